/* test_projection.c - coefficients by quadrature, by Monte Carlo and from samples. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "assay/basis.h"
#include "support/basis_fixture.h"
#include "support/failing_context.h"
#include "support/near.h"

enum { ORDER = 5, MOST = ORDER * ORDER };
static const double PI = 3.14159265358979323846;

/* All functions of a basis as channels. */
static void own_functions(void *user, assay_vec3 d, double *values_out)
{
    assert_int_equal(assay_basis_evaluate(user, d, values_out), ASSAY_OK);
}

/* The coefficients of each function of a basis are a unit vector: orthonormality, the weight of
 * Makhotkin's functions and the solution for LSOSH in one. */
static void functions_have_unit_coefficients(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = basis_make(*state, (assay_basis_kind)kind, ORDER);
        const size_t n     = assay_basis_count(basis);
        double       c[MOST * MOST];
        assert_int_equal(
            assay_basis_project(basis, *state, own_functions, basis, (int)n, 20, 20, c), ASSAY_OK);
        for (size_t i = 0; i < n * n; i++) {
            assert_near(c[i], i % (n + 1) == 0 ? 1.0 : 0.0, 3e-13);
        }
        assay_basis_destroy(basis);
    }
}

static void fifth_power(void *user, assay_vec3 d, double *values_out)
{
    (void)user;
    values_out[0] = pow(d.z, 5.0);
}

/* z^5 is a polynomial of degree 5: from order 6 on its HSH are it, and all its energy, 2 pi / 11.
 */
static void fifth_power_is_in_hsh_from_order_6(void **state)
{
    for (int order = 5; order <= 7; order++) {
        assay_basis *basis = basis_make(*state, ASSAY_BASIS_HSH, order);
        double       c[49], energy = 0.0;
        assert_int_equal(assay_basis_project(basis, *state, fifth_power, NULL, 1, 16, 16, c),
                         ASSAY_OK);
        for (int i = 0; i < order * order; i++) {
            energy += c[i] * c[i];
        }
        if (order < 6) {
            assert_true(energy < 2.0 * PI / 11.0 - 1e-6);
        } else {
            assert_near(energy, 2.0 * PI / 11.0, 1e-15);
        }
        assay_basis_destroy(basis);
    }
}

static void hemisphere_of_light(void *user, assay_vec3 d, double *values_out)
{
    (void)user;
    values_out[0] = exp(d.x) * (d.z + 0.3 * d.y);
    values_out[1] = 1.0 / (1.5 - d.z);
}

static void one(void *user, assay_vec3 d, double *values_out)
{
    (void)user;
    (void)d;
    values_out[0] = 1.0;
}

/* Radiance 1 gives irradiance pi, and c_0 = sqrt(4 pi). */
static void furnace_through_the_clamped_cosine(void **state)
{
    assay_basis *basis = basis_make(*state, ASSAY_BASIS_SH, ORDER);
    double       c[MOST], a[ORDER], y[MOST], irradiance = 0.0;
    assert_int_equal(assay_basis_project(basis, *state, one, NULL, 1, 8, 12, c), ASSAY_OK);
    assert_int_equal(assay_clamped_cosine(ORDER, a), ASSAY_OK);
    assert_int_equal(assay_basis_evaluate(basis, (assay_vec3){0.48, -0.6, 0.64}, y), ASSAY_OK);
    for (int i = 0; i < MOST; i++) {
        int l, m;
        assay_basis_function(basis, (size_t)i, &l, &m);
        irradiance += a[l] * c[i] * y[i];
    }
    assert_near(c[0], sqrt(4.0 * PI), 1e-14);
    assert_near(irradiance, PI, 1e-13);
    assay_basis_destroy(basis);
}

/* The estimate is within 4 standard errors of the quadrature, and on the whole as far from it as
 * its variance says. */
static void monte_carlo_agrees_with_quadrature(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = basis_make(*state, (assay_basis_kind)kind, 3);
        const size_t n     = 2 * assay_basis_count(basis);
        double       exact[18], mean[18], variance[18], z2 = 0.0;
        assert_int_equal(
            assay_basis_project(basis, *state, hemisphere_of_light, NULL, 2, 48, 48, exact),
            ASSAY_OK);
        assert_int_equal(assay_basis_project_random(basis, *state, hemisphere_of_light, NULL, 2,
                                                    20000, 7, mean, variance),
                         ASSAY_OK);
        for (size_t i = 0; i < n; i++) {
            assert_true(variance[i] > 0.0);
            const double z = (mean[i] - exact[i]) / sqrt(variance[i]);
            assert_true(fabs(z) < 4.0);
            z2 += z * z / (double)n;
        }
        assert_true(z2 > 0.1 && z2 < 2.5);
        assay_basis_destroy(basis);
    }
}

/* Samples over the whole sphere, on a spiral: those below the horizon count as zero. */
static void samples_of_somebody_else(void **state)
{
    enum { COUNT = 20000 };
    static assay_vec3 d[COUNT];
    static double     pdf[COUNT], value[2 * COUNT];
    assay_basis      *basis = basis_make(*state, ASSAY_BASIS_HSH, 3);
    double            exact[18], mean[18], variance[18];
    for (int i = 0; i < COUNT; i++) {
        const double z = (2.0 * i + 1.0) / COUNT - 1.0, s = sqrt(1.0 - z * z);
        const double phi = 2.399963229728653 * i;
        d[i]             = (assay_vec3){s * cos(phi), s * sin(phi), z};
        pdf[i]           = 0.25 / PI;
        hemisphere_of_light(NULL, d[i], value + 2 * i);
    }
    assert_int_equal(
        assay_basis_project_samples(basis, *state, COUNT, d, pdf, value, 2, mean, variance),
        ASSAY_OK);
    assert_int_equal(
        assay_basis_project(basis, *state, hemisphere_of_light, NULL, 2, 48, 48, exact), ASSAY_OK);
    for (int i = 0; i < 18; i++) {
        /* A spiral is better than chance. */
        assert_near(mean[i], exact[i], 0.1 * sqrt(variance[i]));
    }
    pdf[5] = 0.0;
    assert_int_equal(
        assay_basis_project_samples(basis, *state, COUNT, d, pdf, value, 2, mean, variance),
        ASSAY_ERR_DOMAIN);
    pdf[5] = 1.0;
    d[7].z += 1e-3;
    assert_int_equal(
        assay_basis_project_samples(basis, *state, COUNT, d, pdf, value, 2, mean, variance),
        ASSAY_ERR_DOMAIN);
    assert_int_equal(
        assay_basis_project_samples(basis, *state, 1, d, pdf, value, 2, mean, variance),
        ASSAY_ERR_ARGUMENT);
    assay_basis_destroy(basis);
}

static void not_a_number(void *user, assay_vec3 d, double *values_out)
{
    (void)user;
    values_out[0] = d.x > 0.5 ? NAN : 1.0;
}

static void bad_input_leaves_outputs_alone(void **state)
{
    assay_basis *basis = basis_make(*state, ASSAY_BASIS_SH, 2);
    double       c[4] = {9.0, 9.0, 9.0, 9.0}, v[4] = {9.0, 9.0, 9.0, 9.0};
    const struct {
        assay_direction_function f;
        int                      channels, theta, phi;
        assay_status             expected;
    } cases[] = {{one, 0, 8, 8, ASSAY_ERR_ARGUMENT},       {one, 1, 0, 8, ASSAY_ERR_ARGUMENT},
                 {one, 1, 8, 0, ASSAY_ERR_ARGUMENT},       {one, 1, 65537, 8, ASSAY_ERR_ARGUMENT},
                 {one, 1, 8, 65537, ASSAY_ERR_ARGUMENT},   {one, -1, 8, 8, ASSAY_ERR_ARGUMENT},
                 {not_a_number, 1, 8, 8, ASSAY_ERR_DOMAIN}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_int_equal(assay_basis_project(basis, *state, cases[i].f, NULL, cases[i].channels,
                                             cases[i].theta, cases[i].phi, c),
                         cases[i].expected);
    }
    assert_int_equal(assay_basis_project_random(basis, *state, one, NULL, 1, 1, 0, c, v),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_project_random(basis, *state, not_a_number, NULL, 1, 99, 0, c, v),
                     ASSAY_ERR_DOMAIN);
    for (int i = 0; i < 4; i++) {
        assert_true(c[i] == 9.0 && v[i] == 9.0);
    }
    assay_basis_destroy(basis);
}

static void smooth_above(void *user, assay_vec3 d, double *values_out)
{
    (void)user;
    values_out[0] = d.z < 0.0 ? 0.0 : exp(d.x) * d.z + d.y;
}

/* Squared distance of f from its series, over the hemisphere by midpoints. */
static double residual(const assay_basis *basis, const double *c)
{
    double sum = 0.0;
    for (int i = 0; i < 60; i++) {
        for (int j = 0; j < 60; j++) {
            const double     z = (i + 0.5) / 60.0, s = sqrt(1.0 - z * z), phi = j * PI / 30.0;
            const assay_vec3 d = {s * cos(phi), s * sin(phi), z};
            double           y[225], f;
            smooth_above(NULL, d, &f);
            assert_int_equal(assay_basis_evaluate(basis, d, y), ASSAY_OK);
            for (size_t k = 0; k < assay_basis_count(basis); k++) {
                f -= c[k] * y[k];
            }
            sum += f * f * 2.0 * PI / 3600.0;
        }
    }
    return sum;
}

/* The best fit beats the plain projection, and no coefficient can be moved to a better fit. */
static void least_squares_are_least(void **state)
{
    assay_basis *fit = basis_make(*state, ASSAY_BASIS_LSOSH, 4);
    assay_basis *sh  = basis_make(*state, ASSAY_BASIS_SH, 4);
    double       c[16], plain[16];
    assert_int_equal(assay_basis_project(fit, *state, smooth_above, NULL, 1, 40, 40, c), ASSAY_OK);
    assert_int_equal(assay_basis_project(sh, *state, smooth_above, NULL, 1, 40, 40, plain),
                     ASSAY_OK);
    const double best = residual(fit, c);
    assert_true(best < 0.1 * residual(fit, plain));
    for (int i = 0; i < 16; i++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            double moved[16];
            memcpy(moved, c, sizeof moved);
            moved[i] += 0.01 * sign;
            assert_true(residual(fit, moved) > best);
        }
    }
    assay_basis_destroy(fit);
    assay_basis_destroy(sh);
}

/* Order 14 still fits to rounding; order 15 has too few digits left and is refused. */
static void least_squares_hold_up_to_order_14(void **state)
{
    assay_basis *last = basis_make(*state, ASSAY_BASIS_LSOSH, 14);
    assay_basis *next = basis_make(*state, ASSAY_BASIS_LSOSH, 15);
    double       c[225];
    assert_int_equal(assay_basis_project(last, *state, smooth_above, NULL, 1, 60, 60, c), ASSAY_OK);
    assert_true(residual(last, c) < 1e-26);
    assert_int_equal(assay_basis_project(next, *state, smooth_above, NULL, 1, 60, 60, c),
                     ASSAY_ERR_DOMAIN);
    assay_basis_destroy(last);
    assay_basis_destroy(next);
}

static assay_status project_all_ways(assay_context *context, void *user)
{
    (void)user;
    double       c[9], v[9];
    assay_basis *basis = NULL;
    assay_status status =
        assay_basis_create(context, ASSAY_BASIS_LSOSH, 3, ASSAY_CONVENTION_THESIS, &basis);
    if (status == ASSAY_OK) {
        status = assay_basis_project(basis, context, one, NULL, 1, 4, 4, c);
    }
    if (status == ASSAY_OK) {
        status = assay_basis_project_random(basis, context, one, NULL, 1, 4, 0, c, v);
    }
    assay_basis_destroy(basis);
    return status;
}

/* Both ways ask whether to go on, and end where the answer is no. */
static void stopped_on_the_way(void **state)
{
    (void)state;
    for (int random = 0; random < 2; random++) {
        failing_memory stopping = {.cancel_at = 2};
        assay_context *context  = failing_context(&stopping);
        assay_basis   *basis    = basis_make(context, ASSAY_BASIS_SH, 1);
        double         c = 9.0, v = 9.0;
        assert_int_equal(
            random ? assay_basis_project_random(basis, context, one, NULL, 1, 10000, 0, &c, &v)
                   : assay_basis_project(basis, context, one, NULL, 1, 10, 1, &c),
            ASSAY_ERR_CANCELLED);
        assert_true(c == 9.0 && v == 9.0);
        assay_basis_destroy(basis);
        assert_int_equal(stopping.live, 1);
        assay_context_destroy(context);
    }
}

static void refused_memory(void **state)
{
    (void)state;
    assert_true(failing_each(project_all_ways, NULL) > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(functions_have_unit_coefficients, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(fifth_power_is_in_hsh_from_order_6, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(furnace_through_the_clamped_cosine, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(monte_carlo_agrees_with_quadrature, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(samples_of_somebody_else, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(bad_input_leaves_outputs_alone, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(least_squares_are_least, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(least_squares_hold_up_to_order_14, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test(stopped_on_the_way),
        cmocka_unit_test(refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
