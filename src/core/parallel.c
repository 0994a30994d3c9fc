/* parallel.c - loops that answer the same for any number of threads.
 *
 * Items are handed out one by one in index order, so when the loop stops at the first failing item
 * every lower index has been taken; the lowest failing index then names the result. */
#include "core/parallel.h"

#include <fenv.h>
#include <float.h>
#include <stdatomic.h>

#include "core/context_data.h"

/* Denormals must be kept and rounding be to nearest: some libraries leave other modes behind. */
static bool float_environment_is_sound(void)
{
    volatile double smallest = DBL_MIN;
    volatile double half     = smallest * 0.5;
    volatile float  tiny     = FLT_MIN;
    volatile float  quarter  = tiny * 0.25F;
    return fegetround() == FE_TONEAREST && half > 0.0 && quarter > 0.0F;
}

typedef struct {
    assay_context       *context;
    const char          *phase;
    uint64_t             before, total, count;
    assay_parallel_body  body;
    void                *user;
    atomic_uint_fast64_t next, done;
    atomic_bool          stop;
    pthread_mutex_t      lock; /* of the lowest failure: */
    uint64_t             failed_index;
    assay_status         failed_status;
} parallel_loop;

static void fail_at(parallel_loop *loop, uint64_t index, assay_status status)
{
    atomic_store(&loop->stop, true);
    pthread_mutex_lock(&loop->lock);
    if (loop->failed_status == ASSAY_OK || index < loop->failed_index) {
        loop->failed_index  = index;
        loop->failed_status = status;
    }
    pthread_mutex_unlock(&loop->lock);
}

/* Takes items until none is left or one failed. */
static void work(void *user, int worker)
{
    parallel_loop *loop = user;
    if (!float_environment_is_sound()) {
        fail_at(loop, 0, ASSAY_ERR_INTERNAL);
        return;
    }
    while (!atomic_load_explicit(&loop->stop, memory_order_relaxed)) {
        const uint64_t index = atomic_fetch_add(&loop->next, 1);
        if (index >= loop->count) {
            return;
        }
        const assay_status status = loop->body(loop->user, index, worker);
        if (status != ASSAY_OK) {
            fail_at(loop, index, status);
            return;
        }
        const uint64_t done = atomic_fetch_add(&loop->done, 1) + 1;
        if (worker == 0 && loop->phase &&
            assay_progress(loop->context, loop->phase, loop->before + done, loop->total) !=
                ASSAY_OK) {
            fail_at(loop, UINT64_MAX, ASSAY_ERR_CANCELLED);
            return;
        }
    }
}

assay_status assay_parallel_for(assay_context *context, const char *phase, uint64_t count,
                                assay_parallel_body body, void *user)
{
    return assay_parallel_part(context, phase, 0, count, count, body, user);
}

assay_status assay_parallel_part(assay_context *context, const char *phase, uint64_t before,
                                 uint64_t total, uint64_t count, assay_parallel_body body,
                                 void *user)
{
    const uint64_t threads = (uint64_t)assay_context_threads(context);
    parallel_loop  loop    = {.context = context,
                              .phase   = phase,
                              .before  = before,
                              .total   = total,
                              .count   = count,
                              .body    = body,
                              .user    = user};
    if (pthread_mutex_init(&loop.lock, NULL) != 0) {
        return ASSAY_ERR_MEMORY;
    }
    if (count > 0) {
        const uint64_t workers = count < threads ? count : threads;
        assay_thread_pool_run(&context->pool, (int)workers - 1, work, &loop);
    }
    pthread_mutex_destroy(&loop.lock);
    const assay_status result = loop.failed_status;
    if (result == ASSAY_ERR_INTERNAL) {
        return assay_fail(context, result,
                          "the floating-point environment flushes denormals or does not round to "
                          "nearest");
    }
    if (result == ASSAY_OK && phase) {
        return assay_progress(context, phase, before + count, total);
    }
    return result;
}
