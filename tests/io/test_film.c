/* test_film.c - means and variances of pixels, and the layers they become. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "io/film.h"
#include "support/measure.h"

/* Samples 1, 2, 4, 9: mean 4, variance of the mean sum (x - 4)^2 / (4 * 3) = 38 / 12. */
static void mean_and_variance(void **state)
{
    (void)state;
    static const double SAMPLES[] = {1, 2, 4, 9};
    assay_context      *context   = measure_context(1);
    assay_film         *film      = NULL;
    assert_int_equal(assay_film_create(context, 2, 1, ASSAY_LAYERS_COLOR, &film), ASSAY_OK);
    for (int i = 0; i < 4; i++) {
        const double x = SAMPLES[i];
        assert_true(assay_film_add(film, 1, ASSAY_FILM_COLOR, rgb(x, 10.0 * x, -x)));
    }
    assert_int_equal(assay_film_samples(film, 1, ASSAY_FILM_COLOR), 4);
    assert_int_equal(assay_film_samples(film, 0, ASSAY_FILM_COLOR), 0);
    const assay_rgb mean     = assay_film_mean(film, 1, ASSAY_FILM_COLOR);
    const assay_rgb variance = assay_film_variance(film, 1, ASSAY_FILM_COLOR);
    assert_true(fabs(mean.r - 4.0) < 1e-14 && fabs(mean.g - 40.0) < 1e-13);
    assert_true(fabs(variance.r - 38.0 / 12.0) < 1e-14 && fabs(variance.b - 38.0 / 12.0) < 1e-14);
    assert_true(fabs(variance.g - 3800.0 / 12.0) < 1e-11);
    assay_film_destroy(film);
    assay_context_destroy(context);
}

/* A large offset must not swallow the variance (the textbook sum of squares would give garbage). */
static void variance_is_stable(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_film    *film    = NULL;
    assert_int_equal(assay_film_create(context, 1, 1, ASSAY_LAYERS_COLOR, &film), ASSAY_OK);
    for (int i = 0; i < 1000; i++) {
        assay_film_add(film, 0, ASSAY_FILM_COLOR, rgb_grey(1e9 + (i & 1)));
    }
    const double expected = 0.25 * 1000.0 / (1000.0 * 999.0);
    assert_true(fabs(assay_film_variance(film, 0, ASSAY_FILM_COLOR).r - expected) <
                1e-6 * expected);
    assay_film_destroy(film);
    assay_context_destroy(context);
}

static void not_finite_is_refused(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_film    *film    = NULL;
    assert_int_equal(assay_film_create(context, 1, 1, ASSAY_LAYERS_COLOR, &film), ASSAY_OK);
    assert_false(assay_film_add(film, 0, ASSAY_FILM_COLOR, rgb(NAN, 0, 0)));
    assert_false(assay_film_add(film, 0, ASSAY_FILM_DIRECT, rgb(0, INFINITY, 0)));
    assert_int_equal(assay_film_samples(film, 0, ASSAY_FILM_COLOR), 0);
    assay_film_destroy(film);
    assert_int_equal(assay_film_create(context, 65536, 65536, ASSAY_LAYERS_COLOR, &film),
                     ASSAY_ERR_LIMIT);
    assay_context_destroy(context);
}

/* Two pixels of luminance 1 and 3 with standard errors 0.1 and 0.3: (0.1 + 0.3) / 4.  Not known
 * while a pixel has less than two samples. */
static void relative_error(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_film    *film    = NULL;
    assert_int_equal(assay_film_create(context, 2, 1, ASSAY_LAYERS_COLOR, &film), ASSAY_OK);
    for (int s = -1; s <= 1; s += 2) { /* of two samples m +- d the standard error is d */
        assert_true(isnan(assay_film_relative_error(film)));
        assay_film_add(film, 0, ASSAY_FILM_COLOR, rgb_grey(1.0 + 0.1 * s));
        assert_true(isnan(assay_film_relative_error(film)));
        assay_film_add(film, 1, ASSAY_FILM_COLOR, rgb_grey(3.0 + 0.3 * s));
    }
    assert_true(fabs(assay_film_relative_error(film) - 0.1) < 1e-14);
    assay_film_destroy(film);
    assert_int_equal(assay_film_create(context, 2, 1, ASSAY_LAYERS_SPLIT, &film), ASSAY_OK);
    assert_true(isnan(assay_film_relative_error(film)));
    assay_film_destroy(film);
    assay_context_destroy(context);
}

static void layers(void **state)
{
    (void)state;
    static const struct {
        const char     *text;
        assay_layer_set set;
    } CASES[]               = {{NULL, ASSAY_LAYERS_ALL},
                               {"all", ASSAY_LAYERS_ALL},
                               {"color", ASSAY_LAYERS_COLOR},
                               {"split,gbuffer", ASSAY_LAYERS_SPLIT | ASSAY_LAYERS_GBUFFER},
                               {"irradiance,irradiance", ASSAY_LAYERS_IRRADIANCE}};
    assay_context  *context = measure_context(1);
    assay_layer_set set;
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        assert_int_equal(assay_layers_parse(context, CASES[i].text, &set), ASSAY_OK);
        assert_int_equal(set, CASES[i].set);
    }
    static const char *const BAD[] = {"", "colour", "color,", ",color", "color;split"};
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        assert_int_equal(assay_layers_parse(context, BAD[i], &set), ASSAY_ERR_ARGUMENT);
    }
    assay_context_destroy(context);
}

/* Only what was asked for is in the image, each with its variance. */
static void developing(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_film    *film    = NULL;
    assay_image   *image   = NULL;
    assay_channel  channel;
    assert_int_equal(
        assay_film_create(context, 2, 1, ASSAY_LAYERS_COLOR | ASSAY_LAYERS_GBUFFER, &film),
        ASSAY_OK);
    assay_film_add(film, 1, ASSAY_FILM_COLOR, rgb(1, 2, 3));
    assay_film_add(film, 1, ASSAY_FILM_COLOR, rgb(3, 2, 1));
    const assay_visible_point point = {.hit = true, .z = 7.0, .primitive = 9, .uv = {0.25, 0.5}};
    assay_film_set_visible(film, 1, &point);
    assert_int_equal(assay_film_develop(film, &image), ASSAY_OK);
    assert_true(assay_image_find_channel(image, "R", &channel));
    assert_true(channel.data.f32[1] == 2.0F && channel.data.f32[0] == 0.0F);
    assert_true(assay_image_find_channel(image, "Variance.B", &channel));
    assert_true(channel.data.f32[1] == 1.0F);
    assert_true(assay_image_find_channel(image, "SampleCount", &channel));
    assert_int_equal(channel.data.u32[1], 2);
    assert_true(assay_image_find_channel(image, "Z", &channel));
    assert_true(channel.data.f32[1] == 7.0F);
    assert_true(assay_image_find_channel(image, "PrimitiveId", &channel));
    assert_int_equal(channel.data.u32[1], 9);
    assert_true(assay_image_find_channel(image, "UV.V", &channel));
    assert_true(channel.data.f32[1] == 0.5F);
    assert_false(assay_image_find_channel(image, "Irradiance.R", NULL));
    assert_false(assay_image_find_channel(image, "Direct.R", NULL));
    assay_image_destroy(image);
    assay_film_destroy(film);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mean_and_variance),
        cmocka_unit_test(variance_is_stable),
        cmocka_unit_test(not_finite_is_refused),
        cmocka_unit_test(relative_error),
        cmocka_unit_test(layers),
        cmocka_unit_test(developing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
