/* mote: many-light rendering and participating media, from C (C99).
 *
 * Handles are opaque and hold the text of their last error. Every function that can fail returns a
 * mote_status; where it is not MOTE_OK, mote_scene_error() or mote_picture_error() says why, with the file
 * and line where there is one.
 *
 * Structures of options begin with `struct_size`, their sizeof in the caller's header; all other members may
 * be zero and then have their default:
 *
 *     mote_render_options options = {0};
 *     options.struct_size = sizeof options;
 *
 * Texts are UTF-8, ended by a zero; those that are returned belong to the handle and live until its next
 * call. Buffers belong to the caller. Pictures are row by row from the top, the channels of a pixel side by
 * side, float32: light in W/(m^2 sr), lengths in metres. A handle may be used by one thread at a time; a
 * scene that is loaded may be rendered by several at once. No C++ exception leaves the library, and no
 * callback may throw one.
 */
#ifndef MOTE_H
#define MOTE_H

#include <stddef.h>
#include <stdint.h>

#define MOTE_VERSION_MAJOR 0
#define MOTE_VERSION_MINOR 1
#define MOTE_VERSION_PATCH 0
#define MOTE_VERSION_NUMBER (MOTE_VERSION_MAJOR * 1000000 + MOTE_VERSION_MINOR * 1000 + MOTE_VERSION_PATCH)

#if defined(__GNUC__)
#define MOTE_API __attribute__((visibility("default")))
#else
#define MOTE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum mote_status {
    MOTE_OK = 0,
    MOTE_INVALID_ARGUMENT = 1, /* a null pointer, a struct_size that is none, a number out of range */
    MOTE_INPUT_ERROR = 2,      /* a scene, a file or a picture is at fault: file and line say where */
    MOTE_BUFFER_TOO_SMALL = 3,
    MOTE_OUT_OF_MEMORY = 4,
    MOTE_INTERNAL_ERROR = 5
} mote_status;

typedef struct mote_scene mote_scene;
typedef struct mote_picture mote_picture;

/* ---- the library
 * -------------------------------------------------------------------------------------------- */

MOTE_API const char* mote_version(void); /* "0.1.0" */
MOTE_API int mote_version_number(
    void); /* MOTE_VERSION_NUMBER of the library, to be held against the header's */
MOTE_API const char* mote_status_name(mote_status status); /* "MOTE_OK"; never null */

/* ---- scenes
 * ------------------------------------------------------------------------------------------------- */

typedef struct mote_load_options {
    size_t struct_size;
    const char* integrator; /* this type instead of the scene's, such as "mote_vpl"; null: its own */
    const char* const*
        define_names; /* as -D NAME=VALUE of the command: $parameters of the scene file, and paths */
    const char* const* define_values; /* such as "integrator.paths" */
    size_t define_count;
    int lenient; /* not 0: leave out or approximate what is wrong, and say so as a warning */
    const char*
        folder; /* for scenes of text or of arrays: where relative file names are looked up; null: here */
    const char* name; /* of such a scene, in messages; null: "<string>", or "scene" */
} mote_load_options;

/* Never null but where memory is out. */
MOTE_API mote_scene* mote_scene_new(void);
/* Null is allowed. Pictures that were rendered from it stay. */
MOTE_API void mote_scene_free(mote_scene* scene);

/* A scene file (docs/scene-format.md), glTF, GLB or pbrt; or its text. `options` may be null. A scene that
 * was loaded before is replaced if this succeeds. */
MOTE_API mote_status mote_scene_load_file(mote_scene* scene, const char* path,
                                          const mote_load_options* options);
MOTE_API mote_status mote_scene_load_text(mote_scene* scene, const char* xml,
                                          const mote_load_options* options);

/* What is wrong: the first of the errors; "" where the last call went well. */
MOTE_API const char* mote_scene_error(const mote_scene* scene);
MOTE_API const char* mote_scene_error_file(const mote_scene* scene); /* "" where there is none */
MOTE_API int mote_scene_error_line(const mote_scene* scene);         /* from 1; 0 where there is none */
/* All that is wrong with a scene, in the order of its files; null beyond the last. */
MOTE_API size_t mote_scene_error_count(const mote_scene* scene);
MOTE_API const char* mote_scene_error_at(const mote_scene* scene, size_t index);

/* Of a scene that is loaded: zero, "" or null where none is. */
MOTE_API int mote_scene_width(const mote_scene* scene);
MOTE_API int mote_scene_height(const mote_scene* scene);
MOTE_API size_t mote_scene_warning_count(const mote_scene* scene);
MOTE_API const char* mote_scene_warning(const mote_scene* scene, size_t index);
/* What will run, with the reason for every choice, as `mote plan` prints it. */
MOTE_API const char* mote_scene_plan(mote_scene* scene);

/* ---- scenes from arrays
 * ------------------------------------------------------------------------------------- */
/* A scene is written down object by object, in the words of the scene language, and then built:
 *
 *     mote_scene_add_mesh(scene, "floor", &mesh);
 *     mote_scene_begin(scene, "shape", "arraymesh", NULL, NULL);
 *       mote_scene_set_string(scene, "array", "floor");
 *       mote_scene_begin(scene, "bsdf", "diffuse", NULL, NULL);
 *         mote_scene_set_rgb(scene, "reflectance", 0.8, 0.8, 0.8);
 *       mote_scene_end(scene);
 *     mote_scene_end(scene);
 *     ... sensor, emitters ...
 *     mote_scene_build(scene, NULL);
 *
 * Materials, lights, cameras, media and integrators are those of the scene language; `arraymesh` replaces a
 * mesh and `arraygrid` for a grid of the host, and "vdbvolume" with "filename" reads a .vdb file. What is
 * written down is used up by mote_scene_build(), whether it succeeds or not. */

typedef struct mote_mesh {
    size_t struct_size;
    const float* positions; /* [vertex][3], in metres */
    const float* normals;   /* [vertex][3], or null: computed, unless face_normals is set on the shape */
    const float* uvs;       /* [vertex][2], or null */
    size_t vertex_count;
    const uint32_t* triangles; /* [triangle][3] */
    size_t triangle_count;
} mote_mesh;

typedef struct mote_grid {
    size_t struct_size;
    const float* values;      /* [z][y][x][channel], not negative */
    int width, height, depth; /* voxels along x, y, z */
    int channels;             /* 1 or 3; 0 is 1 */
    float lower[3], upper[3]; /* its box, where the volume says use_grid_bbox; else it fills the unit cube */
} mote_grid;

/* The arrays are copied. `name` is what `array` names. */
MOTE_API mote_status mote_scene_add_mesh(mote_scene* scene, const char* name, const mote_mesh* mesh);
MOTE_API mote_status mote_scene_add_grid(mote_scene* scene, const char* name, const mote_grid* grid);
/* Opens and closes an object: `kind` is "shape", "bsdf", "emitter", "sensor", "medium", ... `name` (what it
 * is to the object around it) and `id` (for mote_scene_refer) may be null. */
MOTE_API mote_status mote_scene_begin(mote_scene* scene, const char* kind, const char* type, const char* name,
                                      const char* id);
MOTE_API mote_status mote_scene_end(mote_scene* scene);
/* Parameters of the object that is open. */
MOTE_API mote_status mote_scene_set_float(mote_scene* scene, const char* name, double value);
MOTE_API mote_status mote_scene_set_integer(mote_scene* scene, const char* name, int64_t value);
MOTE_API mote_status mote_scene_set_boolean(mote_scene* scene, const char* name, int value);
MOTE_API mote_status mote_scene_set_string(mote_scene* scene, const char* name, const char* value);
MOTE_API mote_status mote_scene_set_rgb(mote_scene* scene, const char* name, double r, double g, double b);
MOTE_API mote_status mote_scene_set_point(mote_scene* scene, const char* name, double x, double y, double z);
MOTE_API mote_status mote_scene_set_vector(mote_scene* scene, const char* name, double x, double y, double z);
/* 16 numbers, row by row, acting on column vectors. */
MOTE_API mote_status mote_scene_set_transform(mote_scene* scene, const char* name, const double* rows);
/* The object with this id. */
MOTE_API mote_status mote_scene_refer(mote_scene* scene, const char* id, const char* name);
MOTE_API mote_status mote_scene_build(mote_scene* scene, const mote_load_options* options);

/* ---- rendering
 * ---------------------------------------------------------------------------------------------- */

typedef struct mote_progress {
    size_t struct_size;
    uint32_t passes;        /* so far, those of a checkpoint included */
    uint32_t passes_wanted; /* 0: not limited */
    double seconds;
    double seconds_left; /* below 0: not known */
    double noise;        /* relative error of the picture so far; infinity: not known */
} mote_progress;

typedef struct mote_render_options {
    size_t struct_size;
    /* The first rule that holds ends the render; 0: no such rule. Without any: the film's sample_count of
     * passes. */
    uint32_t passes;
    double seconds; /* from the call on */
    double noise;   /* relative, such as 0.02 */
    uint64_t seed;
    int threads;             /* 0: one for every core */
    int auxiliary;           /* not 0: also positions, normals, depth, albedo */
    const char* denoise;     /* "oidn" or "bmfr": adds the layer "denoised"; null: none */
    const char* checkpoint;  /* file; null: none. Refused where something else stands there */
    double checkpoint_every; /* [s]; 0: 60 */
    int resume;              /* not 0: continue from the checkpoint */
    /* Called in the thread of mote_render(), twenty times a second at most; each may be null. */
    void* user;
    void (*progress)(void* user, const mote_progress* progress);
    int (*cancelled)(void* user); /* not 0: stop within two seconds, and keep what there is */
    void (*preview)(void* user, int width, int height,
                    const float* rgb); /* the picture so far, now and then */
} mote_render_options;

/* Never null but where memory is out. */
MOTE_API mote_picture* mote_picture_new(void);
MOTE_API void mote_picture_free(mote_picture* picture); /* null is allowed */

/* Renders into `picture`, whose layers it replaces; errors are the picture's. Scene, seed and passes
 * determine every bit, whatever the number of threads. A render that was cancelled is MOTE_OK:
 * mote_picture_interrupted() reports it, and mote_picture_passes() what there is. */
MOTE_API mote_status mote_render(const mote_scene* scene, const mote_render_options* options,
                                 mote_picture* picture);

MOTE_API const char* mote_picture_error(const mote_picture* picture);
MOTE_API const char* mote_picture_error_file(const mote_picture* picture);
MOTE_API int mote_picture_error_line(const mote_picture* picture);

/* ---- pictures
 * ----------------------------------------------------------------------------------------------- */

MOTE_API int mote_picture_width(const mote_picture* picture);
MOTE_API int mote_picture_height(const mote_picture* picture);
MOTE_API uint32_t mote_picture_passes(const mote_picture* picture);
MOTE_API int mote_picture_interrupted(const mote_picture* picture);
MOTE_API double mote_picture_noise(const mote_picture* picture); /* infinity: not known */
MOTE_API const char* mote_picture_statistics(
    const mote_picture* picture); /* JSON; "" where it was not rendered */
MOTE_API size_t mote_picture_warning_count(const mote_picture* picture);
MOTE_API const char* mote_picture_warning(const mote_picture* picture, size_t index);
/* An entry of the metadata, such as "seed" or "worldToCamera"; null where there is none. */
MOTE_API const char* mote_picture_metadata(const mote_picture* picture, const char* name);

/* Layers by index and name: "beauty", then "direct", "Depth", "Variance", ... */
MOTE_API size_t mote_picture_layer_count(const mote_picture* picture);
MOTE_API const char* mote_picture_layer_name(const mote_picture* picture,
                                             size_t index); /* null beyond the last */
MOTE_API int mote_picture_layer_channels(const mote_picture* picture,
                                         const char* layer); /* 0: there is no such layer */
/* Fills [height][width][channels]; `count` floats have room in `values`. */
MOTE_API mote_status mote_picture_read(mote_picture* picture, const char* layer, float* values, size_t count);
/* Adds a layer, or replaces it, of 1 or 3 channels. The first one decides the picture's size. 3 channels are
 * X, Y, Z of layers that hold vectors (P, N, Ns, PreviousP, MotionVector, and what ends in .P, .N, ...), else
 * R, G, B; one is Y. */
MOTE_API mote_status mote_picture_write(mote_picture* picture, const char* layer, int width, int height,
                                        int channels, const float* values);
MOTE_API mote_status mote_picture_set_metadata(mote_picture* picture, const char* name, const char* value);

/* OpenEXR files. `half` not 0: float16. */
MOTE_API mote_status mote_picture_load(mote_picture* picture, const char* path);
MOTE_API mote_status mote_picture_save(mote_picture* picture, const char* path, int half);

/* ---- algorithms on pictures, of whatever renderer
 * ----------------------------------------------------------- */

typedef struct mote_ssbc_options {
    size_t struct_size;
    double bound;        /* of the geometry term [1/m^2]; 0: as the picture's metadata says */
    int steps;           /* how often light is carried on; 0: 2 */
    int flat;            /* not 0: sum over all pixels, exact and slow */
    int half_resolution; /* not 0: gather at one pixel of four */
    double blur;         /* standard deviation of an edge-preserving blur [pixels] */
    int replace;         /* not 0: take out the compensation that the picture holds */
} mote_ssbc_options;

/* Screen-space bias compensation (docs/methods/compensation.md): adds what a bound took to the beauty, and as
 * the layer "compensation_surface". The picture holds beauty, P, N and DiffuseAlbedo (or those of Center),
 * and the metadata "worldToCamera" unless positions are in camera space. `options` may be null. */
MOTE_API mote_status mote_picture_compensate(mote_picture* picture, const mote_ssbc_options* options);

/* Adds the layer "denoised": `method` is "bmfr" (regression on features) or "oidn" (where it is installed).
 * Uses the layers Albedo, Ns, P, Depth, Variance where the picture has them. `threads` 0: one for every core.
 */
MOTE_API mote_status mote_picture_denoise(mote_picture* picture, const char* method, int threads);

/* The frames of a sequence, by regression and by what earlier frames show of the same places
 * (docs/methods/denoising.md). */
typedef struct mote_sequence mote_sequence;
MOTE_API mote_sequence* mote_sequence_new(void);           /* never null but where memory is out */
MOTE_API void mote_sequence_free(mote_sequence* sequence); /* null is allowed */
/* Adds the layer "denoised" to the next frame; errors are the picture's. Frames have one size and the same
 * layers. What moved is known from the layer "MotionVector", else from P and the metadata "worldToCamera";
 * without either no frame takes anything from those before. */
MOTE_API mote_status mote_sequence_denoise(mote_sequence* sequence, mote_picture* frame);

typedef struct mote_metrics {
    size_t struct_size;
    double error;                /* relative, see docs/testing.md */
    double error_standard_error; /* NaN where the reference's variance is not known */
    double bias, bias_standard_error;
    double noise; /* what the image's own variance explains of the error; NaN where it is not known */
    double mse, rmse, mae, mape, smape, rel_mse, rel_mse_trimmed, mrse, ssim;
    double mean_image, mean_reference; /* over pixels and channels */
    uint64_t non_finite;               /* pixels with a NaN or an infinity in either */
} mote_metrics;

/* `image` and `reference`: [height][width][3]; their variances (of the mean) likewise, or null. */
MOTE_API mote_status mote_compare(const float* image, const float* reference, int width, int height,
                                  const float* image_variance, const float* reference_variance,
                                  mote_metrics* metrics);

/* ---- algorithms over the camera and the lights of another renderer
 * ------------------------------------------ */

typedef struct mote_epipolar_options {
    size_t struct_size;
    int width, height;
    const float* depth;  /* [height][width], along the camera's axis [m]; not above 0, or not finite: nothing
                            is there */
    double far_distance; /* [m] along rays that meet nothing: where they end; above 0 */
    double focal_length; /* of a pinhole camera [pixels] */
    double centre_x, centre_y; /* where its axis meets the picture [pixels]; both 0: in the middle */
    double lamp[3];            /* in camera space: x right, y down, z forward [m] */
    int lines;                 /* around the whole border; 0: 512 */
    int samples;               /* of a line before it is refined; 0: 16 */
    double tolerance;          /* of interpolation, relative; 0: 0.05 */
    void* user;
    /* The light of the lamp that is scattered into the ray through the place (x, y) of the picture [pixels;
     * the middle of the first pixel is (0.5, 0.5)] before `distance` [m]: radiance [W/(m^2 sr)]. In the
     * thread of mote_epipolar(). */
    void (*march)(void* user, double x, double y, double distance, float radiance[3]);
} mote_epipolar_options;

/* Epipolar sampling (docs/methods/epipolar.md): light that media scatter once, over a whole picture, from few
 * rays that `march` is called for. Fills light [height][width][3], room for `count` floats; `marched` (may be
 * null): calls of `march`. */
MOTE_API mote_status mote_epipolar(const mote_epipolar_options* options, float* light, size_t count,
                                   uint64_t* marched);

typedef struct mote_upsample_options {
    size_t struct_size;
    int width, height;
    double focal_length;   /* of a pinhole camera at the origin [pixels] */
    const float* position; /* [height][width][3], of first surfaces, in camera space [m]; not finite: none */
    const float* normal;   /* [height][width][3], unit, towards the camera */
    const float* albedo;   /* [height][width][3], what light is interpolated without; null: 1 everywhere */
    int spacing;           /* one pixel of so many is shaded, in both directions */
    void* user;
    /* Radiance of the pixel in column x and row y. In the thread of mote_upsample(). */
    void (*shade)(void* user, int x, int y, float radiance[3]);
} mote_upsample_options;

/* Bilateral upsampling: light of all pixels from those of a lattice, and of those that no neighbour fits.
 * Fills light [height][width][3], room for `count` floats; `shaded` (may be null): calls of `shade`. */
MOTE_API mote_status mote_upsample(const mote_upsample_options* options, float* light, size_t count,
                                   uint64_t* shaded);

#define MOTE_NO_ITEM 0xffffffffu /* a pixel that shows no item */
typedef struct mote_visibility_query {
    uint32_t item;
    int x0, y0, x1, y1; /* pixels x0 <= x < x1, y0 <= y < y1 */
} mote_visibility_query;

/* Visibility queries (docs/methods/visibility.md): of items [height][width], below `item_count` or
 * MOTE_NO_ITEM, how many pixels of an item lie in a rectangle, for each query. */
MOTE_API mote_status mote_count_visible(const uint32_t* items, int width, int height, uint32_t item_count,
                                        const mote_visibility_query* queries, size_t query_count,
                                        uint32_t* pixels);

/* A hierarchy over lights, of which one is sampled for a receiver in proportion to what it may contribute,
 * unoccluded (Estevez and Kulla 2018). */
typedef struct mote_light_tree mote_light_tree;
typedef struct mote_light {
    float lower[3], upper[3]; /* a box that holds it [m] */
    float normal[3];          /* unit: it shines within a right angle of this; zero: to all sides */
    double intensity;         /* along the normal, mean of the channels [W/sr]; above 0 */
} mote_light;

/* The lights are copied. Null, with the reason in `status` (which may be null), where there are none or more
 * than 2^28, or one of them cannot be. */
MOTE_API mote_light_tree* mote_light_tree_new(const mote_light* lights, size_t count, mote_status* status);
MOTE_API void mote_light_tree_free(mote_light_tree* tree); /* null is allowed */
/* A light sampled by u in [0, 1), and the probability of that sample. `normal`: unit, on the side from which
 * light counts; null: from all sides. Several threads may call it at once. */
MOTE_API mote_status mote_light_tree_sample(const mote_light_tree* tree, const float position[3],
                                            const float normal[3], double u, size_t* light,
                                            double* probability);
/* Of mote_light_tree_sample() sampling this light; over all lights they sum to 1. NaN for arguments that
 * cannot be. */
MOTE_API double mote_light_tree_probability(const mote_light_tree* tree, const float position[3],
                                            const float normal[3], size_t light);

/* ---- many-light methods over the rays of another renderer -------------------------------------------------
 */

typedef struct mote_segment {
    float origin[3], direction[3]; /* [m]; unit */
    float length;                  /* [m], infinity for a ray */
} mote_segment;
typedef struct mote_hit {
    float distance;    /* from the origin, above 0 [m] */
    float normal[3];   /* geometric, unit, on either side */
    uint32_t material; /* below mote_host_options::material_count */
} mote_hit;
typedef struct mote_lamp { /* shines to all sides */
    double position[3];    /* [m] */
    float intensity[3];    /* [W/sr] */
} mote_lamp;
typedef struct mote_receiver { /* a place on a surface, seen along its normal */
    float position[3], normal[3];
    uint32_t material;
} mote_receiver;

typedef struct mote_host_options {
    size_t struct_size;
    const float* reflectance; /* [material_count][3], of diffuse materials, both sides alike, in [0, 1] */
    size_t material_count;
    const mote_lamp* lamps;
    size_t lamp_count;
    float lower[3], upper[3];           /* a box that holds all surfaces and lamps [m] */
    float scattering[3], absorption[3]; /* of fog that fills all space [1/m] */
    double anisotropy;                  /* mean cosine of scattering in fog, in (-1, 1) */
    void* user;
    /* The closest surface on a segment; returns 0 where there is none. From many threads at once. */
    int (*first_hit)(void* user, const mote_segment* segment, mote_hit* hit);
    /* For shadow rays, may be null: sets hidden[i], which is 0, to 1 where a surface is on segment i. From
     * many threads at once. */
    void (*find_occluded)(void* user, const mote_segment* segments, size_t count, unsigned char* hidden);
} mote_host_options;

typedef struct mote_host_light_options {
    size_t struct_size;
    const char* method; /* "vpl" (also null), "ray_lights" (in fog), "photon_map" */
    const char*
        selection;  /* of VPLs: a type of the scene reference, such as "stochastic_lightcuts"; null: all */
    uint32_t paths; /* light paths; 0: 1024 */
    double bound;   /* of the geometry term of VPLs [1/m^2]; 0: none */
    int compensation_steps; /* of the light that the bound takes from VPLs; -1: exact */
    uint32_t neighbours;    /* photons of an estimate; 0: 50 */
    uint64_t seed;
} mote_host_light_options;

/* Indirect light in a scene of the host: one set of light paths, any number of receivers. */
typedef struct mote_host_light mote_host_light;
MOTE_API mote_host_light* mote_host_light_new(void);        /* never null but where memory is out */
MOTE_API void mote_host_light_free(mote_host_light* light); /* null is allowed */
MOTE_API const char* mote_host_light_error(const mote_host_light* light); /* of the last call that failed */
/* Traces the light paths, in parallel. The options are copied; `user` must live as long as the handle. */
MOTE_API mote_status mote_host_light_trace(mote_host_light* light, const mote_host_options* scene,
                                           const mote_host_light_options* options);
MOTE_API size_t
mote_host_light_size(const mote_host_light* light); /* VPLs, ray lights with VPLs, or photons */
/* radiance [count][3]: what each receiver reflects along its normal [W/(m^2 sr)], without what reaches it
 * straight from lamps. Receivers that follow each other should be near each other. */
MOTE_API mote_status mote_host_light_reflect(mote_host_light* light, const mote_receiver* receivers,
                                             size_t count, float* radiance);

/* Fronts, from which the corners run counter-clockwise, send and receive light; backs hide it. */
typedef struct mote_triangles {
    const float* positions; /* [position_count][3] [m] */
    size_t position_count;
    const uint32_t* triangles; /* [triangle_count][3], indices into positions */
    size_t triangle_count;
} mote_triangles;

typedef struct mote_micro_options {
    size_t struct_size;
    mote_triangles mesh;
    const float* radiance; /* [triangle_count][3], of each front [W/(m^2 sr)] */
    uint32_t points;       /* that represent the surfaces; 0: 65536 */
    uint32_t side;         /* texels of a buffer, at most 256; 0: 16 */
    uint32_t passes;       /* buffers of a receiver; 0: 1 */
    uint64_t seed;
} mote_micro_options;

/* Micro-buffers (docs/methods/micro_rendering.md): irradiance [count][3] of the receivers [W/m^2]. Their
 * materials do not count. */
MOTE_API mote_status mote_micro_irradiance(const mote_micro_options* options, const mote_receiver* receivers,
                                           size_t count, float* irradiance);

typedef struct mote_bundle_link { /* two triangles whose fronts see each other along a bundle */
    uint32_t from, to;            /* along the direction */
    double area;                  /* perpendicular to the direction, by the rays that link them [m^2] */
} mote_bundle_link;

/* A global ray-bundle (docs/methods/ray_bundles.md): all links along a direction, of parallel rays `spacing`
 * [m] apart. `offset`: of the rays, in [0, 1)^2 of the spacing; uniform, areas have no bias; null: the
 * middle. `count`: all links, of which the first `room` are written to `links`. */
MOTE_API mote_status mote_bundle_links(const mote_triangles* mesh, const float direction[3], double spacing,
                                       const float offset[2], mote_bundle_link* links, size_t room,
                                       size_t* count);

#ifdef __cplusplus
}
#endif

#endif /* MOTE_H */
