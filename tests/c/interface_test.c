/* The C interface from C99: scenes, renders, layers, errors, cancelling, threads, arrays, and the bits of the
 * command. Usage: interface_test MOTE FOLDER: the command, and a folder to write into. */
#define _POSIX_C_SOURCE 200809L
#include <malloc.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include "check.h"
#include "plugins/c/mote.h"

static mote_scene* loaded(const char* xml, const mote_load_options* options) {
    mote_scene* scene = mote_scene_new();
    CHECK(mote_scene_load_text(scene, xml, options) == MOTE_OK);
    if (*mote_scene_error(scene)) fprintf(stderr, "%s\n", mote_scene_error(scene));
    return scene;
}

static mote_render_options passes(uint32_t count) {
    mote_render_options options;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.passes = count, options.seed = 7;
    return options;
}

/* A layer in memory of its own; the caller frees it. */
static float* layer_of(mote_picture* picture, const char* name, size_t* count) {
    const int channels = mote_picture_layer_channels(picture, name);
    float* values;
    *count = (size_t)mote_picture_width(picture) * (size_t)mote_picture_height(picture) * (size_t)channels;
    values = malloc(*count * sizeof(float) + 1);
    CHECK(channels > 0 && mote_picture_read(picture, name, values, *count) == MOTE_OK);
    return values;
}

static void test_version(void) {
    char text[64];
    CHECK(mote_version_number() == MOTE_VERSION_NUMBER);
    /* The header's three numbers are CMake's, which the library was compiled with. */
    snprintf(text, sizeof text, "%d.%d.%d", MOTE_VERSION_MAJOR, MOTE_VERSION_MINOR, MOTE_VERSION_PATCH);
    CHECK(strcmp(mote_version(), text) == 0);
    CHECK(strcmp(mote_status_name(MOTE_INPUT_ERROR), "MOTE_INPUT_ERROR") == 0);
}

static void test_render(void) {
    mote_scene* scene = loaded(small_scene, NULL);
    mote_picture* picture = mote_picture_new();
    const mote_render_options options = passes(2);
    size_t i, count;
    float sum = 0.0f, *values;
    CHECK(mote_scene_width(scene) == 40 && mote_scene_height(scene) == 30);
    CHECK(strstr(mote_scene_plan(scene), "mote_vpl") != NULL);
    CHECK(mote_render(scene, &options, picture) == MOTE_OK);
    mote_scene_free(scene); /* the picture stays */
    CHECK(mote_picture_passes(picture) == 2 && !mote_picture_interrupted(picture));
    CHECK(strcmp(mote_picture_layer_name(picture, 0), "beauty") == 0);
    CHECK(mote_picture_layer_name(picture, mote_picture_layer_count(picture)) == NULL);
    CHECK(mote_picture_layer_channels(picture, "direct") == 3 &&
          mote_picture_layer_channels(picture, "no") == 0);
    CHECK(strcmp(mote_picture_metadata(picture, "seed"), "7") == 0);
    CHECK(mote_picture_metadata(picture, "nothing") == NULL);
    CHECK(strstr(mote_picture_statistics(picture), "\"passes\": 2") != NULL);
    values = layer_of(picture, "beauty", &count);
    CHECK(count == 40 * 30 * 3);
    for (i = 0; i < count; ++i) sum += values[i];
    CHECK(sum > 0.0f && isfinite(sum));
    CHECK(mote_picture_read(picture, "beauty", values, count - 1) == MOTE_BUFFER_TOO_SMALL);
    CHECK(mote_picture_read(picture, "beuaty", values, count) == MOTE_INPUT_ERROR);
    CHECK(strstr(mote_picture_error(picture), "did you mean 'beauty'") != NULL);
    free(values);
    mote_picture_free(picture);
}

static void test_errors(void) {
    mote_scene* scene = mote_scene_new();
    mote_picture* picture = mote_picture_new();
    mote_render_options options = passes(1);
    mote_load_options load;
    struct {
        mote_render_options known;
        int further[4];
    } newer;
    CHECK(mote_scene_load_text(scene, "<scene version=\"3.0.0\">\n\n<shape type=\"sphre\"/></scene>", NULL) ==
          MOTE_INPUT_ERROR);
    CHECK(mote_scene_error_line(scene) == 3 && strcmp(mote_scene_error_file(scene), "<string>") == 0);
    CHECK(strstr(mote_scene_error(scene), "did you mean 'sphere'") != NULL);
    CHECK(mote_scene_error_count(scene) == 1 && mote_scene_error_at(scene, 1) == NULL);
    CHECK(mote_scene_load_text(scene, "<scene", NULL) == MOTE_INPUT_ERROR);
    CHECK(mote_scene_load_file(scene, "/nowhere.xml", NULL) == MOTE_INPUT_ERROR);
    CHECK(strcmp(mote_scene_error_file(scene), "") == 0 && strstr(mote_scene_error(scene), "nowhere.xml"));
    CHECK(mote_scene_load_text(scene, NULL, NULL) == MOTE_INVALID_ARGUMENT);
    CHECK(strstr(mote_scene_error(scene), "null") != NULL);
    CHECK(mote_scene_load_text(NULL, small_scene, NULL) == MOTE_INVALID_ARGUMENT);
    CHECK(mote_render(scene, &options, picture) == MOTE_INVALID_ARGUMENT); /* nothing is loaded */
    CHECK(mote_render(NULL, &options, picture) == MOTE_INVALID_ARGUMENT);
    CHECK(mote_render(scene, &options, NULL) == MOTE_INVALID_ARGUMENT);
    memset(&load, 0, sizeof load);
    CHECK(mote_scene_load_text(scene, small_scene, &load) == MOTE_INVALID_ARGUMENT);
    CHECK(strstr(mote_scene_error(scene), "struct_size") != NULL);
    load.struct_size = sizeof load, load.integrator = "mote_vlp";
    CHECK(mote_scene_load_text(scene, small_scene, &load) == MOTE_INPUT_ERROR);
    CHECK(mote_scene_load_text(scene, small_scene, NULL) == MOTE_OK && !*mote_scene_error(scene));
    options.threads = -1;
    CHECK(mote_render(scene, &options, picture) == MOTE_INVALID_ARGUMENT);
    options.threads = 0, options.denoise = "bmrf";
    CHECK(mote_render(scene, &options, picture) == MOTE_INPUT_ERROR);
    CHECK(strstr(mote_picture_error(picture), "did you mean 'bmfr'") != NULL);
    memset(&newer, 0, sizeof newer); /* of a newer header: what is not known must be zero */
    newer.known = passes(1), newer.known.struct_size = sizeof newer;
    CHECK(mote_render(scene, &newer.known, picture) == MOTE_OK);
    newer.further[3] = 1;
    CHECK(mote_render(scene, &newer.known, picture) == MOTE_INVALID_ARGUMENT);
    mote_scene_free(scene), mote_scene_free(NULL);
    mote_picture_free(picture), mote_picture_free(NULL);
}

typedef struct Watch {
    double begin, requested;
    uint32_t passes;
    int previews;
} Watch;
static int after_a_moment(void* user) {
    Watch* watch = user;
    if (watch->requested == 0.0 && seconds() - watch->begin > 0.4) watch->requested = seconds();
    return watch->requested > 0.0;
}
static void watch_progress(void* user, const mote_progress* progress) {
    ((Watch*)user)->passes = progress->passes;
}
static void watch_preview(void* user, int width, int height, const float* rgb) {
    ((Watch*)user)->previews += width == 40 && height == 30 && isfinite(rgb[0]);
}

static void test_cancel(void) {
    mote_scene* scene = loaded(small_scene, NULL);
    mote_picture* picture = mote_picture_new();
    mote_render_options options = passes(1u << 29);
    Watch watch = {0.0, 0.0, 0, 0};
    watch.begin = seconds();
    options.user = &watch, options.cancelled = after_a_moment, options.progress = watch_progress;
    options.preview = watch_preview;
    CHECK(mote_render(scene, &options, picture) == MOTE_OK);
    CHECK(seconds() - watch.requested < 2.0);
    CHECK(mote_picture_interrupted(picture) && mote_picture_passes(picture) > 0);
    CHECK(watch.passes > 0 && watch.passes <= mote_picture_passes(picture) && watch.previews > 0);
    CHECK(mote_picture_layer_channels(picture, "beauty") == 3);
    mote_scene_free(scene);
    mote_picture_free(picture);
}

static void test_seconds(void) {
    mote_scene* scene = loaded(small_scene, NULL);
    mote_picture* picture = mote_picture_new();
    mote_render_options options = passes(0);
    const double begin = seconds();
    options.seconds = 0.3;
    CHECK(mote_render(scene, &options, picture) == MOTE_OK);
    CHECK(seconds() - begin < 2.3 && mote_picture_passes(picture) > 0 && !mote_picture_interrupted(picture));
    mote_scene_free(scene);
    mote_picture_free(picture);
}

static void* render_twice(void* unused) {
    int i;
    (void)unused;
    mote_picture* picture = mote_picture_new();
    mote_scene* scene = mote_scene_new();
    const mote_render_options options = passes(3);
    for (i = 0; i < 2; ++i) {
        const mote_status load = mote_scene_load_text(scene, small_scene, NULL);
        if (load != MOTE_OK || mote_render(scene, &options, picture) != MOTE_OK) break;
    }
    mote_scene_free(scene);
    return picture;
}

static void test_threads(void) {
    pthread_t threads[2];
    void* pictures[2];
    float* values[2];
    size_t count = 0;
    int i;
    for (i = 0; i < 2; ++i) CHECK(pthread_create(&threads[i], NULL, render_twice, NULL) == 0);
    for (i = 0; i < 2; ++i) pthread_join(threads[i], &pictures[i]);
    for (i = 0; i < 2; ++i) values[i] = layer_of(pictures[i], "beauty", &count);
    CHECK(count == 3600 && memcmp(values[0], values[1], count * sizeof(float)) == 0);
    for (i = 0; i < 2; ++i) free(values[i]), mote_picture_free(pictures[i]);
}

static void compare_layers(mote_picture* ours, mote_picture* theirs) {
    size_t i, a, b;
    CHECK(mote_picture_layer_count(ours) == mote_picture_layer_count(theirs) &&
          mote_picture_layer_count(ours) > 2);
    for (i = 0; i < mote_picture_layer_count(ours); ++i) {
        const char* name = mote_picture_layer_name(ours, i);
        float *x = layer_of(ours, name, &a), *y = layer_of(theirs, name, &b);
        CHECK(a == b && memcmp(x, y, a * sizeof(float)) == 0);
        free(x), free(y);
    }
}

/* The bits of the command, also of a definition and of another integrator. */
static void test_bits(const char* mote, const char* folder) {
    /* More of them than the first value has characters. */
    const char* names[] = {"paths", "film.width", "film.height", "integrator.max_depth"};
    const char* values[] = {"8", "24", "18", "3"};
    char scene_path[4096], picture_path[4096], command[16384];
    mote_scene* scene = mote_scene_new();
    mote_picture *ours = mote_picture_new(), *theirs = mote_picture_new();
    mote_load_options load;
    mote_render_options options = passes(3);
    FILE* file;
    snprintf(scene_path, sizeof scene_path, "%s/c_interface.xml", folder);
    snprintf(picture_path, sizeof picture_path, "%s/c_interface.exr", folder);
    snprintf(command, sizeof command,
             "'%s' render '%s' -o '%s' --passes 3 --seed 7 -D paths=8 -D film.width=24 -D film.height=18 "
             "-D integrator.max_depth=3 --auxiliary --quiet "
             "> /dev/null",
             mote, scene_path, picture_path);
    file = fopen(scene_path, "w");
    CHECK(file != NULL);
    if (!file) return;
    fputs(small_scene, file);
    fclose(file);
    memset(&load, 0, sizeof load);
    load.struct_size = sizeof load, load.define_names = names, load.define_values = values,
    load.define_count = 4;
    CHECK(mote_scene_load_file(scene, scene_path, &load) == MOTE_OK);
    options.auxiliary = 1, options.threads = 1;
    CHECK(mote_render(scene, &options, ours) == MOTE_OK && mote_picture_width(ours) == 24);
    CHECK(system(command) == 0);
    CHECK(mote_picture_load(theirs, picture_path) == MOTE_OK);
    compare_layers(ours, theirs);
    CHECK(strcmp(mote_picture_metadata(ours, "sceneHash"), mote_picture_metadata(theirs, "sceneHash")) == 0);
    mote_scene_free(scene);
    mote_picture_free(ours), mote_picture_free(theirs);
}

/* The small scene again, from arrays: a floor of two triangles, and a cube of fog. */
static void describe(mote_scene* scene, float top) {
    static const float positions[] = {-3, 0, -3, 3, 0, -3, 3, 0, 3, -3, 0, 3};
    static const uint32_t triangles[] = {0, 2, 1, 0, 3, 2};
    const double look[16] = {-1, 0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 4, 0, 0, 0, 1};
    float density[8];
    mote_mesh mesh;
    mote_grid grid;
    int i;
    for (i = 0; i < 8; ++i) density[i] = i < 4 ? 1.0f : top;
    memset(&mesh, 0, sizeof mesh), memset(&grid, 0, sizeof grid);
    mesh.struct_size = sizeof mesh, mesh.positions = positions, mesh.vertex_count = 4;
    mesh.triangles = triangles, mesh.triangle_count = 2;
    grid.struct_size = sizeof grid, grid.values = density, grid.width = grid.height = grid.depth = 2;
    CHECK(mote_scene_add_mesh(scene, "floor", &mesh) == MOTE_OK);
    CHECK(mote_scene_add_grid(scene, "fog", &grid) == MOTE_OK);
    mote_scene_begin(scene, "integrator", "volpath", NULL, NULL), mote_scene_end(scene);
    mote_scene_begin(scene, "sensor", "perspective", NULL, NULL);
    mote_scene_set_float(scene, "fov", 50);
    mote_scene_set_transform(scene, "to_world", look);
    mote_scene_begin(scene, "film", "hdrfilm", NULL, NULL);
    mote_scene_set_integer(scene, "width", 20), mote_scene_set_integer(scene, "height", 16);
    mote_scene_end(scene), mote_scene_end(scene);
    mote_scene_begin(scene, "bsdf", "diffuse", NULL, "white");
    mote_scene_set_rgb(scene, "reflectance", 0.8, 0.8, 0.8);
    mote_scene_end(scene);
    mote_scene_begin(scene, "shape", "arraymesh", NULL, NULL);
    mote_scene_set_string(scene, "array", "floor");
    mote_scene_refer(scene, "white", NULL);
    mote_scene_end(scene);
    mote_scene_begin(scene, "shape", "cube", NULL, NULL);
    mote_scene_begin(scene, "bsdf", "null", NULL, NULL), mote_scene_end(scene);
    mote_scene_begin(scene, "medium", "heterogeneous", "interior", NULL);
    mote_scene_begin(scene, "volume", "arraygrid", "sigma_t", NULL);
    mote_scene_set_string(scene, "array", "fog");
    mote_scene_end(scene), mote_scene_end(scene), mote_scene_end(scene);
    mote_scene_begin(scene, "emitter", "point", NULL, NULL);
    mote_scene_set_point(scene, "position", 1, 3, 2);
    mote_scene_end(scene);
}

static float mean_of_arrays(float top) {
    mote_scene* scene = mote_scene_new();
    mote_picture* picture = mote_picture_new();
    const mote_render_options options = passes(4);
    float sum = 0.0f, *values;
    size_t i, count;
    describe(scene, top);
    CHECK(mote_scene_build(scene, NULL) == MOTE_OK);
    if (*mote_scene_error(scene)) fprintf(stderr, "%s\n", mote_scene_error(scene));
    CHECK(mote_render(scene, &options, picture) == MOTE_OK);
    values = layer_of(picture, "beauty", &count);
    for (i = 0; i < count; ++i) sum += values[i];
    free(values);
    mote_scene_free(scene);
    mote_picture_free(picture);
    return sum / (float)count;
}

static void test_arrays(void) {
    mote_scene* scene = mote_scene_new();
    static const float nowhere[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint32_t beyond[] = {0, 1, 3};
    mote_mesh mesh;
    CHECK(mean_of_arrays(1.0f) > 0.0f);
    CHECK(mean_of_arrays(1.0f) == mean_of_arrays(1.0f));
    CHECK(mean_of_arrays(1.0f) != mean_of_arrays(2.0f)); /* the grid is read */
    memset(&mesh, 0, sizeof mesh);
    mesh.struct_size = sizeof mesh, mesh.positions = nowhere, mesh.vertex_count = 3;
    mesh.triangles = beyond, mesh.triangle_count = 1;
    CHECK(mote_scene_add_mesh(scene, "bad", &mesh) == MOTE_INPUT_ERROR);
    CHECK(strstr(mote_scene_error(scene), "array 'bad'") != NULL);
    CHECK(mote_scene_begin(scene, "shpae", "sphere", NULL, NULL) == MOTE_INPUT_ERROR);
    CHECK(strstr(mote_scene_error(scene), "did you mean 'shape'") != NULL);
    CHECK(mote_scene_end(scene) == MOTE_INPUT_ERROR);
    describe(scene, 1.0f);
    mote_scene_begin(scene, "shape", "sphere", NULL, "ball");
    mote_scene_set_float(scene, "raduis", 1.0);
    CHECK(mote_scene_build(scene, NULL) == MOTE_INPUT_ERROR); /* the sphere is open */
    describe(scene, 1.0f);
    mote_scene_begin(scene, "shape", "sphere", NULL, "ball");
    mote_scene_set_float(scene, "raduis", 1.0), mote_scene_end(scene);
    CHECK(mote_scene_build(scene, NULL) == MOTE_INPUT_ERROR);
    CHECK(strcmp(mote_scene_error_file(scene), "scene.ball") == 0);
    CHECK(strstr(mote_scene_error(scene), "did you mean 'radius'") != NULL);
    mote_scene_free(scene);
}

/* Numbers and depths that no scene has. */
static void test_extremes(void) {
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t triangle[3] = {0, 1, 2};
    mote_mesh mesh = {0};
    mote_grid grid = {0};
    mote_scene* scene = mote_scene_new();
    int i, refused = 0;
    const double begin = seconds();
    for (i = 0; i < 20000; ++i)
        refused += mote_scene_begin(scene, "shape", "sphere", NULL, NULL) == MOTE_INPUT_ERROR;
    CHECK(refused > 19000);
    CHECK(seconds() - begin < 5.0);
    CHECK(strstr(mote_scene_error(scene), "nested") != NULL);
    mesh.struct_size = sizeof mesh, mesh.positions = corners, mesh.triangles = triangle;
    mesh.vertex_count = SIZE_MAX, mesh.triangle_count = 1;
    CHECK(mote_scene_add_mesh(scene, "large", &mesh) == MOTE_INVALID_ARGUMENT);
    mesh.vertex_count = 3, mesh.triangle_count = SIZE_MAX / 3;
    CHECK(mote_scene_add_mesh(scene, "large", &mesh) == MOTE_INVALID_ARGUMENT);
    grid.struct_size = sizeof grid, grid.values = corners;
    grid.width = grid.height = grid.depth = 2000000000;
    CHECK(mote_scene_add_grid(scene, "large", &grid) == MOTE_INVALID_ARGUMENT);
    CHECK(strcmp(mote_scene_error(scene), "a grid has at most 2^34 values") == 0);
    mote_scene_free(scene);
}

/* Under a limit on the address space: what does not fit is refused before it is begun. */
static void test_memory(void) {
    const char *names[] = {"film.width", "film.height"}, *values[] = {"16384", "16384"};
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t triangle[3] = {0, 1, 2};
    mote_load_options changes = {0};
    mote_render_options options = {0};
    mote_mesh mesh = {0};
    mote_grid grid = {0};
    mote_scene* scene = mote_scene_new();
    mote_picture* picture = mote_picture_new();
    struct rlimit before, limit;
    const double begin = seconds();
    getrlimit(RLIMIT_AS, &before);
    limit = before, limit.rlim_cur = (rlim_t)6 << 30;
    setrlimit(RLIMIT_AS, &limit);
    changes.struct_size = sizeof changes, changes.integrator = "path";
    changes.define_names = names, changes.define_values = values, changes.define_count = 2;
    CHECK(mote_scene_load_text(scene, small_scene, &changes) == MOTE_OK);
    options.struct_size = sizeof options, options.passes = 1, options.auxiliary = 1;
    CHECK(mote_render(scene, &options, picture) == MOTE_OUT_OF_MEMORY);
    CHECK(strstr(mote_picture_error(picture), "a film of 16384 x 16384 pixels") != NULL);
    CHECK(strstr(mote_picture_error(picture), "at most") != NULL);
    CHECK(seconds() - begin < 5.0);
    grid.struct_size = sizeof grid, grid.values = corners;
    grid.width = 2000000000, grid.height = grid.depth = 1; /* the values are not read */
    CHECK(mote_scene_add_grid(scene, "large", &grid) == MOTE_OUT_OF_MEMORY);
    mesh.struct_size = sizeof mesh, mesh.positions = corners, mesh.triangles = triangle;
    mesh.vertex_count = 2000000000, mesh.triangle_count = 1;
    CHECK(mote_scene_add_mesh(scene, "large", &mesh) == MOTE_OUT_OF_MEMORY);
    setrlimit(RLIMIT_AS, &before);
    mote_picture_free(picture), mote_scene_free(scene);
}

/* A checkpoint replaces and removes nothing but its own. */
static void test_files_of_others(const char* folder) {
    static const char* const beside[] = {"precious",   "c.png",      "c.part",
                                         "c.exr.part", "c.json",     "c.exr.checkpoint",
                                         "c.1-0.part", "c.exr.json", "c_files"};
    char path[1000], text[16] = "";
    size_t i;
    mote_render_options options = {0};
    mote_scene* scene = mote_scene_new();
    mote_picture* picture = mote_picture_new();
    FILE* file;
    for (i = 0; i < sizeof beside / sizeof *beside; ++i) {
        snprintf(path, sizeof path, "%s/%s", folder, beside[i]);
        file = fopen(path, "w");
        fputs("a diary", file), fclose(file);
    }
    snprintf(path, sizeof path, "%s/precious", folder);
    options.struct_size = sizeof options, options.passes = 1, options.checkpoint = path;
    CHECK(mote_scene_load_text(scene, small_scene, NULL) == MOTE_OK);
    CHECK(mote_render(scene, &options, picture) == MOTE_INPUT_ERROR);
    CHECK(strstr(mote_picture_error_file(picture), "precious") != NULL);
    /* Nor does a render touch what stands beside its checkpoint and its picture. */
    snprintf(path, sizeof path, "%s/c", folder);
    CHECK(mote_render(scene, &options, picture) == MOTE_OK);
    CHECK(access(path, F_OK) != 0); /* a complete render has none */
    snprintf(path, sizeof path, "%s/c.exr", folder);
    CHECK(mote_picture_save(picture, path, 0) == MOTE_OK);
    for (i = 0; i < sizeof beside / sizeof *beside; ++i) {
        snprintf(path, sizeof path, "%s/%s", folder, beside[i]);
        file = fopen(path, "r");
        CHECK(file && fgets(text, sizeof text, file) && strcmp(text, "a diary") == 0);
        if (file) fclose(file);
        remove(path);
    }
    mote_picture_free(picture), mote_scene_free(scene);
}

static void test_algorithms(void) {
    mote_scene* scene = loaded(small_scene, NULL);
    mote_picture *picture = mote_picture_new(), *plain = mote_picture_new();
    mote_render_options options = passes(4);
    mote_metrics metrics;
    mote_ssbc_options ssbc;
    size_t count, i;
    float *before, *after, *added, *names[4];
    static const char* const needed[] = {"beauty", "Center.P", "Center.N", "Center.DiffuseAlbedo"};
    double largest = 0.0;
    options.auxiliary = 1;
    CHECK(mote_render(scene, &options, picture) == MOTE_OK);
    /* The same from plain buffers. */
    for (i = 0; i < 4; ++i) {
        names[i] = layer_of(picture, needed[i], &count);
        CHECK(mote_picture_write(plain, needed[i], 40, 30, 3, names[i]) == MOTE_OK);
    }
    CHECK(mote_picture_write(plain, "wrong", 41, 30, 1, names[0]) == MOTE_INPUT_ERROR);
    mote_picture_set_metadata(plain, "worldToCamera", mote_picture_metadata(picture, "worldToCamera"));
    CHECK(mote_picture_compensate(plain, NULL) == MOTE_INPUT_ERROR); /* no bound */
    memset(&ssbc, 0, sizeof ssbc);
    ssbc.struct_size = sizeof ssbc, ssbc.bound = 0.5;
    CHECK(mote_picture_compensate(plain, &ssbc) == MOTE_OK);
    before = names[0], after = layer_of(plain, "beauty", &count);
    added = layer_of(plain, "compensation_surface", &count);
    for (i = 0; i < count; ++i) {
        CHECK(after[i] == before[i] + added[i]);
        largest = added[i] > largest ? added[i] : largest;
    }
    CHECK(largest > 0.0);
    metrics.struct_size = sizeof metrics;
    CHECK(mote_compare(after, before, 40, 30, NULL, NULL, &metrics) == MOTE_OK);
    CHECK(metrics.error > 0.0 && metrics.bias > 0.0 && metrics.mse > 0.0 && metrics.non_finite == 0);
    CHECK(mote_compare(before, before, 40, 30, NULL, NULL, &metrics) == MOTE_OK && metrics.mse == 0.0);
    metrics.struct_size = 8;
    CHECK(mote_compare(before, before, 40, 30, NULL, NULL, &metrics) == MOTE_INVALID_ARGUMENT);
    CHECK(mote_picture_denoise(picture, "bmfr", 1) == MOTE_OK);
    CHECK(mote_picture_layer_channels(picture, "denoised") == 3);
    CHECK(mote_picture_denoise(picture, "bmfr", 1) == MOTE_INPUT_ERROR); /* it is already */
    for (i = 0; i < 4; ++i) free(names[i]);
    free(after), free(added);
    mote_scene_free(scene);
    mote_picture_free(picture), mote_picture_free(plain);
}

/* Two frames of one scene: the second takes from the first what it shows of the same places. */
static void test_sequence(void) {
    mote_scene* scene = loaded(small_scene, NULL);
    mote_sequence* sequence = mote_sequence_new();
    float *one = NULL, *two = NULL;
    size_t count = 0, i;
    int frame, differ = 0;
    for (frame = 0; frame < 2; ++frame) {
        mote_picture *picture = mote_picture_new(), *alone = mote_picture_new();
        mote_sequence* of_one = mote_sequence_new();
        mote_render_options options = passes(2);
        options.auxiliary = 1, options.seed = (uint64_t)frame + 1;
        CHECK(mote_render(scene, &options, picture) == MOTE_OK);
        CHECK(mote_render(scene, &options, alone) == MOTE_OK);
        CHECK(mote_sequence_denoise(sequence, picture) == MOTE_OK);
        CHECK(mote_sequence_denoise(of_one, alone) == MOTE_OK);
        one = layer_of(picture, "denoised", &count), two = layer_of(alone, "denoised", &count);
        differ = 0;
        for (i = 0; i < count; ++i) {
            CHECK(isfinite(one[i]));
            differ += one[i] != two[i];
        }
        CHECK(frame == 0 ? differ == 0 : differ > (int)count / 2);
        free(one), free(two);
        CHECK(mote_sequence_denoise(sequence, picture) == MOTE_INPUT_ERROR); /* it is already */
        CHECK(strstr(mote_picture_error(picture), "denoised already") != NULL);
        mote_picture_free(picture), mote_picture_free(alone), mote_sequence_free(of_one);
    }
    CHECK(mote_sequence_denoise(NULL, NULL) == MOTE_INVALID_ARGUMENT);
    mote_sequence_free(sequence), mote_sequence_free(NULL);
    mote_scene_free(scene);
}

/* Fog without end before a wall, a lamp in it: what a ray scatters, by ten steps a metre. */
static void march_fog(void* user, double x, double y, double distance, float radiance[3]) {
    const double dx = (x - 40) / 80, dy = (y - 30) / 80, length = sqrt(dx * dx + dy * dy + 1);
    const double lamp[3] = {0.4, 0.2, 2.5};
    const int steps = (int)(10 * distance) + 1;
    double sum = 0;
    int i;
    ++*(uint64_t*)user;
    for (i = 0; i < steps; ++i) {
        const double t = distance * (i + 0.5) / steps;
        const double a = t * dx / length - lamp[0], b = t * dy / length - lamp[1], c = t / length - lamp[2];
        const double r = sqrt(a * a + b * b + c * c);
        sum += exp(-0.05 * (t + r)) / (r * r) * distance / steps;
    }
    radiance[0] = radiance[1] = (float)(0.05 * sum), radiance[2] = 0.0f;
}

static void test_epipolar(void) {
    enum { width = 80, height = 60 };
    static float depth[width * height], light[3 * width * height];
    mote_epipolar_options options;
    uint64_t called = 0, marched = 0, exact = 0;
    double error = 0, sum = 0;
    int i;
    for (i = 0; i < width * height; ++i) depth[i] = i % width < 50 ? 6.0f : i / width < 20 ? INFINITY : 4.0f;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options, options.width = width, options.height = height,
    options.depth = depth;
    options.far_distance = 10, options.focal_length = 80, options.lines = 96;
    options.lamp[0] = 0.4, options.lamp[1] = 0.2, options.lamp[2] = 2.5;
    options.march = march_fog, options.user = &called;
    CHECK(mote_epipolar(&options, light, 3 * width * height - 1, NULL) == MOTE_BUFFER_TOO_SMALL);
    CHECK(mote_epipolar(&options, light, 3 * width * height, &marched) == MOTE_OK);
    CHECK(marched == called && marched > 100 && marched < width * height / 2);
    for (i = 0; i < width * height; ++i) {
        const double x = i % width + 0.5, y = i / width + 0.5, dx = (x - 40) / 80, dy = (y - 30) / 80;
        float truth[3];
        options.march(&exact, x, y, isfinite(depth[i]) ? depth[i] * sqrt(dx * dx + dy * dy + 1) : 10, truth);
        error += fabs(light[3 * i] - truth[0]), sum += truth[0];
        CHECK(light[3 * i + 1] == light[3 * i] && light[3 * i + 2] == 0.0f);
    }
    printf("epipolar: %.1f %% of the rays, error %.2f %%\n", 100.0 * (double)marched / (width * height),
           100.0 * error / sum);
    CHECK(error < 0.01 * sum);
    options.lamp[0] = options.lamp[1] = options.lamp[2] = 0; /* at the eye */
    CHECK(mote_epipolar(&options, light, 3 * width * height, NULL) == MOTE_INVALID_ARGUMENT);
    options.lamp[2] = 2.5, options.march = NULL;
    CHECK(mote_epipolar(&options, light, 3 * width * height, NULL) == MOTE_INVALID_ARGUMENT);
}

/* A corner of a wall at z = 4 and a floor at y = 1, seen along z. */
static void shade_plane(void* user, int x, int y, float radiance[3]) {
    const float* normals = ((const float**)user)[0];
    ++*((uint64_t**)user)[1];
    radiance[0] = radiance[1] = radiance[2] = normals[3 * (y * 48 + x) + 1] < -0.5f ? 2.0f : 1.0f;
}
static void test_upsample(void) {
    enum { width = 48, height = 48, pixels = width * height };
    static float position[3 * pixels], normal[3 * pixels], light[3 * pixels];
    mote_upsample_options options;
    uint64_t called = 0, shaded = 0;
    void* user[2];
    int i;
    user[0] = normal, user[1] = &called;
    memset(normal, 0, sizeof normal);
    for (i = 0; i < pixels; ++i) {
        const float x = ((float)(i % width) + 0.5f) / width - 0.5f,
                    y = ((float)(i / width) + 0.5f) / height - 0.5f;
        const int is_floor = y > 0.25f;
        const float z = is_floor ? 1 / y : 4;
        position[3 * i] = x * z, position[3 * i + 1] = y * z, position[3 * i + 2] = z;
        normal[3 * i + (is_floor ? 1 : 2)] = -1;
    }
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options, options.width = width, options.height = height;
    options.focal_length = width, options.position = position, options.normal = normal, options.spacing = 3;
    options.shade = shade_plane, options.user = user;
    CHECK(mote_upsample(&options, light, 3 * pixels - 1, NULL) == MOTE_BUFFER_TOO_SMALL);
    CHECK(mote_upsample(&options, light, 3 * pixels, &shaded) == MOTE_OK);
    CHECK(shaded == called && shaded >= pixels / 9 && shaded < pixels / 4);
    for (i = 0; i < pixels; ++i) CHECK(fabs(light[3 * i] - (normal[3 * i + 1] < -0.5f ? 2 : 1)) < 1e-3);
    options.spacing = 0;
    CHECK(mote_upsample(&options, light, 3 * pixels, NULL) == MOTE_INVALID_ARGUMENT);
    options.spacing = 3, options.shade = NULL;
    CHECK(mote_upsample(&options, light, 3 * pixels, NULL) == MOTE_INVALID_ARGUMENT);
}

static void test_count_visible(void) {
    const uint32_t items[] = {0, 0, 1, MOTE_NO_ITEM, 0, 1};
    const mote_visibility_query queries[] = {
        {0, 0, 0, 3, 2}, {0, 1, 0, 3, 2}, {1, 2, 0, 9, 9}, {2, 0, 0, 3, 2}};
    uint32_t pixels[4];
    CHECK(mote_count_visible(items, 3, 2, 3, queries, 4, pixels) == MOTE_OK);
    CHECK(pixels[0] == 3 && pixels[1] == 2 && pixels[2] == 2 && pixels[3] == 0);
    CHECK(mote_count_visible(items, 3, 2, 1, queries, 1, pixels) == MOTE_INVALID_ARGUMENT); /* item 1 */
    CHECK(mote_count_visible(items, 3, 2, 2, queries, 4, pixels) ==
          MOTE_INVALID_ARGUMENT); /* query of item 2 */
    CHECK(mote_count_visible(NULL, 3, 2, 3, queries, 4, pixels) == MOTE_INVALID_ARGUMENT);
}

/* Samples come as often as the probabilities say, which sum to 1. */
static void test_light_tree(void) {
    enum { count = 21, samples = 20000 };
    mote_light lights[count];
    int sampled[count] = {0};
    const float here[3] = {3, 0.5f, 0}, up[3] = {0, 0, 1};
    double sum = 0, most = 0, farthest = 0;
    mote_status status;
    mote_light_tree* tree;
    int i;
    memset(lights, 0, sizeof lights);
    for (i = 0; i < count; ++i) {
        lights[i].lower[0] = lights[i].upper[0] = (float)i, lights[i].lower[2] = lights[i].upper[2] = 2;
        lights[i].intensity = 1 + i % 3, lights[i].normal[2] = i % 2 ? -1.0f : 0.0f;
    }
    tree = mote_light_tree_new(lights, count, &status);
    CHECK(tree && status == MOTE_OK);
    for (i = 0; i < samples; ++i) {
        size_t light = count;
        double probability = 0;
        CHECK(mote_light_tree_sample(tree, here, up, (i + 0.5) / samples, &light, &probability) == MOTE_OK);
        CHECK(light < count && fabs(probability - mote_light_tree_probability(tree, here, up, light)) < 1e-6);
        if (light < count) ++sampled[light];
    }
    for (i = 0; i < count; ++i) {
        const double p = mote_light_tree_probability(tree, here, up, (size_t)i);
        sum += p, most = p > most ? p : most, farthest = i == count - 1 ? p : farthest;
        CHECK(fabs(sampled[i] - samples * p) <= 2.0); /* evenly spread u: off by its ends */
    }
    CHECK(fabs(sum - 1) < 1e-6 && most > 5 * farthest);
    CHECK(mote_light_tree_sample(tree, here, NULL, 1.0, NULL, NULL) == MOTE_INVALID_ARGUMENT);
    CHECK(isnan(mote_light_tree_probability(tree, here, up, count)));
    lights[3].intensity = 0;
    CHECK(!mote_light_tree_new(lights, count, &status) && status == MOTE_INVALID_ARGUMENT);
    CHECK(!mote_light_tree_new(NULL, 1, NULL));
    mote_light_tree_free(tree), mote_light_tree_free(NULL);
}

/* A closed unit cube seen from inside, as a host would trace it. */
static int cube_hit(void* user, const mote_segment* s, mote_hit* hit) {
    int axis, nearest = -1;
    (void)user;
    hit->distance = s->length;
    for (axis = 0; axis < 3; ++axis) {
        const float d = s->direction[axis], t = ((d > 0.0f ? 1.0f : 0.0f) - s->origin[axis]) / d;
        if (d != 0.0f && t > 0.0f && t < hit->distance) hit->distance = t, nearest = axis;
    }
    if (nearest < 0) return 0;
    memset(hit->normal, 0, sizeof hit->normal);
    hit->normal[nearest] = 1.0f, hit->material = 0;
    return 1;
}

/* Power ends in the walls: they receive power / (area (1 - reflectance)), of which power / area is direct. */
static void test_host_light(void) {
    static const float reflectance[3] = {0.5f, 0.5f, 0.5f};
    const mote_lamp lamp = {{0.4, 0.5, 0.6}, {2.0f, 2.0f, 2.0f}};
    const double expected = 4.0 * 3.14159265 * 2.0 / 6.0; /* by bounces [W/m^2] */
    enum { SETS = 12, RECEIVERS = 200 };
    mote_receiver receivers[RECEIVERS];
    float radiance[3 * RECEIVERS];
    double sum = 0.0, squares = 0.0, error;
    int set, i, k;
    mote_host_options scene;
    mote_host_light_options options;
    mote_host_light* light = mote_host_light_new();
    memset(&scene, 0, sizeof scene), memset(&options, 0, sizeof options);
    scene.struct_size = sizeof scene, options.struct_size = sizeof options;
    scene.reflectance = reflectance, scene.material_count = 1, scene.lamps = &lamp, scene.lamp_count = 1;
    scene.upper[0] = scene.upper[1] = scene.upper[2] = 1.0f, scene.first_hit = cube_hit;
    options.paths = 256, options.selection = "stochastic_lightcuts";
    CHECK(mote_host_light_reflect(light, receivers, 1, radiance) == MOTE_INVALID_ARGUMENT);
    srand(5);
    for (set = 0; set < SETS; ++set) {
        double mean = 0.0;
        options.seed = (uint64_t)set;
        CHECK(mote_host_light_trace(light, &scene, &options) == MOTE_OK);
        memset(receivers, 0, sizeof receivers);
        for (i = 0; i < RECEIVERS; ++i) { /* evenly over the six walls */
            const int axis = i % 3, upper = i / 3 % 2;
            for (k = 0; k < 3; ++k) receivers[i].position[k] = (float)((rand() + 0.5) / (RAND_MAX + 1.0));
            receivers[i].position[axis] = (float)upper, receivers[i].normal[axis] = upper ? -1.0f : 1.0f;
        }
        CHECK(mote_host_light_reflect(light, receivers, RECEIVERS - 2, radiance) == MOTE_OK);
        for (i = 0; i < RECEIVERS - 2; ++i) mean += radiance[3 * i + 1] * 3.14159265 / 0.5 / (RECEIVERS - 2);
        sum += mean / SETS, squares += mean * mean / SETS;
    }
    error = sqrt((squares - sum * sum) / (SETS - 1)); /* Student, 11 degrees of freedom, 0.1 %: 4.44 */
    printf("host's walls: %.3f +- %.3f W/m^2 by bounces, %.3f by energy\n", sum, error, expected);
    CHECK(fabs(sum - expected) < 4.44 * error && error < 0.05 * expected &&
          mote_host_light_size(light) > 256);
    options.selection = "lightcut";
    CHECK(mote_host_light_trace(light, &scene, &options) == MOTE_INPUT_ERROR);
    CHECK(strstr(mote_host_light_error(light), "did you mean 'lightcuts'") != NULL);
    CHECK(mote_host_light_size(light) > 256); /* the last one that was traced stays */
    scene.first_hit = NULL;
    CHECK(mote_host_light_trace(light, &scene, NULL) == MOTE_INVALID_ARGUMENT);
    CHECK(mote_host_light_trace(light, NULL, NULL) == MOTE_INVALID_ARGUMENT);
    mote_host_light_free(light), mote_host_light_free(NULL);
}

/* A square of radiance 1 above a square: Howell's catalogue, B-3, and the area that crosses. */
static void test_triangles(void) {
    static const float corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1};
    static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6};
    static const float radiance[] = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1}, up[3] = {0, 0, 1};
    const mote_receiver below = {{0.5f, 0.5f, 0.01f}, {0, 0, 1}, 0};
    const double p = sqrt(1.25), closed_form = 4 * 0.5 / p * atan(0.5 / p);
    mote_bundle_link links[4];
    size_t count = 0, i;
    double area = 0;
    float irradiance[3];
    mote_micro_options options;
    memset(&options, 0, sizeof options);
    options.struct_size = sizeof options;
    options.mesh.positions = corners, options.mesh.position_count = 8;
    options.mesh.triangles = triangles, options.mesh.triangle_count = 4;
    options.radiance = radiance, options.points = 8000, options.side = 32, options.passes = 4;
    CHECK(mote_micro_irradiance(&options, &below, 1, irradiance) == MOTE_OK);
    CHECK(irradiance[1] > 0.99 * closed_form && irradiance[1] < 1.2 * closed_form); /* discs at the edge */
    options.radiance = NULL;
    CHECK(mote_micro_irradiance(&options, &below, 1, irradiance) == MOTE_INVALID_ARGUMENT);
    CHECK(mote_bundle_links(&options.mesh, up, 0.01, NULL, links, 4, &count) == MOTE_OK);
    CHECK(count >= 2 && count <= 4); /* rays on the diagonals may meet either triangle */
    for (i = 0; i < count; ++i) area += links[i].area;
    CHECK(fabs(area - 1) < 0.04 && links[0].from < 2 && links[0].to >= 2);
    CHECK(mote_bundle_links(&options.mesh, up, 0.01, NULL, NULL, 0, &count) == MOTE_OK);
    CHECK(mote_bundle_links(&options.mesh, up, 0.0, NULL, links, 4, &count) == MOTE_INPUT_ERROR);
    CHECK(mote_bundle_links(NULL, up, 0.01, NULL, links, 4, &count) == MOTE_INVALID_ARGUMENT);
}

/* Memory of this process. */
typedef struct memory {
    long in_use; /* handed out by malloc [B] */
    long held;   /* resident, but for what malloc keeps free: an arena grows once where two tasks meet [B] */
} memory;

static memory memory_now(void) {
    const struct mallinfo2 of_malloc = mallinfo2();
    long all = 0, resident = 0;
    memory now;
    FILE* file = fopen("/proc/self/statm", "r");
    CHECK(file && fscanf(file, "%ld %ld", &all, &resident) == 2);
    if (file) fclose(file);
    now.in_use = (long)(of_malloc.uordblks + of_malloc.hblkhd);
    now.held = resident * sysconf(_SC_PAGESIZE) - (long)of_malloc.fordblks;
    return now;
}

/* Renders, loaded anew each time: the last three hundred leave less than 32 bytes each. */
static void test_leaks(void) {
    memory before = {0, 0}, after;
    int i;
    for (i = 0; i < 400; ++i) {
        mote_scene* scene = loaded(small_scene, NULL);
        mote_picture* picture = mote_picture_new();
        const mote_render_options options = passes(1);
        CHECK(mote_render(scene, &options, picture) == MOTE_OK);
        mote_scene_free(scene);
        mote_picture_free(picture);
        if (i == 99) before = memory_now();
    }
    after = memory_now();
    printf("300 renders leave %ld bytes in use, and %ld held\n", after.in_use - before.in_use,
           after.held - before.held);
#if !defined(MOTE_SANITIZED)
    CHECK(after.in_use - before.in_use < 300 * 32);
    CHECK(after.held - before.held < 70 * 4096L);
#endif
}

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    test_version();
    test_render();
    test_errors();
    test_cancel();
    test_seconds();
    test_threads();
    test_bits(argv[1], argv[2]);
    test_arrays();
    test_extremes();
#if !defined(MOTE_SANITIZED)
    test_memory();
#endif
    test_files_of_others(argv[2]);
    test_algorithms();
    test_sequence();
    test_epipolar();
    test_light_tree();
    test_upsample();
    test_count_visible();
    test_host_light();
    test_triangles();
    test_leaks();
    printf("%d checks, %d failures\n", checks, failures);
    return failures > 0;
}
