/* test_verify_runs.c - a candidate whose noise nobody states: a single image without a variance, or
 * several runs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "assay/verify.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

/* ---- a candidate alone ---- */

static assay_image *alone(assay_context *context, uint64_t seed, double sigma)
{
    assay_image *image = NULL, *from = normal_images_make(context, seed, sigma, 100);
    assert_int_equal(assay_image_create(context, SIDE, SIDE, &image), ASSAY_OK);
    memcpy(normal_images_add(image, "R"), normal_images_values(from, "R"), sizeof(float) * PIXELS);
    assay_image_destroy(from);
    return image;
}

static void alone_without_variance(void **state)
{
    assay_image *c = alone(*state, 11, 0.5), *r = normal_images_make(*state, 12, 0.5, 256);
    assert_int_equal(normal_images_kind(*state, c, r, NULL), ASSAY_VERDICT_PASS);
    for (int i = 0; i < PIXELS; i++) {
        normal_images_values(c, "R")[i] *= 1.02F;
    }
    assay_verdict *verdict = normal_images_verify(*state, c, r, NULL);
    assert_int_equal(normal_images_find(verdict, "whole").kind, ASSAY_VERDICT_FAIL);
    assert_string_equal(assay_verdict_get(verdict, "candidate_noise"),
                        "differences to the reference");
    assay_verdict_destroy(verdict);
    /* A single pixel far off may be a firefly: who would know? */
    assay_image *d                  = alone(*state, 13, 0.5);
    normal_images_values(d, "R")[7] = 3.0F;
    verdict                         = normal_images_verify(*state, d, r, NULL);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_CANNOT_TELL);
    assert_int_equal(normal_images_find(verdict, "outlier").place.x, 7);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(d);
    assay_image_destroy(r);
}

/* ---- runs ---- */

/* Noise of blocks of 8 x 8 pixels, as a cache has: with pixels taken as independent every tile
 * would fail. */
static assay_image *blotchy(assay_context *context, uint64_t seed, double bias)
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(context, SIDE, SIDE, &image), ASSAY_OK);
    float *r = normal_images_add(image, "R");
    for (int i = 0; i < PIXELS; i++) {
        const int block = (i / SIDE / 8) * 8 + i % SIDE / 8;
        r[i]            = (float)(normal_images_light(i) + bias +
                       0.05 * normal_images_deviate(seed, (uint64_t)block));
    }
    return image;
}

static assay_verdict_kind kind_of_runs(assay_context *context, double bias, const assay_image *r,
                                       uint64_t seed, assay_verdict **verdict_out)
{
    const assay_image         *runs[4];
    const assay_verify_options o       = assay_verify_options_default();
    assay_verdict             *verdict = NULL;
    for (int k = 0; k < 4; k++) {
        runs[k] = blotchy(context, seed + (uint64_t)k, bias);
    }
    assert_int_equal(assay_verdict_create(context, "c", "r", &verdict), ASSAY_OK);
    assert_int_equal(assay_verify_images(runs, 4, r, &o, verdict), ASSAY_OK);
    const assay_verdict_kind kind = assay_verdict_whole(verdict);
    for (int k = 0; k < 4; k++) {
        assay_image_destroy((assay_image *)runs[k]);
    }
    *verdict_out = verdict;
    return kind;
}

static void runs_show_noise_that_hangs_together(void **state)
{
    assay_image   *r       = normal_images_make(*state, 14, 0.5, 4096);
    assay_verdict *verdict = NULL;
    for (uint64_t seed = 100; seed < 150; seed += 10) {
        assert_int_equal(kind_of_runs(*state, 0.0, r, seed, &verdict), ASSAY_VERDICT_PASS);
        assay_verdict_destroy(verdict);
    }
    assert_int_equal(kind_of_runs(*state, 0.1, r, 200, &verdict), ASSAY_VERDICT_FAIL);
    assert_string_equal(assay_verdict_get(verdict, "candidate_noise"), "differences of its runs");
    /* sd of the mean of 4 runs of 64 blocks: 0.05 / 16, with the reference's 0.5 / 64 / 64; the
     * quantile at 3 degrees of freedom is 8.9 */
    const assay_finding f  = normal_images_find(verdict, "whole");
    const double        sd = sqrt(0.05 * 0.05 / 256 + 0.25 / 4096 / PIXELS);
    assert_true(f.bound > 7.0 * sd && f.bound < 20.0 * sd);
    assay_verdict_destroy(verdict);
    assay_image_destroy(r);
}

/* Independent pixels: the mean of 4 runs has a fourth of the variance, and all pixels tell it. */
static void runs_of_independent_pixels(void **state)
{
    const assay_image         *runs[4];
    assay_image               *r       = normal_images_make(*state, 14, 0.5, 256);
    const assay_verify_options o       = assay_verify_options_default();
    assay_verdict             *verdict = NULL;
    double                     mean    = 0.0;
    for (int k = 0; k < 4; k++) {
        runs[k] = normal_images_make(*state, 300 + (uint64_t)k, 0.5, 64);
        for (int i = 0; i < PIXELS; i++) {
            mean += (double)normal_images_values(runs[k], "R")[i] / (4.0 * PIXELS);
        }
    }
    assert_int_equal(assay_verdict_create(*state, "c", "r", &verdict), ASSAY_OK);
    assert_int_equal(assay_verify_images(runs, 4, r, &o, verdict), ASSAY_OK);
    const assay_finding f  = normal_images_find(verdict, "whole");
    const double        sd = sqrt((0.25 / 64 / 4 + 0.25 / 256) / PIXELS);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_true(f.bound > 2.9352 * sd * 0.97 && f.bound < 2.9352 * sd * 1.15);
    assert_true(fabs(f.candidate - mean) < 1e-6);
    assay_verdict_destroy(verdict);
    for (int k = 0; k < 4; k++) {
        assay_image_destroy((assay_image *)runs[k]);
    }
    assay_image_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(alone_without_variance, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(runs_show_noise_that_hangs_together, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(runs_of_independent_pixels, counted_set_up,
                                        counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
