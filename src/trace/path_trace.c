/* path_trace.c - one path at a time.
 *
 * Invariant: before bounce b, `throughput` is the unbiased weight of the path so far, and `vertex`
 * is where it stands.  A vertex always asks for the same number of random numbers whatever it
 * finds, so that two paths from neighbouring points stay together (common random numbers for
 * gradients). */
#include "trace/path_trace.h"

#include "core/numerics.h"
#include "trace/vertex_light.h"

/* Roulette lets a path go on with at most this probability, so that a closed white furnace ends. */
static const double ROULETTE_MAX = 0.95;

typedef struct {
    const assay_world         *world;
    const assay_path_settings *settings;
    assay_random              *random;
    assay_ray_counts          *counts;
    assay_path_light           light;
    assay_rgb                  throughput;
    const assay_material      *medium; /* the solid body that the path is inside of, or NULL */
} path_walk;

static void add_light(path_walk *walk, int bounce, assay_rgb radiance)
{
    assay_rgb *sum = bounce >= 2 ? &walk->light.indirect : &walk->light.direct;
    *sum           = rgb_add(*sum, rgb_mul(walk->throughput, radiance));
}

/* Weight of a technique of density p against another of density q: the power heuristic with
 * exponent 2 [veach95, eq. 9.12 of the thesis], without overflow. */
static double power_weight(double p, double q)
{
    const double ratio = q / p;
    return 1.0 / (1.0 + ratio * ratio);
}

/* Beer's law inside a solid body (KHR_materials_volume). */
static assay_rgb absorption(const assay_material *medium, double distance)
{
    if (!medium || isinf(medium->attenuation_distance)) {
        return rgb_grey(1.0);
    }
    const double lengths = distance / medium->attenuation_distance;
    return rgb(assay_pow(medium->attenuation_color.r, lengths),
               assay_pow(medium->attenuation_color.g, lengths),
               assay_pow(medium->attenuation_color.b, lengths));
}

/* Draws a light for the vertex, which needs no BSDF yet. */
static bool draw_light(path_walk *walk, const assay_vertex *vertex, assay_light_sample *light_out)
{
    const double         u_choice   = assay_random_next(walk->random);
    const double         u1         = assay_random_next(walk->random);
    const double         u2         = assay_random_next(walk->random);
    const bool           delta_only = walk->settings->estimator == ASSAY_ESTIMATOR_BSDF;
    const assay_receiver receiver   = assay_vertex_as_receiver(vertex);
    return assay_lights_sample(walk->world->lights, &receiver, delta_only, u_choice, u1, u2,
                               light_out);
}

/* What the vertex scatters of the light that was drawn. */
static void add_drawn_light(path_walk *walk, const assay_vertex *vertex,
                            const assay_bsdf_view *view, int bounce,
                            const assay_light_sample *light)
{
    if (view->specular) {
        return;
    }
    const assay_vec3 wi = frame3_to_local(&vertex->frame, light->direction);
    if (!assay_vertex_sides_agree(vertex, light->direction, wi.z * vertex->wo_local.z < 0.0)) {
        return;
    }
    const assay_bsdf_value f = assay_bsdf_view_evaluate(view, wi);
    if (rgb_is_black(f.value)) {
        return;
    }
    assay_vec3   along;
    const double clear =
        assay_vertex_sees_light(walk->world, vertex, light, &along, &walk->counts->shadow);
    if (clear <= 0.0) {
        return;
    }
    double weight = clear / light->pdf;
    if (!light->delta && walk->settings->estimator == ASSAY_ESTIMATOR_MIS) {
        weight *= power_weight(light->pdf, f.pdf);
    }
    assay_rgb radiance = rgb_scale(rgb_mul(f.value, light->radiance), weight);
    if (walk->medium) {
        radiance = rgb_mul(
            radiance, absorption(walk->medium, light->infinite ? INFINITY : vec3_length(along)));
    }
    add_light(walk, bounce, radiance);
}

/* Weight of emission found by BSDF sampling, where light sampling would have had pdf_light. */
static double emission_weight(const path_walk *walk, const assay_bsdf_sample *sample,
                              double pdf_light)
{
    if (sample->specular || pdf_light == 0.0) {
        return 1.0;
    }
    switch (walk->settings->estimator) {
    case ASSAY_ESTIMATOR_NEE: return 0.0;
    case ASSAY_ESTIMATOR_BSDF: return 1.0;
    case ASSAY_ESTIMATOR_MIS: break;
    }
    return power_weight(sample->pdf, pdf_light);
}

/* Unlit surfaces show themselves to the camera and light nothing (docs/scenes.md). */
static assay_rgb emission_of(const path_walk *walk, const assay_vertex *vertex)
{
    const assay_scene *scene = walk->world->scene;
    if (scene->materials[vertex->surface.material].model == ASSAY_MATERIAL_UNLIT) {
        return rgb_grey(0.0);
    }
    return assay_surface_emission(scene, &vertex->surface, vertex->front);
}

/* Ends dim paths at random; the survivors stand for them. */
static bool survives_roulette(path_walk *walk, int bounce)
{
    const double u = assay_random_next(walk->random);
    if (bounce <= walk->settings->roulette_depth) {
        return true;
    }
    const double strength = rgb_max(walk->throughput);
    const double chance   = strength < ROULETTE_MAX ? strength : ROULETTE_MAX;
    if (!(u < chance)) {
        return false;
    }
    walk->throughput = rgb_scale(walk->throughput, 1.0 / chance);
    return true;
}

/* Draws where the path goes on from the vertex. */
static bool draw_direction(path_walk *walk, const assay_vertex *vertex, const assay_bsdf_view *view,
                           assay_bsdf_sample *sample_out, assay_vec3 *direction_out)
{
    const double u_lobe = assay_random_next(walk->random);
    const double u1     = assay_random_next(walk->random);
    const double u2     = assay_random_next(walk->random);
    if (!assay_bsdf_view_sample(view, u_lobe, u1, u2, sample_out)) {
        return false;
    }
    *direction_out = frame3_to_world(&vertex->frame, sample_out->wi);
    return assay_vertex_sides_agree(vertex, *direction_out, sample_out->transmitted);
}

/* What the ray from the vertex meets.  False where it meets nothing. */
static bool trace_from(path_walk *walk, const assay_vertex *vertex, assay_vec3 direction,
                       bool transmitted, assay_hit *hit_out)
{
    if (transmitted && vertex->bsdf.solid) {
        const bool enters = vec3_dot(direction, vertex->surface.ng) < 0.0;
        walk->medium = enters ? &walk->world->scene->materials[vertex->surface.material] : NULL;
    }
    const assay_vec3 origin =
        assay_world_offset(walk->world, vertex->surface.position, vertex->surface.ng, direction);
    return assay_world_closest(walk->world, origin, direction, false, walk->random,
                               &walk->counts->scatter, hit_out);
}

/* Goes from the vertex to the next one, adding what it finds there.  False where the path ends. */
static bool follow(path_walk *walk, assay_vertex *vertex, const assay_bsdf_view *view, int bounce)
{
    const bool        last = bounce == walk->settings->bounces;
    assay_bsdf_sample sample;
    assay_vec3        direction;
    if (!draw_direction(walk, vertex, view, &sample, &direction) ||
        (last && !sample.specular && walk->settings->estimator == ASSAY_ESTIMATOR_NEE)) {
        return false;
    }
    walk->throughput = rgb_mul(walk->throughput, sample.weight);
    if (!survives_roulette(walk, bounce)) {
        return false;
    }
    assay_hit hit;
    if (!trace_from(walk, vertex, direction, sample.transmitted, &hit)) {
        const assay_receiver receiver = assay_vertex_as_receiver(vertex);
        const double         pdf_light =
            assay_lights_pdf_infinite(walk->world->lights, &receiver, direction);
        const assay_rgb radiance = assay_lights_infinite_radiance(walk->world->lights, direction);
        walk->throughput         = rgb_mul(walk->throughput, absorption(walk->medium, INFINITY));
        add_light(walk, bounce, rgb_scale(radiance, emission_weight(walk, &sample, pdf_light)));
        return false;
    }
    walk->throughput = rgb_mul(walk->throughput, absorption(walk->medium, hit.t));
    if (last && !assay_triangle_emits(walk->world->scene, hit.triangle)) {
        return false;
    }
    assay_vertex_place(walk->world, &hit, direction, vertex);
    const assay_rgb emission = emission_of(walk, vertex);
    if (!rgb_is_black(emission)) {
        const double pdf_light = assay_lights_pdf_triangle(walk->world->lights, hit.triangle, hit.t,
                                                           vec3_dot(direction, vertex->surface.ng));
        add_light(walk, bounce, rgb_scale(emission, emission_weight(walk, &sample, pdf_light)));
    }
    return !last && !rgb_is_black(walk->throughput);
}

static void scatter(path_walk *walk, assay_vertex *vertex, int first)
{
    const bool draws =
        walk->settings->estimator != ASSAY_ESTIMATOR_BSDF || walk->world->scene->punctual_count > 0;
    for (int bounce = first; bounce <= walk->settings->bounces; bounce++) {
        assay_light_sample light;
        const bool         lit = draws && draw_light(walk, vertex, &light);
        assay_vertex_dress(walk->world, vertex);
        const assay_bsdf_view view = assay_bsdf_seen_from(&vertex->bsdf, vertex->wo_local);
        if (lit) {
            add_drawn_light(walk, vertex, &view, bounce, &light);
        }
        if (!follow(walk, vertex, &view, bounce)) {
            return;
        }
    }
}

assay_path_light assay_path_scatter(const assay_world *world, const assay_path_settings *settings,
                                    const assay_vertex *vertex, assay_random *random,
                                    assay_ray_counts *counts)
{
    path_walk    walk = {.world      = world,
                         .settings   = settings,
                         .random     = random,
                         .counts     = counts,
                         .throughput = rgb_grey(1.0)};
    assay_vertex at   = *vertex;
    scatter(&walk, &at, 1);
    return walk.light;
}

/* The path is followed with a throughput of 1 and what it brings is weighted afterwards, since the
 * weight may be negative. */
assay_rgb assay_path_indirect(const assay_world *world, const assay_path_settings *settings,
                              const assay_vertex *vertex, assay_rgb lambert, assay_random *random,
                              assay_ray_counts *counts)
{
    const assay_rgb       nothing = rgb_grey(0.0);
    const assay_bsdf_view view    = assay_bsdf_seen_from(&vertex->bsdf, vertex->wo_local);
    path_walk             walk    = {.world      = world,
                                     .settings   = settings,
                                     .random     = random,
                                     .counts     = counts,
                                     .throughput = rgb_grey(1.0)};
    assay_bsdf_sample     sample;
    assay_vec3            direction;
    if (settings->bounces < 2 || !draw_direction(&walk, vertex, &view, &sample, &direction)) {
        return nothing;
    }
    assay_rgb weight = sample.weight;
    if (!sample.specular && !sample.transmitted) {
        const double density = fabs(sample.wi.z) * ASSAY_INV_PI;
        weight               = rgb_sub(weight, rgb_scale(lambert, density / sample.pdf));
    }
    const double strength = rgb_max(rgb(fabs(weight.r), fabs(weight.g), fabs(weight.b)));
    const double chance   = strength < 1.0 ? strength : 1.0;
    assay_hit    hit;
    if (!(assay_random_next(random) < chance) ||
        !trace_from(&walk, vertex, direction, sample.transmitted, &hit)) {
        return nothing;
    }
    walk.throughput = absorption(walk.medium, hit.t);
    assay_vertex next;
    assay_vertex_place(world, &hit, direction, &next);
    scatter(&walk, &next, 2);
    return rgb_mul(rgb_scale(weight, 1.0 / chance), walk.light.indirect);
}

assay_path_light assay_path_radiance(const assay_world *world, const assay_path_settings *settings,
                                     assay_vec3 origin, assay_vec3 direction, assay_random *random,
                                     assay_ray_counts *counts)
{
    path_walk walk = {.world      = world,
                      .settings   = settings,
                      .random     = random,
                      .counts     = counts,
                      .throughput = rgb_grey(1.0)};
    assay_hit hit;
    if (!assay_world_closest(world, origin, direction, true, random, &counts->camera, &hit)) {
        add_light(&walk, 0, assay_lights_infinite_radiance(world->lights, direction));
        return walk.light;
    }
    assay_vertex vertex;
    assay_vertex_place(world, &hit, direction, &vertex);
    add_light(&walk, 0, assay_surface_emission(world->scene, &vertex.surface, vertex.front));
    scatter(&walk, &vertex, 1);
    return walk.light;
}
