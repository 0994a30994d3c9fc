/* test_noise_model.c - views of the variance, by hand, on 3 x 3 tiles of constant noise. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "core/numerics.h"
#include "oracle/image/noise_model.h"
#include "oracle/image/student.h"
#include "support/failing_context.h"

enum { SIDE = 12, TILE = 4, PIXELS = SIDE * SIDE, IN_TILE = TILE * TILE };

/* Variances of the nine tiles, row by row; means are 2 and 1; 5 and 9 samples. */
typedef struct {
    float            c[PIXELS], r[PIXELS], vc[PIXELS], vr[PIXELS];
    assay_noisy_pair pair;
} images;

static void fill(images *m, const double *candidate, const double *reference)
{
    for (int i = 0; i < PIXELS; i++) {
        const int tile = i / SIDE / TILE * 3 + i % SIDE / TILE;
        m->c[i]        = 2.0F;
        m->r[i]        = 1.0F;
        m->vc[i]       = (float)candidate[tile];
        m->vr[i]       = (float)reference[tile];
    }
    m->pair = (assay_noisy_pair){.width     = SIDE,
                                 .height    = SIDE,
                                 .candidate = {.mean = m->c, .variance = m->vc, .samples = 5},
                                 .reference = {.mean = m->r, .variance = m->vr, .samples = 9}};
}

static void expect_view(const assay_noise *noise, int at, double variance, double degrees)
{
    if (fabs(noise->views[at].variance / variance - 1.0) > 1e-6 ||
        fabs(noise->views[at].degrees / degrees - 1.0) > 1e-6) {
        fail_msg("view %d: %.9g with %.9g degrees, not %.9g with %.9g", at,
                 noise->views[at].variance, noise->views[at].degrees, variance, degrees);
    }
}

static void by_hand(void **state)
{
    /* Ratios c / r: 4 2 2 / 2 2 2 / 2 2 8; over the whole 3; without the largest of nine 2.25. */
    static const double CANDIDATE[] = {4, 2, 2, 2, 2, 2, 2, 2, 8};
    static const double REFERENCE[] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    images              m;
    assay_tile_sums     sums;
    assay_noise_model   model;
    fill(&m, CANDIDATE, REFERENCE);
    assert_int_equal(assay_tile_sums_make(*state, &m.pair, TILE, &sums), ASSAY_OK);
    assert_int_equal(assay_noise_model_fit(*state, &sums.levels[0], ASSAY_NOISE_MODEL_BOTH, &model),
                     ASSAY_OK);
    assert_int_equal(assay_tile_sums_gather(&sums), ASSAY_OK);
    assay_noise_model_light(&sums);
    const double n = IN_TILE, whole = 26.0 / 9.0;
    /* The tile in the middle, 16 pixels: own; by the reference, ratio of the whole; by the
     * candidate, where the ratio near here, 1/2, is larger than 9 / 26; by light, whose event is
     * the mean of c's variances over 2, and r's over 1. */
    const assay_noise tile = assay_noise_of_region(&model, &sums.levels[0].sums[4], 1.0);
    assert_int_equal(tile.count, 5);
    expect_view(&tile, 0, 3 * n, 9 * n * n / (n * (4.0 / 4 + 1.0 / 8)));
    expect_view(&tile, 1, (1 + whole) * n, 8 * n);
    expect_view(&tile, 2, (1 + (6 * 0.5 + 0.25 + 0.125) / 8) * 2 * n, 4 * n);
    expect_view(&tile, 3, (1 + whole / 2) * n, ASSAY_NORMAL);
    expect_view(&tile, 4, (2 + 1 * 2) * n, ASSAY_NORMAL);
    /* Twice the design effect: twice the variances, the same degrees. */
    const assay_noise twice = assay_noise_of_region(&model, &sums.levels[0].sums[4], 2.0);
    expect_view(&twice, 0, 6 * n, tile.views[0].degrees);
    expect_view(&twice, 2, 2 * tile.views[2].variance, 4 * n);
    /* The same of a pixel, with the fewer degrees of both, and what is usual near there. */
    const assay_noise pixel = assay_noise_of_pixel(&model, &m.pair, 5 * SIDE + 5);
    assert_int_equal(pixel.count, 7);
    expect_view(&pixel, 0, 3, 4);
    expect_view(&pixel, 1, 1 + whole, 8);
    expect_view(&pixel, 3, 1 + (26.0 - 8.0) / 8, ASSAY_NORMAL);
    expect_view(&pixel, 4, 2 + 1, ASSAY_NORMAL);
    expect_view(&pixel, 5, 1 + whole / 2, ASSAY_NORMAL);
    /* The whole, whose events are its own. */
    const assay_noise all = assay_noise_of_region(&model, &sums.whole, 1.0);
    expect_view(&all, 0, 26 * n + 9 * n,
                35 * n * 35 * n / (n * (16 + 7 * 4 + 64) / 4.0 + n * 9 / 8.0));
    expect_view(&all, 3, 9 * n + 26 * n / 2, ASSAY_NORMAL);
    assay_noise_model_release(&model);
    assay_tile_sums_release(&sums);
}

/* Variances are 2 to 1; numbers of samples count where they say more, and where both are known. */
static void by_counts(void **state)
{
    static const double CANDIDATE[] = {2, 2, 2, 2, 2, 2, 2, 2, 2};
    static const double REFERENCE[] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
    static const struct {
        double candidate, reference, up, down, candidate_degrees, reference_degrees;
    } CASES[] = {
        {4, 16, 4, 0.5, 3, 15}, {16, 4, 2, 4, 15, 3}, {4, 0, 2, 0.5, 3, 1}, {0, 4, 2, 0.5, 1, 3}};
    const double n = IN_TILE;
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        images            m;
        assay_tile_sums   sums;
        assay_noise_model model;
        fill(&m, CANDIDATE, REFERENCE);
        m.pair.candidate.samples = CASES[i].candidate;
        m.pair.reference.samples = CASES[i].reference;
        assert_int_equal(assay_tile_sums_make(*state, &m.pair, TILE, &sums), ASSAY_OK);
        assert_int_equal(
            assay_noise_model_fit(*state, &sums.levels[0], ASSAY_NOISE_MODEL_COUNTED, &model),
            ASSAY_OK);
        const assay_noise noise = assay_noise_of_region(&model, &sums.levels[0].sums[4], 1.0);
        expect_view(&noise, 1, (1.0 + CASES[i].up) * n, n * CASES[i].reference_degrees);
        expect_view(&noise, 2, (1.0 + CASES[i].down) * 2.0 * n, n * CASES[i].candidate_degrees);
        assay_noise_model_release(&model);
        assay_tile_sums_release(&sums);
    }
}

/* A candidate that is taken as it is, or whose noise is what the differences say: 1 each. */
static void without_a_variance(void **state)
{
    static const double ZERO[9] = {0}, REFERENCE[] = {1, 1, 1, 1, 1, 1, 1, 1, 0.25};
    images              m;
    for (int kind = 1; kind <= 2; kind++) {
        assay_tile_sums   sums;
        assay_noise_model model;
        fill(&m, ZERO, REFERENCE);
        m.pair.candidate.variance = NULL;
        for (int i = 0; i < PIXELS; i++) {
            m.c[i] = i % 2 ? 4.0F : -2.0F; /* squares of 9 */
        }
        assert_int_equal(assay_tile_sums_make(*state, &m.pair, TILE, &sums), ASSAY_OK);
        assert_int_equal(
            assay_noise_model_fit(*state, &sums.levels[0], (assay_noise_model_kind)kind, &model),
            ASSAY_OK);
        assert_int_equal(assay_tile_sums_gather(&sums), ASSAY_OK);
        assay_noise_model_light(&sums);
        const assay_noise noise = assay_noise_of_region(&model, &sums.levels[0].sums[4], 1.0);
        const double      n = IN_TILE, excess = 9 * 9 - 8.25;
        expect_view(&noise, 0, n, 8 * n);
        expect_view(&noise, 1, (kind == ASSAY_NOISE_MODEL_ALONE ? 1 + excess / 8.25 : 1) * n,
                    8 * n);
        if (kind == ASSAY_NOISE_MODEL_ALONE) {
            expect_view(&noise, noise.count - 1, 9 * n, ASSAY_NORMAL);
        }
        assay_noise_model_release(&model);
        assay_tile_sums_release(&sums);
    }
}

/* The largest p of all views; what passes; one-sided: half, or all but half. */
static void probabilities(void **state)
{
    assay_noise noise = {0};
    assert_true(assay_noise_log_p(&noise, 0.0) == 0.0);
    assert_true(assay_noise_log_p(&noise, 1e-300) == -INFINITY);
    assert_true(assay_noise_log_p_one_sided(&noise, -1.0) == 0.0);
    assay_noise_add(&noise, 0.0, 3.0);
    assert_int_equal(noise.count, 0);
    assay_noise_add(&noise, 1.0, 2.0);
    assay_noise_add(&noise, 4.0, ASSAY_NORMAL);
    assert_true(assay_noise_variance(&noise) == 4.0);
    /* 2 degrees: p = 1 - t / sqrt(2 + t^2), larger from some place on than that of the normal */
    for (double size = 0.5; size < 40.0; size += 0.5) {
        const double t = 1.0 - size / sqrt(2.0 + size * size);
        const double z = assay_exp(assay_student_log_p(size / 2.0, ASSAY_NORMAL));
        const double p = assay_exp(assay_noise_log_p(&noise, size));
        assert_true(fabs(p / fmax(t, z) - 1.0) < 1e-9);
    }
    const double large = assay_noise_log_p_one_sided(&noise, -3.0);
    assert_true(fabs(assay_exp(large) - (0.5 + 0.5 * 3.0 / sqrt(11.0))) < 1e-12);
    assay_critical_values critical = assay_critical_values_exact(-9.0);
    const double          bound    = assay_noise_bound(&noise, &critical, NULL);
    assert_true(fabs(assay_noise_log_p(&noise, bound) + 9.0) < 1e-9);
    assay_critical_values table = assay_critical_values_at(-9.0);
    assert_true(assay_noise_bound(&noise, &table, NULL) >= bound * (1.0 - 1e-12));
    assert_true(assay_noise_bound(&noise, &table, &critical) >= 2.0 * bound * (1.0 - 1e-12));
    (void)state;
}

/* Of 2 and 2 samples there are 6 ways, of 3 and 5 there are 56; two are as far apart as it gets. */
static void few_samples(void **state)
{
    assay_critical_values critical = assay_critical_values_exact(-9.0);
    assay_noise           noise    = {.candidate_samples = 2, .reference_samples = 2};
    assert_true(fabs(assay_exp(assay_noise_log_p(&noise, 1.0)) - 1.0 / 3) < 1e-12);
    assert_true(isinf(assay_noise_bound(&noise, &critical, NULL)));
    noise.candidate_samples = 3;
    noise.reference_samples = 5;
    assert_true(fabs(assay_exp(assay_noise_log_p(&noise, 1.0)) - 2.0 / 56) < 1e-12);
    noise.candidate_samples = 64;
    noise.reference_samples = 64;
    assert_true(assay_noise_log_p(&noise, 1.0) < -80.0);
    assert_true(assay_noise_bound(&noise, &critical, NULL) == 0.0);
    assay_noise_add(&noise, 1.0, ASSAY_NORMAL);
    assert_true(assay_noise_log_p(&noise, 3.0) == assay_student_log_p(3.0, ASSAY_NORMAL));
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(by_hand, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(by_counts, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(without_a_variance, counted_set_up, counted_tear_down),
        cmocka_unit_test(probabilities),
        cmocka_unit_test(few_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
