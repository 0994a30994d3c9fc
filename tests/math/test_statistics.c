/* The judges of the samplers, judged: distributions against closed forms, quadrature against known
 * integrals, and p-values against the uniform law that they follow when all is right. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "../support/near.h"
#include "../support/statistics.h"
#include "core/numerics.h"
#include "core/random.h"
#include "math/sampling.h"

static void test_gamma(void **state)
{
    (void)state;
    for (double x = 0.0; x < 40.0; x += 0.37) {
        /* Q(1/2, x) = erfc(sqrt x), Q(1, x) = e^-x, Q(n, x) = e^-x sum x^k / k! */
        assert_near(statistics_gamma_q(0.5, x), erfc(sqrt(x)), 1e-14);
        assert_near(statistics_gamma_q(1.0, x), exp(-x), 1e-14);
        double term = exp(-x), sum = term;
        for (int k = 1; k < 25; k++) {
            term *= x / k;
            sum += term;
        }
        assert_near(statistics_gamma_q(25.0, x), sum, 1e-13);
    }
    /* The median of chi-square is near k (1 - 2 / (9 k))^3, Wilson and Hilferty; its error is far
     * under 1e-3 in probability at k = 500. */
    assert_near(statistics_chi_square_tail(500.0 * pow(1.0 - 2.0 / 4500.0, 3.0), 500), 0.5, 1e-4);
    assert_near(statistics_sidak(0.01, 1), 0.01, 1e-15);
    assert_near(1.0 - pow(1.0 - statistics_sidak(0.01, 300), 300.0), 0.01, 1e-12);
}

static double constant(const void *context, assay_vec3 w)
{
    (void)w;
    return *(const double *)context;
}

static double upper_cosine(const void *context, assay_vec3 w)
{
    return w.z > 0.0 ? w.z * *(const double *)context : 0.0;
}

/* Normalised on the sphere: k / (2 pi (1 - e^-2k)) exp(k (w . d - 1)), von Mises and Fisher. */
static double fisher(const void *context, assay_vec3 w)
{
    const double     k = *(const double *)context;
    const assay_vec3 d = {0.6, 0.0, 0.8};
    return k / (ASSAY_TWO_PI * -expm1(-2.0 * k)) * exp(k * (vec3_dot(w, d) - 1.0));
}

static void test_quadrature(void **state)
{
    (void)state;
    const double    one = 1.0, narrow = 1e5;
    statistics_grid grid = statistics_grid_between(-1.0, 1.0, 9, 17);
    assert_near(statistics_integrate(&grid, constant, &one, 1e-9, NULL), 4.0 * ASSAY_PI, 1e-12);
    /* A kink that no edge follows: 9 rows put none at z = 0. */
    assert_near(statistics_integrate(&grid, upper_cosine, &one, 1e-9, NULL), ASSAY_PI, 1e-7);
    statistics_grid_focus(&grid, (assay_vec3){0.6, 0.0, 0.8}, 1.0 / sqrt(narrow));
    assert_near(statistics_integrate(&grid, fisher, &narrow, 1e-9, NULL), 1.0, 1e-7);
}

static bool cosine_sampler(const void *context, const double u[3], assay_vec3 *direction_out)
{
    (void)context;
    *direction_out = assay_sample_cosine_hemisphere(u[0], u[1]);
    return u[2] < 0.7;
}

/* p-values of a right density are uniform: their empirical distribution keeps within Kolmogorov's
 * bound 1.95 / sqrt(n), exceeded with probability 1e-3. */
static void test_p_values(void **state)
{
    (void)state;
    enum { RUNS = 200 };
    const double          scale = 0.7 * ASSAY_INV_PI;
    const statistics_grid grid  = statistics_grid_between(-1.0, 1.0, 8, 8);
    double                worst = 0.0, p[RUNS];
    for (int i = 0; i < RUNS; i++) {
        p[i] =
            statistics_test_sampler(&grid, upper_cosine, cosine_sampler, &scale, 4000, (uint64_t)i)
                .p_shape;
    }
    for (int i = 0; i < RUNS; i++) {
        int below = 0;
        for (int j = 0; j < RUNS; j++) {
            below += p[j] <= p[i];
        }
        worst = fmax(worst, fmax(fabs((double)below / RUNS - p[i]),
                                 fabs((double)(below - 1) / RUNS - p[i])));
    }
    assert_true(worst < 1.95 / sqrt(RUNS));
}

/* A density of 1 % too much or too little, and one of another shape, do not pass. */
static void test_mutants(void **state)
{
    (void)state;
    const statistics_grid grid      = statistics_grid_between(-1.0, 1.0, 8, 8);
    const double          scales[3] = {0.7 * 1.01 * ASSAY_INV_PI, 0.7 * 0.99 * ASSAY_INV_PI,
                                       2.0 * ASSAY_INV_PI};
    for (int i = 0; i < 3; i++) {
        assert_true(
            statistics_test_sampler(&grid, upper_cosine, cosine_sampler, &scales[i], 400000, 1).p <
            1e-6);
    }
    const double flat = 0.7 * 0.25 * ASSAY_INV_PI;
    assert_true(statistics_test_sampler(&grid, constant, cosine_sampler, &flat, 4000, 1).p < 1e-6);
}

static void test_means(void **state)
{
    (void)state;
    statistics_mean mean   = {0};
    assay_random    random = assay_random_start(1, ASSAY_STAGE_TEST, 0, 0);
    for (int i = 0; i < 100000; i++) {
        statistics_mean_add(&mean, assay_random_next(&random));
    }
    assert_near(statistics_mean_error(&mean), sqrt(1.0 / 12.0 / 1e5), 1e-5);
    assert_true(fabs(mean.mean - 0.5) < 4.0 * statistics_mean_error(&mean));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gamma),    cmocka_unit_test(test_quadrature),
        cmocka_unit_test(test_p_values), cmocka_unit_test(test_mutants),
        cmocka_unit_test(test_means),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
