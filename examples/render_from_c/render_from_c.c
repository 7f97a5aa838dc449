/* render_from_c SCENE OUT.exr PASSES [NAME VALUE]...: `mote render SCENE -o OUT.exr --passes PASSES -D
 * NAME=VALUE`, to the bit, in C99. */
#include <mote/mote.h>
#include <stdio.h>
#include <stdlib.h>

enum { max_defines = 16 };

static void show(void* user, const mote_progress* progress) {
    (void)user;
    fprintf(stderr, "\r%u passes", (unsigned)progress->passes);
}

int main(int argc, char** argv) {
    const char *names[max_defines], *values[max_defines];
    mote_scene* scene = mote_scene_new();
    mote_picture* picture = mote_picture_new();
    mote_load_options load = {0};
    mote_render_options render = {0};
    mote_status status;
    if (argc < 4) return fputs("render_from_c SCENE OUT.exr PASSES [NAME VALUE]...\n", stderr), 2;
    load.struct_size = sizeof load;
    load.define_names = names, load.define_values = values;
    for (; load.define_count < max_defines && 5 + 2 * (int)load.define_count < argc; ++load.define_count) {
        names[load.define_count] = argv[4 + 2 * load.define_count];
        values[load.define_count] = argv[5 + 2 * load.define_count];
    }
    render.struct_size = sizeof render;
    render.passes = (uint32_t)atoi(argv[3]);
    render.progress = show;

    status = mote_scene_load_file(scene, argv[1], &load);
    if (status != MOTE_OK)
        fprintf(stderr, "%s\n", mote_scene_error(scene)); /* with file and line */
    else if ((status = mote_render(scene, &render, picture)) != MOTE_OK ||
             (status = mote_picture_save(picture, argv[2], 0)) != MOTE_OK)
        fprintf(stderr, "%s\n", mote_picture_error(picture));
    else
        printf("\n%s: %d x %d pixels, %u passes\n", argv[2], mote_picture_width(picture),
               mote_picture_height(picture), (unsigned)mote_picture_passes(picture));
    mote_picture_free(picture);
    mote_scene_free(scene);
    return status != MOTE_OK;
}
