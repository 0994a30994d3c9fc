/* test_verify.c - images against a reference, both with variances: each kind of answer.
 *
 * The noise is made here, so what is right is known: independent normal pixels of a given variance,
 * unless a test says otherwise. */
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
#include "core/numerics.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

static void same_light_passes(void **state)
{
    assay_image *c         = normal_images_make(*state, 1, 0.5, 64),
                *r         = normal_images_make(*state, 2, 0.5, 256);
    assay_verdict *verdict = normal_images_verify(*state, c, r, NULL);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    /* whole; tiles of 16 (16 of them; of 64 there is one, too few); pixels */
    assert_int_equal(assay_verdict_count(verdict), 3);
    assert_int_equal(normal_images_find(verdict, "whole").values, PIXELS);
    assert_int_equal(normal_images_find(verdict, "tile-16").values, 16);
    assert_int_equal(normal_images_find(verdict, "welch").values, PIXELS);
    assert_string_equal(assay_verdict_get(verdict, "candidate_noise"), "its own variance");
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* Numbers of the whole, by hand: exact variances of 4096 pixels, sd of the mean = sqrt(v / 4096)
 * with v = 0.25 / 64 + 0.25 / 256; a third of 0.01 for one channel, two-sided 0.00333: quantile
 * 2.9352; 0.9: 1.2816. */
static void whole_by_hand(void **state)
{
    assay_image *c = normal_images_make(*state, 1, 0.5, 64),
                *r = normal_images_make(*state, 2, 0.5, 256);
    float *x = normal_images_values(c, "R"), *y = normal_images_values(r, "R");
    double sum = 0.0, mean = 0.0;
    for (int i = 0; i < PIXELS; i++) {
        x[i] += 0.02F;
        sum += (double)x[i] - y[i];
        mean += y[i];
    }
    assay_verdict      *verdict = normal_images_verify(*state, c, r, NULL);
    const assay_finding f       = normal_images_find(verdict, "whole");
    /* Of the views of the variance the largest: the reference's grows with the light. */
    const double sd = sqrt((0.25 / 64 + 0.25 / 256 * (1.0 + sum / mean)) / PIXELS);
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    /* Rounding: 2^-24 (2 + 4 sqrt(n)) of either mean, which is 1.25. */
    const double rounding = 0x1p-24 * 1.25 * ((2 + 4 * 8) + (2 + 4 * 16));
    assert_true(fabs((f.bound - rounding) / (2.9352 * sd) - 1.0) < 1e-4);
    assert_true(fabs(f.visible / ((2.9352 + 1.2816) * sd) - 1.0) < 0.01);
    assert_true(fabs(f.effect - sum / mean) < 1e-9);
    assert_true(fabs(f.in_bounds - sum / PIXELS / (2.9352 * sd)) < 0.01 * f.in_bounds);
    assert_non_null(f.meaning);
    /* Pixels do not show it. */
    assert_int_equal(normal_images_find(verdict, "welch").kind, ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

static void leak_in_one_tile(void **state)
{
    assay_image *c = normal_images_make(*state, 3, 0.5, 64),
                *r = normal_images_make(*state, 4, 0.5, 256);
    for (int y = 32; y < 48; y++) {
        for (int x = 16; x < 32; x++) {
            normal_images_values(c, "R")[y * SIDE + x] += 0.03F;
        }
    }
    assay_verdict      *verdict = normal_images_verify(*state, c, r, NULL);
    const assay_finding f       = normal_images_find(verdict, "tile-16");
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    assert_int_equal(f.place.x, 16);
    assert_int_equal(f.place.y, 32);
    assert_int_equal(f.place.width, 16);
    assert_int_equal(normal_images_find(verdict, "welch").kind, ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* In twenty pixels one sample in a hundred is 30, all others are 1.  Four samples missed all of
 * them: their variance is 0, and the light is the same still.  Of 1024 they would be missed in no
 * image. */
static void rare_light_missed(void **state)
{
    enum { RARE = 20 };
    const double variance = 0.01 * 0.99 * 30.0 * 30.0;
    for (int samples = 4; samples <= 1024; samples *= 256) {
        assay_image *c = normal_images_make(*state, 5, 0.5, samples),
                    *r = normal_images_make(*state, 6, 0.5, 1024);
        for (int i = 0; i < PIXELS; i++) {
            const bool rare                          = i % (PIXELS / RARE) == 0 && i > 0;
            normal_images_values(c, "R")[i]          = 1.0F;
            normal_images_values(r, "R")[i]          = rare ? 1.3F : 1.0F;
            normal_images_values(c, "Variance.R")[i] = 0.0F;
            normal_images_values(r, "Variance.R")[i] = rare ? (float)(variance / 1024.0) : 0.0F;
        }
        assert_int_equal(normal_images_kind(*state, c, r, NULL),
                         samples == 4 ? ASSAY_VERDICT_PASS : ASSAY_VERDICT_FAIL);
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

static void one_pixel(void **state)
{
    assay_image *c = normal_images_make(*state, 5, 0.5, 64),
                *r = normal_images_make(*state, 6, 0.5, 256);
    normal_images_values(c, "R")[10 * SIDE + 20] -= 0.9F;
    assay_verdict      *verdict = normal_images_verify(*state, c, r, NULL);
    const assay_finding f       = normal_images_find(verdict, "welch");
    assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
    assert_int_equal(f.place.x, 20);
    assert_int_equal(f.place.y, 10);
    assert_true(f.candidate == normal_images_values(c, "R")[10 * SIDE + 20]);
    assert_true(f.p < 1e-9 && fabs(assay_log(f.p) - f.log_p) < 1e-9);
    assert_int_equal(normal_images_find(verdict, "whole").kind, ASSAY_VERDICT_PASS);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* The edge of a light: all samples of the one image hit it, all of the other miss it, and neither
 * has a variance there.  Of two samples each that is chance, of 64 it is not. */
static void edge_of_few_samples(void **state)
{
    for (int samples = 2; samples <= 64; samples *= 32) {
        assay_image *c                               = normal_images_make(*state, 14, 0.5, samples),
                    *r                               = normal_images_make(*state, 15, 0.5, samples);
        const int pixel                              = 20 * SIDE + 7;
        normal_images_values(c, "R")[pixel]          = 0.0F;
        normal_images_values(r, "R")[pixel]          = 20.0F;
        normal_images_values(c, "Variance.R")[pixel] = 0.0F;
        normal_images_values(r, "Variance.R")[pixel] = 0.0F;
        assay_verdict *verdict                       = normal_images_verify(*state, c, r, NULL);
        assert_int_equal(normal_images_find(verdict, "welch").kind,
                         samples == 2 ? ASSAY_VERDICT_PASS : ASSAY_VERDICT_FAIL);
        assay_verdict_destroy(verdict);
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

/* A pixel that few samples outweigh is large, and its variance with it: told, not judged. */
static void firefly_is_told(void **state)
{
    assay_image *c                            = normal_images_make(*state, 7, 0.5, 64),
                *r                            = normal_images_make(*state, 8, 0.5, 256);
    normal_images_values(c, "R")[99]          = 1000.0F;
    normal_images_values(c, "Variance.R")[99] = 1e6F;
    normal_images_values(r, "R")[77]          = 500.0F;
    normal_images_values(r, "Variance.R")[77] = 25e4F;
    assay_verdict *verdict                    = normal_images_verify(*state, c, r, NULL);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_PASS);
    assert_int_equal(normal_images_find(verdict, "fireflies").values, 1);
    assert_int_equal(normal_images_find(verdict, "fireflies").place.x, 99 % SIDE);
    assert_int_equal(normal_images_find(verdict, "reference-fireflies").place.x, 77 % SIDE);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* ---- what cannot be told ---- */

static void detection_that_was_asked(void **state)
{
    assay_image *c         = normal_images_make(*state, 9, 0.5, 64),
                *r         = normal_images_make(*state, 10, 0.5, 256);
    assay_verify_options o = assay_verify_options_default();
    /* visible: 4.22 sqrt(0.0049 / 4096) / 1.25 = 0.37 percent */
    o.detect = 0.005;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_PASS);
    o.detect = 0.002;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_CANNOT_TELL);
    /* in a tile 4 times as much, and a larger quantile: 5.0 sqrt(0.0049 / 256) / 1.25 = 1.7 */
    o.detect      = NAN;
    o.detect_tile = 0.025;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_PASS);
    o.detect_tile = 0.012;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_CANNOT_TELL);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* visible, as above: 0.0074 sigma of the mean */
static void black_would_have_passed(void **state)
{
    static const struct {
        double             sigma;
        assay_verdict_kind kind;
    } CASES[] = {{100.0, ASSAY_VERDICT_PASS}, {200.0, ASSAY_VERDICT_CANNOT_TELL}};
    for (int i = 0; i < 2; i++) {
        assay_image *c               = normal_images_make(*state, 9, CASES[i].sigma, 64),
                    *r               = normal_images_make(*state, 10, CASES[i].sigma, 256);
        const assay_verify_options o = assay_verify_options_default();
        assert_int_equal(normal_images_kind(*state, c, r, &o), CASES[i].kind);
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

/* ---- rounding ---- */

/* The same constant, in pixels without noise, but for the last bits: no difference.  One more bit
 * of a thousand is one. */
static void rounding_is_no_difference(void **state)
{
    assay_image *c = normal_images_make(*state, 1, 0.0, 64),
                *r = normal_images_make(*state, 2, 0.0, 256);
    for (int i = 0; i < PIXELS; i++) {
        normal_images_values(c, "R")[i] *= 1.0F + 0x1p-23F;
    }
    assert_int_equal(normal_images_kind(*state, c, r, NULL), ASSAY_VERDICT_PASS);
    for (int i = 0; i < PIXELS; i++) {
        normal_images_values(c, "R")[i] *= 1.0F + 0x1p-13F;
    }
    assay_verdict *verdict = normal_images_verify(*state, c, r, NULL);
    assert_int_equal(assay_verdict_whole(verdict), ASSAY_VERDICT_FAIL);
    assert_true(isinf(normal_images_find(verdict, "whole").in_bounds) &&
                normal_images_find(verdict, "whole").p == 0.0);
    assay_verdict_destroy(verdict);
    assay_verify_options o = assay_verify_options_default();
    o.precision            = ASSAY_PRECISION_HALF;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_PASS);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* ---- the order of stages, and the same bits ---- */

static void stages_in_the_lights_order(void **state)
{
    static const char *const NAMES[] = {"R", "Direct.G", "Irradiance.B", "IrradianceDirect.B"};
    assay_image             *images[2];
    for (int k = 0; k < 2; k++) {
        assay_image *from = normal_images_make(*state, 20 + (uint64_t)k, 0.5, 64);
        assert_int_equal(assay_image_create(*state, SIDE, SIDE, &images[k]), ASSAY_OK);
        for (int i = 0; i < 4; i++) {
            char variance[40];
            snprintf(variance, sizeof variance, "Variance.%s", NAMES[i]);
            memcpy(normal_images_add(images[k], NAMES[i]), normal_images_values(from, "R"),
                   sizeof(float) * PIXELS);
            memcpy(normal_images_add(images[k], variance), normal_images_values(from, "Variance.R"),
                   sizeof(float) * PIXELS);
            for (int p = 0; k == 1 && p < PIXELS; p++) {
                normal_images_values(images[k], NAMES[i])[p] *= i < 3 ? 2.0F : 1.0F;
            }
        }
        assay_image_destroy(from);
    }
    assay_verdict      *verdict = normal_images_verify(*state, images[0], images[1], NULL);
    const assay_finding first   = assay_verdict_at(verdict, assay_verdict_first(verdict));
    assert_string_equal(assay_verdict_at(verdict, 0).array, "IrradianceDirect.B");
    assert_string_equal(first.array, "Irradiance.B");
    assert_string_equal(first.stage, "irradiance");
    assay_verdict_destroy(verdict);
    assay_image_destroy(images[0]);
    assay_image_destroy(images[1]);
}

static char *json_with_threads(int threads)
{
    const assay_context_options options = {.threads = threads};
    assay_context              *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    assay_image *c = normal_images_make(context, 30, 0.5, 64),
                *r = normal_images_make(context, 31, 0.5, 64);
    for (int i = 0; i < PIXELS; i++) {
        normal_images_values(c, "R")[i] += i % 7 == 0 ? 0.3F : 0.0F;
    }
    assay_verdict *verdict = normal_images_verify(context, c, r, NULL);
    char          *text = NULL, *copy = NULL;
    assert_int_equal(assay_verdict_json(verdict, &text), ASSAY_OK);
    copy = strdup(text);
    assay_text_destroy(context, text);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
    assay_context_destroy(context);
    return copy;
}

static void same_for_any_threads(void **state)
{
    char *one = json_with_threads(1), *five = json_with_threads(5);
    assert_string_equal(one, five);
    free(one);
    free(five);
    (void)state;
}

/* Holm names fewer pixels than Benjamini and Hochberg, of the same images. */
static void corrections(void **state)
{
    assay_image *c = normal_images_make(*state, 40, 0.5, 64),
                *r = normal_images_make(*state, 41, 0.5, 256);
    for (int i = 0; i < PIXELS; i += 5) {
        normal_images_values(c, "R")[i] += i % 2 ? 0.3F : -0.3F;
    }
    assay_verify_options o = assay_verify_options_default();
    o.correction           = ASSAY_CORRECTION_BH;
    assay_verdict *holm    = normal_images_verify(*state, c, r, NULL),
                  *bh      = normal_images_verify(*state, c, r, &o);
    assert_true(normal_images_find(bh, "welch").bound <
                0.95 * normal_images_find(holm, "welch").bound);
    assert_string_equal(assay_verdict_get(bh, "correction"), "bh");
    assay_verdict_destroy(holm);
    assay_verdict_destroy(bh);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(same_light_passes, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(whole_by_hand, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(leak_in_one_tile, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(rare_light_missed, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(one_pixel, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(edge_of_few_samples, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(firefly_is_told, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(black_would_have_passed, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(detection_that_was_asked, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(rounding_is_no_difference, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(stages_in_the_lights_order, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(same_for_any_threads),
        cmocka_unit_test_setup_teardown(corrections, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
