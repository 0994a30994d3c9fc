/* test_gltf_json.c - the JSON reader against RFC 8259, and the two decoders of URIs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "scene/gltf_limits.h"
#include "scene/gltf_loader.h"
#include "scene/scene_text.h"
#include "support/failing_context.h"
#include "support/gltf_maker.h"

/* Reads from a heap block of exactly the size, so that a sanitizer sees reading past it. */
static assay_status read_exactly(assay_context *context, const char *text, size_t count,
                                 assay_json_document *out)
{
    char *copy = malloc(count ? count : 1);
    memcpy(copy, text, count);
    const assay_status status = assay_json_read(context, "x.gltf", copy, count, out);
    free(copy);
    return status;
}

static bool accepts(const char *text, size_t count)
{
    assay_context      *context  = gltf_context();
    assay_json_document document = {0};
    const assay_status  status   = read_exactly(context, text, count, &document);
    assert_true(status == ASSAY_OK || strncmp(assay_context_error(context), "x.gltf: ", 8) == 0);
    assay_json_release(context, &document);
    assay_context_destroy(context);
    return status == ASSAY_OK;
}

static void test_well_formed(void **state)
{
    static const char *const texts[] = {
        "{}",
        " {\t}\r\n",
        "\xEF\xBB\xBF{}",
        "{\"a\":[]}",
        "{\"a\":[ ]}",
        "{\"a\":[[],{}, [1]]}",
        "{\"a\":null,\"b\":true,\"c\":false}",
        "{\"a\":0,\"b\":-0,\"c\":-1.5e+3,\"d\":1E2,\"e\":0.0,\"f\":10}",
        "{\"\":\"\"}",
        "{\"\\u00e9\\n\\\"\\\\\\/\":\"\\ud83d\\ude00\"}",
        "{\"\xC3\xA9\":\"\xF0\x9F\x98\x80 \xE2\x82\xAC\"}",
        "{\"a\":\"\x7F\"}",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        if (!accepts(texts[i], strlen(texts[i]))) {
            fail_msg("refused: %s", texts[i]);
        }
    }
}

static void test_malformed(void **state)
{
    static const char *const texts[] = {
        "",
        " ",
        "[]",
        "1",
        "\"a\"",
        "nul",
        "{",
        "{}}",
        "{} x",
        "{,}",
        "{\"a\"}",
        "{\"a\":}",
        "{\"a\":1,}",
        "{\"a\":1 \"b\":2}",
        "{a:1}",
        "{'a':1}",
        "{\"a\" 1}",
        "{\"a\":[1,]}",
        "{\"a\":[,1]}",
        "{\"a\":[1 2]}",
        "{\"a\":[1}",
        "{\"a\":1]",
        "{\"a\":tru}",
        "{\"a\":True}",
        "{\"a\":nan}",
        "{\"a\":01}",
        "{\"a\":-}",
        "{\"a\":+1}",
        "{\"a\":1.}",
        "{\"a\":.5}",
        "{\"a\":1e}",
        "{\"a\":1e+}",
        "{\"a\":0x10}",
        "{\"a\":1e999}",
        "{\"a\":-1e999}",
        "{\"a\":Infinity}",
        "{\"a\":\"b}",
        "{\"a\":\"\\x\"}",
        "{\"a\":\"\\u12\"}",
        "{\"a\":\"\\u12g4\"}",
        "{\"a\":\"\\ud800\"}",
        "{\"a\":\"\\ud800\\u0041\"}",
        "{\"a\":\"\\udc00\"}",
        "{\"a\":\"\\u0000\"}",
        "{\"a\":\"\n\"}",
        "{\"a\":\"\t\"}",
        "{\"a\":\"\x80\"}",
        "{\"a\":\"\xC0\xAF\"}",
        "{\"a\":\"\xC3\"}",
        "{\"a\":\"\xE0\x80\xAF\"}",
        "{\"a\":\"\xED\xA0\x80\"}",
        "{\"a\":\"\xF4\x90\x80\x80\"}",
        "{\"a\":\"\xF5\x80\x80\x80\"}",
        "{\"a\":\"\xFF\"}",
        "/* */{}",
        "{}//",
        "{\"a\":1//\n}",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        if (accepts(texts[i], strlen(texts[i]))) {
            fail_msg("accepted: %s", texts[i]);
        }
    }
    assert_false(accepts("{\"a\":\"\0\"}", 9));
    assert_false(accepts("{\0}", 3));
}

static void test_every_prefix_is_refused(void **state)
{
    const char *text = "{\"a\":[1,-2.5e3,null,true,{\"b\":\"\\u00e9\xC3\xA9\\\\\"}],\"c\":{}}";
    (void)state;
    assert_true(accepts(text, strlen(text)));
    for (size_t count = 0; count < strlen(text); count++) {
        assert_false(accepts(text, count));
    }
}

static void test_tree(void **state)
{
    const char *text =
        "{\"n\":[1,2.5,-1e-3],\"o\":{\"t\":\"\\u00e9\\u20AC\\ud83d\\ude00x\",\"b\":true},"
        "\"z\":null,\"i\":7}";
    assay_context      *context = gltf_context();
    assay_json_document d       = {0};
    (void)state;
    assert_int_equal(read_exactly(context, text, strlen(text), &d), ASSAY_OK);
    const assay_json *root = d.nodes, *o = assay_json_member(root, "o");
    double            n[3] = {0, 0, 0};
    assert_int_equal(root->count, 4);
    assert_true(assay_json_numbers(root, "n", 3, n));
    assert_true(n[0] == 1.0 && n[1] == 2.5 && n[2] == -1e-3);
    assert_string_equal(assay_json_text(o, "t", ""), "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80x");
    assert_true(assay_json_bool(o, "b", false));
    assert_int_equal(assay_json_member(root, "z")->type, ASSAY_JSON_NULL);
    assert_int_equal(assay_json_index(root, "i"), 7);
    assert_int_equal(assay_json_index(root, "j"), ASSAY_NONE);
    assert_null(assay_json_member(root, "N"));
    assert_null(assay_json_member(NULL, "n"));
    assay_json_release(context, &d);
    assay_context_destroy(context);
}

/* The judge is the C library's correctly rounded strtod on the number alone. */
static void test_numbers_are_exact(void **state)
{
    static const char *const numbers[] = {"0.1",
                                          "0.30000000000000004",
                                          "1.7976931348623157e308",
                                          "4.9406564584124654e-324",
                                          "2.2250738585072014e-308",
                                          "9007199254740993",
                                          "123456789012345678901234567890",
                                          "0.7071067811865475244",
                                          "1e23",
                                          "5e-324",
                                          "-0.0"};
    assay_context           *context   = gltf_context();
    (void)state;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        char                text[128];
        assay_json_document d = {0};
        snprintf(text, sizeof text, "{\"a\":%s}", numbers[i]);
        assert_int_equal(read_exactly(context, text, strlen(text), &d), ASSAY_OK);
        const double expected = strtod(numbers[i], NULL);
        assert_memory_equal(&assay_json_member(d.nodes, "a")->number, &expected, sizeof expected);
        assay_json_release(context, &d);
    }
    assay_context_destroy(context);
}

/* What tinygltf is given reads back as the same numbers, and leaves out what it must not see. */
static void test_written_again(void **state)
{
    const char *text =
        "{\"buffers\":[{\"byteLength\":1}],\"images\":[],\"materials\":[{}],"
        "\"a\":[2.0,1e2,0.1,0.7071067811865475,-3,1e300,123456789.125],"
        "\"extras\":{\"x\":1},\"o\":{\"extensions\":{},\"buffers\":\"\\u0001\\\"\"}}";
    const char         *expected = "{\"a\":[2,100,0.10000000000000001,0.70710678118654746,-3,"
                                   "1.0000000000000001e+300,123456789.125],"
                                   "\"o\":{\"buffers\":\"\\u0001\\\"\"}}";
    assay_context      *context  = gltf_context();
    assay_json_document d        = {0};
    char               *written  = NULL;
    size_t              count    = 0;
    (void)state;
    assert_int_equal(read_exactly(context, text, strlen(text), &d), ASSAY_OK);
    assert_int_equal(assay_gltf_write_text(context, "x", d.nodes, &written, &count), ASSAY_OK);
    assert_int_equal(count, strlen(expected));
    assert_memory_equal(written, expected, count);
    assert_true(accepts(written, count));
    assay_release(context, written);
    assay_json_release(context, &d);
    assay_context_destroy(context);
}

/* ---- limits ---- */

static void test_depth(void **state)
{
    (void)state;
    for (int depth = ASSAY_GLTF_MAX_JSON_DEPTH - 1; depth <= ASSAY_GLTF_MAX_JSON_DEPTH; depth++) {
        char text[1024];
        int  used = snprintf(text, sizeof text, "{\"a\":");
        for (int i = 0; i < depth; i++) {
            text[used++] = '[';
        }
        for (int i = 0; i < depth; i++) {
            text[used++] = ']';
        }
        text[used++] = '}';
        assert_int_equal(accepts(text, (size_t)used), depth < ASSAY_GLTF_MAX_JSON_DEPTH);
    }
}

static void test_a_million_brackets(void **state)
{
    const size_t        count   = 1000000;
    char               *text    = malloc(count + 5);
    assay_context      *context = gltf_context();
    assay_json_document d       = {0};
    (void)state;
    memcpy(text, "{\"a\":", 5);
    memset(text + 5, '[', count);
    assert_int_equal(assay_json_read(context, "x", text, count + 5, &d), ASSAY_ERR_LIMIT);
    assert_non_null(strstr(assay_context_error(context), "line 1, column 133"));
    assay_context_destroy(context);
    free(text);
}

static void test_too_many_values(void **state)
{
    const size_t        count   = 2 * (size_t)ASSAY_GLTF_MAX_JSON_VALUES;
    char               *text    = malloc(count + 16);
    assay_context      *context = gltf_context();
    assay_json_document d       = {0};
    (void)state;
    memcpy(text, "{\"a\":[0", 7);
    for (size_t i = 0; i < count; i += 2) {
        memcpy(text + 7 + i, ",0", 2);
    }
    memcpy(text + 7 + count, "]}", 2);
    assert_int_equal(assay_json_read(context, "x", text, count + 9, &d), ASSAY_ERR_LIMIT);
    assay_context_destroy(context);
    free(text);
}

static void test_message_gives_line_and_column(void **state)
{
    const char         *text    = "{\n  \"a\": 1,\n  \"b\": 01\n}";
    assay_context      *context = gltf_context();
    assay_json_document d       = {0};
    (void)state;
    assert_int_equal(assay_json_read(context, "a.gltf", text, strlen(text), &d), ASSAY_ERR_FORMAT);
    assert_string_equal(assay_context_error(context),
                        "a.gltf: line 3, column 10 of the JSON text: a malformed number");
    assay_context_destroy(context);
}

static assay_status read_and_release(assay_context *context, void *user)
{
    assay_json_document d      = {0};
    const assay_status  status = assay_json_read(context, "x", user, strlen(user), &d);
    assay_json_release(context, &d);
    return status;
}

static void test_refused_memory(void **state)
{
    (void)state;
    assert_int_equal(failing_each(read_and_release, "{\"a\":[1,\"b\"]}"), 2);
}

/* ---- URIs ---- */

static void test_percent(void **state)
{
    static const struct {
        const char *from, *to;
        bool        sound;
    } cases[] = {
        {"a%20b.bin", "a b.bin", true},
        {"a+b.bin", "a+b.bin", true},
        {"gr%C3%BCn.png", "gr\xC3\xBCn.png", true},
        {"100%", "100%", true},
        {"%4", "%4", true},
        {"%zz%41", "%zzA", true},
        {"%2F%2f", "//", true},
        {"a%00b", NULL, false},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char   text[64];
        size_t length = 0;
        snprintf(text, sizeof text, "%s", cases[i].from);
        assert_int_equal(assay_gltf_uri_decode(text, &length), cases[i].sound);
        if (cases[i].to) {
            assert_string_equal(text, cases[i].to);
            assert_int_equal(length, strlen(cases[i].to));
        }
    }
    assert_true(assay_gltf_uri_has_scheme("http://a"));
    assert_true(assay_gltf_uri_has_scheme("C:\\a"));
    assert_true(assay_gltf_uri_has_scheme("data:,"));
    assert_false(assay_gltf_uri_has_scheme("a/b:c"));
    assert_false(assay_gltf_uri_has_scheme("1:2"));
    assert_false(assay_gltf_uri_has_scheme(""));
}

/* RFC 4648, section 10, and what is not base64. */
static void test_base64(void **state)
{
    static const struct {
        const char *from, *to;
    } cases[] = {
        {"", ""},
        {"Zg==", "f"},
        {"Zm8=", "fo"},
        {"Zm9v", "foo"},
        {"Zm9vYg==", "foob"},
        {"Zm9vYmE=", "fooba"},
        {"Zm9vYmFy", "foobar"},
        {"Zg", "f"},
        {"Zm8", "fo"},
        {"+/+/", "\xFB\xFF\xBF"},
        {"Z", NULL},
        {"Zg=", NULL},
        {"Zg===", NULL},
        {"Z===", NULL},
        {"Zm9v!mFy", NULL},
        {"Zm9v YmFy", NULL},
        {"Zg==Zg==", NULL},
        {"-_-_", NULL},
        {"=", NULL},
        {"====", NULL},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char   text[64];
        size_t length = 99;
        snprintf(text, sizeof text, "%s", cases[i].from);
        const bool sound = assay_gltf_base64_decode(text, strlen(text), &length);
        if (sound != (cases[i].to != NULL)) {
            fail_msg("%s", cases[i].from);
        }
        if (sound) {
            assert_int_equal(length, strlen(cases[i].to));
            assert_memory_equal(text, cases[i].to, length);
        }
    }
}

static void test_clean_text(void **state)
{
    char clean[16];
    (void)state;
    assay_text_clean("a\nb\x1b[1m\x7F", clean, sizeof clean);
    assert_string_equal(clean, "a?b?[1m?");
    assay_text_clean("\xC3\xA9\xFF\xED\xA0\x80\xC3", clean, sizeof clean);
    assert_string_equal(clean, "\xC3\xA9?????");
    assay_text_clean("\xE2\x82\xAC\xF0\x9F\x98\x80\xF4\x90\x80\x80", clean, sizeof clean);
    assert_string_equal(clean, "\xE2\x82\xAC\xF0\x9F\x98\x80????");
    assay_text_clean("12345678901234\xC3\xA9", clean, sizeof clean);
    assert_string_equal(clean, "12345678901234");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_well_formed),
        cmocka_unit_test(test_malformed),
        cmocka_unit_test(test_every_prefix_is_refused),
        cmocka_unit_test(test_tree),
        cmocka_unit_test(test_numbers_are_exact),
        cmocka_unit_test(test_written_again),
        cmocka_unit_test(test_depth),
        cmocka_unit_test(test_a_million_brackets),
        cmocka_unit_test(test_too_many_values),
        cmocka_unit_test(test_message_gives_line_and_column),
        cmocka_unit_test(test_refused_memory),
        cmocka_unit_test(test_percent),
        cmocka_unit_test(test_base64),
        cmocka_unit_test(test_clean_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
