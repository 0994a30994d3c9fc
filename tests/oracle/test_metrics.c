/* test_metrics.c - SSIM against closed forms and its definition, the colour map, errors of colours.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "assay/compare.h"
#include "assay/metrics.h"
#include "io/srgb_encode.h"
#include "support/failing_context.h"
#include "support/near.h"
#include "support/pictures.h"

static double ssim(const assay_image *a, const assay_image *b, double exposure)
{
    assay_metrics_options options = assay_metrics_defaults();
    double                value   = -7.0;
    options.exposure              = exposure;
    assert_int_equal(assay_image_ssim(a, b, &options, &value), ASSAY_OK);
    return value;
}

static long double encoded(long double linear)
{
    const long double x = fminl(fmaxl(linear, 0.0L), 1.0L);
    return x <= 0.0031308L ? 12.92L * x : 1.055L * powl(x, 1.0L / 2.4L) - 0.055L;
}

/* Without variance, [wang04]'s comparison of means is left. */
static void ssim_of_constants(void **state)
{
    static const double LUMA[2] = {0.25, 0.0625};
    assay_image        *a       = picture_constant(*state, 30, 20, LUMA[0], LUMA[0], LUMA[0]);
    assay_image        *b       = picture_constant(*state, 30, 20, LUMA[1], LUMA[1], LUMA[1]);
    for (int stops = 0; stops <= 3; stops += 3) {
        const long double x = encoded(ldexpl(0.25L, stops)), y = encoded(ldexpl(0.0625L, stops));
        const long double expected = (2.0L * x * y + 1e-4L) / (x * x + y * y + 1e-4L);
        assert_near(ssim(a, b, stops), (double)expected, 1e-12);
    }
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* Red is seen as the luma of its luminance. */
static void ssim_looks_at_luminance(void **state)
{
    assay_image *a = picture_constant(*state, 11, 11, 1.0, 0.0, 0.0);
    assay_image *b = picture_constant(*state, 11, 11, 0.2126, 0.2126, 0.2126);
    assert_near(ssim(a, b, 0.0), 1.0, 1e-9);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void ssim_of_equal_pictures_is_one(void **state)
{
    assay_image *a = picture_random(*state, 300, 40, 2.0, 1);
    assert_near(ssim(a, a, -0.5), 1.0, 0.0);
    assay_image_destroy(a);
}

static void ssim_needs_a_window(void **state)
{
    assay_image *a = picture_constant(*state, 10, 30, 1.0, 1.0, 1.0);
    assert_true(isnan(ssim(a, a, 0.0)));
    assay_image_destroy(a);
}

static long double luma(const assay_image *image, int i)
{
    return encoded(0.2126L * (long double)picture_channel(image, "R")[i] +
                   0.7152L * (long double)picture_channel(image, "G")[i] +
                   0.0722L * (long double)picture_channel(image, "B")[i]);
}

/* One window by [wang04] eqs. 13 to 16: weighted means, then weighted deviations from them. */
static long double window(const long double *a, const long double *b, int width)
{
    long double sum = 0.0L, means[2] = {0.0L, 0.0L}, aa = 0.0L, bb = 0.0L, ab = 0.0L;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < 121; i++) {
            const int         x = i % 11, y = i / 11, at = y * width + x;
            const long double w =
                expl(-(long double)((x - 5) * (x - 5) + (y - 5) * (y - 5)) / 4.5L);
            if (pass == 0) {
                sum += w;
                means[0] += w * a[at];
                means[1] += w * b[at];
            } else {
                aa += w / sum * (a[at] - means[0]) * (a[at] - means[0]);
                bb += w / sum * (b[at] - means[1]) * (b[at] - means[1]);
                ab += w / sum * (a[at] - means[0]) * (b[at] - means[1]);
            }
        }
        means[0] /= pass == 0 ? sum : 1.0L;
        means[1] /= pass == 0 ? sum : 1.0L;
    }
    return (2.0L * means[0] * means[1] + 1e-4L) * (2.0L * ab + 9e-4L) /
           ((means[0] * means[0] + means[1] * means[1] + 1e-4L) * (aa + bb + 9e-4L));
}

/* All windows of a picture of more than one tile. */
static void ssim_by_the_definition(void **state)
{
    enum { WIDTH = 147, HEIGHT = 141 };
    static long double a[WIDTH * HEIGHT], b[WIDTH * HEIGHT];
    assay_image       *p   = picture_random(*state, WIDTH, HEIGHT, 1.2, 2);
    assay_image       *q   = picture_random(*state, WIDTH, HEIGHT, 1.0, 3);
    long double        sum = 0.0L;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        a[i] = luma(p, i);
        b[i] = luma(q, i);
    }
    for (int y = 0; y + 11 <= HEIGHT; y++) {
        for (int x = 0; x + 11 <= WIDTH; x++) {
            sum += window(a + y * WIDTH + x, b + y * WIDTH + x, WIDTH);
        }
    }
    const double expected = (double)(sum / ((WIDTH - 10) * (HEIGHT - 10)));
    assert_true(expected > 0.1 && expected < 0.9);
    assert_near(ssim(p, q, 0.0), expected, 1e-12);
    assert_true(ssim(p, q, 0.0) == ssim(q, p, 0.0));
    assay_image_destroy(p);
    assay_image_destroy(q);
}

static void ssim_is_the_same_for_all_threads(void **state)
{
    (void)state;
    double values[2];
    for (int i = 0; i < 2; i++) {
        const assay_context_options threads = {.threads = i ? 5 : 1};
        assay_context              *context = NULL;
        assert_int_equal(assay_context_create(&threads, &context), ASSAY_OK);
        assay_image *a = picture_random(context, 400, 300, 1.2, 4);
        assay_image *b = picture_random(context, 400, 300, 1.2, 5);
        values[i]      = ssim(a, b, 0.0);
        assay_image_destroy(a);
        assay_image_destroy(b);
        assay_context_destroy(context);
    }
    assert_true(values[0] == values[1]);
}

static void ssim_refuses_what_is_no_picture(void **state)
{
    const assay_metrics_options options = assay_metrics_defaults();
    double                      value   = -7.0;
    assay_image                *a       = picture_constant(*state, 12, 12, 1.0, 1.0, 1.0);
    assay_image                *b       = picture_constant(*state, 12, 12, 1.0, 1.0, 1.0);
    picture_channel(b, "R")[13]         = INFINITY;
    assert_int_equal(assay_image_ssim(a, b, &options, &value), ASSAY_ERR_DOMAIN);
    assert_non_null(strstr(assay_context_error(*state),
                           "the candidate's channel \"R\" is infinite at pixel (1, 1)"));
    assert_true(value == -7.0);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* Any float channel counts, whole numbers do not. */
static void values_that_are_not_finite_are_named(void **state)
{
    assay_image  *a = picture_constant(*state, 3, 2, 1.0, 1.0, 1.0);
    assay_channel numbers;
    assert_int_equal(assay_image_add_channel(a, "SampleCount", ASSAY_CHANNEL_UINT, &numbers),
                     ASSAY_OK);
    numbers.data.u32[0] = 0xffffffffu;
    assert_int_equal(assay_image_check_finite(a), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(a, "Z", ASSAY_CHANNEL_FLOAT, NULL), ASSAY_OK);
    picture_channel(a, "Z")[5] = NAN;
    assert_int_equal(assay_image_check_finite(a), ASSAY_ERR_DOMAIN);
    assert_non_null(strstr(assay_context_error(*state), "channel \"Z\" is NaN at pixel (2, 1)"));
    assay_image_destroy(a);
}

/* ---- errors of colours ---- */

/* R: 1 against 2, G: 3 against 3, B: 0 against 1/2 in one of two pixels. */
static void colors_by_hand(void **state)
{
    assay_image           *a          = picture_constant(*state, 2, 1, 1.0, 3.0, 0.0);
    assay_image           *b          = picture_constant(*state, 2, 1, 2.0, 3.0, 0.0);
    assay_comparison      *comparison = NULL;
    assay_color_difference d          = {0};
    picture_channel(a, "B")[0]        = 1.0F;
    picture_channel(b, "B")[0]        = 1.0F;
    picture_channel(b, "B")[1]        = 0.5F;
    assert_int_equal(assay_image_compare(a, b, &comparison), ASSAY_OK);
    assert_false(assay_comparison_color(comparison, "Indirect", &d));
    assert_true(assay_comparison_color(comparison, "", &d));
    assert_near(d.mean_a, (1.0 + 3.0 + 0.5) / 3.0, 1e-15);
    assert_near(d.mean_error, (1.0 + 0.0 + 0.25) / 3.0, 1e-15);
    assert_near(d.mse, (1.0 + 0.0 + 0.125) / 3.0, 1e-15);
    assert_near(d.rmse, sqrt(1.125 / 3.0), 1e-15);
    assert_near(d.relative_mse, (1.0 / 1.01 + 0.5 * 0.25 / 0.01) / 3.0, 1e-14);
    assert_near(d.relative_rmse, sqrt((1.0 / 1.01 + 0.5 * 0.25 / (0.01 * 0.25)) / 3.0), 1e-14);
    assay_comparison_destroy(comparison);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* ---- the colour map ---- */

static void code_at(const assay_image *picture, int i, int code[3])
{
    static const char *const NAMES[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        code[c] = assay_srgb_encode8((double)picture_channel(picture, NAMES[c])[i]);
    }
}

/* Five of the published entries, times 255; NaN and what is outside go to the ends. */
static void magma_is_as_published(void **state)
{
    static const struct {
        float  value;
        double rgb[3];
    } CASES[] = {{0.0F, {0.001462, 0.000466, 0.013866}},
                 {64.0F / 255.0F, {0.316654, 0.071690, 0.485380}},
                 {128.0F / 255.0F, {0.716387, 0.214982, 0.475290}},
                 {200.0F / 255.0F, {0.992785, 0.594891, 0.410283}},
                 {1.0F, {0.987053, 0.991438, 0.749504}},
                 {-3.0F, {0.001462, 0.000466, 0.013866}},
                 {NAN, {0.001462, 0.000466, 0.013866}},
                 {INFINITY, {0.987053, 0.991438, 0.749504}}};
    enum { COUNT = sizeof CASES / sizeof CASES[0] };
    assay_image *map = NULL, *picture = NULL;
    assert_int_equal(assay_image_create(*state, COUNT, 1, &map), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(map, "FLIP", ASSAY_CHANNEL_FLOAT, NULL), ASSAY_OK);
    for (int i = 0; i < COUNT; i++) {
        picture_channel(map, "FLIP")[i] = CASES[i].value;
    }
    assert_int_equal(assay_image_magma(map, "FLIP", 0.0, 1.0, &picture), ASSAY_OK);
    for (int i = 0; i < COUNT; i++) {
        int code[3];
        code_at(picture, i, code);
        for (int c = 0; c < 3; c++) {
            assert_int_equal(code[c], (int)(255.0 * CASES[i].rgb[c] + 0.5));
        }
    }
    assay_image_destroy(picture);
    picture = NULL;
    assert_int_equal(assay_image_magma(map, "FLIP", 1.0, 1.0, &picture), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_magma(map, "FLIP", 0.0, INFINITY, &picture), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_magma(map, "R", 0.0, 1.0, &picture), ASSAY_ERR_ARGUMENT);
    assert_null(picture);
    assay_image_destroy(map);
}

/* Lighter and lighter, in steps that are alike. */
static void magma_is_ordered_by_lightness(void **state)
{
    assay_image *map = NULL, *picture = NULL;
    double       last = -1.0;
    assert_int_equal(assay_image_create(*state, 256, 1, &map), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(map, "X", ASSAY_CHANNEL_FLOAT, NULL), ASSAY_OK);
    for (int i = 0; i < 256; i++) {
        picture_channel(map, "X")[i] = (float)(10.0 + i / 255.0);
    }
    assert_int_equal(assay_image_magma(map, "X", 10.0, 11.0, &picture), ASSAY_OK);
    for (int i = 0; i < 256; i++) {
        const double y = 0.2126729 * (double)picture_channel(picture, "R")[i] +
                         0.7151522 * (double)picture_channel(picture, "G")[i] +
                         0.0721750 * (double)picture_channel(picture, "B")[i];
        const double l = y > 216.0 / 24389.0 ? 116.0 * cbrt(y) - 16.0 : y * 24389.0 / 27.0;
        assert_true(l >= last - 0.35 && l < (last < 0.0 ? 1.0 : last + 1.0)); /* 8-bit codes */
        last = l;
    }
    assert_true(last > 95.0);
    assay_image_destroy(picture);
    assay_image_destroy(map);
}

static assay_status measure(assay_context *context, void *user)
{
    const assay_metrics_options options = assay_metrics_defaults();
    assay_image                *a = NULL, *picture = NULL;
    double                      value;
    (void)user;
    assay_status status = assay_image_create(context, 12, 13, &a);
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        static const char *const NAMES[3] = {"R", "G", "B"};
        status = assay_image_add_channel(a, NAMES[c], ASSAY_CHANNEL_FLOAT, NULL);
    }
    if (status == ASSAY_OK) {
        status = assay_image_ssim(a, a, &options, &value);
    }
    if (status == ASSAY_OK) {
        status = assay_image_magma(a, "R", 0.0, 1.0, &picture);
    }
    assay_image_destroy(a);
    assay_image_destroy(picture);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_true(failing_each(measure, NULL) > 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(ssim_of_constants, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(ssim_looks_at_luminance, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(ssim_of_equal_pictures_is_one, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(ssim_needs_a_window, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(ssim_by_the_definition, counted_set_up, counted_tear_down),
        cmocka_unit_test(ssim_is_the_same_for_all_threads),
        cmocka_unit_test_setup_teardown(ssim_refuses_what_is_no_picture, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(values_that_are_not_finite_are_named, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(colors_by_hand, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(magma_is_as_published, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(magma_is_ordered_by_lightness, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
