/* test_bundle_refused.c - bundles that cannot be compared are refused, by name. */
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

static void refuse(assay_context *context, const stage_case *c, const splat_data *reference,
                   assay_status status, const char *word)
{
    stage_case     r       = stage_case_begin(context);
    assay_verdict *verdict = NULL;
    splat_add_arrays(&r, reference, -1);
    stage_case_finish(&r);
    assert_int_equal(assay_verdict_create(context, "candidate", "reference", &verdict), ASSAY_OK);
    const assay_status got =
        assay_verify_bundle(context, c->path, r.path, NULL, ASSAY_PRECISION_FLOAT, verdict);
    if (got != status || !strstr(assay_context_error(context), word)) {
        fail_msg("status %d, %s; '%s' was expected", got, assay_context_error(context), word);
    }
    assert_int_equal(assay_status_exit_code(got), 2);
    assay_verdict_destroy(verdict);
    stage_case_end(&r);
}

static void test_other_making(void **state)
{
    static const char *const keys[] = {"assay:splat.a", "assay:scene.digest",
                                       "assay:camera.position"};
    splat_data              *d      = splat_make_data(*state);
    for (int i = 0; i < 3; i++) {
        for (int missing = 0; missing < 2; missing++) {
            stage_case c = stage_case_begin(*state);
            stage_case_text(&c, "assay:method", "splat");
            for (int k = 0; k < 3; k++) {
                if (k != i || !missing) {
                    stage_case_text(&c, keys[k],
                                    k == i   ? "9 9 9"
                                    : k == 0 ? "2.5e-1"
                                    : k == 1 ? "abc"
                                             : "1.0 2 3.00");
                }
            }
            stage_case_table(&c, splat_arrays[0].name, splat_arrays[0].unit, splat_arrays[0].rows,
                             splat_arrays[0].columns, d->values[0]);
            stage_case_finish(&c);
            refuse(*state, &c, d, ASSAY_ERR_ARGUMENT, keys[i]);
            stage_case_end(&c);
        }
    }
    free(d);
}

static void test_other_arrays(void **state)
{
    splat_data *d = splat_make_data(*state);
    struct {
        const char  *name, *unit;
        size_t       rows, columns;
        double       spoil;
        assay_status status;
        const char  *word;
    } cases[] = {
        {"splat/surprise", "m", SPLAT_PIXELS, 1, 0.0, ASSAY_ERR_FORMAT,
         "surprise' is not an array"},
        {"splat/result", "W/m2", SPLAT_PIXELS, 3, 0.0, ASSAY_ERR_FORMAT, "W/m2"},
        {"splat/result", "W/(m2 sr)", SPLAT_PIXELS, 4, 0.0, ASSAY_ERR_FORMAT, "splat/result"},
        {"splat/result", "W/(m2 sr)", SPLAT_PIXELS - 1, 3, 0.0, ASSAY_ERR_FORMAT, "splat/result"},
        {"splat/result", "W/(m2 sr)", SPLAT_PIXELS, 3, NAN, ASSAY_ERR_DOMAIN, "splat/result"},
        {"splat/result", "W/(m2 sr)", SPLAT_PIXELS, 3, INFINITY, ASSAY_ERR_DOMAIN, "splat/result"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage_case c = stage_case_begin(*state);
        double    *v = calloc(4 * SPLAT_PIXELS, sizeof *v);
        assert_non_null(v);
        v[5] = cases[i].spoil;
        splat_add_arrays(&c, d, SPLAT_RESULT);
        stage_case_table(&c, cases[i].name, cases[i].unit, cases[i].rows, cases[i].columns, v);
        stage_case_finish(&c);
        refuse(*state, &c, d, cases[i].status, cases[i].word);
        stage_case_end(&c);
        free(v);
    }
    stage_case c = stage_case_begin(*state);
    splat_add_arrays(&c, d, -1);
    stage_case_table(&c, splat_arrays[SPLAT_RESULT].name, splat_arrays[SPLAT_RESULT].unit,
                     SPLAT_PIXELS, 3, d->values[SPLAT_RESULT]);
    stage_case_finish(&c);
    refuse(*state, &c, d, ASSAY_ERR_FORMAT, "twice");
    stage_case_end(&c);
    free(d);
}

/* Bytes that change behind the manifest's back; files that are cut; a manifest that lies. */
static void test_broken_files(void **state)
{
    static const struct {
        const char *file;
        long        at; /* < 0: cut to -at bytes */
        const char *word;
    } cases[]     = {{"splat/result.npy", 200, "splat/result"},
                     {"splat/result.npy", 0, "splat/result"},
                     {"records/radius.npy", -100, "records/radius"},
                     {"records/radius.npy", -5, "records/radius"},
                     {"manifest.json", -60, "manifest.json"}};
    splat_data *d = splat_make_data(*state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage_case c = stage_case_begin(*state);
        char       path[400];
        splat_add_arrays(&c, d, -1);
        stage_case_finish(&c);
        snprintf(path, sizeof path, "%s/%s", c.path, cases[i].file);
        FILE *file = fopen(path, "r+b");
        assert_non_null(file);
        static uint8_t bytes[1 << 20];
        const size_t   count = fread(bytes, 1, sizeof bytes, file);
        fclose(file);
        if (cases[i].at >= 0) {
            bytes[cases[i].at] ^= 1;
        }
        file = fopen(path, "wb");
        assert_non_null(file);
        fwrite(bytes, 1, cases[i].at < 0 ? (size_t)-cases[i].at : count, file);
        fclose(file);
        refuse(*state, &c, d, ASSAY_ERR_FORMAT, cases[i].word);
        stage_case_end(&c);
    }
    free(d);
}

/* Text of the manifest that is replaced, of an entry that begins with `after`. */
static void replace(const stage_case *c, const char *after, const char *from, const char *to)
{
    static char text[1 << 16];
    char        path[400];
    snprintf(path, sizeof path, "%s/manifest.json", c->path);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    char *entry = strstr(text, after);
    char *at    = entry ? strstr(entry, from) : NULL;
    assert_non_null(at);
    memmove(at + strlen(to), at + strlen(from), strlen(at + strlen(from)) + 1);
    memcpy(at, to, strlen(to));
    file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void test_lying_manifest(void **state)
{
    static const struct {
        const char *after, *from, *to, *word;
    } cases[] = {
        {"\"records/radius\"", "200", "199", "shape"},
        {"\"records/radius\"", "float64", "float32", "dtype"},
        {"\"records/radius\"", "float64", "floaty8", "dtype"},
        {"\"records/radius\"", "records/radius.npy", "records/normal.npy", "'file'"},
        {"\"records/radius\"", "\"unit\"", "\"tinu\"", "unit"},
        {"\"records/radius\"", "\"sha256\":\t\"", "\"sha256\":0,\"\":\"", "'sha256'"},
        {"\"assay-bundle\"", "assay-bundle", "essay-bundle", "not of a bundle"},
        {"\"assay-bundle\"", "\"arrays\"", "\"errays\"", "'arrays'"},
    };
    splat_data *d = splat_make_data(*state);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        stage_case c = stage_case_begin(*state);
        splat_add_arrays(&c, d, -1);
        stage_case_finish(&c);
        replace(&c, cases[i].after, cases[i].from, cases[i].to);
        refuse(*state, &c, d, ASSAY_ERR_FORMAT, cases[i].word);
        stage_case_end(&c);
    }
    /* A NaN that the reference has, too, is a NaN still. */
    stage_case c                 = stage_case_begin(*state);
    d->values[SPLAT_RESULT][100] = NAN;
    splat_add_arrays(&c, d, -1);
    stage_case_finish(&c);
    refuse(*state, &c, d, ASSAY_ERR_DOMAIN, "splat/result");
    stage_case_end(&c);
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
    assay_verdict_destroy(verdict);
    return status;
}

static void test_refused_memory(void **state)
{
    splat_data *d = splat_make_data(*state);
    stage_case  c = stage_case_begin(*state), r = stage_case_begin(*state);
    const paths p = {c.path, r.path};
    splat_add_arrays(&c, d, -1);
    splat_add_arrays(&r, d, -1);
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
        cmocka_unit_test_setup_teardown(test_other_making, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_other_arrays, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_broken_files, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_lying_manifest, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_refused_memory, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
