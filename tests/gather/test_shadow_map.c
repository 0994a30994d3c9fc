/* test_shadow_map.c - maps of depth against rays to the same lights. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>

#include "core/numerics.h"
#include "gather/shadow_map.h"
#include "support/failing_context.h"
#include "support/lit_world.h"
#include "support/measure.h"

static const char *const LIGHTS[4] = {
    "{\"type\":\"directional\",\"intensity\":2}", "{\"type\":\"point\",\"intensity\":30}",
    "{\"type\":\"spot\",\"intensity\":30,\"spot\":{\"outerConeAngle\":0.9}}",
    "{\"type\":\"spot\",\"intensity\":30,\"spot\":{\"outerConeAngle\":1.5}}"};

/* A light at (0, 3, 0) that shines down. */
static void add_light(scene_builder *b, const char *light)
{
    char top[256];
    snprintf(top, sizeof top, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[%s]}}", light);
    scene_builder_top(b, top);
    scene_builder_node(b, "\"translation\":[0,3,0],\"rotation\":[-0.70710678118654752440,0,0,"
                          "0.70710678118654752440],\"extensions\":{\"KHR_lights_punctual\":{"
                          "\"light\":0}}");
}

static assay_shadow_maps *maps_of(const lit_world *w, int side, int taps)
{
    const assay_shadow_settings settings = {side, taps};
    assay_shadow_maps          *maps     = NULL;
    assert_int_equal(assay_shadow_maps_create(w->world, &settings, &maps), ASSAY_OK);
    return maps;
}

static double draw(assay_random *random, double low, double high)
{
    return low + (high - low) * assay_random_next(random);
}

/* A plane of any slope, far larger than the map's view, never shadows itself: not one tap of it. */
static void planes_do_not_shadow_themselves(void **state)
{
    (void)state;
    static const int taps[] = {1, 4, 9, 16, 25};
    for (uint64_t k = 0; k < 60; k++) {
        assay_random   random = assay_random_start(31, ASSAY_STAGE_TEST, k, 0);
        scene_builder *b      = scene_builder_create();
        const double   lean   = draw(&random, -6.0, 6.0);
        const double   across = draw(&random, -2.0, 2.0);
        const int      m      = scene_builder_diffuse(b, 0.5, 0.0, true);
        const double   far    = 40.0;
        scene_builder_quad(
            b, m, vec3(-far, far * (across - lean), far), vec3(far, far * (across + lean), far),
            vec3(far, far * (lean - across), -far), vec3(-far, far * (-lean - across), -far));
        add_light(b, LIGHTS[k % 4]);
        lit_world          w    = lit_world_open(b, 1);
        assay_shadow_maps *maps = maps_of(&w, 48, taps[k % 5]);
        for (int i = 0; i < 400; i++) {
            assay_surface s;
            const double  v = draw(&random, 0.0, 1.0), u = draw(&random, 0.0, 1.0 - v);
            assay_surface_at(w.scene, (uint32_t)(i % 2), u, v, &s);
            const assay_vec3 n = i % 4 < 2 ? s.ng : vec3_negate(s.ng);
            assert_true(assay_shadow_maps_visibility(maps, 0, s.position, n) == 1.0);
        }
        assay_shadow_maps_destroy(maps);
        lit_world_close(&w);
    }
}

/* A half plane of shade at height 1 over a floor: where the shadow ends, how wide its edge is, and
 * how it falls. */
static void edge_of_a_shadow(void **state)
{
    (void)state;
    for (int k = 0; k < 8; k++) {
        const int      taps = k < 4 ? 16 : 1;
        scene_builder *b    = scene_builder_create();
        const int      m    = scene_builder_diffuse(b, 0.5, 0.0, true);
        scene_builder_quad(b, m, vec3(-3, 0, 3), vec3(3, 0, 3), vec3(3, 0, -3), vec3(-3, 0, -3));
        scene_builder_quad(b, m, vec3(-2, 1, 2), vec3(0.2, 1, 2), vec3(0.2, 1, -2),
                           vec3(-2, 1, -2));
        add_light(b, LIGHTS[k % 4]);
        lit_world          w    = lit_world_open(b, 1);
        assay_shadow_maps *maps = maps_of(&w, 512, taps);
        /* The light is 3 above the floor, the shade 2 under it. */
        const double edge = k % 4 == 0 ? 0.2 : 0.3;
        /* Half a map: the bounding sphere; at depth 3 the cone, or a face. */
        const double half  = k % 4 == 0 ? 0.5 * sqrt(73.0) : k % 4 == 2 ? 3 * assay_tan(0.9) : 3.0;
        const double texel = 2.0 * half / 512.0;
        const double reach = 3.0 * texel; /* 2 of the taps, 1 of the shade's own edge */
        double       sum = 0.0, last = 0.0;
        for (int i = 0; i < 2000; i++) {
            const double x = edge - 20 * texel + 40 * texel * (i + 0.5) / 2000;
            const double v = assay_shadow_maps_visibility(maps, 0, vec3(x, 0, 0.11), vec3(0, 1, 0));
            assert_true(x > edge - reach || v == 0.0);
            assert_true(x < edge + reach || v == 1.0);
            assert_true(v >= last);
            last = v;
            sum += v / 2000;
        }
        assert_true(fabs(sum * 40 * texel - 20 * texel) < 0.8 * texel);
        assay_shadow_maps_destroy(maps);
        lit_world_close(&w);
    }
}

/* ---- light at vertices ---- */

static bool vertex_at(const lit_world *w, assay_random *random, assay_vertex *vertex)
{
    const assay_vec3 origin =
        vec3(draw(random, -1.8, 1.8), draw(random, 0.2, 2.5), draw(random, -1.8, 1.8));
    const double       z       = draw(random, -1.0, 1.0);
    const double       turn    = draw(random, 0.0, 1.0);
    const assay_sincos azimuth = assay_sincos_turns(turn);
    const double       out     = sqrt(1.0 - z * z);
    const assay_vec3   d       = vec3(out * azimuth.cos, z, out * azimuth.sin);
    uint64_t           rays    = 0;
    assay_hit          hit;
    if (!assay_world_closest(w->world, origin, d, false, random, &rays, &hit)) {
        return false;
    }
    assay_vertex_place(w->world, &hit, d, vertex);
    assay_vertex_dress(w->world, vertex);
    return true;
}

/* A shading normal that leans, as smooth meshes have it. */
static void lean(assay_vertex *vertex)
{
    const assay_vec3 n = vec3_normalize(vec3_mad(vertex->frame.z, 2.0, vertex->frame.x));
    if ((vec3_dot(n, vertex->wo) >= 0.0) == vertex->front) {
        vertex->frame    = frame3_from_z(n);
        vertex->wo_local = frame3_to_local(&vertex->frame, vertex->wo);
    }
}

/* In a room with some things, under one light of each kind: where the map says all or nothing, it
 * is what a path's direct light is, but for few points beside edges. */
static void agrees_with_rays(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene_builder *b = scene_builder_create();
        const int      m = scene_builder_diffuse(b, 0.5, 0.0, true);
        if (k == 0) { /* the sun needs an open sky */
            scene_builder_quad(b, m, vec3(-2, 0, 2), vec3(2, 0, 2), vec3(2, 0, -2),
                               vec3(-2, 0, -2));
        } else {
            scene_builder_box(b, m, vec3(-2, 0, -2), vec3(2, 4, 2), true);
        }
        scene_builder_box(b, m, vec3(-1, 0, -1), vec3(-0.5, 1.5, 0.2), false);
        scene_builder_box(b, m, vec3(0.2, 0.3, -0.6), vec3(1.1, 0.9, 0.5), false);
        scene_builder_sphere(b, m, vec3(0.3, 1.6, 0.9), 0.4, 3);
        scene_builder_quad(b, m, vec3(-1.8, 1.2, 1.8), vec3(-0.3, 1.2, 1.8), vec3(-0.3, 1.2, 0.3),
                           vec3(-1.8, 1.2, 0.3)); /* thin: lit above, dark below */
        for (int i = 0; i < 4; i++) {             /* shades beside the light, one a face */
            const double x = i < 2 ? 1.6 * i - 0.8 : 0.0, z = i < 2 ? 0.0 : 1.6 * i - 4.0;
            scene_builder_box(b, m, vec3(x - 0.2, 2.8, z - 0.2), vec3(x + 0.2, 3.2, z + 0.2),
                              false);
        }
        add_light(b, LIGHTS[k]);
        lit_world                 w      = lit_world_open(b, 1);
        assay_shadow_maps        *maps   = maps_of(&w, 1024, 16);
        const assay_path_settings direct = {
            .bounces = 1, .roulette_depth = 5, .estimator = ASSAY_ESTIMATOR_NEE};
        int same = 0, off = 0, lit = 0;
        for (uint64_t i = 0; i < 4000; i++) {
            assay_random     random = assay_random_start(33, ASSAY_STAGE_TEST, i, (uint64_t)k);
            assay_ray_counts counts = {0};
            assay_vertex     vertex;
            if (!vertex_at(&w, &random, &vertex)) {
                continue;
            }
            if (i % 3 == 0) {
                lean(&vertex);
            }
            const assay_rgb map = assay_shadow_maps_light(maps, &vertex, &random, &counts);
            assert_int_equal(counts.shadow, 0);
            const assay_rgb ray =
                assay_path_scatter(w.world, &direct, &vertex, &random, &counts).direct;
            const bool agree = fabs(map.g - ray.g) <= 1e-12 * (map.g + ray.g);
            same += agree;
            off += !agree;
            lit += ray.g > 0.0;
        }
        print_message("light %d: %d the same, %d not, %d lit\n", k, same, off, lit);
        assert_true(off < (same + off) / 60);
        assert_true(lit > 500);
        assay_shadow_maps_destroy(maps);
        lit_world_close(&w);
    }
}

/* Light that is before the shading normal and behind the surface does not exist, though the other
 * side of a thin surface is lit. */
static void behind_a_thin_surface(void **state)
{
    (void)state;
    scene_builder *b = scene_builder_create();
    const int      m = scene_builder_diffuse(b, 0.5, 0.0, true);
    scene_builder_quad(b, m, vec3(-2, 1, 2), vec3(2, 1, 2), vec3(2, 1, -2), vec3(-2, 1, -2));
    add_light(b, LIGHTS[1]);
    lit_world          w      = lit_world_open(b, 1);
    assay_shadow_maps *maps   = maps_of(&w, 256, 4);
    assay_random       random = assay_random_start(1, ASSAY_STAGE_TEST, 0, 0);
    assay_ray_counts   counts = {0};
    assay_hit          hit;
    assay_vertex       vertex;
    const assay_vec3   up = vec3(0, 1, 0);
    assert_true(assay_world_closest(w.world, vec3(-0.5, 0, 0.1), up, false, &random,
                                    &counts.scatter, &hit));
    assay_vertex_place(w.world, &hit, up, &vertex);
    vertex.frame    = frame3_from_z(vec3_normalize(vec3(0.95, -0.1, 0)));
    vertex.wo_local = frame3_to_local(&vertex.frame, vertex.wo);
    assert_true(rgb_is_black(assay_shadow_maps_light(maps, &vertex, &random, &counts)));
    assert_true(assay_shadow_maps_visibility(maps, 0, vertex.surface.position, up) == 1.0);
    assay_shadow_maps_destroy(maps);
    lit_world_close(&w);
}

/* Lights without a map are ray-traced: the mean over many samples is that of paths. */
static void others_are_traced(void **state)
{
    (void)state;
    lit_world w = {.context = measure_context(1)};
    assert_int_equal(assay_scene_load(w.context, "scenes/colonnade/colonnade.gltf", NULL, &w.scene),
                     ASSAY_OK);
    assert_int_equal(assay_world_create(w.scene, &w.world), ASSAY_OK);
    assay_shadow_maps        *maps   = maps_of(&w, 1024, 16);
    const assay_path_settings direct = {
        .bounces = 1, .roulette_depth = 5, .estimator = ASSAY_ESTIMATOR_NEE};
    double           by_map = 0.0, by_ray = 0.0, square = 0.0;
    assay_ray_counts counts = {0};
    const int        count  = 12000;
    for (uint64_t i = 0; i < (uint64_t)count; i++) {
        assay_random     random = assay_random_start(35, ASSAY_STAGE_TEST, i, 0);
        const assay_vec3 origin = vec3(draw(&random, -8.0, 8.0), 1.5, draw(&random, -3.0, 3.0));
        assay_vertex     vertex;
        assay_hit        hit;
        const assay_vec3 d = vec3_normalize(
            vec3(draw(&random, -1, 1), draw(&random, -1, 0.5), draw(&random, -1, 1)));
        uint64_t rays = 0;
        if (!assay_world_closest(w.world, origin, d, false, &random, &rays, &hit)) {
            continue;
        }
        assay_vertex_place(w.world, &hit, d, &vertex);
        const double map = assay_shadow_maps_light(maps, &vertex, &random, &counts).g;
        const double ray = assay_path_scatter(w.world, &direct, &vertex, &random, &counts).direct.g;
        by_map += map / count;
        by_ray += ray / count;
        square += (map - ray) * (map - ray) / count;
    }
    const double error = sqrt(square / count);
    print_message("colonnade: direct light %.5f by maps, %.5f by rays, error %.5f\n", by_map,
                  by_ray, error);
    assert_true(fabs(by_map - by_ray) < 5.0 * error + 0.03 * by_ray);
    assert_true(error < 0.1 * by_ray && counts.shadow > 0);
    assay_shadow_maps_destroy(maps);
    lit_world_close(&w);
}

static void refuses(void **state)
{
    (void)state;
    static const assay_shadow_settings bad[] = {{8, 1},   {8193, 1}, {64, 0},  {64, 2},
                                                {64, 15}, {64, 81},  {64, -4}, {-64, 4}};
    lit_world                          w     = lit_world_wall(1);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assay_shadow_maps *maps = NULL;
        assert_int_equal(assay_shadow_maps_create(w.world, &bad[i], &maps), ASSAY_ERR_ARGUMENT);
        assert_null(maps);
    }
    lit_world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(planes_do_not_shadow_themselves),
        cmocka_unit_test(edge_of_a_shadow),
        cmocka_unit_test(agrees_with_rays),
        cmocka_unit_test(behind_a_thin_surface),
        cmocka_unit_test(others_are_traced),
        cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
