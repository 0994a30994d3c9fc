/* test_distribution.c - draws from tables of weights, against their definition in long double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>

#include "core/random.h"
#include "math/distribution.h"
#include "support/failing_context.h"
#include "support/near.h"

static const double BELOW_ONE = 0x1.fffffffffffffp-1;

static assay_context *context_of(void **state) { return *state; }

static int set_up(void **state)
{
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    *state = context;
    return 0;
}

static int tear_down(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

/* Weights over many magnitudes, about a tenth of them zero. */
static double *random_weights(size_t count, uint64_t seed)
{
    double *weights = malloc(count * sizeof *weights);
    assert_non_null(weights);
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 1, 0);
    for (size_t i = 0; i < count; i++) {
        const double u = assay_random_next(&random);
        weights[i]     = u < 0.1 ? 0.0 : ldexp(u, (int)(40.0 * assay_random_next(&random)) - 20);
    }
    return weights;
}

static void small_table_by_hand(void **state)
{
    static const double  weights[] = {1.0, 2.0, 0.0, 5.0};
    assay_distribution1 *d         = NULL;
    double               p, t;
    assert_int_equal(assay_distribution1_create(context_of(state), weights, 4, &d), ASSAY_OK);
    assert_int_equal(assay_distribution1_count(d), 4);
    assert_true(assay_distribution1_total(d) == 8.0);
    assert_true(assay_distribution1_probability(d, 0) == 0.125);
    assert_true(assay_distribution1_probability(d, 1) == 0.25);
    assert_true(assay_distribution1_probability(d, 2) == 0.0);
    assert_true(assay_distribution1_probability(d, 3) == 0.625);
    static const struct {
        double u;
        size_t index;
        double remapped;
    } rows[] = {{0.0, 0, 0.0},   {0.0625, 0, 0.5}, {0.125, 1, 0.0},          {0.25, 1, 0.5},
                {0.375, 3, 0.0}, {0.6875, 3, 0.5}, {BELOW_ONE, 3, BELOW_ONE}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(assay_distribution1_sample(d, rows[i].u, &p, &t), rows[i].index);
        assert_true(p == assay_distribution1_probability(d, rows[i].index));
        assert_near(t, rows[i].remapped, 2e-16);
        assert_true(t >= 0.0 && t < 1.0);
    }
    assert_int_equal(assay_distribution1_sample(d, 0.5, NULL, NULL), 3);
    assay_distribution1_destroy(d);
    assay_distribution1_destroy(NULL);
}

/* Against sums in long double.  A sum of n doubles by compensation is within 2 ulp. */
static void probabilities_are_shares(void **state)
{
    enum { COUNT = 100000 };
    double              *weights = random_weights(COUNT, 7);
    assay_distribution1 *d       = NULL;
    long double          total = 0.0L, sum = 0.0L;
    for (size_t i = 0; i < COUNT; i++) {
        total += weights[i];
    }
    assert_int_equal(assay_distribution1_create(context_of(state), weights, COUNT, &d), ASSAY_OK);
    assert_near(assay_distribution1_total(d), (double)total, 4e-16 * (double)total);
    for (size_t i = 0; i < COUNT; i++) {
        const double p = assay_distribution1_probability(d, i);
        assert_near(p, (double)(weights[i] / total), 1e-15);
        assert_true(weights[i] != 0.0 || p == 0.0);
        sum += p;
    }
    assert_near((double)sum, 1.0, 1e-11);
    assay_distribution1_destroy(d);
    free(weights);
}

/* Draws at COUNT evenly spaced numbers: each index must come up its probability times COUNT, up to
 * one.  `shift` turns the probabilities: the mutant. */
static bool evenly_drawn(const assay_distribution1 *d, size_t count, size_t shift)
{
    enum { DRAWS = 200000 };
    int *drawn = calloc(count, sizeof *drawn);
    bool good  = true;
    assert_non_null(drawn);
    for (int k = 0; k < DRAWS; k++) {
        double p, t;
        drawn[assay_distribution1_sample(d, (k + 0.5) / DRAWS, &p, &t)]++;
        good = good && p > 0.0 && t >= 0.0 && t < 1.0;
    }
    for (size_t i = 0; i < count; i++) {
        const double p = assay_distribution1_probability(d, (i + shift) % count);
        good           = good && fabs(drawn[i] - p * DRAWS) <= 1.0;
    }
    free(drawn);
    return good;
}

static void draws_follow_probabilities(void **state)
{
    enum { COUNT = 257 };
    double              *weights = random_weights(COUNT, 3);
    assay_distribution1 *d       = NULL;
    assert_int_equal(assay_distribution1_create(context_of(state), weights, COUNT, &d), ASSAY_OK);
    assert_true(evenly_drawn(d, COUNT, 0));
    assert_false(evenly_drawn(d, COUNT, 1));
    assay_distribution1_destroy(d);
    free(weights);
}

static void zero_weights_are_never_drawn(void **state)
{
    static const double  weights[] = {0.0, 0.0, 1e-300, 0.0, 3.0, 0.0, 0.0};
    assay_distribution1 *d         = NULL;
    assert_int_equal(assay_distribution1_create(context_of(state), weights, 7, &d), ASSAY_OK);
    for (int k = 0; k <= 1000; k++) {
        const double u = k == 1000 ? BELOW_ONE : k / 1000.0;
        const size_t i = assay_distribution1_sample(d, u, NULL, NULL);
        assert_true(weights[i] > 0.0);
    }
    assay_distribution1_destroy(d);
}

static void subnormal_totals_work(void **state)
{
    static const double  weights[] = {0x1p-1074, 0.0, 0x1p-1074, 0.0};
    assay_distribution1 *d         = NULL;
    double               p, t;
    assert_int_equal(assay_distribution1_create(context_of(state), weights, 4, &d), ASSAY_OK);
    assert_int_equal(assay_distribution1_sample(d, 0.0, &p, &t), 0);
    assert_true(p == 0.5);
    assert_int_equal(assay_distribution1_sample(d, BELOW_ONE, &p, &t), 2);
    assert_true(p == 0.5 && t >= 0.0 && t < 1.0);
    assay_distribution1_destroy(d);
}

static void nothing_to_draw(void **state)
{
    static const double      zeros[6] = {0.0};
    assay_distribution1     *d        = NULL;
    assay_distribution2     *d2       = NULL;
    double                   p = -1.0, t = -1.0;
    assay_distribution2_cell cell;
    assert_int_equal(assay_distribution1_create(context_of(state), zeros, 6, &d), ASSAY_OK);
    assert_int_equal(assay_distribution1_sample(d, 0.7, &p, &t), 0);
    assert_true(p == 0.0 && t == 0.7 && assay_distribution1_probability(d, 3) == 0.0);
    assert_int_equal(assay_distribution2_create(context_of(state), zeros, 2, 3, &d2), ASSAY_OK);
    cell = assay_distribution2_sample(d2, 0.7, 0.2);
    assert_true(cell.probability == 0.0 && cell.in_row == 0.7 && cell.in_column == 0.2);
    assert_true(assay_distribution2_probability(d2, 1, 1) == 0.0);
    assay_distribution1_destroy(d);
    assay_distribution2_destroy(d2);
}

static void bad_weights_are_refused(void **state)
{
    static const double bad[][2] = {
        {1.0, NAN}, {-1.0, 2.0}, {INFINITY, 1.0}, {-0x1p-1074, 1.0}, {0x1.8p1023, 0x1p1023}};
    assay_distribution1 *d  = NULL;
    assay_distribution2 *d2 = NULL;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(assay_distribution1_create(context_of(state), bad[i], 2, &d),
                         ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_distribution2_create(context_of(state), bad[i], 2, 1, &d2),
                         ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_distribution2_create(context_of(state), bad[i], 1, 2, &d2),
                         ASSAY_ERR_DOMAIN);
    }
    assert_int_equal(assay_distribution1_create(context_of(state), bad[0], 0, &d),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(
        assay_distribution1_create(context_of(state), bad[0], ((size_t)1 << 31) + 1, &d),
        ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_distribution2_create(context_of(state), bad[0], (size_t)1 << 16,
                                                (size_t)1 << 16, &d2),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_distribution2_create(context_of(state), bad[0], 0, 3, &d2),
                     ASSAY_ERR_ARGUMENT);
    assert_null(d);
    assert_null(d2);
}

/* Draws on an even grid of the square; every cell must come up as often as it should.  A row's
 * share of the grid is off by at most one line of it. */
static bool evenly_drawn2(const assay_distribution2 *d, size_t rows, size_t columns,
                          bool transposed)
{
    enum { SIDE = 700 };
    int *drawn = calloc(rows * columns, sizeof *drawn);
    bool good  = true;
    assert_non_null(drawn);
    for (int a = 0; a < SIDE; a++) {
        for (int b = 0; b < SIDE; b++) {
            const assay_distribution2_cell c =
                assay_distribution2_sample(d, (a + 0.5) / SIDE, (b + 0.5) / SIDE);
            drawn[c.row * columns + c.column]++;
            good = good && c.probability == assay_distribution2_probability(d, c.row, c.column) &&
                   c.in_row >= 0.0 && c.in_row < 1.0 && c.in_column >= 0.0 && c.in_column < 1.0;
        }
    }
    for (size_t i = 0; i < rows * columns; i++) {
        const size_t row = i / columns, column = i % columns;
        const double p = transposed
                             ? assay_distribution2_probability(d, column % rows, row % columns)
                             : assay_distribution2_probability(d, row, column);
        good           = good && fabs(drawn[i] - p * SIDE * SIDE) <= 2.0 * SIDE;
    }
    free(drawn);
    return good;
}

static void cells_follow_probabilities(void **state)
{
    enum { ROWS = 5, COLUMNS = 7 };
    double      weights[ROWS * COLUMNS];
    long double total = 0.0L;
    for (size_t i = 0; i < ROWS * COLUMNS; i++) {
        weights[i] = (double)((i * i * 7 + 3 * i) % 11) * (i / COLUMNS == 2 ? 0.0 : 1.0);
        total += weights[i];
    }
    assay_distribution2 *d = NULL;
    assert_int_equal(assay_distribution2_create(context_of(state), weights, ROWS, COLUMNS, &d),
                     ASSAY_OK);
    assert_near(assay_distribution2_total(d), (double)total, 1e-13);
    for (size_t i = 0; i < ROWS * COLUMNS; i++) {
        const double p = assay_distribution2_probability(d, i / COLUMNS, i % COLUMNS);
        assert_near(p, (double)(weights[i] / total), 1e-15);
    }
    assert_true(evenly_drawn2(d, ROWS, COLUMNS, false));
    assert_false(evenly_drawn2(d, ROWS, COLUMNS, true));
    assay_distribution2_destroy(d);
    assay_distribution2_destroy(NULL);
}

static assay_status make_both(assay_context *context, void *user)
{
    static const double  weights[6] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0};
    assay_distribution1 *d1         = NULL;
    assay_distribution2 *d2         = NULL;
    (void)user;
    assay_status status = assay_distribution1_create(context, weights, 6, &d1);
    if (status == ASSAY_OK) {
        status = assay_distribution2_create(context, weights, 2, 3, &d2);
    }
    assay_distribution1_destroy(d1);
    assay_distribution2_destroy(d2);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_int_equal(failing_each(make_both, NULL), 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(small_table_by_hand, set_up, tear_down),
        cmocka_unit_test_setup_teardown(probabilities_are_shares, set_up, tear_down),
        cmocka_unit_test_setup_teardown(draws_follow_probabilities, set_up, tear_down),
        cmocka_unit_test_setup_teardown(zero_weights_are_never_drawn, set_up, tear_down),
        cmocka_unit_test_setup_teardown(subnormal_totals_work, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nothing_to_draw, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bad_weights_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(cells_follow_probabilities, set_up, tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
