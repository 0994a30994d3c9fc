/* run.h - what an image and a set of probes have in common: find the method, build the world, run.
 */
#ifndef ASSAY_METHODS_RUN_H
#define ASSAY_METHODS_RUN_H

#include "methods/method.h"

/* Errors: ARGUMENT, with a message that lists the methods there are. */
assay_status assay_run_find(assay_context *context, const char *name,
                            const assay_method **method_out);

/* The world of the scene's current time, and how long it took. */
assay_status assay_run_build(const assay_scene *scene, assay_world **world_out,
                             assay_render_stats *stats);

/* Makes the method's state, prepares it, hands it to `work`, and destroys it. */
typedef assay_status (*assay_run_work)(const assay_method *method, void *state,
                                       const assay_frame *frame, void *user,
                                       assay_ray_counts *counts);
assay_status assay_run_method(const assay_method *method, const assay_params *params,
                              const assay_frame *frame, assay_run_work work, void *user,
                              assay_ray_counts *counts);

/* Counts and sizes; what only an image has stays 0 (its error: NaN) where film is NULL. */
void assay_run_fill_stats(const assay_film *film, const assay_frame *frame,
                          const assay_ray_counts *counts, assay_render_stats *stats);

#endif
