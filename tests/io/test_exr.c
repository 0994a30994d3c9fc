/* test_exr.c - OpenEXR in and out, bit for bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/random.h"
#include "io/half.h"
#include "io/image_data.h"
#include "io/image_decode.h"
#include "support/broken.h"
#include "support/exr_files.h"
#include "support/failing_context.h"
#include "support/temporary.h"

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

/* Zeros, denormals, infinities, quiet and signalling NaNs with payloads, the largest and smallest.
 */
static const uint32_t special_bits[] = {0x00000000u, 0x80000000u, 0x00000001u, 0x807fffffu,
                                        0x00800000u, 0x7f7fffffu, 0xff7fffffu, 0x7f800000u,
                                        0xff800000u, 0x7fc00000u, 0xffc12345u, 0x7f800001u,
                                        0xffbfffffu, 0x3f800000u, 0x3f7fffffu, 0x33333333u};

static uint32_t random_bits(uint64_t seed, uint64_t item)
{
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, item, 0);
    return (uint32_t)(0x1p32 * assay_random_next(&random));
}

static void fill(assay_channel channel, size_t pixels, uint64_t seed)
{
    const size_t specials = sizeof special_bits / sizeof *special_bits;
    for (size_t i = 0; i < pixels; i++) {
        channel.data.u32[i] =
            i < specials ? special_bits[(i + seed) % specials] : random_bits(seed, i);
    }
}

static assay_image *make_image(assay_context *context, int width, int height)
{
    static const char *const names[] = {"R", "G", "B", "Albedo.R", "Variance.Direct.G"};
    assay_image             *image   = NULL;
    assay_channel            channel;
    char                     long_name[201];
    memset(long_name, 'n', 200);
    long_name[200] = 0;
    assert_int_equal(assay_image_create(context, width, height, &image), ASSAY_OK);
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(assay_image_add_channel(image, names[i], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        fill(channel, (size_t)width * (size_t)height, i);
    }
    assert_int_equal(assay_image_add_channel(image, "SampleCount", ASSAY_CHANNEL_UINT, &channel),
                     ASSAY_OK);
    fill(channel, (size_t)width * (size_t)height, 9);
    assert_int_equal(assay_image_add_channel(image, long_name, ASSAY_CHANNEL_UINT, NULL), ASSAY_OK);
    assert_int_equal(assay_image_set_attribute(image, "assay:method", "path"), ASSAY_OK);
    assert_int_equal(assay_image_set_attribute(image, long_name, "two\nlines, \xc3\xbc"), ASSAY_OK);
    assert_int_equal(assay_image_set_attribute(image, "assay:empty", ""), ASSAY_OK);
    return image;
}

static bool same_images(const assay_image *a, const assay_image *b)
{
    char digest_a[65], digest_b[65];
    if (assay_image_attribute_count(a) != assay_image_attribute_count(b)) {
        return false;
    }
    for (int i = 0; i < assay_image_attribute_count(a); i++) {
        const char *name, *value;
        assay_image_attribute_at(a, i, &name, &value);
        const char *other = assay_image_get_attribute(b, name);
        if (!other || strcmp(value, other) != 0) {
            return false;
        }
    }
    for (int i = 0; i < assay_image_channel_count(a); i++) {
        const assay_channel x = assay_image_channel_at(a, i);
        assay_channel       y;
        if (!assay_image_find_channel(b, x.name, &y) || x.type != y.type ||
            memcmp(x.data.u32, y.data.u32,
                   (size_t)assay_image_width(a) * (size_t)assay_image_height(a) * 4) != 0) {
            return false;
        }
    }
    assay_image_digest(a, digest_a);
    assay_image_digest(b, digest_b);
    return strcmp(digest_a, digest_b) == 0;
}

static void round_trip_is_bit_exact(void **state)
{
    static const int sizes[][2] = {{1, 1}, {1, 40}, {33, 17}, {100, 16}, {5, 32}};
    temporary        t          = temporary_create();
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        assay_image *image = make_image(*state, sizes[i][0], sizes[i][1]), *back = NULL;
        const char  *path = temporary_path(&t, "image.exr");
        assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
        assert_int_equal(assay_image_read(*state, path, &back), ASSAY_OK);
        assert_int_equal(assay_image_width(back), sizes[i][0]);
        assert_int_equal(assay_image_height(back), sizes[i][1]);
        assert_int_equal(assay_image_channel_count(back), 7);
        assert_true(same_images(image, back));
        /* One bit less would have been seen. */
        assay_image_channel_at(back, 1).data.u32[0] ^= 1u;
        assert_false(same_images(image, back));
        assay_image_destroy(image);
        assay_image_destroy(back);
    }
    assert_int_equal(temporary_count(&t), 1);
    temporary_destroy(&t);
}

/* IEEE 754 binary16, from its definition. */
static double half_value(uint16_t half)
{
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    double    value;
    if (exponent == 31) {
        value = fraction ? (double)NAN : (double)INFINITY;
    } else {
        value = exponent ? ldexp(1024 + fraction, exponent - 25) : ldexp(fraction, -24);
    }
    return half & 0x8000 ? -value : value;
}

static bool is_float_of_half(uint32_t bits, uint16_t half)
{
    const double expected = half_value(half);
    float        value;
    memcpy(&value, &bits, sizeof value);
    if (isnan(expected)) {
        return isnan(value) && (bits >> 13 & 1023u) == (half & 1023u) && bits >> 31 == half >> 15;
    }
    return (double)value == expected && !signbit(value) == !(half & 0x8000);
}

static void every_half_becomes_its_float(void **state)
{
    (void)state;
    for (uint32_t half = 0; half < 65536; half++) {
        const uint32_t bits = assay_half_to_float_bits((uint16_t)half);
        assert_true(is_float_of_half(bits, (uint16_t)half));
        assert_false(is_float_of_half(bits + (1u << 13), (uint16_t)half));
    }
}

enum { WIDTH = 53, HEIGHT = 71, PIXELS = WIDTH * HEIGHT };

typedef struct {
    uint16_t half[PIXELS];
    float    single[PIXELS];
    uint32_t whole[PIXELS];
} samples;

/* Smooth, as images are, and never NaN, which PXR24 and B44 may change. */
static void make_samples(samples *s)
{
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        s->half[i]   = (uint16_t)(0x3000 + 16 * x + 7 * y + (x * y) % 5);
        s->single[i] = ldexpf(1.0f + 0.01f * (float)(x + y), (x - y) / 4);
        s->whole[i]  = (uint32_t)(x * 1000003 + y);
    }
}

static exr_file_spec spec_of(const samples *s, exr_compression_t compression, int tile)
{
    return (exr_file_spec){.width         = WIDTH,
                           .height        = HEIGHT,
                           .compression   = compression,
                           .tile_width    = tile,
                           .tile_height   = tile,
                           .channels      = {{"F", EXR_PIXEL_FLOAT, s->single, 0},
                                             {"H", EXR_PIXEL_HALF, s->half, 0},
                                             {"U", EXR_PIXEL_UINT, s->whole, 0}},
                           .channel_count = 3};
}

/* PXR24 keeps 24 bits of a float, rounded: half a unit of 15 bits of fraction.  B44 keeps 4 x 4
 * halves as 14 bytes: differences of 6 bits and a common shift, so an error of a few units of what
 * the block spans; with the ramps of make_samples that is below 16 units of a half. */
static bool samples_match(const assay_image *image, const samples *s, exr_compression_t compression)
{
    assay_channel f, h, u;
    const bool    b44 = compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
    const double  f_slack = compression == EXR_COMPRESSION_PXR24 ? 0x1p-16 : 0.0;
    const double  h_slack = b44 ? 16.0 * 0x1p-10 : 0.0;
    bool          good    = assay_image_find_channel(image, "F", &f) &&
                assay_image_find_channel(image, "H", &h) &&
                assay_image_find_channel(image, "U", &u) && f.type == ASSAY_CHANNEL_FLOAT &&
                h.type == ASSAY_CHANNEL_FLOAT && u.type == ASSAY_CHANNEL_UINT;
    for (int i = 0; i < PIXELS && good; i++) {
        const double half = half_value(s->half[i]), single = (double)s->single[i];
        good = fabs((double)f.data.f32[i] - single) <= f_slack * single &&
               fabs((double)h.data.f32[i] - half) <= h_slack * half && u.data.u32[i] == s->whole[i];
    }
    return good;
}

static void check_samples(const assay_image *image, const samples *s, exr_compression_t compression)
{
    assert_true(samples_match(image, s, compression));
    for (int c = 0; c < 3; c++) { /* one value off by 4 % or by one must be seen */
        const assay_channel channel = assay_image_channel_at(image, c);
        const uint32_t      kept    = channel.data.u32[PIXELS - 1];
        if (channel.type == ASSAY_CHANNEL_FLOAT) {
            channel.data.f32[PIXELS - 1] *= 1.04f;
        } else {
            channel.data.u32[PIXELS - 1] ^= 1u;
        }
        assert_false(samples_match(image, s, compression));
        channel.data.u32[PIXELS - 1] = kept;
    }
}

static void every_compression_is_read(void **state)
{
    static const exr_compression_t all[] = {
        EXR_COMPRESSION_NONE, EXR_COMPRESSION_RLE,   EXR_COMPRESSION_ZIPS, EXR_COMPRESSION_ZIP,
        EXR_COMPRESSION_PIZ,  EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44,  EXR_COMPRESSION_B44A};
    static samples s;
    make_samples(&s);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        for (int tile = 0; tile <= 24; tile += 12) {
            const exr_file_spec spec  = spec_of(&s, all[i], tile);
            size_t              count = 0;
            uint8_t            *bytes = exr_file_bytes(&spec, &count);
            assay_image        *image = NULL;
            assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image), ASSAY_OK);
            check_samples(image, &s, all[i]);
            assay_image_destroy(image);
            free(bytes);
        }
    }
}

/* Changes a header byte by what stands before it; false where that is not there. */
static uint8_t *find(uint8_t *bytes, size_t count, const char *text, size_t length)
{
    uint8_t *at = memmem(bytes, count, text, length);
    assert_non_null(at);
    return at + length;
}

static void unknown_compressions_are_named(void **state)
{
    static samples s;
    make_samples(&s);
    const exr_file_spec spec  = spec_of(&s, EXR_COMPRESSION_ZIP, 0);
    size_t              count = 0;
    uint8_t            *bytes = exr_file_bytes(&spec, &count);
    assay_image        *image = NULL;
    uint8_t            *at    = find(bytes, count, "compression\0compression\0\1\0\0\0", 28);
    *at                       = EXR_COMPRESSION_DWAB;
    assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image),
                     ASSAY_ERR_UNSUPPORTED);
    assert_non_null(strstr(assay_context_error(*state), "DWAB"));
    *at = 77;
    assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image), ASSAY_ERR_FORMAT);
    assert_null(image);
    free(bytes);
}

/* What compression does not make smaller is stored as it is, and must not be decompressed: an
 * uncompressed tiled file with another name for its compression is such a file. */
static void chunks_stored_raw_are_taken_as_they_are(void **state)
{
    static samples s;
    make_samples(&s);
    const exr_file_spec spec  = spec_of(&s, EXR_COMPRESSION_NONE, 16);
    size_t              count = 0;
    uint8_t            *bytes = exr_file_bytes(&spec, &count);
    uint8_t            *at    = find(bytes, count, "compression\0compression\0\1\0\0\0", 28);
    for (int compression = 0; compression < EXR_COMPRESSION_DWAA; compression++) {
        assay_image *image = NULL;
        *at                = (uint8_t)compression;
        assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image), ASSAY_OK);
        check_samples(image, &s, EXR_COMPRESSION_NONE);
        assay_image_destroy(image);
    }
    free(bytes);
}

static void mipmaps_give_their_first_level(void **state)
{
    static samples s;
    make_samples(&s);
    exr_file_spec spec = spec_of(&s, EXR_COMPRESSION_ZIP, 16);
    spec.mipmap        = true;
    size_t       count = 0;
    uint8_t     *bytes = exr_file_bytes(&spec, &count);
    assay_image *image = NULL;
    assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image), ASSAY_OK);
    check_samples(image, &s, EXR_COMPRESSION_ZIP);
    assay_image_destroy(image);
    free(bytes);
}

/* Reads the spec with a display window; every pixel must be the sample there, or 0. */
static void check_window(assay_context *context, exr_file_spec spec, const samples *s,
                         exr_attr_box2i_t display)
{
    size_t count        = 0;
    spec.display        = display;
    uint8_t      *bytes = exr_file_bytes(&spec, &count);
    assay_image  *image = NULL;
    assay_channel u;
    memory.log[0] = 0;
    assert_int_equal(assay_image_decode(context, bytes, count, "x", NULL, &image), ASSAY_OK);
    assert_int_equal(assay_image_width(image), display.max.x - display.min.x + 1);
    assert_int_equal(assay_image_height(image), display.max.y - display.min.y + 1);
    assert_true(assay_image_find_channel(image, "U", &u));
    for (int y = display.min.y; y <= display.max.y; y++) {
        for (int x = display.min.x; x <= display.max.x; x++) {
            const int  dx = x - spec.x, dy = y - spec.y;
            const bool in = dx >= 0 && dx < WIDTH && dy >= 0 && dy < HEIGHT;
            assert_int_equal(
                u.data.u32[(y - display.min.y) * assay_image_width(image) + x - display.min.x],
                in ? s->whole[dy * WIDTH + dx] : 0);
        }
    }
    assert_non_null(strstr(memory.log, "window"));
    assay_image_destroy(image);
    free(bytes);
}

static void the_image_is_the_display_window(void **state)
{
    static const exr_attr_box2i_t displays[] = {{{.x = -10, .y = -20}, {.x = 99, .y = 99}},
                                                {{.x = 7, .y = -3}, {.x = 20, .y = 9}},
                                                {{.x = -30, .y = 40}, {.x = 5, .y = 200}},
                                                {{.x = 41, .y = 62}, {.x = 41, .y = 62}}};
    static samples                s;
    make_samples(&s);
    for (int tile = 0; tile <= 16; tile += 16) {
        for (size_t i = 0; i < sizeof displays / sizeof *displays; i++) {
            exr_file_spec spec = spec_of(&s, EXR_COMPRESSION_ZIP, tile);
            spec.x             = -5;
            spec.y             = 3;
            check_window(*state, spec, &s, displays[i]);
        }
    }
    exr_file_spec spec = spec_of(&s, EXR_COMPRESSION_ZIP, 0);
    spec.display       = (exr_attr_box2i_t){{.x = 500, .y = 0}, {.x = 600, .y = 10}};
    size_t       count = 0;
    uint8_t     *bytes = exr_file_bytes(&spec, &count);
    assay_image *image = NULL;
    assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image),
                     ASSAY_ERR_UNSUPPORTED);
    free(bytes);
}

static void what_is_not_read_is_refused_by_name(void **state)
{
    static samples s;
    make_samples(&s);
    static const char *const words[] = {"deep", "'U' is subsampled"};
    for (int i = 0; i < 2; i++) {
        exr_file_spec spec = spec_of(&s, EXR_COMPRESSION_ZIPS, 0);
        spec.deep          = i == 0;
        if (i == 1) {
            spec.width = spec.height  = 16;
            spec.channels[2].sampling = 2;
            spec.channels[0].sampling = 1;
        }
        size_t       count = 0;
        uint8_t     *bytes = exr_file_bytes(&spec, &count);
        assay_image *image = NULL;
        assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image),
                         ASSAY_ERR_UNSUPPORTED);
        assert_non_null(strstr(assay_context_error(*state), words[i]));
        free(bytes);
    }
}

static void of_several_parts_the_first_is_read(void **state)
{
    static samples s;
    make_samples(&s);
    exr_file_spec spec = spec_of(&s, EXR_COMPRESSION_ZIP, 0);
    spec.parts         = 2;
    size_t       count = 0;
    uint8_t     *bytes = exr_file_bytes(&spec, &count);
    assay_image *image = NULL;
    memory.log[0]      = 0;
    assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image), ASSAY_OK);
    check_samples(image, &s, EXR_COMPRESSION_ZIP);
    assert_non_null(strstr(memory.log, "first of 2 parts"));
    assay_image_destroy(image);
    free(bytes);
}

static void put32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++) {
        at[i] = (uint8_t)(value >> (8 * i));
    }
}

static void sizes_are_checked_before_memory_is_asked(void **state)
{
    static const struct {
        uint32_t     x, y; /* largest coordinates of both windows */
        assay_status status;
    } rows[] = {{70000, 10, ASSAY_ERR_LIMIT},
                {10, 70000, ASSAY_ERR_LIMIT},
                {60000, 60000, ASSAY_ERR_LIMIT},
                {16000, 16000, ASSAY_ERR_FORMAT}, /* allowed, but more than the file can hold */
                {0xffffffffu, 10, ASSAY_ERR_FORMAT},
                {0x7fffffffu, 0x7fffffffu, ASSAY_ERR_FORMAT}};
    static samples s;
    make_samples(&s);
    const exr_file_spec spec    = spec_of(&s, EXR_COMPRESSION_ZIP, 0);
    size_t              count   = 0;
    uint8_t            *bytes   = exr_file_bytes(&spec, &count);
    uint8_t            *data    = find(bytes, count, "dataWindow\0box2i\0\20\0\0\0", 21);
    uint8_t            *display = find(bytes, count, "displayWindow\0box2i\0\20\0\0\0", 24);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assay_image *image = NULL;
        put32(data + 8, rows[i].x);
        put32(data + 12, rows[i].y);
        memcpy(display, data, 16);
        memory.asked = 0;
        assert_int_equal(assay_image_decode(*state, bytes, count, "x", NULL, &image),
                         rows[i].status);
        assert_int_equal(memory.asked, 0);
        assert_null(image);
    }
    free(bytes);
}

static assay_status read_bytes(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_image       *image = NULL;
    const assay_status status =
        assay_image_decode(context, bytes, count, "broken.exr", NULL, &image);
    assay_image_destroy(image);
    return status;
}

static void broken_files_are_refused(void **state)
{
    static const exr_compression_t all[] = {EXR_COMPRESSION_NONE,  EXR_COMPRESSION_RLE,
                                            EXR_COMPRESSION_ZIP,   EXR_COMPRESSION_PIZ,
                                            EXR_COMPRESSION_PXR24, EXR_COMPRESSION_B44A};
    static samples                 s;
    (void)state;
    make_samples(&s);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        exr_file_spec spec = spec_of(&s, all[i], i % 2 ? 8 : 0);
        spec.width         = 13;
        spec.height        = 19;
        size_t   count     = 0;
        uint8_t *bytes     = exr_file_bytes(&spec, &count);
        broken_truncate(read_bytes, bytes, count);
        assert_true(broken_flip(read_bytes, bytes, count, 1500, i) > 100);
        free(bytes);
    }
}

static assay_status write_and_read(assay_context *context, void *user)
{
    const char  *path  = user;
    assay_image *image = NULL, *back = NULL;
    assay_status status = assay_image_create(context, 5, 4, &image);
    if (status == ASSAY_OK) {
        status = assay_image_add_channel(image, "R", ASSAY_CHANNEL_FLOAT, NULL);
    }
    if (status == ASSAY_OK) {
        status = assay_image_set_attribute(image, "assay:method", "path");
    }
    if (status == ASSAY_OK) {
        status = assay_image_write_exr(image, path);
    }
    if (status == ASSAY_OK) {
        status = assay_image_read(context, path, &back);
    }
    assay_image_destroy(image);
    assay_image_destroy(back);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    temporary t = temporary_create();
    assert_true(failing_each(write_and_read, (void *)temporary_path(&t, "a.exr")) > 10);
    assert_int_equal(temporary_count(&t), 1);
    temporary_destroy(&t);
}

static void only_regular_files_are_read(void **state)
{
    temporary    t     = temporary_create();
    assay_image *image = NULL;
    assert_int_equal(assay_image_read(*state, temporary_path(&t, "none.exr"), &image),
                     ASSAY_ERR_NOT_FOUND);
    assert_non_null(strstr(assay_context_error(*state), "none.exr"));
    assert_int_equal(assay_image_read(*state, t.folder, &image), ASSAY_ERR_NOT_FOUND);
    assert_int_equal(assay_image_read(*state, "/dev/null", &image), ASSAY_ERR_NOT_FOUND);
    assert_int_equal(mkfifo(temporary_path(&t, "pipe"), 0600), 0);
    assert_int_equal(assay_image_read(*state, t.path, &image), ASSAY_ERR_NOT_FOUND);
    assert_non_null(strstr(assay_context_error(*state), "not a regular file"));
    temporary_write(temporary_path(&t, "text"), "hello", 5);
    assert_int_equal(assay_image_read(*state, t.path, &image), ASSAY_ERR_FORMAT);
    temporary_write(temporary_path(&t, "empty"), "", 0);
    assert_int_equal(assay_image_read(*state, t.path, &image), ASSAY_ERR_FORMAT);
    assert_null(image);
    temporary_destroy(&t);
}

static void a_full_disk_is_reported(void **state)
{
    assay_image *image = make_image(*state, 64, 64);
    assert_int_equal(assay_image_write_exr(image, "/dev/full"), ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), "No space left"));
    assert_int_equal(assay_image_write_exr(image, "/dev/null"), ASSAY_OK);
    assay_image_destroy(image);
}

static void shared_maps_are_read_or_refused(void **state)
{
    static const struct {
        const char  *name;
        assay_status status;
    } files[]         = {{"grace_latlong.exr", ASSAY_OK},
                         {"pmndrs_apartment.exr", ASSAY_ERR_UNSUPPORTED},
                         {"pmndrs_city.exr", ASSAY_ERR_UNSUPPORTED},
                         {"pmndrs_studio.exr", ASSAY_ERR_UNSUPPORTED},
                         {"pmndrs_sunset.exr", ASSAY_ERR_UNSUPPORTED},
                         {"royal_esplanade_1k.hdr", ASSAY_OK},
                         {"spiaggia_di_mondello_1k.hdr", ASSAY_OK}};
    const char *named = getenv("ASSAY_SHARED_SCENES");
    const char *root  = named ? named : "../shared/scenes";
    if (access(root, R_OK) != 0) {
        skip();
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char         path[600];
        assay_image *image = NULL;
        snprintf(path, sizeof path, "%s/hdri/%s", root, files[i].name);
        const assay_status status = assay_image_read(*state, path, &image);
        print_message("# %-28s %s\n", files[i].name,
                      status == ASSAY_OK ? "read" : assay_context_error(*state));
        assert_int_equal(status, files[i].status);
        if (status == ASSAY_OK) {
            assay_channel r;
            assert_int_equal(assay_image_width(image), 1024);
            assert_int_equal(assay_image_height(image), 512);
            assert_true(assay_image_find_channel(image, "R", &r));
            for (int p = 0; p < 1024 * 512; p++) {
                assert_true(isfinite(r.data.f32[p]) && r.data.f32[p] >= 0.0f);
            }
        }
        assay_image_destroy(image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(round_trip_is_bit_exact, set_up, tear_down),
        cmocka_unit_test(every_half_becomes_its_float),
        cmocka_unit_test_setup_teardown(every_compression_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(unknown_compressions_are_named, set_up, tear_down),
        cmocka_unit_test_setup_teardown(chunks_stored_raw_are_taken_as_they_are, set_up, tear_down),
        cmocka_unit_test_setup_teardown(mipmaps_give_their_first_level, set_up, tear_down),
        cmocka_unit_test_setup_teardown(the_image_is_the_display_window, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_not_read_is_refused_by_name, set_up, tear_down),
        cmocka_unit_test_setup_teardown(of_several_parts_the_first_is_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sizes_are_checked_before_memory_is_asked, set_up,
                                        tear_down),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test(refused_memory_is_reported),
        cmocka_unit_test_setup_teardown(only_regular_files_are_read, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_full_disk_is_reported, set_up, tear_down),
        cmocka_unit_test_setup_teardown(shared_maps_are_read_or_refused, set_up, tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
