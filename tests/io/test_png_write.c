/* test_png_write.c - previews, read back through the texture decoder. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assay/image.h"
#include "io/srgb_encode.h"
#include "scene/texture.h"
#include "support/failing_context.h"
#include "support/temporary.h"

/* Linear value at which code k + 1/2 begins, in long double. */
static long double border(int k)
{
    const long double c = (k + 0.5L) / 255.0L;
    return c <= 0.04045L ? c / 12.92L : powl((c + 0.055L) / 1.055L, 2.4L);
}

typedef uint8_t (*encoder)(double linear);

static uint8_t encode_gamma_22(double linear)
{
    return (uint8_t)(255.0 * pow(linear, 1.0 / 2.2) + 0.5);
}

/* Just under and over each border the codes must be those of the curve. */
static bool follows_curve(encoder encode)
{
    for (int k = 0; k < 255; k++) {
        const double at = (double)border(k);
        if (encode(at * (1.0 - 1e-12)) != k || encode(at * (1.0 + 1e-12)) != k + 1) {
            return false;
        }
    }
    return true;
}

static void the_curve_is_exact(void **state)
{
    (void)state;
    assert_true(follows_curve(assay_srgb_encode8));
    assert_false(follows_curve(encode_gamma_22));
    assert_int_equal(assay_srgb_encode8(NAN), 0);
    assert_int_equal(assay_srgb_encode8(-1.0), 0);
    assert_int_equal(assay_srgb_encode8(-0.0), 0);
    assert_int_equal(assay_srgb_encode8(1e300), 255);
    assert_int_equal(assay_srgb_encode8(INFINITY), 255);
    for (int k = 0; k < 256; k++) {
        assert_int_equal(assay_srgb_encode8(assay_srgb_decode8((uint8_t)k)), k);
    }
}

enum { WIDTH = 11, HEIGHT = 5, PIXELS = WIDTH * HEIGHT };

static assay_image *make_image(assay_context *context)
{
    static const char *const names[] = {"R",        "G",   "B",   "Albedo.R", "Albedo.G",
                                        "Albedo.B", "N.X", "N.Y", "N.Z",      "Z"};
    assay_image             *image   = NULL;
    assay_channel            channel;
    assert_int_equal(assay_image_create(context, WIDTH, HEIGHT, &image), ASSAY_OK);
    for (int n = 0; n < 10; n++) {
        assert_int_equal(assay_image_add_channel(image, names[n], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        for (int i = 0; i < PIXELS; i++) {
            channel.data.f32[i] = (float)(((i * 7 + n * 13) % 64) / 32.0 - 0.25);
        }
        channel.data.f32[3] = NAN;
    }
    assert_int_equal(assay_image_add_channel(image, "Id", ASSAY_CHANNEL_UINT, &channel), ASSAY_OK);
    channel.data.u32[0] = 1;
    return image;
}

/* Whether the file shows these channels at 2^exposure. */
static bool shows(assay_context *context, const char *path, const assay_image *image,
                  const char *const names[3], double exposure)
{
    size_t              count = 0;
    uint8_t            *bytes = temporary_read(path, &count);
    assay_texture_image picture;
    bool                same = true;
    assert_int_equal(assay_texture_image_decode(context, bytes, count, path, &picture), ASSAY_OK);
    assert_int_equal(picture.width, WIDTH);
    assert_int_equal(picture.height, HEIGHT);
    assert_int_equal(picture.bits, 8);
    const uint8_t *texels = picture.texels;
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        assert_true(assay_image_find_channel(image, names[c], &channel));
        for (int i = 0; i < PIXELS; i++) {
            const double value = channel.type == ASSAY_CHANNEL_UINT ? (double)channel.data.u32[i]
                                                                    : (double)channel.data.f32[i];
            same = same && texels[4 * i + c] == assay_srgb_encode8(value * exp2(exposure));
        }
    }
    assay_texture_image_release(context, &picture);
    free(bytes);
    return same;
}

static void layers_are_drawn(void **state)
{
    static const struct {
        const char *layer, *names[3];
    } rows[]                        = {{"", {"R", "G", "B"}},
                                       {"Albedo", {"Albedo.R", "Albedo.G", "Albedo.B"}},
                                       {"N", {"N.X", "N.Y", "N.Z"}},
                                       {"Z", {"Z", "Z", "Z"}},
                                       {"Albedo.G", {"Albedo.G", "Albedo.G", "Albedo.G"}},
                                       {"Id", {"Id", "Id", "Id"}}};
    static const double exposures[] = {0.0, -1.5, 3.0};
    temporary           t           = temporary_create();
    assay_image        *image       = make_image(*state);
    const char         *path        = temporary_path(&t, "a.png");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        for (int e = 0; e < 3; e++) {
            assert_int_equal(assay_image_write_png(image, rows[i].layer, exposures[e], path),
                             ASSAY_OK);
            assert_true(shows(*state, path, image, rows[i].names, exposures[e]));
            assert_false(shows(*state, path, image, rows[(i + 1) % 5].names, exposures[e]));
        }
    }
    assert_int_equal(temporary_count(&t), 1);
    assay_image_destroy(image);
    temporary_destroy(&t);
}

static void what_cannot_be_drawn_is_told(void **state)
{
    temporary    t     = temporary_create();
    assay_image *image = make_image(*state);
    const char  *path  = temporary_path(&t, "a.png");
    assert_int_equal(assay_image_write_png(image, "Direct", 0.0, path), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "'Direct'"));
    assert_int_equal(assay_image_write_png(image, "", NAN, path), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_write_png(image, "", INFINITY, path), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_image_write_png(image, "", 2000.0, path), ASSAY_ERR_ARGUMENT);
    assert_int_equal(temporary_count(&t), 0);
    assert_int_equal(assay_image_write_png(image, "", -2000.0, path), ASSAY_OK);
    assert_int_equal(assay_image_write_png(image, "", 0.0, "/dev/full"), ASSAY_ERR_WRITE);
    assert_int_equal(assay_image_write_png(image, "", 0.0, t.folder), ASSAY_ERR_WRITE);
    assay_image_destroy(image);
    temporary_destroy(&t);
}

static assay_status draw(assay_context *context, void *user)
{
    assay_image *image  = NULL;
    assay_status status = assay_image_create(context, 4, 4, &image);
    if (status == ASSAY_OK) {
        status = assay_image_add_channel(image, "Z", ASSAY_CHANNEL_FLOAT, NULL);
    }
    if (status == ASSAY_OK) {
        status = assay_image_write_png(image, "Z", 0.0, user);
    }
    assay_image_destroy(image);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    temporary t = temporary_create();
    (void)state;
    assert_true(failing_each(draw, (void *)temporary_path(&t, "a.png")) > 10);
    assert_int_equal(temporary_count(&t), 1);
    temporary_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_curve_is_exact),
        cmocka_unit_test_setup_teardown(layers_are_drawn, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(what_cannot_be_drawn_is_told, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
