/* bvh_decision.h - whether a ray meets a triangle: the one test that every answer rests on.
 *
 * Everything here is IEEE double arithmetic in a fixed order, without contraction, on the
 * triangle's nine floats: the same bits everywhere.  The steps are derived in docs/exact-hits.md. */
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
    uint32_t axis[3];     /* the world axes of x, y, z                                        */
    double   o[3];        /* origin, permuted                                                 */
    double   sx, sy;      /* dx / dz, dy / dz                                                 */
    double   inverse_dz, abs_dz;
    double   magnitude;   /* M = scene extent + max |o|, m                                    */
    double   residual;    /* largest residual of a plain decision, m                          */
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

static inline bvh_query bvh_query_start(const assay_bvh *bvh, const assay_ray *ray)
{
    const double   d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    const double   o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double   x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
    const uint32_t kz = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    const uint32_t kx = kz == 2 ? 0 : kz + 1, ky = kx == 2 ? 0 : kx + 1;
    const double   ox = fabs(o[0]), oy = fabs(o[1]), oz = fabs(o[2]);
    const double   oxy = ox > oy ? ox : oy;
    bvh_query      q;
    q.shear.axis[0]    = kx;
    q.shear.axis[1]    = ky;
    q.shear.axis[2]    = kz;
    q.shear.o[0]       = o[kx];
    q.shear.o[1]       = o[ky];
    q.shear.o[2]       = o[kz];
    q.shear.sx         = d[kx] / d[kz];
    q.shear.sy         = d[ky] / d[kz];
    q.shear.inverse_dz = 1.0 / d[kz];
    q.shear.abs_dz     = fabs(d[kz]);
    q.shear.magnitude  = bvh->extent + (oxy > oz ? oxy : oz);
    q.shear.residual   = bvh->tuning.residual_limit * q.shear.magnitude;
    q.t_after          = ray->t_after;
    q.triangle_after   = ray->triangle_after;
    q.best_triangle    = 0;
    q.best_t           = ray->t_max;
    q.v = q.w = q.det = 0.0;
    return q;
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
