/* test_verify_given.c - bundles whose stages are right, or look wrong, because of what they began
 * with. */
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

/* Another albedo, and all that follows from it: every stage is right, on inputs that are not. */
static void test_inputs(void **state)
{
    splat_data *d = splat_make_data(*state), *other = splat_copy(d);
    other->values[SPLAT_ALBEDO][31] *= 1.0 + 0x1p-22;
    splat_round(other);
    splat_make_stages(*state, other);
    assay_verdict      *verdict = splat_verify(*state, other, d, ASSAY_PRECISION_FLOAT);
    const assay_finding f       = splat_first(verdict);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assert_string_equal(f.stage, "inputs");
    assert_string_equal(f.array, "splat/albedo");
    assert_true(f.place.row == 10 && f.place.column == 1 && f.in_bounds > 1.0);
    assay_verdict_destroy(verdict);
    /* Rounded to halves it is what a half has of it. */
    verdict = splat_verify(*state, other, d, ASSAY_PRECISION_HALF);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    verdict = splat_verify(*state, other, NULL, ASSAY_PRECISION_FLOAT);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(splat_count_of(verdict, "inputs"), 0);
    assert_non_null(strstr(assay_verdict_get(verdict, "not judged"), "splat/albedo"));
    assert_null(strstr(assay_verdict_get(verdict, "not judged"), "splat/result"));
    assay_verdict_destroy(verdict);
    /* What is rounded once is the reference's. */
    memcpy(other, d, sizeof *other);
    other->values[SPLAT_DIRECT][3] *= 1.0 + 0.9 * 0x1p-24;
    verdict = splat_verify(*state, d, other, ASSAY_PRECISION_FLOAT);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    free(other);
    free(d);
}

/* Who asks nothing of any pixel makes no mistake in any stage, and no image. */
static void test_nothing_asked(void **state)
{
    static const int made[] = {SPLAT_WEIGHT, SPLAT_SUM, SPLAT_RESULT};
    for (int all = 0; all < 2; all++) {
        splat_data *d = splat_make_data(*state), *mine = splat_copy(d);
        for (size_t i = all ? 0 : 100; i < (all ? SPLAT_PIXELS : 101); i++) {
            for (size_t a = 0; a < 3; a++) {
                const size_t columns = splat_arrays[made[a]].columns;
                memset(&mine->values[made[a]][columns * i], 0, columns * sizeof(double));
            }
            for (size_t c = 0; c < 3; c++) {
                mine->values[SPLAT_POSITION][3 * i + c] = NAN;
            }
        }
        assay_verdict      *verdict = splat_verify(*state, mine, d, ASSAY_PRECISION_FLOAT);
        const assay_finding f       = splat_first(verdict);
        assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
        assert_string_equal(f.array, "splat/position");
        assert_int_equal(f.place.row, all ? 0 : 100);
        assay_verdict_destroy(verdict);
        free(mine);
        free(d);
    }
}

/* ---- who is to blame ---- */

static assay_finding finding_of(const assay_verdict *verdict, const char *array)
{
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        if (strcmp(assay_verdict_at(verdict, i).array, array) == 0) {
            return assay_verdict_at(verdict, i);
        }
    }
    fail_msg("no finding of %s", array);
    return assay_finding_default();
}

/* What a verdict says of a stage that fails: all of these words, and never that the error is made
 * in it for sure, unless `sure`. */
static void blames(const assay_verdict *verdict, const char *array, const char *const words[2],
                   bool sure)
{
    const assay_finding f = finding_of(verdict, array);
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    for (int i = 0; i < 2; i++) {
        if (words[i] && !strstr(f.meaning, words[i])) {
            fail_msg("%s: '%s' is not in: %s", array, words[i], f.meaning);
        }
    }
    if (!sure != !strstr(f.meaning, "Its inputs pass: the error is made in this stage.")) {
        fail_msg("%s: %s", array, f.meaning);
    }
}

/* Normals of records that were dumped upside down by a renderer that used the right ones: all that
 * it made is right, and the stage that reads them fails. */
static void test_wrong_dump(void **state)
{
    splat_data *d = splat_make_data(*state), *bad = splat_copy(d);
    for (size_t i = 0; i < 3 * SPLAT_RECORDS; i++) {
        bad->values[SPLAT_RECORD_NORMAL][i] *= -1.0;
    }
    bad->values[SPLAT_WEIGHT][10] *= 1.0 + 0x1p-23; /* the reference's, rounded in another way */
    assay_verdict *verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    blames(verdict, "splat/batch.0/weight",
           (const char *const[2]){"judged with records/normal (not the reference's at row ",
                                  "made what the reference has"},
           false);
    assay_verdict_destroy(verdict);
    /* The same, with an error besides: nobody knows. */
    bad->values[SPLAT_WEIGHT][40] *= 1.01;
    verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    blames(verdict, "splat/batch.0/weight",
           (const char *const[2]){"judged with records/normal (not the reference's at row ",
                                  "in this stage only if it was given these"},
           false);
    assay_verdict_destroy(verdict);
    free(bad);
    free(d);
}

/* A wrong stage of right inputs, and the one after it, whose inputs are what the first made. */
static void test_two_stages(void **state)
{
    splat_data *d = splat_make_data(*state), *bad = splat_copy(d);
    bad->values[SPLAT_SUM][3 * 40] *= 1.01;
    bad->values[SPLAT_RESULT][3 * 50] *= 1.01;
    assay_verdict *verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    blames(verdict, "splat/batch.0/radiance", (const char *const[2]){"1 number is beyond"}, true);
    blames(verdict, "splat/result",
           (const char *const[2]){"judged with splat/batch.0/radiance (fails itself)",
                                  "only if it was given these"},
           false);
    assay_verdict_destroy(verdict);
    /* A weight where a record stands may be anything: what follows from it fails. */
    memcpy(bad, d, sizeof *bad);
    bad->values[SPLAT_WEIGHT][SPLAT_STANDS] *= 1.01;
    verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    assert_int_equal(finding_of(verdict, "splat/batch.0/weight").kind, ASSAY_VERDICT_PASS);
    assert_string_equal(splat_first(verdict).stage, "splat-light");
    assert_non_null(strstr(splat_first(verdict).meaning,
                           "or in splat/batch.0/weight where bounds are as large"));
    assay_verdict_destroy(verdict);
    /* Radiance there passes in one stage and fails in the next: it is not right. */
    memcpy(bad, d, sizeof *bad);
    bad->values[SPLAT_SUM][3 * SPLAT_STANDS] *= 1.05;
    verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    assert_int_equal(finding_of(verdict, "splat/batch.0/radiance").kind, ASSAY_VERDICT_PASS);
    blames(verdict, "splat/result",
           (const char *const[2]){"judged with splat/batch.0/radiance (fails itself)"}, false);
    assay_verdict_destroy(verdict);
    /* Alone, nothing says what a stage was given. */
    memcpy(bad, d, sizeof *bad);
    bad->values[SPLAT_SUM][3 * 40] *= 1.01;
    verdict = splat_verify(*state, bad, NULL, ASSAY_PRECISION_FLOAT);
    blames(verdict, "splat/batch.0/radiance",
           (const char *const[2]){"if it was given the bundle's inputs"}, false);
    assay_verdict_destroy(verdict);
    free(bad);
    free(d);
}

/* More arrays than a sentence names; the paragraph says it, too, and calls the replay no
 * reference. */
static void test_many_wrong(void **state)
{
    splat_data *d = splat_make_data(*state), *bad = splat_copy(d);
    char       *text = NULL;
    for (int a = SPLAT_RECORD_POSITION; a <= SPLAT_RECORD_TRANSLATION; a++) {
        bad->values[a][0] *= a == SPLAT_RECORD_NORMAL ? 1.0 : 1.5; /* which must be units */
    }
    bad->values[SPLAT_WEIGHT][40] *= 2.0;
    assay_verdict *verdict = splat_verify(*state, bad, d, ASSAY_PRECISION_FLOAT);
    blames(verdict, "splat/batch.0/weight", (const char *const[2]){" and 2 more: "}, false);
    assert_int_equal(assay_verdict_paragraph(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, "First stage that fails: splat."));
    assert_non_null(strstr(text, ", replayed "));
    assert_null(strstr(text, ", reference "));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
    free(bad);
    free(d);
}

typedef struct {
    const char *candidate, *reference;
} paths;

static assay_status verify_once(assay_context *context, void *user)
{
    const paths   *p       = user;
    assay_verdict *verdict = NULL;
    assay_status   status  = assay_verdict_create(context, "candidate", "reference", &verdict);
    status                 = status ? status
                                    : assay_verify_bundle(context, p->candidate, p->reference, NULL,
                                                          ASSAY_PRECISION_FLOAT, verdict);
    status                 = status ? status : assay_verify_insist(verdict, 1e-9, 0.5);
    status                 = status ? status : assay_verify_require(verdict, "visible");
    assay_verdict_destroy(verdict);
    return status;
}

/* Every block that is refused while a failure is explained and a demand is made. */
static void test_refused_memory(void **state)
{
    splat_data *d = splat_make_data(*state);
    stage_case  c = stage_case_begin(*state), r = stage_case_begin(*state);
    const paths p = {c.path, r.path};
    splat_add_arrays(&r, d, -1);
    d->values[SPLAT_RECORD_RADIUS][3] *= 1.5;
    splat_add_arrays(&c, d, -1);
    stage_case_finish(&c);
    stage_case_finish(&r);
    assert_true(failing_each(verify_once, (void *)&p) > 200);
    stage_case_end(&c);
    stage_case_end(&r);
    free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_inputs, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_nothing_asked, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_wrong_dump, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_two_stages, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_many_wrong, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_refused_memory, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
