/* bvh_decision.c - the watertight test of [woop13] in double, made independent of the tree.
 *
 * Invariant: the outcome is a function of the ray and the nine floats alone, and an accepted hit
 * lies within residual + 20 * 2^-53 M of the triangle's box.  Edge functions of a triangle seen
 * nearly edge-on are rounding noise; the residual of their barycentric combination shows it, and
 * they are then computed again with products that do not round. */
#include "trace/bvh_decision.h"

/* A corner in the ray's frame. */
typedef struct {
    double x, y, z;
} sheared;

/* Edge functions: signed areas opposite to corners a, b, c, times two. */
typedef struct {
    double u, v, w;
} edges;

static inline sheared shear(const bvh_shear *ray, const float *corner, size_t axis_stride)
{
    const double x = (double)corner[ray->axis[0] * axis_stride] - ray->o[0];
    const double y = (double)corner[ray->axis[1] * axis_stride] - ray->o[1];
    const double z = (double)corner[ray->axis[2] * axis_stride] - ray->o[2];
    return (sheared){x - ray->sx * z, y - ray->sy * z, z};
}

/* The signs of a closed triangle: none below zero, or none above. */
static inline bool encloses(edges e)
{
    const double uv_low = e.u < e.v ? e.u : e.v, uv_high = e.u > e.v ? e.u : e.v;
    const double low = uv_low < e.w ? uv_low : e.w, high = uv_high > e.w ? uv_high : e.w;
    return (low >= 0.0) | (high <= 0.0);
}

/* Whether the point that the edge functions stand for is on the ray; false for det = 0 and NaN. */
static inline bool consistent(const bvh_shear *ray, edges e, double det, sheared a, sheared b,
                              sheared c)
{
    const double limit = ray->residual * fabs(det);
    const double x     = e.u * a.x + e.v * b.x + e.w * c.x;
    const double y     = e.u * a.y + e.v * b.y + e.w * c.y;
    return fabs(x) < limit && fabs(y) < limit;
}

/* p q - r s with the right sign, within 1.5 units in the last place ([jeannerod13], algorithm 1).
 */
static double difference_of_products(double p, double q, double r, double s)
{
    const double rs    = r * s;
    const double error = fma(r, s, -rs);
    return fma(p, q, -rs) - error;
}

__attribute__((noinline, cold)) static bool refine(const bvh_shear *ray, edges *e, double *det,
                                                   sheared a, sheared b, sheared c)
{
    e->u = difference_of_products(c.x, b.y, c.y, b.x);
    e->v = difference_of_products(a.x, c.y, a.y, c.x);
    e->w = difference_of_products(b.x, a.y, b.y, a.x);
    *det = e->u + e->v + e->w;
    return encloses(*e) && consistent(ray, *e, *det, a, b, c);
}

bool bvh_query_try(bvh_query *query, const float *corner, size_t corner_stride, size_t axis_stride,
                   uint32_t triangle)
{
    const bvh_shear *ray = &query->shear;
    const sheared    a   = shear(ray, corner, axis_stride);
    const sheared    b   = shear(ray, corner + corner_stride, axis_stride);
    const sheared    c   = shear(ray, corner + 2 * corner_stride, axis_stride);

    edges e = {c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x};
    if (!encloses(e)) {
        return false;
    }
    double det = e.u + e.v + e.w;
    if (!consistent(ray, e, det, a, b, c) && !refine(ray, &e, &det, a, b, c)) {
        return false;
    }
    const double t = (e.u * a.z + e.v * b.z + e.w * c.z) / det * ray->inverse_dz;

    if (!bvh_query_in_order(query, t, triangle)) {
        return false;
    }
    bvh_query_take(query, t, triangle, e.v, e.w, det);
    return true;
}
