/* test_exr_memory.c - what an OpenEXR file may take: only wanted channels, never more than there
 * is, and who is to blame. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "io/image_data.h"
#include "io/image_decode.h"
#include "support/exr_files.h"
#include "support/temporary.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, CHANNELS = 6 };

static const char *const NAMES[CHANNELS] = {"A", "B", "G", "N.X", "R", "Z"};

/* Channel c of pixel i. */
static float value_of(int c, int i) { return (float)(c * 1000 + i % 97); }

static assay_context *limited(uint64_t limit)
{
    const assay_context_options options = {.threads = 1, .memory_limit = limit};
    assay_context              *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    return context;
}

static uint8_t *file_of(exr_compression_t compression, exr_attr_box2i_t display, size_t *count_out)
{
    static float  values[CHANNELS][PIXELS];
    exr_file_spec spec = {.width         = SIDE,
                          .height        = SIDE,
                          .compression   = compression,
                          .display       = display,
                          .channel_count = CHANNELS};
    for (int c = 0; c < CHANNELS; c++) {
        for (int i = 0; i < PIXELS; i++) {
            values[c][i] = value_of(c, i);
        }
        spec.channels[c] = (exr_file_channel){NAMES[c], EXR_PIXEL_FLOAT, values[c], 0};
    }
    return exr_file_bytes(&spec, count_out);
}

static const exr_attr_box2i_t WHOLE = {.max.x = SIDE - 1, .max.y = SIDE - 1};

static void only_wanted_channels_take_memory(void **state)
{
    (void)state;
    static const char *const wanted[] = {"R", "G", "B", "missing", NULL};
    size_t                   count    = 0;
    uint8_t                 *bytes    = file_of(EXR_COMPRESSION_ZIP, WHOLE, &count);
    assay_context           *context  = limited(UINT64_MAX);
    assay_image             *image    = NULL;
    assert_int_equal(assay_image_decode(context, bytes, count, "x", wanted, &image), ASSAY_OK);
    assert_in_range(assay_context_memory_used(context), 3 * PIXELS * 4, 4 * PIXELS * 4);
    assert_int_equal(assay_image_channel_count(image), 3);
    for (int c = 0; c < CHANNELS; c++) {
        assay_channel channel;
        const bool    there = assay_image_find_channel(image, NAMES[c], &channel);
        assert_int_equal(there, c == 1 || c == 2 || c == 4);
        for (int i = 0; there && i < PIXELS; i++) {
            assert_true(channel.data.f32[i] == value_of(c, i));
        }
    }
    assay_image_destroy(image);
    assert_int_equal(assay_image_decode(context, bytes, count, "x", NULL, &image), ASSAY_OK);
    assert_int_equal(assay_image_channel_count(image), CHANNELS);
    assert_true(assay_context_memory_used(context) > (uint64_t)CHANNELS * PIXELS * 4);
    assay_image_destroy(image);
    assay_context_destroy(context);
    free(bytes);
}

/* A display window of 2048 x 2048 makes 96 MiB of six channels, and 16 MiB of one. */
static void a_large_window_is_refused(void **state)
{
    (void)state;
    static const char *const wanted[] = {"Z", NULL};
    const exr_attr_box2i_t   window   = {.max.x = 2047, .max.y = 2047};
    size_t                   count    = 0;
    uint8_t                 *bytes    = file_of(EXR_COMPRESSION_ZIP, window, &count);
    assay_context           *context  = limited(UINT64_C(10) << 20);
    assay_image             *image    = NULL;
    assert_int_equal(assay_image_decode(context, bytes, count, "big.exr", NULL, &image),
                     ASSAY_ERR_MEMORY);
    assert_non_null(strstr(assay_context_error(context), "big.exr: it needs 96 MiB"));
    assert_int_equal(assay_image_decode(context, bytes, count, "big.exr", wanted, &image),
                     ASSAY_ERR_MEMORY);
    assert_non_null(strstr(assay_context_error(context), "big.exr: it needs 16 MiB"));
    assert_null(image);
    assert_int_equal(assay_context_memory_used(context), 0);
    assay_context_destroy(context);
    free(bytes);
}

/* A few pixels of a picture of 4096 x 4096 are refused whatever memory there is. */
static void a_hollow_window_is_refused(void **state)
{
    (void)state;
    const exr_attr_box2i_t window  = {.max.x = 4095, .max.y = 4095};
    size_t                 count   = 0;
    uint8_t               *bytes   = file_of(EXR_COMPRESSION_ZIP, window, &count);
    assay_context         *context = limited(UINT64_C(1) << 40);
    assay_image           *image   = NULL;
    assert_int_equal(assay_image_decode(context, bytes, count, "hollow.exr", NULL, &image),
                     ASSAY_ERR_LIMIT);
    assert_non_null(strstr(assay_context_error(context), "hollow.exr: the OpenEXR display window"));
    assert_null(image);
    assay_context_destroy(context);
    free(bytes);
}

/* A file whose compression byte says something else is broken, however little memory there is. */
static void another_compression_is_a_broken_file(void **state)
{
    (void)state;
    size_t         count   = 0;
    uint8_t       *bytes   = file_of(EXR_COMPRESSION_ZIP, WHOLE, &count);
    uint8_t       *at      = memmem(bytes, count, "compression\0compression\0\1\0\0\0", 28);
    assay_context *context = limited(UINT64_C(16) << 20);
    assert_non_null(at);
    for (int c = 0; c < EXR_COMPRESSION_DWAA; c++) {
        assay_image *image        = NULL;
        at[28]                    = (uint8_t)c;
        const assay_status status = assay_image_decode(context, bytes, count, "x", NULL, &image);
        assay_image_destroy(image);
        /* Deflated bytes may inflate to something under PXR24. */
        if (c == EXR_COMPRESSION_ZIP || (c == EXR_COMPRESSION_PXR24 && status == ASSAY_OK)) {
            assert_int_equal(status, ASSAY_OK);
        } else {
            assert_int_equal(status, ASSAY_ERR_FORMAT);
        }
    }
    assay_context_destroy(context);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_wanted_channels_take_memory),
        cmocka_unit_test(a_large_window_is_refused),
        cmocka_unit_test(a_hollow_window_is_refused),
        cmocka_unit_test(another_compression_is_a_broken_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
