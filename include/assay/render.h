/* render.h - methods, and images and probes made with them. */
#ifndef ASSAY_RENDER_H
#define ASSAY_RENDER_H

#include <stdint.h>

#include "assay/array.h"
#include "assay/context.h"
#include "assay/image.h"
#include "assay/params.h"
#include "assay/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- methods ---- */

typedef struct {
    const char             *name;    /* "path"                     */
    const char             *summary; /* one sentence               */
    const assay_param_desc *params;  /* ends with a NULL name      */
} assay_method_info;

/* Count of methods, and the i-th in the order of the registry. */
ASSAY_API int               assay_method_count(void);
ASSAY_API assay_method_info assay_method_at(int index);
/* Parameters of a method at their defaults.  Errors: ARGUMENT (no such method; the message lists
 * them), MEMORY. */
ASSAY_API assay_status assay_method_params(assay_context *context, const char *method,
                                           assay_params **params_out);
/* Methods and parameter tables as JSON: all, or the one named.  Release with assay_text_destroy. */
ASSAY_API assay_status assay_methods_json(assay_context *context, const char *method,
                                          char **text_out);

/* ---- images ---- */

typedef struct {
    int width, height;  /* pixels, 1 to ASSAY_IMAGE_MAX_SIDE each, and at most
                           ASSAY_RENDER_MAX_PIXELS in all                                */
    const char *camera; /* name or decimal index; NULL: the first; a scene without one
                           is framed by a camera of its own                               */
    uint64_t    seed;   /* of the random numbers                                         */
    const char *layers; /* comma-separated groups "color,gbuffer,split,irradiance" or
                           "all"; NULL: "all".  See docs/methods/path.md                 */
    const char *dump;   /* folder to make for the stages, a bundle (docs/bundle.md), or
                           NULL; must not be there yet                                   */
} assay_render_options;

/* Defaults: 512 x 512, first camera, seed 0, all layers. */
ASSAY_API assay_render_options assay_render_options_default(void);

/* What became of the error that a method was to go on to. */
typedef enum {
    ASSAY_TARGET_NONE,    /* none was asked for                                 */
    ASSAY_TARGET_REACHED, /* it was reached                                     */
    ASSAY_TARGET_MISSED   /* the method gave up before, and said so in a warning */
} assay_error_target;

/* What a render did.  Counts are exact and the same on every machine; seconds are not. */
typedef struct {
    uint64_t camera_rays, scatter_rays, shadow_rays; /* rays traced, by kind                      */
    uint64_t samples; /* camera paths                                              */
    uint64_t records; /* of caches, made or loaded                                           */
    uint64_t lost; /* contributions of records to pixels that splat's bounds=published left out */
    uint64_t spp_min, spp_max; /* over pixels                                               */
    double   relative_error;   /* mean over pixels of the standard error of the pixel's
                                  luminance / the image's mean luminance; NaN where it is not
                                  known: one sample a pixel, no layer group color, probes   */
    assay_error_target target;
    double seconds_build, seconds_render; /* wall                                                */
    uint64_t peak_memory; /* bytes, of the process                                     */
    uint64_t bvh_bytes, geometry_bytes, texture_bytes;
    int      threads;
} assay_render_stats;

/* Renders the scene at its current time: a sequence of one image.  stats_out may be NULL.  Memory
 * for all pixels is asked for before the work begins.  Errors: ARGUMENT, MEMORY, LIMIT, WRITE (the
 * dump), DOMAIN (light that is no finite number), CANCELLED. */
ASSAY_API assay_status assay_render(assay_scene *scene, const char *method,
                                    const assay_params *params, const assay_render_options *options,
                                    assay_image **image_out, assay_render_stats *stats_out);

/* Frames of a scene, one after another, by one method: what the method learned of the light stays
 * as long as nothing but cameras moves (caches keep their records, and the tree of triangles is
 * kept), and is dropped when a triangle or a light does.  So an image may depend on those before
 * it; how is told by the method's page. */
typedef struct assay_sequence assay_sequence;

/* The scene and the parameters must outlive it, and only the scene's time may change.  Errors:
 * ARGUMENT, MEMORY. */
ASSAY_API assay_status assay_sequence_create(assay_scene *scene, const char *method,
                                             const assay_params *params,
                                             assay_sequence    **sequence_out);
/* The next image, of the scene's current time, as by assay_render; last: none comes after it, so
 * that what is kept to the end is written now.  After an error the sequence may only be destroyed.
 */
ASSAY_API assay_status assay_sequence_render(assay_sequence             *sequence,
                                             const assay_render_options *options, bool last,
                                             assay_image       **image_out,
                                             assay_render_stats *stats_out);
ASSAY_API void         assay_sequence_destroy(assay_sequence *sequence);

/* Irradiance at points.  points: rows of x y z nx ny nz (m; normals are normalised).  The result
 * has a row a point; its columns are named by assay_probe_column_name. Gradients are
 * differences with common random numbers, central but along the normal, where they are one-sided
 * (docs/methods/path.md; a warning where steps are too short for their variances). Errors: ARGUMENT
 * (columns other than 6, a zero normal), DOMAIN (not finite), UNSUPPORTED (the method has no
 * probes), MEMORY, CANCELLED. */
ASSAY_API assay_status assay_render_probes(assay_scene *scene, const char *method,
                                           const assay_params *params, uint64_t seed,
                                           const assay_array *points, assay_array **result_out,
                                           assay_render_stats *stats_out);
/* Columns of a probe's result: 18 plain ones ("E.R", "E.G", "E.B", "Variance.E.R", ..., then
 * "EDirect" and "EIndirect" likewise), and with gradients 36 more ("dE/dx.R": W/m3, "dE/dax.R":
 * W/(m2 rad) about the x axis, ..., each with its variance). */
#define ASSAY_PROBE_COLUMNS_PLAIN 18
#define ASSAY_PROBE_COLUMNS 54
/* The name of a column.  False, and name_out untouched, outside [0, ASSAY_PROBE_COLUMNS). */
ASSAY_API bool assay_probe_column_name(int column, char name_out[32]);

#ifdef __cplusplus
}
#endif
#endif
