/* test_texture_decode.c - PNG and JPEG files into texels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "core/numerics.h"
#include "core/random.h"
#include "scene/texture.h"
#include "support/broken.h"
#include "support/encoded_image.h"
#include "support/failing_context.h"

static failing_memory memory;

static int set_up(void **state)
{
    *state = failing_context(&memory);
    return 0;
}

static int tear_down(void **state)
{
    assert_int_equal(memory.live, 1);
    assay_context_destroy(*state);
    return 0;
}

/* ---- PNG ---- */

enum { WIDTH = 13, HEIGHT = 11, PIXELS = WIDTH * HEIGHT };

static const struct {
    const char *name;
    int         color_type, bits;
} kinds[] = {{"grey 1", PNG_COLOR_TYPE_GRAY, 1},
             {"grey 2", PNG_COLOR_TYPE_GRAY, 2},
             {"grey 4", PNG_COLOR_TYPE_GRAY, 4},
             {"grey 8", PNG_COLOR_TYPE_GRAY, 8},
             {"grey 16", PNG_COLOR_TYPE_GRAY, 16},
             {"grey alpha 8", PNG_COLOR_TYPE_GRAY_ALPHA, 8},
             {"grey alpha 16", PNG_COLOR_TYPE_GRAY_ALPHA, 16},
             {"palette 1", PNG_COLOR_TYPE_PALETTE, 1},
             {"palette 2", PNG_COLOR_TYPE_PALETTE, 2},
             {"palette 4", PNG_COLOR_TYPE_PALETTE, 4},
             {"palette 8", PNG_COLOR_TYPE_PALETTE, 8},
             {"rgb 8", PNG_COLOR_TYPE_RGB, 8},
             {"rgb 16", PNG_COLOR_TYPE_RGB, 16},
             {"rgba 8", PNG_COLOR_TYPE_RGB_ALPHA, 8},
             {"rgba 16", PNG_COLOR_TYPE_RGB_ALPHA, 16}};
enum { KINDS = sizeof kinds / sizeof *kinds };

typedef struct {
    png_spec spec;
    uint16_t samples[PIXELS * 4];
} png_case;

static int channels_of(int color_type)
{
    static const int counts[] = {1, 0, 3, 1, 2, 0, 4};
    return counts[color_type];
}

/* Random samples; where transparent, pixel 5 has the transparent colour. */
static void make_case(png_case *c, int kind, bool interlaced, bool transparent)
{
    const int channels = channels_of(kinds[kind].color_type);
    memset(c, 0, sizeof *c);
    c->spec =
        (png_spec){.width         = WIDTH,
                   .height        = HEIGHT,
                   .color_type    = kinds[kind].color_type,
                   .bits          = kinds[kind].bits,
                   .interlaced    = interlaced,
                   .with_gamma    = kind % 2 == 0,
                   .palette_count = 1 << (kinds[kind].bits < 8 ? kinds[kind].bits : 8),
                   .transparent = transparent && !(kinds[kind].color_type & PNG_COLOR_MASK_ALPHA)};
    for (int i = 0; i < PIXELS * channels; i++) {
        assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, (uint64_t)i, (uint32_t)kind);
        c->samples[i]       = (uint16_t)(ldexp(1.0, kinds[kind].bits) * assay_random_next(&random));
    }
    for (int i = 0; i < c->spec.palette_count; i++) {
        for (int k = 0; k < 4; k++) {
            c->spec.palette[i][k] = (uint8_t)(i * (37 + 50 * k) + 11 * k);
        }
    }
    for (int k = 0; k < 3; k++) {
        c->spec.transparent_color[k] = c->samples[5 * channels + (channels < 3 ? 0 : k)];
    }
}

/* What a texel's component must be, out of the samples. */
static uint32_t expected_component(const png_case *c, int pixel, int component)
{
    const int       channels = channels_of(c->spec.color_type);
    const uint16_t *s        = c->samples + pixel * channels;
    const uint32_t  most = (1u << c->spec.bits) - 1, scale = c->spec.bits < 8 ? 255 / most : 1;
    const uint32_t  full = c->spec.bits == 16 ? 65535 : 255;
    if (c->spec.color_type == PNG_COLOR_TYPE_PALETTE) {
        return component < 3 || c->spec.transparent ? c->spec.palette[s[0]][component] : 255;
    }
    if (component < 3) {
        return scale * s[channels < 3 ? 0 : component];
    }
    if (c->spec.color_type & PNG_COLOR_MASK_ALPHA) {
        return s[channels - 1];
    }
    bool is_transparent = c->spec.transparent;
    for (int k = 0; k < channels; k++) {
        is_transparent = is_transparent && s[k] == c->spec.transparent_color[k];
    }
    return is_transparent ? 0 : full;
}

static bool texels_match(const assay_texture_image *image, const png_case *c)
{
    if (image->width != WIDTH || image->height != HEIGHT ||
        image->bits != (c->spec.bits == 16 ? 16 : 8)) {
        return false;
    }
    for (int i = 0; i < PIXELS * 4; i++) {
        const uint32_t value = image->bits == 8 ? ((const uint8_t *)image->texels)[i]
                                                : ((const uint16_t *)image->texels)[i];
        if (value != expected_component(c, i / 4, i % 4)) {
            return false;
        }
    }
    return true;
}

static void every_kind_of_png_is_read(void **state)
{
    static png_case c;
    for (int i = 0; i < KINDS * 4; i++) {
        assay_texture_image image = {0};
        size_t              count = 0;
        make_case(&c, i / 4, i & 1, i & 2);
        uint8_t *bytes = png_bytes(&c.spec, c.samples, &count);
        assert_int_equal(assay_texture_image_decode(*state, bytes, count, "a name", &image),
                         ASSAY_OK);
        assert_string_equal(image.name, "a name");
        if (!texels_match(&image, &c)) {
            fail_msg("%s%s%s", kinds[i / 4].name, i & 1 ? ", interlaced" : "",
                     i & 2 ? ", transparent" : "");
        }
        ((uint8_t *)image.texels)[image.bits == 8 ? 7 : 14] ^= 1; /* the second alpha */
        assert_false(texels_match(&image, &c));
        assay_texture_image_release(*state, &image);
        assert_null(image.texels);
        assay_texture_image_release(*state, &image);
        free(bytes);
    }
}

static assay_status decode(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_texture_image image;
    const assay_status status = assay_texture_image_decode(context, bytes, count, "broken", &image);
    if (status == ASSAY_OK) {
        assay_texture_image_release(context, &image);
    }
    return status;
}

static void broken_pngs_are_refused(void **state)
{
    static png_case c;
    (void)state;
    for (int kind = 0; kind < KINDS; kind += 2) {
        size_t count = 0;
        make_case(&c, kind, kind % 4 == 0, true);
        uint8_t *bytes = png_bytes(&c.spec, c.samples, &count);
        broken_truncate(decode, bytes, count);
        assert_true(broken_flip(decode, bytes, count, 400, (uint64_t)kind) > 300);
        free(bytes);
    }
}

/* The checksum of a chunk, so that a changed header is still well-formed (PNG, annex D). */
static void put_checksum(uint8_t *chunk, size_t length)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 4; i < length + 8; i++) {
        crc ^= chunk[i];
        for (int k = 0; k < 8; k++) {
            crc = crc & 1u ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
        }
    }
    crc = ~crc;
    for (int i = 0; i < 4; i++) {
        chunk[length + 8 + (size_t)i] = (uint8_t)(crc >> (24 - 8 * i));
    }
}

static void sizes_are_checked_before_memory_is_asked(void **state)
{
    static const struct {
        uint32_t     width, height;
        assay_status status;
    } rows[] = {{16385, 1, ASSAY_ERR_LIMIT},       {1, 16385, ASSAY_ERR_LIMIT},
                {16384, 8193, ASSAY_ERR_LIMIT},    {16384, 8192, ASSAY_ERR_FORMAT},
                {0, 1, ASSAY_ERR_FORMAT},          {1, 0, ASSAY_ERR_FORMAT},
                {0xffffffffu, 1, ASSAY_ERR_LIMIT}, {0x80000000u, 0x80000000u, ASSAY_ERR_LIMIT}};
    static png_case c;
    size_t          count = 0;
    make_case(&c, 3, false, false);
    uint8_t *bytes = png_bytes(&c.spec, c.samples, &count);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (int k = 0; k < 4; k++) {
            bytes[16 + k] = (uint8_t)(rows[i].width >> (24 - 8 * k));
            bytes[20 + k] = (uint8_t)(rows[i].height >> (24 - 8 * k));
        }
        put_checksum(bytes + 8, 13);
        memory.asked = 0;
        assert_int_equal(decode(*state, bytes, count), rows[i].status);
        assert_int_equal(memory.asked, 0);
    }
    free(bytes);
}

/* ---- JPEG ---- */

/* Smooth colours: what JPEG keeps nearly as it is at quality 100. */
static void make_jpeg_samples(uint8_t *samples, const jpeg_spec *spec)
{
    for (uint32_t y = 0; y < spec->height; y++) {
        for (uint32_t x = 0; x < spec->width; x++) {
            for (int c = 0; c < spec->channels; c++) {
                samples[(y * spec->width + x) * (uint32_t)spec->channels + (uint32_t)c] =
                    (uint8_t)(60 + 2 * x + y + (uint32_t)c * 20);
            }
        }
    }
}

static double largest_error(const assay_texture_image *image, const jpeg_spec *spec,
                            const uint8_t *samples)
{
    const uint8_t *texels  = image->texels;
    double         largest = 0.0;
    for (uint32_t i = 0; i < spec->width * spec->height; i++) {
        for (uint32_t c = 0; c < 4; c++) {
            const int expected =
                c == 3 ? 255
                       : samples[i * (uint32_t)spec->channels + (spec->channels == 1 ? 0 : c)];
            largest = fmax(largest, abs(texels[4 * i + c] - expected));
        }
    }
    return largest;
}

/* At quality 100 the quantisation is 1 in each of 64 coefficients and in the conversion to YCbCr
 * and back: an error of at most 3 codes.  A grey ramp has no conversion: 2. */
static void every_kind_of_jpeg_is_read(void **state)
{
    static uint8_t samples[40 * 30 * 3];
    for (int i = 0; i < 8; i++) {
        const jpeg_spec     spec = {.width       = 37,
                                    .height      = 29,
                                    .channels    = i & 1 ? 1 : 3,
                                    .quality     = 100,
                                    .progressive = i & 2,
                                    .subsampled  = i & 4};
        assay_texture_image image;
        size_t              count = 0;
        make_jpeg_samples(samples, &spec);
        uint8_t *bytes = jpeg_bytes(&spec, samples, &count);
        assert_int_equal(assay_texture_image_decode(*state, bytes, count, "x", &image), ASSAY_OK);
        assert_int_equal(image.width, 37);
        assert_int_equal(image.height, 29);
        assert_int_equal(image.bits, 8);
        const double bound = spec.channels == 1 ? 2.0 : 3.0;
        assert_true(largest_error(&image, &spec, samples) <= bound);
        samples[100] = (uint8_t)(samples[100] + 7); /* one wrong sample would be seen */
        assert_false(largest_error(&image, &spec, samples) <= bound);
        assay_texture_image_release(*state, &image);
        free(bytes);
    }
}

static void flat_grey_is_exact(void **state)
{
    static uint8_t  samples[64];
    const jpeg_spec spec = {.width = 8, .height = 8, .channels = 1, .quality = 90};
    for (int grey = 0; grey < 256; grey += 51) {
        assay_texture_image image;
        size_t              count = 0;
        memset(samples, grey, sizeof samples);
        uint8_t *bytes = jpeg_bytes(&spec, samples, &count);
        assert_int_equal(assay_texture_image_decode(*state, bytes, count, "x", &image), ASSAY_OK);
        assert_true(largest_error(&image, &spec, samples) == 0.0);
        assay_texture_image_release(*state, &image);
        free(bytes);
    }
}

static void other_jpegs_are_refused_by_name(void **state)
{
    static uint8_t samples[16 * 16 * 4];
    static const struct {
        jpeg_spec   spec;
        const char *word;
    } rows[] = {{{16, 16, 4, 90, false, false, false}, "CMYK"},
                {{16, 16, 3, 90, false, true, false}, "arithmetic"}};
    for (int i = 0; i < 2; i++) {
        size_t   count = 0;
        uint8_t *bytes = jpeg_bytes(&rows[i].spec, samples, &count);
        assert_int_equal(decode(*state, bytes, count), ASSAY_ERR_UNSUPPORTED);
        assert_non_null(strstr(assay_context_error(*state), rows[i].word));
        free(bytes);
    }
    /* 12 bits, in the frame header of a baseline file */
    const jpeg_spec spec  = {16, 16, 1, 90, false, false, false};
    size_t          count = 0;
    uint8_t        *bytes = jpeg_bytes(&spec, samples, &count);
    uint8_t        *frame = memmem(bytes, count, "\xff\xc0", 2);
    assert_non_null(frame);
    frame[4] = 12;
    assert_int_equal(decode(*state, bytes, count), ASSAY_ERR_UNSUPPORTED);
    frame[4]     = 8;
    frame[5]     = 0xff; /* height 65296 */
    memory.asked = 0;
    assert_int_equal(decode(*state, bytes, count), ASSAY_ERR_LIMIT);
    frame[5] = frame[7] = 0x20; /* 8208 a side: allowed, but more than the file can hold */
    assert_int_equal(decode(*state, bytes, count), ASSAY_ERR_FORMAT);
    assert_int_equal(memory.asked, 0);
    free(bytes);
}

static void broken_jpegs_are_refused(void **state)
{
    static uint8_t samples[40 * 30 * 3];
    (void)state;
    for (int i = 0; i < 4; i++) {
        const jpeg_spec spec  = {.width       = 24,
                                 .height      = 17,
                                 .channels    = i & 1 ? 1 : 3,
                                 .quality     = 70,
                                 .progressive = i & 2,
                                 .subsampled  = true};
        size_t          count = 0;
        make_jpeg_samples(samples, &spec);
        uint8_t *bytes = jpeg_bytes(&spec, samples, &count);
        broken_truncate(decode, bytes, count);
        assert_true(broken_flip(decode, bytes, count, 1000, (uint64_t)i) > 100);
        free(bytes);
    }
}

/* ---- both ---- */

static void other_formats_are_named(void **state)
{
    static const struct {
        const char  *bytes;
        size_t       count;
        assay_status status;
        const char  *word;
    } rows[] = {{"", 0, ASSAY_ERR_FORMAT, "empty"},
                {"hello", 5, ASSAY_ERR_UNSUPPORTED, "neither"},
                {"\253KTX 20\273\r\n\032\n", 12, ASSAY_ERR_UNSUPPORTED, "KTX"},
                {"RIFF\1\2\3\4WEBPVP8 ", 16, ASSAY_ERR_UNSUPPORTED, "WebP"},
                {"RIFF\1\2\3\4WAVE", 12, ASSAY_ERR_UNSUPPORTED, "neither"},
                {"DDS |", 5, ASSAY_ERR_UNSUPPORTED, "DDS"},
                {"GIF89a", 6, ASSAY_ERR_UNSUPPORTED, "GIF"},
                {"BM12", 4, ASSAY_ERR_UNSUPPORTED, "BMP"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(decode(*state, (const uint8_t *)rows[i].bytes, rows[i].count),
                         rows[i].status);
        assert_non_null(strstr(assay_context_error(*state), "broken: "));
        assert_non_null(strstr(assay_context_error(*state), rows[i].word));
    }
}

typedef struct {
    uint8_t *bytes;
    size_t   count;
} encoded;

static assay_status decode_encoded(assay_context *context, void *user)
{
    const encoded *e = user;
    return decode(context, e->bytes, e->count);
}

static void refused_memory_is_reported(void **state)
{
    static png_case c;
    encoded         e;
    const jpeg_spec spec = {WIDTH, HEIGHT, 1, 90, false, false, false};
    (void)state;
    make_case(&c, 7, true, true);
    e.bytes = png_bytes(&c.spec, c.samples, &e.count);
    assert_true(failing_each(decode_encoded, &e) > 5);
    free(e.bytes);
    e.bytes = jpeg_bytes(&spec, (const uint8_t *)c.samples, &e.count);
    assert_int_equal(failing_each(decode_encoded, &e), 2);
    free(e.bytes);
}

/* The table against the formula, in long double and in this library's power function.  In double
 * the base is off by up to 4 units of 2^-53 (quotient, constant, sum, quotient), which the power
 * makes 9.6; its exponent's own rounding adds up to 5.8 and the power function 2. */
static void srgb_decoding_is_exact(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++) {
        const double      c       = i / 255.0;
        const long double l       = i / 255.0L;
        const double      formula = c <= 0.04045 ? c / 12.92 : assay_pow((c + 0.055) / 1.055, 2.4);
        const double      exact =
            (double)(l <= 0.04045L ? l / 12.92L : powl((l + 0.055L) / 1.055L, 2.4L));
        const double table = assay_srgb_decode8((uint8_t)i);
        assert_true(fabs(table - formula) <= 18.0 * 0x1p-53 * table);
        assert_true(fabs(table - exact) <= 1.0 * 0x1p-53 * table);
        assert_true(fabs(assay_srgb_decode16((uint16_t)(257 * i)) - table) <=
                    18.0 * 0x1p-53 * table);
        assert_true(i == 0 || table > assay_srgb_decode8((uint8_t)(i - 1)));
        assert_true(i == 0 || fabs(pow(c, 2.2) - exact) > 18.0 * 0x1p-53 * exact || i == 255);
    }
    for (int i = 0; i < 65536; i++) {
        const long double l = i / 65535.0L;
        const double      exact =
            (double)(l <= 0.04045L ? l / 12.92L : powl((l + 0.055L) / 1.055L, 2.4L));
        assert_true(fabs(assay_srgb_decode16((uint16_t)i) - exact) <= 18.0 * 0x1p-53 * exact);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_kind_of_png_is_read, set_up, tear_down),
        cmocka_unit_test(broken_pngs_are_refused),
        cmocka_unit_test_setup_teardown(sizes_are_checked_before_memory_is_asked, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(every_kind_of_jpeg_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(flat_grey_is_exact, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_jpegs_are_refused_by_name, set_up, tear_down),
        cmocka_unit_test(broken_jpegs_are_refused),
        cmocka_unit_test_setup_teardown(other_formats_are_named, set_up, tear_down),
        cmocka_unit_test(refused_memory_is_reported),
        cmocka_unit_test(srgb_decoding_is_exact)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
