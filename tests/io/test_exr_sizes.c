/* test_exr_sizes.c - pixels that compress to about as many bytes as they are: whatever a chunk's
 * size, they come back to the bit; as long as the pixels, they are the pixels (3.1 would write the
 * stream, which is read all the same).
 *
 * One chunk of noise in which more and more samples are 0: its compressed size passes that of the
 * samples in steps of a few bytes, so some of the files have it exactly. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include "assay/image.h"
#include "core/random.h"
#include "support/failing_context.h"
#include "support/temporary.h"

enum {
    WIDTH  = 24,
    HEIGHT = 16,
    PIXELS = WIDTH * HEIGHT,
    RAW    = 4 * PIXELS,
    SEEDS  = 24,
    FIRST  = 14,
    LAST   = 22
};

static assay_image *make_image(assay_context *context, uint64_t seed, int zeros)
{
    assay_image  *image = NULL;
    assay_channel channel;
    assert_int_equal(assay_image_create(context, WIDTH, HEIGHT, &image), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(image, "A", ASSAY_CHANNEL_UINT, &channel), ASSAY_OK);
    for (int i = 0; i < PIXELS; i++) {
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        channel.data.u32[i] = i < zeros ? 0u : (uint32_t)(0x1p32 * assay_random_next(&random));
    }
    return image;
}

static void expect_back(assay_context *context, const assay_image *image, const char *path)
{
    assay_image *back = NULL;
    assert_int_equal(assay_image_read(context, path, &back), ASSAY_OK);
    assert_memory_equal(assay_image_channel_at(image, 0).data.u32,
                        assay_image_channel_at(back, 0).data.u32, RAW);
    assay_image_destroy(back);
}

/* The one chunk's size, which is the last but the chunk itself; its bytes where it is as long as
 * the samples. */
static bool read_full_chunk(const char *path, uint8_t chunk[RAW])
{
    FILE   *file = fopen(path, "rb");
    uint8_t size[4];
    assert_true(file && fseek(file, -(RAW + 4L), SEEK_END) == 0 && fread(size, 1, 4, file) == 4 &&
                fread(chunk, 1, RAW, file) == RAW);
    fclose(file);
    return (uint32_t)size[0] + 256u * size[1] + 65536u * size[2] == RAW && size[3] == 0;
}

static void overwrite_chunk(const char *path, const uint8_t chunk[RAW])
{
    FILE *file = fopen(path, "r+b");
    assert_true(file && fseek(file, -(long)RAW, SEEK_END) == 0 &&
                fwrite(chunk, 1, RAW, file) == RAW);
    fclose(file);
}

/* Sorted, made differences and deflated; false where that is not as long as before. */
static bool deflate_to_size(const uint8_t raw[RAW], uint8_t stream[2 * RAW])
{
    uint8_t sorted[RAW];
    for (int i = 0; i < RAW; i++) {
        sorted[i % 2 * (RAW / 2) + i / 2] = raw[i];
    }
    for (int i = RAW - 1; i > 0; i--) {
        sorted[i] = (uint8_t)(sorted[i] - sorted[i - 1] + 128);
    }
    for (int level = 1; level <= 9; level++) {
        uLongf length = 2 * RAW;
        if (compress2(stream, &length, sorted, RAW, level) == Z_OK && length == RAW) {
            return true;
        }
    }
    return false;
}

static void every_size_comes_back(void **state)
{
    temporary      t    = temporary_create();
    const char    *path = temporary_path(&t, "image.exr");
    static uint8_t chunk[RAW], stream[2 * RAW];
    int            streams = 0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        for (int zeros = FIRST; zeros < LAST; zeros++) {
            assay_image *image = make_image(*state, seed, zeros);
            assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
            expect_back(*state, image, path);
            if (read_full_chunk(path, chunk)) {
                assert_memory_equal(chunk, assay_image_channel_at(image, 0).data.u32, RAW);
                if (deflate_to_size(chunk, stream)) {
                    overwrite_chunk(path, stream);
                    expect_back(*state, image, path);
                    streams++;
                }
            }
            assay_image_destroy(image);
        }
    }
    assert_true(streams > 0);
    temporary_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_size_comes_back, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
