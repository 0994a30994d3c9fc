/* test_hdr.c - Radiance pictures: every coding of a row against an encoder of the test's own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "io/image_data.h"
#include "io/image_decode.h"
#include "support/broken.h"
#include "support/failing_context.h"

typedef enum { CODING_FLAT, CODING_OLD, CODING_NEW, CODING_COUNT } row_coding;

typedef struct {
    uint8_t bytes[1 << 20];
    size_t  count;
} file_bytes;

static void put(file_bytes *file, const void *bytes, size_t count)
{
    assert_true(file->count + count <= sizeof file->bytes);
    memcpy(file->bytes + file->count, bytes, count);
    file->count += count;
}

static void put_byte(file_bytes *file, unsigned value)
{
    const uint8_t byte = (uint8_t)value;
    put(file, &byte, 1);
}

static void put_header(file_bytes *file, const char *lines, int width, int height)
{
    char text[300];
    file->count = 0;
    snprintf(text, sizeof text, "#?RADIANCE\n%sFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", lines,
             height, width);
    put(file, text, strlen(text));
}

/* Runs of equal bytes of at least 3, up to 127; else literals of up to 128. */
static void put_new_row(file_bytes *file, const uint8_t *pixels, int width)
{
    const uint8_t mark[] = {2, 2, (uint8_t)(width >> 8), (uint8_t)width};
    put(file, mark, 4);
    for (int c = 0; c < 4; c++) {
        for (int x = 0; x < width;) {
            int run = 1;
            while (x + run < width && run < 127 && pixels[4 * (x + run) + c] == pixels[4 * x + c]) {
                run++;
            }
            if (run > 2) {
                put_byte(file, 128u + (unsigned)run);
                put_byte(file, pixels[4 * x + c]);
                x += run;
            } else {
                int literal = width - x < 128 ? width - x : (x % 128) + 1;
                put_byte(file, (unsigned)literal);
                for (int i = 0; i < literal; i++) {
                    put_byte(file, pixels[4 * (x + i) + c]);
                }
                x += literal;
            }
        }
    }
}

/* Equal pixels as (1, 1, 1, n), with n over 255 as two of them, lowest byte first. */
static void put_old_row(file_bytes *file, const uint8_t *pixels, int width)
{
    for (int x = 0; x < width;) {
        int run = 1;
        while (x + run < width && memcmp(pixels + 4 * x, pixels + 4 * (x + run), 4) == 0) {
            run++;
        }
        put(file, pixels + 4 * x, 4);
        for (int repeats = run - 1; repeats > 0; repeats >>= 8) {
            const uint8_t mark[] = {1, 1, 1, (uint8_t)repeats};
            put(file, mark, 4);
        }
        x += run;
    }
}

static void put_row(file_bytes *file, row_coding coding, const uint8_t *pixels, int width)
{
    switch (coding) {
    case CODING_NEW: put_new_row(file, pixels, width); break;
    case CODING_OLD: put_old_row(file, pixels, width); break;
    default: put(file, pixels, (size_t)width * 4); break;
    }
}

/* Pixels with runs of all lengths; never (1, 1, 1, n) nor (2, 2, ...), which mark codings. */
static void make_pixels(uint8_t *pixels, int count, uint64_t seed)
{
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 0, 0);
    for (int i = 0; i < count;) {
        const double u   = assay_random_next(&random);
        const int    run = u < 0.5 ? 1 : (int)(exp2(9.0 * assay_random_next(&random)));
        uint8_t      pixel[4];
        for (int c = 0; c < 4; c++) {
            pixel[c] = (uint8_t)(3 + 253.0 * assay_random_next(&random));
        }
        if (u < 0.1) {
            pixel[3] = 0;
        }
        for (int k = 0; k < run && i < count; k++, i++) {
            memcpy(pixels + 4 * i, pixel, 4);
        }
    }
}

/* Whether the image is the pixels, times `factor`, exactly up to the rounding of the factor (of
 * floats below 2^-126: half a unit of the last place that they have). */
static bool is_picture(const assay_image *image, const uint8_t *pixels, const double factor[3])
{
    static const char *const names[] = {"R", "G", "B"};
    const int                count   = assay_image_width(image) * assay_image_height(image);
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        if (!assay_image_find_channel(image, names[c], &channel)) {
            return false;
        }
        for (int i = 0; i < count; i++) {
            const uint8_t *p     = pixels + 4 * i;
            const double   value = p[3] ? ldexp(p[c], p[3] - 136) * factor[c] : 0.0;
            if (fabs((double)channel.data.f32[i] - value) > 0x1p-24 * value + 0x1p-150) {
                return false;
            }
        }
    }
    return assay_image_channel_count(image) == 3;
}

static const double unit[3] = {1.0, 1.0, 1.0};

static void every_coding_of_rows_is_read(void **state)
{
    static const int  widths[] = {1, 7, 8, 130, 1000, 32768};
    static uint8_t    pixels[32768 * 4 * 3];
    static file_bytes file;
    for (int coding = 0; coding < CODING_COUNT; coding++) {
        for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
            const int width = widths[w];
            if (coding == CODING_NEW && (width < 8 || width > 32767)) {
                continue;
            }
            assay_image *image = NULL;
            make_pixels(pixels, width * 3, w);
            put_header(&file, "", width, 3);
            for (int y = 0; y < 3; y++) {
                put_row(&file, coding, pixels + (size_t)4 * (size_t)(width * y), width);
            }
            assert_int_equal(assay_image_decode(*state, file.bytes, file.count, "x", NULL, &image),
                             ASSAY_OK);
            assert_true(is_picture(image, pixels, unit));
            pixels[4 * width] ^= 1; /* a pixel of another row would be seen */
            assert_false(is_picture(image, pixels, unit));
            assay_image_destroy(image);
        }
    }
}

static void rows_may_change_coding(void **state)
{
    static uint8_t    pixels[40 * 4 * 3];
    static file_bytes file;
    assay_image      *image = NULL;
    make_pixels(pixels, 120, 5);
    put_header(&file, "", 40, 3);
    for (int y = 0; y < 3; y++) {
        put_row(&file, (row_coding)y, pixels + 160 * y, 40);
    }
    assert_int_equal(assay_image_decode(*state, file.bytes, file.count, "x", NULL, &image),
                     ASSAY_OK);
    assert_true(is_picture(image, pixels, unit));
    assay_image_destroy(image);
}

static void exposures_are_divided_out(void **state)
{
    static const double expected[3] = {1.0 / (2.0 * 3.5), 1.0 / (2.0 * 3.5 * 2.0),
                                       1.0 / (2.0 * 3.5 * 0.5)};
    static uint8_t      pixels[40 * 4];
    static file_bytes   file;
    assay_image        *image = NULL;
    make_pixels(pixels, 40, 6);
    put_header(&file, "# a comment\nEXPOSURE=2.0\r\nCOLORCORR= 1 2.0 0.5 \nEXPOSURE= 3.5\nVIEW=x\n",
               40, 1);
    put_row(&file, CODING_NEW, pixels, 40);
    assert_int_equal(assay_image_decode(*state, file.bytes, file.count, "x", NULL, &image),
                     ASSAY_OK);
    assert_true(is_picture(image, pixels, expected));
    assert_false(is_picture(image, pixels, unit));
    assay_image_destroy(image);
}

static void headers_are_judged(void **state)
{
    static const struct {
        const char  *text;
        assay_status status;
    } rows[] = {
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_OK},
        {"#?RGBE\nFORMAT=32-bit_rle_rgbe\r\n\r\n-Y 1 +X 1\r\n", ASSAY_OK},
        {"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", ASSAY_ERR_UNSUPPORTED},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 1 +X 1\n", ASSAY_ERR_UNSUPPORTED},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 -X 1\n", ASSAY_ERR_UNSUPPORTED},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 1\n", ASSAY_ERR_UNSUPPORTED},
        {"#?RADIANCE\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\nhello\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1 2\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 0\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 999999999999\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 65537\n", ASSAY_ERR_LIMIT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 65536 +X 65536\n", ASSAY_ERR_LIMIT},
        {"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4096 +X 65536\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=0\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=-2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=nan\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=1 x\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nEXPOSURE=\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT},
        {"#?RADIANCE\nCOLORCORR=1 1\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n", ASSAY_ERR_FORMAT}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        static file_bytes file;
        assay_image      *image = NULL;
        file.count              = 0;
        put(&file, rows[i].text, strlen(rows[i].text));
        put(&file, "abcd", 4);
        const assay_status status =
            assay_image_decode(*state, file.bytes, file.count, "x", NULL, &image);
        if (status != rows[i].status) {
            fail_msg("row %d: '%s'", (int)i, assay_context_error(*state));
        }
        assay_image_destroy(image);
    }
}

static void malformed_rows_are_refused(void **state)
{
    static const struct {
        const char *bytes;
        size_t      count;
    } rows[] = {{"\2\2\0\11abcdefghi", 13},  /* another width               */
                {"\2\2\0\10\211a", 6},       /* a run past the row           */
                {"\2\2\0\10\0abcdefgh", 13}, /* a literal of nothing         */
                {"\2\2\0\10\10abcdefgh\10abcdefgh\10abcdefgh", 31}, /* three components of four */
                {"\1\1\1\5abcdabcdabcdabcd", 20}, /* repeats nothing              */
                {"abcd\1\1\1\10", 8},             /* repeats past the row         */
                {"abcd\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\0\1\1\1\1", 24}, /* shifted out of any row */
                {"abcdabcd", 8}}; /* cut short                    */
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        static file_bytes file;
        assay_image      *image = NULL;
        put_header(&file, "", 8, 1);
        put(&file, rows[i].bytes, rows[i].count);
        assert_int_equal(assay_image_decode(*state, file.bytes, file.count, "x", NULL, &image),
                         ASSAY_ERR_FORMAT);
        assert_null(image);
    }
}

static assay_status read_bytes(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_image       *image = NULL;
    const assay_status status =
        assay_image_decode(context, bytes, count, "broken.hdr", NULL, &image);
    assay_image_destroy(image);
    return status;
}

static void broken_files_are_refused(void **state)
{
    static uint8_t    pixels[20 * 4 * 3];
    static file_bytes file;
    (void)state;
    make_pixels(pixels, 60, 8);
    for (int coding = 0; coding < CODING_COUNT; coding++) {
        put_header(&file, "EXPOSURE=2\n", 20, 3);
        for (int y = 0; y < 3; y++) {
            put_row(&file, coding, pixels + 80 * y, 20);
        }
        broken_truncate(read_bytes, file.bytes, file.count);
        assert_true(broken_flip(read_bytes, file.bytes, file.count, 3000, (uint64_t)coding) > 300);
    }
}

static assay_status read_file(assay_context *context, void *user)
{
    const file_bytes *file = user;
    return read_bytes(context, file->bytes, file->count);
}

static void refused_memory_is_reported(void **state)
{
    static file_bytes file;
    (void)state;
    put_header(&file, "", 1, 1);
    put(&file, "abcd", 4);
    assert_int_equal(failing_each(read_file, &file), 9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_coding_of_rows_is_read, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(rows_may_change_coding, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(exposures_are_divided_out, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(headers_are_judged, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(malformed_rows_are_refused, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
