/* test_exr_sizes.c - pixels that compress to about as many bytes as they are: whatever a chunk's
 * size, they come back to the bit.
 *
 * One chunk of noise in which more and more samples are 0: its compressed size passes that of the
 * samples in steps of a few bytes, so some of the files have it exactly. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "assay/image.h"
#include "core/random.h"
#include "support/failing_context.h"
#include "support/temporary.h"

enum { WIDTH = 24, HEIGHT = 16, PIXELS = WIDTH * HEIGHT, SEEDS = 24, FIRST = 14, LAST = 22 };

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

static void every_size_comes_back(void **state)
{
    temporary   t    = temporary_create();
    const char *path = temporary_path(&t, "image.exr");
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        for (int zeros = FIRST; zeros < LAST; zeros++) {
            assay_image *image = make_image(*state, seed, zeros), *back = NULL;
            assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
            assert_int_equal(assay_image_read(*state, path, &back), ASSAY_OK);
            assert_memory_equal(assay_image_channel_at(image, 0).data.u32,
                                assay_image_channel_at(back, 0).data.u32,
                                PIXELS * sizeof(uint32_t));
            assay_image_destroy(image);
            assay_image_destroy(back);
        }
    }
    temporary_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_size_comes_back, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
