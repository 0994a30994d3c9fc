/* Hashes of arrays: of bytes that are laid out here by hand, and of everything that must count. */
#include "support/array_hash.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "core/hash.h"

static int set_up(void **state)
{
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    *state = context;
    return 0;
}

static int tear_down(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

static void hash_bytes(const void *bytes, size_t count, char digest[65])
{
    assay_hash hash;
    assay_hash_start(&hash);
    assay_hash_add(&hash, bytes, count);
    assay_hash_finish(&hash, digest);
}

static assay_array *make_table(assay_context *context, size_t rows, size_t columns,
                               const double *values)
{
    assay_array *table = NULL;
    assert_int_equal(assay_array_create(context, rows, columns, &table), ASSAY_OK);
    memcpy(assay_array_data(table), values, rows * columns * sizeof *values);
    return table;
}

/* 1, -0 and -2 as IEEE 754 has them, and the NaN that stands for all. */
static void test_table(void **state)
{
    static const uint8_t bytes[] =
        "r/x\0<f8\0\x02\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0"
        "\0\0\0\0\0\0\xf0\x3f\0\0\0\0\0\0\0\x80\0\0\0\0\0\0\0\xc0\0\0\0\0\0\0\xf8\x7f";
    const double values[] = {1.0, -0.0, -2.0, -NAN};
    assay_array *table    = make_table(*state, 2, 2, values);
    char         got[65], want[65];
    array_hash_table("r/x", table, got);
    hash_bytes(bytes, sizeof bytes - 1, want);
    assert_string_equal(got, want);
    assay_array_destroy(table);
}

static assay_image *make_image(assay_context *context, const char *first, const char *second,
                               assay_channel_type type, const uint32_t bits[4])
{
    assay_image  *image = NULL;
    assay_channel channel;
    assert_int_equal(assay_image_create(context, 2, 1, &image), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(image, first, type, &channel), ASSAY_OK);
    memcpy(channel.data.u32, bits, 8);
    assert_int_equal(assay_image_add_channel(image, second, type, &channel), ASSAY_OK);
    memcpy(channel.data.u32, bits + 2, 8);
    return image;
}

static void test_image(void **state)
{
    static const uint8_t bytes[] = "p\0<f4\0\x01\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0"
                                   "X\0Y\0\0\0\x80\x3f\0\0\x20\x41\x01\0\0\0\0\0\xc0\x7f";
    const uint32_t       bits[]  = {0x3f800000u, 1u, 0x41200000u, 0xffc00001u};
    assay_image         *image   = make_image(*state, "X", "Y", ASSAY_CHANNEL_FLOAT, bits);
    char                 got[65], want[65];
    array_hash_image("p", image, got);
    hash_bytes(bytes, sizeof bytes - 1, want);
    assert_string_equal(got, want);
    assay_image_destroy(image);
}

/* What would be a NaN among floats is a number among integers. */
static void test_integers(void **state)
{
    static const uint8_t bytes[] = "p\0<u4\0\x01\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0"
                                   "X\0Y\0\x01\0\0\0\x03\0\0\0\x02\0\0\0\x01\0\xc0\xff";
    const uint32_t       bits[]  = {1u, 2u, 3u, 0xffc00001u};
    assay_image         *image   = make_image(*state, "X", "Y", ASSAY_CHANNEL_UINT, bits);
    char                 got[65], want[65];
    array_hash_image("p", image, got);
    hash_bytes(bytes, sizeof bytes - 1, want);
    assert_string_equal(got, want);
    assay_image_destroy(image);
}

/* One bit of one value, the shape, the name, the channels' names and the type: each counts. */
static void test_everything_counts(void **state)
{
    const double   values[] = {1.0, 2.0, 3.0, 4.0}, other[] = {1.0, 2.0, 3.0, 4.0 + 0x1p-50};
    assay_array   *table[] = {make_table(*state, 2, 2, values), make_table(*state, 2, 2, other),
                              make_table(*state, 4, 1, values), make_table(*state, 1, 4, values)};
    const uint32_t bits[] = {1u, 2u, 3u, 4u}, last[] = {1u, 2u, 3u, 5u};
    assay_image   *image[] = {make_image(*state, "X", "Y", ASSAY_CHANNEL_FLOAT, bits),
                              make_image(*state, "X", "Y", ASSAY_CHANNEL_FLOAT, last),
                              make_image(*state, "X", "Z", ASSAY_CHANNEL_FLOAT, bits),
                              make_image(*state, "X", "Y", ASSAY_CHANNEL_UINT, bits)};
    char           digest[10][65];
    for (int i = 0; i < 4; i++) {
        array_hash_table("a", table[i], digest[i]);
        array_hash_image("a", image[i], digest[4 + i]);
    }
    array_hash_table("b", table[0], digest[8]);
    array_hash_image("b", image[0], digest[9]);
    for (int i = 0; i < 10; i++) {
        for (int j = 0; j < i; j++) {
            assert_string_not_equal(digest[i], digest[j]);
        }
    }
    for (int i = 0; i < 4; i++) {
        assay_array_destroy(table[i]);
        assay_image_destroy(image[i]);
    }
}

/* All NaNs are one; zero and minus zero are two. */
static void test_nan_and_zero(void **state)
{
    const double   numbers[4] = {NAN, -NAN, 0.0, -0.0};
    const uint32_t bits[4][4] = {{0x7fc00000u}, {0xff800001u}, {0u}, {0x80000000u}};
    char           table_digest[4][65], image_digest[4][65];
    for (int i = 0; i < 4; i++) {
        assay_array *table = make_table(*state, 1, 1, &numbers[i]);
        assay_image *image = make_image(*state, "X", "Y", ASSAY_CHANNEL_FLOAT, bits[i]);
        array_hash_table("a", table, table_digest[i]);
        array_hash_image("a", image, image_digest[i]);
        assay_array_destroy(table);
        assay_image_destroy(image);
    }
    assert_string_equal(table_digest[0], table_digest[1]);
    assert_string_equal(image_digest[0], image_digest[1]);
    assert_string_not_equal(table_digest[2], table_digest[3]);
    assert_string_not_equal(image_digest[2], image_digest[3]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_table, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_image, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_integers, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_everything_counts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(test_nan_and_zero, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
