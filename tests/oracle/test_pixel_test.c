/* test_pixel_test.c - the tests of pixels against a p for each of them, one after the other. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "core/numerics.h"
#include "oracle/image/pixel_test.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = 48, TILE = 8, PIXELS = SIDE * SIDE, SAMPLES = 1000 };
static const double LEVEL = 0.01;

typedef struct {
    float            c[PIXELS], r[PIXELS], vc[PIXELS], vr[PIXELS];
    assay_noisy_pair pair;
} images;

/* Noise that differs from pixel to pixel, a tenth of them without any, and where planted a
 * difference beyond it in every seventh. */
static void fill(images *m, double noise, bool planted)
{
    for (int i = 0; i < PIXELS; i++) {
        const double size = i % 10 == 3 ? 0.0 : 0.01 * (1 + i % 5);
        m->vc[i]          = (float)(size * size);
        m->vr[i]          = (float)(size * size / 4.0);
        m->r[i] = (float)(1.0 + 0.5 * size * noise * normal_images_deviate(1, (uint64_t)i));
        m->c[i] = (float)(1.0 + size * noise * normal_images_deviate(2, (uint64_t)i) +
                          (planted && i % 7 == 0 ? size * (i % 21) / 2.0 : 0.0));
    }
    m->pair =
        (assay_noisy_pair){.width     = SIDE,
                           .height    = SIDE,
                           .candidate = {.mean = m->c, .variance = m->vc, .samples = SAMPLES},
                           .reference = {.mean = m->r, .variance = m->vr, .samples = SAMPLES}};
}

static double log_p_of(const assay_multiple_tests *tests, uint64_t item)
{
    for (size_t k = 0; k < tests->kept_count; k++) {
        if (tests->kept[k].item == item) {
            return tests->kept[k].log_p;
        }
    }
    return 0.0;
}

/* Those that may be rejected, in the order of pixels, and the one that is most deviations off. */
static size_t compare(const images *m, const assay_noise_model *model,
                      const assay_multiple_tests *tests, const assay_pixel_result *result)
{
    size_t kept = 0, worst = 0;
    double worst_t = 0.0;
    for (size_t i = 0; i < PIXELS; i++) {
        const assay_noisy_sums s     = assay_noisy_pixel(&m->pair, i);
        const assay_noise      noise = assay_noise_of_pixel(model, &m->pair, i);
        const double           size  = assay_noisy_size(&s);
        const double           log_p = assay_noise_log_p(&noise, size);
        const double           t     = size > 0.0 ? size / sqrt(assay_noise_variance(&noise)) : 0.0;
        worst                        = t > worst_t ? i : worst;
        worst_t                      = fmax(worst_t, t);
        if (log_p <= assay_log(LEVEL)) {
            kept++;
            assert_true(log_p_of(tests, 1000 + i) == log_p);
        }
    }
    assert_int_equal(tests->kept_count, kept);
    assert_int_equal(tests->count, PIXELS);
    assert_int_equal(result->worst, worst);
    assert_true(result->worst_t == worst_t);
    return kept;
}

static size_t kept_of(void **state, double noise, bool planted)
{
    static images        m;
    assay_tile_sums      sums;
    assay_noise_model    model;
    assay_pixel_result   result;
    assay_multiple_tests tests = assay_multiple_tests_start(*state, LEVEL);
    fill(&m, noise, planted);
    assert_int_equal(assay_tile_sums_make(*state, &m.pair, TILE, &sums), ASSAY_OK);
    assert_int_equal(assay_noise_model_fit(*state, &sums.levels[0], ASSAY_NOISE_MODEL_BOTH, &model),
                     ASSAY_OK);
    assert_int_equal(assay_pixel_test(*state, &m.pair, &model, 1000, &tests, &result), ASSAY_OK);
    const size_t kept = compare(&m, &model, &tests, &result);
    assay_multiple_tests_end(&tests);
    assay_noise_model_release(&model);
    assay_tile_sums_release(&sums);
    return kept;
}

/* Also where nothing is to be kept, and the worst is far from it. */
static void as_one_by_one(void **state)
{
    const size_t kept = kept_of(state, 1.0, true);
    assert_true(kept > 20 && kept < PIXELS / 2);
    assert_int_equal(kept_of(state, 0.3, false), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(as_one_by_one, counted_set_up, counted_tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
