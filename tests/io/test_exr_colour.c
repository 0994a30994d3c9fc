/* test_exr_colour.c - what an OpenEXR header says of its colours. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>

#include "io/image_data.h"
#include "io/image_decode.h"
#include "support/exr_files.h"
#include "support/failing_context.h"
#include "support/temporary.h"

static const exr_attr_chromaticities_t P3 = {0.68F, 0.32F, 0.265F,  0.69F,
                                             0.15F, 0.06F, 0.3127F, 0.329F};

static void expect_colour(const assay_image *image)
{
    const char *text    = assay_image_get_attribute(image, "exr:chromaticities");
    float       read[8] = {0.0F};
    assert_non_null(text);
    char *at = (char *)text;
    for (int i = 0; i < 8; i++) {
        read[i] = strtof(at, &at);
    }
    assert_int_equal(*at, '\0');
    assert_memory_equal(read, &P3, sizeof read);
    assert_string_equal(assay_image_get_attribute(image, "exr:acesImageContainerFlag"), "1");
    assert_int_equal(assay_image_attribute_count(image), 2);
}

/* What is no text in a header, as a text; and again after it was written. */
static void colour_of_header(void **state)
{
    static const float  value = 1.0F;
    const exr_file_spec spec  = {.width          = 1,
                                 .height         = 1,
                                 .compression    = EXR_COMPRESSION_NONE,
                                 .channels       = {{"R", EXR_PIXEL_FLOAT, &value, 0}},
                                 .channel_count  = 1,
                                 .chromaticities = &P3,
                                 .aces           = 1};
    temporary           t     = temporary_create();
    const char         *path  = temporary_path(&t, "p3.exr");
    size_t              count = 0;
    uint8_t            *bytes = exr_file_bytes(&spec, &count);
    assay_image        *image = NULL;
    temporary_write(path, bytes, count);
    free(bytes);
    for (int again = 0; again < 2; again++) {
        assert_int_equal(assay_image_read(*state, path, &image), ASSAY_OK);
        expect_colour(image);
        assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
        assay_image_destroy(image);
    }
    temporary_destroy(&t);
}

static void nothing_said(void **state)
{
    static const float  value = 1.0F;
    const exr_file_spec spec  = {.width         = 1,
                                 .height        = 1,
                                 .compression   = EXR_COMPRESSION_NONE,
                                 .channels      = {{"R", EXR_PIXEL_FLOAT, &value, 0}},
                                 .channel_count = 1};
    size_t              count = 0;
    uint8_t            *bytes = exr_file_bytes(&spec, &count);
    assay_image        *image = NULL;
    assert_int_equal(assay_image_decode_exr(*state, bytes, count, "x.exr", NULL, &image), ASSAY_OK);
    assert_int_equal(assay_image_attribute_count(image), 0);
    assay_image_destroy(image);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(colour_of_header, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(nothing_said, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
