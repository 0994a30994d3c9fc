/* test_sobol.c - what makes a (0, 2)-sequence one, for every seed.
 *
 * Mutant: without the second coordinate's directions (both coordinates the same) the check must
 * fail. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/random.h"
#include "math/sobol.h"

enum { LEVELS = 8, POINTS = 1 << LEVELS };

/* Whether each of the 2^m boxes of 2^a columns and 2^(m - a) rows holds one of the points. */
static bool one_in_each(const assay_point2 *points, int m, int a)
{
    bool taken[POINTS];
    memset(taken, 0, sizeof taken);
    for (int i = 0; i < 1 << m; i++) {
        const int column = (int)(points[i].x * (1 << a));
        const int row    = (int)(points[i].y * (1 << (m - a)));
        const int box    = column << (m - a) | row;
        if (taken[box]) {
            return false;
        }
        taken[box] = true;
    }
    return true;
}

static bool all_divisions(const assay_point2 *points, int m)
{
    for (int a = 0; a <= m; a++) {
        if (!one_in_each(points, m, a)) {
            return false;
        }
    }
    return true;
}

static void every_division_of_the_square(void **state)
{
    (void)state;
    assay_random random = assay_random_start(5, ASSAY_STAGE_TEST, 0, 0);
    for (int seed = 0; seed < 200; seed++) {
        const uint64_t values = assay_random_bits(&random);
        const uint32_t order  = (uint32_t)assay_random_bits(&random);
        const uint32_t block  = (uint32_t)(seed % 5);
        assay_point2   points[POINTS], same[POINTS];
        for (int m = 0; m <= LEVELS; m++) {
            for (uint32_t i = 0; i < 1u << m; i++) {
                points[i] = sobol_point((block << m) + i, values, order);
                same[i]   = (assay_point2){points[i].x, points[i].x};
                assert_true(points[i].x >= 0.0 && points[i].x < 1.0 && points[i].y >= 0.0 &&
                            points[i].y < 1.0);
            }
            assert_true(all_divisions(points, m));
            assert_true(m < 2 || !all_divisions(same, m));
        }
    }
}

/* Over seeds, one point is uniform, and two sequences know nothing of one another: means of x and
 * of products of deviations within 5 standard errors. */
static void seeds_are_independent(void **state)
{
    (void)state;
    enum { N = 100000 };
    assay_random random = assay_random_start(6, ASSAY_STAGE_TEST, 0, 0);
    double       mean = 0.0, square = 0.0, product = 0.0, across = 0.0;
    for (int i = 0; i < N; i++) {
        const uint64_t     v1 = assay_random_bits(&random), v2 = assay_random_bits(&random);
        const uint64_t     order = assay_random_bits(&random);
        const assay_point2 p     = sobol_point(3, v1, (uint32_t)order);
        const assay_point2 q     = sobol_point(3, v2, (uint32_t)(order >> 32));
        mean += p.x - 0.5;
        square += (p.y - 0.5) * (p.y - 0.5) - 1.0 / 12.0;
        product += (p.x - 0.5) * (p.y - 0.5);
        across += (p.x - 0.5) * (q.x - 0.5);
    }
    assert_true(fabs(mean / N) < 5.0 * sqrt(1.0 / 12.0 / N));
    assert_true(fabs(square / N) < 5.0 * sqrt(1.0 / 180.0 / N));
    assert_true(fabs(product / N) < 5.0 / 12.0 / sqrt(N));
    assert_true(fabs(across / N) < 5.0 / 12.0 / sqrt(N));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_division_of_the_square),
        cmocka_unit_test(seeds_are_independent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
