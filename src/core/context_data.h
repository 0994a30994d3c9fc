/* context_data.h - the inside of a context, for core alone. */
#ifndef ASSAY_CORE_CONTEXT_DATA_H
#define ASSAY_CORE_CONTEXT_DATA_H

#include <stdatomic.h>

#include "core/context.h"
#include "core/thread_pool.h"

struct assay_context {
    assay_context_options options;        /* allocator, threads and memory limit filled in        */
    atomic_uint_fast64_t  memory_used;    /* bytes of all blocks that are out                     */
    atomic_uint_fast64_t  memory_refused; /* bytes that were refused last and not told yet, or 0  */
    char                  isa[16];        /* "" for the best                                      */
    char                  error[1024];
    assay_thread_pool     pool;      /* of options.threads - 1 helpers                            */
    pthread_t             helpers[]; /* as many                                                   */
};

#endif
