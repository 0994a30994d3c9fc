/* lit_world.c - the light of the wall is one bounce old where it is seen. */
#include "support/lit_world.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/measure.h"

const assay_vec3 LIT_WALL[4] = {{-0.5, 1, -1}, {0.5, 1, -1}, {0.5, 1, 1}, {-0.5, 1, 1}};

lit_world lit_world_open(scene_builder *builder, int threads)
{
    lit_world w = {.context = measure_context(threads)};
    w.scene     = scene_builder_load(builder, w.context, NULL);
    assert_int_equal(assay_world_create(w.scene, &w.world), ASSAY_OK);
    return w;
}

void lit_world_close(lit_world *w)
{
    assay_world_destroy(w->world);
    assay_scene_destroy(w->scene);
    assay_context_destroy(w->context);
}

/* Reflectance 0.6 under 5 lux from straight below. */
lit_world lit_world_wall(int threads)
{
    scene_builder *b    = scene_builder_create();
    const int      wall = scene_builder_diffuse(b, 0.6, 0.0, false);
    scene_builder_quad(b, wall, LIT_WALL[0], LIT_WALL[1], LIT_WALL[2], LIT_WALL[3]);
    scene_builder_top(b, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
                         "\"directional\",\"intensity\":5}]}}");
    scene_builder_node(b, "\"rotation\":[0.70710678118654752440,0,0,0.70710678118654752440],"
                          "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}");
    return lit_world_open(b, threads);
}

lit_world lit_world_furnace(int threads)
{
    scene_builder *b = scene_builder_create();
    scene_builder_box(b, scene_builder_diffuse(b, 0.5, 1.0, false), vec3(-1, -1, -1), vec3(1, 1, 1),
                      true);
    return lit_world_open(b, threads);
}

assay_irradiance_cache_settings lit_settings(int theta, int phi)
{
    return (assay_irradiance_cache_settings){
        .layout       = {.theta = theta, .phi = phi, .strata = ASSAY_STRATA_COSINE},
        .rules        = {.a              = 0.2,
                         .weight         = ASSAY_WEIGHT_WARD,
                         .gradients      = ASSAY_GRADIENTS_BOTH,
                         .clamp_negative = true},
        .r_max        = INFINITY,
        .r_max_pixels = INFINITY,
        .max_records  = 1000000,
        .secondary    = ASSAY_SECONDARY_DIRECT,
        .levels       = 1,
        .path         = {.bounces = 2, .roulette_depth = 5, .estimator = ASSAY_ESTIMATOR_MIS},
    };
}

assay_cache_point lit_point(assay_vec3 position, assay_vec3 normal)
{
    const assay_vec3 n = vec3_normalize(normal);
    return (assay_cache_point){
        .site = {position, n, frame3_from_z(n)}, .footprint = 0.01, .wanted = true};
}

assay_cache_point *lit_floor(double bend)
{
    assay_cache_point *points = malloc(LIT_FLOOR_POINTS * sizeof *points);
    assert_non_null(points);
    for (int i = 0; i < LIT_FLOOR_POINTS; i++) {
        const int    column = i % LIT_FLOOR_SIDE, row = i / LIT_FLOOR_SIDE;
        const double x = 2.0 * column / LIT_FLOOR_SIDE - 1.0, z = 2.0 * row / LIT_FLOOR_SIDE - 1.0;
        points[i] = lit_point(vec3(x, bend * 0.1 * x * x, z), vec3(bend * -0.2 * x, 1.0, 0.0));
    }
    return points;
}
