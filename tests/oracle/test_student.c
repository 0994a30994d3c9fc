/* test_student.c - tails of Student's t against the certified table, closed forms, and themselves.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "core/numerics.h"
#include "oracle/image/student.h"
#include "support/near.h"
#include "support/reference_table.h"

static double relative(double got, double expected)
{
    return got == expected ? 0.0 : fabs(got - expected) / fabs(expected);
}

static void table_of_arb(void **state)
{
    reference_table *table = reference_table_read("student_tail");
    assert_int_equal(table->rows, 12 * 13);
    for (size_t row = 0; row < table->rows; row++) {
        const double *key      = reference_table_keys(table, row);
        const double  degrees  = key[0] > 0.0 ? key[0] : ASSAY_NORMAL;
        const double  expected = reference_table_values(table, row)[0];
        const double  error    = relative(assay_student_log_p(key[1], degrees), expected);
        if (!(error < 1e-12)) {
            fail_msg("degrees %g, t %g: relative error %g", key[0], key[1], error);
        }
    }
    reference_table_free(table);
    (void)state;
}

/* Three degrees: p = 1 - 2 / pi (atan(u) + u / (1 + u^2)), u = t / sqrt(3), which is 4 / (3 pi u^3)
 * far out. */
static void closed_forms(void **state)
{
    for (double t = 0.1; t < 5.0; t += 0.1) {
        const double u = t / sqrt(3.0);
        const double p = 1.0 - 2.0 * ASSAY_INV_PI * (assay_atan(u) + u / (1.0 + u * u));
        assert_true(relative(assay_student_log_p(t, 3.0), assay_log(p)) < 1e-13 / p);
    }
    for (double u = 1e10; u < 1e100; u *= 1e10) {
        const double expected = assay_log(4.0 / (3.0 * ASSAY_PI)) - 3.0 * assay_log(u);
        assert_true(relative(assay_student_log_p(-u * sqrt(3.0), 3.0), expected) < 1e-14);
    }
    (void)state;
}

static void ends(void **state)
{
    assert_true(assay_student_log_p(0.0, 5.0) == 0.0);
    assert_true(assay_student_log_p(INFINITY, 5.0) == -INFINITY);
    assert_true(isnan(assay_student_log_p(NAN, 5.0)));
    assert_true(isnan(assay_student_log_p(1.0, NAN)));
    assert_true(assay_student_log_p(1e-200, 5.0) <= 0.0);
    assert_true(assay_student_quantile(0.0, 5.0) < 1e-300);
    assert_true(isinf(assay_student_quantile(-1e9, 1.0)));
    (void)state;
}

/* The tail falls with t and, for a t that is not small, with the degrees, across every switch of
 * method. */
static void falls(void **state)
{
    static const double degrees[] = {0.5, 1.0, 2.9, 7.0, 31.0, 32.5, 1e3, 1e7, 1e15, ASSAY_NORMAL};
    enum { COUNT = sizeof degrees / sizeof degrees[0] };
    for (int i = 0; i < COUNT; i++) {
        double before = 0.0;
        for (double t = 0.01; t < 60.0; t *= 1.003) {
            const double log_p = assay_student_log_p(t, degrees[i]);
            assert_true(log_p < before);
            assert_true(t < 2.0 || i == 0 ||
                        log_p * (1.0 + 1e-12) <= assay_student_log_p(t, degrees[i - 1]));
            before = log_p;
        }
    }
    (void)state;
}

static void quantile_is_the_inverse(void **state)
{
    static const double degrees[] = {0.7, 3.0, 12.3, 900.0, ASSAY_NORMAL};
    for (int i = 0; i < 5; i++) {
        for (double log_p = -0.01; log_p > -2000.0; log_p *= 3.0) {
            const double t = assay_student_quantile(log_p, degrees[i]);
            assert_true(isinf(t) || relative(assay_student_log_p(t, degrees[i]), log_p) < 1e-12);
        }
    }
    /* Printed in every table of the distributions. */
    assert_true(fabs(assay_student_quantile(assay_log(0.05), ASSAY_NORMAL) - 1.959963985) < 1e-8);
    assert_true(fabs(assay_student_quantile(assay_log(0.05), 10.0) - 2.228138852) < 1e-8);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_of_arb),
        cmocka_unit_test(closed_forms),
        cmocka_unit_test(ends),
        cmocka_unit_test(falls),
        cmocka_unit_test(quantile_is_the_inverse),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
