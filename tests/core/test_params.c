/* test_params.c - every kind of value, its bounds, its canonical text, and the words of refusals.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "assay/params.h"

static const assay_param_desc TABLE[] = {
    {"count", ASSAY_PARAM_INT, "", "3", 1, 10, NULL, "", ""},
    {"depth", ASSAY_PARAM_INT, "", "inf", 0, ASSAY_PARAM_INF, NULL, "", ""},
    {"error", ASSAY_PARAM_REAL, "", "0.1", 0, 1, NULL, "", ""},
    {"flag", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL, "", ""},
    {"kind", ASSAY_PARAM_CHOICE, "", "b", 0, 0, "a|b|long-one", "", ""},
    {"file", ASSAY_PARAM_PATH, "", "", 0, 0, NULL, "", ""},
    {0},
};

static int setup(void **state)
{
    static assay_context *context; /* one a run, freed by teardown */
    static assay_params  *params;
    static void          *both[2];
    if (assay_context_create(NULL, &context) != ASSAY_OK ||
        assay_params_create(context, TABLE, &params) != ASSAY_OK) {
        return 1;
    }
    both[0] = context;
    both[1] = params;
    *state  = both;
    return 0;
}

static int teardown(void **state)
{
    void **both = *state;
    assay_params_destroy(both[1]);
    assay_context_destroy(both[0]);
    return 0;
}

static void defaults(void **state)
{
    const assay_params *params = ((void **)*state)[1];
    assert_int_equal(assay_params_int(params, "count"), 3);
    assert_true(assay_params_int(params, "depth") == 2147483647);
    assert_true(assay_params_real(params, "error") == 0.1);
    assert_false(assay_params_bool(params, "flag"));
    assert_int_equal(assay_params_choice(params, "kind"), 1);
    assert_string_equal(assay_params_text(params, "error"), "0.1");
    assert_string_equal(assay_params_text(params, "depth"), "inf");
    assert_string_equal(assay_params_text(params, "file"), "");
    assert_null(assay_params_text(params, "nothing"));
}

/* Kept whole, however long; replaced; and taken away. */
static void paths(void **state)
{
    assay_params *params = ((void **)*state)[1];
    char          text[5001];
    memset(text, 'x', sizeof text);
    text[5000] = 0;
    assert_int_equal(assay_params_set(params, "file", text), ASSAY_OK);
    assert_string_equal(assay_params_text(params, "file"), text);
    assert_int_equal(assay_params_set(params, "file", "a b"), ASSAY_OK);
    assert_string_equal(assay_params_text(params, "file"), "a b");
    assert_int_equal(assay_params_set(params, "file", ""), ASSAY_OK);
    assert_string_equal(assay_params_text(params, "file"), "");
}

static void good_values(void **state)
{
    assay_params            *params    = ((void **)*state)[1];
    static const char *const GOOD[][3] = {
        {"count", "10", "10"},
        {"count", "1", "1"},
        {"count", "2e0", "2"},
        {"depth", "0", "0"},
        {"depth", "2147483646", "2147483646"},
        {"depth", "inf", "inf"},
        {"error", "1", "1"},
        {"error", "-0", "0"},
        {"error", "1e-3", "0.001"},
        {"error", "0.30000000000000004", "0.30000000000000004"},
        {"flag", "on", "on"},
        {"flag", "off", "off"},
        {"kind", "a", "a"},
        {"kind", "long-one", "long-one"},
    };
    for (size_t i = 0; i < sizeof GOOD / sizeof GOOD[0]; i++) {
        assert_int_equal(assay_params_set(params, GOOD[i][0], GOOD[i][1]), ASSAY_OK);
        assert_string_equal(assay_params_text(params, GOOD[i][0]), GOOD[i][2]);
    }
    assert_int_equal(assay_params_choice(params, "kind"), 2);
}

/* A refusal names the parameter and leaves its value alone. */
static void bad_values(void **state)
{
    assay_context           *context  = ((void **)*state)[0];
    assay_params            *params   = ((void **)*state)[1];
    static const char *const BAD[][2] = {
        {"count", "0"},    {"count", "11"},    {"count", "1.5"}, {"count", ""},
        {"count", "x"},    {"count", "inf"},   {"count", "nan"}, {"count", " 2"},
        {"count", "2 "},   {"count", "0x2"},   {"depth", "-1"},  {"depth", "2147483647"},
        {"depth", "1e99"}, {"error", "-0.1"},  {"error", "1.1"}, {"error", "inf"},
        {"error", "nan"},  {"error", "1e999"}, {"error", "."},   {"flag", "yes"},
        {"flag", "ON"},    {"flag", ""},       {"kind", "c"},    {"kind", "a|b"},
        {"kind", ""},      {"kind", "long"},
    };
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        char before[64];
        strcpy(before, assay_params_text(params, BAD[i][0]));
        assert_int_equal(assay_params_set(params, BAD[i][0], BAD[i][1]), ASSAY_ERR_ARGUMENT);
        assert_non_null(strstr(assay_context_error(context), BAD[i][0]));
        assert_string_equal(assay_params_text(params, BAD[i][0]), before);
    }
    assert_int_equal(assay_params_set(params, "colour", "1"), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(context), "colour"));
    assert_non_null(strstr(assay_context_error(context), "count, depth, error, flag, kind"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(defaults, setup, teardown),
        cmocka_unit_test_setup_teardown(paths, setup, teardown),
        cmocka_unit_test_setup_teardown(good_values, setup, teardown),
        cmocka_unit_test_setup_teardown(bad_values, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
