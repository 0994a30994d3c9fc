/* plot.h - pictures to look at: curves in a frame with axes, functions of a basis as lobes, text.
 *
 * Images have channels R, G, B of linear light on white; assay_image_write_png makes files of them.
 * They are drawn by arithmetic alone: the same pixels on every machine. */
#ifndef ASSAY_PLOT_H
#define ASSAY_PLOT_H

#include "assay/basis.h"
#include "assay/image.h"
#include "assay/types.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ASSAY_PLOT_MAX_CURVES 8

/* A line through `count` points, with a mark at each; borrowed. */
typedef struct {
    const char   *name; /* for the legend */
    size_t        count;
    const double *x, *y;
} assay_plot_curve;

/* Names are printable ASCII.  The frame is [x_min, x_max] x [y_min, y_max]: within +-1e9, and min
 * below max by 1e-6 of the larger of them, or of 1.  Curves are drawn in this order, and cut off
 * where they leave the frame. */
typedef struct {
    const char             *title, *x_label, *y_label;
    double                  x_min, x_max, y_min, y_max;
    size_t                  curve_count; /* at most ASSAY_PLOT_MAX_CURVES */
    const assay_plot_curve *curves;
} assay_plot;

/* Ticks at round numbers, the legend at the lower right.  width, height: 200 ... 4096.
 * Errors: ARGUMENT, DOMAIN (a point is not finite), MEMORY. */
ASSAY_API assay_status assay_plot_draw(assay_context *context, const assay_plot *plot, int width,
                                       int height, assay_image **image_out);

/* Function i < count of a basis as the surface |f(w)| w, scaled to fit, seen from above the horizon
 * between +x and +y: f > 0 is warm, f < 0 cool; axes and the horizon's circle as hints.
 * size: 64 ... 2048 pixels, a square.  Errors: ARGUMENT, MEMORY. */
ASSAY_API assay_status assay_basis_draw(assay_context *context, const assay_basis *basis, size_t i,
                                        int size, assay_image **image_out);

/* Text with its left end at x and its baseline at y (pixels, from the top left corner), capitals
 * `height` pixels high.  What is not printable ASCII shows as a blank.  The image needs float
 * channels R, G, B.  Errors: ARGUMENT. */
ASSAY_API assay_status assay_image_draw_text(assay_image *image, double x, double y, double height,
                                             assay_rgb color, const char *text);
/* Its width in pixels. */
ASSAY_API double assay_text_width(double height, const char *text);

#ifdef __cplusplus
}
#endif
#endif
