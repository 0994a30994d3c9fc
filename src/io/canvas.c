/* canvas.c - a stroke is all that a plot and its text are made of.
 *
 * Invariant: a pixel's share of a stroke is clamp(half width + 1/2 - distance of its centre from
 * the segment), which is exact for the inside of wide strokes and smooth at their edges. */
#include "io/canvas.h"

#include <math.h>

#include "core/context.h"

bool assay_canvas_open(const assay_image *image, assay_canvas *canvas_out)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_canvas             canvas   = {assay_image_width(image), assay_image_height(image), {0}};
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        if (!assay_image_find_channel(image, names[c], &channel) ||
            channel.type != ASSAY_CHANNEL_FLOAT) {
            return false;
        }
        canvas.plane[c] = channel.data.f32;
    }
    *canvas_out = canvas;
    return true;
}

assay_status assay_canvas_create(assay_context *context, int width, int height,
                                 assay_image **image_out)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_image             *image    = NULL;
    assay_status             status   = assay_image_create(context, width, height, &image);
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        assay_channel channel;
        status = assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &channel);
        for (size_t i = 0; i < (size_t)width * (size_t)height && status == ASSAY_OK; i++) {
            channel.data.f32[i] = 1.0f;
        }
    }
    if (status != ASSAY_OK) {
        assay_image_destroy(image);
        return status;
    }
    *image_out = image;
    return ASSAY_OK;
}

static double clamp(double x, double low, double high) { return fmin(fmax(x, low), high); }

/* Distance of a point from a segment. */
static double distance_to(double px, double py, double x0, double y0, double dx, double dy)
{
    const double square = dx * dx + dy * dy;
    const double along  = (px - x0) * dx + (py - y0) * dy;
    const double t      = square > 0.0 ? clamp(along / square, 0.0, 1.0) : 0.0;
    const double ex = px - x0 - t * dx, ey = py - y0 - t * dy;
    return sqrt(ex * ex + ey * ey);
}

static void blend(const assay_canvas *canvas, int x, int y, double share, assay_rgb color)
{
    const size_t at       = (size_t)y * (size_t)canvas->width + (size_t)x;
    const double value[3] = {color.r, color.g, color.b};
    for (int c = 0; c < 3; c++) {
        float *p = &canvas->plane[c][at];
        *p       = (float)(*p + share * (value[c] - *p));
    }
}

void assay_canvas_stroke(const assay_canvas *canvas, double x0, double y0, double x1, double y1,
                         double width, assay_rgb color)
{
    const double reach  = 0.5 * width + 0.5;
    const int    left   = (int)clamp(floor(fmin(x0, x1) - reach), 0.0, canvas->width);
    const int    right  = (int)clamp(ceil(fmax(x0, x1) + reach), 0.0, canvas->width);
    const int    top    = (int)clamp(floor(fmin(y0, y1) - reach), 0.0, canvas->height);
    const int    bottom = (int)clamp(ceil(fmax(y0, y1) + reach), 0.0, canvas->height);
    for (int y = top; y < bottom; y++) {
        for (int x = left; x < right; x++) {
            const double d     = distance_to(x + 0.5, y + 0.5, x0, y0, x1 - x0, y1 - y0);
            const double share = clamp(reach - d, 0.0, fmin(1.0, width));
            if (share > 0.0) {
                blend(canvas, x, y, share, color);
            }
        }
    }
}
