/* test_path_gradients.c - whether the variances of a probe's gradients are honest where steps are
 * small.
 *
 * One point is probed many times; each row has random numbers of its own.  With the exact gradient
 * from a closed form, a row's deviation over its own standard error is a z-score, and the mean
 * square of n of them is 1 with a standard deviation of sqrt(2 / n).  A difference that meets the
 * edge of a light in one path of a hundred thousand has z-scores of ten and more in the rows that
 * never met it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/closed_form.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/scene_builder.h"

enum { ROWS = 96 };

/* Five standard deviations of the mean square above 1. */
static const double LIMIT = 1.73;

/* Mean square of the rows' z-scores. */
static double mean_square(const assay_array *result, const char *column, double exact)
{
    double sum = 0.0;
    for (int i = 0; i < ROWS; i++) {
        const measured m = measure_probe(result, i, column);
        assert_true(m.error > 0.0);
        sum += (m.value - exact) * (m.value - exact) / (m.error * m.error) / ROWS;
    }
    return sum;
}

static assay_array *probe_rows(assay_scene *scene, const setting *settings, const double point[6])
{
    double rows[ROWS][6];
    for (int i = 0; i < ROWS; i++) {
        memcpy(rows[i], point, sizeof rows[i]);
    }
    return measure_probes(scene, settings, rows[0], ROWS);
}

static void check(const assay_array *result, const char *what, const char *column, double exact)
{
    const double square = mean_square(result, column, exact);
    printf("#| %-10s %-8s z rms %.2f\n", what, column, sqrt(square));
    assert_true(square < LIMIT);
    /* Mutant: a gradient of twice the size. */
    assert_true(mean_square(result, column, 2.0 * exact) > LIMIT);
}

/* A rectangle of 1 x 2 m at height 1 m that shines down on the point. */
static void edges_of_lights(void **state)
{
    (void)state;
    static const assay_vec3  LIGHT[4] = {{-0.5, 1, -1}, {0.5, 1, -1}, {0.5, 1, 1}, {-0.5, 1, 1}};
    static const double      POINT[6] = {0.2, 0.3, -0.4, 0.6, 0.8, 0};
    static const char *const STEPS[]  = {"1e-3", "1e-5", "1e-6"};
    const assay_vec3         p        = vec3(POINT[0], POINT[1], POINT[2]);
    const assay_vec3         n        = vec3(POINT[3], POINT[4], POINT[5]);
    const assay_vec3         t        = closed_polygon_gradient(LIGHT, 4, p, n);
    const assay_vec3         r        = closed_polygon_rotation(LIGHT, 4, p, n);
    assay_context           *context  = measure_context(2);
    scene_builder           *b        = scene_builder_create();
    const int                light    = scene_builder_diffuse(b, 0.0, 1.0, false);
    scene_builder_quad(b, light, LIGHT[0], LIGHT[1], LIGHT[2], LIGHT[3]);
    assay_scene *scene = scene_builder_load(b, context, NULL);
    for (int i = 0; i < 3; i++) {
        const setting settings[] = {{"bounces", "1"},
                                    {"spp", "2048"},
                                    {"gradient_step", STEPS[i]},
                                    {"gradient_angle", STEPS[i]},
                                    {NULL, NULL}};
        assay_array  *result     = probe_rows(scene, settings, POINT);
        check(result, STEPS[i], "dE/dx.R", t.x);
        check(result, STEPS[i], "dE/dy.R", t.y);
        check(result, STEPS[i], "dE/dz.R", t.z);
        check(result, STEPS[i], "dE/daz.R", r.z);
        assay_array_destroy(result);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- light by way of a wall ---- */

/* A lamp of 2 x 2 m beside the point, a little lower, shines up at a ceiling of reflectance 1/2 and
 * half the width WALL at y = 1. */
static const assay_vec3 LAMP[4] = {{-1, -0.01, 1}, {1, -0.01, 1}, {1, -0.01, -1}, {-1, -0.01, -1}};
static const double     WALL    = 40.0;

/* Irradiance at (x, 0, 0.3), facing up: over the ceiling the radiosity rho E / pi times
 * cos cos / d^2, by the midpoint rule in the angles whose tangents are the two distances. */
static double by_way_of_the_wall(double x)
{
    enum { NODES = 200 };
    const double low = atan(-WALL - x), high = atan(WALL - x), side = atan(WALL);
    double       sum = 0.0;
    for (int i = 0; i < NODES; i++) {
        const double a  = low + (high - low) * (i + 0.5) / NODES;
        const double dx = tan(a);
        for (int k = 0; k < NODES; k++) {
            const double dz  = tan(side * (2.0 * (k + 0.5) / NODES - 1.0));
            const double jac = (1.0 + dx * dx) * (1.0 + dz * dz);
            const double dd  = 1.0 + dx * dx + dz * dz;
            sum += (double)closed_polygon(LAMP, 4, vec3(x + dx, 1, 0.3 + dz), vec3(0, -1, 0)) *
                   jac / (dd * dd);
        }
    }
    return 0.5 * ASSAY_INV_PI * sum * (high - low) / NODES * 2.0 * side / NODES;
}

static void edges_of_lights_seen_from_walls(void **state)
{
    (void)state;
    static const double POINT[6]   = {1.2, 0, 0.3, 0, 1, 0};
    const setting       settings[] = {{"bounces", "2"},
                                      {"spp", "4096"},
                                      {"gradient_step", "1e-5"},
                                      {"gradient_angle", "1e-5"},
                                      {NULL, NULL}};
    assay_context      *context    = measure_context(2);
    scene_builder      *b          = scene_builder_create();
    const int           wall       = scene_builder_diffuse(b, 0.5, 0.0, false);
    const int           lamp       = scene_builder_diffuse(b, 0.0, 1.0, false);
    scene_builder_quad(b, wall, vec3(-WALL, 1, -WALL), vec3(WALL, 1, -WALL), vec3(WALL, 1, WALL),
                       vec3(-WALL, 1, WALL));
    scene_builder_quad(b, lamp, LAMP[0], LAMP[1], LAMP[2], LAMP[3]);
    assay_scene *scene  = scene_builder_load(b, context, NULL);
    assay_array *result = probe_rows(scene, settings, POINT);
    const double h      = 1e-3;
    const double exact  = (by_way_of_the_wall(1.2 + h) - by_way_of_the_wall(1.2 - h)) / (2.0 * h);
    check(result, "wall", "dE/dx.R", exact);
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- the bound ---- */

/* Steps too short for the samples are said; the bound is one step in the diagonal (here 5 m) or
 * one radian, all samples together. */
static void short_steps_are_said(void **state)
{
    (void)state;
    static const struct {
        const char *spp, *step, *angle, *gradients;
        bool        said;
    } cases[] = {{"100", "0.051", "0.01", "on", false},  {"100", "0.049", "0.01", "on", true},
                 {"100", "0.051", "0.0099", "on", true}, {"100", "0.001", "0.0001", "off", false},
                 {"1001", "0", "0.001", "on", false},    {"999", "0", "0.0011", "on", true}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        failing_memory memory  = {0};
        assay_context *context = failing_context(&memory);
        scene_builder *b       = scene_builder_create();
        const int      light   = scene_builder_diffuse(b, 0.0, 1.0, false);
        scene_builder_quad(b, light, vec3(0, 0, 0), vec3(3, 0, 0), vec3(3, 4, 0), vec3(0, 4, 0));
        assay_scene  *scene  = scene_builder_load(b, context, NULL);
        assay_params *params = NULL;
        assay_array  *points = NULL, *result = NULL;
        assert_int_equal(assay_method_params(context, "path", &params), ASSAY_OK);
        assert_int_equal(assay_params_set(params, "spp", cases[i].spp), ASSAY_OK);
        assert_int_equal(assay_params_set(params, "gradient_step", cases[i].step), ASSAY_OK);
        assert_int_equal(assay_params_set(params, "gradient_angle", cases[i].angle), ASSAY_OK);
        assert_int_equal(assay_params_set(params, "gradients", cases[i].gradients), ASSAY_OK);
        assert_int_equal(assay_array_create(context, 1, 6, &points), ASSAY_OK);
        memcpy(assay_array_data(points), (double[6]){1, 1, 1, 0, 0, -1}, 6 * sizeof(double));
        memory.log[0] = '\0';
        assert_int_equal(assay_render_probes(scene, "path", params, 0, points, &result, NULL),
                         ASSAY_OK);
        assert_true((strstr(memory.log, "gradients=off") != NULL) == cases[i].said);
        assay_array_destroy(points);
        assay_array_destroy(result);
        assay_params_destroy(params);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(edges_of_lights),
        cmocka_unit_test(edges_of_lights_seen_from_walls),
        cmocka_unit_test(short_steps_are_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
