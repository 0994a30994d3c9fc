/* test_image.c - channels, attributes, digest. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <sha2.h>
#include <stdlib.h>
#include <string.h>

#include "assay/image.h"
#include "support/failing_context.h"

static void sizes_are_limited(void **state)
{
    static const int bad[][2] = {{0, 1},     {1, 0},         {-1, 5},        {65537, 1},
                                 {1, 65537}, {65536, 65536}, {16385, 16385}, {-2147483647 - 1, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assay_image *image = NULL;
        assert_int_equal(assay_image_create(*state, bad[i][0], bad[i][1], &image),
                         ASSAY_ERR_ARGUMENT);
        assert_null(image);
    }
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(*state, 65536, 4096, &image), ASSAY_OK);
    assert_int_equal(assay_image_width(image), 65536);
    assert_int_equal(assay_image_height(image), 4096);
    assert_int_equal(assay_image_channel_count(image), 0);
    assay_image_destroy(image);
    assay_image_destroy(NULL);
}

static void channels_are_sorted_and_unique(void **state)
{
    static const char *const added[]  = {"R", "G", "B", "Albedo.R", "a", "Z", "A"};
    static const char *const sorted[] = {"A", "Albedo.R", "B", "G", "R", "Z", "a"};
    assay_image             *image    = NULL;
    assay_channel            channel, first;
    char                     long_name[257];
    memset(long_name, 'n', 256);
    long_name[256] = 0;
    assert_int_equal(assay_image_create(*state, 3, 2, &image), ASSAY_OK);
    for (size_t i = 0; i < 7; i++) {
        const assay_channel_type type = i == 3 ? ASSAY_CHANNEL_UINT : ASSAY_CHANNEL_FLOAT;
        assert_int_equal(assay_image_add_channel(image, added[i], type, i ? &channel : &first),
                         ASSAY_OK);
    }
    for (int i = 0; i < 7; i++) {
        channel = assay_image_channel_at(image, i);
        assert_string_equal(channel.name, sorted[i]);
        assert_int_equal(channel.type, i == 1 ? ASSAY_CHANNEL_UINT : ASSAY_CHANNEL_FLOAT);
        for (int p = 0; p < 6; p++) {
            assert_int_equal(channel.data.u32[p], 0);
        }
    }
    /* What was handed out stays where it is. */
    assert_true(assay_image_find_channel(image, "R", &channel));
    assert_ptr_equal(channel.data.f32, first.data.f32);
    assert_true(assay_image_find_channel(image, "Z", NULL));
    channel.name = "untouched";
    assert_false(assay_image_find_channel(image, "Y", &channel));
    assert_string_equal(channel.name, "untouched");
    assert_int_equal(assay_image_add_channel(image, "R", ASSAY_CHANNEL_UINT, &channel),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_add_channel(image, "", ASSAY_CHANNEL_UINT, &channel),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_add_channel(image, long_name, ASSAY_CHANNEL_UINT, &channel),
                     ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_add_channel(image, long_name + 1, ASSAY_CHANNEL_UINT, NULL),
                     ASSAY_OK);
    assert_int_equal(assay_image_channel_count(image), 8);
    assay_image_destroy(image);
}

static void attributes_are_sorted_and_replaced(void **state)
{
    assay_image *image = NULL;
    const char  *name, *value;
    char         text[] = "three";
    assert_int_equal(assay_image_create(*state, 1, 1, &image), ASSAY_OK);
    assert_null(assay_image_get_attribute(image, "b"));
    assert_int_equal(assay_image_set_attribute(image, "b", "one"), ASSAY_OK);
    assert_int_equal(assay_image_set_attribute(image, "a", "two"), ASSAY_OK);
    assert_int_equal(assay_image_set_attribute(image, "b", text), ASSAY_OK);
    text[0] = 'x';
    assert_int_equal(assay_image_attribute_count(image), 2);
    assay_image_attribute_at(image, 0, &name, &value);
    assert_string_equal(name, "a");
    assert_string_equal(value, "two");
    assert_string_equal(assay_image_get_attribute(image, "b"), "three");
    assert_int_equal(assay_image_set_attribute(image, "", "x"), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_set_attribute(image, "compression", "x"), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_set_attribute(image, "dataWindow", "x"), ASSAY_ERR_ARGUMENT);
    char *long_text = malloc((1u << 24) + 2);
    assert_non_null(long_text);
    memset(long_text, 't', (1u << 24) + 1);
    long_text[(1u << 24) + 1] = 0;
    assert_int_equal(assay_image_set_attribute(image, "c", long_text), ASSAY_ERR_ARGUMENT);
    free(long_text);
    assert_int_equal(assay_image_attribute_count(image), 2);
    assay_image_destroy(image);
}

static void digest_of(const assay_image *image, char out[65]) { assay_image_digest(image, out); }

/* The message written out by hand: text with NUL, then little-endian words. */
static void digest_is_sha256_of_the_stated_bytes(void **state)
{
    static const uint8_t message[] = "assay image 1\0"
                                     "\2\0\0\0\1\0\0\0\2\0\0\0"
                                     "R\0\0\0\0\0\0\0\200\77\0\0\0\200"
                                     "U\0\1\0\0\0\4\3\2\1\377\377\377\377";
    char                 expected[65], digest[65];
    assay_image         *image = NULL;
    assay_channel        r, u;
    assert_int_equal(assay_image_create(*state, 2, 1, &image), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(image, "U", ASSAY_CHANNEL_UINT, &u), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(image, "R", ASSAY_CHANNEL_FLOAT, &r), ASSAY_OK);
    r.data.f32[0] = 1.0f;
    r.data.f32[1] = -0.0f;
    u.data.u32[0] = 0x01020304;
    u.data.u32[1] = 0xffffffff;
    SHA256Data(message, sizeof message - 1, expected);
    digest_of(image, digest);
    assert_string_equal(digest, expected);
    assert_int_equal(assay_image_set_attribute(image, "a", "b"), ASSAY_OK);
    digest_of(image, digest);
    assert_string_equal(digest, expected);
    r.data.f32[1] = 0.0f;
    digest_of(image, digest);
    assert_string_not_equal(digest, expected);
    assay_image_destroy(image);
}

static assay_status make_image(assay_context *context, void *user)
{
    static const char *const names[] = {"a", "c", "b", "d", "e", "f", "g", "h", "i"};
    assay_image             *image   = NULL;
    assay_status             status  = assay_image_create(context, 4, 4, &image);
    (void)user;
    for (size_t i = 0; i < 9 && status == ASSAY_OK; i++) {
        status = assay_image_add_channel(image, names[i], ASSAY_CHANNEL_FLOAT, NULL);
    }
    for (size_t i = 0; i < 9 && status == ASSAY_OK; i++) {
        status = assay_image_set_attribute(image, names[i], "value");
    }
    if (status == ASSAY_OK) {
        status = assay_image_set_attribute(image, "a", "other");
    }
    assay_image_destroy(image);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_int_equal(failing_each(make_image, NULL), 1 + 9 * 2 + 2 + 9 * 2 + 2 + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sizes_are_limited, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(channels_are_sorted_and_unique, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(attributes_are_sorted_and_replaced, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(digest_is_sha256_of_the_stated_bytes, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
