/* test_verify_variance.c - variances that are too large are told, those that are right are not,
 * whatever the noise. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assay/verify.h"
#include "oracle/image/verify_variance.h"
#include "support/failing_context.h"
#include "support/noise_pool.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

static void scale(assay_image *image, const char *name, float factor)
{
    float *values = normal_images_values(image, name);
    for (int i = 0; i < assay_image_width(image) * assay_image_height(image); i++) {
        values[i] *= factor;
    }
}

/* The review's case: a bias of 5 percent hides in a variance that is 100 times what it should be.
 * E[d^2] of a pixel: v + 0.0039 by the bias of 0.0625, with v = 0.25 / 64 + 0.25 / 256 = 0.0049;
 * the variances say 0.3916. */
static void too_large_a_variance_is_told(void **state)
{
    assay_image *c = normal_images_make(*state, 1, 0.5, 64),
                *r = normal_images_make(*state, 2, 0.5, 256);
    char *text = NULL, *json = NULL;
    scale(c, "R", 1.05F);
    assert_int_equal(normal_images_kind(*state, c, r, NULL), ASSAY_VERDICT_FAIL);
    scale(c, "Variance.R", 100.0F);
    assay_verdict *verdict = normal_images_verify(*state, c, r, NULL);
    const char    *said    = assay_verdict_get(verdict, "variances");
    assert_non_null(said);
    assert_int_equal(strncmp(said, "Squared differences in R are ", 29), 0);
    const double times = strtod(said + 29, NULL);
    assert_true(times > 35.0 && times < 55.0);
    assert_int_equal(assay_verdict_paragraph(verdict, &text), ASSAY_OK);
    assert_non_null(strstr(text, said));
    assert_int_equal(assay_verdict_json(verdict, &json), ASSAY_OK);
    assert_non_null(strstr(json, said));
    assay_text_destroy(*state, text);
    assay_text_destroy(*state, json);
    assay_verdict_destroy(verdict);
    /* Within an allowance such a variance hides nothing. */
    assay_verify_options o = assay_verify_options_default();
    o.allow                = 0.5;
    verdict                = normal_images_verify(*state, c, r, &o);
    assert_null(assay_verdict_get(verdict, "variances"));
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* 3 times is not told, 6 is: of 64 x 64 normal pixels the median of 16 tiles errs by 3 percent. */
static void where_it_begins(void **state)
{
    for (int times = 3; times <= 6; times += 3) {
        assay_image *c = normal_images_make(*state, 3, 0.5, 64),
                    *r = normal_images_make(*state, 4, 0.5, 64);
        scale(c, "Variance.R", (float)times);
        scale(r, "Variance.R", (float)times);
        assay_verdict *verdict = normal_images_verify(*state, c, r, NULL);
        assert_int_equal(assay_verdict_get(verdict, "variances") != NULL, times == 6);
        assay_verdict_destroy(verdict);
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

static void no_difference_at_all(void **state)
{
    assay_image   *c       = normal_images_make(*state, 5, 0.5, 64);
    assay_verdict *verdict = normal_images_verify(*state, c, c, NULL);
    const char    *said    = assay_verdict_get(verdict, "variances");
    assert_non_null(said);
    assert_non_null(strstr(said, "no differences in R"));
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
}

/* Fireflies with a right variance, in a third of the tiles, do not hide that all others' are wrong;
 * and pixels of which both images happened to see the same large samples do not make it wrong. */
static void fireflies_neither_hide_nor_alarm(void **state)
{
    for (int kind = 0; kind < 2; kind++) {
        assay_image *c = normal_images_make(*state, 6, 0.5, 64),
                    *r = normal_images_make(*state, 7, 0.5, 256);
        if (kind == 0) {
            scale(c, "Variance.R", 100.0F);
        }
        for (int tile = 0; tile < 16; tile += 3) {
            const int i = tile / 4 * 16 * SIDE + tile % 4 * 16 + 5 * SIDE + 5;
            normal_images_values(c, "R")[i] += 1000.0F;
            normal_images_values(c, "Variance.R")[i] = 1e6F;
            if (kind == 1) {
                normal_images_values(r, "R")[i] += 1000.0F;
                normal_images_values(r, "Variance.R")[i] = 1e6F;
            }
        }
        assay_verdict *verdict = normal_images_verify(*state, c, r, NULL);
        assert_int_equal(assay_verdict_get(verdict, "variances") != NULL, kind == 0);
        assay_verdict_destroy(verdict);
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

static double excess_of(assay_context *context, const assay_image *c, const assay_image *r)
{
    const assay_noisy_pair pair = {
        .width     = assay_image_width(c),
        .height    = assay_image_height(c),
        .candidate = {.mean     = normal_images_values(c, "R"),
                      .variance = normal_images_values(c, "Variance.R")},
        .reference = {.mean     = normal_images_values(r, "R"),
                      .variance = normal_images_values(r, "Variance.R")}};
    assay_tile_sums sums;
    double          excess = NAN;
    assert_int_equal(assay_tile_sums_make(context, &pair, 8, &sums), ASSAY_OK);
    assert_int_equal(assay_variance_excess(context, &sums.levels[0], &excess), ASSAY_OK);
    assay_tile_sums_release(&sums);
    return excess;
}

/* Skewed noise of every kind and few samples: variances as they are estimated are never told, those
 * that are 100 times as large always. */
static void any_noise(void **state)
{
    static const int SAMPLES[] = {2, 4, 16, 64};
    for (int kind = 0; kind < NOISE_KINDS; kind++) {
        noise_pool *pool = noise_pool_made_up((noise_kind)kind, 48);
        for (int s = 0; s < 4; s++) {
            for (uint64_t n = 0; n < 10; n++) {
                assay_image *c =
                    noise_pool_draw(*state, pool, SAMPLES[s], 100 * n + 1, DEFECT_NONE);
                assay_image *r     = noise_pool_draw(*state, pool, 64, 100 * n + 2, DEFECT_NONE);
                const double right = excess_of(*state, c, r);
                scale(c, "Variance.R", 100.0F);
                scale(r, "Variance.R", 100.0F);
                const double wrong = excess_of(*state, c, r);
                if (!(right < 2.0 && wrong > 50.0)) {
                    fail_msg("noise %d, %d samples: %.3g, and 100 times as large %.3g", kind,
                             SAMPLES[s], right, wrong);
                }
                assay_image_destroy(c);
                assay_image_destroy(r);
            }
        }
        noise_pool_free(pool);
    }
}

/* Less than four tiles with noise tell nothing. */
static void too_few_tiles(void **state)
{
    assay_noisy_sums tiles[5];
    assay_tile_level level = {.count = 5, .sums = tiles};
    double           excess;
    for (int noisy = 3; noisy <= 4; noisy++) {
        memset(tiles, 0, sizeof tiles);
        for (int i = 0; i < noisy; i++) {
            tiles[i].candidate_variance = 3.0;
            tiles[i].reference_variance = 5.0;
            tiles[i].squares            = 0.5 + i;
        }
        assert_int_equal(assay_variance_excess(*state, &level, &excess), ASSAY_OK);
        assert_true(noisy == 3 ? isnan(excess) : fabs(excess - 8.0 / 2.5) < 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(too_large_a_variance_is_told, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(where_it_begins, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(no_difference_at_all, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(fireflies_neither_hide_nor_alarm, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(any_noise, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(too_few_tiles, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
