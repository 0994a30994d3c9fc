/* test_projection_lobe.c - coefficients of lobes, wide and as narrow as can be said: against the
 * closed form of Funk and Hecke, digons, limits, and the product rule. */
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

enum { ORDER = 6, COUNT = ORDER * ORDER };
static const double PI = 3.14159265358979323846;

static assay_lobe phong(double exponent, double theta, double phi)
{
    return (assay_lobe){
        .kind = ASSAY_LOBE_PHONG, .exponent = exponent, .theta_out = theta, .phi_out = phi};
}

static assay_lobe ward(double ax, double ay, double theta, double phi)
{
    return (assay_lobe){
        .kind = ASSAY_LOBE_WARD, .alpha_x = ax, .alpha_y = ay, .theta_out = theta, .phi_out = phi};
}

static assay_vec3 mirror_direction(assay_lobe lobe)
{
    return (assay_vec3){-sin(lobe.theta_out) * cos(lobe.phi_out),
                        -sin(lobe.theta_out) * sin(lobe.phi_out), cos(lobe.theta_out)};
}

/* 2 pi times the integral of x^k P_l over [0, 1]: 2 pi / (k + 1), 2 pi / (k + 2), and
 * (k - l + 2) / (k + l + 1) from l - 2 to l. */
static double funk_hecke(double k, int l)
{
    double factor = 2.0 * PI / (k + 1.0 + l % 2);
    for (int j = 2 + l % 2; j <= l; j += 2) {
        factor *= (k - j + 2.0) / (k + j + 1.0);
    }
    return factor;
}

/* What of a lobe lies below the horizon is less than rounding: then it is zonal about its axis. */
static void narrow_phong_in_sh(void **state)
{
    static const double exponents[] = {150.0, 1e3, 1e5, 1e8, 1e16, 1e300, 1.7e308};
    assay_basis        *sh          = basis_make(*state, ASSAY_BASIS_SH, ORDER);
    double              worst       = 0.0;
    for (size_t i = 0; i < sizeof exponents / sizeof exponents[0]; i++) {
        const double     k    = exponents[i];
        const assay_lobe lobe = phong(k, 0.5, 0.3);
        double           values[COUNT], out[COUNT], accuracy[ORDER], captured = 0.0;
        assert_int_equal(assay_basis_evaluate(sh, mirror_direction(lobe), values), ASSAY_OK);
        assert_int_equal(assay_basis_project_lobe(sh, *state, &lobe, out), ASSAY_OK);
        assert_int_equal(assay_basis_accuracy(sh, *state, &lobe, accuracy, NULL), ASSAY_OK);
        for (int j = 0; j < COUNT; j++) {
            const int l = (int)sqrt(j);
            worst       = fmax(worst, fabs(out[j] / (funk_hecke(k, l) * values[j]) - 1.0));
        }
        for (int l = 0; l < ORDER; l++) {
            captured += funk_hecke(k, l) * ((2.0 * l + 1.0) / (4.0 * PI)) *
                        (funk_hecke(k, l) * ((2.0 * k + 1.0) / (2.0 * PI)));
            worst = fmax(worst, k < 1e100 ? fabs(accuracy[l] / captured - 1.0) : 0.0);
        }
    }
    print_message("narrow Phong lobes: relative error %.2g\n", worst);
    assert_true(worst < 1e-12);
    assay_basis_destroy(sh);
}

/* Exponent 0 is 1 on a hemisphere about the mirror direction: a digon with ours. */
static void exponent_zero_is_a_digon(void **state)
{
    assay_basis *hsh = basis_make(*state, ASSAY_BASIS_HSH, ORDER);
    for (double beta = 0.1; beta < 1.57; beta += 0.3) {
        const assay_lobe lobe = phong(0.0, beta, 0.0);
        double           out[COUNT], matrix[COUNT * COUNT];
        assert_int_equal(assay_hsh_digon(hsh, *state, beta, matrix), ASSAY_OK);
        assert_int_equal(assay_basis_project_lobe(hsh, *state, &lobe, out), ASSAY_OK);
        for (int i = 0; i < COUNT; i++) {
            assert_near(out[i], sqrt(2.0 * PI) * matrix[i * COUNT], 1e-14);
        }
    }
    assay_basis_destroy(hsh);
}

/* The two rules for Phong meet at exponent 64: also where the horizon cuts the lobe. */
static void two_rules_agree(void **state)
{
    static const double tilts[] = {0.0, 0.6, 1.3};
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = basis_make(*state, (assay_basis_kind)kind, ORDER);
        const double noise = kind == ASSAY_BASIS_LSOSH ? 1e-9 : 1e-13;
        for (size_t i = 0; i < sizeof tilts / sizeof tilts[0]; i++) {
            const assay_lobe one = phong(64.0, tilts[i], 0.4);
            const assay_lobe two = phong(64.0 + 0x1p-46, tilts[i], 0.4);
            double           a[COUNT], b[COUNT], c[ORDER], d[ORDER];
            assert_int_equal(assay_basis_project_lobe(basis, *state, &one, a), ASSAY_OK);
            assert_int_equal(assay_basis_project_lobe(basis, *state, &two, b), ASSAY_OK);
            assert_int_equal(assay_basis_accuracy(basis, *state, &one, c, NULL), ASSAY_OK);
            assert_int_equal(assay_basis_accuracy(basis, *state, &two, d, NULL), ASSAY_OK);
            for (size_t k = 0; k < assay_basis_count(basis); k++) {
                assert_near(a[k], b[k], noise);
            }
            for (int n = 0; n < ORDER; n++) {
                assert_near(c[n], d[n], 1e-13);
            }
        }
        assay_basis_destroy(basis);
    }
}

static void value_of(void *user, assay_vec3 d, double *value_out)
{
    if (assay_lobe_value(user, d, value_out) != ASSAY_OK) {
        *value_out = 0.0;
    }
}

static void wide_lobes_by_the_product_rule(void **state)
{
    assay_lobe lobes[] = {ward(0.2, 0.5, 0.5, 0.7), ward(0.5, 0.15, 1.2, -2.0),
                          phong(90.0, 1.2, 2.5), phong(70.0, 0.0, 0.0)};
    for (int kind = ASSAY_BASIS_HSH; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        assay_basis *basis = basis_make(*state, (assay_basis_kind)kind, 4);
        for (size_t i = 0; i < sizeof lobes / sizeof lobes[0]; i++) {
            double out[16], expected[16];
            assert_int_equal(assay_basis_project_lobe(basis, *state, &lobes[i], out), ASSAY_OK);
            assert_int_equal(
                assay_basis_project(basis, *state, value_of, &lobes[i], 1, 128, 256, expected),
                ASSAY_OK);
            for (size_t k = 0; k < assay_basis_count(basis); k++) {
                assert_near(out[k], expected[k], 1e-8);
            }
        }
        assay_basis_destroy(basis);
    }
}

/* Ward's lobe tends to cos(theta_out) times a point at the mirror direction. */
static void narrow_ward(void **state)
{
    static const double widths[] = {1e-9, 1e-100, 1e-300};
    assay_basis        *hsh      = basis_make(*state, ASSAY_BASIS_HSH, ORDER);
    for (size_t i = 0; i < sizeof widths / sizeof widths[0]; i++) {
        const assay_lobe lobe = ward(widths[i], 0.25 * widths[i], 0.9, 0.4);
        double           values[COUNT], out[COUNT];
        assert_int_equal(assay_basis_evaluate(hsh, mirror_direction(lobe), values), ASSAY_OK);
        assert_int_equal(assay_basis_project_lobe(hsh, *state, &lobe, out), ASSAY_OK);
        for (int j = 0; j < COUNT; j++) {
            assert_near(out[j], cos(0.9) * values[j], 2e-14);
        }
    }
    assay_basis_destroy(hsh);
}

static void what_cannot_be_done(void **state)
{
    const assay_lobe bad[]    = {phong(-1.0, 0.1, 0.0), phong(5.0, 1.6, 0.0),
                                 ward(1e300, 1e300, 0.2, 0), ward(0.0, 0.5, 0.2, 0.0)};
    assay_basis     *hsh      = basis_make(*state, ASSAY_BASIS_HSH, 1);
    assay_basis     *lsosh    = basis_make(*state, ASSAY_BASIS_LSOSH, 20);
    double           out[400] = {7.0};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(assay_basis_project_lobe(hsh, *state, &bad[i], out), ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_basis_accuracy(hsh, *state, &bad[i], out, NULL), ASSAY_ERR_DOMAIN);
    }
    const assay_lobe grazing = ward(0.5, 0.5, 0.4999 * PI * (1.0 + 1e-4), 0.0);
    assert_int_equal(assay_basis_project_lobe(hsh, *state, &grazing, out), ASSAY_ERR_DOMAIN);
    const assay_lobe good = phong(5.0, 0.3, 0.0);
    assert_int_equal(assay_basis_project_lobe(lsosh, *state, &good, out), ASSAY_ERR_DOMAIN);
    assert_near(out[0], 7.0, 0.0);
    assay_basis_destroy(hsh);
    assay_basis_destroy(lsosh);
}

static assay_status project_lsosh(assay_context *context, void *user)
{
    assay_basis *basis = NULL;
    double       out[4];
    assay_status status =
        assay_basis_create(context, ASSAY_BASIS_LSOSH, 2, ASSAY_CONVENTION_THESIS, &basis);
    if (status == ASSAY_OK) {
        status = assay_basis_project_lobe(basis, context, user, out);
    }
    assay_basis_destroy(basis);
    return status;
}

static void refused_memory(void **state)
{
    assay_lobe lobe = phong(100.0, 0.2, 0.0);
    (void)state;
    assert_true(failing_each(project_lsosh, &lobe) > 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(narrow_phong_in_sh, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(exponent_zero_is_a_digon, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(two_rules_agree, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(wide_lobes_by_the_product_rule, basis_set_up,
                                        basis_tear_down),
        cmocka_unit_test_setup_teardown(narrow_ward, basis_set_up, basis_tear_down),
        cmocka_unit_test_setup_teardown(what_cannot_be_done, basis_set_up, basis_tear_down),
        cmocka_unit_test(refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
