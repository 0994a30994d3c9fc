/* test_compare.c - differences of images against hand-made cases and long double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assay/compare.h"
#include "core/random.h"
#include "io/heat_color.h"
#include "support/failing_context.h"
#include "support/near.h"

static float *add(assay_image *image, const char *name)
{
    assay_channel channel;
    assert_int_equal(assay_image_add_channel(image, name, ASSAY_CHANNEL_FLOAT, &channel), ASSAY_OK);
    return channel.data.f32;
}

static assay_image *make(assay_context *context, int width, int height)
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(context, width, height, &image), ASSAY_OK);
    return image;
}

static assay_channel_difference only_difference(const assay_image *a, const assay_image *b,
                                                bool *identical_out)
{
    assay_comparison *comparison = NULL;
    assert_int_equal(assay_image_compare(a, b, &comparison), ASSAY_OK);
    const assay_channel_difference d = assay_comparison_at(comparison, 0);
    *identical_out                   = assay_comparison_identical(comparison);
    assay_comparison_destroy(comparison);
    return d;
}

/* a = 1, 2, 3, 4, b = a + 1, 0, 0, -3: every number by hand. */
static void metrics_by_hand(void **state)
{
    assay_image *a = make(*state, 2, 2), *b = make(*state, 2, 2);
    float       *x = add(a, "R"), *y = add(b, "R");
    bool         identical;
    for (int i = 0; i < 4; i++) {
        x[i] = y[i] = (float)(i + 1);
    }
    y[0] += 1.0f;
    y[3] -= 3.0f;
    const assay_channel_difference d = only_difference(a, b, &identical);
    assert_false(identical);
    assert_string_equal(d.channel, "R");
    assert_int_equal(d.pixels, 4);
    assert_int_equal(d.differing, 2);
    assert_int_equal(d.not_finite, 0);
    assert_near(d.mean_a, 2.5, 0.0);
    assert_near(d.mean_b, 2.0, 0.0);
    assert_near(d.mean_error, -0.5, 0.0);
    assert_near(d.max_abs, 3.0, 0.0);
    assert_int_equal(d.max_x, 1);
    assert_int_equal(d.max_y, 1);
    assert_near(d.rmse, sqrt(10.0 / 4.0), 1e-15);
    assert_near(d.relative_rmse, sqrt((1.0 / 1.0625 + 9.0 / 16.0625) / 4.0), 1e-15);
    assert_true(isnan(d.z_rms));
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void nothing_differs_in_equal_images(void **state)
{
    assay_image *a = make(*state, 3, 1), *b = make(*state, 3, 1);
    float       *x = add(a, "R"), *y = add(b, "R");
    bool         identical;
    x[0] = y[0] = 0.0f;
    x[1] = y[1] = INFINITY;
    x[2] = y[2]                = NAN;
    assay_channel_difference d = only_difference(a, b, &identical);
    assert_true(identical);
    assert_int_equal(d.differing, 0);
    assert_int_equal(d.not_finite, 0);
    assert_int_equal(d.pixels, 1);
    assert_near(d.rmse, 0.0, 0.0);
    assert_near(d.relative_rmse, 0.0, 0.0);
    /* The sign of zero is a bit, but no difference in value. */
    y[0] = -0.0f;
    d    = only_difference(a, b, &identical);
    assert_false(identical);
    assert_int_equal(d.differing, 1);
    assert_near(d.max_abs, 0.0, 0.0);
    /* Another NaN is not "differing", but not identical. */
    y[0]                   = 0.0f;
    const uint32_t payload = 0x7fc00001u;
    memcpy(&y[2], &payload, sizeof payload);
    d = only_difference(a, b, &identical);
    assert_false(identical);
    assert_int_equal(d.differing, 0);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void values_that_are_not_finite_are_counted(void **state)
{
    static const float xs[]       = {NAN, 1.0f, INFINITY, INFINITY, -INFINITY, NAN, NAN, 2.0f};
    static const float ys[]       = {1.0f, NAN, -INFINITY, 1.0f, -INFINITY, NAN, INFINITY, 2.5f};
    const uint64_t     not_finite = 5;
    assay_image       *a = make(*state, 8, 1), *b = make(*state, 8, 1);
    bool               identical;
    memcpy(add(a, "R"), xs, sizeof xs);
    memcpy(add(b, "R"), ys, sizeof ys);
    const assay_channel_difference d = only_difference(a, b, &identical);
    assert_int_equal(d.not_finite, not_finite);
    assert_int_equal(d.pixels, 1);
    assert_int_equal(d.differing, 6);
    assert_near(d.max_abs, 0.5, 0.0);
    assert_int_equal(d.max_x, 7);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void no_finite_pixel_gives_no_numbers(void **state)
{
    assay_image *a = make(*state, 1, 1), *b = make(*state, 1, 1);
    bool         identical;
    add(a, "R")[0]                   = NAN;
    add(b, "R")[0]                   = 1.0f;
    const assay_channel_difference d = only_difference(a, b, &identical);
    assert_int_equal(d.pixels, 0);
    assert_int_equal(d.max_x, -1);
    assert_true(isnan(d.mean_a) && isnan(d.rmse) && isnan(d.mean_error) && isnan(d.relative_rmse));
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static double uniform_at(uint64_t item, uint32_t sample)
{
    assay_random random = assay_random_start(11, ASSAY_STAGE_TEST, item, sample);
    return assay_random_next(&random);
}

/* Two unbiased renders of the same pixels, whose variance is known: uniform noise of width w has
 * the variance w^2 / 12.  With a million pixels rms z is 1 within 4 standard errors of 0.0005; the
 * mutant's variance is 4 % too small. */
static void z_is_one_for_unbiased_renders(void **state)
{
    enum { SIDE = 1000 };
    assay_image *a = make(*state, SIDE, SIDE), *b = make(*state, SIDE, SIDE);
    float       *x = add(a, "Irradiance.R"), *y = add(b, "Irradiance.R");
    float       *vx = add(a, "Variance.Irradiance.R"), *vy = add(b, "Variance.Irradiance.R");
    bool         identical;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double width = 0.1 + (i % 7);
        x[i]               = (float)(100.0 + width * (uniform_at((uint64_t)i, 0) - 0.5));
        y[i]               = (float)(100.0 + width * (uniform_at((uint64_t)i, 1) - 0.5));
        vx[i] = vy[i] = (float)(width * width / 12.0);
    }
    vx[5] = vy[5]              = 0.0f; /* no variance, no verdict */
    assay_channel_difference d = only_difference(a, b, &identical);
    assert_near(d.z_rms, 1.0, 0.002);
    for (int i = 0; i < SIDE * SIDE; i++) {
        vx[i] *= 0.96f;
        vy[i] *= 0.96f;
    }
    d = only_difference(a, b, &identical);
    assert_true(fabs(d.z_rms - 1.0) > 0.002);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* Values over 16 magnitudes against sums in long double. */
static void sums_are_accurate(void **state)
{
    enum { COUNT = 50000 };
    assay_image *a = make(*state, COUNT, 1), *b = make(*state, COUNT, 1);
    float       *x = add(a, "R"), *y = add(b, "R");
    long double  sum_a = 0.0L, errors = 0.0L, squares = 0.0L;
    bool         identical;
    for (int i = 0; i < COUNT; i++) {
        x[i] =
            (float)((uniform_at((uint64_t)i, 2) - 0.5) * exp2(50.0 * uniform_at((uint64_t)i, 3)));
        y[i] = x[i] * 1.25f;
        sum_a += x[i];
        errors += (long double)y[i] - x[i];
        squares += ((long double)y[i] - x[i]) * ((long double)y[i] - x[i]);
    }
    const assay_channel_difference d = only_difference(a, b, &identical);
    assert_near(d.mean_a, (double)(sum_a / COUNT), 1e-12 * fabs((double)(sum_a / COUNT)));
    assert_near(d.mean_error, (double)(errors / COUNT), 1e-12 * fabs((double)(errors / COUNT)));
    assert_near(d.rmse, (double)sqrtl(squares / COUNT), 1e-14 * (double)sqrtl(squares / COUNT));
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void common_channels_are_compared(void **state)
{
    assay_image      *a = make(*state, 2, 1), *b = make(*state, 2, 1), *c = make(*state, 1, 2);
    assay_comparison *comparison = NULL;
    assay_channel     channel;
    add(a, "R");
    add(a, "G");
    add(a, "Z");
    add(b, "G");
    assert_int_equal(assay_image_compare(a, c, &comparison), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "2 x 1 and 1 x 2"));
    /* Whole numbers against floats: by value. */
    assert_int_equal(assay_image_add_channel(b, "Z", ASSAY_CHANNEL_UINT, &channel), ASSAY_OK);
    channel.data.u32[1] = 3;
    assert_int_equal(assay_image_compare(a, b, &comparison), ASSAY_OK);
    assert_int_equal(assay_comparison_count(comparison), 2);
    assert_string_equal(assay_comparison_at(comparison, 0).channel, "G");
    assert_string_equal(assay_comparison_at(comparison, 1).channel, "Z");
    assert_int_equal(assay_comparison_at(comparison, 1).differing, 1);
    assert_near(assay_comparison_at(comparison, 1).max_abs, 3.0, 0.0);
    assert_false(assay_comparison_identical(comparison));
    assay_comparison_destroy(comparison);
    assay_comparison_destroy(NULL);
    assay_image_destroy(b);
    b          = make(*state, 2, 1);
    comparison = NULL;
    add(b, "Y");
    assert_int_equal(assay_image_compare(a, b, &comparison), ASSAY_ERR_ARGUMENT);
    assert_null(comparison);
    assay_image_destroy(a);
    assay_image_destroy(b);
    assay_image_destroy(c);
}

/* CIELAB lightness of a linear sRGB colour. */
static double lightness(assay_rgb c)
{
    const double y = 0.2126729 * c.r + 0.7151522 * c.g + 0.0721750 * c.b;
    return y > 216.0 / 24389.0 ? 116.0 * cbrt(y) - 16.0 : y * 24389.0 / 27.0;
}

typedef assay_rgb (*color_scale)(double t);

static assay_rgb rainbow(double t)
{
    return (assay_rgb){fmax(0.0, 2.0 * t - 1.0), 1.0 - fabs(2.0 * t - 1.0),
                       fmax(0.0, 1.0 - 2.0 * t)};
}

/* L* = 100 t, and every colour one that sRGB has. */
static bool is_ordered(color_scale scale)
{
    for (int i = 0; i <= 1000; i++) {
        const double    t = i / 1000.0;
        const assay_rgb c = scale(t);
        if (!(fabs(lightness(c) - 100.0 * t) < 0.05) || fmin(fmin(c.r, c.g), c.b) < 0.0 ||
            fmax(fmax(c.r, c.g), c.b) > 1.0) {
            return false;
        }
    }
    return true;
}

static void the_scale_is_ordered_by_lightness(void **state)
{
    (void)state;
    assert_true(is_ordered(assay_heat_color));
    assert_false(is_ordered(rainbow));
    assert_near(assay_heat_color(-3.0).r, 0.0, 0.0);
    assert_near(assay_heat_color(NAN).g, 0.0, 0.0);
    assert_near(assay_heat_color(INFINITY).b, 1.0, 1e-3);
}

static void check_numbers(const assay_image *a, const assay_image *b, const double *errors)
{
    assay_image  *map = NULL;
    assay_channel channel;
    assert_int_equal(assay_image_relative_error(a, b, &map), ASSAY_OK);
    assert_true(assay_image_find_channel(map, "RelativeError", &channel));
    for (int i = 0; i < 4; i++) {
        assert_true(channel.data.f32[i] == (float)errors[i] ||
                    fabs((double)channel.data.f32[i] - errors[i]) < 1e-6);
    }
    assay_image_destroy(map);
}

/* Pixel i of the map must be the colour of the error at full scale 2. */
static void check_map(const assay_image *a, const assay_image *b, const double *errors)
{
    static const char *const names[] = {"R", "G", "B"};
    assay_image             *map     = NULL;
    check_numbers(a, b, errors);
    assert_int_equal(assay_image_heat_map(a, b, 2.0, &map), ASSAY_OK);
    assert_int_equal(assay_image_channel_count(map), 3);
    for (int i = 0; i < 4; i++) {
        const assay_rgb c = assay_heat_color(errors[i] / 2.0);
        for (int k = 0; k < 3; k++) {
            assay_channel channel;
            assert_true(assay_image_find_channel(map, names[k], &channel));
            assert_near((double)channel.data.f32[i], k == 0 ? c.r : k == 1 ? c.g : c.b, 1e-6);
        }
    }
    assay_image_destroy(map);
}

static void heat_maps_by_hand(void **state)
{
    assay_image *a = make(*state, 4, 1), *b = make(*state, 4, 1), *map = NULL;
    float       *x = add(a, "Z"), *y = add(b, "Z");
    /* mean of a is 2: the floor is 0.02 */
    x[0] = 1.0f, x[1] = 3.0f, x[2] = 4.0f, x[3] = 0.0f;
    y[0] = 2.0f, y[1] = 3.0f, y[2] = 0.0f, y[3] = 0.01f;
    const double one[] = {1.0 / 1.02, 0.0, 4.0 / 4.02, 0.5};
    check_map(a, b, one);
    /* With R, G and B only these count: R and G are alike, B is as Z. */
    for (int c = 0; c < 3; c++) {
        static const char *const names[] = {"R", "G", "B"};
        float                   *p = add(a, names[c]), *q = add(b, names[c]);
        for (int i = 0; i < 4; i++) {
            p[i] = x[i];
            q[i] = c == 2 ? y[i] : x[i];
        }
    }
    const double third[] = {one[0] / 3.0, 0.0, one[2] / 3.0, one[3] / 3.0};
    check_map(a, b, third);
    /* Not finite in one image: off the scale. */
    assay_channel blue;
    assert_true(assay_image_find_channel(b, "B", &blue));
    blue.data.f32[0]       = NAN;
    const double missing[] = {INFINITY, 0.0, 4.0 / (4.0 + 0.01 * 7.0 / 3.0) / 3.0,
                              0.01 / (0.01 * 7.0 / 3.0) / 3.0};
    check_map(a, b, missing);
    assert_int_equal(assay_image_heat_map(a, b, 0.0, &map), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_heat_map(a, b, NAN, &map), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_heat_map(a, b, INFINITY, &map), ASSAY_ERR_ARGUMENT);
    assay_image_destroy(b);
    b = make(*state, 4, 1);
    assert_int_equal(assay_image_heat_map(a, b, 1.0, &map), ASSAY_ERR_ARGUMENT);
    assert_null(map);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static assay_status compare_both(assay_context *context, void *user)
{
    assay_image      *a = NULL, *map = NULL;
    assay_comparison *comparison = NULL;
    (void)user;
    assay_status status = assay_image_create(context, 2, 2, &a);
    if (status == ASSAY_OK) {
        status = assay_image_add_channel(a, "R", ASSAY_CHANNEL_FLOAT, NULL);
    }
    if (status == ASSAY_OK) {
        status = assay_image_compare(a, a, &comparison);
    }
    if (status == ASSAY_OK) {
        status = assay_image_heat_map(a, a, 1.0, &map);
    }
    assay_image_destroy(a);
    assay_image_destroy(map);
    assay_comparison_destroy(comparison);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_int_equal(failing_each(compare_both, NULL), 4 + 2 + 2 + 1 + 7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(metrics_by_hand, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(nothing_differs_in_equal_images, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(values_that_are_not_finite_are_counted, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(no_finite_pixel_gives_no_numbers, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(z_is_one_for_unbiased_renders, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(sums_are_accurate, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(common_channels_are_compared, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(the_scale_is_ordered_by_lightness),
        cmocka_unit_test_setup_teardown(heat_maps_by_hand, counted_set_up, counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
