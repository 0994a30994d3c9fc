/* test_path_furnace.c - closed rooms whose light is a geometric series.
 *
 * In a closed room whose walls all have reflectance r and emission Le, radiance with N bounces is
 * Le (1 + r + ... + r^N) everywhere, and irradiance pi Le (1 + ... + r^(N-1)).  The mistakes that
 * the checks must see: one bounce more, and a reflectance of r / pi for r. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/measure.h"
#include "support/scene_builder.h"

static assay_scene *furnace(assay_context *context, double reflectance)
{
    scene_builder *b        = scene_builder_create();
    const int      material = scene_builder_diffuse(b, reflectance, 1.0, true);
    scene_builder_sphere(b, material, vec3(0, 0, 0), 1.0, 3);
    scene_builder_camera(b, vec3(0.3, 0.2, 0.1), vec3(-1, 0, 0), 1.2);
    return scene_builder_load(b, context, NULL);
}

static double series(double r, int terms)
{
    double sum = 0.0, power = 1.0;
    for (int i = 0; i < terms; i++) {
        sum += power;
        power *= r;
    }
    return sum;
}

static void check_room(double r, const char *estimator, int bounces)
{
    char bounce_text[16], what[96];
    snprintf(bounce_text, sizeof bounce_text, "%d", bounces);
    const setting  settings[] = {{"estimator", estimator},
                                 {"bounces", bounce_text},
                                 {"spp", "768"},
                                 {"roulette_depth", "2"},
                                 {NULL, NULL}};
    assay_context *context    = measure_context(2);
    assay_scene   *scene      = furnace(context, r);
    assay_image   *image      = measure_render(scene, settings, 8, 8, NULL);
    snprintf(what, sizeof what, "rho %g, %s, %d bounces", r, estimator, bounces);
    /* r is rounded to float nowhere; 1e-6 is the EXR's float. */
    measure_check(what, measure_mean(image, "R"), series(r, bounces + 1), 1e-6 * series(r, 99),
                  series(r, bounces + 2));
    if (bounces >= 1) {
        measure_check(what, measure_mean(image, "Irradiance.R"), ASSAY_PI * series(r, bounces),
                      1e-5, ASSAY_PI * series(r, bounces + 1));
        measure_check(what, measure_mean(image, "IrradianceDirect.G"), ASSAY_PI, 1e-5,
                      2.0 * ASSAY_PI);
        measure_check(what, measure_mean(image, "Direct.R"), 1.0 + r, 1e-6, 1.0 + r / ASSAY_PI);
    }
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void bounces_are_counted(void **state)
{
    (void)state;
    static const char *const ESTIMATORS[] = {"nee", "bsdf", "mis"};
    for (int e = 0; e < 3; e++) {
        for (int n = 0; n <= 4; n++) {
            check_room(0.5, ESTIMATORS[e], n);
        }
        check_room(0.9, ESTIMATORS[e], 3);
    }
}

/* All bounces: Le / (1 - r), with roulette from early on. */
static void all_bounces(void **state)
{
    (void)state;
    static const double REFLECTANCE[] = {0.5, 0.9};
    for (int i = 0; i < 2; i++) {
        const double  r       = REFLECTANCE[i];
        const setting plain[] = {
            {"estimator", "bsdf"}, {"spp", "4096"}, {"roulette_depth", "3"}, {NULL, NULL}};
        assay_context *context = measure_context(2);
        assay_scene   *scene   = furnace(context, r);
        assay_image   *image   = measure_render(scene, plain, 8, 8, "color,irradiance");
        measure_check("all bounces", measure_mean(image, "R"), 1.0 / (1.0 - r), 1e-5,
                      0.98 / (1.0 - r));
        measure_check("all bounces, irradiance", measure_mean(image, "Irradiance.B"),
                      ASSAY_PI / (1.0 - r), 1e-5, 0.98 * ASSAY_PI / (1.0 - r));
        assay_image_destroy(image);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* In the furnace each BSDF sample finds emission 1: without roulette the estimator `bsdf` has no
 * variance at all, so nothing but rounding may be off. */
static void bsdf_estimator_is_exact(void **state)
{
    (void)state;
    const setting  settings[] = {{"estimator", "bsdf"},
                                 {"bounces", "4"},
                                 {"spp", "4"},
                                 {"roulette_depth", "10"},
                                 {NULL, NULL}};
    assay_context *context    = measure_context(1);
    assay_scene   *scene      = furnace(context, 0.5);
    assay_image   *image      = measure_render(scene, settings, 4, 4, "color");
    assay_channel  channel;
    assert_true(assay_image_find_channel(image, "R", &channel));
    for (int i = 0; i < 16; i++) {
        assert_true(channel.data.f32[i] == 1.9375F);
    }
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* A convex body of reflectance r under a constant sky L shows r L; the sky itself shows L. */
static void under_the_sky(void **state)
{
    (void)state;
    static const char *const ESTIMATORS[] = {"nee", "bsdf", "mis"};
    for (int e = 0; e < 3; e++) {
        const setting settings[]    = {{"estimator", ESTIMATORS[e]}, {"spp", "2048"}, {NULL, NULL}};
        assay_scene_options options = assay_scene_options_default();
        assay_context      *context = measure_context(2);
        scene_builder      *b       = scene_builder_create();
        const int           material = scene_builder_diffuse(b, 0.9, 0.0, false);
        options.background           = rgb(2.0, 1.0, 0.5);
        scene_builder_sphere(b, material, vec3(0, 0, 0), 1.0, 3);
        scene_builder_camera(b, vec3(0, 0, 5), vec3(0, 0, 0), 0.1);
        assay_scene *scene = scene_builder_load(b, context, &options);
        assay_image *image = measure_render(scene, settings, 8, 8, NULL);
        measure_check("sphere under the sky, R", measure_mean(image, "R"), 1.8, 1e-6, 1.74);
        measure_check("sphere under the sky, B", measure_mean(image, "B"), 0.45, 1e-6, 0.9);
        measure_check("irradiance", measure_mean(image, "Irradiance.G"), ASSAY_PI, 1e-5, 3.0);
        assay_image_destroy(image);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounces_are_counted),
        cmocka_unit_test(all_bounces),
        cmocka_unit_test(bsdf_estimator_is_exact),
        cmocka_unit_test(under_the_sky),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
