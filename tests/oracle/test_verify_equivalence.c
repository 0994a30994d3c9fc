/* test_verify_equivalence.c - is a bias within the allowance: shown, refuted, or neither. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "assay/verify.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

static void equivalence(void **state)
{
    assay_image *r         = normal_images_make(*state, 15, 0.5, 4096),
                *c         = normal_images_make(*state, 16, 0.5, 4096);
    assay_verify_options o = assay_verify_options_default();
    for (int i = 0; i < PIXELS; i++) {
        normal_images_values(c, "R")[i] *= 1.03F;
    }
    assert_int_equal(normal_images_kind(*state, c, r, NULL), ASSAY_VERDICT_FAIL);
    /* sd of a tile's mean: 0.5 / 64 / 16 sqrt(2) = 0.00069, 0.06 percent */
    o.allow = 0.04;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_PASS);
    o.allow = 0.0302;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_CANNOT_TELL);
    o.allow = 0.02;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_FAIL);
    /* 3 percent of 1 to 1.5 is 0.03 to 0.045 */
    o.allow          = NAN;
    o.allow_absolute = 0.05;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_PASS);
    o.allow_absolute = 0.035;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_FAIL);
    /* Both together are added. */
    o.allow = 0.01;
    assert_int_equal(normal_images_kind(*state, c, r, &o), ASSAY_VERDICT_PASS);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* One tile beyond the allowance fails, whatever the whole has. */
static void equivalence_of_each_tile(void **state)
{
    assay_image *r         = normal_images_make(*state, 15, 0.5, 4096),
                *c         = normal_images_make(*state, 16, 0.5, 4096);
    assay_verify_options o = assay_verify_options_default();
    o.allow                = 0.02;
    for (int y = 0; y < 16; y++) {
        for (int x = 48; x < 64; x++) {
            normal_images_values(c, "R")[y * SIDE + x] *= 0.95F;
        }
    }
    assay_verdict *verdict = normal_images_verify(*state, c, r, &o);
    assert_int_equal(normal_images_find(verdict, "tost-whole").kind, ASSAY_VERDICT_PASS);
    assert_int_equal(normal_images_find(verdict, "tost-16").kind, ASSAY_VERDICT_FAIL);
    assert_int_equal(normal_images_find(verdict, "tost-16").place.x, 48);
    assert_true(normal_images_find(verdict, "tost-16").p < 1e-4);
    assay_verdict_destroy(verdict);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(equivalence, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(equivalence_of_each_tile, counted_set_up,
                                        counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
