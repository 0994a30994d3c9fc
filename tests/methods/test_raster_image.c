/* test_raster_image.c - caches whose hemispheres are rasterised, and shadows by maps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "record/radiance_cache.h"
#include "support/failing_context.h"
#include "support/lit_world.h"
#include "support/measure.h"
#include "support/near.h"

static const double FOV = 2.2142974355881810;

enum { MAX_SETTINGS = 16, SIZE = 12 };

static assay_image *render(assay_scene *scene, const setting *settings, const setting *more)
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
    return measure_render(scene, all, SIZE, SIZE, "irradiance");
}

/* ---- the furnace ---- */

static assay_irradiance_cache_settings settings_of(assay_missing missing)
{
    assay_irradiance_cache_settings settings = lit_settings(64, 64);
    settings.layout.strata                   = ASSAY_STRATA_PLANE;
    settings.layout.fov                      = FOV;
    settings.layout.missing                  = missing;
    settings.path.estimator                  = ASSAY_ESTIMATOR_BSDF;
    return settings;
}

/* Indirect irradiance is pi / 2, times what each way makes of the missing directions. */
static void furnace_by_each_way(void **state)
{
    (void)state;
    const double seen      = 4.0 / ASSAY_PI * (2.0 / sqrt(5.0)) * assay_atan(2.0 / sqrt(5.0));
    const double factors[] = {seen, 1.0, 1.1727, 1.0};
    lit_world    w         = lit_world_furnace(2);
    for (int i = 0; i < 4; i++) {
        const assay_irradiance_cache_settings settings = settings_of((assay_missing)i);
        const assay_cache_point               point = lit_point(vec3(0.3, -1, 0.1), vec3(0, 1, 0));
        assay_irradiance_cache               *cache = NULL;
        assert_int_equal(assay_irradiance_cache_create(w.world, &settings, 3, &cache), ASSAY_OK);
        assert_int_equal(assay_irradiance_cache_fill(cache, NULL, 0, 0, 1, &point, NULL), ASSAY_OK);
        const assay_record *record = assay_record_store_at(assay_irradiance_cache_store(cache), 0);
        assert_near(record->irradiance.g / (0.5 * ASSAY_PI), factors[i], i == 2 ? 5e-5 : 1e-12);
        assert_near(vec3_length(record->rotation[0]), 0.0, 1e-12);
        assert_true(record->mean > 0.5 && record->mean < 2.0);
        assay_irradiance_cache_destroy(cache);
    }
    lit_world_close(&w);
}

/* A radiance record sees the same plane: of a furnace it holds a constant. */
static void radiance_records(void **state)
{
    (void)state;
    lit_world                           w        = lit_world_furnace(1);
    assay_irradiance_cache             *beside   = NULL;
    assay_radiance_cache               *cache    = NULL;
    const assay_radiance_cache_settings settings = {.records =
                                                        settings_of(ASSAY_MISSING_BORDER_CORRECTED),
                                                    .order    = 6,
                                                    .gradient = ASSAY_COEFFICIENT_GRADIENT_WALLS,
                                                    .rotation = ASSAY_HSH_TABLE,
                                                    .rotation_steps = 4};
    const assay_cache_point             point    = lit_point(vec3(0.3, -1, 0.1), vec3(0, 1, 0));
    assert_int_equal(assay_irradiance_cache_create(w.world, &settings.records, 3, &beside),
                     ASSAY_OK);
    assert_int_equal(assay_radiance_cache_create(w.context, beside, &settings, &cache), ASSAY_OK);
    assert_int_equal(assay_irradiance_cache_fill(assay_radiance_cache_records(cache), NULL, 0, 0, 1,
                                                 &point, NULL),
                     ASSAY_OK);
    const double     *c = assay_radiance_cache_coefficients(cache, 0);
    const assay_vec3 *g = assay_radiance_cache_gradients(cache, 0);
    assert_near(c[0], 0.5 * sqrt(ASSAY_TWO_PI), 1e-7);
    for (int i = 1; i < 36; i++) {
        assert_near(c[i], 0.0, 1e-6);
        assert_near(vec3_length(g[i]), 0.0, 1e-12);
    }
    assay_radiance_cache_destroy(cache);
    assay_irradiance_cache_destroy(beside);
    lit_world_close(&w);
}

/* On top of one another, in more than one block of cells: another bounce, pi / 4 more.  No pixel
 * looks exactly at an edge of the box, from where a half would be seen. */
static void levels_of_planes(void **state)
{
    (void)state;
    lit_world                       w        = lit_world_furnace(2);
    assay_irradiance_cache_settings settings = settings_of(ASSAY_MISSING_BORDER_CORRECTED);
    settings.layout.theta = settings.layout.phi = 66;
    settings.rules.a                            = 0.8;
    settings.secondary                          = ASSAY_SECONDARY_CACHE;
    settings.levels                             = 2;
    settings.path.bounces                       = 3;
    const assay_cache_point point = lit_point(vec3(0.3123, -1, 0.1277), vec3(0, 1, 0));
    assay_irradiance_cache *cache = NULL;
    assert_int_equal(assay_irradiance_cache_create(w.world, &settings, 3, &cache), ASSAY_OK);
    assert_int_equal(assay_irradiance_cache_fill(cache, NULL, 0, 0, 1, &point, NULL), ASSAY_OK);
    const assay_record *record = assay_record_store_at(assay_irradiance_cache_store(cache), 0);
    assert_near(record->irradiance.r / ASSAY_PI, 0.75, 1e-10);
    assay_irradiance_cache_destroy(cache);
    lit_world_close(&w);
}

/* ---- a room ---- */

/* A point light under the ceiling and a box on the floor. */
static assay_scene *room(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.5, 0.0, false);
    scene_builder_box(b, walls, vec3(-1, -1, -1), vec3(1, 1, 1), true);
    scene_builder_box(b, walls, vec3(-0.5, -1, -0.6), vec3(0.3, -0.2, 0.1), false);
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(-0.1, -0.3, -1), 1.1);
    scene_builder_top(b, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
                         "\"intensity\":5}]}}");
    scene_builder_node(b, "\"translation\":[0.1,0.8,0.2],\"extensions\":{\"KHR_lights_punctual\":{"
                          "\"light\":0}}");
    return scene_builder_load(b, context, NULL);
}

static const setting RASTER[] = {{"method", "irradiance-cache"},
                                 {"gather", "raster"},
                                 {"secondary", "direct"},
                                 {"spp", "4"},
                                 {"a", "0.2"},
                                 {NULL, NULL}};
static const setting MAP[]    = {{"shadow", "map"}, {NULL, NULL}};
static const setting ONE[]    = {{"bounces", "2"}, {"spp", "400"}, {NULL, NULL}};

/* One bounce, against paths: what remains is what the plane misses; maps hardly change it. */
static void room_against_path(void **state)
{
    (void)state;
    assay_context *context = measure_context(2);
    assay_scene   *scene   = room(context);
    assay_image   *truth = render(scene, ONE, NULL), *ray = render(scene, RASTER, NULL);
    assay_image   *map = render(scene, RASTER, MAP);
    const double   e   = measure_mean(truth, "IrradianceIndirect.G").value;
    const double   r   = measure_mean(ray, "IrradianceIndirect.G").value;
    const double   m   = measure_mean(map, "IrradianceIndirect.G").value;
    print_message("#| indirect irradiance %.4f by paths, %.4f by the raster, %.4f with maps\n", e,
                  r, m);
    assert_true(fabs(r / e - 1.0) < 0.06);
    assert_true(fabs(m / r - 1.0) < 0.02);
    assert_true(m != r);
    assay_image_destroy(truth);
    assay_image_destroy(ray);
    assay_image_destroy(map);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void same_bits_for_all_threads(void **state)
{
    (void)state;
    assay_context *contexts[2];
    assay_image   *images[2];
    for (int i = 0; i < 2; i++) {
        contexts[i]        = measure_context(i == 0 ? 1 : 5);
        assay_scene *scene = room(contexts[i]);
        images[i]          = render(scene, RASTER, MAP);
        assay_scene_destroy(scene);
    }
    static const char *const channels[] = {"IrradianceIndirect.R", "IrradianceIndirect.B"};
    for (int i = 0; i < 2; i++) {
        assert_true(measure_difference(images[0], images[1], channels[i]) == 0.0);
    }
    for (int i = 0; i < 2; i++) {
        assay_image_destroy(images[i]);
        assay_context_destroy(contexts[i]);
    }
}

/* ---- refusals ---- */

static assay_status quick(assay_scene *scene, assay_context *context, const char *method,
                          const char *const (*settings)[2])
{
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    assay_render_options options = assay_render_options_default();
    options.width = options.height = 4;
    assay_status status            = assay_method_params(context, method, &params);
    for (; (*settings)[0] && !status; settings++) {
        status = assay_params_set(params, (*settings)[0], (*settings)[1]);
    }
    status = status ? status : assay_render(scene, method, params, &options, &image, NULL);
    assay_image_destroy(image);
    assay_params_destroy(params);
    return status;
}

static const char *const QUICK[][2] = {
    {"gather", "raster"}, {"secondary", "direct"}, {"shadow", "map"}, {"shadow_size", "32"},
    {"shadow_taps", "4"}, {"raster_size", "8"},    {"spp", "1"},      {"a", "0.6"},
    {NULL, NULL}};

static void memory_refused(void **state)
{
    (void)state;
    int refusals = 0;
    for (uint64_t n = 1;; n++) {
        failing_memory memory     = {0};
        assay_context *context    = failing_context(&memory);
        assay_scene   *scene      = room(context);
        const uint64_t live       = memory.live;
        memory.asked              = 0;
        memory.fail_at            = n;
        const assay_status status = quick(scene, context, "irradiance-cache", QUICK);
        memory.fail_at            = 0;
        assert_true(memory.live == live);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
        if (status == ASSAY_OK) {
            break;
        }
        assert_int_equal(status, ASSAY_ERR_MEMORY);
        refusals++;
    }
    assert_true(refusals > 40);
}

static void settings_that_exclude(void **state)
{
    (void)state;
    static const struct {
        const char *method, *settings[4][2], *word;
    } cases[] = {
        {"irradiance-cache", {{"shadow", "map"}}, "secondary"},
        {"irradiance-cache", {{"shadow", "map"}, {"secondary", "cache"}}, "secondary"},
        {"irradiance-cache",
         {{"shadow", "map"}, {"secondary", "direct"}, {"shadow_taps", "15"}},
         "taps"},
        {"radiance-cache", {{"gather", "raster"}, {"coefficient_gradient", "points"}}, "points"},
        {"splat", {{"gather", "raster"}, {"coefficient_gradient", "points"}}, "points"}};
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(quick(scene, context, cases[i].method, cases[i].settings),
                         ASSAY_ERR_ARGUMENT);
        assert_non_null(strstr(assay_context_error(context), cases[i].word));
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace_by_each_way),       cmocka_unit_test(radiance_records),
        cmocka_unit_test(levels_of_planes),          cmocka_unit_test(room_against_path),
        cmocka_unit_test(same_bits_for_all_threads), cmocka_unit_test(memory_refused),
        cmocka_unit_test(settings_that_exclude),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
