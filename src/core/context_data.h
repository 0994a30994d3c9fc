/* context_data.h - the inside of a context, for core alone. */
#ifndef ASSAY_CORE_CONTEXT_DATA_H
#define ASSAY_CORE_CONTEXT_DATA_H

#include "core/context.h"

struct assay_context {
    assay_context_options options; /* allocator filled in, threads resolved */
    char                  isa[16]; /* "" for the best                       */
    char                  error[1024];
};

#endif
