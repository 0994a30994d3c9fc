/* ray_bound.h - how far a hit may be off that is computed with less precision, and whether it may
 * be another triangle's. */
#ifndef ASSAY_ORACLE_RAY_BOUND_H
#define ASSAY_ORACLE_RAY_BOUND_H

#include "oracle/stage/tracked.h"
#include "trace/world.h"

/* A ray that a candidate computes itself. */
typedef struct {
    tracked3 origin, direction; /* m; unit */
} bound_ray;

/* Where it meets the triangle's plane. */
typedef struct {
    tracked  distance; /* m              */
    tracked3 point;    /* m, world       */
    tracked3 normal;   /* unit, of the front */
} bound_hit;

/* The largest coordinate of the scene, m. */
double bound_scene_size(const assay_scene *scene);

bound_hit bound_hit_of(const rounding *r, const assay_scene *scene, uint32_t triangle,
                       const bound_ray *ray);

/* Asks which triangle a ray meets (UINT32_MAX: none). */
typedef uint32_t (*bound_ask)(const void *user, assay_vec3 origin, assay_vec3 direction);

/* HEURISTIC: whether rays that are off as far as this one may be meet another triangle than
 * `triangle` (UINT32_MAX: than none): eight are tried, on a cone about it. */
bool bound_is_torn(const rounding *r, const assay_scene *scene, const bound_ray *ray,
                   uint32_t triangle, double distance, bound_ask ask, const void *user);

#endif
