/* test_path_lights.c - punctual lights, mirrors and glass: closed forms without any noise.
 *
 * Punctual lights leave nothing to chance, so a probe must give the closed form up to rounding.  In
 * a furnace of radiance 1 a mirror and clear glass show 1, whatever path the light takes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/measure.h"
#include "support/scene_builder.h"

static const char LIGHTS[] = "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[%s]}}";

/* A floor far below, so that the scene has a surface, and one light at (0, 2, 0) turned by a
 * quaternion. */
static assay_scene *lit_scene(assay_context *context, const char *light, const char *rotation)
{
    scene_builder *b     = scene_builder_create();
    const int      floor = scene_builder_diffuse(b, 0.5, 0.0, true);
    char           text[512];
    scene_builder_quad(b, floor, vec3(-9, -9, 9), vec3(9, -9, 9), vec3(9, -9, -9),
                       vec3(-9, -9, -9));
    snprintf(text, sizeof text, LIGHTS, light);
    scene_builder_top(b, text);
    snprintf(text, sizeof text,
             "\"translation\":[0,2,0],\"rotation\":[%s],\"extensions\":{\"KHR_lights_punctual\":{"
             "\"light\":0}}",
             rotation);
    scene_builder_node(b, text);
    return scene_builder_load(b, context, NULL);
}

/* Lights shine along -Z of their node: this turns it to -Y. */
static const char DOWN[]  = "-0.70710678118654752440,0,0,0.70710678118654752440";
static const char ALONG[] = "0,0,0,1";

static void check_points(const char *light, const char *rotation, const double (*points)[6],
                         const double *expected, int count)
{
    const setting settings[] = {{"bounces", "1"}, {"spp", "2"}, {"gradients", "off"}, {NULL, NULL}};
    assay_context *context   = measure_context(1);
    assay_scene   *scene     = lit_scene(context, light, rotation);
    assay_array   *result    = measure_probes(scene, settings, points[0], count);
    for (int i = 0; i < count; i++) {
        const measured m = measure_probe(result, i, "E.R");
        assert_true(m.error <= 1e-9 * fabs(m.value));
        if (!measure_agrees(m, expected[i], 0.0, 1e-12 * (1.0 + fabs(expected[i])))) {
            fail_msg("%.60s: point %d: %.17g, not %.17g", light, i, m.value, expected[i]);
        }
        /* Mutants: the light doubled, the cosine or the distance forgotten once. */
        assert_true(expected[i] == 0.0 || !measure_agrees(m, 2.0 * expected[i], 0.0, 1e-9));
    }
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void point_light(void **state)
{
    (void)state;
    static const double POINTS[][6] = {
        {0, 0, 0, 0, 1, 0}, {3, 0, 0, 0, 1, 0}, {0, 0, 2, 0, 0.8, -0.6}, {0, 3, 0, 0, 1, 0}};
    /* I cos / d^2 with I = 5. */
    const double expected[] = {5.0 / 4.0, 5.0 * 2.0 / (13.0 * sqrt(13.0)),
                               5.0 * 2.8 / (8.0 * sqrt(8.0)), 0.0};
    check_points("{\"type\":\"point\",\"intensity\":5}", ALONG, POINTS, expected, 4);
}

/* KHR_lights_punctual: max(0, 1 - (d / range)^4) / d^2. */
static void point_light_with_range(void **state)
{
    (void)state;
    static const double POINTS[][6] = {
        {0, 0, 0, 0, 1, 0}, {0, -1, 0, 0, 1, 0}, {0, -3, 0, 0, 1, 0}};
    const double expected[] = {5.0 / 4.0 * (1.0 - 16.0 / 256.0), 5.0 / 9.0 * (1.0 - 81.0 / 256.0),
                               0.0};
    check_points("{\"type\":\"point\",\"intensity\":5,\"range\":4}", ALONG, POINTS, expected, 3);
}

static void spot_light(void **state)
{
    (void)state;
    /* Straight below; at 45 degrees, between the cones; outside the outer cone. */
    static const double POINTS[][6] = {{0, 0, 0, 0, 1, 0}, {2, 0, 0, 0, 1, 0}, {9, 0, 0, 0, 1, 0}};
    const double        inner = assay_cos(0.5), outer = assay_cos(1.0);
    const double        edge       = (sqrt(0.5) - outer) / (inner - outer);
    const double        expected[] = {3.0 / 4.0, 3.0 * edge * edge * sqrt(0.5) / 8.0, 0.0};
    check_points("{\"type\":\"spot\",\"intensity\":3,\"spot\":{\"innerConeAngle\":0.5,"
                 "\"outerConeAngle\":1.0}}",
                 DOWN, POINTS, expected, 3);
}

static void directional_light(void **state)
{
    (void)state;
    static const double POINTS[][6] = {
        {0, 0, 0, 0, 1, 0}, {5, -3, 1, 0.6, 0.8, 0}, {0, 0, 0, 1, 0, 0}, {0, 0, 0, 0, -1, 0}};
    const double expected[] = {7.0, 5.6, 0.0, 0.0};
    check_points("{\"type\":\"directional\",\"intensity\":7}", DOWN, POINTS, expected, 4);
}

/* A wall between: no light. */
static void shadow(void **state)
{
    (void)state;
    static const double POINT[][6] = {{0, 0, 0, 0, 1, 0}};
    const setting settings[] = {{"bounces", "1"}, {"spp", "2"}, {"gradients", "off"}, {NULL, NULL}};
    assay_context *context   = measure_context(1);
    scene_builder *b         = scene_builder_create();
    const int      wall      = scene_builder_diffuse(b, 0.5, 0.0, false);
    char           text[512];
    scene_builder_quad(b, wall, vec3(-1, 1, 1), vec3(1, 1, 1), vec3(1, 1, -1), vec3(-1, 1, -1));
    snprintf(text, sizeof text, LIGHTS, "{\"type\":\"point\",\"intensity\":5}");
    scene_builder_top(b, text);
    scene_builder_node(b, "\"translation\":[0,2,0],\"extensions\":{\"KHR_lights_punctual\":{"
                          "\"light\":0}}");
    assay_scene *scene  = scene_builder_load(b, context, NULL);
    assay_array *result = measure_probes(scene, settings, POINT[0], 1);
    assert_true(measure_probe(result, 0, "E.R").value == 0.0);
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- specular bodies in a furnace ---- */

static void check_body(const char *material, double radiance, double tolerance)
{
    const setting       settings[] = {{"spp", "16"}, {NULL, NULL}};
    assay_scene_options options    = assay_scene_options_default();
    assay_context      *context    = measure_context(2);
    scene_builder      *b          = scene_builder_create();
    options.background             = rgb(1.0, 1.0, 1.0);
    scene_builder_sphere(b, scene_builder_material(b, material), vec3(0, 0, 0), 1.0, 4);
    scene_builder_camera(b, vec3(0, 0, 5), vec3(0, 0, 0), 0.5);
    assay_scene  *scene = scene_builder_load(b, context, &options);
    assay_image  *image = measure_render(scene, settings, 32, 32, "color");
    assay_channel red, variance;
    assert_true(assay_image_find_channel(image, "R", &red));
    assert_true(assay_image_find_channel(image, "Variance.R", &variance));
    for (int i = 0; i < 32 * 32; i++) {
        const measured m = {red.data.f32[i], sqrt(variance.data.f32[i])};
        const bool     body =
            (i % 32 - 15.5) * (i % 32 - 15.5) + (i / 32 - 15.5) * (i / 32 - 15.5) < 9.0 * 9.0;
        if (body && !measure_agrees(m, radiance, 6.0, tolerance)) {
            fail_msg("pixel %d: %.9g +- %.2g, not %.9g", i, m.value, m.error, radiance);
        }
    }
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void mirror(void **state)
{
    (void)state;
    check_body("\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}", 1.0, 1e-6);
}

/* Roulette is noise here, of weights whose mean is exactly 1. */
static void glass(void **state)
{
    (void)state;
    check_body("\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},"
               "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
               "\"KHR_materials_ior\":{\"ior\":1.5},"
               "\"KHR_materials_volume\":{\"thicknessFactor\":1}}",
               1.0, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(point_light), cmocka_unit_test(point_light_with_range),
        cmocka_unit_test(spot_light),  cmocka_unit_test(directional_light),
        cmocka_unit_test(shadow),      cmocka_unit_test(mirror),
        cmocka_unit_test(glass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
