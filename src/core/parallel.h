/* parallel.h - loops over independent items; the only room that knows threads. */
#ifndef ASSAY_CORE_PARALLEL_H
#define ASSAY_CORE_PARALLEL_H

#include <stdint.h>

#include "assay/context.h"

/* Does item `index` on worker `worker` (0 <= worker < threads; for scratch memory only).
 * Must write nothing that another item reads. */
typedef assay_status (*assay_parallel_body)(void *user, uint64_t index, int worker);

/* Runs body for each index in [0, count), in any order, on the context's threads.
 * Returns the status of the lowest index that failed (all lower ones were run, so it does not
 * depend on threads); when the progress callback cancels, ASSAY_ERR_CANCELLED.
 * phase may be NULL: no progress.  Each worker runs with denormals on and rounding to nearest, as
 * checked once a worker: ASSAY_ERR_INTERNAL otherwise. */
assay_status assay_parallel_for(assay_context *context, const char *phase, uint64_t count,
                                assay_parallel_body body, void *user);

/* The same for one of several loops that make up a phase: `before` items were done by earlier ones,
 * and all of them have `total`.  Cancelling waits for the item that runs, so long items are better
 * cut up. */
assay_status assay_parallel_part(assay_context *context, const char *phase, uint64_t before,
                                 uint64_t total, uint64_t count, assay_parallel_body body,
                                 void *user);

#endif
