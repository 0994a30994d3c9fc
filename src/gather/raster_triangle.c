/* raster_triangle.c - see raster_triangle.h.
 *
 * Nothing is clipped: homogeneous edge functions [olano97] are right on both sides of the eye's
 * plane, and the depth of a pixel says on which side it is.  They are taken after each corner has
 * been sheared along the pixel's ray, as the hit decision does (docs/exact-hits.md): what is far
 * away and small then keeps its digits, and the bounds proven there hold here.
 *
 * Invariant: an edge function is the exact negative of that of the same edge walked the other way,
 * for products commute and differences change sign exactly; so of two triangles at an edge at least
 * one covers a pixel there. */
#include "gather/raster_triangle.h"

/* Largest miss, in parts of the corners' largest coordinate; that of the hit decision. */
static const double MISS = 0x1p-40;

static raster_corner corner_at(const assay_raster_view *view, const float *p)
{
    const assay_vec3 world = vec3((double)p[0], (double)p[1], (double)p[2]);
    const assay_vec3 v     = frame3_to_local(&view->frame, vec3_sub(world, view->eye));
    return (raster_corner){v.x, v.y, v.z, view->parallel ? 1.0 : v.z};
}

/* fmax is a call, as it must see to NaN. */
static double larger(double a, double b) { return a > b ? a : b; }

void raster_triangle_load(const assay_scene *scene, const assay_raster_view *view,
                          uint32_t triangle, raster_triangle *out)
{
    const uint32_t *index   = scene->indices + (size_t)triangle * 3;
    double          largest = 0.0;
    for (int i = 0; i < 3; i++) {
        raster_corner *p = &out->corner[i];
        *p               = corner_at(view, scene->positions + (size_t)index[i] * 3);
        largest          = larger(largest, larger(fabs(p->x), larger(fabs(p->y), fabs(p->z))));
    }
    out->tolerance = MISS * largest;
    out->triangle  = triangle;
}

/* p q - r s with the right sign, within 1.5 units in the last place ([jeannerod13], algorithm 1).
 */
static double difference_of_products(double p, double q, double r, double s)
{
    const double rs    = r * s;
    const double error = fma(r, s, -rs);
    return fma(p, q, -rs) - error;
}

raster_areas raster_areas_refine(const double x[3], const double y[3])
{
    return (raster_areas){difference_of_products(x[2], y[1], y[2], x[1]),
                          difference_of_products(x[0], y[2], y[0], x[2]),
                          difference_of_products(x[1], y[0], y[1], x[0])};
}
