/* test_cache_queries.c - what dumps of caches say of the pixels' centres is what the image shows
 * there and what a replay makes of the dumped records, splatted or asked. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "assay/replay.h"
#include "core/numerics.h"
#include "io/array_data.h"
#include "io/bundle_read.h"
#include "methods/cache_queries.h"
#include "support/rendered.h"
#include "support/scene_builder.h"

enum { SIDE = 100, PIXELS = SIDE * SIDE, ORDER = 2, ROW = 3 * ORDER * ORDER };

static const setting CACHE[] = {
    {"method", "radiance-cache"}, {"size", "100"},     {"spp", "1"},     {"a", "0.5"},
    {"theta_strata", "4"},        {"phi_strata", "9"}, {"bounces", "2"}, {"secondary", "direct"},
    {"estimator", "nee"},         {"camera", "0"},     {NULL, NULL}};

static const setting GLOSSY[] = {{"order", "2"},           {"grid", "8"},
                                 {"nodes", "16"},          {"layers", "all"},
                                 {"glossy_accuracy", "0"}, {NULL, NULL}};

/* A ball that nearly fills the picture, under a lamp in the open. */
static assay_scene *ball(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      lamp  = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int      floor = scene_builder_diffuse(b, 0.5, 0.0, false);
    const int      metal = scene_builder_material(
             b, "\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.6,0.3,1],\"metallicFactor\":1,"
                     "\"roughnessFactor\":0.8}");
    scene_builder_sphere(b, metal, vec3(0, 0, 0), 0.95, 4);
    scene_builder_quad(b, floor, vec3(-3, -1, 3), vec3(3, -1, 3), vec3(3, -1, -3),
                       vec3(-3, -1, -3));
    scene_builder_quad(b, lamp, vec3(-1, 3, -1), vec3(1, 3, -1), vec3(1, 3, 1), vec3(-1, 3, 1));
    scene_builder_camera(b, vec3(0, 0.2, 2.2), vec3(0, 0, 0), 0.9);
    return scene_builder_load(b, context, NULL);
}

typedef struct {
    rendering            r;
    assay_scene         *scene;
    rendered             made;
    char                *folder;
    assay_bundle_reader *reader;
} dumped;

static void begin(dumped *d, const char *method)
{
    setting more[12] = {{"method", method}};
    int     count    = 0;
    rendering_open(&d->r, 2);
    d->scene           = ball(d->r.context);
    d->folder          = rendered_folder();
    const char *dump   = rendered_path(d->folder, "dump");
    const bool  glossy = strcmp(method, "irradiance-cache") != 0;
    more[count++]      = (setting){"method", method};
    more[count++]      = (setting){"dump", dump};
    for (int i = 0; GLOSSY[i].name && glossy; i++) {
        more[count++] = GLOSSY[i];
    }
    if (!glossy) {
        more[count++] = (setting){"layers", "irradiance,gbuffer"};
    }
    more[count] = (setting){NULL, NULL};
    d->made     = rendered_make(&d->r, d->scene, CACHE, more);
    if (d->made.status != ASSAY_OK) {
        fail_msg("%s", d->made.error);
    }
    assert_int_equal(assay_bundle_open(d->r.context, dump, &d->reader), ASSAY_OK);
}

static void end(dumped *d)
{
    assay_bundle_close(d->reader);
    rendered_drop(&d->made);
    assay_scene_destroy(d->scene);
    rendering_close(&d->r);
    rendered_remove(d->folder);
}

static assay_array *table(dumped *d, const char *name, size_t rows, size_t columns)
{
    assay_array *t = NULL;
    if (assay_bundle_read_table(d->reader, name, rows, columns, &t) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(d->r.context));
    }
    return t;
}

static const float *channel(const dumped *d, const char *name)
{
    assay_channel c;
    assert_true(assay_image_find_channel(d->made.image, name, &c));
    return c.data.f32;
}

/* Every stage that can judge it does, and passes. */
static void check_stage(dumped *d, const char *stage, int arrays)
{
    assay_verdict *verdict = NULL;
    const char    *dump    = rendered_path(d->folder, "dump");
    int            found   = 0;
    assert_int_equal(assay_verdict_create(d->r.context, dump, dump, &verdict), ASSAY_OK);
    assert_int_equal(
        assay_verify_bundle(d->r.context, dump, dump, NULL, ASSAY_PRECISION_FLOAT, verdict),
        ASSAY_OK);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        found += strcmp(assay_verdict_at(verdict, i).stage, stage) == 0;
    }
    assert_int_equal(found, arrays);
    assay_verdict_destroy(verdict);
}

/* Without samples no record is made after a centre was looked at, so the layer is the mean. */
static void irradiance(void **state)
{
    dumped d;
    (void)state;
    begin(&d, "irradiance-cache");
    assay_array  *position = table(&d, "query/position", PIXELS, 3);
    assay_array  *normal   = table(&d, "query/normal", PIXELS, 3);
    assay_array  *mean     = table(&d, "query/irradiance", PIXELS, 3);
    assay_array  *sum      = table(&d, "query/weight_sum", PIXELS, 1);
    const float  *shown = channel(&d, "IrradianceIndirect.G"), *x = channel(&d, "P.X");
    const double *p = assay_array_values(position), *n = assay_array_values(normal);
    int           sky = 0, lit = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        const double e = assay_array_values(mean)[3 * i + 1], w = assay_array_values(sum)[i];
        const bool   none = isnan(p[3 * i]);
        sky += none;
        lit += e > 0.0;
        assert_true(none == isnan(n[3 * i]) && (none ? 0.0F : (float)p[3 * i]) == x[i]);
        assert_true((float)e == shown[i] && (none ? w == 0.0 : w >= 0.5));
    }
    assert_true(sky > 100 && lit > PIXELS / 2);
    check_stage(&d, "interpolate", 2);
    assay_array_destroy(position);
    assay_array_destroy(normal);
    assay_array_destroy(mean);
    assay_array_destroy(sum);
    end(&d);
}

/* What is on the ball is asked, every second pixel of it. */
static void radiance(void **state)
{
    dumped d;
    (void)state;
    begin(&d, "radiance-cache");
    assay_array  *pixel    = table(&d, "radiance_query/pixel", SIZE_MAX, 1);
    const size_t  rows     = assay_array_rows(pixel);
    assay_array  *position = table(&d, "radiance_query/position", rows, 3);
    assay_array  *frame    = table(&d, "radiance_query/frame", rows, 9);
    assay_array  *light    = table(&d, "radiance_query/coefficients", rows, ROW);
    assay_array  *sum      = table(&d, "radiance_query/weight_sum", rows, 1);
    const double *at = assay_array_values(pixel), *p = assay_array_values(position);
    const float  *x = channel(&d, "P.X"), *nx = channel(&d, "N.X");
    size_t        lit = 0, last = 0;
    assert_true(rows > ASSAY_CACHE_QUERIES_MOST / 2 && rows < ASSAY_CACHE_QUERIES_MOST);
    for (size_t i = 0; i < rows; i++) {
        const size_t here = (size_t)at[i];
        assert_true(i == 0 || here > last + 1);
        assert_true((float)p[3 * i] == x[here] && p[3 * i + 1] > -0.95);
        assert_true(fabs(assay_array_values(frame)[9 * i + 6] - nx[here]) < 1e-6);
        assert_true(assay_array_values(sum)[i] >= 0.5);
        lit += assay_array_values(light)[ROW * i] > 0.0;
        last = here;
    }
    assert_true(lit > rows / 2);
    check_stage(&d, "interpolate-radiance", 2);
    assay_array_destroy(pixel);
    assay_array_destroy(position);
    assay_array_destroy(frame);
    assay_array_destroy(light);
    assay_array_destroy(sum);
    end(&d);
}

/* The lobes that are dumped are those that glossy pixels show. */
static void splatted(void **state)
{
    dumped d;
    (void)state;
    begin(&d, "splat");
    check_stage(&d, "splat-glossy", 2);
    check_stage(&d, "splat-glossy-light", 1);
    check_stage(&d, "normalise-glossy", 1);
    end(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(irradiance), cmocka_unit_test(radiance),
                                       cmocka_unit_test(splatted)};
    return cmocka_run_group_tests_name("cache_queries", tests, NULL, NULL);
}
