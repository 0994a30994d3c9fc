/* test_verify_power.c - false alarms at the stated level, and what is planted is found: a short
 * form of tests/tables/verdict_power.c, with a fixed seed.
 *
 * Images are drawn from pools of samples, so that two images of one pool are the same light, and
 * skewed as a path tracer's are. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "assay/verify.h"
#include "core/parallel.h"
#include "support/noise_pool.h"

enum { SIDE = 32, TILE = 4 };

typedef struct {
    const noise_pool *pool, *reference; /* NULL: the same    */
    int               samples, reference_samples, runs;
    bool              alone; /* the candidate has no variance                */
    bool              exact; /* the reference has the pool's very means */
    noise_defect      defect;
    uint64_t          first;
    atomic_int        failed;
} experiment;

static assay_status compare(void *user, uint64_t index, int worker)
{
    experiment                 *e       = user;
    const assay_context_options options = {.threads = 1};
    assay_context              *context = NULL;
    assay_image                *images[5];
    assay_verdict              *verdict = NULL;
    if (assay_context_create(&options, &context) != ASSAY_OK) {
        return ASSAY_ERR_MEMORY;
    }
    for (int k = 0; k <= e->runs; k++) {
        const uint64_t number = e->first + index * 8 + (uint64_t)k;
        if (k < e->runs) {
            images[k] = noise_pool_draw(context, e->pool, e->samples, number, e->defect);
            images[k] = noise_pool_without(context, images[k], e->alone, false);
        } else if (e->exact) {
            images[k] = noise_pool_exact(context, e->pool, e->reference_samples);
        } else {
            images[k] = noise_pool_draw(context, e->reference ? e->reference : e->pool,
                                        e->reference_samples, number, DEFECT_NONE);
        }
    }
    assay_verify_options how  = assay_verify_options_default();
    how.tile                  = TILE;
    const assay_status status = assay_verdict_create(context, "c", "r", &verdict);
    const assay_status tested = status != ASSAY_OK
                                    ? status
                                    : assay_verify_images((const assay_image *const *)images,
                                                          e->runs, images[e->runs], &how, verdict);
    if (tested == ASSAY_OK && assay_verdict_whole(verdict) == ASSAY_VERDICT_FAIL) {
        atomic_fetch_add(&e->failed, 1);
    }
    assay_verdict_destroy(verdict);
    for (int k = 0; k <= e->runs; k++) {
        assay_image_destroy(images[k]);
    }
    assay_context_destroy(context);
    (void)worker;
    return tested;
}

static int failures(experiment e, int count)
{
    assay_context *context = NULL;
    e.first                = (uint64_t)(e.defect + 1) << 40;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assert_int_equal(assay_parallel_for(context, NULL, (uint64_t)count, compare, &e), ASSAY_OK);
    assay_context_destroy(context);
    return (int)e.failed;
}

/* Of 100 comparisons at a level of 0.01 seven or more fail with a probability of 8e-5. */
static void hold_level(experiment e)
{
    const int failed = failures(e, 100);
    if (failed >= 7) {
        fail_msg("%d of 100 fail at a level of 0.01", failed);
    }
}

static void expect_level(const noise_pool *pool, int samples, int reference_samples, int runs)
{
    hold_level((experiment){
        .pool = pool, .samples = samples, .reference_samples = reference_samples, .runs = runs});
}

/* Another renderer's noise may lie where the reference has none. */
static void noise_that_lies_elsewhere(void **state)
{
    noise_pool *mine   = noise_pool_made_up(NOISE_ELSEWHERE, SIDE);
    noise_pool *theirs = noise_pool_made_up(NOISE_GAUSS, SIDE);
    noise_pool_match(mine, theirs);
    hold_level((experiment){
        .pool = mine, .reference = theirs, .samples = 4, .reference_samples = 64, .runs = 1});
    hold_level((experiment){
        .pool = mine, .reference = theirs, .samples = 32, .reference_samples = 8, .runs = 1});
    hold_level((experiment){.pool              = mine,
                            .reference         = theirs,
                            .samples           = 4,
                            .reference_samples = 64,
                            .runs              = 1,
                            .alone             = true});
    noise_pool_free(mine);
    noise_pool_free(theirs);
    (void)state;
}

static void normal_noise(void **state)
{
    noise_pool *pool = noise_pool_made_up(NOISE_GAUSS, SIDE);
    expect_level(pool, 4, 64, 1);
    expect_level(pool, 3, 3, 1);
    expect_level(pool, 64, 4, 1);
    noise_pool_free(pool);
    (void)state;
}

static void skewed_noise(void **state)
{
    noise_pool *pool = noise_pool_made_up(NOISE_LOGNORMAL, SIDE);
    expect_level(pool, 16, 64, 1);
    expect_level(pool, 4, 16, 4);
    noise_pool_free(pool);
    (void)state;
}

static void rare_bright_samples(void **state)
{
    noise_pool *pool = noise_pool_made_up(NOISE_RARE, SIDE);
    expect_level(pool, 4, 128, 1);
    expect_level(pool, 16, 128, 1);
    expect_level(pool, 64, 16, 1);
    /* A truth that has seen what most pixels of the candidate missed. */
    hold_level((experiment){
        .pool = pool, .samples = 64, .reference_samples = 1000000, .runs = 1, .exact = true});
    noise_pool_free(pool);
    (void)state;
}

/* Many samples: each stands for 16. */
static void what_is_planted_is_found(void **state)
{
    static const noise_defect DEFECTS[] = {DEFECT_LEAK, DEFECT_ENERGY, DEFECT_SHIFT, DEFECT_COLOUR,
                                           DEFECT_CLAMP};
    noise_pool               *few       = noise_pool_made_up(NOISE_RARE, SIDE);
    noise_pool               *normal    = noise_pool_made_up(NOISE_GAUSS, SIDE);
    noise_pool               *many      = noise_pool_batches(normal, 16);
    for (int i = 0; i < 5; i++) {
        const noise_pool *pool = DEFECTS[i] == DEFECT_CLAMP ? few : many;
        const experiment  e    = {
                .pool = pool, .samples = 64, .reference_samples = 64, .runs = 1, .defect = DEFECTS[i]};
        assert_int_equal(failures(e, 10), 10);
    }
    noise_pool_free(few);
    noise_pool_free(normal);
    noise_pool_free(many);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_noise),
        cmocka_unit_test(noise_that_lies_elsewhere),
        cmocka_unit_test(skewed_noise),
        cmocka_unit_test(rare_bright_samples),
        cmocka_unit_test(what_is_planted_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
