/* test_random.c - Philox against published vectors, streams against each other. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "core/random.h"

/* Known answers of Philox4x32-10 from the Random123 distribution's kat_vectors. */
static void philox_known_answers(void **state)
{
    (void)state;
    static const struct {
        uint32_t counter[4], key[2], answer[4];
    } CASES[] = {
        {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
        {{~0u, ~0u, ~0u, ~0u}, {~0u, ~0u}, {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
        {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
         {0xa4093822, 0x299f31d0},
         {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        philox4x32_ctr_t counter;
        philox4x32_key_t key;
        for (int k = 0; k < 4; k++) {
            counter.v[k] = CASES[i].counter[k];
        }
        key.v[0]                      = CASES[i].key[0];
        key.v[1]                      = CASES[i].key[1];
        const philox4x32_ctr_t answer = philox4x32(counter, key);
        for (int k = 0; k < 4; k++) {
            assert_int_equal(answer.v[k], CASES[i].answer[k]);
        }
    }
}

/* The stream's first numbers, from the known answer of counter 0 and key 0. */
static void stream_is_the_generator(void **state)
{
    (void)state;
    assay_random random = assay_random_start(0, ASSAY_STAGE_TEST, 0, 0);
    assert_true(assay_random_next(&random) ==
                (double)((0xe169c58dull << 32 | 0x6627e8d5ull) >> 11) * 0x1p-53);
    assert_true(assay_random_next(&random) ==
                (double)((0x9b00dbd8ull << 32 | 0xbc57ac4cull) >> 11) * 0x1p-53);
}

/* Streams that differ in one part of their address share no number; the same address gives the same
 * numbers. */
static void streams_are_separate(void **state)
{
    (void)state;
    const struct {
        uint64_t    seed;
        assay_stage stage;
        uint64_t    item;
        uint32_t    sample;
    } addresses[] = {{1, ASSAY_STAGE_CAMERA, 2, 3},         {2, ASSAY_STAGE_CAMERA, 2, 3},
                     {1, ASSAY_STAGE_PROBE, 2, 3},          {1, ASSAY_STAGE_CAMERA, 3, 3},
                     {1, ASSAY_STAGE_CAMERA, 2, 4},         {1ull << 32, ASSAY_STAGE_CAMERA, 2, 3},
                     {1, ASSAY_STAGE_CAMERA, 1ull << 40, 3}};
    enum { COUNT = sizeof addresses / sizeof addresses[0] };
    double first[COUNT];
    for (size_t i = 0; i < COUNT; i++) {
        assay_random a = assay_random_start(addresses[i].seed, addresses[i].stage,
                                            addresses[i].item, addresses[i].sample);
        assay_random b = a;
        first[i]       = assay_random_next(&a);
        assert_true(first[i] == assay_random_next(&b));
        for (size_t k = 0; k < i; k++) {
            assert_true(first[i] != first[k]);
        }
    }
}

/* Mean and variance of uniform numbers: 1/2 and 1/12, within 5 standard errors. */
static void moments(void **state)
{
    (void)state;
    enum { N = 1000000 };
    assay_random random = assay_random_start(7, ASSAY_STAGE_TEST, 1, 2);
    double       sum = 0.0, squares = 0.0;
    for (int i = 0; i < N; i++) {
        const double u = assay_random_next(&random);
        assert_true(u >= 0.0 && u < 1.0);
        sum += u;
        squares += (u - 0.5) * (u - 0.5);
    }
    const double mean_error     = 5.0 * 0.28867513459481287 / 1000.0;
    const double variance_error = 5.0 * 0.07453559924999299 / 1000.0; /* sqrt(1/80 - 1/144) */
    assert_true(sum / N > 0.5 - mean_error && sum / N < 0.5 + mean_error);
    assert_true(squares / N > 1.0 / 12.0 - variance_error &&
                squares / N < 1.0 / 12.0 + variance_error);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(philox_known_answers),
        cmocka_unit_test(stream_is_the_generator),
        cmocka_unit_test(streams_are_separate),
        cmocka_unit_test(moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
