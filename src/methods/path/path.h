/* path.h - the method `path`: path tracing, the ground truth under all others. */
#ifndef ASSAY_METHODS_PATH_PATH_H
#define ASSAY_METHODS_PATH_PATH_H

#include "methods/method.h"
#include "trace/path_trace.h"

extern const assay_method assay_method_path;

/* Samples that are taken in one go, of each pixel and of each point: as many as keep an item of
 * work (a tile, a point) long against starting threads and short for who waits for cancelling. */
enum { ASSAY_PATH_PIXEL_PASS = 64, ASSAY_PATH_POINT_PASS = 4096 };

/* target_error decides on no fewer samples than these of each pixel, and of the image: few samples
 * of rare light do not know their variance (docs/methods/path.md). */
enum { ASSAY_PATH_DECIDE_PIXEL = 64, ASSAY_PATH_DECIDE_IMAGE = 4096 };

/* The parameters, read. */
typedef struct {
    assay_context      *context;
    assay_path_settings settings;
    uint32_t            spp, max_spp;
    double              target_error;   /* 0: off                                       */
    bool                gradients;      /* of probes                                    */
    double              gradient_step;  /* m; 0: a thousandth of the scene's diagonal   */
    double              gradient_angle; /* rad                                          */
} assay_path_state;

assay_status assay_path_render(void *state, const assay_frame *frame, assay_film *film,
                               assay_ray_counts *counts);
assay_status assay_path_probe(void *state, const assay_frame *frame,
                              const assay_probe_points *points, double *rows,
                              assay_ray_counts *counts);

#endif
