/* test_hemisphere.c - cells, irradiance and mean distances against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <float.h>
#include <string.h>

#include "core/numerics.h"
#include "math/quadrature.h"
#include "support/closed_form.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/seen.h"

static const assay_strata STRATA[] = {ASSAY_STRATA_COSINE, ASSAY_STRATA_UNIFORM};
enum { KINDS = 2 };

/* ---- cells ---- */

/* A direction lies between the borders of its cell, for any numbers in [0, 1), is of unit length
 * and above the horizon. */
static void directions_lie_in_their_cells(void **state)
{
    (void)state;
    static const double numbers[] = {0.0, 0.25, 0.5, 0.875, 1.0 - 0x1p-53};
    for (int s = 0; s < KINDS; s++) {
        const assay_hemisphere_layout layout = {.theta = 7, .phi = 12, .strata = STRATA[s]};
        for (int i = 0; i < 7 * 12 * 25; i++) {
            const int        j = i / (12 * 25), k = i / 25 % 12;
            const double     u1 = numbers[i % 5], u2 = numbers[i / 5 % 5];
            const assay_vec3 d = assay_hemisphere_direction(&layout, j, k, u1, u2);
            const double     inner =
                s == 0 ? 1.0 - d.z * d.z : 1.0 - d.z; /* 1 - z^2 or 1 - z, between j/M, (j+1)/M */
            double phi = atan2(d.y, d.x);
            phi += phi < -1e-12 ? 2.0 * ASSAY_PI : 0.0;
            assert_near(vec3_dot(d, d), 1.0, 8 * DBL_EPSILON);
            assert_true(d.z > 0.0);
            assert_near(inner, (j + u1) / 7.0, 4 * DBL_EPSILON);
            if (j + u1 > 0.0 && k + u2 < 12.0) {
                assert_near(phi, 2.0 * ASSAY_PI * (k + u2) / 12.0, 32 * DBL_EPSILON);
            }
        }
    }
}

/* Cells of one strata kind have one solid angle, or one projected solid angle; all make 2 pi. */
static void solid_angles(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    for (int s = 0; s < KINDS; s++) {
        const assay_hemisphere_layout layout     = {.theta = 33, .phi = 5, .strata = STRATA[s]};
        assay_hemisphere             *hemisphere = NULL;
        assert_int_equal(assay_hemisphere_create(context, &layout, &hemisphere), ASSAY_OK);
        double sum = 0.0;
        for (int j = 0; j < 33; j++) {
            const double a = acos(s == 0 ? sqrt(1.0 - j / 33.0) : 1.0 - j / 33.0);
            const double b = acos(s == 0 ? sqrt(1.0 - (j + 1) / 33.0) : 1.0 - (j + 1) / 33.0);
            assert_near(assay_hemisphere_solid_angle(hemisphere, j),
                        2.0 * ASSAY_PI / 5.0 * (cos(a) - cos(b)), 1e-14);
            sum += 5.0 * assay_hemisphere_solid_angle(hemisphere, j);
        }
        assert_near(sum, 2.0 * ASSAY_PI, 1e-14);
        assay_hemisphere_destroy(context, hemisphere);
    }
    assay_context_destroy(context);
}

/* Nothing written: nothing seen. */
static void starts_empty(void **state)
{
    (void)state;
    assay_context                *context = measure_context(1);
    const assay_hemisphere_layout layout  = {
         .theta = 2, .phi = 2, .strata = ASSAY_STRATA_COSINE, .jitter = true};
    assay_hemisphere *hemisphere = NULL;
    assay_vec3        g[3];
    assert_int_equal(assay_hemisphere_create(context, &layout, &hemisphere), ASSAY_OK);
    assert_true(assay_hemisphere_irradiance(hemisphere).r == 0.0);
    assert_true(assay_hemisphere_harmonic_mean(hemisphere, ASSAY_MEAN_UNIFORM) == INFINITY);
    assert_true(assay_hemisphere_harmonic_mean(hemisphere, ASSAY_MEAN_COSINE) == INFINITY);
    assert_true(assay_hemisphere_nearest(hemisphere) == INFINITY);
    hemisphere->cells[1].radiance = rgb_grey(2.0); /* a light at infinity moves no border */
    assay_hemisphere_translation_gradient(hemisphere, true, g);
    assert_true(vec3_length(g[0]) == 0.0 && vec3_length(g[2]) == 0.0);
    assay_hemisphere_rotation_gradient(hemisphere, g);
    assert_true(vec3_length(g[1]) > 0.5);
    assay_hemisphere_destroy(context, hemisphere);
    assay_hemisphere_destroy(context, NULL);
    assay_context_destroy(context);
}

static void refuses(void **state)
{
    (void)state;
    static const assay_hemisphere_layout bad[] = {
        {.theta = 1, .phi = 8, .strata = ASSAY_STRATA_COSINE},
        {.theta = 8, .phi = 1, .strata = ASSAY_STRATA_COSINE},
        {.theta = 4097, .phi = 8, .strata = ASSAY_STRATA_UNIFORM},
        {.theta = 8, .phi = 4097, .strata = ASSAY_STRATA_UNIFORM},
        {.theta = -3, .phi = 8, .strata = ASSAY_STRATA_UNIFORM},
        {.theta = 8, .phi = 8, .strata = (assay_strata)3}};
    assay_context *context = measure_context(1);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assay_hemisphere *hemisphere = NULL;
        assert_int_equal(assay_hemisphere_create(context, &bad[i], &hemisphere),
                         ASSAY_ERR_ARGUMENT);
        assert_null(hemisphere);
        assert_true(strlen(assay_context_error(context)) > 0);
    }
    assay_context_destroy(context);
}

static assay_status create_one(assay_context *context, void *user)
{
    assay_hemisphere  *hemisphere = NULL;
    const assay_status status     = assay_hemisphere_create(context, user, &hemisphere);
    assay_hemisphere_destroy(context, hemisphere);
    return status;
}

static void survives_without_memory(void **state)
{
    (void)state;
    assay_hemisphere_layout layout = {.theta = 4, .phi = 12, .strata = ASSAY_STRATA_COSINE};
    assert_int_equal(failing_each(create_one, &layout), 4);
}

/* ---- a furnace ---- */

/* Seen from anywhere in a sphere of radiance L: E = pi L; what is a difference is exactly 0. */
static void furnace(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    const seen_object wall    = seen_sphere(vec3(0.2, -0.1, 0.3), 1.0, 0.7);
    const seen_scene  scene   = seen_from_origin(&wall, 1);
    for (int i = 0; i < 4; i++) {
        assay_vec3        g[3], t[3];
        assay_hemisphere *h = seen_hemisphere(context, &scene, 16, 51, STRATA[i % 2], i >= 2, 17);
        assay_hemisphere_rotation_gradient(h, g);
        assay_hemisphere_translation_gradient(h, true, t);
        for (int c = 0; c < 3; c++) {
            assert_true(g[c].x == 0.0 && g[c].y == 0.0 && g[c].z == 0.0);
            assert_true(t[c].x == 0.0 && t[c].y == 0.0 && t[c].z == 0.0);
        }
        /* Jittered cosines alone vary: by less than 1 / sqrt(12) of a stratum's height each. */
        const bool   exact = i != 3;
        const double error = ASSAY_TWO_PI * 0.7 / sqrt(12.0) / 16 / sqrt(16.0 * 51.0);
        assert_near(assay_hemisphere_irradiance(h).b, ASSAY_PI * 0.7, exact ? 1e-14 : 5.0 * error);
        assay_hemisphere_destroy(context, h);
    }
    assay_context_destroy(context);
}

/* ---- irradiance ---- */

/* The vector of a polygon that is wholly or partly above the horizon against its own definitions:
 * n . Phi is the irradiance, n x Phi the rotational gradient. */
static void lambert_vector(void **state)
{
    (void)state;
    const seen_object quads[] = {
        seen_quad(vec3(0.3, 0.2, 1.5), vec3(0.8, 0, 0), vec3(0, 0.6, 0.1), 1.0),
        seen_quad(vec3(1.1, 0.3, 0.2), vec3(0, 0.9, 0), vec3(0, 0, 0.8), 1.0)};
    const assay_vec3 p = {0, 0, 0}, n = {0, 0, 1};
    for (int i = 0; i < 2; i++) {
        const assay_vec3 phi = closed_polygon_vector(quads[i].vertices, 4, p, n);
        const assay_vec3 g   = closed_polygon_rotation(quads[i].vertices, 4, p, n);
        const assay_vec3 v   = vec3_cross(n, phi);
        assert_near(phi.z, (double)closed_polygon(quads[i].vertices, 4, p, n), 1e-15);
        assert_near(vec3_length(vec3_sub(g, v)), 0.0, 1e-11);
    }
}

/* A frame of one's own: what is seen does not depend on it, up to the place of the cells. */
static void irradiance_in_a_turned_frame(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    const seen_object quad =
        seen_quad(vec3(0.3, 0.2, 1.5), vec3(0.8, 0, 0.1), vec3(0, 0.6, 0), 1.0);
    seen_scene scene = seen_from_origin(&quad, 1);
    for (int i = 0; i < 3; i++) {
        const assay_vec3 n = vec3_normalize(vec3(0.3 * i, -0.2 * i, 1.0));
        scene.frame        = frame3_from_z(n);
        scene.eye          = vec3(0.1, 0.1 * i, 0.0);
        assay_hemisphere *h =
            seen_hemisphere(context, &scene, 128, 402, ASSAY_STRATA_COSINE, false, 0);
        assert_near(assay_hemisphere_irradiance(h).r,
                    (double)closed_polygon(quad.vertices, 4, scene.eye, n), 0.002);
        assay_hemisphere_destroy(context, h);
    }
    assay_context_destroy(context);
}

/* ---- mean distances ---- */

/* A plane overhead that fills all but the last 0.1 percent of a degree. */
static seen_object ceiling(double height)
{
    return seen_quad(vec3(0, 0, height), vec3(1e6, 0, 0), vec3(0, 1e6, 0), 1.0);
}

/* At height 1 distances are 1 / cos theta: uniform 1 / (1/2), by cosine 1 / (2/3).  The mean of z
 * over strata of z is exact, of z^2 right to M^-2.  Over strata of z^2 the last one has the height
 * M^-1/2 and errs in z by as much: 1 / M for the uniform mean; M^-1.5 where the cosine weighs it.
 */
static void mean_under_a_ceiling(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    const seen_object plane   = ceiling(1.0);
    const seen_scene  scene   = seen_from_origin(&plane, 1);
    for (int s = 0; s < KINDS; s++) {
        for (int m = 16; m <= 256; m *= 4) {
            assay_hemisphere *h       = seen_hemisphere(context, &scene, m, 8, STRATA[s], false, 0);
            const double      uniform = assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_UNIFORM);
            const double      cosine  = assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_COSINE);
            print_message("#| ceiling, %s strata, M %3d: R %.6f uniform (2), %.6f cosine (1.5)\n",
                          s == 0 ? "cosine " : "uniform", m, uniform, cosine);
            assert_near(uniform, 2.0, s == 1 ? 1e-14 : 1.0 / m);
            assert_near(cosine, 1.5, pow(m, -1.5));
            assert_near(assay_hemisphere_nearest(h), 1.0, s == 1 ? 0.6 / m : 0.3 / m);
            assay_hemisphere_destroy(context, h);
        }
    }
    assay_context_destroy(context);
}

/* The integrals of 1 / r and of cos theta / r over what a rectangle covers, by Gauss over its area:
 * z is its height, or (upright) the plane x = z with heights b0 ... b1. */
static void add_rectangle(double z, double a0, double a1, double b0, double b1, bool upright,
                          double sums[2])
{
    enum { NODES = 40 };
    double a[NODES], wa[NODES], b[NODES], wb[NODES];
    assay_gauss_legendre_on(a0, a1, NODES, a, wa);
    assay_gauss_legendre_on(b0, b1, NODES, b, wb);
    for (int i = 0; i < NODES * NODES; i++) {
        const double x = a[i % NODES], y = b[i / NODES], w = wa[i % NODES] * wb[i / NODES];
        const double r2 = x * x + y * y + z * z;
        sums[0] += w * z / (r2 * r2);
        sums[1] += w * z * (upright ? y : z) / (r2 * r2 * sqrt(r2));
    }
}

/* From the middle of the floor of a unit cube, all closed, and with the ceiling alone: what is not
 * hit counts in the weights.  1 / r is continuous in the cube: M^-1.5 = 0.002 as above; the
 * ceiling's edge crosses some 2 M of 3 M^2 cells, each half right. */
static void mean_in_a_cube(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    const seen_object faces[] = {
        seen_quad(vec3(0, 0, 1), vec3(0.5, 0, 0), vec3(0, 0.5, 0), 1.0),
        seen_quad(vec3(0.5, 0, 0.5), vec3(0, 0.5, 0), vec3(0, 0, 0.5), 1.0),
        seen_quad(vec3(-0.5, 0, 0.5), vec3(0, 0.5, 0), vec3(0, 0, 0.5), 1.0),
        seen_quad(vec3(0, 0.5, 0.5), vec3(0.5, 0, 0), vec3(0, 0, 0.5), 1.0),
        seen_quad(vec3(0, -0.5, 0.5), vec3(0.5, 0, 0), vec3(0, 0, 0.5), 1.0)};
    double top[2] = {0, 0}, all[2] = {0, 0};
    add_rectangle(1.0, -0.5, 0.5, -0.5, 0.5, false, top);
    add_rectangle(0.5, -0.5, 0.5, 0.0, 1.0, true, all);
    all[0] = 4.0 * all[0] + top[0];
    all[1] = 4.0 * all[1] + top[1];
    assert_near(2.0 * ASSAY_PI / all[0], 0.68553, 5e-6);
    assert_near(ASSAY_PI / all[1], 0.77768, 5e-6);
    for (int s = 0; s < KINDS; s++) {
        for (int closed = 0; closed < 2; closed++) {
            const seen_scene  scene = seen_from_origin(faces, closed ? 5 : 1);
            const double     *truth = closed ? all : top;
            assay_hemisphere *h = seen_hemisphere(context, &scene, 64, 200, STRATA[s], false, 0);
            const double      uniform = assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_UNIFORM);
            const double      cosine  = assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_COSINE);
            print_message("#| %s, %s strata, M 64: R %.5f uniform (%.5f), %.5f cosine (%.5f)\n",
                          closed ? "cube" : "its ceiling alone", s == 0 ? "cosine " : "uniform",
                          uniform, 2.0 * ASSAY_PI / truth[0], cosine, ASSAY_PI / truth[1]);
            assert_near(uniform * truth[0] / (2.0 * ASSAY_PI), 1.0, closed ? 2e-3 : 5e-3);
            assert_near(cosine * truth[1] / ASSAY_PI, 1.0, closed ? 2e-3 : 5e-3);
            assay_hemisphere_destroy(context, h);
        }
    }
    assay_context_destroy(context);
}

/* All at one distance: any mean is it. */
static void mean_in_a_sphere(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    const seen_object wall    = seen_sphere(vec3(0, 0, 0), 2.5, 1.0);
    const seen_scene  scene   = seen_from_origin(&wall, 1);
    for (int i = 0; i < 4; i++) {
        assay_hemisphere *h = seen_hemisphere(context, &scene, 16, 50, STRATA[i % 2], i >= 2, 3);
        assert_near(assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_UNIFORM), 2.5, 1e-13);
        assert_near(assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_COSINE), 2.5, 1e-13);
        assert_near(assay_hemisphere_nearest(h), 2.5, 1e-14);
        assay_hemisphere_destroy(context, h);
    }
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(directions_lie_in_their_cells),
                                       cmocka_unit_test(solid_angles),
                                       cmocka_unit_test(starts_empty),
                                       cmocka_unit_test(refuses),
                                       cmocka_unit_test(survives_without_memory),
                                       cmocka_unit_test(furnace),
                                       cmocka_unit_test(lambert_vector),
                                       cmocka_unit_test(irradiance_in_a_turned_frame),
                                       cmocka_unit_test(mean_under_a_ceiling),
                                       cmocka_unit_test(mean_in_a_cube),
                                       cmocka_unit_test(mean_in_a_sphere)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
