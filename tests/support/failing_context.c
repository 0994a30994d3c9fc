/* failing_context.c - malloc with a counter. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "failing_context.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *allocate(void *user, size_t bytes)
{
    failing_memory *memory = user;
    if (++memory->asked == memory->fail_at) {
        return NULL;
    }
    void *block = malloc(bytes);
    memory->live += block != NULL;
    return block;
}

static void release(void *user, void *block)
{
    failing_memory *memory = user;
    memory->live--;
    free(block);
}

static void keep_line(void *user, assay_log_level level, const char *line)
{
    failing_memory *memory = user;
    (void)level;
    snprintf(memory->log, sizeof memory->log, "%s", line);
}

static bool count_progress(void *user, const char *phase, double fraction)
{
    failing_memory *memory = user;
    assert_non_null(phase);
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return ++memory->progress_calls != memory->cancel_at;
}

assay_context *failing_context(failing_memory *memory)
{
    const assay_context_options options   = {.threads   = 1,
                                             .allocator = {allocate, release, memory},
                                             .log       = keep_line,
                                             .progress  = count_progress,
                                             .user      = memory};
    const uint64_t              fail_at   = memory->fail_at;
    const uint64_t              cancel_at = memory->cancel_at;
    assay_context              *context   = NULL;
    *memory                               = (failing_memory){0};
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    memory->fail_at   = fail_at;
    memory->cancel_at = cancel_at;
    memory->asked     = 0;
    return context;
}

static failing_memory COUNTED;

int counted_set_up(void **state)
{
    *state = failing_context(&COUNTED);
    return 0;
}

int counted_tear_down(void **state)
{
    assert_int_equal(COUNTED.live, 1);
    assay_context_destroy(*state);
    return 0;
}

int failing_each(assay_status (*work)(assay_context *context, void *user), void *user)
{
    for (int n = 1; n < 10000; n++) {
        failing_memory     memory  = {.fail_at = (uint64_t)n};
        assay_context     *context = failing_context(&memory);
        const assay_status status  = work(context, user);
        if (memory.live != 1) {
            fail_msg("%d blocks are left after refusal %d", (int)memory.live - 1, n);
        }
        if (memory.asked >= memory.fail_at) {
            assert_int_equal(status, ASSAY_ERR_MEMORY);
            assert_true(strlen(assay_context_error(context)) > 0);
        } else {
            assert_int_equal(status, ASSAY_OK);
        }
        assay_context_destroy(context);
        if (status == ASSAY_OK) {
            return n - 1;
        }
    }
    fail_msg("refusals do not end");
    return 0;
}
