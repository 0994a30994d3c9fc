/* test_multiple_tests.c - corrections for many tests, against published examples and the rules
 * worked out by brute force. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "core/numerics.h"
#include "core/random.h"
#include "oracle/image/multiple_tests.h"
#include "support/failing_context.h"

static failing_memory memory;

static int set_up(void **state)
{
    *state = failing_context(&memory);
    return 0;
}

static int tear_down(void **state)
{
    assert_int_equal(memory.live, 1);
    assay_context_destroy(*state);
    return 0;
}

static uint64_t rejected(assay_context *context, double level, const double *p, int count,
                         assay_correction correction)
{
    assay_multiple_tests    tests = assay_multiple_tests_start(context, level);
    assay_multiple_decision decision;
    for (int i = 0; i < count; i++) {
        assay_multiple_tests_add(&tests, assay_log(p[i]), (uint64_t)i);
    }
    assert_int_equal(assay_multiple_tests_decide(&tests, correction, &decision), ASSAY_OK);
    assert_int_equal(decision.tests, count);
    for (size_t i = 0; i < tests.kept_count; i++) {
        assert_true(i == 0 || tests.kept[i - 1].log_p <= tests.kept[i].log_p);
        assert_true((tests.kept[i].log_p <= decision.log_bound) == (i < decision.rejected));
    }
    assay_multiple_tests_end(&tests);
    return decision.rejected;
}

/* The 15 p-values of [benjamini95], section 3.2: Bonferroni (and so the first step of Holm) rejects
 * 3 at 0.05, the step-up rule 4. */
static void thrombolysis(void **state)
{
    static const double p[] = {0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                               0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0};
    assert_int_equal(rejected(*state, 0.05, p, 15, ASSAY_CORRECTION_HOLM), 3);
    assert_int_equal(rejected(*state, 0.05, p, 15, ASSAY_CORRECTION_BH), 4);
}

/* Both rules as their definitions read, on all p and without logarithms. */
static int brute(double level, const double *sorted, int count, bool holm)
{
    int best = 0;
    for (int i = 1; i <= count; i++) {
        const bool small =
            holm ? sorted[i - 1] * (count - i + 1) <= level : sorted[i - 1] * count <= i * level;
        if (holm && !small) {
            return i - 1;
        }
        best = small ? i : best;
    }
    return best;
}

static void as_defined(void **state)
{
    enum { COUNT = 40 };
    uint64_t found[2] = {0, 0};
    for (uint64_t round = 0; round < 2000; round++) {
        assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, round, 0);
        double       p[COUNT], sorted[COUNT] = {0};
        for (int i = 0; i < COUNT; i++) {
            const double u = assay_random_next(&random) + 1e-9;
            p[i]           = i % 3 == 0 ? u * u * u * u : u;
            int at         = i;
            for (; at > 0 && sorted[at - 1] > p[i]; at--) {
                sorted[at] = sorted[at - 1];
            }
            sorted[at] = p[i];
        }
        for (int rule = 0; rule < 2; rule++) {
            const uint64_t got = rejected(*state, 0.1, p, COUNT, (assay_correction)rule);
            assert_int_equal(got, brute(0.1, sorted, COUNT, rule == 0));
            found[rule] += got;
        }
    }
    assert_true(found[0] > 1000 && found[1] > found[0]);
}

static void nan_and_large_count(void **state)
{
    assay_multiple_tests    tests = assay_multiple_tests_start(*state, 0.01);
    assay_multiple_decision decision;
    assay_multiple_tests_add(&tests, NAN, 0);
    assay_multiple_tests_add(&tests, -1e6, 7);
    assay_multiple_tests_add(&tests, -INFINITY, 3);
    assay_multiple_tests_add_large(&tests, 6000000);
    assert_int_equal(assay_multiple_tests_decide(&tests, ASSAY_CORRECTION_HOLM, &decision),
                     ASSAY_OK);
    assert_int_equal(decision.tests, 6000003);
    assert_int_equal(decision.rejected, 2);
    assert_int_equal(tests.kept[0].item, 3);
    assert_true(fabs(decision.log_bound - assay_log(0.01 / 6000001.0)) < 1e-12);
    assay_multiple_tests_end(&tests);
}

static void without_memory(void **state)
{
    assay_multiple_tests    tests = assay_multiple_tests_start(*state, 0.01);
    assay_multiple_decision decision;
    memory.fail_at = memory.asked + 1;
    assay_multiple_tests_add(&tests, -100.0, 0);
    assert_int_equal(assay_multiple_tests_decide(&tests, ASSAY_CORRECTION_HOLM, &decision),
                     ASSAY_ERR_MEMORY);
    assay_multiple_tests_end(&tests);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(thrombolysis, set_up, tear_down),
        cmocka_unit_test_setup_teardown(as_defined, set_up, tear_down),
        cmocka_unit_test_setup_teardown(nan_and_large_count, set_up, tear_down),
        cmocka_unit_test_setup_teardown(without_memory, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
