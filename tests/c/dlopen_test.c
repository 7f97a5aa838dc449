/* libmote_c.so loaded at run time, with its header alone: renders a picture, and shows no other symbol.
 * Usage: dlopen_test LIBRARY */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>

#include "check.h"
#include "plugins/c/mote.h"

#define GET(name)                                       \
    do {                                                \
        *(void**)(&name##_now) = dlsym(library, #name); \
        CHECK(name##_now != NULL);                      \
        if (!name##_now) return 1;                      \
    } while (0)

static __typeof__(&mote_version_number) mote_version_number_now;
static __typeof__(&mote_scene_new) mote_scene_new_now;
static __typeof__(&mote_scene_load_text) mote_scene_load_text_now;
static __typeof__(&mote_scene_free) mote_scene_free_now;
static __typeof__(&mote_picture_new) mote_picture_new_now;
static __typeof__(&mote_picture_read) mote_picture_read_now;
static __typeof__(&mote_picture_free) mote_picture_free_now;
static __typeof__(&mote_render) mote_render_now;

int main(int argc, char** argv) {
    void* library;
    mote_scene* scene;
    mote_picture* picture;
    mote_render_options options;
    static float values[40 * 30 * 3];
    float sum = 0.0f;
    size_t i;
    if (argc != 2) return 2;
    library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return 1;
    }
    GET(mote_version_number);
    GET(mote_scene_new);
    GET(mote_scene_load_text);
    GET(mote_scene_free);
    GET(mote_picture_new);
    GET(mote_picture_read);
    GET(mote_picture_free);
    GET(mote_render);
    CHECK(mote_version_number_now() == MOTE_VERSION_NUMBER);
    CHECK(dlsym(library, "_ZN4mote7session13make_registryEv") == NULL);
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options, options.passes = 1;
    scene = mote_scene_new_now(), picture = mote_picture_new_now();
    CHECK(mote_scene_load_text_now(scene, small_scene, NULL) == MOTE_OK);
    CHECK(mote_render_now(scene, &options, picture) == MOTE_OK);
    CHECK(mote_picture_read_now(picture, "beauty", values, sizeof values / sizeof *values) == MOTE_OK);
    for (i = 0; i < sizeof values / sizeof *values; ++i) sum += values[i];
    CHECK(sum > 0.0f);
    (void)seconds;
    mote_scene_free_now(scene);
    mote_picture_free_now(picture);
    printf("%d checks, %d failures\n", checks, failures);
    return failures > 0;
}
