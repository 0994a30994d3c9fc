/* test_irradiance_cache_image.c - images by irradiance-cache against `path` with the same bounces.
 *
 * The mistakes that the checks must see: albedo without 1 / pi (or with it twice), a bounce too
 * many or too few, indirect light dropped on what is not Lambertian. */
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

/* A room with a lamp under its ceiling and a box of some material. */
static assay_scene *room(assay_context *context, const char *material)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.5, 0.0, false);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int      thing = material ? scene_builder_material(b, material) : walls;
    scene_builder_box(b, walls, vec3(-1, -1, -1), vec3(1, 1, 1), true);
    scene_builder_box(b, thing, vec3(-0.5, -1, -0.6), vec3(0.3, -0.2, 0.1), false);
    scene_builder_quad(b, lamp, vec3(-0.3, 0.98, -0.3), vec3(0.3, 0.98, -0.3), vec3(0.3, 0.98, 0.3),
                       vec3(-0.3, 0.98, 0.3));
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(-0.1, -0.3, -1), 1.1);
    return scene_builder_load(b, context, NULL);
}

enum { SIZE = 16, MAX_SETTINGS = 16 };

static const setting CACHE[] = {{"method", "irradiance-cache"}, {"spp", "32"},        {"a", "0.15"},
                                {"theta_strata", "12"},         {"phi_strata", "25"}, {NULL, NULL}};
static const setting PATH[]  = {{"spp", "150"}, {NULL, NULL}};

/* The settings and more of them, which come last and so win. */
static assay_image *render(assay_scene *scene, const setting *settings, const setting *more,
                           const char *layers)
{
    setting all[MAX_SETTINGS] = {{NULL, NULL}};
    int     count             = 0;
    for (const setting *s = settings; s->name; s++) {
        all[count++] = *s;
    }
    for (const setting *s = more; s && s->name; s++) {
        assert_true(count + 1 < MAX_SETTINGS);
        all[count++] = *s;
    }
    return measure_render(scene, all, SIZE, SIZE, layers);
}

static bool mean_agrees(const assay_image *image, const assay_image *truth, const char *channel,
                        double factor)
{
    const measured m = measure_mean(image, channel), t = measure_mean(truth, channel);
    const double   error = sqrt(m.error * m.error + t.error * t.error);
    /* 1.5 % is what interpolation at this a may be off by. */
    return fabs(factor * m.value - t.value) <= 5.0 * error + 0.015 * fabs(t.value);
}

static void check_mean(const char *what, const assay_image *image, const assay_image *truth,
                       const char *channel)
{
    const measured m = measure_mean(image, channel), t = measure_mean(truth, channel);
    print_message("#| %-28s %-22s %.5f +- %.5f, path %.5f +- %.5f\n", what, channel, m.value,
                  m.error, t.value, t.error);
    assert_true(mean_agrees(image, truth, channel, 1.0));
    assert_false(mean_agrees(image, truth, channel, 1.15));
    assert_false(mean_agrees(image, truth, channel, 0.85));
}

/* ---- against path ---- */

static void check_scene(const char *what, const char *material, const setting *cache_more,
                        const setting *path_more)
{
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context, material);
    assay_image   *image   = render(scene, CACHE, cache_more, NULL);
    assay_image   *truth   = render(scene, PATH, path_more, NULL);
    check_mean(what, image, truth, "G");
    check_mean(what, image, truth, "Indirect.R");
    check_mean(what, image, truth, "Irradiance.B");
    check_mean(what, image, truth, "IrradianceIndirect.G");
    assay_image_destroy(image);
    assay_image_destroy(truth);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void all_bounces(void **state)
{
    (void)state;
    check_scene("all bounces", NULL, NULL, NULL);
}

static void one_indirect_bounce(void **state)
{
    (void)state;
    const setting direct[] = {{"secondary", "direct"}, {NULL, NULL}};
    const setting two[]    = {{"bounces", "2"}, {NULL, NULL}};
    check_scene("secondary=direct", NULL, direct, two);
    check_scene("bounces=2", NULL, two, two);
}

static void three_bounces(void **state)
{
    (void)state;
    const setting three[] = {{"bounces", "3"}, {NULL, NULL}};
    const setting cache[] = {
        {"bounces", "3"}, {"secondary", "cache"}, {"levels", "4"}, {NULL, NULL}};
    check_scene("bounces=3", NULL, three, three);
    check_scene("bounces=3, two caches", NULL, cache, three);
}

/* Plastic, metal, glass and a mirror: what is not Lambertian comes from paths. */
static void other_materials(void **state)
{
    (void)state;
    static const char *const materials[] = {
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.6,0.3,1],\"metallicFactor\":0,"
        "\"roughnessFactor\":0.3}",
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.6,0.3,1],\"metallicFactor\":0.5,"
        "\"roughnessFactor\":0.5}",
        "\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}",
        "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.4,0.4,0.4,1],\"metallicFactor\":0},"
        "\"extras\":{\"assay\":{\"brdf\":\"phong\",\"specular\":[0.5,0.5,0.5],\"exponent\":20}}"};
    for (size_t i = 0; i < sizeof materials / sizeof materials[0]; i++) {
        char what[40];
        snprintf(what, sizeof what, "material %zu", i);
        check_scene(what, materials[i], NULL, NULL);
    }
}

/* Without indirect light there is nothing to cache. */
static void no_indirect_light(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context, NULL);
    for (int bounces = 0; bounces < 2; bounces++) {
        const setting more[] = {{"bounces", bounces ? "1" : "0"}, {NULL, NULL}};
        assay_image  *image  = render(scene, CACHE, more, NULL);
        assay_image  *truth  = render(scene, PATH, more, NULL);
        assert_true(measure_mean(image, "Indirect.G").value == 0.0);
        assert_true(mean_agrees(image, truth, "G", 1.0));
        assert_true(mean_agrees(image, truth, "Irradiance.G", 1.0));
        assay_image_destroy(image);
        assay_image_destroy(truth);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- passes, traversal ---- */

/* One pass shows another image with the very same records; traversal and layers: layers change no
 * record, traversal does. */
static void passes_and_traversal(void **state)
{
    (void)state;
    assay_context *context  = measure_context(1);
    assay_scene   *scene    = room(context, NULL);
    const setting  few[]    = {{"spp", "1"}, {"a", "0.4"}, {NULL, NULL}};
    const setting  once[]   = {{"spp", "1"}, {"a", "0.4"}, {"passes", "1"}, {NULL, NULL}};
    const setting  coarse[] = {
         {"spp", "1"}, {"a", "0.4"}, {"traversal", "hierarchical"}, {NULL, NULL}};
    assay_image *two  = render(scene, CACHE, few, NULL);
    assay_image *one  = render(scene, CACHE, once, NULL);
    assay_image *hier = render(scene, CACHE, coarse, NULL);
    assay_image *only = render(scene, CACHE, few, "color");
    assert_true(measure_difference(two, one, "IrradianceIndirect.G") > 0.0);
    assert_true(measure_difference(two, one, "IrradianceDirect.G") == 0.0);
    assert_true(measure_difference(two, hier, "IrradianceIndirect.G") > 0.0);
    assert_true(measure_difference(two, only, "G") == 0.0);
    assay_image_destroy(two);
    assay_image_destroy(one);
    assay_image_destroy(hier);
    assay_image_destroy(only);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_bounces),       cmocka_unit_test(one_indirect_bounce),
        cmocka_unit_test(three_bounces),     cmocka_unit_test(other_materials),
        cmocka_unit_test(no_indirect_light), cmocka_unit_test(passes_and_traversal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
