/* test_report_stale.c - a report tells where a verdict beside an image is of other pixels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/image.h"
#include "assay/report.h"
#include "assay/verify.h"
#include "support/failing_context.h"
#include "support/normal_images.h"
#include "support/temporary.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

typedef struct {
    temporary    folder;
    char         c[512], more[512], r[512], json[512], page[512];
    assay_image *candidate, *reference;
} scene;

/* R, G and B, the same in each, and another layer that no report shows. */
static assay_image *make(assay_context *context, uint64_t seed)
{
    static const char *const NAMES[] = {"G",          "B",        "Variance.G",
                                        "Variance.B", "Direct.R", "Variance.Direct.R"};
    assay_image             *image   = normal_images_make(context, seed, 0.5, 64);
    for (int k = 0; k < 6; k++) {
        const char *from = strncmp(NAMES[k], "Variance", 8) == 0 ? "Variance.R" : "R";
        memcpy(normal_images_add(image, NAMES[k]), normal_images_values(image, from),
               sizeof(float) * PIXELS);
    }
    return image;
}

static void write(const scene *s)
{
    assert_int_equal(assay_image_write_exr(s->candidate, s->c), ASSAY_OK);
    assert_int_equal(assay_image_write_exr(s->reference, s->r), ASSAY_OK);
}

/* Writes what verify says of the files as they are. */
static void judge(assay_context *context, const scene *s, const char *channels, int runs)
{
    const char *const    candidates[] = {s->c, s->more};
    assay_verify_options o            = assay_verify_options_default();
    assay_verdict       *verdict      = NULL;
    char                *text         = NULL;
    o.channels                        = channels;
    assert_int_equal(assay_verify_files(context, candidates, runs, s->r, &o, &verdict), ASSAY_OK);
    assert_int_equal(assay_verdict_json(verdict, &text), ASSAY_OK);
    temporary_write(s->json, text, strlen(text));
    assay_text_destroy(context, text);
    assay_verdict_destroy(verdict);
}

static scene start(assay_context *context)
{
    scene s = {.folder = temporary_create()};
    snprintf(s.c, sizeof s.c, "%s", temporary_path(&s.folder, "mine.exr"));
    snprintf(s.more, sizeof s.more, "%s", temporary_path(&s.folder, "more.exr"));
    snprintf(s.r, sizeof s.r, "%s", temporary_path(&s.folder, "truth.exr"));
    snprintf(s.json, sizeof s.json, "%s", temporary_path(&s.folder, "mine.verdict.json"));
    snprintf(s.page, sizeof s.page, "%s", temporary_path(&s.folder, "page.html"));
    s.candidate = make(context, 1);
    s.reference = make(context, 2);
    /* The worst pixel, which a finding names. */
    normal_images_values(s.candidate, "R")[10 * SIDE + 20] = 3.5F;
    write(&s);
    return s;
}

static void finish(scene *s)
{
    assay_image_destroy(s->candidate);
    assay_image_destroy(s->reference);
    temporary_destroy(&s->folder);
}

/* The list of other pixels in the page, "" where there is none; release with free. */
static char *report(assay_context *context, const scene *s)
{
    static const char    KEY[]        = "\"otherPixels\":";
    const char          *candidates[] = {s->c};
    assay_report_options options      = assay_report_options_default();
    size_t               count        = 0;
    options.reference                 = s->r;
    options.candidates                = candidates;
    options.candidate_count           = 1;
    assert_int_equal(assay_report_write(context, &options, s->page), ASSAY_OK);
    uint8_t *bytes = temporary_read(s->page, &count);
    char    *page  = malloc(count + 1);
    memcpy(page, bytes, count);
    page[count] = '\0';
    free(bytes);
    assert_non_null(strstr(page, "\"verdict\":{\"format\":"));
    const char *at  = strstr(page, KEY);
    const char *end = at ? strchr(at, ']') : NULL;
    char       *list =
        at ? strndup(at + sizeof KEY - 1, (size_t)(end - at) + 2 - sizeof KEY) : strdup("");
    free(page);
    return list;
}

static void expect(assay_context *context, const scene *s, const char *word)
{
    char *list = report(context, s);
    if (word ? !strstr(list, word) : *list != '\0') {
        fail_msg("'%s' was expected in %s", word ? word : "", list);
    }
    free(list);
}

/* Nothing is said of the very files; of one other pixel, the place and both values; of a pixel that
 * no finding names, the means. */
static void pixels_of_the_report(void **state)
{
    scene s = start(*state);
    judge(*state, &s, NULL, 1);
    expect(*state, &s, NULL);
    normal_images_values(s.candidate, "R")[10 * SIDE + 20] = 3.25F;
    write(&s);
    expect(*state, &s,
           "'R' at (20, 10) is 3.25 (0x1.ap+1) in mine and 3.5 (0x1.cp+1) in the verdict, and ");
    normal_images_values(s.candidate, "R")[10 * SIDE + 20] = 3.5F;
    normal_images_values(s.candidate, "G")[7] += 1e-4F;
    write(&s);
    expect(*state, &s, "the mean of 'G' is ");
    normal_images_values(s.candidate, "G")[7] = normal_images_values(s.candidate, "R")[7];
    normal_images_values(s.reference, "B")[8] += 1e-4F;
    write(&s);
    expect(*state, &s, "the mean of 'B' is ");
    expect(*state, &s, " in truth and ");
    finish(&s);
}

/* Writes the verdict with its first mean of a candidate multiplied. */
static void multiply_mean(const scene *s, const char *json, double factor)
{
    static const char KEY[] = "\"candidate_hex\"";
    const char       *hex   = strstr(strstr(json, "\"whole\""), KEY) + sizeof KEY - 1;
    hex += strcspn(hex, "0123456789");
    char        *end   = NULL;
    const double value = strtod(hex, &end);
    const size_t room  = strlen(json) + 64;
    char        *text  = malloc(room);
    snprintf(text, room, "%.*s%a%s", (int)(hex - json), json, value * factor, end);
    temporary_write(s->json, text, strlen(text));
    free(text);
}

/* A mean that was added up in another order is no other one: of 4096 values up to 9e-13. */
static void rounding_of_means(void **state)
{
    scene  s     = start(*state);
    size_t count = 0;
    judge(*state, &s, NULL, 1);
    uint8_t *bytes = temporary_read(s.json, &count);
    char    *json  = malloc(count + 1);
    memcpy(json, bytes, count);
    json[count] = '\0';
    free(bytes);
    multiply_mean(&s, json, 1.0 + 4e-13);
    expect(*state, &s, NULL);
    multiply_mean(&s, json, 1.0 - 4e-12);
    expect(*state, &s, "the mean of ");
    free(json);
    finish(&s);
}

static void layers_that_are_not_shown(void **state)
{
    scene s = start(*state);
    judge(*state, &s, "Direct.R", 1);
    expect(*state, &s, NULL);
    normal_images_values(s.candidate, "Direct.R")[99] += 0.5F;
    write(&s);
    expect(*state, &s, "the mean of 'Direct.R'");
    assay_image_destroy(s.candidate);
    s.candidate       = make(*state, 1);
    assay_image *bare = NULL;
    assert_int_equal(assay_image_create(*state, SIDE, SIDE, &bare), ASSAY_OK);
    for (const char *c = "RGB"; *c; c++) {
        const char name[2] = {*c, '\0'};
        memcpy(normal_images_add(bare, name), normal_images_values(s.candidate, name),
               sizeof(float) * PIXELS);
    }
    assay_image_destroy(s.candidate);
    s.candidate = bare;
    write(&s);
    expect(*state, &s, "mine has no channel 'Direct.R'");
    finish(&s);
}

/* The mean of several runs is in no file; the reference is. */
static void several_runs(void **state)
{
    scene        s    = start(*state);
    assay_image *more = make(*state, 3);
    assert_int_equal(assay_image_write_exr(more, s.more), ASSAY_OK);
    assay_image_destroy(more);
    judge(*state, &s, NULL, 2);
    expect(*state, &s, NULL);
    normal_images_values(s.reference, "B")[8] += 0.5F;
    write(&s);
    expect(*state, &s, " in truth and ");
    finish(&s);
}

static void a_nan_that_was_mended(void **state)
{
    scene s = start(*state);
    for (int kind = 0; kind < 2; kind++) {
        normal_images_values(s.candidate, "R")[77] = kind == 0 ? NAN : INFINITY;
        write(&s);
        judge(*state, &s, NULL, 1);
        expect(*state, &s, NULL);
        normal_images_values(s.candidate, "R")[77] = 1.0F;
        write(&s);
        expect(*state, &s, "'R' at (13, 1) is 1 ");
    }
    finish(&s);
}

static assay_status page(assay_context *context, void *user)
{
    const scene         *s            = user;
    const char          *candidates[] = {s->c};
    assay_report_options options      = assay_report_options_default();
    options.reference                 = s->r;
    options.candidates                = candidates;
    options.candidate_count           = 1;
    return assay_report_write(context, &options, s->page);
}

static void refused_memory(void **state)
{
    scene s = start(*state);
    judge(*state, &s, "R,Direct.R", 1);
    assert_true(failing_each(page, &s) > 20);
    finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(pixels_of_the_report, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(rounding_of_means, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(layers_that_are_not_shown, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(several_runs, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(a_nan_that_was_mended, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(refused_memory, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
