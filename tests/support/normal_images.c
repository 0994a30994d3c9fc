/* normal_images.c - drawn by the Box-Muller transform, a stream a pixel. */
#include "support/normal_images.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "core/numerics.h"
#include "core/random.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

double normal_images_deviate(uint64_t seed, uint64_t pixel)
{
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, pixel, 0);
    const double u = assay_random_next(&random), v = assay_random_next(&random);
    return sqrt(-2.0 * assay_log1p(-u)) * assay_cos(ASSAY_TWO_PI * v);
}

float *normal_images_add(assay_image *image, const char *name)
{
    assay_channel channel;
    assert_int_equal(assay_image_add_channel(image, name, ASSAY_CHANNEL_FLOAT, &channel), ASSAY_OK);
    return channel.data.f32;
}

float *normal_images_values(const assay_image *image, const char *name)
{
    assay_channel channel;
    assert_true(assay_image_find_channel(image, name, &channel));
    return channel.data.f32;
}

double normal_images_light(int i) { return 1.0 + 0.5 * (i % SIDE) / SIDE; }

/* R alone, of `samples` samples whose deviation is `sigma`; the variance is exact.  samples 0: no
 * count. */
assay_image *normal_images_make(assay_context *context, uint64_t seed, double sigma, int samples)
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(context, SIDE, SIDE, &image), ASSAY_OK);
    float *r = normal_images_add(image, "R"), *variance = normal_images_add(image, "Variance.R");
    const double n = samples ? samples : 100;
    for (int i = 0; i < PIXELS; i++) {
        r[i]        = (float)(normal_images_light(i) +
                       sigma / sqrt(n) * normal_images_deviate(seed, (uint64_t)i));
        variance[i] = (float)(sigma * sigma / n);
    }
    if (samples) {
        assay_channel count;
        assert_int_equal(assay_image_add_channel(image, "SampleCount", ASSAY_CHANNEL_UINT, &count),
                         ASSAY_OK);
        for (int i = 0; i < PIXELS; i++) {
            count.data.u32[i] = (uint32_t)samples;
        }
    }
    return image;
}

assay_verdict *normal_images_verify(assay_context *context, const assay_image *candidate,
                                    const assay_image          *reference,
                                    const assay_verify_options *options)
{
    const assay_verify_options usual   = assay_verify_options_default();
    assay_verdict             *verdict = NULL;
    assert_int_equal(assay_verdict_create(context, "c", "r", &verdict), ASSAY_OK);
    assert_int_equal(
        assay_verify_images(&candidate, 1, reference, options ? options : &usual, verdict),
        ASSAY_OK);
    return verdict;
}

assay_finding normal_images_find(const assay_verdict *verdict, const char *test)
{
    for (int i = 0; i < assay_verdict_count(verdict); i++) {
        const assay_finding f = assay_verdict_at(verdict, i);
        if (strcmp(f.test, test) == 0) {
            return f;
        }
    }
    fail_msg("no finding of %s", test);
    return assay_finding_default();
}

assay_verdict_kind normal_images_kind(assay_context *context, assay_image *candidate,
                                      assay_image *reference, const assay_verify_options *options)
{
    assay_verdict           *verdict = normal_images_verify(context, candidate, reference, options);
    const assay_verdict_kind kind    = assay_verdict_whole(verdict);
    assay_verdict_destroy(verdict);
    return kind;
}
