/* alloc.h - the library's only door to memory.
 *
 * Every block comes zeroed from the context's allocator, sizes are checked for overflow, and a
 * refused block is a status, never an abort. */
#ifndef ASSAY_CORE_ALLOC_H
#define ASSAY_CORE_ALLOC_H

#include <stddef.h>

#include "assay/context.h"

/* count * size bytes of zeros, aligned to 64 bytes; NULL when refused or count * size overflows.
 * count 0 gives a block that may be released. */
void *assay_allocate(assay_context *context, size_t count, size_t size);
void  assay_release(assay_context *context, void *memory);

/* Makes room for `needed` elements in a growing array, doubling; old content kept, the rest zeroed.
 * On ASSAY_ERR_MEMORY the array is as it was. */
assay_status assay_grow(assay_context *context, void **array, size_t *capacity, size_t needed,
                        size_t size);

/* A copy of a string; NULL when refused. */
char *assay_copy_text(assay_context *context, const char *text);

#endif
