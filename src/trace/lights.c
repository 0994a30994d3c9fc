/* lights.c - choosing among all that emits.
 *
 * Invariant: whatever can emit towards anywhere has a probability > 0 of being drawn, so light
 * sampling alone is unbiased wherever the BSDF can be evaluated.  Powers only steer noise: they are
 * W of luminance, with the scene's bounding sphere standing for the receiver of what comes from
 * infinitely far. */
#include "trace/lights.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/random.h"
#include "math/distribution.h"
#include "math/sampling.h"
#include "scene/environment.h"
#include "scene/surface.h"

/* Lights are numbered: emissive triangles, then punctual lights, then the environment. */
struct assay_lights {
    const assay_scene   *scene;
    uint32_t            *emitters; /* triangles, ascending */
    uint32_t             emitter_count;
    bool                 has_infinite;
    assay_distribution1 *choice;       /* among all; NULL without any light      */
    assay_distribution1 *delta_choice; /* among the punctual ones; NULL without  */
};

/* Looks at a textured emitter in this many places; a tenth of the untextured power is added, so
 * that a bright texel that all of them miss can still be found. */
enum { EMISSION_LOOKS = 64 };

static double triangle_power(const assay_scene *scene, uint32_t triangle)
{
    const assay_material *material =
        &scene->materials[scene->shapes[scene->triangle_shape[triangle]].material];
    assay_vec3 ng;
    double     area;
    assay_triangle_geometry(scene, triangle, &ng, &area);
    const double plain    = rgb_luminance(material->emissive);
    double       radiance = plain;
    if (material->emissive_texture.texture != ASSAY_NONE) {
        double       sum    = 0.0;
        assay_random random = assay_random_start(0, ASSAY_STAGE_LIGHTS, triangle, 0);
        for (int i = 0; i < EMISSION_LOOKS; i++) {
            const double       u1 = assay_random_next(&random);
            const double       u2 = assay_random_next(&random);
            assay_surface      surface;
            const assay_point2 at = assay_sample_triangle(u1, u2);
            assay_surface_at(scene, triangle, at.x, at.y, &surface);
            sum += rgb_luminance(assay_surface_emission(scene, &surface, true));
        }
        radiance = 0.9 * sum / EMISSION_LOOKS + 0.1 * plain;
    }
    return ASSAY_PI * area * radiance * (material->emission_two_sided ? 2.0 : 1.0);
}

static double scene_radius(const assay_scene *scene)
{
    const double radius = 0.5 * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    return radius > 0.0 ? radius : 1.0;
}

static double punctual_power(const assay_scene *scene, const assay_punctual_light *light)
{
    const double intensity = rgb_luminance(light->intensity);
    const double radius    = scene_radius(scene);
    switch (light->kind) {
    case ASSAY_LIGHT_POINT: return 4.0 * ASSAY_PI * intensity;
    case ASSAY_LIGHT_SPOT: return 2.0 * ASSAY_PI * (1.0 - light->cos_outer) * intensity;
    case ASSAY_LIGHT_DIRECTIONAL: break;
    }
    return ASSAY_PI * radius * radius * intensity;
}

static double infinite_power(const assay_scene *scene)
{
    const double    radius  = scene_radius(scene);
    const assay_rgb fluence = scene->environment
                                  ? assay_environment_integral(scene->environment)
                                  : rgb_scale(scene->options.background, 4.0 * ASSAY_PI);
    return ASSAY_PI * radius * radius * rgb_luminance(fluence);
}

static assay_status find_emitters(assay_lights *lights)
{
    const assay_scene *scene = lights->scene;
    uint32_t           count = 0;
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        count += assay_triangle_emits(scene, i);
    }
    lights->emitters = assay_allocate(scene->context, count, sizeof *lights->emitters);
    if (!lights->emitters) {
        return assay_fail_memory(scene->context, "the list of lights");
    }
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        if (assay_triangle_emits(scene, i)) {
            lights->emitters[lights->emitter_count++] = i;
        }
    }
    return ASSAY_OK;
}

static assay_status make_choices(assay_lights *lights)
{
    const assay_scene *scene   = lights->scene;
    assay_context     *context = scene->context;
    const size_t       count =
        (size_t)lights->emitter_count + scene->punctual_count + (lights->has_infinite ? 1 : 0);
    if (count == 0) {
        return ASSAY_OK;
    }
    double *power = assay_allocate(context, count, sizeof *power);
    if (!power) {
        return assay_fail_memory(context, "the list of lights");
    }
    size_t n = 0;
    for (uint32_t i = 0; i < lights->emitter_count; i++) {
        power[n++] = triangle_power(scene, lights->emitters[i]);
    }
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        power[n++] = punctual_power(scene, &scene->punctual[i]);
    }
    if (lights->has_infinite) {
        power[n++] = infinite_power(scene);
    }
    assay_status status = assay_distribution1_create(context, power, n, &lights->choice);
    if (status == ASSAY_OK && scene->punctual_count) {
        status = assay_distribution1_create(context, power + lights->emitter_count,
                                            scene->punctual_count, &lights->delta_choice);
    }
    assay_release(context, power);
    return status;
}

assay_status assay_lights_create(const assay_scene *scene, assay_lights **lights_out)
{
    assay_lights *lights = assay_allocate(scene->context, 1, sizeof *lights);
    if (!lights) {
        return assay_fail_memory(scene->context, "the list of lights");
    }
    lights->scene        = scene;
    lights->has_infinite = scene->environment
                               ? !rgb_is_black(assay_environment_integral(scene->environment))
                               : !rgb_is_black(scene->options.background);
    assay_status status  = find_emitters(lights);
    if (status == ASSAY_OK) {
        status = make_choices(lights);
    }
    if (status != ASSAY_OK) {
        assay_lights_destroy(lights);
        return status;
    }
    *lights_out = lights;
    return ASSAY_OK;
}

void assay_lights_destroy(assay_lights *lights)
{
    if (lights) {
        assay_distribution1_destroy(lights->choice);
        assay_distribution1_destroy(lights->delta_choice);
        assay_release(lights->scene->context, lights->emitters);
        assay_release(lights->scene->context, lights);
    }
}

/* Uniform by area.  The pdf is turned into solid angle as seen from the point. */
static bool sample_triangle(const assay_scene *scene, uint32_t triangle, assay_vec3 point,
                            double probability, double u1, double u2, assay_light_sample *out)
{
    const assay_point2 at = assay_sample_triangle(u1, u2);
    assay_surface      surface;
    double             area;
    assay_vec3         ng;
    assay_surface_at(scene, triangle, at.x, at.y, &surface);
    assay_triangle_geometry(scene, triangle, &ng, &area);
    const assay_vec3 to_light = vec3_sub(surface.position, point);
    const double     squared  = vec3_dot(to_light, to_light);
    if (!(squared > 0.0)) {
        return false;
    }
    const double     distance  = sqrt(squared);
    const assay_vec3 direction = vec3_scale(to_light, 1.0 / distance);
    const double     cosine    = -vec3_dot(direction, ng);
    out->radiance              = rgb_scale(assay_surface_emission(scene, &surface, cosine > 0.0),
                                           assay_triangle_coverage(scene, triangle, surface.u, surface.v));
    if (cosine == 0.0 || rgb_is_black(out->radiance)) {
        return false;
    }
    out->to_light  = to_light;
    out->direction = direction;
    out->infinite  = false;
    out->delta     = false;
    out->pdf       = probability * squared / (area * fabs(cosine));
    return true;
}

/* KHR_lights_punctual: falloff over the last part of a light's range. */
static double range_attenuation(double squared_distance, double range)
{
    if (isinf(range)) {
        return 1.0;
    }
    const double ratio = squared_distance / (range * range);
    const double left  = 1.0 - ratio * ratio;
    return left < 0.0 ? 0.0 : left;
}

/* KHR_lights_punctual: from full inside the inner cone to nothing at the outer one. */
static double spot_attenuation(const assay_punctual_light *light, assay_vec3 direction)
{
    const double width  = light->cos_inner - light->cos_outer;
    const double scale  = 1.0 / (width > 0.001 ? width : 0.001);
    const double cosine = -vec3_dot(direction, light->direction);
    double       x      = (cosine - light->cos_outer) * scale;
    x                   = x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
    return x * x;
}

static bool sample_punctual(const assay_punctual_light *light, assay_vec3 point, double probability,
                            assay_light_sample *out)
{
    out->delta = true;
    out->pdf   = probability;
    if (light->kind == ASSAY_LIGHT_DIRECTIONAL) {
        out->infinite  = true;
        out->direction = vec3_negate(light->direction);
        out->to_light  = out->direction;
        out->radiance  = light->intensity;
        return true;
    }
    const assay_vec3 to_light = vec3_sub(light->position, point);
    const double     squared  = vec3_dot(to_light, to_light);
    if (!(squared > 0.0)) {
        return false;
    }
    out->infinite  = false;
    out->to_light  = to_light;
    out->direction = vec3_scale(to_light, 1.0 / sqrt(squared));
    double falloff = range_attenuation(squared, light->range) / squared;
    if (light->kind == ASSAY_LIGHT_SPOT) {
        falloff *= spot_attenuation(light, out->direction);
    }
    out->radiance = rgb_scale(light->intensity, falloff);
    return !rgb_is_black(out->radiance);
}

bool assay_lights_punctual(const assay_punctual_light *light, assay_vec3 point,
                           assay_light_sample *sample_out)
{
    assay_light_sample sample = {0};
    if (!sample_punctual(light, point, 1.0, &sample)) {
        return false;
    }
    *sample_out = sample;
    return true;
}

bool assay_lights_all_punctual(const assay_lights *lights)
{
    return lights->emitter_count == 0 && !lights->has_infinite;
}

/* Density of a constant background over the sphere, or over the half of it that is of use. */
static double background_pdf(const assay_receiver *receiver)
{
    const assay_vec3 n = receiver->normal;
    return n.x == 0.0 && n.y == 0.0 && n.z == 0.0 ? 0.25 * ASSAY_INV_PI : 0.5 * ASSAY_INV_PI;
}

static bool sample_infinite(const assay_scene *scene, const assay_receiver *receiver,
                            double probability, double u1, double u2, assay_light_sample *out)
{
    double pdf;
    if (scene->environment) {
        out->direction = assay_environment_sample(scene->environment, u1, u2, &pdf);
        if (!(pdf > 0.0)) {
            return false;
        }
    } else {
        const assay_vec3 d = assay_sample_sphere(u1, u2);
        out->direction     = vec3_dot(d, receiver->normal) < 0.0 ? vec3_negate(d) : d;
        pdf                = background_pdf(receiver);
    }
    out->radiance = scene->environment
                        ? assay_environment_radiance(scene->environment, out->direction)
                        : scene->options.background;
    out->to_light = out->direction;
    out->infinite = true;
    out->delta    = false;
    out->pdf      = probability * pdf;
    return !rgb_is_black(out->radiance);
}

bool assay_lights_sample(const assay_lights *lights, const assay_receiver *receiver,
                         bool delta_only, double u_choice, double u1, double u2,
                         assay_light_sample *sample_out)
{
    const assay_scene         *scene  = lights->scene;
    const assay_vec3           point  = receiver->point;
    const assay_distribution1 *choice = delta_only ? lights->delta_choice : lights->choice;
    if (!choice) {
        return false;
    }
    double   probability;
    uint32_t index = (uint32_t)assay_distribution1_sample(choice, u_choice, &probability, NULL);
    if (!(probability > 0.0)) {
        return false;
    }
    assay_light_sample sample = {0};
    bool               lit;
    if (delta_only) {
        index += lights->emitter_count;
    }
    if (index < lights->emitter_count) {
        lit = sample_triangle(scene, lights->emitters[index], point, probability, u1, u2, &sample);
    } else if (index - lights->emitter_count < scene->punctual_count) {
        lit = sample_punctual(&scene->punctual[index - lights->emitter_count], point, probability,
                              &sample);
    } else {
        lit = sample_infinite(scene, receiver, probability, u1, u2, &sample);
    }
    if (lit) {
        *sample_out = sample;
    }
    return lit;
}

double assay_lights_pdf_triangle(const assay_lights *lights, uint32_t triangle, double distance,
                                 double cos_light)
{
    uint32_t low = 0, high = lights->emitter_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (lights->emitters[middle] < triangle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    if (low == lights->emitter_count || lights->emitters[low] != triangle) {
        return 0.0;
    }
    assay_vec3 ng;
    double     area;
    assay_triangle_geometry(lights->scene, triangle, &ng, &area);
    return assay_distribution1_probability(lights->choice, low) * distance * distance /
           (area * fabs(cos_light));
}

double assay_lights_pdf_infinite(const assay_lights *lights, const assay_receiver *receiver,
                                 assay_vec3 direction)
{
    if (!lights->has_infinite) {
        return 0.0;
    }
    const size_t last   = (size_t)lights->emitter_count + lights->scene->punctual_count;
    const double inside = lights->scene->environment
                              ? assay_environment_pdf(lights->scene->environment, direction)
                              : background_pdf(receiver);
    return assay_distribution1_probability(lights->choice, last) * inside;
}

assay_rgb assay_lights_infinite_radiance(const assay_lights *lights, assay_vec3 direction)
{
    return lights->scene->environment
               ? assay_environment_radiance(lights->scene->environment, direction)
               : lights->scene->options.background;
}
