/* seen.c - see seen.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/seen.h"

#include "core/random.h"

seen_scene seen_from_origin(const seen_object *objects, int count)
{
    return (seen_scene){objects, count, vec3(0, 0, 0), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

seen_object seen_quad(assay_vec3 centre, assay_vec3 a, assay_vec3 b, double radiance)
{
    return (seen_object){
        .shape    = SEEN_POLYGON,
        .vertices = {vec3_sub(vec3_sub(centre, a), b), vec3_sub(vec3_add(centre, a), b),
                     vec3_add(vec3_add(centre, a), b), vec3_add(vec3_sub(centre, a), b)},
        .count    = 4,
        .radiance = rgb_grey(radiance)};
}

seen_object seen_sphere(assay_vec3 centre, double radius, double radiance)
{
    return (seen_object){
        .shape = SEEN_SPHERE, .centre = centre, .radius = radius, .radiance = rgb_grey(radiance)};
}

/* Distance along w (unit), or INFINITY. */
static double hit_polygon(const seen_object *o, assay_vec3 eye, assay_vec3 w, assay_vec3 *normal)
{
    const assay_vec3 n        = vec3_normalize(vec3_cross(vec3_sub(o->vertices[1], o->vertices[0]),
                                                          vec3_sub(o->vertices[2], o->vertices[0])));
    const double     distance = vec3_dot(n, vec3_sub(o->vertices[0], eye)) / vec3_dot(n, w);
    if (!(distance > 0.0) || !isfinite(distance)) {
        return INFINITY;
    }
    const assay_vec3 q = vec3_mad(eye, distance, w);
    for (int i = 0; i < o->count; i++) {
        const assay_vec3 a = o->vertices[i], b = o->vertices[(i + 1) % o->count];
        if (vec3_dot(n, vec3_cross(vec3_sub(b, a), vec3_sub(q, a))) < 0.0) {
            return INFINITY;
        }
    }
    *normal = n;
    return distance;
}

static double hit_sphere(const seen_object *o, assay_vec3 eye, assay_vec3 w, assay_vec3 *normal)
{
    const assay_vec3 to   = vec3_sub(o->centre, eye);
    const double     mid  = vec3_dot(to, w);
    const assay_vec3 side = vec3_mad(to, -mid, w);
    const double     half = o->radius * o->radius - vec3_dot(side, side);
    if (!(half > 0.0)) {
        return INFINITY;
    }
    const double near = mid - sqrt(half), far = mid + sqrt(half);
    const double distance = near > 0.0 ? near : far;
    if (!(distance > 0.0)) {
        return INFINITY;
    }
    *normal = vec3_normalize(vec3_sub(vec3_mad(eye, distance, w), o->centre));
    return distance;
}

assay_cell seen_cell(const seen_scene *scene, assay_vec3 direction)
{
    assay_cell       cell = {.distance = INFINITY, .direction = direction};
    const assay_vec3 w    = frame3_to_world(&scene->frame, direction);
    for (int i = 0; i < scene->count; i++) {
        const seen_object *o      = &scene->objects[i];
        assay_vec3         normal = vec3(0, 0, 0);
        const double       d = o->shape == SEEN_POLYGON ? hit_polygon(o, scene->eye, w, &normal)
                                                        : hit_sphere(o, scene->eye, w, &normal);
        if (d < cell.distance) {
            const double wave = 1.0 + vec3_dot(o->slope, vec3_mad(scene->eye, d, w));
            cell.distance     = d;
            cell.radiance     = rgb_scale(o->radiance, wave * wave);
            cell.hit_normal   = frame3_to_local(
                  &scene->frame, vec3_dot(normal, w) > 0.0 ? vec3_negate(normal) : normal);
        }
    }
    return cell;
}

void seen_fill(const seen_scene *scene, uint64_t seed, assay_hemisphere *hemisphere)
{
    const assay_hemisphere_layout *layout = &hemisphere->layout;
    for (int j = 0; j < layout->theta; j++) {
        for (int k = 0; k < layout->phi; k++) {
            const size_t at     = (size_t)j * (size_t)layout->phi + (size_t)k;
            assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, at, 0);
            const double u1     = layout->jitter ? assay_random_next(&random) : 0.5;
            const double u2     = layout->jitter ? assay_random_next(&random) : 0.5;
            hemisphere->cells[at] =
                seen_cell(scene, assay_hemisphere_direction(layout, j, k, u1, u2));
        }
    }
}

assay_hemisphere *seen_hemisphere(assay_context *context, const seen_scene *scene, int m, int n,
                                  assay_strata strata, bool jitter, uint64_t seed)
{
    const assay_hemisphere_layout layout = {
        .theta = m, .phi = n, .strata = strata, .jitter = jitter};
    assay_hemisphere *hemisphere = NULL;
    assert_int_equal(assay_hemisphere_create(context, &layout, &hemisphere), ASSAY_OK);
    seen_fill(scene, seed, hemisphere);
    return hemisphere;
}
