/* test_verify_worth.c - what a pass could have seen is told as it is, and asked for as it was
 * meant.
 *
 * Widths are compared with closed forms: of a sum of two numbers in float, stored as float64 or
 * float16, and of numbers that are placed so that order statistics are known. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "oracle/bundle/bundle_compare.h"
#include "support/random_places.h"
#include "support/splat_bundle.h"

/* ---- widths ---- */

enum { COUNT = 1000 };

static stage_output output_of(double *values, double *bounds)
{
    return (stage_output){
        .unit = "", .rows = COUNT, .columns = 1, .values = values, .bounds = bounds};
}

/* Ratios are 1, 2, ..., in an order of their own; zeros, infinities and numbers without a bound
 * are none of them. */
static void test_order_statistics(void **state)
{
    double             values[COUNT], bounds[COUNT];
    const stage_output out   = output_of(values, bounds);
    size_t             sized = 0;
    for (size_t i = 0; i < COUNT; i++) {
        values[i] = i % 10 == 3 ? 0.0 : i % 10 == 7 ? INFINITY : i % 2 ? -4.0 : 4.0;
        bounds[i] = i % 10 == 5 ? NAN : 0.0;
        if (isfinite(values[i]) && values[i] != 0.0 && !isnan(bounds[i])) {
            bounds[i] = 4.0 * (double)(1 + (sized++ * 477) % 700);
        }
    }
    assert_int_equal(sized, 700);
    bundle_comparison c = {.out = &out, .values = values};
    assert_int_equal(bundle_compare(*state, &c), ASSAY_OK);
    assert_true(c.width == 351.0 && c.width_90 == 630.0);
    assert_int_equal(c.unknown, 100);
    assert_int_equal(c.vacuous, 700);
    assert_int_equal(bundle_compare_kind(&c), ASSAY_VERDICT_CANNOT_TELL);
}

static void test_no_width(void **state)
{
    double             values[COUNT] = {0}, bounds[COUNT] = {0}, theirs[COUNT];
    const stage_output out = output_of(values, bounds);
    bundle_comparison  c   = {.out = &out, .values = values};
    assert_int_equal(bundle_compare(*state, &c), ASSAY_OK);
    assert_true(isnan(c.width) && isnan(c.width_90));
    assert_int_equal(bundle_compare_kind(&c), ASSAY_VERDICT_PASS);
    /* Within infinite bounds is everything; where that is most of all numbers, it is no pass. */
    for (size_t sure = COUNT / 2 - 1; sure <= COUNT / 2; sure++) {
        for (size_t i = 0; i < COUNT; i++) {
            values[i] = 1.0;
            bounds[i] = i < sure ? 0.0 : INFINITY;
            theirs[i] = i < sure ? 1.0 : 7.0;
        }
        c = (bundle_comparison){.out = &out, .values = theirs};
        assert_int_equal(bundle_compare(*state, &c), ASSAY_OK);
        assert_true(isinf(c.width_90));
        assert_int_equal(bundle_compare_kind(&c),
                         sure < COUNT / 2 ? ASSAY_VERDICT_CANNOT_TELL : ASSAY_VERDICT_PASS);
    }
    /* More than a half without a bound is no pass, a half is. */
    for (size_t i = 0; i < COUNT; i++) {
        bounds[i] = i < COUNT / 2 ? NAN : 0.0;
    }
    c = (bundle_comparison){.out = &out, .values = values};
    assert_int_equal(bundle_compare(*state, &c), ASSAY_OK);
    assert_int_equal(bundle_compare_kind(&c), ASSAY_VERDICT_PASS);
    bounds[COUNT / 2] = NAN;
    c                 = (bundle_comparison){.out = &out, .values = values};
    assert_int_equal(bundle_compare(*state, &c), ASSAY_OK);
    assert_int_equal(bundle_compare_kind(&c), ASSAY_VERDICT_CANNOT_TELL);
}

/* ---- verdicts ---- */

static assay_finding finding_of(const assay_verdict *verdict, const char *stage)
{
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        if (strcmp(assay_verdict_at(verdict, i).stage, stage) == 0) {
            return assay_verdict_at(verdict, i);
        }
    }
    fail_msg("no finding of %s", stage);
    return assay_finding_default();
}

/* Sums of two positive numbers: each off by u, and the sum by u once more: 2 u and a little. */
static void test_precisions(void **state)
{
    static const double u[] = {0x1p-11, 0x1p-24};
    splat_data         *d   = splat_make_data(*state);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_FLOAT; p++) {
        assay_verdict      *verdict = splat_verify(*state, d, d, (assay_precision)p);
        const assay_finding f       = finding_of(verdict, "combine-irradiance");
        assert_int_equal(f.kind, ASSAY_VERDICT_PASS);
        assert_true(f.width > 2.0 * u[p] && f.width < 2.01 * u[p] + 1e-7);
        assert_true(f.width_90 >= f.width && f.width_90 < 2.01 * u[p] + 1e-7);
        assert_true(isnan(finding_of(verdict, "inputs").width));
        assay_verdict_destroy(verdict);
    }
    free(d);
}

/* A pass in half precision says that its bounds are wide, and where. */
static void test_told(void **state)
{
    splat_data    *d       = splat_make_data(*state);
    char          *text    = NULL;
    assay_verdict *verdict = splat_verify(*state, d, d, ASSAY_PRECISION_HALF);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verdict_paragraph(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, "Of the arrays that were judged all 4096 numbers have a bound."));
    assert_non_null(strstr(text, "Bounds are widest in splat/batch.0/"));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
    free(d);
}

/* ---- demands ---- */

static assay_verdict *three_findings(assay_context *context)
{
    assay_verdict *verdict = NULL;
    assay_finding  f       = assay_finding_default();
    assert_int_equal(assay_verdict_create(context, "c", "r", &verdict), ASSAY_OK);
    f.stage    = "splat";
    f.array    = "narrow";
    f.test     = "rounding";
    f.values   = 90;
    f.unjudged = 10;
    f.width    = 0.01;
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_OK);
    f.array    = "wide";
    f.values   = 100;
    f.unjudged = 0;
    f.width    = 0.02;
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_OK);
    f.stage = "inputs";
    f.array = "given";
    f.test  = "given";
    f.width = NAN;
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_OK);
    return verdict;
}

static void test_insist(void **state)
{
    static const struct {
        double      detect, judged;
        const char *doubted; /* the first; NULL: it passes */
        const char *word;
    } cases[] = {
        {NAN, NAN, NULL, NULL},
        {0.02, 0.9, NULL, NULL},
        {0.0199, NAN, "wide", "by 0.02 of itself"},
        {0.009, NAN, "narrow", "by 0.01 of itself"},
        {NAN, 0.91, "narrow", "0.91 of all"},
        {0.015, 0.8, "wide", "by 0.02 of itself"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assay_verdict *verdict = three_findings(*state);
        assert_int_equal(assay_verify_insist(verdict, cases[i].detect, cases[i].judged), ASSAY_OK);
        assert_int_equal(assay_verdict_whole(verdict),
                         cases[i].doubted ? ASSAY_VERDICT_CANNOT_TELL : ASSAY_VERDICT_PASS);
        if (cases[i].doubted) {
            int at = 0;
            while (assay_verdict_at(verdict, at).kind == ASSAY_VERDICT_PASS) {
                at++;
            }
            assert_string_equal(assay_verdict_at(verdict, at).array, cases[i].doubted);
            assert_non_null(strstr(assay_verdict_at(verdict, at).meaning, cases[i].word));
        }
        assert_int_equal(!assay_verdict_get(verdict, "judged"), isnan(cases[i].judged));
        assay_verdict_destroy(verdict);
    }
}

/* What fails goes on to fail, of what is all 0 nothing is asked, and nonsense is refused. */
static void test_insist_edges(void **state)
{
    assay_verdict *verdict = three_findings(*state);
    assay_finding  f       = assay_finding_default();
    f.stage = f.array = "combine";
    f.test            = "rounding";
    f.values          = 10;
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_OK);
    f.kind  = ASSAY_VERDICT_FAIL;
    f.width = 9.0;
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_OK);
    assert_int_equal(assay_verify_insist(verdict, 0.5, 0.5), ASSAY_OK);
    assert_int_equal(assay_verdict_at(verdict, 3).kind, ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verdict_at(verdict, 4).kind, ASSAY_VERDICT_FAIL);
    assert_int_equal(assay_verify_insist(verdict, 0.0, NAN), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_verify_insist(verdict, NAN, 1.5), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_verify_insist(verdict, NAN, -0.5), ASSAY_ERR_ARGUMENT);
    assay_verdict_destroy(verdict);
}

/* A stage that ran and knew nothing of what it made: nobody asked, and it is said; who asks for
 * any part of it gets no pass. */
static void test_blind_stage(void **state)
{
    splat_data    *d       = splat_make_data(*state);
    assay_verdict *verdict = splat_verify(*state, d, d, ASSAY_PRECISION_FLOAT);
    assert_null(assay_verdict_get(verdict, "blind"));
    assert_int_equal(assay_verdict_set(verdict, "blind", "visible, gather"), ASSAY_OK);
    assert_int_equal(assay_verify_insist(verdict, 1.0, NAN), ASSAY_OK);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verify_insist(verdict, NAN, 0.5), ASSAY_OK);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assert_string_equal(splat_first(verdict).stage, "visible");
    assert_int_equal(splat_count_of(verdict, "gather"), 1);
    assay_verdict_destroy(verdict);
    free(d);
}

/* [gautron06]'s own variant of splatting has no bounds. */
static void test_no_bounds(void **state)
{
    splat_data *d = splat_make_data(*state);
    stage_case  c = stage_case_begin(*state), r = stage_case_begin(*state);
    for (int k = 0; k < 2; k++) {
        splat_add_arrays(k ? &r : &c, d, -1);
        stage_case_text(k ? &r : &c, "assay:splat.variant", "published");
    }
    assay_verdict *verdict = splat_verify_cases(&c, &r);
    assert_string_equal(assay_verdict_get(verdict, "blind"), "splat-light");
    assay_verdict_destroy(verdict);
    free(d);
}

/* Which stages have no bound where records shrink, and the last of `ends` is that. */
static void check_shrinking(assay_context *context, const splat_data *d, double end,
                            const char *expected)
{
    stage_case c = stage_case_begin(context), r = stage_case_begin(context);
    for (int k = 0; k < 2; k++) {
        splat_add_arrays(k ? &r : &c, d, -1);
        stage_case_text(k ? &r : &c, "assay:splat.neighbour_clamp", "on");
        stage_case_table(k ? &r : &c, "splat/batch_end", "records", 1, 1, &end);
    }
    assay_verdict *verdict = splat_verify_cases(&c, &r);
    const char    *blind   = assay_verdict_get(verdict, "blind");
    assert_string_equal(blind ? blind : "", expected);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
}

/* A later sweep made records, which shrunk those that had been splatted. */
static void test_later_sweeps(void **state)
{
    splat_data *d = splat_make_data(*state);
    check_shrinking(*state, d, SPLAT_RECORDS, "");
    check_shrinking(*state, d, SPLAT_RECORDS - 1, "splat, splat-light");
    free(d);
}

/* ---- what was required ---- */

static void test_require(void **state)
{
    splat_data    *d       = splat_make_data(*state);
    assay_verdict *verdict = splat_verify(*state, d, d, ASSAY_PRECISION_FLOAT);
    const int      count   = assay_verdict_count(verdict);
    assert_int_equal(assay_verify_require(verdict, "splat,combine"), ASSAY_OK);
    assert_int_equal(assay_verdict_count(verdict), count);
    assert_int_equal(assay_verify_require(verdict, "splat,visible,combine,weights"), ASSAY_OK);
    assert_int_equal(assay_verdict_count(verdict), count + 2);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assert_string_equal(splat_first(verdict).stage, "visible");
    assert_int_equal(splat_count_of(verdict, "weights"), 1);
    assert_int_equal(assay_verify_require(verdict, "splat,spat"), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "spat"));
    assert_int_equal(assay_verify_require(verdict, "splat,"), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_verify_require(verdict, ""), ASSAY_ERR_ARGUMENT);
    assay_verdict_destroy(verdict);
    free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_order_statistics, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_no_width, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_precisions, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_told, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_insist, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_insist_edges, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_blind_stage, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_no_bounds, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_later_sweeps, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_require, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
