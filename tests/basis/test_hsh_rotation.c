/* test_hsh_rotation.c - M_R and M against another rule, and what they must be. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "support/basis_fixture.h"
#include "support/failing_context.h"
#include "support/hsh_matrix.h"
#include "support/near.h"

static const double PI = ASSAY_PI;

static const assay_hsh_rotation_options EXACT = {.way = ASSAY_HSH_EXACT};

static assay_context *context_of(void **state) { return *state; }

/* ---- the second method ---- */

enum { SIDE = 160 };

/* x in (0, width) and its weight by the tanh-sinh rule; *rest_out: width - x. */
static double tanh_sinh(int q, double width, double *rest_out, double *weight_out)
{
    const double h = 7.0 / SIDE, u = (q - SIDE / 2) * h, a = 0.5 * PI * sinh(u);
    const double x = 1.0 / (1.0 + exp(-2.0 * a)), r = 1.0 / (1.0 + exp(2.0 * a));
    *rest_out   = width * r;
    *weight_out = width * h * PI * cosh(u) * x * r;
    return width * x;
}

/* Integral of H_i(w) H_j(u) over what lies up to pi - turn - gap from the horizon at +x (or -x:
 * mirrored), measured about y; u is w moved on by the turn. */
static double *second_method(const assay_basis *hsh, double turn, double gap, bool mirrored)
{
    const size_t n      = assay_basis_count(hsh);
    const double width  = PI - turn - gap;
    double      *matrix = hsh_matrix(hsh), a[64], b[64];
    for (int q = 0; q <= SIDE; q++) {
        double       rest = 0.0, weight = 0.0;
        const double d = tanh_sinh(q, width, &rest, &weight), up = d + turn;
        const double below = gap + rest; /* pi - up, without cancellation */
        const double sine  = up < 0.5 * PI ? sin(up) : sin(below);
        for (int p = 0; p <= SIDE; p++) {
            double           unused = 0.0, psi_weight = 0.0;
            const double     psi = tanh_sinh(p, PI, &unused, &psi_weight);
            const double     c = sin(psi < 0.5 * PI ? psi : unused), y = -cos(psi);
            const double     side = mirrored ? -1.0 : 1.0;
            const assay_vec3 w    = {side * c * cos(d), y, c * sin(d)};
            const assay_vec3 u    = {side * c * cos(up), y, c * sine};
            assert_int_equal(assay_basis_evaluate(hsh, w, a), ASSAY_OK);
            assert_int_equal(assay_basis_evaluate(hsh, u, b), ASSAY_OK);
            for (size_t i = 0; i < n; i++) {
                for (size_t j = 0; j < n; j++) {
                    matrix[i * n + j] += weight * psi_weight * c * a[i] * b[j];
                }
            }
        }
    }
    return matrix;
}

/* R turns +z to +x by beta > 0, so what is at height d at +x comes from d + beta. */
static void test_second_method(void **state)
{
    assay_context      *context    = context_of(state);
    static const double angles[]   = {1e-16, 1e-9, 0.01, 0.3, 1.0, 0.5 * ASSAY_PI, 2.2, 3.1};
    double              worst_turn = 0.0, worst_digon = 0.0;
    for (int order = 3; order <= 5; order += 2) {
        assay_basis *hsh = hsh_basis(context, order, ASSAY_CONVENTION_THESIS);
        const size_t n   = assay_basis_count(hsh);
        for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
            if (order == 5 && k % 2) {
                continue;
            }
            const double beta = angles[k];
            double      *a    = hsh_turned(hsh, context, EXACT, beta);
            double      *b    = second_method(hsh, beta, 0.0, false);
            worst_turn        = fmax(worst_turn, hsh_distance(n, a, b));
            free(a);
            free(b);
            a           = hsh_digon(hsh, context, beta);
            b           = second_method(hsh, 0.0, beta, true);
            worst_digon = fmax(worst_digon, hsh_distance(n, a, b));
            free(a);
            free(b);
        }
        assay_basis_destroy(hsh);
    }
    printf("# M_R off by %.2g, M by %.2g (orders 3 and 5, another rule)\n", worst_turn,
           worst_digon);
    assert_true(worst_turn <= 3e-14);
    assert_true(worst_digon <= 3e-14);
}

/* ---- what they must be ---- */

/* Largest singular value, by the power method. */
static double norm_of(size_t n, const double *a)
{
    double *x = malloc(2 * n * sizeof *x), *y = x + n, norm = 0.0;
    assert_non_null(x);
    for (size_t i = 0; i < n; i++) {
        x[i] = 1.0 / (1.0 + (double)i);
    }
    for (int step = 0; step < 60; step++) {
        norm = 0.0;
        for (size_t i = 0; i < n; i++) {
            y[i] = 0.0;
            for (size_t j = 0; j < n; j++) {
                y[i] += a[i * n + j] * x[j];
            }
            norm += y[i] * y[i];
        }
        double length = 0.0;
        for (size_t i = 0; i < n; i++) {
            x[i] = 0.0;
            for (size_t j = 0; j < n; j++) {
                x[i] += a[j * n + i] * y[j];
            }
            length += x[i] * x[i];
        }
        for (size_t i = 0; i < n; i++) {
            x[i] /= sqrt(length);
        }
        norm = sqrt(sqrt(length)); /* |a' a x| of a unit x */
    }
    free(x);
    return norm;
}

static void check_identities(assay_context *context, const assay_basis *hsh, double beta)
{
    const size_t n = assay_basis_count(hsh);
    double      *r = hsh_turned(hsh, context, EXACT, beta),
           *back   = hsh_turned(hsh, context, EXACT, -beta);
    double *m = hsh_digon(hsh, context, beta), *other = hsh_digon(hsh, context, -beta);
    assert_near(r[0], 1.0 - beta / PI, 1e-14);
    assert_near(m[0], 1.0 - beta / PI, 1e-14);
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            assert_near(back[i * n + j], r[j * n + i], 0.0);
            assert_near(m[i * n + j], m[j * n + i], 2e-16);
        }
    }
    assert_true(norm_of(n, r) <= 1.0 + 1e-14);
    assert_true(norm_of(n, m) <= 1.0 + 1e-14);
    if (beta > 0.01 && beta < 3.0) {
        assert_true(hsh_distance(n, r, back) > 1e-3 || n == 1);
        assert_true(hsh_distance(n, m, other) > 1e-5 || n == 1);
    }
    free(r);
    free(back);
    free(m);
    free(other);
}

static void test_identities(void **state)
{
    assay_context      *context  = context_of(state);
    static const double angles[] = {
        0.0, 1e-14, 1e-5, ASSAY_PI / 18.0, ASSAY_PI / 6.0, ASSAY_PI / 3.0, 1.9, 3.0};
    for (int order = 1; order <= 10; order += 3) {
        assay_basis *hsh = hsh_basis(context, order, ASSAY_CONVENTION_THESIS);
        const size_t n   = assay_basis_count(hsh);
        for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
            check_identities(context, hsh, angles[k]);
        }
        double *r    = hsh_turned(hsh, context, EXACT, 0.0),
               *gone = hsh_turned(hsh, context, EXACT, PI);
        double *m = hsh_digon(hsh, context, 0.0), *empty = hsh_digon(hsh, context, PI);
        for (size_t i = 0; i < n * n; i++) {
            assert_true(r[i] == (i % (n + 1) == 0) && m[i] == (i % (n + 1) == 0));
            assert_true(gone[i] == 0.0 && empty[i] == 0.0);
        }
        free(r);
        free(gone);
        free(m);
        free(empty);
        assay_basis_destroy(hsh);
    }
}

/* Orders as far as the basis goes: the rows of the smaller order are those of the larger. */
static void test_orders(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *small   = hsh_basis(context, 6, ASSAY_CONVENTION_PLAIN);
    assay_basis   *large   = hsh_basis(context, 20, ASSAY_CONVENTION_PLAIN);
    assay_basis   *thesis  = hsh_basis(context, 6, ASSAY_CONVENTION_THESIS);
    double *a = hsh_turned(small, context, EXACT, 0.4), *b = hsh_turned(large, context, EXACT, 0.4);
    double *c = hsh_turned(thesis, context, EXACT, 0.4), worst = 0.0;
    for (size_t i = 0; i < 36; i++) {
        for (size_t j = 0; j < 36; j++) {
            int l = 0, m = 0, k = 0;
            assay_basis_function(small, i, &l, &m);
            assay_basis_function(small, j, &l, &k);
            worst = fmax(worst, fabs(a[i * 36 + j] - b[i * 400 + j]));
            assert_near(c[i * 36 + j], ((m - k) & 1 ? -1.0 : 1.0) * a[i * 36 + j], 1e-15);
        }
    }
    printf("# M_R of order 6 in that of order 20: off by %.2g\n", worst);
    assert_true(worst <= 1e-14);
    free(a);
    free(b);
    free(c);
    assay_basis_destroy(small);
    assay_basis_destroy(large);
    assay_basis_destroy(thesis);
}

/* ---- what is lost ---- */

/* A uniform sky after a turn by beta gives pi (1 + cos beta) / 2: the digon that comes up is dark.
 */
static void test_furnace(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *hsh     = hsh_basis(context, 4, ASSAY_CONVENTION_THESIS);
    double         one[16], cosine[16];
    hsh_power(hsh, 0, one);
    hsh_power(hsh, 1, cosine);
    for (int k = 0; k <= 18; k++) {
        const double beta = k * PI / 18.0;
        double      *a = hsh_turned(hsh, context, EXACT, beta), irradiance = 0.0;
        for (int i = 0; i < 256; i++) {
            irradiance += cosine[i / 16] * a[i] * one[i % 16];
        }
        assert_near(irradiance, 0.5 * PI * (1.0 + cos(beta)), 2e-14);
        free(a);
    }
    assay_basis_destroy(hsh);
}

/* ---- any rotation ---- */

static void test_any_rotation(void **state)
{
    assay_context *context     = context_of(state);
    assay_basis   *hsh         = hsh_basis(context, 5, ASSAY_CONVENTION_THESIS);
    const double   angles[][3] = {{0.4, 0.9, -2.0}, {1.0, 0.0, 0.5},   {0.3, ASSAY_PI, 0.2},
                                  {0.0, 2.0, 0.0},  {-2.5, 1e-7, 1.5}, {1.0, 0.5 * ASSAY_PI, 3.0}};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; k++) {
        const double a = angles[k][0], b = angles[k][1], g = angles[k][2];
        for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT; way++) {
            const assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way};
            double                           r[9], *matrix = hsh_matrix(hsh);
            assay_rotation_from_euler_zyz(a, b, g, r);
            const assay_status status = assay_hsh_rotation(hsh, context, &options, r, matrix);
            if (b > 1.6 && way != ASSAY_HSH_EXACT && way != ASSAY_HSH_CONVERSION) {
                assert_int_equal(status, ASSAY_ERR_DOMAIN);
                free(matrix);
                continue;
            }
            assert_int_equal(status, ASSAY_OK);
            double *y = hsh_turned(hsh, context, options, b), in[25], mid[25], out[25];
            for (int j = 0; j < 25; j++) {
                memset(in, 0, sizeof in);
                in[j] = 1.0;
                assert_int_equal(assay_basis_rotate_z(hsh, g, 1, in), ASSAY_OK);
                for (int i = 0; i < 25; i++) {
                    mid[i] = 0.0;
                    for (int q = 0; q < 25; q++) {
                        mid[i] += y[i * 25 + q] * in[q];
                    }
                }
                memcpy(out, mid, sizeof out);
                assert_int_equal(assay_basis_rotate_z(hsh, a, 1, out), ASSAY_OK);
                for (int i = 0; i < 25; i++) {
                    assert_near(matrix[i * 25 + j], out[i], 1e-7 * (b == 0.5 * PI) + 2e-14);
                }
            }
            free(y);
            free(matrix);
        }
    }
    assay_basis_destroy(hsh);
}

/* ---- refusals ---- */

static assay_status all_ways(assay_context *context, void *user)
{
    (void)user;
    assay_basis *hsh = NULL;
    double       matrix[81];
    assay_status status =
        assay_basis_create(context, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS, &hsh);
    for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT && !status; way++) {
        const assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way};
        matrix[0]                                = 7.0;
        status = assay_hsh_rotation_y(hsh, context, &options, 0.4, matrix);
        assert_true(!status || matrix[0] == 7.0);
    }
    assay_basis_destroy(hsh);
    return status;
}

/* Small turns move entries by less than hsh_rotation.c proves, and such as cannot be seen are none.
 * (That takes no time, at the largest order, too.) */
static void test_small_turns(void **state)
{
    assay_context *context = context_of(state);
    for (int order = 1; order <= 33; order += order < 9 ? 1 : 24) {
        assay_basis *hsh   = hsh_basis(context, order, ASSAY_CONVENTION_THESIS);
        const size_t n     = assay_basis_count(hsh);
        const double bound = 4.0 / PI * (order + 2) * (2 * order - 1);
        double      *one   = hsh_turned(hsh, context, EXACT, 0.0);
        for (double beta = 0.1; beta > 1e-16 && order < 9; beta *= 1e-3) {
            double *turned = hsh_turned(hsh, context, EXACT, beta);
            assert_true(hsh_distance(n, turned, one) <= bound * beta + 2e-14);
            free(turned);
        }
        for (int k = 0; k < 2; k++) {
            double *turned = hsh_turned(hsh, context, EXACT, k ? -1e-300 : 0.99 * 0x1p-54 / bound);
            assert_true(hsh_distance(n, turned, one) == 0.0);
            free(turned);
        }
        free(one);
        assay_basis_destroy(hsh);
    }
}

static void test_refusals(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *hsh = hsh_basis(context, 2, ASSAY_CONVENTION_THESIS), *sh = NULL;
    double         matrix[16] = {7.0}, r[9];
    assert_int_equal(assay_basis_create(context, ASSAY_BASIS_SH, 2, ASSAY_CONVENTION_THESIS, &sh),
                     ASSAY_OK);
    assert_int_equal(assay_hsh_rotation_y(sh, context, &EXACT, 0.1, matrix), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_hsh_digon(sh, context, 0.1, matrix), ASSAY_ERR_ARGUMENT);
    const assay_hsh_rotation_options wrong[] = {
        {.way = (assay_hsh_rotation_way)5},
        {.way = (assay_hsh_rotation_way)-1},
        {.way = ASSAY_HSH_CONVERSION, .sh_order = -1},
        {.way = ASSAY_HSH_CONVERSION, .sh_order = ASSAY_BASIS_MAX_ORDER + 1},
        {.way = ASSAY_HSH_TABLE, .table_steps = -1},
    };
    assay_rotation_from_euler_zyz(0.1, 0.2, 0.3, r);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(assay_hsh_rotation_y(hsh, context, &wrong[i], 0.1, matrix),
                         ASSAY_ERR_ARGUMENT);
        assert_int_equal(assay_hsh_rotation(hsh, context, &wrong[i], r, matrix),
                         ASSAY_ERR_ARGUMENT);
        assert_true(assay_context_error(context)[0] != '\0');
    }
    for (int way = 0; way < ASSAY_HSH_ROTATION_WAY_COUNT; way++) {
        const assay_hsh_rotation_options options = {.way = (assay_hsh_rotation_way)way};
        const bool   any   = way == ASSAY_HSH_EXACT || way == ASSAY_HSH_CONVERSION;
        const double limit = any ? PI : 0.5 * PI;
        const double bad[] = {NAN, INFINITY, nextafter(limit, 4.0), -nextafter(limit, 4.0)};
        for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
            assert_int_equal(assay_hsh_rotation_y(hsh, context, &options, bad[i], matrix),
                             ASSAY_ERR_DOMAIN);
        }
        r[0] = NAN;
        assert_int_equal(assay_hsh_rotation(hsh, context, &options, r, matrix), ASSAY_ERR_DOMAIN);
    }
    assert_int_equal(assay_hsh_digon(hsh, context, 3.2, matrix), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_hsh_digon(hsh, context, NAN, matrix), ASSAY_ERR_DOMAIN);
    assert_true(matrix[0] == 7.0);
    assay_basis_destroy(hsh);
    assay_basis_destroy(sh);
    assert_true(failing_each(all_ways, NULL) > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_second_method), cmocka_unit_test(test_identities),
        cmocka_unit_test(test_orders),        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_any_rotation),  cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_small_turns),
    };
    return cmocka_run_group_tests(tests, basis_set_up, basis_tear_down);
}
