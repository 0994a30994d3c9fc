/* test_probe_driver.c - irradiance at points: what is refused, what is odd but fine, and means and
 * variances over passes.  The method is `path`. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/scene_builder.h"

/* A lamp over a floor. */
static assay_scene *lit_floor(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      floor = scene_builder_diffuse(b, 0.5, 0.0, true);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 4.0, false);
    scene_builder_quad(b, floor, vec3(-2, 0, 2), vec3(2, 0, 2), vec3(2, 0, -2), vec3(-2, 0, -2));
    scene_builder_quad(b, lamp, vec3(-1, 2, -1), vec3(1, 2, -1), vec3(1, 2, 1), vec3(-1, 2, 1));
    return scene_builder_load(b, context, NULL);
}

typedef struct {
    assay_context *context;
    assay_scene   *scene;
    assay_params  *params;
} bench;

static bench open_bench(void)
{
    bench b = {.context = measure_context(1)};
    b.scene = lit_floor(b.context);
    assert_int_equal(assay_method_params(b.context, "path", &b.params), ASSAY_OK);
    assert_int_equal(assay_params_set(b.params, "spp", "1"), ASSAY_OK);
    return b;
}

static void close_bench(bench *b)
{
    assay_params_destroy(b->params);
    assay_scene_destroy(b->scene);
    assay_context_destroy(b->context);
}

static void set(bench *b, const char *name, const char *value)
{
    assert_int_equal(assay_params_set(b->params, name, value), ASSAY_OK);
}

static assay_status probe(bench *b, const double *values, size_t rows, size_t columns,
                          assay_array **result)
{
    assay_array *points = NULL;
    assert_int_equal(assay_array_create(b->context, rows, columns, &points), ASSAY_OK);
    memcpy(assay_array_data(points), values, rows * columns * sizeof *values);
    const assay_status status =
        assay_render_probes(b->scene, "path", b->params, 1, points, result, NULL);
    assay_array_destroy(points);
    return status;
}

static void bad_points(void **state)
{
    (void)state;
    static const struct {
        size_t       columns;
        double       row[7];
        assay_status status;
    } cases[] = {
        {5, {0, 0, 0, 0, 1}, ASSAY_ERR_ARGUMENT},
        {7, {0, 0, 0, 0, 1, 0, 0}, ASSAY_ERR_ARGUMENT},
        {6, {0, 0, 0, 0, 0, 0}, ASSAY_ERR_ARGUMENT},
        {6, {NAN, 0, 0, 0, 1, 0}, ASSAY_ERR_DOMAIN},
        {6, {0, INFINITY, 0, 0, 1, 0}, ASSAY_ERR_DOMAIN},
        {6, {0, 0, 0, 0, NAN, 0}, ASSAY_ERR_DOMAIN},
        {6, {0, 0, 0, 0, 0, -INFINITY}, ASSAY_ERR_DOMAIN},
    };
    bench b = open_bench();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assay_array *const no_result = (assay_array *)&b;
        assay_array       *result    = no_result;
        assert_int_equal(probe(&b, cases[i].row, 1, cases[i].columns, &result), cases[i].status);
        assert_ptr_equal(result, no_result);
        assert_non_null(strstr(assay_context_error(b.context), "points:"));
    }
    close_bench(&b);
}

/* Normals of any length, positions anywhere; no points at all. */
static void odd_points(void **state)
{
    (void)state;
    static const double rows[4][6] = {{0, 1e-3, 0, 0, 1, 0},
                                      {0, 1e-3, 0, 0, 1e-300, 0},
                                      {0, 1e-3, 0, 0, 1e300, 0},
                                      {1e30, 1e30, 0, 0, 1, 0}};
    bench               b          = open_bench();
    assay_array        *result     = NULL;
    assert_int_equal(probe(&b, rows[0], 4, 6, &result), ASSAY_OK);
    assert_int_equal(assay_array_columns(result), ASSAY_PROBE_COLUMNS);
    /* Random numbers differ from row to row; what they measure does not. */
    for (int i = 0; i < 3; i++) {
        assert_true(measure_probe(result, i, "E.R").value > 0.0);
    }
    assert_true(measure_probe(result, 3, "E.R").value == 0.0);
    assay_array_destroy(result);
    result = NULL;
    set(&b, "gradients", "off");
    set(&b, "spp", "1000000000");
    assert_int_equal(probe(&b, rows[0], 0, 6, &result), ASSAY_OK);
    assert_int_equal(assay_array_rows(result), 0);
    assert_int_equal(assay_array_columns(result), ASSAY_PROBE_COLUMNS_PLAIN);
    assay_array_destroy(result);
    close_bench(&b);
}

/* Every path either finds the lamp, and is worth 4 pi, or nothing.  So n times the mean is 4 pi
 * times a whole number c, and the sum of squared deviations (4 pi)^2 c (n - c) / n. */
static void probes_over_passes(void **state)
{
    (void)state;
    static const int    counts[] = {1, 2, 64, 4095, 4096, 4097, 4098, 8191, 8192, 8193, 10000};
    static const double row[6]   = {0.3, 1e-3, 0.2, 0, 1, 0};
    const double        worth    = 4.0 * ASSAY_PI;
    double              hits = 0.0, hits_4096 = 0.0;
    bench               b = open_bench();
    set(&b, "gradients", "off");
    set(&b, "estimator", "bsdf");
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        const int    n      = counts[i];
        assay_array *result = NULL;
        char         spp[16];
        snprintf(spp, sizeof spp, "%d", n);
        set(&b, "spp", spp);
        assert_int_equal(probe(&b, row, 1, 6, &result), ASSAY_OK);
        const measured e = measure_probe(result, 0, "E.R");
        const double   c = floor(n * e.value / worth + 0.5);
        assert_near(n * e.value / worth, c, 1e-8);
        assert_near(n * (n - 1.0) * e.error * e.error, worth * worth * c * (n - c) / n, 1e-6 * n);
        /* More samples are the same ones and new ones. */
        assert_true(c >= hits && c - hits <= n - (i ? counts[i - 1] : 0));
        assert_true(n != 8192 || c != 2.0 * hits_4096);
        hits      = c;
        hits_4096 = n == 4096 ? c : hits_4096;
        assay_array_destroy(result);
    }
    assert_true(hits > 100.0 && hits < 9900.0);
    close_bench(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_points),
        cmocka_unit_test(odd_points),
        cmocka_unit_test(probes_over_passes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
