/* test_legendre.c - Legendre polynomials against written-out ones, their norms and the bases. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assay/basis.h"
#include "math/quadrature.h"

enum { N = 17, COUNT = N * (N + 1) / 2 };

static size_t at(int l, int m) { return (size_t)(l * (l + 1) / 2 + m); }

static void close(double value, double expected, double scale)
{
    if (!(fabs(value - expected) <= 1e-13 * scale)) {
        fail_msg("%.17g, not %.17g", value, expected);
    }
}

/* With (-1)^m, as the thesis prints them; shifted, the same of 2 x - 1. */
static void low_degrees(void **state)
{
    (void)state;
    double p[10], q[10];
    for (int i = 0; i <= 20; i++) {
        const double x = i / 10.0 - 1.0, s = sqrt(1.0 - x * x);
        assert_int_equal(assay_legendre(4, x, p), ASSAY_OK);
        const double expected[10] = {1.0,
                                     x,
                                     -s,
                                     (3 * x * x - 1) / 2,
                                     -3 * x * s,
                                     3 * s * s,
                                     (5 * x * x * x - 3 * x) / 2,
                                     -1.5 * (5 * x * x - 1) * s,
                                     15 * x * s * s,
                                     -15 * s * s * s};
        assert_int_equal(assay_legendre_shifted(4, i / 20.0, q), ASSAY_OK);
        for (int k = 0; k < 10; k++) {
            close(p[k], expected[k], 15.0);
            close(q[k], expected[k], 15.0);
        }
    }
}

/* Eq. 3.3: integral of (P_l^m)^2 = 2 (l + m)! / ((2 l + 1) (l - m)!), and 0 for different l. */
static void norms(void **state)
{
    (void)state;
    double x[N + 1], weight[N + 1], p[COUNT], gram[N][N];
    assay_gauss_legendre_on(-1.0, 1.0, N + 1, x, weight);
    for (int m = 0; m < N; m++) {
        double norm[N] = {0.0};
        for (int l = m; l < N; l++) {
            norm[l] = 2.0 / (2 * l + 1);
            for (int k = l - m + 1; k <= l + m; k++) {
                norm[l] *= k;
            }
            for (int j = m; j < N; j++) {
                gram[l][j] = 0.0;
            }
        }
        for (int i = 0; i <= N; i++) {
            assert_int_equal(assay_legendre(N, x[i], p), ASSAY_OK);
            for (int l = m; l < N; l++) {
                for (int j = m; j < N; j++) {
                    gram[l][j] += weight[i] * p[at(l, m)] * p[at(j, m)];
                }
            }
        }
        for (int l = m; l < N; l++) {
            for (int j = m; j < N; j++) {
                close(gram[l][j] / sqrt(norm[l] * norm[j]), l == j ? 1.0 : 0.0, 1.0);
            }
        }
    }
}

static void refusals(void **state)
{
    (void)state;
    double p[3] = {7.0, 7.0, 7.0};
    assert_int_equal(assay_legendre(0, 0.5, p), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_legendre(ASSAY_BASIS_MAX_ORDER + 1, 0.5, p), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_legendre(2, 1.0000001, p), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_legendre(2, NAN, p), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_legendre_shifted(2, -1e-9, p), ASSAY_ERR_DOMAIN);
    assert_true(p[0] == 7.0 && p[2] == 7.0);
}

/* The diffuse convolution of a constant radiance 1 is irradiance pi, and dot products are sums. */
static void convolution_and_dot(void **state)
{
    (void)state;
    assay_context *context = NULL;
    assay_basis   *sh = NULL, *hsh = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assert_int_equal(
        assay_basis_create(context, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_KONTKANEN, &sh), ASSAY_OK);
    assert_int_equal(assay_basis_create(context, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS, &hsh),
                     ASSAY_OK);
    const double pi   = 3.14159265358979323846;
    double       c[9] = {sqrt(4.0 * pi), 1.0, 0, 0, 0, 0, 0, 1.0, 0}, y[9];
    const double a[9] = {1, 2, 3, 0, 0, 0, 0, 0, 4}, b[9] = {5, 6, 7, 0, 0, 0, 0, 0, 8};
    assert_int_equal(assay_basis_convolve_cosine(sh, 1, c), ASSAY_OK);
    assert_int_equal(assay_basis_evaluate(sh, (assay_vec3){0.6, 0.0, 0.8}, y), ASSAY_OK);
    close(c[0] * y[0], pi, 1.0);
    close(c[1], 2.0 * pi / 3.0, 1.0);
    close(c[7], pi / 4.0, 1.0);
    assert_true(assay_basis_dot(sh, a, b) == 5.0 + 12.0 + 21.0 + 32.0);
    assert_int_equal(assay_basis_convolve_cosine(hsh, 1, c), ASSAY_ERR_ARGUMENT);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(low_degrees),
        cmocka_unit_test(norms),
        cmocka_unit_test(refusals),
        cmocka_unit_test(convolution_and_dot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
