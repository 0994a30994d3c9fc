/* shadow_map.c - depths as lights see them.
 *
 * A receiver is compared from a place off its surface, along its normal, by as much as the farthest
 * tap lies beside it; that is enough for a plane of any slope never to shadow itself
 * (docs/methods/raster.md), and no bias is left to be chosen.
 *
 * Invariant: maps are written once, by assay_shadow_maps_create. */
#include "gather/shadow_map.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "gather/raster.h"
#include "trace/vertex_light.h"

/* A spot whose tangent is above this is seen by six maps, as a point light is. */
static const double WIDEST = 4.0;

/* Over what is needed: rounding. */
static const double SLACK = 1.0 + 0x1p-20;

/* Depths of one view: INFINITY where nothing is hit. */
typedef struct {
    assay_raster_view view;
    double           *depth; /* side * side */
} shadow_map;

typedef struct {
    uint32_t first, count; /* of its maps */
} light_maps;

struct assay_shadow_maps {
    const assay_world    *world;
    assay_shadow_settings settings;
    int                   tap_side; /* root of the taps */
    light_maps           *lights;
    shadow_map           *maps;
    uint32_t              map_count;
};

/* ---- views ---- */

static double tangent_of(const assay_punctual_light *light)
{
    const double c = light->cos_outer;
    return c > 0.0 ? sqrt((1.0 - c) * (1.0 + c)) / c : INFINITY;
}

static uint32_t views_of(const assay_punctual_light *light)
{
    return light->kind == ASSAY_LIGHT_DIRECTIONAL ||
                   (light->kind == ASSAY_LIGHT_SPOT && tangent_of(light) <= WIDEST)
               ? 1
               : 6;
}

/* Face i looks along +x, -x, +y, -y, +z, -z of the world. */
static assay_frame3 face_frame(uint32_t i)
{
    const double sign = i % 2 ? -1.0 : 1.0;
    return frame3_from_z(i < 2   ? vec3(sign, 0.0, 0.0)
                         : i < 4 ? vec3(0.0, sign, 0.0)
                                 : vec3(0.0, 0.0, sign));
}

static assay_raster_view view_of(const assay_shadow_maps *maps, const assay_punctual_light *light,
                                 uint32_t face)
{
    const assay_scene *scene = maps->world->scene;
    assay_raster_view  view  = {.eye     = light->position,
                                .frame   = frame3_from_z(light->direction),
                                .columns = maps->settings.side,
                                .rows    = maps->settings.side};
    if (light->kind == ASSAY_LIGHT_DIRECTIONAL) {
        view.eye      = vec3_scale(vec3_add(scene->bounds_min, scene->bounds_max), 0.5);
        view.parallel = true;
        view.near     = -INFINITY;
        view.half = SLACK * fmax(0.5 * vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min)),
                                 maps->world->offset);
        return view;
    }
    if (views_of(light) == 6) {
        view.frame = face_frame(face);
        view.half  = 1.0;
        return view;
    }
    view.half = SLACK * fmax(tangent_of(light), 0x1p-20);
    return view;
}

/* ---- making ---- */

static size_t texels_of(const assay_shadow_maps *maps)
{
    return (size_t)maps->settings.side * (size_t)maps->settings.side;
}

static assay_status draw(const assay_shadow_maps *maps, shadow_map *map,
                         assay_raster_sample *samples)
{
    assay_context     *context = maps->world->scene->context;
    const size_t       count   = texels_of(maps);
    const assay_status status  = assay_raster_draw(maps->world, &map->view, samples);
    if (status != ASSAY_OK) {
        return status;
    }
    map->depth = assay_allocate(context, count, sizeof *map->depth);
    if (!map->depth) {
        return assay_fail_memory(context, "a shadow map");
    }
    for (size_t i = 0; i < count; i++) {
        map->depth[i] = samples[i].depth;
    }
    return ASSAY_OK;
}

static assay_status draw_all(assay_shadow_maps *maps, assay_raster_sample *samples)
{
    const assay_scene *scene  = maps->world->scene;
    assay_status       status = ASSAY_OK;
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        maps->lights[i] = (light_maps){maps->map_count, views_of(&scene->punctual[i])};
        for (uint32_t f = 0; f < maps->lights[i].count && status == ASSAY_OK; f++) {
            shadow_map *map = &maps->maps[maps->map_count++];
            map->view       = view_of(maps, &scene->punctual[i], f);
            status          = draw(maps, map, samples);
        }
    }
    return status;
}

static assay_status make(assay_shadow_maps *maps)
{
    const assay_scene   *scene   = maps->world->scene;
    const size_t         lights  = scene->punctual_count;
    assay_raster_sample *samples = assay_allocate(scene->context, texels_of(maps), sizeof *samples);
    maps->lights                 = assay_allocate(scene->context, lights, sizeof *maps->lights);
    maps->maps                   = assay_allocate(scene->context, lights * 6, sizeof *maps->maps);
    const assay_status status    = samples && maps->lights && maps->maps
                                       ? draw_all(maps, samples)
                                       : assay_fail_memory(scene->context, "shadow maps");
    assay_release(scene->context, samples);
    return status;
}

static assay_status check(const assay_world *world, const assay_shadow_settings *settings,
                          int *tap_side_out)
{
    assay_context *context = world->scene->context;
    int            root    = 1;
    while (root * root < settings->taps && root < ASSAY_RASTER_MAX / 8) {
        root++;
    }
    if (settings->side < 16 || settings->side > ASSAY_RASTER_MAX || settings->taps < 1 ||
        root * root != settings->taps || root > settings->side / 8) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "shadow maps of %d texels a side with %d taps: 16 ... %d texels, and a "
                          "square number of taps, an eighth of the side across at most",
                          settings->side, settings->taps, ASSAY_RASTER_MAX);
    }
    *tap_side_out = root;
    return ASSAY_OK;
}

assay_status assay_shadow_maps_create(const assay_world           *world,
                                      const assay_shadow_settings *settings,
                                      assay_shadow_maps          **maps_out)
{
    int          tap_side = 0;
    assay_status status   = check(world, settings, &tap_side);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_shadow_maps *maps = assay_allocate(world->scene->context, 1, sizeof *maps);
    if (!maps) {
        return assay_fail_memory(world->scene->context, "shadow maps");
    }
    maps->world    = world;
    maps->settings = *settings;
    maps->tap_side = tap_side;
    status         = make(maps);
    if (status != ASSAY_OK) {
        assay_shadow_maps_destroy(maps);
        return status;
    }
    *maps_out = maps;
    return ASSAY_OK;
}

void assay_shadow_maps_destroy(assay_shadow_maps *maps)
{
    if (maps) {
        assay_context *context = maps->world->scene->context;
        for (uint32_t i = 0; i < maps->map_count; i++) {
            assay_release(context, maps->maps[i].depth);
        }
        assay_release(context, maps->lights);
        assay_release(context, maps->maps);
        assay_release(context, maps);
    }
}

/* ---- looking ---- */

/* The face of six that a direction from the light goes through. */
static uint32_t face_towards(assay_vec3 d)
{
    const double x = fabs(d.x), y = fabs(d.y), z = fabs(d.z);
    if (x >= y && x >= z) {
        return d.x < 0.0 ? 1 : 0;
    }
    return y >= z ? (d.y < 0.0 ? 3 : 2) : (d.z < 0.0 ? 5 : 4);
}

static const shadow_map *map_towards(const assay_shadow_maps *maps, uint32_t light,
                                     assay_vec3 position)
{
    const light_maps *own = &maps->lights[light];
    const uint32_t    face =
        own->count == 6
               ? face_towards(vec3_sub(position, maps->world->scene->punctual[light].position))
               : 0;
    return &maps->maps[own->first + face];
}

/* Off the surface, so far that no tap of a plane is before it: the farthest is `reach` beside it at
 * distance 1, and farther in proportion to the depth that it then has. */
static assay_vec3 stand_off(const assay_shadow_maps *maps, const shadow_map *map,
                            assay_vec3 position, assay_vec3 normal)
{
    const assay_raster_view *view = &map->view;
    const double reach = SLACK * sqrt(0.5) * maps->tap_side * (2.0 * view->half / view->columns);
    const double depth = vec3_dot(view->frame.z, vec3_sub(position, view->eye));
    const double off   = view->parallel ? reach : reach * fmax(depth, 0.0) / (1.0 - reach);
    return vec3_mad(position, off + maps->world->offset, normal);
}

/* The tap_side nearest texels' first, along one axis; p in [-1, 1]. */
static int first_tap(const assay_shadow_maps *maps, double p)
{
    const double at = 0.5 * (p + 1.0) * maps->settings.side - 0.5 * maps->tap_side;
    return (int)assay_floor(at + 0.5);
}

static int within(const assay_shadow_maps *maps, int texel)
{
    return texel < 0 ? 0 : texel >= maps->settings.side ? maps->settings.side - 1 : texel;
}

double assay_shadow_maps_visibility(const assay_shadow_maps *maps, uint32_t light,
                                    assay_vec3 position, assay_vec3 ng)
{
    const assay_punctual_light *source   = &maps->world->scene->punctual[light];
    const shadow_map           *map      = map_towards(maps, light, position);
    const assay_vec3            to_light = source->kind == ASSAY_LIGHT_DIRECTIONAL
                                               ? vec3_negate(source->direction)
                                               : vec3_sub(source->position, position);
    const assay_vec3            normal   = vec3_dot(to_light, ng) < 0.0 ? vec3_negate(ng) : ng;
    const assay_vec3            stand    = stand_off(maps, map, position, normal);
    map                                  = map_towards(maps, light, stand);
    const assay_raster_view *view        = &map->view;
    const assay_vec3         at = frame3_to_local(&view->frame, vec3_sub(stand, view->eye));
    const double             w  = view->half * (view->parallel ? 1.0 : at.z);
    if (!(fabs(at.x) <= w && fabs(at.y) <= w)) {
        return 1.0; /* out of a spot's cone */
    }
    const int i = first_tap(maps, at.x / w), j = first_tap(maps, at.y / w);
    int       clear = 0;
    for (int k = 0; k < maps->settings.taps; k++) {
        const int column = within(maps, i + k % maps->tap_side);
        const int row    = within(maps, j + k / maps->tap_side);
        clear += map->depth[(size_t)row * (size_t)view->columns + (size_t)column] >= at.z;
    }
    return clear / (double)maps->settings.taps;
}

/* ---- light ---- */

/* What the vertex scatters of a light that nothing hides. */
static assay_rgb unhidden(const assay_vertex *vertex, const assay_bsdf_view *view,
                          const assay_light_sample *light)
{
    const assay_vec3 wi      = frame3_to_local(&vertex->frame, light->direction);
    const bool       through = wi.z * vertex->wo_local.z < 0.0;
    return assay_vertex_sides_agree(vertex, light->direction, through)
               ? rgb_scale(rgb_mul(assay_bsdf_view_evaluate(view, wi).value, light->radiance),
                           1.0 / light->pdf)
               : rgb_grey(0.0);
}

/* One sample of the lights that have no map; those that have one count as 0. */
static assay_rgb others(const assay_world *world, const assay_vertex *vertex,
                        const assay_bsdf_view *view, assay_random *random, assay_ray_counts *counts)
{
    const double         u_choice = assay_random_next(random);
    const double         u1       = assay_random_next(random);
    const double         u2       = assay_random_next(random);
    const assay_receiver receiver = assay_vertex_as_receiver(vertex);
    assay_light_sample   light;
    if (!assay_lights_sample(world->lights, &receiver, false, u_choice, u1, u2, &light) ||
        light.delta) {
        return rgb_grey(0.0);
    }
    const assay_rgb all = unhidden(vertex, view, &light);
    if (rgb_is_black(all)) {
        return all;
    }
    assay_vec3 along;
    return rgb_scale(all, assay_vertex_sees_light(world, vertex, &light, &along, &counts->shadow));
}

assay_rgb assay_shadow_maps_light(const assay_shadow_maps *maps, assay_vertex *vertex,
                                  assay_random *random, assay_ray_counts *counts)
{
    const assay_world   *world = maps->world;
    const assay_surface *at    = &vertex->surface;
    assay_rgb            sum   = rgb_grey(0.0);
    assay_vertex_dress(world, vertex);
    const assay_bsdf_view view = assay_bsdf_seen_from(&vertex->bsdf, vertex->wo_local);
    if (view.specular) {
        return sum;
    }
    if (!assay_lights_all_punctual(world->lights)) {
        sum = others(world, vertex, &view, random, counts);
    }
    for (uint32_t i = 0; i < world->scene->punctual_count; i++) {
        assay_light_sample light;
        if (assay_lights_punctual(&world->scene->punctual[i], at->position, &light)) {
            const assay_rgb all = unhidden(vertex, &view, &light);
            if (!rgb_is_black(all)) {
                sum = rgb_add(sum, rgb_scale(all, assay_shadow_maps_visibility(
                                                      maps, i, at->position, at->ng)));
            }
        }
    }
    return sum;
}
