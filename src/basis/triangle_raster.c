/* triangle_raster.c - edge functions over the bounding box.
 *
 * Invariant: a pixel centre is inside when its three signed areas have the sign of the triangle's,
 * zero included: neighbours share their edge's pixels, and no gap opens. */
#include "basis/triangle_raster.h"

#include <math.h>

#include "core/alloc.h"
#include "core/context.h"

assay_status assay_triangle_raster_create(assay_context *context, int side,
                                          assay_triangle_raster *raster_out)
{
    const size_t          pixels = (size_t)side * (size_t)side;
    assay_triangle_raster raster = {.context = context, .side = side};
    raster.depth                 = assay_allocate(context, pixels, sizeof(float));
    raster.color                 = assay_allocate(context, pixels, 3 * sizeof(float));
    if (!raster.depth || !raster.color) {
        assay_triangle_raster_destroy(&raster);
        return assay_fail_memory(context, "a picture");
    }
    for (size_t i = 0; i < pixels; i++) {
        raster.depth[i]         = -INFINITY;
        raster.color[3 * i]     = 1.0f;
        raster.color[3 * i + 1] = 1.0f;
        raster.color[3 * i + 2] = 1.0f;
    }
    *raster_out = raster;
    return ASSAY_OK;
}

void assay_triangle_raster_destroy(assay_triangle_raster *raster)
{
    assay_release(raster->context, raster->depth);
    assay_release(raster->context, raster->color);
}

static int pixel_floor(double x, int side) { return (int)fmin(fmax(floor(x), 0.0), side); }

/* Twice the signed area of p, q and the point (x, y). */
static double area(assay_vec3 p, assay_vec3 q, double x, double y)
{
    return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
}

void assay_triangle_raster_add(assay_triangle_raster *raster, assay_vec3 a, assay_vec3 b,
                               assay_vec3 c, assay_rgb color)
{
    const double whole = area(a, b, c.x, c.y);
    if (whole == 0.0) {
        return;
    }
    const int left   = pixel_floor(fmin(a.x, fmin(b.x, c.x)) - 0.5, raster->side);
    const int right  = pixel_floor(fmax(a.x, fmax(b.x, c.x)) + 0.5, raster->side);
    const int top    = pixel_floor(fmin(a.y, fmin(b.y, c.y)) - 0.5, raster->side);
    const int bottom = pixel_floor(fmax(a.y, fmax(b.y, c.y)) + 0.5, raster->side);
    for (int y = top; y < bottom; y++) {
        for (int x = left; x < right; x++) {
            const double u = area(b, c, x + 0.5, y + 0.5) / whole;
            const double v = area(c, a, x + 0.5, y + 0.5) / whole;
            const double w = area(a, b, x + 0.5, y + 0.5) / whole;
            const size_t i = (size_t)y * (size_t)raster->side + (size_t)x;
            const double z = u * a.z + v * b.z + w * c.z;
            if (u >= 0.0 && v >= 0.0 && w >= 0.0 && z > raster->depth[i]) {
                raster->depth[i]         = (float)z;
                raster->color[3 * i]     = (float)color.r;
                raster->color[3 * i + 1] = (float)color.g;
                raster->color[3 * i + 2] = (float)color.b;
            }
        }
    }
}
