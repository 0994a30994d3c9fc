/* bvh_decision.h - whether a ray meets a triangle: the one test that every answer rests on.
 *
 * Everything here is IEEE double arithmetic in a fixed order, without contraction, on the
 * triangle's nine floats: the same bits everywhere.  The steps are derived in docs/exact-hits.md.
 */
#ifndef ASSAY_TRACE_BVH_DECISION_H
#define ASSAY_TRACE_BVH_DECISION_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trace/bvh_tree.h"

/* A ray's own frame: axes permuted so that z is the largest component of the direction, then
 * sheared so that the ray is the z axis [woop13]. */
typedef struct {
    uint32_t axis[3]; /* the world axes of x, y, z                                        */
    double   o[3];    /* origin, permuted                                                 */
    double   sx, sy;  /* dx / dz, dy / dz                                                 */
    double   inverse_dz, abs_dz;
    double   magnitude; /* M = scene extent + max |o|, m                                    */
    double   residual;  /* largest residual of a plain decision, m                          */
} bvh_shear;

/* A query under way: its ray and the best hit so far. */
typedef struct {
    bvh_shear shear;
    double    t_after;
    uint32_t  triangle_after;
    uint32_t  best_triangle; /* 0 while there is no hit, so that t = t_max never ties */
    double    best_t;        /* t_max while there is no hit                           */
    double    v, w, det;     /* edge functions of the best hit; det = 0: no hit       */
} bvh_query;

/* The axis of the largest component, without a branch: rays of any kind take turns. */
static inline uint32_t bvh_largest_axis(double x, double y, double z)
{
    const uint32_t y_over_x  = y > x;
    const uint32_t z_over_xy = z > (y > x ? y : x);
    return z_over_xy << 1 | (y_over_x & ~z_over_xy);
}

/* Loads one number by itself.  Compilers like to load two or four of a ray that was just written
 * number by number at once, which makes a processor wait until the writes have left its queue. */
static inline double bvh_load_alone(const double *p)
{
    double x = *p;
#if defined(__x86_64__)
    __asm__("" : "+x"(x));
#elif defined(__aarch64__)
    __asm__("" : "+w"(x));
#endif
    return x;
}

static inline void bvh_query_start(bvh_query *q, const assay_bvh *bvh, const assay_ray *ray)
{
    const double   d[3] = {bvh_load_alone(&ray->direction.x), bvh_load_alone(&ray->direction.y),
                           bvh_load_alone(&ray->direction.z)};
    const double   o[3] = {bvh_load_alone(&ray->origin.x), bvh_load_alone(&ray->origin.y),
                           bvh_load_alone(&ray->origin.z)};
    const uint32_t kz   = bvh_largest_axis(fabs(d[0]), fabs(d[1]), fabs(d[2]));
    const uint32_t kx   = 0x09U >> 2 * kz & 3U,
                   ky   = 0x12U >> 2 * kz & 3U; /* the next, the one after */
    const double ox = fabs(o[0]), oy = fabs(o[1]), oz = fabs(o[2]);
    const double oxy = ox > oy ? ox : oy;

    q->shear.axis[0]    = kx;
    q->shear.axis[1]    = ky;
    q->shear.axis[2]    = kz;
    q->shear.o[0]       = o[kx];
    q->shear.o[1]       = o[ky];
    q->shear.o[2]       = o[kz];
    q->shear.sx         = d[kx] / d[kz];
    q->shear.sy         = d[ky] / d[kz];
    q->shear.inverse_dz = 1.0 / d[kz];
    q->shear.abs_dz     = fabs(d[kz]);
    q->shear.magnitude  = bvh->extent + (oxy > oz ? oxy : oz);
    q->shear.residual   = bvh->tuning.residual_limit * q->shear.magnitude;
    q->t_after          = bvh_load_alone(&ray->t_after);
    q->triangle_after   = ray->triangle_after;
    q->best_triangle    = 0;
    q->best_t           = bvh_load_alone(&ray->t_max);
    q->v = q->w = q->det = 0.0;
}

/* Whether a hit lies after the ray's start and before the best so far, in the order (t, triangle).
 */
static inline bool bvh_query_in_order(const bvh_query *q, double t, uint32_t triangle)
{
    return (t > q->t_after || (t == q->t_after && triangle > q->triangle_after)) &&
           (t < q->best_t || (t == q->best_t && triangle < q->best_triangle));
}

static inline void bvh_query_take(bvh_query *q, double t, uint32_t triangle, double v, double w,
                                  double det)
{
    q->best_t        = t;
    q->best_triangle = triangle;
    q->v             = v;
    q->w             = w;
    q->det           = det;
}

/* Lets a triangle compete for the first hit; true when it became the best so far.
 * Coordinate k of corner c is at corner[c * corner_stride + k * axis_stride]. */
bool bvh_query_try(bvh_query *query, const float *corner, size_t corner_stride, size_t axis_stride,
                   uint32_t triangle);

static inline bool bvh_query_finish(const bvh_query *query, assay_hit *hit_out)
{
    if (query->det == 0.0) {
        return false;
    }
    hit_out->t        = query->best_t;
    hit_out->u        = query->v / query->det;
    hit_out->v        = query->w / query->det;
    hit_out->triangle = query->best_triangle;
    return true;
}

#endif
