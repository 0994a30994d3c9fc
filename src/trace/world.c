/* world.c - rays through a scene with surfaces that may be partly there. */
#include "trace/world.h"

#include "core/alloc.h"
#include "core/context.h"

/* Relative to the largest coordinate.  Points on a surface are exact to about 2^-50 of it, so 2^-36
 * is far above rounding and far below anything that is modelled. */
static const double OFFSET_SCALE = 0x1p-36;

static double largest_coordinate(const assay_scene *scene)
{
    const assay_vec3 a = scene->bounds_min, b = scene->bounds_max;
    return fmax(fmax(fmax(fabs(a.x), fabs(b.x)), fmax(fabs(a.y), fabs(b.y))),
                fmax(fabs(a.z), fabs(b.z)));
}

static void look_at_materials(assay_world *world)
{
    const assay_scene *scene = world->scene;
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const assay_material *material = &scene->materials[scene->shapes[i].material];
        world->has_alpha |= material->alpha_mode != ASSAY_ALPHA_OPAQUE;
        world->has_solid |= material->solid;
    }
}

assay_status assay_world_create(const assay_scene *scene, assay_world **world_out)
{
    assay_world *world = assay_allocate(scene->context, 1, sizeof *world);
    if (!world) {
        return assay_fail_memory(scene->context, "the ray tracer");
    }
    world->scene                    = scene;
    world->offset                   = OFFSET_SCALE * largest_coordinate(scene);
    const assay_triangles triangles = {scene->positions, scene->indices, scene->vertex_count,
                                       scene->triangle_count};
    look_at_materials(world);
    assay_status status = assay_bvh_create(scene->context, &triangles, &world->bvh);
    if (status == ASSAY_OK) {
        status = assay_lights_create(scene, &world->lights);
    }
    if (status != ASSAY_OK) {
        assay_world_destroy(world);
        return status;
    }
    *world_out = world;
    return ASSAY_OK;
}

void assay_world_destroy(assay_world *world)
{
    if (world) {
        assay_bvh_destroy(world->bvh);
        assay_lights_destroy(world->lights);
        assay_release(world->scene->context, world);
    }
}

assay_status assay_world_fail_light(const assay_world *world)
{
    return assay_fail(world->scene->context, ASSAY_ERR_DOMAIN,
                      "%s: gives light that is too bright to compute with: its emission or its "
                      "scale is too extreme",
                      world->scene->path);
}

/* glTF culls the backs of single-sided materials.  What light passes through keeps its back, or a
 * glass body would have no far side. */
static bool is_culled(const assay_scene *scene, uint32_t triangle, assay_vec3 direction)
{
    const assay_material *material =
        &scene->materials[scene->shapes[scene->triangle_shape[triangle]].material];
    if (material->double_sided || material->solid || material->transmission > 0.0) {
        return false;
    }
    assay_vec3 ng;
    double     area;
    assay_triangle_geometry(scene, triangle, &ng, &area);
    return vec3_dot(ng, direction) > 0.0;
}

static void continue_past(assay_ray *ray, const assay_hit *hit)
{
    ray->t_after        = hit->t;
    ray->triangle_after = hit->triangle;
}

bool assay_world_closest(const assay_world *world, assay_vec3 origin, assay_vec3 direction,
                         bool camera_ray, assay_random *random, uint64_t *count, assay_hit *hit_out)
{
    assay_ray ray = assay_ray_start(origin, direction, INFINITY);
    for (;;) {
        ++*count;
        if (!assay_bvh_closest(world->bvh, &ray, hit_out)) {
            return false;
        }
        bool passed = camera_ray && is_culled(world->scene, hit_out->triangle, direction);
        if (!passed && world->has_alpha) {
            const double coverage =
                assay_triangle_coverage(world->scene, hit_out->triangle, hit_out->u, hit_out->v);
            passed = coverage < 1.0 && !(assay_random_next(random) < coverage);
        }
        if (!passed) {
            return true;
        }
        continue_past(&ray, hit_out);
    }
}

bool assay_world_visible(const assay_world *world, assay_vec3 origin, assay_vec3 direction,
                         uint64_t *count, assay_hit *hit_out)
{
    assay_ray ray = assay_ray_start(origin, direction, INFINITY);
    for (;;) {
        ++*count;
        if (!assay_bvh_closest(world->bvh, &ray, hit_out)) {
            return false;
        }
        if (!is_culled(world->scene, hit_out->triangle, direction) &&
            (!world->has_alpha || assay_triangle_coverage(world->scene, hit_out->triangle,
                                                          hit_out->u, hit_out->v) >= 0.5)) {
            return true;
        }
        continue_past(&ray, hit_out);
    }
}

double assay_world_transmittance(const assay_world *world, assay_vec3 origin, assay_vec3 direction,
                                 double t_max, uint64_t *count)
{
    assay_ray ray = assay_ray_start(origin, direction, t_max);
    if (!world->has_alpha) {
        ++*count;
        return assay_bvh_occluded(world->bvh, &ray) ? 0.0 : 1.0;
    }
    double    transmittance = 1.0;
    assay_hit hit;
    for (;;) {
        ++*count;
        if (!assay_bvh_closest(world->bvh, &ray, &hit)) {
            return transmittance;
        }
        transmittance *= 1.0 - assay_triangle_coverage(world->scene, hit.triangle, hit.u, hit.v);
        if (transmittance <= 0.0) {
            return 0.0;
        }
        continue_past(&ray, &hit);
    }
}
