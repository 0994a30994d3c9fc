/* test_accuracy.c - lobes, and the share of their energy that a basis captures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "assay/basis.h"
#include "support/basis_fixture.h"
#include "support/failing_context.h"
#include "support/near.h"

static const double PI = 3.14159265358979323846;

static assay_lobe phong(double exponent, double theta_deg, double phi_deg)
{
    return (assay_lobe){.kind      = ASSAY_LOBE_PHONG,
                        .exponent  = exponent,
                        .theta_out = theta_deg * PI / 180.0,
                        .phi_out   = phi_deg * PI / 180.0};
}

static assay_lobe ward(double ax, double ay, double theta_deg, double phi_deg)
{
    return (assay_lobe){.kind      = ASSAY_LOBE_WARD,
                        .alpha_x   = ax,
                        .alpha_y   = ay,
                        .theta_out = theta_deg * PI / 180.0,
                        .phi_out   = phi_deg * PI / 180.0};
}

static void measure(assay_context *context, assay_basis_kind kind, int order, assay_lobe lobe,
                    double *accuracy, size_t *counts)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, kind, order, ASSAY_CONVENTION_THESIS, &basis),
                     ASSAY_OK);
    assert_int_equal(assay_basis_accuracy(basis, context, &lobe, accuracy, counts), ASSAY_OK);
    assay_basis_destroy(basis);
}

static double at_order(assay_context *context, assay_basis_kind kind, int order, assay_lobe lobe)
{
    double accuracy[ASSAY_BASIS_MAX_ORDER];
    measure(context, kind, order, lobe, accuracy, NULL);
    return accuracy[order - 1];
}

static double value_of(assay_lobe lobe, double theta, double phi)
{
    const assay_vec3 d     = {sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)};
    double           value = NAN;
    assert_int_equal(assay_lobe_value(&lobe, d, &value), ASSAY_OK);
    return value;
}

/* Ward by his words: tan delta and the azimuth of the half vector, from angles. */
static double ward_by_angles(double ax, double ay, double theta_o, double phi_o, double theta_i,
                             double phi_i)
{
    const double hx    = sin(theta_o) * cos(phi_o) + sin(theta_i) * cos(phi_i);
    const double hy    = sin(theta_o) * sin(phi_o) + sin(theta_i) * sin(phi_i);
    const double hz    = cos(theta_o) + cos(theta_i);
    const double delta = acos(hz / sqrt(hx * hx + hy * hy + hz * hz)), phi = atan2(hy, hx);
    const double tan2 = tan(delta) * tan(delta);
    const double e    = tan2 * (cos(phi) * cos(phi) / (ax * ax) + sin(phi) * sin(phi) / (ay * ay));
    return cos(theta_i) / sqrt(cos(theta_i) * cos(theta_o)) * exp(-e) / (4.0 * PI * ax * ay);
}

static void lobes_have_their_values(void **state)
{
    (void)state;
    assert_near(value_of(phong(5.0, 40.0, 25.0), 40.0 * PI / 180.0, 205.0 * PI / 180.0), 1.0,
                1e-15);
    assert_near(value_of(phong(5.0, 0.0, 0.0), PI / 3.0, 1.0), 1.0 / 32.0, 1e-15);
    assert_near(value_of(phong(5.0, 80.0, 0.0), 50.0 * PI / 180.0, 0.0), 0.0, 0.0);
    assert_near(value_of(phong(5.0, 0.0, 0.0), 2.0, 0.0), 0.0, 0.0);
    assert_near(value_of(ward(0.2, 0.5, 0.0, 0.0), 0.0, 0.0), 1.0 / (0.4 * PI), 1e-15);
    assert_near(value_of(ward(0.2, 0.5, 30.0, 0.0), 2.0, 0.0), 0.0, 0.0);
    for (int i = 0; i < 20; i++) {
        const double theta = 0.01 + 0.077 * i, phi = 2.3 * i;
        assert_near(value_of(ward(0.2, 0.5, 35.0, 50.0), theta, phi),
                    ward_by_angles(0.2, 0.5, 35.0 * PI / 180.0, 50.0 * PI / 180.0, theta, phi),
                    1e-13);
    }
}

static void bad_lobes(void **state)
{
    const assay_lobe bad[] = {
        phong(-1.0, 0.0, 0.0),     phong(NAN, 0.0, 0.0),          phong(5.0, 90.0, 0.0),
        phong(5.0, -1.0, 0.0),     phong(5.0, 0.0, INFINITY),     ward(0.0, 0.5, 0.0, 0.0),
        ward(0.2, -0.5, 0.0, 0.0), ward(INFINITY, 0.5, 0.0, 0.0), {.kind = (assay_lobe_kind)7}};
    assay_basis *basis = NULL;
    assert_int_equal(
        assay_basis_create(*state, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS, &basis), ASSAY_OK);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double value = 9.0, accuracy[2] = {9.0, 9.0};
        size_t count[2] = {9, 9};
        assert_int_equal(assay_lobe_value(&bad[i], (assay_vec3){0.0, 0.0, 1.0}, &value),
                         ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_basis_accuracy(basis, *state, &bad[i], accuracy, count),
                         ASSAY_ERR_DOMAIN);
        assert_true(value == 9.0 && accuracy[0] == 9.0 && count[0] == 9);
    }
    const assay_lobe good  = phong(5.0, 0.0, 0.0);
    double           value = 9.0;
    assert_int_equal(assay_lobe_value(&good, (assay_vec3){0.0, 0.0, 1.1}, &value),
                     ASSAY_ERR_DOMAIN);
    const assay_lobe grazing = ward(0.5, 0.5, 89.999, 0.0);
    double           accuracy[2];
    assert_int_equal(assay_basis_accuracy(basis, *state, &grazing, accuracy, NULL),
                     ASSAY_ERR_DOMAIN);
    assay_basis_destroy(basis);
}

/* What ERRATA found with a quadrature of its own, to the digits given there. */
static void accuracies_as_found_before(void **state)
{
    const struct {
        assay_basis_kind kind;
        int              order;
        assay_lobe       lobe;
        double           expected, half_digit;
    } cases[] = {
        {ASSAY_BASIS_HSH, 4, phong(5, 30, 0), 0.9980, 5e-5},
        {ASSAY_BASIS_ESH, 4, phong(5, 30, 0), 0.9573, 5e-5},
        {ASSAY_BASIS_ZERNIKE, 5, phong(5, 30, 0), 0.9364, 5e-5},
        {ASSAY_BASIS_HSH, 6, phong(5, 60, 0), 0.9926, 5e-5},
        {ASSAY_BASIS_ESH, 6, phong(5, 60, 0), 0.9929, 5e-5},
        {ASSAY_BASIS_ZERNIKE, 6, phong(5, 60, 0), 0.9934, 5e-5},
        {ASSAY_BASIS_HSH, 5, phong(5, 60, 0), 0.9884, 6e-5},
        {ASSAY_BASIS_ESH, 4, phong(5, 80, 0), 0.9684, 5e-5},
        {ASSAY_BASIS_ZERNIKE, 5, phong(5, 80, 0), 0.9770, 5e-5},
        {ASSAY_BASIS_HSH, 4, phong(5, 80, 0), 0.9095, 5e-5},
        {ASSAY_BASIS_HSH, 10, phong(5, 30, 0), 0.99999, 5e-6},
        {ASSAY_BASIS_HSH, 10, phong(5, 60, 0), 0.9976, 5e-5},
        {ASSAY_BASIS_HSH, 10, phong(5, 80, 0), 0.9884, 5e-5},
        {ASSAY_BASIS_ESH, 10, phong(5, 80, 0), 0.9996, 5e-5},
        {ASSAY_BASIS_HSH, 5, ward(0.2, 0.5, 30, 0), 0.9894, 5e-5},
        {ASSAY_BASIS_ESH, 5, ward(0.2, 0.5, 30, 0), 0.9280, 5e-5},
        {ASSAY_BASIS_ESH, 4, ward(0.2, 0.5, 30, 0), 0.873, 5e-4},
        {ASSAY_BASIS_HSH, 3, ward(0.2, 0.5, 30, 0), 0.865, 5e-4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assert_near(at_order(*state, cases[i].kind, cases[i].order, cases[i].lobe),
                    cases[i].expected, cases[i].half_digit);
    }
}

/* Shares grow with the order and never exceed 1; the functions are counted. */
static void accuracies_grow_up_to_one(void **state)
{
    enum { ORDER = 10 };
    const assay_lobe lobes[] = {phong(5, 0, 0), phong(5, 75, 30), phong(0, 50, 10),
                                ward(0.2, 0.5, 60, 40)};
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        const bool half = kind == ASSAY_BASIS_ESH || kind == ASSAY_BASIS_ZERNIKE;
        for (size_t i = 0; i < sizeof lobes / sizeof lobes[0]; i++) {
            double accuracy[ORDER];
            size_t count[ORDER];
            measure(*state, (assay_basis_kind)kind, ORDER, lobes[i], accuracy, count);
            for (int n = 0; n < ORDER; n++) {
                assert_true(accuracy[n] > 0.0 && accuracy[n] <= 1.0 + 1e-13);
                assert_true(n == 0 || accuracy[n] >= accuracy[n - 1]);
                assert_int_equal(count[n], half ? (n + 1) * (n + 2) / 2 : (n + 1) * (n + 1));
            }
        }
    }
}

static void hsh_hold_the_fifth_power_from_order_6(void **state)
{
    assert_near(at_order(*state, ASSAY_BASIS_HSH, 6, phong(5, 0, 0)), 1.0, 1e-14);
    assert_true(at_order(*state, ASSAY_BASIS_HSH, 5, phong(5, 0, 0)) < 1.0 - 1e-6);
    /* The mean of z^5 over the hemisphere: (1/6)^2 / (1/11). */
    assert_near(at_order(*state, ASSAY_BASIS_HSH, 1, phong(5, 0, 0)), 11.0 / 36.0, 1e-14);
    assert_near(at_order(*state, ASSAY_BASIS_SH, 1, phong(5, 0, 0)), 11.0 / 72.0, 1e-14);
    /* A constant is Makhotkin's first function, under his weight. */
    assert_near(at_order(*state, ASSAY_BASIS_MAKHOTKIN, 1, phong(0, 0, 0)), 1.0, 1e-14);
    /* Only azimuths count, and they do not for a lobe without axes. */
    assert_near(at_order(*state, ASSAY_BASIS_HSH, 5, phong(5, 60, 77)),
                at_order(*state, ASSAY_BASIS_HSH, 5, phong(5, 60, 0)), 1e-13);
}

static void lobe_channel(void *user, assay_vec3 d, double *values_out)
{
    assert_int_equal(assay_lobe_value(user, d, &values_out[0]), ASSAY_OK);
}

/* Another quadrature: the rings and sectors of projections; the energy by
 * Simpson's rule in t, z = t^2. */
static void another_quadrature_agrees(void **state)
{
    enum { ORDER = 6, RINGS = 400, SECTORS = 256 };
    static const assay_basis_kind kinds[] = {ASSAY_BASIS_HSH, ASSAY_BASIS_ZERNIKE, ASSAY_BASIS_ESH,
                                             ASSAY_BASIS_MAKHOTKIN_SQRT};
    const assay_lobe              lobes[] = {ward(0.2, 0.5, 30, 20), phong(5, 60, 20)};
    for (size_t i = 0; i < 2; i++) {
        assay_lobe lobe   = lobes[i];
        double     energy = 0.0;
        for (int t = 1; t <= RINGS; t++) {
            const double at     = (double)t / RINGS;
            const double weight = (t == RINGS ? 1.0 : t % 2 ? 4.0 : 2.0) / (3.0 * RINGS);
            for (int p = 0; p < SECTORS; p++) {
                const double f = value_of(lobe, acos(at * at), 2.0 * PI * p / SECTORS);
                energy += weight * 2.0 * at * f * f * 2.0 * PI / SECTORS;
            }
        }
        for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
            assay_basis *basis = NULL;
            double       c[ORDER * ORDER], sum = 0.0;
            assert_int_equal(
                assay_basis_create(*state, kinds[k], ORDER, ASSAY_CONVENTION_THESIS, &basis),
                ASSAY_OK);
            assert_int_equal(
                assay_basis_project(basis, *state, lobe_channel, &lobe, 1, 128, 256, c), ASSAY_OK);
            for (size_t j = 0; j < assay_basis_count(basis); j++) {
                sum += c[j] * c[j];
            }
            assert_near(sum / energy, at_order(*state, kinds[k], ORDER, lobe), 1e-6);
            assay_basis_destroy(basis);
        }
    }
}

static assay_status accuracy_of_lsosh(assay_context *context, void *user)
{
    assay_basis *basis = NULL;
    double       accuracy[2];
    size_t       count[2];
    assay_status status =
        assay_basis_create(context, ASSAY_BASIS_LSOSH, 2, ASSAY_CONVENTION_THESIS, &basis);
    if (status == ASSAY_OK) {
        status = assay_basis_accuracy(basis, context, user, accuracy, count);
    }
    assay_basis_destroy(basis);
    return status;
}

static void refused_memory(void **state)
{
    assay_lobe lobe = phong(5, 30, 0);
    (void)state;
    assert_true(failing_each(accuracy_of_lsosh, &lobe) > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(lobes_have_their_values, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(bad_lobes, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(accuracies_as_found_before, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(accuracies_grow_up_to_one, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(hsh_hold_the_fifth_power_from_order_6, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(another_quadrature_agrees, basis_set_up, basis_tear_down),
        cmocka_unit_test(refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
