/* test_exr_threads.c - OpenEXR read by several threads: the same pixels, and the same words about
 * what is broken. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/random.h"
#include "io/image_data.h"
#include "io/image_decode.h"
#include "support/exr_files.h"

enum { WIDTH = 53, HEIGHT = 300, PIXELS = WIDTH * HEIGHT, FLIPS = 60, RUN = 32 };

static assay_context *threaded(int threads, uint64_t limit)
{
    const assay_context_options options = {.threads = threads, .memory_limit = limit};
    assay_context              *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    return context;
}

/* 19 chunks of scan lines, or 266 tiles, of what cannot be predicted; in every other band of 16
 * lines nothing can be left out, so that some chunks are stored as they are. */
static uint8_t *make_file(exr_compression_t compression, int tile, size_t *count_out)
{
    static uint32_t     values[2][PIXELS];
    const exr_file_spec spec = {
        .width         = WIDTH,
        .height        = HEIGHT,
        .compression   = compression,
        .tile_width    = tile,
        .tile_height   = tile,
        .channels      = {{"A", EXR_PIXEL_UINT, values[0], 0}, {"B", EXR_PIXEL_UINT, values[1], 0}},
        .channel_count = 2};
    for (int i = 0; i < 2 * PIXELS; i++) {
        assay_random random            = assay_random_start(3, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        const double range             = i % PIXELS / WIDTH / 16 % 2 ? 0x1p32 : 64.0;
        values[i / PIXELS][i % PIXELS] = (uint32_t)(range * assay_random_next(&random));
    }
    return exr_file_bytes(&spec, count_out);
}

static void check_same(const assay_image *a, const assay_image *b)
{
    for (int c = 0; c < 2; c++) {
        assert_memory_equal(assay_image_channel_at(a, c).data.u32,
                            assay_image_channel_at(b, c).data.u32, PIXELS * sizeof(uint32_t));
    }
}

static void flip(uint8_t *bytes, size_t at)
{
    for (size_t i = at; i < at + RUN; i++) {
        bytes[i] ^= 0xff;
    }
}

/* Of the file as it is and with bytes turned round; how often it was refused. */
static int compare(uint8_t *bytes, size_t count)
{
    int refused = 0;
    for (int i = 0; i < FLIPS; i++) {
        assay_context *contexts[2] = {threaded(1, UINT64_MAX), threaded(4, UINT64_MAX)};
        assay_image   *images[2]   = {NULL};
        assay_status   statuses[2];
        assay_random   random = assay_random_start(4, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        const size_t   at     = (size_t)((double)(count - RUN) * assay_random_next(&random));
        if (i > 0) {
            flip(bytes, at);
        }
        for (int k = 0; k < 2; k++) {
            statuses[k] = assay_image_decode(contexts[k], bytes, count, "x", NULL, &images[k]);
        }
        if (i > 0) {
            flip(bytes, at);
        }
        assert_int_equal(statuses[0], statuses[1]);
        if (statuses[0] == ASSAY_OK && assay_image_width(images[0]) == WIDTH) {
            check_same(images[0], images[1]);
        } else if (statuses[0] != ASSAY_OK) {
            refused++;
            assert_string_equal(assay_context_error(contexts[0]), assay_context_error(contexts[1]));
        }
        for (int k = 0; k < 2; k++) {
            assay_image_destroy(images[k]);
            assay_context_destroy(contexts[k]);
        }
        assert_true(i > 0 || statuses[0] == ASSAY_OK);
    }
    return refused;
}

static void threads_change_nothing(void **state)
{
    (void)state;
    static const exr_compression_t all[]   = {EXR_COMPRESSION_ZIP, EXR_COMPRESSION_PIZ};
    int                            refused = 0;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        for (int tile = 0; tile <= 8; tile += 8) {
            size_t   count = 0;
            uint8_t *bytes = make_file(all[i], tile, &count);
            refused += compare(bytes, count);
            free(bytes);
        }
    }
    assert_true(refused > 10);
}

/* Two readers at once need more room than one; where there is room for one alone it reads all. */
static void room_for_one_reader_is_enough(void **state)
{
    (void)state;
    size_t         count   = 0;
    uint8_t       *bytes   = make_file(EXR_COMPRESSION_PIZ, 0, &count);
    const uint64_t pixels  = 2 * PIXELS * sizeof(uint32_t);
    const uint64_t chunk   = 2 * 32 * WIDTH * sizeof(uint32_t); /* 32 lines, decompressed */
    assay_image   *image   = NULL;
    assay_context *context = threaded(4, pixels + 3 * chunk + 4096);
    assert_int_equal(assay_image_decode(context, bytes, count, "x", NULL, &image), ASSAY_OK);
    assay_image_destroy(image);
    assay_context_destroy(context);
    context = threaded(4, pixels + chunk);
    assert_int_equal(assay_image_decode(context, bytes, count, "x", NULL, &image),
                     ASSAY_ERR_MEMORY);
    assert_non_null(strstr(assay_context_error(context), "out of memory for x"));
    assay_context_destroy(context);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(threads_change_nothing),
                                       cmocka_unit_test(room_for_one_reader_is_enough)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
