/* parallel.c - OpenMP loops that answer the same for any number of threads.
 *
 * Items are handed out one by one in index order, so when the loop stops at the first failing item
 * every lower index has been taken; the lowest failing index then names the result. */
#include "core/parallel.h"

#include <fenv.h>
#include <float.h>
#include <omp.h>
#include <stdatomic.h>

#include "core/context.h"

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
} parallel_loop;

/* Takes items until none is left or one failed; remembers its lowest failure. */
static void work(parallel_loop *loop, int worker, uint64_t *failed_index,
                 assay_status *failed_status)
{
    if (!float_environment_is_sound()) {
        *failed_index  = 0;
        *failed_status = ASSAY_ERR_INTERNAL;
        return;
    }
    while (!atomic_load_explicit(&loop->stop, memory_order_relaxed)) {
        const uint64_t index = atomic_fetch_add(&loop->next, 1);
        if (index >= loop->count) {
            return;
        }
        const assay_status status = loop->body(loop->user, index, worker);
        if (status != ASSAY_OK) {
            *failed_index  = index;
            *failed_status = status;
            atomic_store(&loop->stop, true);
            return;
        }
        const uint64_t done = atomic_fetch_add(&loop->done, 1) + 1;
        if (worker == 0 && loop->phase &&
            assay_progress(loop->context, loop->phase, loop->before + done, loop->total) !=
                ASSAY_OK) {
            *failed_index  = UINT64_MAX;
            *failed_status = ASSAY_ERR_CANCELLED;
            atomic_store(&loop->stop, true);
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
    parallel_loop loop   = {.context = context,
                            .phase   = phase,
                            .before  = before,
                            .total   = total,
                            .count   = count,
                            .body    = body,
                            .user    = user};
    uint64_t      lowest = UINT64_MAX;
    assay_status  result = ASSAY_OK;
    /* The analyzer does not look into OpenMP's regions. NOLINTBEGIN(clang-analyzer-deadcode*) */
    const int threads = count < (uint64_t)assay_context_threads(context)
                            ? (int)count
                            : assay_context_threads(context);
#pragma omp parallel num_threads(threads > 0 ? threads : 1)
    {
        uint64_t     index  = UINT64_MAX;
        assay_status status = ASSAY_OK;
        work(&loop, omp_get_thread_num(), &index, &status);
        if (status != ASSAY_OK) {
#pragma omp critical(assay_parallel_failure)
            if (result == ASSAY_OK || index < lowest) {
                lowest = index;
                result = status;
            }
        }
    }
    /* NOLINTEND(clang-analyzer-deadcode*) */
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
