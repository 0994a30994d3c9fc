/* bvh.h - which triangle a ray meets first; the only room that knows Embree.
 *
 * Embree builds the tree; the decision is our own double test (docs/exact-hits.md), so every bit
 * of an answer (t, u, v, triangle, hit or miss) is the same on every machine, for any tree and any
 * vector width. */
#ifndef ASSAY_TRACE_BVH_H
#define ASSAY_TRACE_BVH_H

#include <stdint.h>

#include "assay/context.h"
#include "assay/types.h"

typedef struct assay_bvh assay_bvh;

#define ASSAY_NO_TRIANGLE UINT32_MAX

/* The triangles to build from; borrowed, and used until the tree is destroyed. */
typedef struct {
    const float    *positions; /* vertex_count * 3, m, finite                                   */
    const uint32_t *indices;   /* triangle_count * 3, each < vertex_count                       */
    uint32_t        vertex_count, triangle_count; /* triangle_count < 2^31                      */
} assay_triangles;

/* Half-line origin + t direction.  A hit counts where, in the order (t, triangle), it lies strictly
 * after (t_after, triangle_after) and t < t_max.  Start with t_after = 0, triangle_after =
 * ASSAY_NO_TRIANGLE: t must then be > 0; to go on past a hit, give its t and triangle.
 * direction need not be a unit vector; not zero; all finite. */
typedef struct {
    assay_vec3 origin, direction;
    double     t_after, t_max; /* t_max may be INFINITY */
    uint32_t   triangle_after;
} assay_ray;

/* Point = (1 - u - v) p0 + u p1 + v p2 = origin + t direction, up to rounding. */
typedef struct {
    double   t, u, v;
    uint32_t triangle;
} assay_hit;

/* Errors: MEMORY, CANCELLED, LIMIT (a tree of 64 GiB or more), ARGUMENT (ASSAY_ISA is unknown),
 * INTERNAL (Embree refused; its words are in the message).
 * A tree over no triangle is legal and misses everything. */
assay_status assay_bvh_create(assay_context *context, const assay_triangles *triangles,
                              assay_bvh **bvh_out);
void         assay_bvh_destroy(assay_bvh *bvh);

/* The first hit in the order (t, triangle); false and *hit_out untouched when there is none.
 * Thread-safe. */
bool assay_bvh_closest(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out);

/* Whether there is any hit. */
bool assay_bvh_occluded(const assay_bvh *bvh, const assay_ray *ray);

/* Bytes held, without the borrowed triangles. */
uint64_t assay_bvh_bytes(const assay_bvh *bvh);

/* The judge: the same question answered by trying every triangle with the same decision. */
bool assay_bvh_closest_brute_force(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out);

static inline assay_ray assay_ray_start(assay_vec3 origin, assay_vec3 direction, double t_max)
{
    return (assay_ray){origin, direction, 0.0, t_max, ASSAY_NO_TRIANGLE};
}

#endif
