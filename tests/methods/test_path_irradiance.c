/* test_path_irradiance.c - probes against closed forms: rectangles, spheres, facing squares, and
 * their gradients.
 *
 * The mistakes that the checks must see: the receiver's cosine dropped (seen as the solid angle),
 * the light doubled, a gradient's sign. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/closed_form.h"
#include "support/measure.h"
#include "support/scene_builder.h"

static const char *const ESTIMATORS[] = {"nee", "bsdf", "mis"};

/* A rectangle of 1 x 2 m at height 1 m that shines down. */
static const assay_vec3 RECTANGLE[4] = {{-0.5, 1, -1}, {0.5, 1, -1}, {0.5, 1, 1}, {-0.5, 1, 1}};

static assay_scene *rectangle_scene(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      light = scene_builder_diffuse(b, 0.0, 1.0, false);
    scene_builder_quad(b, light, RECTANGLE[0], RECTANGLE[1], RECTANGLE[2], RECTANGLE[3]);
    return scene_builder_load(b, context, NULL);
}

/* Positions and normals: under the middle, aside, tilted, clipped by the horizon, close, far. */
static const double RECTANGLE_POINTS[][6] = {
    {0, 0, 0, 0, 1, 0},
    {1.5, 0, 0.5, 0, 1, 0},
    {0.2, 0.3, -0.4, 0.6, 0.8, 0},
    {-2, 0.1, 1, 0.8, 0.6, 0},
    {0.4, 0.9, 0.3, 0, 1, 0},
    {3, -2, 1, 0, 0.6, -0.8},
    {0.25, 0, 0.5, 0, 0, 1},
    {0.1, 0.5, -0.9, -0.48, 0.6, 0.64},
};
enum { RECTANGLE_COUNT = sizeof RECTANGLE_POINTS / sizeof RECTANGLE_POINTS[0] };

static assay_vec3 position_of(const double *row) { return vec3(row[0], row[1], row[2]); }
static assay_vec3 normal_of(const double *row) { return vec3(row[3], row[4], row[5]); }

static void rectangle(void **state)
{
    (void)state;
    for (int e = 0; e < 3; e++) {
        const setting  settings[] = {{"estimator", ESTIMATORS[e]},
                                     {"bounces", "1"},
                                     {"spp", "20000"},
                                     {"gradients", "off"},
                                     {NULL, NULL}};
        assay_context *context    = measure_context(2);
        assay_scene   *scene      = rectangle_scene(context);
        assay_array *result = measure_probes(scene, settings, RECTANGLE_POINTS[0], RECTANGLE_COUNT);
        for (int i = 0; i < RECTANGLE_COUNT; i++) {
            const double exact = (double)closed_polygon(
                RECTANGLE, 4, position_of(RECTANGLE_POINTS[i]), normal_of(RECTANGLE_POINTS[i]));
            char what[64];
            snprintf(what, sizeof what, "rectangle, %s, point %d", ESTIMATORS[e], i);
            measure_check(what, measure_probe(result, i, "E.R"), exact, 1e-9, 2.0 * exact);
            measure_check(what, measure_probe(result, i, "EDirect.G"), exact, 1e-9, 0.5 * exact);
            assert_true(measure_probe(result, i, "EIndirect.B").value == 0.0);
        }
        assay_array_destroy(result);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* The dropped cosine would give the solid angle: pi at most; the check must be able to tell. */
static void cosine_is_there(void **state)
{
    (void)state;
    const setting settings[] = {
        {"bounces", "1"}, {"spp", "20000"}, {"gradients", "off"}, {NULL, NULL}};
    assay_context *context  = measure_context(2);
    assay_scene   *scene    = rectangle_scene(context);
    const double   point[6] = {1.5, 0, 0.5, 0, 1, 0};
    assay_array   *result   = measure_probes(scene, settings, point, 1);
    /* Solid angle of the rectangle from (1.5, 0, 0.5): sum of four corner terms atan(ab / (h d)).
     */
    const double a[2] = {1.0, 2.0}, c[2] = {-1.5, 0.5};
    double       solid = 0.0;
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 2; k++) {
            const double sign = i == k ? 1.0 : -1.0;
            solid += sign * assay_atan(a[i] * c[k] / sqrt(1.0 + a[i] * a[i] + c[k] * c[k]));
        }
    }
    measure_check("cosine", measure_probe(result, 0, "E.R"),
                  (double)closed_polygon(RECTANGLE, 4, position_of(point), normal_of(point)), 1e-9,
                  fabs(solid));
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void gradients(void **state)
{
    (void)state;
    static const char *const AXES[3] = {"x", "y", "z"};
    /* Unclipped points: the closed form is smooth there. */
    const setting settings[] = {
        {"bounces", "1"}, {"spp", "40000"}, {"gradient_step", "0.001"}, {NULL, NULL}};
    assay_context *context = measure_context(2);
    assay_scene   *scene   = rectangle_scene(context);
    assay_array   *result  = measure_probes(scene, settings, RECTANGLE_POINTS[0], 4);
    for (int i = 0; i < 4; i++) {
        const assay_vec3 p = position_of(RECTANGLE_POINTS[i]), n = normal_of(RECTANGLE_POINTS[i]);
        const assay_vec3 t              = closed_polygon_gradient(RECTANGLE, 4, p, n);
        const assay_vec3 r              = closed_polygon_rotation(RECTANGLE, 4, p, n);
        const double     translation[3] = {t.x, t.y, t.z}, rotation[3] = {r.x, r.y, r.z};
        for (int k = 0; k < 3; k++) {
            char column[16], what[64];
            snprintf(column, sizeof column, "dE/d%s.R", AXES[k]);
            snprintf(what, sizeof what, "point %d, %s", i, column);
            /* One-sided along the normal: half a step of the second derivative, below 5 per m2. */
            if (fabs(translation[k]) > 0.02) {
                measure_check(what, measure_probe(result, i, column), translation[k], 2.5e-3,
                              -translation[k]);
            } else {
                assert_true(
                    measure_agrees(measure_probe(result, i, column), translation[k], 5.0, 2.5e-3));
            }
            snprintf(column, sizeof column, "dE/da%s.G", AXES[k]);
            snprintf(what, sizeof what, "point %d, %s", i, column);
            if (fabs(rotation[k]) > 0.02) {
                measure_check(what, measure_probe(result, i, column), rotation[k], 1e-5,
                              -rotation[k]);
            } else {
                assert_true(
                    measure_agrees(measure_probe(result, i, column), rotation[k], 5.0, 1e-5));
            }
        }
    }
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* A sphere of 81920 triangles inscribed in the true one: its outline lies within 2e-4 of it. */
static void sphere(void **state)
{
    (void)state;
    static const double POINTS[][6] = {
        {0, 0, 0, 0, 1, 0}, {2, 0, 1, 0, 1, 0}, {-1, 0.5, 0, 0.6, 0.8, 0}, {0, 2, 3, 0, 0, -1}};
    const assay_vec3 centre     = vec3(0, 2, 0);
    const setting    settings[] = {
           {"bounces", "1"}, {"spp", "400000"}, {"gradients", "off"}, {NULL, NULL}};
    assay_context *context = measure_context(2);
    scene_builder *b       = scene_builder_create();
    const int      light   = scene_builder_diffuse(b, 0.0, 1.0, false);
    scene_builder_sphere(b, light, centre, 0.5, 6);
    assay_scene *scene  = scene_builder_load(b, context, NULL);
    assay_array *result = measure_probes(scene, settings, POINTS[0], 4);
    for (int i = 0; i < 4; i++) {
        const double exact =
            (double)closed_sphere(centre, 0.5, position_of(POINTS[i]), normal_of(POINTS[i]));
        char what[32];
        snprintf(what, sizeof what, "sphere, point %d", i);
        measure_check(what, measure_probe(result, i, "E.R"), exact, 4e-4 * exact, 1.05 * exact);
    }
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Two unit squares face each other at 1 m; one shines.  Irradiance averaged over a grid of the
 * other (midpoints, 32 x 32: error below 1e-4 of it) is pi times the form factor
 * 0.19982489569838746. */
static void facing_squares(void **state)
{
    (void)state;
    enum { SIDE = 32 };
    static double points[SIDE * SIDE][6];
    const setting settings[] = {
        {"bounces", "1"}, {"spp", "256"}, {"gradients", "off"}, {NULL, NULL}};
    assay_context *context = measure_context(2);
    scene_builder *b       = scene_builder_create();
    const int      light   = scene_builder_diffuse(b, 0.0, 1.0, false);
    scene_builder_quad(b, light, vec3(0, 1, 0), vec3(1, 1, 0), vec3(1, 1, 1), vec3(0, 1, 1));
    assay_scene *scene = scene_builder_load(b, context, NULL);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double row[6] = {(i % SIDE + 0.5) / SIDE, 0, (i / SIDE + 0.5) / SIDE, 0, 1, 0};
        for (int k = 0; k < 6; k++) {
            points[i][k] = row[k];
        }
    }
    assay_array *result = measure_probes(scene, settings, points[0], SIDE * SIDE);
    measured     mean   = {0, 0};
    for (int i = 0; i < SIDE * SIDE; i++) {
        const measured m = measure_probe(result, i, "E.R");
        mean.value += m.value / (SIDE * SIDE);
        mean.error += m.error * m.error / ((double)SIDE * SIDE * SIDE * SIDE);
    }
    mean.error = sqrt(mean.error);
    assert_true(fabs((double)closed_parallel_squares(1.0, 1.0) - 0.19982489569838746) < 1e-15);
    measure_check("form factor", mean, ASSAY_PI * 0.19982489569838746, 1e-4,
                  0.98 * ASSAY_PI * 0.19982489569838746);
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rectangle), cmocka_unit_test(cosine_is_there), cmocka_unit_test(gradients),
        cmocka_unit_test(sphere),    cmocka_unit_test(facing_squares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
