/* world.h - a scene at one time, made ready for rays. */
#ifndef ASSAY_TRACE_WORLD_H
#define ASSAY_TRACE_WORLD_H

#include "core/random.h"
#include "scene/surface.h"
#include "trace/bvh.h"
#include "trace/lights.h"

typedef struct {
    const assay_scene *scene;
    assay_bvh         *bvh;
    assay_lights      *lights;
    double             offset;    /* m: how far off a surface the rays that leave it start  */
    bool               has_alpha; /* some material is not opaque                            */
    bool               has_solid; /* some material refracts into a volume                   */
} assay_world;

/* Errors: MEMORY, CANCELLED, INTERNAL. */
assay_status assay_world_create(const assay_scene *scene, assay_world **world_out);
void         assay_world_destroy(assay_world *world);

/* Says that light came out that is no finite number; returns ASSAY_ERR_DOMAIN. */
assay_status assay_world_fail_light(const assay_world *world);

/* Rays traced, by kind, and what caches made of them; each worker counts its own. */
typedef struct {
    uint64_t camera, scatter, shadow;
    uint64_t records, lost; /* lost: contributions of records that billboards leave out */
} assay_ray_counts;

static inline void assay_ray_counts_add(assay_ray_counts *sum, const assay_ray_counts *counts)
{
    sum->camera += counts->camera;
    sum->scatter += counts->scatter;
    sum->shadow += counts->shadow;
    sum->records += counts->records;
    sum->lost += counts->lost;
}

/* Where a ray that leaves a surface starts: off the geometric normal's plane, on the side that the
 * direction goes to, far enough not to meet the surface again (docs/determinism.md). */
static inline assay_vec3 assay_world_offset(const assay_world *world, assay_vec3 position,
                                            assay_vec3 ng, assay_vec3 direction)
{
    return vec3_mad(position, vec3_dot(ng, direction) < 0.0 ? -world->offset : world->offset, ng);
}

/* The first hit that is not see-through: MASK below its cutoff is passed, BLEND is accepted with
 * its coverage as probability.  With camera_ray, backs of single-sided opaque materials are passed
 * too, as glTF culls them.  *count is raised by the rays traced. */
bool assay_world_closest(const assay_world *world, assay_vec3 origin, assay_vec3 direction,
                         bool camera_ray, assay_random *random, uint64_t *count,
                         assay_hit *hit_out);

/* The same for the ray that looks at the visible point of a pixel: BLEND counts from coverage 1/2
 * on, so that no random number is asked. */
bool assay_world_visible(const assay_world *world, assay_vec3 origin, assay_vec3 direction,
                         uint64_t *count, assay_hit *hit_out);

/* Part of the light that gets from origin to origin + direction * t_max: product of (1 - coverage)
 * of what lies between. */
double assay_world_transmittance(const assay_world *world, assay_vec3 origin, assay_vec3 direction,
                                 double t_max, uint64_t *count);

#endif
