/* memory_budget.c - what the blocks of a context may be together.
 *
 * Invariant: memory_used never exceeds the limit, in no order of threads: bytes are added by a
 * compare-and-exchange that looks first, so that a refused block never makes another one fail. */
#include <stdio.h>

#include "core/alloc.h"
#include "core/context_data.h"

bool assay_memory_charge(assay_context *context, uint64_t bytes)
{
    const uint64_t limit = context->options.memory_limit;
    uint_fast64_t  used  = atomic_load_explicit(&context->memory_used, memory_order_relaxed);
    do {
        if (used > limit || bytes > limit - used) {
            atomic_store_explicit(&context->memory_refused, bytes, memory_order_relaxed);
            return false;
        }
    } while (!atomic_compare_exchange_weak_explicit(&context->memory_used, &used, used + bytes,
                                                    memory_order_relaxed, memory_order_relaxed));
    return true;
}

void assay_memory_discharge(assay_context *context, uint64_t bytes)
{
    atomic_fetch_sub_explicit(&context->memory_used, bytes, memory_order_relaxed);
}

enum { SIZE_TEXT = 32 };

/* "1.5 GiB" */
static const char *size_text(uint64_t bytes, char text[SIZE_TEXT])
{
    static const char *const units[] = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    double                   value   = (double)bytes / 1024.0;
    int                      unit    = 0;
    while (value >= 1000.0 && unit < 5) {
        value /= 1024.0;
        unit++;
    }
    if (bytes < 1024) {
        snprintf(text, SIZE_TEXT, "%d bytes", (int)bytes);
    } else {
        snprintf(text, SIZE_TEXT, "%.3g %s", value, units[unit]);
    }
    return text;
}

assay_status assay_fail_memory(assay_context *context, const char *what)
{
    char           wanted[SIZE_TEXT], there[SIZE_TEXT], all[SIZE_TEXT];
    const uint64_t limit   = context->options.memory_limit;
    const uint64_t used    = atomic_load(&context->memory_used);
    const uint64_t refused = atomic_exchange(&context->memory_refused, 0);
    if (refused == 0) {
        return assay_fail(context, ASSAY_ERR_MEMORY, "out of memory for %s", what);
    }
    if (refused <= limit - used) {
        return assay_fail(context, ASSAY_ERR_MEMORY,
                          "out of memory for %s: the system refuses %s (%s are held)", what,
                          size_text(refused, wanted), size_text(used, there));
    }
    return assay_fail(context, ASSAY_ERR_MEMORY,
                      "out of memory for %s: it needs %s, and %s are left of a limit of %s", what,
                      size_text(refused, wanted), size_text(limit - used, there),
                      size_text(limit, all));
}

assay_status assay_memory_ask(assay_context *context, uint64_t bytes, const char *what)
{
    if (bytes <= context->options.memory_limit - atomic_load(&context->memory_used)) {
        return ASSAY_OK;
    }
    atomic_store(&context->memory_refused, bytes);
    return assay_fail_memory(context, what);
}
