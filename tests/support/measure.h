/* measure.h - renders and probes in one call, and whether a measured value is an expected one. */
#ifndef ASSAY_TESTS_MEASURE_H
#define ASSAY_TESTS_MEASURE_H

#include "assay/render.h"

/* A value with the standard error of its mean. */
typedef struct {
    double value, error;
} measured;

/* A parameter by name and value, "seed", or "method" (path without it); lists end with {NULL,
 * NULL}. */
typedef struct {
    const char *name, *value;
} setting;

assay_context *measure_context(int threads);

/* Renders width x height with a method's settings; fails the test on any error. */
assay_image *measure_render(assay_scene *scene, const setting *settings, int width, int height,
                            const char *layers);

/* Mean over all pixels of a channel ("R", "Irradiance.G"), its error from "Variance.". */
measured measure_mean(const assay_image *image, const char *channel);

/* Sum over all pixels of |a - b| of a channel of two images of the same size. */
double measure_difference(const assay_image *a, const assay_image *b, const char *channel);

/* Probes at rows of x y z nx ny nz. */
assay_array *measure_probes(assay_scene *scene, const setting *settings, const double *points,
                            int count);
/* A named column of a probe's row, with its "Variance." column. */
measured measure_probe(const assay_array *result, int row, const char *column);

/* Whether the value is the expected one within `sigmas` standard errors and `slack` (absolute: what
 * a closed form leaves out, such as tessellation or a finite difference). */
bool measure_agrees(measured m, double expected, double sigmas, double slack);

/* Fails unless it agrees within 5 standard errors and slack, and unless the same check refuses
 * `mutant`, the value that a typical mistake would give: so the check is sharp enough to see it. */
void measure_check(const char *what, measured m, double expected, double slack, double mutant);

/* Folder of the shared scenes, or NULL: $ASSAY_SHARED_SCENES, else ../shared/scenes. */
const char *measure_shared_scenes(void);

#endif
