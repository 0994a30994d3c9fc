/* test_conversion.c - C by another rule and another evaluation, in both directions. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "core/random.h"
#include "support/basis_fixture.h"
#include "support/failing_context.h"
#include "support/near.h"

enum { LARGEST = ASSAY_BASIS_MAX_ORDER };

static assay_context *context_of(void **state) { return *state; }

/* Dense, rows by `to`. */
static double *dense(assay_context *context, const assay_basis *from, const assay_basis *to)
{
    assay_sparse *c = NULL;
    assert_int_equal(assay_basis_conversion(context, from, to, &c), ASSAY_OK);
    const assay_sparse_view v = assay_sparse_entries(c);
    assert_int_equal(v.rows, assay_basis_count(to));
    assert_int_equal(v.columns, assay_basis_count(from));
    assert_int_equal(v.row_start[0], 0);
    assert_int_equal(v.row_start[v.rows], v.entries);
    double *matrix = calloc(v.rows * v.columns, sizeof *matrix);
    assert_non_null(matrix);
    for (size_t r = 0; r < v.rows; r++) {
        for (size_t k = v.row_start[r]; k < v.row_start[r + 1]; k++) {
            assert_true(k == v.row_start[r] || v.column[k] > v.column[k - 1]);
            matrix[r * v.columns + v.column[k]] = v.value[k];
        }
    }
    assay_sparse_destroy(c);
    return matrix;
}

/* ---- the second method ---- */

enum { TRAPEZIUM = 400 };

/* sqrt((2 l + 1) (l - m)! / (l + m)!) P_l^m(x) without (-1)^m, l < LARGEST, from 1 - x^2. */
static void legendre(int m, long double x, long double square, long double *p_out)
{
    long double start = 1.0L;
    for (int k = 1; k <= m; k++) {
        start *= (2.0L * k - 1.0L) * sqrtl(square) / sqrtl((2.0L * k - 1.0L) * 2.0L * k);
    }
    long double p = start, before = 0.0L;
    for (int l = m; l < LARGEST; l++) {
        p_out[l] = sqrtl(2.0L * l + 1.0L) * p;
        const long double next =
            ((2.0L * l + 1.0L) * x * p - sqrtl((long double)(l - m) * (l + m)) * before) /
            sqrtl((long double)(l + 1 - m) * (l + 1 + m));
        before = p;
        p      = next;
    }
}

/* C[l][k] of one m: integral over z in [0, 1] of the two, times sqrt(2) 2 pi / (4 pi), by the
 * tanh-sinh rule. */
static void second_method(int m, long double (*c)[LARGEST])
{
    for (int i = 0; i < LARGEST * LARGEST; i++) {
        c[i / LARGEST][i % LARGEST] = 0.0L;
    }
    const long double h = 8.0L / TRAPEZIUM;
    for (int q = 0; q <= TRAPEZIUM; q++) {
        const long double u      = (q - TRAPEZIUM / 2) * h;
        const long double a      = 1.5707963267948966192313L * sinhl(u);
        const long double z      = 1.0L / (1.0L + expl(-2.0L * a)); /* (1 + tanh a) / 2 */
        const long double r      = 1.0L / (1.0L + expl(2.0L * a));  /* 1 - z            */
        const long double weight = h * 3.1415926535897932384626L * coshl(u) * z * r;
        long double       hsh[LARGEST], sh[LARGEST];
        legendre(m, z - r, 4.0L * z * r, hsh);
        legendre(m, z, r * (1.0L + z), sh);
        for (int l = m; l < LARGEST; l++) {
            for (int k = m; k < LARGEST; k++) {
                c[l][k] += weight * hsh[l] * sh[k] * sqrtl(0.5L);
            }
        }
    }
}

static void test_second_method(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *sh  = basis_make_in(context, ASSAY_BASIS_SH, LARGEST, ASSAY_CONVENTION_THESIS);
    assay_basis   *hsh = basis_make_in(context, ASSAY_BASIS_HSH, LARGEST, ASSAY_CONVENTION_THESIS);
    double        *c = dense(context, sh, hsh), worst = 0.0;
    const size_t   n                = LARGEST * LARGEST;
    long double(*expected)[LARGEST] = malloc(sizeof(long double) * n);
    assert_non_null(expected);
    size_t seen = 0, nonzero = 0;
    for (int m = 0; m < LARGEST; m++) {
        second_method(m, expected);
        for (int l = m; l < LARGEST; l++) {
            for (int k = m; k < LARGEST; k++) {
                for (int sign = -1; sign <= (m ? 1 : -1); sign += 2) {
                    const double is =
                        c[(size_t)(l * l + l + sign * m) * n + (size_t)(k * k + k + sign * m)];
                    worst = fmax(worst, fabs(is - (double)expected[l][k]));
                    seen += is != 0.0;
                }
            }
        }
    }
    for (size_t i = 0; i < n * n; i++) {
        nonzero += c[i] != 0.0;
    }
    printf("# C to order %d, worst entry off by %.2g\n", LARGEST, worst);
    assert_true(worst <= 4e-15);
    assert_int_equal(seen, nonzero); /* nothing where m differs */
    free(expected);
    free(c);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

/* ---- numbers that were derived elsewhere ---- */

static void test_known_entries(void **state)
{
    static const struct {
        int    row, column;
        double value;
    } known[] = {{0, 0, .7071},  {0, 2, .6124},  {0, 6, 0},     {2, 0, 0},     {2, 2, .3536},
                 {2, 6, .6847},  {6, 0, 0},      {6, 2, 0},     {6, 6, .1768}, {1, 1, .6739},
                 {1, 5, .6746},  {5, 1, -.1581}, {5, 5, .2117}, {3, 3, .6739}, {3, 7, .6746},
                 {7, 3, -.1581}, {7, 7, .2117},  {4, 4, .6187}, {8, 8, .6187}, {1, 3, 0},
                 {4, 8, 0},      {1, 0, 0}};
    assay_context *context = context_of(state);
    assay_basis   *sh      = basis_make_in(context, ASSAY_BASIS_SH, 4, ASSAY_CONVENTION_PLAIN);
    assay_basis   *hsh     = basis_make_in(context, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_PLAIN);
    double        *c       = dense(context, sh, hsh);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        assert_near(c[known[i].row * 16 + known[i].column], known[i].value, 5.01e-4 * 0.1 + 3.5e-4);
    }
    /* m = 0 in closed form: integrals of polynomials. */
    assert_near(c[0], sqrt(0.5), 1e-15);
    assert_near(c[2], sqrt(0.375), 1e-15);
    assert_near(c[12], -sqrt(7.0 / 128.0), 1e-15);
    assert_near(c[2 * 16 + 2], sqrt(0.125), 1e-15);
    assert_near(c[2 * 16 + 6], sqrt(15.0 / 32.0), 1e-15);
    free(c);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

/* ---- directions, orders, conventions ---- */

static void test_transposed(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *sh      = basis_make_in(context, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_KONTKANEN);
    assay_basis   *plain   = basis_make_in(context, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_PLAIN);
    assay_basis   *hsh     = basis_make_in(context, ASSAY_BASIS_HSH, 6, ASSAY_CONVENTION_THESIS);
    double        *c = dense(context, sh, hsh), *back = dense(context, hsh, sh),
           *p = dense(context, plain, hsh);
    for (size_t i = 0; i < 36; i++) {
        for (size_t j = 0; j < 9; j++) {
            assert_true(c[i * 9 + j] == back[j * 36 + i]);
            int l = 0, m = 0;
            assay_basis_function(sh, j, &l, &m);
            assert_true(c[i * 9 + j] == p[i * 9 + (size_t)(l * l + l + m)]);
        }
    }
    assert_true(c[1 * 9 + 2] < -0.6); /* H_1^-1 of the thesis has y with -, Y_2 = +y */
    free(c);
    free(back);
    free(p);
    assay_basis_destroy(sh);
    assay_basis_destroy(plain);
    assay_basis_destroy(hsh);
}

/* Coefficients of a function that both bases hold, z^5 + x y z^2 ..., and their multiplication. */
static void test_exact_functions(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *sh      = basis_make_in(context, ASSAY_BASIS_SH, 6, ASSAY_CONVENTION_THESIS);
    assay_basis   *hsh     = basis_make_in(context, ASSAY_BASIS_HSH, 6, ASSAY_CONVENTION_PLAIN);
    assay_sparse  *c       = NULL;
    assert_int_equal(assay_basis_conversion(context, sh, hsh, &c), ASSAY_OK);
    double in[36] = {0.0}, out[36], v[36];
    for (int l = 0; l < 6; l++) {
        in[l * l + l] = 1.0 / (1.0 + l); /* any polynomial of z below degree 6 is in both */
    }
    assay_sparse_multiply(c, in, out);
    for (int i = 0; i <= 20; i++) {
        const double     z = i / 20.0, s = sqrt(1.0 - z * z);
        const assay_vec3 d = {0.6 * s, 0.8 * s, z};
        double           a = 0.0, b = 0.0;
        assert_int_equal(assay_basis_evaluate(sh, d, v), ASSAY_OK);
        for (int k = 0; k < 36; k++) {
            a += v[k] * in[k];
        }
        assert_int_equal(assay_basis_evaluate(hsh, d, v), ASSAY_OK);
        for (int k = 0; k < 36; k++) {
            b += v[k] * out[k];
        }
        assert_near(b, a, 1e-14);
    }
    assay_sparse_destroy(c);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

/* ---- there and back ---- */

/* Of 1 - C C': largest singular value by the power method, and root of the mean square of all
 * singular values. */
static void defect(assay_context *context, int hsh_order, int sh_order, double *largest_out,
                   double *rms_out, double *constant_out)
{
    assay_basis *sh  = basis_make_in(context, ASSAY_BASIS_SH, sh_order, ASSAY_CONVENTION_THESIS);
    assay_basis *hsh = basis_make_in(context, ASSAY_BASIS_HSH, hsh_order, ASSAY_CONVENTION_THESIS);
    double      *c   = dense(context, sh, hsh);
    const size_t n = assay_basis_count(hsh), m = assay_basis_count(sh);
    double      *e = calloc(n * n, sizeof *e), squares = 0.0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j < n; j++) {
            e[i * n + j] = i == j;
            for (size_t k = 0; k < m; k++) {
                e[i * n + j] -= c[i * m + k] * c[j * m + k];
            }
            squares += e[i * n + j] * e[i * n + j];
        }
    }
    double x[64], y[64], norm = 0.0;
    for (size_t i = 0; i < n; i++) {
        x[i] = 1.0 + 0.1 * (double)i;
    }
    for (int step = 0; step < 2000; step++) {
        norm = 0.0;
        for (size_t i = 0; i < n; i++) {
            y[i] = 0.0;
            for (size_t j = 0; j < n; j++) {
                y[i] += e[i * n + j] * x[j];
            }
            norm += y[i] * y[i];
        }
        for (size_t i = 0; i < n; i++) {
            x[i] = y[i] / sqrt(norm);
        }
    }
    *largest_out  = sqrt(norm);
    *rms_out      = sqrt(squares / (double)n);
    *constant_out = e[0];
    free(e);
    free(c);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

static void test_round_trip(void **state)
{
    static const struct {
        int    hsh, sh;
        double largest, rms; /* rms 0: not stated */
    } known[] = {{3, 3, .996, .65},
                 {3, 5, .588, .21},
                 {3, 10, .280, .096},
                 {6, 6, 1.000, .69},
                 {6, 10, .921, .24}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double largest = 0.0, rms = 0.0, constant = 0.0;
        defect(context_of(state), known[i].hsh, known[i].sh, &largest, &rms, &constant);
        printf("# HSH %d by SH %2d: 1 - C C' has norm %.4f, rms %.4f, of a constant %.4f\n",
               known[i].hsh, known[i].sh, largest, rms, constant);
        assert_near(largest, known[i].largest, 5.1e-4);
        assert_near(rms, known[i].rms, 5.1e-3);
        if (known[i].hsh == 3 && known[i].sh != 5) {
            assert_near(constant, known[i].sh == 3 ? 0.125 : 0.030,
                        known[i].sh == 3 ? 1e-15 : 5e-4);
        }
    }
}

/* ---- refusals ---- */

static assay_status convert(assay_context *context, void *user)
{
    (void)user;
    assay_basis  *sh = NULL, *hsh = NULL;
    assay_sparse *c = NULL;
    assay_status  status =
        assay_basis_create(context, ASSAY_BASIS_SH, 4, ASSAY_CONVENTION_THESIS, &sh);
    status = status
                 ? status
                 : assay_basis_create(context, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS, &hsh);
    status = status ? status : assay_basis_conversion(context, hsh, sh, &c);
    assert_true(!status == !!c);
    assay_sparse_destroy(c);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
    return status;
}

static void test_refusals(void **state)
{
    assay_context *context = context_of(state);
    assay_basis   *sh      = basis_make_in(context, ASSAY_BASIS_SH, 2, ASSAY_CONVENTION_THESIS);
    assay_basis   *esh     = basis_make_in(context, ASSAY_BASIS_ESH, 2, ASSAY_CONVENTION_THESIS);
    assay_sparse  *c       = NULL;
    assert_int_equal(assay_basis_conversion(context, sh, sh, &c), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_conversion(context, sh, esh, &c), ASSAY_ERR_ARGUMENT);
    assert_null(c);
    assay_sparse_destroy(NULL);
    assay_basis_destroy(sh);
    assay_basis_destroy(esh);
    assert_true(failing_each(convert, NULL) > 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_second_method), cmocka_unit_test(test_known_entries),
        cmocka_unit_test(test_transposed),    cmocka_unit_test(test_exact_functions),
        cmocka_unit_test(test_round_trip),    cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, basis_set_up, basis_tear_down);
}
