/* test_quadrature.c - Gauss-Legendre rules: closed forms, moments, and the definition in long
 * double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "math/quadrature.h"
#include "support/near.h"

enum { LARGEST = 2000 };

static double nodes[LARGEST], weights[LARGEST];

static void test_closed_forms(void **state)
{
    (void)state;
    assay_gauss_legendre(1, nodes, weights);
    assert_true(nodes[0] == 0.0 && weights[0] == 2.0);
    assay_gauss_legendre(2, nodes, weights);
    assert_near(nodes[1], sqrt(1.0 / 3.0), DBL_EPSILON / 2);
    assert_near(weights[0], 1.0, DBL_EPSILON / 2);
    assay_gauss_legendre(3, nodes, weights);
    assert_true(nodes[1] == 0.0);
    assert_near(nodes[2], sqrt(0.6), DBL_EPSILON / 2);
    assert_near(weights[0], 5.0 / 9.0, DBL_EPSILON / 2);
    assert_near(weights[1], 8.0 / 9.0, DBL_EPSILON / 2);
    assay_gauss_legendre_on(3.0, 7.0, 2, nodes, weights);
    assert_near(nodes[0], 5.0 - 2.0 * sqrt(1.0 / 3.0), 2 * DBL_EPSILON);
    assert_near(weights[1], 2.0, DBL_EPSILON);
}

/* Moments up to the last that the rule has to get right, and the first that it must not. */
static void test_polynomials(void **state)
{
    (void)state;
    for (int n = 1; n <= 24; n++) {
        assay_gauss_legendre(n, nodes, weights);
        for (int k = 0; k <= 2 * n; k++) {
            long double sum = 0.0L;
            for (int i = 0; i < n; i++) {
                sum += (long double)weights[i] * powl((long double)nodes[i], k);
            }
            const double expected = k % 2 ? 0.0 : 2.0 / (k + 1.0);
            if (k < 2 * n) {
                assert_near((double)sum, expected, 4 * DBL_EPSILON);
            } else if (n < 12) {
                assert_true(fabs((double)sum - expected) > 1e-9);
            }
        }
    }
}

/* One Newton step in long double from the node, and the weight there. */
static void check_rule(int n, double *worst_node, double *worst_weight)
{
    assay_gauss_legendre(n, nodes, weights);
    const int stride = n > 300 ? 13 : 1; /* long double is slow on some machines */
    for (int i = 0; i < n; i += stride) {
        long double x = (long double)nodes[i], slope = 0.0L;
        for (int step = 0; step < 2; step++) {
            long double p = x, before = 1.0L;
            for (int k = 2; k <= n; k++) {
                const long double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before                 = p;
                p                      = next;
            }
            slope = n == 1 ? 1.0L : n * (before - x * p) / (1.0L - x * x);
            x -= p / slope;
        }
        const long double w    = 2.0L / ((1.0L - x * x) * slope * slope);
        const double      unit = nextafter(fabs(nodes[i]), 2.0) - fabs(nodes[i]);
        *worst_node   = fmax(*worst_node, fabs((double)(x - (long double)nodes[i])) / unit);
        *worst_weight = fmax(*worst_weight, (double)fabsl(w / (long double)weights[i] - 1.0L));
        assert_true(i == 0 || nodes[i] > nodes[i - 1]);
        assert_true(nodes[i] == -nodes[n - 1 - i] && weights[i] == weights[n - 1 - i]);
    }
}

static void test_last_bits(void **state)
{
    (void)state;
    const int sizes[] = {2, 3, 4, 5, 7, 10, 16, 33, 64, 101, 256, 500, 1001, LARGEST};
    double    node = 0.0, weight = 0.0;
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        check_rule(sizes[k], &node, &weight);
        /* What long double's own recurrence may lose near the ends grows as n^2. */
        const double n = sizes[k];
        assert_true(weight <= 0.51 * DBL_EPSILON + 0.3 * n * n * (double)LDBL_EPSILON);
    }
    printf("# Gauss-Legendre to %d nodes: nodes within %.2f units, weights within %.2g\n", LARGEST,
           node, weight);
    assert_true(node <= 0.6);
    assert_true(weight <= 1e-13);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_forms),
        cmocka_unit_test(test_polynomials),
        cmocka_unit_test(test_last_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
