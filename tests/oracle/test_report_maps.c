/* test_report_maps.c - maps and histograms against the definitions, pixel by pixel in long double.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "core/random.h"
#include "oracle/report/report_maps.h"
#include "support/failing_context.h"
#include "support/random_places.h"

enum { WIDTH = 23, HEIGHT = 11, PIXELS = WIDTH * HEIGHT };

static const char *const NAMES[3] = {"R", "G", "B"};

static assay_image *make_image(assay_context *context, uint64_t seed, bool with_noise)
{
    assay_image *image  = NULL;
    assay_random random = assay_random_start(seed, 0, 0, 0);
    assert_int_equal(assay_image_create(context, WIDTH, HEIGHT, &image), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        char          name[32];
        assay_channel value, variance;
        snprintf(name, sizeof name, "Variance.%s", NAMES[c]);
        assert_int_equal(assay_image_add_channel(image, NAMES[c], ASSAY_CHANNEL_FLOAT, &value),
                         ASSAY_OK);
        for (int i = 0; i < PIXELS; i++) {
            value.data.f32[i] = (float)random_in(&random, 0.5, 4.0);
        }
        if (with_noise) {
            assert_int_equal(assay_image_add_channel(image, name, ASSAY_CHANNEL_FLOAT, &variance),
                             ASSAY_OK);
            for (int i = 0; i < PIXELS; i++) {
                variance.data.f32[i] = (float)random_in(&random, 0.1, 1.0);
            }
        }
    }
    return image;
}

static float *plane(const assay_image *image, const char *name)
{
    assay_channel channel;
    return assay_image_find_channel(image, name, &channel) ? channel.data.f32 : NULL;
}

static uint64_t total(const assay_report_histogram *h)
{
    uint64_t sum = h->below + h->above + h->not_finite + h->equal;
    for (int i = 0; i < h->bins; i++) {
        sum += h->count[i];
    }
    return sum;
}

/* How many of the values a histogram's bin holds. */
static uint64_t inside(const assay_report_histogram *h, int bin, const double *values, int count)
{
    uint64_t n = 0;
    for (int i = 0; i < count; i++) {
        n += values[i] >= h->low + bin * h->step && values[i] < h->low + (bin + 1) * h->step;
    }
    return n;
}

static void check_maps(const assay_image *a, const assay_image *b, bool noise_a, bool noise_b,
                       const assay_report_maps *maps)
{
    double      z_values[3 * PIXELS], errors[3 * PIXELS];
    long double mean[3] = {0.0L, 0.0L, 0.0L};
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < PIXELS; i++) {
            mean[c] += plane(a, NAMES[c])[i] / (long double)PIXELS;
        }
    }
    for (int i = 0; i < PIXELS; i++) {
        long double difference = 0.0L, relative = 0.0L, worst = 0.0L;
        for (int c = 0; c < 3; c++) {
            char name[32];
            snprintf(name, sizeof name, "Variance.%s", NAMES[c]);
            const long double value = plane(a, NAMES[c])[i], d = plane(b, NAMES[c])[i] - value;
            const long double error = fabsl(d) / (value + 0.01L * mean[c]);
            const long double variance =
                (noise_a ? plane(a, name)[i] : 0.0L) + (noise_b ? plane(b, name)[i] : 0.0L);
            difference += d / 3.0L;
            relative += error / 3.0L;
            errors[3 * i + c]   = (double)log10l(error);
            z_values[3 * i + c] = (double)(d / sqrtl(variance));
            worst = fabsl(d / sqrtl(variance)) > fabsl(worst) ? d / sqrtl(variance) : worst;
        }
        assert_true(fabsl(maps->difference[i] - difference) <= 1e-6L);
        assert_true(fabsl(maps->relative[i] - relative) <= 1e-6L * relative);
        assert_true(!maps->z || fabsl(maps->z[i] - worst) <= 1e-6L * fabsl(worst));
    }
    assert_int_equal(total(&maps->relative_histogram), 3 * PIXELS);
    for (int bin = 0; bin < maps->relative_histogram.bins; bin++) {
        assert_int_equal(maps->relative_histogram.count[bin],
                         inside(&maps->relative_histogram, bin, errors, 3 * PIXELS));
    }
    for (int bin = 0; maps->z && bin < maps->z_histogram.bins; bin++) {
        assert_int_equal(maps->z_histogram.count[bin],
                         inside(&maps->z_histogram, bin, z_values, 3 * PIXELS));
    }
}

static void test_maps(void **state)
{
    for (int noise = 0; noise < 4; noise++) {
        assay_image *a = make_image(*state, 1, noise & 1), *b = make_image(*state, 2, noise & 2);
        assay_report_maps maps;
        assert_int_equal(assay_report_maps_create(*state, a, b, &maps), ASSAY_OK);
        assert_int_equal(maps.noise, noise);
        assert_true((maps.z != NULL) == (noise != 0));
        check_maps(a, b, noise & 1, noise & 2, &maps);
        assay_report_maps_release(*state, &maps);
        assay_image_destroy(a);
        assay_image_destroy(b);
    }
}

/* Of one sample nobody knows a variance; of two in one pixel somebody does. */
static void test_one_sample(void **state)
{
    for (unsigned most = 1; most <= 2; most++) {
        assay_image  *a = make_image(*state, 1, true), *b = make_image(*state, 2, false);
        assay_channel samples;
        assert_int_equal(assay_image_add_channel(a, "SampleCount", ASSAY_CHANNEL_UINT, &samples),
                         ASSAY_OK);
        for (int i = 0; i < PIXELS; i++) {
            samples.data.u32[i] = i == PIXELS - 1 ? most : 1;
        }
        assay_report_maps maps;
        assert_int_equal(assay_report_maps_create(*state, a, b, &maps), ASSAY_OK);
        assert_int_equal(maps.noise, most == 1 ? ASSAY_NOISE_NONE : ASSAY_NOISE_REFERENCE);
        assert_true((maps.z != NULL) == (most > 1));
        assay_report_maps_release(*state, &maps);
        assay_image_destroy(a);
        assay_image_destroy(b);
    }
}

static void test_equal_and_not_finite(void **state)
{
    assay_image      *a = make_image(*state, 1, true), *b = make_image(*state, 1, true);
    assay_report_maps maps;
    plane(b, "G")[7]          = NAN;
    plane(a, "R")[8]          = INFINITY;
    plane(b, "R")[9]          = -plane(a, "R")[9];
    plane(a, "Variance.R")[9] = plane(b, "Variance.R")[9] = 0.0F;
    assert_int_equal(assay_report_maps_create(*state, a, b, &maps), ASSAY_OK);
    assert_true(maps.difference[6] == 0.0F && maps.relative[6] == 0.0F && maps.z[6] == 0.0F);
    assert_true(isnan(maps.difference[7]) && isnan(maps.relative[7]) && isnan(maps.z[7]));
    assert_true(!isfinite(maps.difference[8]) && isnan(maps.relative[8]));
    assert_true(isinf(maps.z[9]) && maps.z[9] < 0.0F);
    assert_int_equal(maps.relative_histogram.equal, 3 * PIXELS - 3);
    assert_int_equal(maps.z_histogram.equal, 3 * PIXELS - 3);
    assert_int_equal(maps.relative_histogram.not_finite, 2);
    assert_int_equal(total(&maps.z_histogram), 3 * PIXELS);
    assay_report_maps_release(*state, &maps);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void test_luminance_and_exposure(void **state)
{
    assay_image           *image = make_image(*state, 3, false);
    assay_report_histogram h;
    for (int i = 0; i < PIXELS; i++) {
        /* Luminance 2^(i mod 8) and a little; mean of all channels known. */
        plane(image, "R")[i] = plane(image, "G")[i] = plane(image, "B")[i] =
            ldexpf(1.0625F, i % 8 - 4);
    }
    plane(image, "R")[0] = plane(image, "G")[0] = plane(image, "B")[0] = -1.0F;
    assay_report_luminance(image, &h);
    assert_int_equal(total(&h), PIXELS);
    assert_int_equal(h.below, 1);
    for (int e = -4; e < 4; e++) {
        const int n = PIXELS / 8 + (e + 4 < PIXELS % 8) - (e == -4);
        assert_int_equal(h.count[(int)((e - h.low) / h.step)], n);
    }
    for (int stops = -3; stops <= 3; stops++) {
        for (int i = 0; i < PIXELS; i++) {
            plane(image, "R")[i] = plane(image, "G")[i] = plane(image, "B")[i] =
                ldexpf(1.0F / 3.0F, -stops);
        }
        assert_true(assay_report_exposure(image) == stops);
    }
    for (int i = 0; i < PIXELS; i++) {
        plane(image, "R")[i] = plane(image, "G")[i] = plane(image, "B")[i] = 0.0F;
    }
    assert_true(assay_report_exposure(image) == 0.0);
    assay_image_destroy(image);
}

static assay_status work(assay_context *context, void *user)
{
    assay_report_maps  maps;
    assay_image      **images = user;
    const assay_status status = assay_report_maps_create(context, images[0], images[1], &maps);
    if (status == ASSAY_OK) {
        assay_report_maps_release(context, &maps);
    }
    return status;
}

static void test_memory(void **state)
{
    assay_image *images[2] = {make_image(*state, 1, true), make_image(*state, 2, true)};
    assert_int_equal(failing_each(work, images), 3);
    assay_image_destroy(images[0]);
    assay_image_destroy(images[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_maps, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_one_sample, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_equal_and_not_finite, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(test_luminance_and_exposure, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(test_memory, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
