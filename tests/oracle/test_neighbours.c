/* test_neighbours.c - noise that neighbours share is told from noise that they do not, and from a
 * bias; a failure that may come from it says so. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "oracle/image/neighbours.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE, PIXELS = SIDE * SIDE };

static assay_neighbours neighbours_of(const float *candidate, const float *reference)
{
    const assay_noisy_pair pair = {.width     = SIDE,
                                   .height    = SIDE,
                                   .candidate = {.mean = candidate},
                                   .reference = {.mean = reference}};
    return assay_neighbours_of(&pair);
}

/* A checkerboard of signs: neighbours never agree, those four apart always do; a plane: all do. */
static void signs_that_are_known(void **state)
{
    static float c[PIXELS], r[PIXELS];
    (void)state;
    for (int i = 0; i < PIXELS; i++) {
        c[i] = (i % SIDE + i / SIDE) % 2 ? 1.0F : -3.0F;
    }
    assay_neighbours n = neighbours_of(c, r);
    assert_true(n.near == -1.0 && n.far == 1.0 && n.pairs == 2.0 * SIDE * (SIDE - 4));
    assert_false(assay_neighbours_share_noise(&n));
    for (int i = 0; i < PIXELS; i++) {
        c[i] = 0.001F;
    }
    c[77] = 1e9F;
    n     = neighbours_of(c, r);
    assert_true(n.near == 1.0 && n.far == 1.0);
    assert_false(assay_neighbours_share_noise(&n));
    n = neighbours_of(r, r);
    assert_true(n.near == 0.0 && n.far == 0.0);
    n = (assay_neighbours){0};
    assert_false(assay_neighbours_share_noise(&n));
}

/* A box of `width` pixels over the noise; the light itself stays as it is. */
static assay_image *blurred(assay_context *context, uint64_t seed, int width)
{
    assay_image *image = normal_images_make(context, seed, 0.5, 16);
    float       *r     = normal_images_values(image, "R");
    for (int i = 0; i < PIXELS; i++) {
        double sum = 0.0;
        for (int k = 0; k < width * width; k++) {
            const int x = (i % SIDE + k % width) % SIDE, y = (i / SIDE + k / width) % SIDE;
            sum += normal_images_deviate(seed, (uint64_t)(y * SIDE + x));
        }
        r[i] = (float)(normal_images_light(i) + 0.125 * sum / width);
    }
    return image;
}

/* A filter's failure comes with a warning; that of a plain image, however biased, does not.  A box
 * of 3 correlates neighbours by 2/3, whose signs by asin(2/3) / (pi / 2) = 0.46. */
static void shared_noise_is_told(void **state)
{
    assay_image *r = normal_images_make(*state, 15, 0.5, 4096);
    for (int alone = 0; alone < 2; alone++) {
        assay_image *c = blurred(*state, 16, 3);
        if (alone) {
            memset(normal_images_values(c, "Variance.R"), 0, PIXELS * sizeof(float));
        }
        for (int i = 0; i < PIXELS; i++) {
            normal_images_values(c, "R")[i] += 0.03F;
        }
        assay_verdict      *verdict = normal_images_verify(*state, c, r, NULL);
        const assay_finding f       = normal_images_find(verdict, "whole");
        assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
        assert_non_null(strstr(f.meaning, "shares noise"));
        assert_non_null(strstr(f.meaning, "--allow"));
        assay_verdict_destroy(verdict);
        assay_image_destroy(c);
    }
    for (int k = 1; k <= 8; k++) {
        assay_image *c = normal_images_make(*state, 16 + (uint64_t)k, 0.5, 16);
        for (int i = 0; i < PIXELS; i++) {
            normal_images_values(c, "R")[i] += 0.05F * (float)k * (float)(1 + i % SIDE / 32);
        }
        assay_verdict      *verdict = normal_images_verify(*state, c, r, NULL);
        const assay_finding f       = normal_images_find(verdict, "whole");
        assert_int_equal(f.kind, ASSAY_VERDICT_FAIL);
        assert_null(strstr(f.meaning, "shares noise"));
        assay_verdict_destroy(verdict);
        assay_image_destroy(c);
    }
    assay_image_destroy(r);
}

/* A box of 3, by the arcsine law of normal signs, within four standard deviations of so many pairs,
 * which are alike themselves over a box. */
static void arcsine_law(void **state)
{
    assay_image *r = normal_images_make(*state, 15, 0.5, 4096);
    assay_image *c = blurred(*state, 16, 3);
    static float light[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        light[i] = (float)normal_images_light(i);
    }
    const assay_neighbours n    = neighbours_of(normal_images_values(c, "R"), light);
    const double           near = assay_asin(2.0 / 3.0) / (0.5 * ASSAY_PI);
    assert_true(fabs(n.near - near) < 4.0 * 3.0 / sqrt(2.0 * PIXELS));
    assert_true(fabs(n.far) < 4.0 * 3.0 / sqrt(2.0 * PIXELS));
    assert_true(assay_neighbours_share_noise(&n));
    assay_image_destroy(c);
    assay_image_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(signs_that_are_known),
        cmocka_unit_test_setup_teardown(arcsine_law, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(shared_noise_is_told, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
