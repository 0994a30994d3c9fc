/* test_core.c - statuses, contexts, memory, hashes, parallel loops. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/hash.h"
#include "core/parallel.h"

static void exit_codes(void **state)
{
    (void)state;
    static const int EXPECTED[] = {0, 2, 2, 2, 2, 2, 3, 3, 2, 130, 4};
    for (int s = ASSAY_OK; s <= ASSAY_ERR_INTERNAL; s++) {
        assert_int_equal(assay_status_exit_code((assay_status)s), EXPECTED[s]);
        assert_string_not_equal(assay_status_text((assay_status)s), "unknown status");
    }
    assert_string_equal(assay_status_text((assay_status)99), "unknown status");
    assert_int_equal(assay_status_exit_code((assay_status)99), 4);
}

static void bad_context_options(void **state)
{
    (void)state;
    assay_context        *context = NULL;
    assay_context_options options = {.threads = -1};
    assert_int_equal(assay_context_create(&options, &context), ASSAY_ERR_ARGUMENT);
    options.threads = 1025;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_ERR_ARGUMENT);
    assert_null(context);
    assay_context_destroy(NULL);
}

/* FIPS 180-4's example, and that texts do not run into one another. */
static void sha256(void **state)
{
    (void)state;
    assay_hash hash;
    char       digest[65], other[65];
    assay_hash_start(&hash);
    assay_hash_add(&hash, "abc", 3);
    assay_hash_finish(&hash, digest);
    assert_string_equal(digest, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    assay_hash_start(&hash);
    assay_hash_add_text(&hash, "ab");
    assay_hash_add_text(&hash, "c");
    assay_hash_finish(&hash, digest);
    assay_hash_start(&hash);
    assay_hash_add_text(&hash, "a");
    assay_hash_add_text(&hash, "bc");
    assay_hash_finish(&hash, other);
    assert_string_not_equal(digest, other);
}

static void memory(void **state)
{
    (void)state;
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assert_null(assay_allocate(context, SIZE_MAX / 2, 4));
    assert_null(assay_allocate(context, SIZE_MAX, 1));
    char *block = assay_allocate(context, 1000, 3);
    assert_non_null(block);
    assert_int_equal((uintptr_t)block % 64, 0);
    for (int i = 0; i < 3000; i++) {
        assert_int_equal(block[i], 0);
    }
    assay_release(context, block);
    assay_release(context, NULL);
    void  *array    = NULL;
    size_t capacity = 0;
    assert_int_equal(assay_grow(context, &array, &capacity, 5, sizeof(int)), ASSAY_OK);
    ((int *)array)[4] = 42;
    assert_int_equal(assay_grow(context, &array, &capacity, 1000, sizeof(int)), ASSAY_OK);
    assert_int_equal(((int *)array)[4], 42);
    assert_int_equal(((int *)array)[999], 0);
    const size_t before = capacity;
    assert_int_equal(assay_grow(context, &array, &capacity, SIZE_MAX / 2, sizeof(int)),
                     ASSAY_ERR_MEMORY);
    assert_int_equal(capacity, before);
    assay_release(context, array);
    assay_context_destroy(context);
}

/* ---- parallel loops ---- */

typedef struct {
    unsigned char *done;
    uint64_t       fail_at[2]; /* UINT64_MAX: nowhere */
} loop_job;

static assay_status mark(void *user, uint64_t index, int worker)
{
    (void)worker;
    loop_job *job = user;
    job->done[index]++;
    if (index == job->fail_at[0]) {
        return ASSAY_ERR_DOMAIN;
    }
    return index == job->fail_at[1] ? ASSAY_ERR_LIMIT : ASSAY_OK;
}

static void every_item_once(void **state)
{
    (void)state;
    enum { COUNT = 10000 };
    for (int threads = 1; threads <= 5; threads++) {
        const assay_context_options options = {.threads = threads};
        assay_context              *context = NULL;
        unsigned char              *done    = calloc(COUNT, 1);
        assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
        loop_job job = {done, {UINT64_MAX, UINT64_MAX}};
        assert_int_equal(assay_parallel_for(context, "test", COUNT, mark, &job), ASSAY_OK);
        for (int i = 0; i < COUNT; i++) {
            assert_int_equal(done[i], 1);
        }
        assert_int_equal(assay_parallel_for(context, "test", 0, mark, &job), ASSAY_OK);
        free(done);
        assay_context_destroy(context);
    }
}

/* Of several failures the one of the lowest index is told, for any number of threads, and every
 * item before it was done. */
static void lowest_failure(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    for (int threads = 1; threads <= 4; threads++) {
        for (int round = 0; round < 50; round++) {
            const assay_context_options options     = {.threads = threads};
            assay_context              *context     = NULL;
            unsigned char               done[COUNT] = {0};
            assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
            loop_job job = {done, {300, 301}};
            assert_int_equal(assay_parallel_for(context, NULL, COUNT, mark, &job),
                             ASSAY_ERR_DOMAIN);
            for (int i = 0; i <= 300; i++) {
                assert_int_equal(done[i], 1);
            }
            assay_context_destroy(context);
        }
    }
}

static bool cancel_at_half(void *user, const char *phase, double fraction)
{
    (void)user;
    (void)phase;
    return fraction < 0.5;
}

static void cancelling(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    const assay_context_options options     = {.threads = 2, .progress = cancel_at_half};
    assay_context              *context     = NULL;
    unsigned char               done[COUNT] = {0};
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    loop_job job = {done, {UINT64_MAX, UINT64_MAX}};
    assert_int_equal(assay_parallel_for(context, "render", COUNT, mark, &job), ASSAY_ERR_CANCELLED);
    assert_non_null(strstr(assay_context_error(context), "render"));
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exit_codes),      cmocka_unit_test(bad_context_options),
        cmocka_unit_test(sha256),          cmocka_unit_test(memory),
        cmocka_unit_test(every_item_once), cmocka_unit_test(lowest_failure),
        cmocka_unit_test(cancelling),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
