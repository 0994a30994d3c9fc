/* alloc.h - the library's only door to memory.
 *
 * Every block comes zeroed from the context's allocator and is counted; sizes are checked for
 * overflow and against the context's memory limit, and a refused block is a status, never an abort.
 * All may be called from several threads. */
#ifndef ASSAY_CORE_ALLOC_H
#define ASSAY_CORE_ALLOC_H

#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

/* count * size bytes of zeros, aligned to 64 bytes; NULL when refused, when count * size overflows,
 * or when it is more than the context's limit leaves.  count 0 gives a block that may be released.
 */
void *assay_allocate(assay_context *context, size_t count, size_t size);
void  assay_release(assay_context *context, void *memory);

/* Makes room for `needed` elements in a growing array, doubling; old content kept, the rest zeroed.
 * On ASSAY_ERR_MEMORY the array is as it was. */
assay_status assay_grow(assay_context *context, void **array, size_t *capacity, size_t needed,
                        size_t size);

/* Asks before work is begun: MEMORY, with a message that says how much is wanted for `what` and how
 * much there is, where so many bytes more would exceed the context's limit. */
assay_status assay_memory_ask(assay_context *context, uint64_t bytes, const char *what);

/* Counts bytes that a foreign library takes and gives back by itself.  False, and nothing counted,
 * where they exceed the limit. */
bool assay_memory_charge(assay_context *context, uint64_t bytes);
void assay_memory_discharge(assay_context *context, uint64_t bytes);

/* A copy of a string; NULL when refused. */
char *assay_copy_text(assay_context *context, const char *text);

#endif
