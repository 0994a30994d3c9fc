/* test_random.c - Philox against published vectors, streams against each other. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/random.h"

/* One block by the definition of [salmon11], section 3.2, in 128-bit products. */
static void philox_by_definition(const uint64_t counter[4], const uint64_t key[2],
                                 uint64_t block_out[4])
{
    uint64_t x[4] = {counter[0], counter[1], counter[2], counter[3]};
    uint64_t k[2] = {key[0], key[1]};
    for (int round = 0; round < 10; round++) {
        const unsigned __int128 a      = (unsigned __int128)0xd2e7470ee14c6c93u * x[0];
        const unsigned __int128 b      = (unsigned __int128)0xca5a826395121157u * x[2];
        const uint64_t          next[] = {(uint64_t)(b >> 64) ^ x[1] ^ k[0], (uint64_t)b,
                                          (uint64_t)(a >> 64) ^ x[3] ^ k[1], (uint64_t)a};
        memcpy(x, next, sizeof x);
        k[0] += 0x9e3779b97f4a7c15u;
        k[1] += 0xbb67ae8584caa73bu;
    }
    memcpy(block_out, x, sizeof x);
}

/* Known answers of Philox4x64-10 from the Random123 distribution's kat_vectors, for Random123's
 * generator and for the judge of the streams below. */
static void philox_known_answers(void **state)
{
    (void)state;
    static const struct {
        uint64_t counter[4], key[2], answer[4];
    } CASES[] = {
        {{0, 0, 0, 0},
         {0, 0},
         {0x16554d9eca36314cu, 0xdb20fe9d672d0fdcu, 0xd7e772cee186176bu, 0x7e68b68aec7ba23bu}},
        {{~0ul, ~0ul, ~0ul, ~0ul},
         {~0ul, ~0ul},
         {0x87b092c3013fe90bu, 0x438c3c67be8d0224u, 0x9cc7d7c69cd777b6u, 0xa09caebf594f0ba0u}},
        {{0x243f6a8885a308d3u, 0x13198a2e03707344u, 0xa4093822299f31d0u, 0x082efa98ec4e6c89u},
         {0x452821e638d01377u, 0xbe5466cf34e90c6cu},
         {0xa528f45403e61d95u, 0x38c72dbd566e9788u, 0xa5a1610e72fd18b5u, 0x57bd43b5e52b7fe6u}},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof CASES[0]; i++) {
        philox4x64_ctr_t counter;
        philox4x64_key_t key;
        uint64_t         defined[4];
        memcpy(counter.v, CASES[i].counter, sizeof counter.v);
        memcpy(key.v, CASES[i].key, sizeof key.v);
        const philox4x64_ctr_t answer = philox4x64(counter, key);
        philox_by_definition(CASES[i].counter, CASES[i].key, defined);
        assert_memory_equal(answer.v, CASES[i].answer, sizeof answer.v);
        assert_memory_equal(defined, CASES[i].answer, sizeof defined);
    }
}

/* The stream as docs/determinism.md gives it to other programs. */
static void stream_is_the_documented_one(void **state)
{
    (void)state;
    const uint64_t seed = 0xfeedfacecafebeefu, item = 0x0123456789abcdefu, sample = 1ull << 40;
    assay_random   random = assay_random_start(seed, ASSAY_STAGE_PROBE, item, sample);
    for (uint64_t block = 1; block <= 3; block++) {
        const uint64_t counter[] = {block, sample, item, 3}, key[] = {seed, 0};
        uint64_t       words[4];
        philox_by_definition(counter, key, words);
        for (int k = 0; k < 4; k++) {
            assert_true(assay_random_next(&random) == (double)(words[k] >> 11) / 0x1p53);
        }
    }
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
        uint64_t    sample;
    } addresses[] = {
        {1, ASSAY_STAGE_CAMERA, 2, 3},          {2, ASSAY_STAGE_CAMERA, 2, 3},
        {1, ASSAY_STAGE_PROBE, 2, 3},           {1, ASSAY_STAGE_CAMERA, 3, 3},
        {1, ASSAY_STAGE_CAMERA, 2, 4},          {1ull << 32, ASSAY_STAGE_CAMERA, 2, 3},
        {1, ASSAY_STAGE_CAMERA, 1ull << 40, 3}, {1, ASSAY_STAGE_CAMERA, 2, 1ull << 40}};
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
        cmocka_unit_test(stream_is_the_documented_one),
        cmocka_unit_test(streams_are_separate),
        cmocka_unit_test(moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
