/* pictures.c - the same pixels everywhere: whole-number noise of our own generator. */
#include "pictures.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/random.h"

static const char *const NAMES[3] = {"R", "G", "B"};

static assay_image *make(assay_context *context, int width, int height, float *channels[3])
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(context, width, height, &image), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(image, NAMES[c], ASSAY_CHANNEL_FLOAT, NULL),
                         ASSAY_OK);
        assert_true(assay_image_find_channel(image, NAMES[c], &channel));
        channels[c] = channel.data.f32;
    }
    return image;
}

assay_image *picture_constant(assay_context *context, int width, int height, double r, double g,
                              double b)
{
    const double values[3] = {r, g, b};
    float       *channels[3];
    assay_image *image = make(context, width, height, channels);
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < width * height; i++) {
            channels[c][i] = (float)values[c];
        }
    }
    return image;
}

assay_image *picture_random(assay_context *context, int width, int height, double scale,
                            unsigned seed)
{
    float       *channels[3];
    assay_image *image = make(context, width, height, channels);
    for (int i = 0; i < width * height; i++) {
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        const int    x = i % width, y = i / width;
        for (int c = 0; c < 3; c++) {
            const double block = (x / 5 + y / 7 + c) % 3 / 3.0;
            const double ramp  = (double)(x + y) / (width + height);
            channels[c][i] =
                (float)(scale * (0.4 * block + 0.3 * ramp + 0.3 * assay_random_next(&random)));
        }
    }
    return image;
}

assay_image *picture_primaries(assay_context *context, int width, int height, unsigned seed)
{
    float       *channels[3];
    assay_image *image = make(context, width, height, channels);
    for (int i = 0; i < width * height; i++) {
        const int    block  = i % width / 3 + 1000 * (i / width / 3);
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)block, 0);
        for (int c = 0; c < 3; c++) {
            channels[c][i] = assay_random_next(&random) < 0.5 ? 0.0F : 1.0F;
        }
    }
    return image;
}

float *picture_channel(const assay_image *image, const char *name)
{
    assay_channel channel;
    assert_true(assay_image_find_channel(image, name, &channel));
    assert_int_equal(channel.type, ASSAY_CHANNEL_FLOAT);
    return channel.data.f32;
}
