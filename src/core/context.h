/* context.h - inside a context: failing, warning, progress. */
#ifndef ASSAY_CORE_CONTEXT_H
#define ASSAY_CORE_CONTEXT_H

#include <stdint.h>

#include "assay/context.h"

/* Records the message and returns the status: `return assay_fail(ctx, ASSAY_ERR_FORMAT, ...)`.
 * Only on the thread that made the call; workers return bare statuses. */
assay_status assay_fail(assay_context *context, assay_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* "out of memory" with the standard words: how much was refused, and how much there is. */
assay_status assay_fail_memory(assay_context *context, const char *what);

void assay_inform(assay_context *context, assay_log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Reports done of total; ASSAY_ERR_CANCELLED (message set) when the user wants to stop. */
assay_status assay_progress(assay_context *context, const char *phase, uint64_t done,
                            uint64_t total);

/* Vector width that trace may use; ASSAY_ISA=sse2|avx2|avx512 in the environment lowers it, for
 * tests only: no result depends on it.  NULL: the best of this machine. */
const char *assay_context_isa(const assay_context *context);

#endif
