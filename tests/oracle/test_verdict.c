/* test_verdict.c - what findings amount to, and that no output lies or breaks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/verdict.h"
#include "support/failing_context.h"
#include "support/reference_table.h"
#include "support/schema.h"

static assay_finding finding(const char *stage, const char *array, assay_verdict_kind kind)
{
    assay_finding f = assay_finding_default();
    f.stage         = stage;
    f.array         = array;
    f.test          = "welch";
    f.kind          = kind;
    return f;
}

static assay_verdict *create(assay_context *context)
{
    assay_verdict *verdict = NULL;
    assert_int_equal(assay_verdict_create(context, "c.exr", "r.exr", &verdict), ASSAY_OK);
    return verdict;
}

static void add(assay_verdict *verdict, const assay_finding *f)
{
    assert_int_equal(assay_verdict_add(verdict, f), ASSAY_OK);
}

/* Three findings, each of three kinds: the whole by its definition, in all 27 ways. */
static void whole_of_all_kinds(void **state)
{
    for (int code = 0; code < 27; code++) {
        assay_verdict *verdict  = create(*state);
        const int      kinds[3] = {code % 3, code / 3 % 3, code / 9};
        bool           failed = false, unsure = false;
        for (int i = 0; i < 3; i++) {
            const assay_finding f = finding("image", "R", (assay_verdict_kind)kinds[i]);
            add(verdict, &f);
            failed = failed || kinds[i] == 1;
            unsure = unsure || kinds[i] == 2;
        }
        const int expected = failed ? 1 : unsure ? 2 : 0;
        assert_int_equal(assay_verdict_whole(verdict), expected);
        int first = -1;
        for (int i = 2; i >= 0; i--) {
            first = expected && kinds[i] == expected ? i : first;
        }
        assert_int_equal(assay_verdict_first(verdict), first);
        assay_verdict_destroy(verdict);
    }
}

static void nothing_tested_does_not_pass(void **state)
{
    assay_verdict *verdict = create(*state);
    char          *text    = NULL;
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assert_int_equal(assay_verdict_first(verdict), -1);
    assert_int_equal(assay_verdict_junit(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, "errors=\"1\""));
    assay_text_destroy(*state, text);
    assert_int_equal(assay_verdict_annotations(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, "::warning"));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

/* The first stage is the one to look at, and in it what is farthest off. */
static void first_stage_then_farthest(void **state)
{
    assay_verdict *verdict = create(*state);
    assay_finding  f       = finding("gbuffer", "P", ASSAY_VERDICT_PASS);
    add(verdict, &f);
    f           = finding("records", "a", ASSAY_VERDICT_FAIL);
    f.in_bounds = 2.0;
    add(verdict, &f);
    f = finding("records", "unknown", ASSAY_VERDICT_FAIL);
    add(verdict, &f);
    f           = finding("image", "R", ASSAY_VERDICT_FAIL);
    f.in_bounds = 1e9;
    add(verdict, &f);
    f           = finding("records", "b", ASSAY_VERDICT_FAIL);
    f.in_bounds = 5.0;
    add(verdict, &f);
    f           = finding("records", "c", ASSAY_VERDICT_PASS);
    f.in_bounds = 7.0;
    add(verdict, &f);
    const assay_finding first = assay_verdict_at(verdict, assay_verdict_first(verdict));
    assert_string_equal(first.array, "b");
    char *text = NULL;
    assert_int_equal(assay_verdict_paragraph(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, "FAIL: c.exr differs from r.exr in 4 of 6 tests."));
    assert_non_null(strstr(text, "First stage that fails: records. b, test welch"));
    assert_null(strchr(text, '\n'));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

static void refused(void **state)
{
    assay_verdict *verdict = create(*state);
    assay_finding  f       = finding("", "R", ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_ERR_ARGUMENT);
    f = finding("image", NULL, ASSAY_VERDICT_PASS);
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_ERR_ARGUMENT);
    f      = finding("image", "R", ASSAY_VERDICT_PASS);
    f.test = "";
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_ERR_ARGUMENT);
    f = finding("image", "R", (assay_verdict_kind)3);
    assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_verdict_set(verdict, "", "x"), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_verdict_count(verdict), 0);
    assay_verdict_destroy(verdict);
    assay_verdict_destroy(NULL);
}

static void settings(void **state)
{
    assay_verdict *verdict = create(*state);
    assert_null(assay_verdict_get(verdict, "level"));
    assert_int_equal(assay_verdict_set(verdict, "level", "0.01"), ASSAY_OK);
    assert_int_equal(assay_verdict_set(verdict, "level", "0.02"), ASSAY_OK);
    assert_string_equal(assay_verdict_get(verdict, "level"), "0.02");
    assay_verdict_destroy(verdict);
}

/* ---- outputs ---- */

/* Everything that a format may stumble over. */
static assay_verdict *nasty(assay_context *context)
{
    assay_verdict *verdict = NULL;
    assert_int_equal(
        assay_verdict_create(context, "a<b>&\"c\"',:%\n\x01\xff.exr", "r\xc3\xa9.exr", &verdict),
        ASSAY_OK);
    assay_finding f = finding("image", "R&<\"G>", ASSAY_VERDICT_FAIL);
    f.place         = assay_place_pixel(3, 4);
    f.candidate     = 0.1;
    f.reference     = INFINITY;
    f.effect        = -0.25;
    f.bound         = 1e-3;
    f.in_bounds     = INFINITY;
    f.ulps          = 7.0;
    f.p             = 0.0;
    f.log_p         = -1e5;
    f.visible       = 2e-3;
    f.values        = 6220800;
    f.meaning       = "a %d line\r\nand another, ]]> \xed\xa0\x80";
    add(verdict, &f);
    f          = finding("records", "records/irradiance", ASSAY_VERDICT_CANNOT_TELL);
    f.channel  = "X";
    f.place    = assay_place_row(1ull << 40, 2);
    f.values   = 70;
    f.unjudged = 30;
    f.vacuous  = 5;
    f.width    = 0.25;
    f.width_90 = INFINITY;
    add(verdict, &f);
    f       = finding("records", "tile", ASSAY_VERDICT_PASS);
    f.place = assay_place_tile(16, 32, 16, 8);
    add(verdict, &f);
    assert_int_equal(assay_verdict_set(verdict, "level", "0.01"), ASSAY_OK);
    assert_int_equal(assay_verdict_set(verdict, "power", "It could see."), ASSAY_OK);
    return verdict;
}

static void json_follows_its_schema(void **state)
{
    size_t         size;
    char          *schema_text = reference_file_bytes("docs/verdict.schema.json", &size);
    cJSON         *schema      = cJSON_Parse(schema_text);
    assay_verdict *verdict     = nasty(*state);
    char          *text        = NULL;
    char           why[256]    = "";
    assert_non_null(schema);
    assert_int_equal(assay_verdict_json(verdict, &text), ASSAY_OK);
    cJSON *json = cJSON_Parse(text);
    assert_non_null(json);
    if (!schema_accepts(schema, json, why, sizeof why)) {
        fail_msg("%s", why);
    }
    const cJSON *first = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "findings"), 0);
    assert_string_equal(cJSON_GetObjectItem(first, "candidate_hex")->valuestring,
                        "0x1.999999999999ap-4");
    assert_string_equal(cJSON_GetObjectItem(first, "reference_hex")->valuestring, "inf");
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(first, "reference")));
    assert_true(cJSON_GetObjectItem(first, "log_p")->valuedouble == -1e5);
    const cJSON *second = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "findings"), 1);
    assert_true(cJSON_GetObjectItem(second, "unjudged")->valuedouble == 30.0);
    assert_true(cJSON_GetObjectItem(second, "vacuous")->valuedouble == 5.0);
    assert_true(cJSON_GetObjectItem(second, "width")->valuedouble == 0.25);
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(second, "width_90")));
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(first, "width")));
    assert_int_equal(cJSON_GetObjectItem(json, "exit_code")->valueint, 1);
    /* The schema is no empty form: what is wrong in it is refused. */
    cJSON_ReplaceItemInObject(json, "verdict", cJSON_CreateString("perhaps"));
    assert_false(schema_accepts(schema, json, why, sizeof why));
    cJSON_ReplaceItemInObject(json, "verdict", cJSON_CreateString("fail"));
    assert_true(schema_accepts(schema, json, why, sizeof why));
    cJSON_AddNumberToObject(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "findings"), 1), "more",
                            1.0);
    assert_false(schema_accepts(schema, json, why, sizeof why));
    cJSON_DeleteItemFromObject(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "findings"), 1),
                               "more");
    cJSON_DeleteItemFromObject(cJSON_GetArrayItem(cJSON_GetObjectItem(json, "findings"), 0),
                               "stage");
    assert_false(schema_accepts(schema, json, why, sizeof why));
    cJSON_Delete(json);
    cJSON_Delete(schema);
    free(schema_text);
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

/* Elements are closed in order, attributes are quoted, and no bare character is left: a reader of
 * the little XML that is written.  Counts the elements of a name. */
static int read_xml(const char *s, const char *counted)
{
    char stack[16][32];
    int  depth = 0, found = 0;
    assert_int_equal(strncmp(s, "<?xml", 5), 0);
    s = strchr(s, '>') + 1;
    while (*s) {
        if (*s != '<') {
            assert_true((unsigned char)*s >= ' ' || *s == '\n');
            assert_true(*s != '&' || s[1] == '#');
            assert_true(*s != '>');
            s++;
            continue;
        }
        const bool   close  = s[1] == '/';
        const char  *name   = s + 1 + close;
        const size_t length = strcspn(name, " />\n");
        assert_true(length > 0 && length < 32 && depth < 15);
        found += !close && strlen(counted) == length && strncmp(name, counted, length) == 0;
        for (s = name + length; *s == ' ';) {
            s += strcspn(s, "=") + 1;
            assert_int_equal(*s, '"');
            for (s++; *s != '"'; s++) {
                assert_true(*s && *s != '<' && (unsigned char)*s >= ' ');
                assert_true(*s != '&' || s[1] == '#');
            }
            s++;
        }
        if (close) {
            assert_true(depth > 0 && strlen(stack[--depth]) == length &&
                        strncmp(stack[depth], name, length) == 0);
        } else if (*s != '/') {
            snprintf(stack[depth++], 32, "%.*s", (int)length, name);
        } else {
            s++;
        }
        assert_int_equal(*s++, '>');
    }
    assert_int_equal(depth, 0);
    return found;
}

static void junit_is_well_formed(void **state)
{
    assay_verdict *verdict = nasty(*state);
    char          *text    = NULL;
    assert_int_equal(assay_verdict_junit(verdict, &text), ASSAY_OK);
    assert_int_equal(read_xml(text, "testsuite"), 2);
    assert_int_equal(read_xml(text, "testcase"), 3);
    assert_int_equal(read_xml(text, "failure"), 1);
    assert_int_equal(read_xml(text, "error"), 1);
    assert_non_null(strstr(text, "tests=\"3\" failures=\"1\" errors=\"1\""));
    assert_non_null(strstr(text, "a&#60;b&#62;&#38;&#34;c&#34;&#39;,:%&#10;??.exr"));
    assert_null(strchr(text, '\x01'));
    assert_null(strstr(text, "skipped"));
    assert_non_null(strstr(text, "bounds of 0.25 of a typical value (one in ten: inf), of 5 values "
                                 "as large as they; 70 of 100 values were judged."));
    /* A surrogate in UTF-8 is no character of XML, byte by byte. */
    assert_non_null(strstr(text, "]]&#62; ???\""));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

/* What nothing was said of is counted among the tests, as skipped. */
static void junit_skips_the_unseen(void **state)
{
    assay_verdict *verdict = nasty(*state);
    char          *text    = NULL;
    assert_int_equal(assay_verdict_set(verdict, "not judged", "a<b, c"), ASSAY_OK);
    assert_int_equal(assay_verdict_set(verdict, "missing", "d"), ASSAY_OK);
    assert_int_equal(assay_verdict_set(verdict, "blind", "visible"), ASSAY_OK);
    assert_int_equal(assay_verdict_junit(verdict, &text), ASSAY_OK);
    assert_int_equal(read_xml(text, "testsuite"), 3);
    assert_int_equal(read_xml(text, "testcase"), 6);
    assert_int_equal(read_xml(text, "skipped"), 3);
    assert_non_null(strstr(text, "tests=\"6\" failures=\"1\" errors=\"1\" skipped=\"3\""));
    assert_non_null(strstr(text, "name=\"not judged\">\n      <skipped message=\"a&#60;b, c\"/>"));
    assert_non_null(strstr(text, "name=\"missing\">\n      <skipped message=\"d\"/>"));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

static void annotations_are_lines(void **state)
{
    assay_verdict *verdict = nasty(*state);
    char          *text    = NULL;
    assert_int_equal(assay_verdict_annotations(verdict, &text), ASSAY_OK);
    int lines = 0;
    for (const char *s = text; *s; s = strchr(s, '\n') + 1, lines++) {
        assert_int_equal(
            strncmp(s, lines == 0 ? "::error file=" : "::warning file=", lines == 0 ? 13 : 15), 0);
    }
    assert_int_equal(lines, 2);
    /* The name of the file, its comma, colon, percent sign and line break escaped. */
    assert_non_null(strstr(text, "file=a<b>&\"c\"'%2C%3A%25%0A"));
    assert_non_null(strstr(text, "a %25d line%0D%0Aand another, ]]>"));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

/* p far below the smallest double is told as a power of ten: exp(-1e5) = 10^-43429.4. */
static void words(void **state)
{
    assay_verdict *verdict = nasty(*state);
    char          *text    = NULL;
    assert_int_equal(assay_verdict_paragraph(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, "p = 10^-43429"));
    assert_non_null(strstr(text, "at pixel (3, 4)"));
    assert_non_null(strstr(text, "candidate 0.10000000000000001 (0x1.999999999999ap-4)"));
    assert_non_null(strstr(text, "6220800 values"));
    assert_non_null(strstr(text, "1 more cannot tell"));
    assert_non_null(strstr(text, "It could see."));
    assay_text_destroy(*state, text);
    assay_verdict_destroy(verdict);
}

static void words_of_a_bound(void **state)
{
    static const char *const said[]   = {"; 1e+300 times what passes (2)",
                                         "; nothing but the latter passes;"};
    static const double      bounds[] = {2.0, 0.0};
    for (int i = 0; i < 2; i++) {
        assay_verdict *verdict = NULL;
        char          *text    = NULL;
        assay_finding  f       = finding("splat", "splat/result", ASSAY_VERDICT_FAIL);
        f.bound                = bounds[i];
        f.in_bounds            = 1e300;
        f.values               = 7;
        assert_int_equal(assay_verdict_create(*state, "c", "r", &verdict), ASSAY_OK);
        assert_int_equal(assay_verdict_add(verdict, &f), ASSAY_OK);
        assert_int_equal(assay_verdict_paragraph(verdict, &text), ASSAY_OK);
        assert_non_null(strstr(text, said[i]));
        assay_text_destroy(*state, text);
        assay_verdict_destroy(verdict);
    }
}

/* ---- memory ---- */

typedef assay_status (*output)(const assay_verdict *verdict, char **text_out);

static const output OUTPUTS[] = {assay_verdict_paragraph, assay_verdict_json, assay_verdict_junit,
                                 assay_verdict_annotations};

static assay_status everything(assay_context *context, void *user)
{
    assay_verdict *verdict = NULL;
    char          *text    = NULL;
    assay_status   status  = assay_verdict_create(context, "c", "r", &verdict);
    for (int i = 0; status == ASSAY_OK && i < 20; i++) {
        assay_finding f = finding("image", "R", i ? ASSAY_VERDICT_FAIL : ASSAY_VERDICT_PASS);
        f.channel       = "X";
        f.meaning       = "so";
        status          = assay_verdict_add(verdict, &f);
    }
    if (status == ASSAY_OK) {
        status = assay_verdict_set(verdict, "a", "b");
    }
    for (int i = 0; status == ASSAY_OK && i < 4; i++) {
        status = OUTPUTS[i](verdict, &text);
        if (status == ASSAY_OK) {
            assay_text_destroy(context, text);
        }
    }
    assay_verdict_destroy(verdict);
    (void)user;
    return status;
}

static void every_refused_block(void **state)
{
    assert_true(failing_each(everything, NULL) > 100);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(whole_of_all_kinds, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(nothing_tested_does_not_pass, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(first_stage_then_farthest, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(refused, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(settings, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(json_follows_its_schema, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(junit_is_well_formed, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(junit_skips_the_unseen, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(annotations_are_lines, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(words, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(words_of_a_bound, counted_set_up, counted_tear_down),
        cmocka_unit_test(every_refused_block),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
