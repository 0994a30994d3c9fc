/* canvas.h - smooth strokes on an image. */
#ifndef ASSAY_IO_CANVAS_H
#define ASSAY_IO_CANVAS_H

#include "assay/image.h"
#include "assay/types.h"

/* Where to draw: float planes of an image, borrowed. */
typedef struct {
    int    width, height;
    float *plane[3];
} assay_canvas;

/* False where the image has no float channels R, G, B. */
bool assay_canvas_open(const assay_image *image, assay_canvas *canvas_out);

/* An image of this size with channels R, G, B, all white.  Errors: ARGUMENT, MEMORY. */
assay_status assay_canvas_create(assay_context *context, int width, int height,
                                 assay_image **image_out);

/* A stroke with round ends from (x0, y0) to (x1, y1), pixels from the top left corner; pixel
 * centres are at + 1/2.  Coverage is that of the distance to the stroke, blended in linear light.
 * What lies outside the image is cut off. */
void assay_canvas_stroke(const assay_canvas *canvas, double x0, double y0, double x1, double y1,
                         double width, assay_rgb color);

/* Text by strokes: as assay_image_draw_text; turned a quarter counter-clockwise where upward. */
void assay_canvas_text(const assay_canvas *canvas, double x, double y, double height, bool upward,
                       assay_rgb color, const char *text);

#endif
