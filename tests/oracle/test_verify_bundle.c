/* test_verify_bundle.c - bundles against bundles: what is right passes, what is wrong fails at the
 * stage where it was planted. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/failing_context.h"
#include "support/random_places.h"
#include "support/splat_bundle.h"

static void test_right(void **state)
{
    splat_data    *d       = splat_make_data(*state);
    assay_verdict *verdict = splat_verify(*state, d, d, ASSAY_PRECISION_FLOAT);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verdict_count(verdict), SPLAT_JUDGED + SPLAT_INPUTS);
    assert_string_equal(assay_verdict_at(verdict, 0).stage, "splat");
    assert_string_equal(assay_verdict_at(verdict, 2).stage, "splat-light");
    assert_string_equal(assay_verdict_at(verdict, 3).stage, "normalise");
    assert_string_equal(assay_verdict_at(verdict, 4).stage, "combine-irradiance");
    assert_string_equal(assay_verdict_at(verdict, 5).stage, "combine");
    assert_string_equal(assay_verdict_get(verdict, "precision"), "float");
    assert_int_equal(splat_count_of(verdict, "inputs"), SPLAT_INPUTS);
    assert_null(assay_verdict_get(verdict, "not judged"));
    /* Our own stage made this: by hand it is the same. */
    for (size_t i = 0; i < 3 * SPLAT_PIXELS; i++) {
        const few_digits single = {.digits = 24};
        assert_true(d->values[SPLAT_IRRADIANCE_TOTAL][i] ==
                    few(&single, d->values[SPLAT_IRRADIANCE_DIRECT][i] +
                                     d->values[SPLAT_IRRADIANCE_INDIRECT][i]));
    }
    for (int i = 0; i < SPLAT_JUDGED; i++) {
        const assay_finding f = assay_verdict_at(verdict, i);
        assert_true(f.in_bounds >= 0.0 && f.in_bounds <= 1.0 && f.bound > 0.0);
        assert_int_equal(f.values, SPLAT_PIXELS * (i == 0 ? 1 : 3));
    }
    assay_verdict_destroy(verdict);
    /* A float's rounding is seen by who asks for doubles. */
    verdict = splat_verify(*state, d, d, ASSAY_PRECISION_DOUBLE);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_FAIL);
    assay_verdict_destroy(verdict);
    free(d);
}

/* Both parts are just short of the middle between two of a half's smallest steps, so their sum
 * loses nearly one. */
static void test_small_halves(void **state)
{
    enum { AT = 3 * 7 };
    static const struct {
        double             taken, total;
        assay_verdict_kind kind;
    } cases[]     = {{16.49, 24.0, ASSAY_VERDICT_PASS},
                     {16.0, 24.0, ASSAY_VERDICT_PASS},
                     {16.49, 23.0, ASSAY_VERDICT_FAIL},
                     {15.0, 23.0, ASSAY_VERDICT_CANNOT_TELL}};
    splat_data *d = splat_make_data(*state), *mine = splat_copy(d);
    d->values[SPLAT_DIRECT][AT]   = 16.49 * 0x1p-24;
    d->values[SPLAT_INDIRECT][AT] = 8.49 * 0x1p-24;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        memcpy(mine, d, sizeof *mine);
        mine->values[SPLAT_DIRECT][AT] = cases[i].taken * 0x1p-24;
        mine->values[SPLAT_TOTAL][AT]  = cases[i].total * 0x1p-24;
        assay_verdict *verdict         = splat_verify(*state, mine, d, ASSAY_PRECISION_HALF);
        assert_int_equal(assay_verdict_whole(verdict), cases[i].kind);
        assay_verdict_destroy(verdict);
    }
    free(mine);
    free(d);
}

/* Something planted in one array, and where it must be found. */
typedef struct {
    const char *name;
    int         array;
    double      factor, offset;
    size_t      first, end; /* rows of all columns; 0, 0: all */
    const char *stage, *meaning;
} planted;

static const planted DEFECTS[] = {
    {"a weight", SPLAT_WEIGHT, 1.0001, 0.0, 40, 41, "splat", "made in this stage"},
    {"all weights", SPLAT_WEIGHT, 0.99, 0.0, 0, 0, "splat", "0.99 times"},
    {"the sums", SPLAT_SUM, 3.14159265358979, 0.0, 0, 0, "splat", "3.14159 times"},
    {"radiance where a record stands", SPLAT_SUM, 1.05, 0.0, SPLAT_STANDS, SPLAT_STANDS + 1,
     "splat-light", "made in this stage"},
    {"the results", SPLAT_RESULT, -1.0, 0.0, 0, 0, "normalise", "wrong sign"},
    {"one result", SPLAT_RESULT, 1.0, 1e-4, 100, 101, "normalise", "made in this stage"},
    {"the image", SPLAT_TOTAL, 1.0, 0.001, 0, 128, "combine", "made in this stage"},
    {"irradiance", SPLAT_IRRADIANCE_TOTAL, 1.0, 1e-5, 3, 4, "combine-irradiance",
     "made in this stage"},
};

static void test_planted(void **state)
{
    splat_data *d = splat_make_data(*state), *bad = splat_copy(d);
    for (size_t i = 0; i < sizeof DEFECTS / sizeof DEFECTS[0]; i++) {
        const planted *p   = &DEFECTS[i];
        const size_t   end = p->end ? p->end : splat_arrays[p->array].rows;
        memcpy(bad, d, sizeof *bad);
        for (size_t k = p->first * splat_arrays[p->array].columns;
             k < end * splat_arrays[p->array].columns; k++) {
            bad->values[p->array][k] = p->factor * bad->values[p->array][k] + p->offset;
        }
        assay_verdict *verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
        const int      first   = assay_verdict_first(verdict);
        if (assay_verdict_whole(verdict) != ASSAY_VERDICT_FAIL) {
            fail_msg("%s: not seen", p->name);
        }
        const assay_finding f = assay_verdict_at(verdict, first);
        assert_string_equal(f.stage, p->stage);
        assert_string_equal(f.array, splat_arrays[p->array].name);
        assert_true(f.in_bounds > 1.0 && f.ulps > 1.0);
        if (!strstr(f.meaning, p->meaning)) {
            fail_msg("%s: %s", p->name, f.meaning);
        }
        if (p->end == p->first + 1) {
            assert_int_equal(f.place.kind, ASSAY_PLACE_ROW);
            assert_int_equal(f.place.row, p->first);
        }
        assay_verdict_destroy(verdict);
    }
    free(bad);
    free(d);
}

static void test_channels(void **state)
{
    splat_data *d = splat_make_data(*state), *bad = splat_copy(d);
    for (size_t i = 0; i < SPLAT_PIXELS; i++) {
        bad->values[SPLAT_TOTAL][3 * i]     = d->values[SPLAT_TOTAL][3 * i + 2];
        bad->values[SPLAT_TOTAL][3 * i + 2] = d->values[SPLAT_TOTAL][3 * i];
    }
    assay_verdict      *verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    const assay_finding f       = splat_first(verdict);
    assert_string_equal(f.stage, "combine");
    assert_non_null(strstr(f.meaning, "exchanged"));
    assert_true(strcmp(f.channel, "R") == 0 || strcmp(f.channel, "B") == 0);
    assay_verdict_destroy(verdict);
    free(bad);
    free(d);
}

/* Records that no stage reads: alone they are nothing to judge, beside an image that is right they
 * must be the reference's. */
static void test_records_alone(void **state)
{
    splat_data *d = splat_make_data(*state);
    for (int other = 0; other < 2; other++) {
        stage_case c = stage_case_begin(*state), r = stage_case_begin(*state);
        for (int a = 0; a < SPLAT_ARRAY_COUNT; a++) {
            if (a == SPLAT_RECORD_IRRADIANCE || a >= SPLAT_DIRECT) {
                stage_case_table(&r, splat_arrays[a].name, splat_arrays[a].unit,
                                 splat_arrays[a].rows, splat_arrays[a].columns, d->values[a]);
                d->values[SPLAT_RECORD_IRRADIANCE][100] *=
                    other && a == SPLAT_RECORD_IRRADIANCE ? 1.5 : 1.0;
                stage_case_table(&c, splat_arrays[a].name, splat_arrays[a].unit,
                                 splat_arrays[a].rows, splat_arrays[a].columns, d->values[a]);
            }
        }
        assay_verdict *verdict = splat_verify_cases(&c, &r);
        assert_int_equal(assay_verdict_whole(verdict),
                         other ? ASSAY_VERDICT_CANNOT_TELL : ASSAY_VERDICT_PASS);
        assert_int_equal(splat_count_of(verdict, "inputs"), 5);
        assay_verdict_destroy(verdict);
    }
    free(d);
}

/* Nothing that a stage could judge is no pass. */
static void test_nothing(void **state)
{
    splat_data *d = splat_make_data(*state);
    stage_case  c = stage_case_begin(*state), r = stage_case_begin(*state);
    stage_case_table(&c, splat_arrays[0].name, splat_arrays[0].unit, splat_arrays[0].rows,
                     splat_arrays[0].columns, d->values[0]);
    stage_case_table(&r, splat_arrays[0].name, splat_arrays[0].unit, splat_arrays[0].rows,
                     splat_arrays[0].columns, d->values[0]);
    assay_verdict *verdict = splat_verify_cases(&c, &r);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assay_verdict_destroy(verdict);
    free(d);
}

/* What the candidate lacks is told; without the sums of the last batch nothing is said of what
 * follows from them, and nothing wrong of the batch before. */
static void test_missing(void **state)
{
    const double ends[2] = {SPLAT_RECORDS, SPLAT_RECORDS};
    splat_data  *d       = splat_make_data(*state);
    stage_case   c = stage_case_begin(*state), r = stage_case_begin(*state);
    for (int k = 0; k < 2; k++) {
        splat_add_arrays(k ? &r : &c, d, k ? -1 : SPLAT_TOTAL);
        stage_case_table(k ? &r : &c, "splat/batch_end", "records", 2, 1, ends);
    }
    stage_case_table(&r, "splat/batch.1/weight", "", SPLAT_PIXELS, 1, d->values[SPLAT_WEIGHT]);
    stage_case_table(&r, "splat/batch.1/radiance", "W/(m2 sr)", SPLAT_PIXELS, 3,
                     d->values[SPLAT_SUM]);
    assay_verdict *verdict = splat_verify_cases(&c, &r);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(splat_count_of(verdict, "splat"), 2);
    assert_int_equal(splat_count_of(verdict, "splat-light"), 0);
    assert_int_equal(splat_count_of(verdict, "normalise"), 0);
    assert_string_equal(assay_verdict_get(verdict, "missing"), "radiance/total");
    assert_string_equal(assay_verdict_get(verdict, "not judged"),
                        "splat/result, radiance/direct, radiance/indirect");
    assay_verdict_destroy(verdict);
    free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_right, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_small_halves, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_planted, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_channels, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_records_alone, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_nothing, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_missing, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
