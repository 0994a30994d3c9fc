/* test_verify_chance.c - light that few samples find, missing in a candidate that has no variance.
 *
 * In RARE pixels one sample in a hundred is 30, all other samples are 1; so a pixel's mean is 1.29
 * and a sample's variance .01 .99 29^2.  What a candidate of n samples sees of it is drawn. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/verify.h"
#include "core/random.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE, RARE = 20, REFERENCE_SAMPLES = 1024 };
static const double SAMPLE_VARIANCE = 0.01 * 0.99 * 29.0 * 29.0, MEAN = 1.29;

/* Spread over the image, or side by side in the first tile. */
static int rare_pixel(int k, bool together)
{
    return together ? k % 8 * SIDE + k / 8 : (k + 1) * (PIXELS / RARE) - 1;
}

/* Its values are its expectation. */
static assay_image *make_reference(assay_context *context, bool together)
{
    assay_image *image = normal_images_make(context, 1, 0.5, REFERENCE_SAMPLES);
    for (int i = 0; i < PIXELS; i++) {
        normal_images_values(image, "R")[i]          = 1.0F;
        normal_images_values(image, "Variance.R")[i] = 0.0F;
    }
    for (int k = 0; k < RARE; k++) {
        const int i                                  = rare_pixel(k, together);
        normal_images_values(image, "R")[i]          = (float)MEAN;
        normal_images_values(image, "Variance.R")[i] = (float)(SAMPLE_VARIANCE / REFERENCE_SAMPLES);
    }
    return image;
}

/* R alone, `value` in the rare pixels. */
static assay_image *make_candidate(assay_context *context, double value, bool together)
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(context, SIDE, SIDE, &image), ASSAY_OK);
    float *r = normal_images_add(image, "R");
    for (int i = 0; i < PIXELS; i++) {
        r[i] = 1.0F;
    }
    for (int k = 0; k < RARE; k++) {
        r[rare_pixel(k, together)] = (float)value;
    }
    return image;
}

static assay_finding find_of(assay_context *context, assay_image *candidate, const assay_image *r,
                             uint32_t samples, const char *test, char meaning[1024])
{
    assay_verify_options o = assay_verify_options_default();
    o.candidate_samples    = samples;
    assay_verdict *verdict = normal_images_verify(context, candidate, r, &o);
    assay_finding  finding = normal_images_find(verdict, test);
    snprintf(meaning, 1024, "%s", finding.meaning ? finding.meaning : "");
    finding.meaning = meaning;
    assay_verdict_destroy(verdict);
    return finding;
}

/* The whole lacks 20 times 0.29 and its variance, k + 1 times that of 20 pixels of the reference,
 * makes that 2.9352 deviations (a third of 0.01, two-sided; degrees beyond 20,000) at k = 22.6; so
 * 1024 / k samples make it too much.  A tenth of it is rounding's. */
static double samples_by_hand(double lack, double quantile)
{
    const double rounding = 0x1p-24 * PIXELS * 1.002 * (2 + 4 + 2 + 4 * 32);
    const double v        = RARE * SAMPLE_VARIANCE / REFERENCE_SAMPLES;
    const double size     = (lack - rounding) / quantile;
    return REFERENCE_SAMPLES / (size * size / v - 1.0);
}

static void says_how_many_samples(void **state)
{
    char          text[1024];
    assay_image  *c = make_candidate(*state, 1.0, false), *r = make_reference(*state, false);
    const double  n  = ceil(samples_by_hand(RARE * 0.29, 2.9352));
    assay_finding f  = find_of(*state, c, r, 0, "whole", text);
    const char   *at = strstr(text, "if the candidate took ");
    assert_int_equal(f.kind, ASSAY_VERDICT_CANNOT_TELL);
    assert_non_null(at);
    assert_true(fabs(strtod(at + 22, NULL) - n) <= 1.0);
    /* One that has fewer may have missed it, one that has as many may not. */
    f = find_of(*state, c, r, (uint32_t)n - 2, "whole", text);
    assert_int_equal(f.kind, ASSAY_VERDICT_CANNOT_TELL);
    assert_non_null(strstr(text, "by chance"));
    f = find_of(*state, c, r, (uint32_t)n + 2, "whole", text);
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    assert_null(strstr(text, "chance"));
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* Where nobody knows how many samples the reference has, it is said in parts of them.  They may be
 * two: the variance of 20 pixels has 20 degrees of freedom, and Student's quantile is 3.33. */
static void says_which_share(void **state)
{
    char          text[1024];
    assay_image  *c = make_candidate(*state, 1.0, false), *r = make_reference(*state, false);
    assay_channel samples;
    const double  share = samples_by_hand(RARE * 0.29, 3.33) / REFERENCE_SAMPLES;
    assert_true(assay_image_find_channel(r, "SampleCount", &samples));
    memset(samples.data.u32, 0, PIXELS * sizeof *samples.data.u32);
    const assay_finding f  = find_of(*state, c, r, 0, "whole", text);
    const char         *at = strstr(text, "if the candidate took ");
    assert_int_equal(f.kind, ASSAY_VERDICT_CANNOT_TELL);
    assert_non_null(at);
    assert_true(fabs(strtod(at + 22, NULL) - share) <= 0.05 * share);
    assert_non_null(
        strstr(at, " of the reference's samples or more (--samples and --reference-samples"));
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* The same in one of 16 tiles: of that the level is a sixteenth of a third. */
static void a_tile_likewise(void **state)
{
    char          text[1024];
    assay_image  *c = make_candidate(*state, 1.0, true), *r = make_reference(*state, true);
    assay_finding f = find_of(*state, c, r, 30, "tile-16", text);
    assert_int_equal(f.kind, ASSAY_VERDICT_CANNOT_TELL);
    assert_int_equal(f.place.x, 0);
    f = find_of(*state, c, r, 200, "tile-16", text);
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    assert_null(strstr(text, "chance"));
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* Two tiles fail; in the second the reference has no noise, so that chance has no part in it. */
static void the_surest_tile_decides(void **state)
{
    char         text[1024];
    assay_image *c = make_candidate(*state, 1.0, true), *r = make_reference(*state, true);
    for (int y = 32; y < 48; y++) {
        for (int x = 32; x < 48; x++) {
            normal_images_values(c, "R")[y * SIDE + x] = 0.98F;
        }
    }
    const assay_finding f = find_of(*state, c, r, 4, "tile-16", text);
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

static void too_much_light_is_no_lack(void **state)
{
    char         text[1024];
    assay_image *c = make_candidate(*state, MEAN + 0.29, false), *r = make_reference(*state, false);
    const assay_finding f = find_of(*state, c, r, 4, "whole", text);
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    assert_null(strstr(text, "chance"));
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* Their spread is known, but what all of them missed is not in it. */
static void runs_say_it_too(void **state)
{
    const assay_image   *runs[4];
    assay_image         *r = make_reference(*state, false);
    assay_verify_options o = assay_verify_options_default();
    for (uint32_t samples = 0; samples <= 40; samples += 20) {
        assay_verdict *verdict = NULL;
        o.candidate_samples    = samples;
        for (int k = 0; k < 4; k++) {
            assay_image *run                  = make_candidate(*state, 1.0, false);
            normal_images_values(run, "R")[5] = 1.0F + 0x1p-20F * (float)k;
            runs[k]                           = run;
        }
        assert_int_equal(assay_verdict_create(*state, "c", "r", &verdict), ASSAY_OK);
        assert_int_equal(assay_verify_images(runs, 4, r, &o, verdict), ASSAY_OK);
        const assay_finding f = normal_images_find(verdict, "whole");
        assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
        assert_int_equal(strstr(f.meaning, "if the runs together took ") != NULL, samples == 0);
        assay_verdict_destroy(verdict);
        for (int k = 0; k < 4; k++) {
            assay_image_destroy((assay_image *)runs[k]);
        }
    }
    assay_image_destroy(r);
}

/* A pixel's mean of so many samples. */
static double draw(uint64_t seed, int pixel, int samples)
{
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)pixel, 0);
    double       sum    = 0.0;
    for (int i = 0; i < samples; i++) {
        sum += assay_random_next(&random) < 0.01 ? 30.0 : 1.0;
    }
    return sum / samples;
}

/* The same light, in four samples a pixel.  At a level of 0.01 five or more of 100 are false by
 * chance with a probability of 0.0034; whoever claims a thousand samples for them is told that they
 * fail, where they saw nothing. */
static void level_is_held_whether_samples_are_known(void **state)
{
    char         text[1024];
    assay_image *r     = make_reference(*state, false);
    int          known = 0, unknown = 0, claimed = 0;
    for (uint64_t seed = 0; seed < 100; seed++) {
        assay_image *c = make_candidate(*state, 1.0, false);
        for (int k = 0; k < RARE; k++) {
            normal_images_values(c, "R")[rare_pixel(k, false)] = (float)draw(seed, k, 4);
        }
        known += find_of(*state, c, r, 4, "whole", text).kind == ASSAY_VERDICT_FAIL;
        unknown += find_of(*state, c, r, 0, "whole", text).kind == ASSAY_VERDICT_FAIL;
        claimed += find_of(*state, c, r, 1000, "whole", text).kind == ASSAY_VERDICT_FAIL;
        assay_image_destroy(c);
    }
    assert_true(known < 5);
    assert_true(unknown < 5);
    assert_true(claimed > 20);
    assay_image_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(says_how_many_samples, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(says_which_share, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(a_tile_likewise, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(the_surest_tile_decides, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(too_much_light_is_no_lack, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(runs_say_it_too, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(level_is_held_whether_samples_are_known, counted_set_up,
                                        counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
