/* method.h - the one interface of all algorithms.
 *
 * A new method is one folder and one line in registry.c.  Its parameter table is the only place of
 * a tunable: it makes the flags, the help, the defaults and the metadata.  Methods never include
 * each other; what two of them need moves down (docs/adding-a-method.md). */
#ifndef ASSAY_METHODS_METHOD_H
#define ASSAY_METHODS_METHOD_H

#include "assay/render.h"
#include "io/bundle.h"
#include "io/film.h"
#include "trace/world.h"

/* What is looked at. */
typedef struct {
    assay_context      *context;
    const assay_world  *world;
    const assay_camera *camera; /* NULL for probes */
    int                 width, height;
    uint64_t            seed;
    assay_layer_set     layers;
    assay_bundle       *dump; /* where a method puts its stages, or NULL */
    /* Frames before this one that the state rendered of this very world with this seed: what it
     * knows of the light still holds, whatever the camera.  0: the world that it knew, if any, is
     * gone, and nothing of it may be touched. */
    uint64_t frames_before;
    double   since; /* s: time of the first of them, or of this one                              */
    bool     last;  /* the state is destroyed after this frame: what is to be saved is saved now  */
} assay_frame;

/* Points at which irradiance is asked. */
typedef struct {
    size_t            count;
    const assay_vec3 *positions; /* m    */
    const assay_vec3 *normals;   /* unit */
} assay_probe_points;

typedef struct {
    const char             *name;
    const char             *summary;
    const assay_param_desc *params;
    bool keeps_light; /* an image depends on those before it, while nothing but the camera moves */

    assay_status (*create)(assay_context *context, const assay_params *params, void **state_out);
    /* Once a frame, before render or probe.  The scene is the same for all frames of a state, but
     * not its time. */
    assay_status (*prepare)(void *state, const assay_frame *frame);
    assay_status (*render)(void *state, const assay_frame *frame, assay_film *film,
                           assay_ray_counts *counts);
    /* rows: probe_columns(state) doubles a point, as assay_probe_column_name names them; zeros when
     * the call begins.  NULL: the method has no probes. */
    assay_status (*probe)(void *state, const assay_frame *frame, const assay_probe_points *points,
                          double *rows, assay_ray_counts *counts);
    int (*probe_columns)(const void *state);
    void (*destroy)(void *state);
} assay_method;

#endif
