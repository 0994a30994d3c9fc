/* alloc.c - blocks are aligned to 64 bytes by keeping the allocator's own pointer just before, and
 * beside it the bytes that the block is counted with. */
#include "core/alloc.h"

#include <stdint.h>
#include <string.h>

#include "core/context_data.h"

enum { ALIGNMENT = 64 };

/* Lies before every block. */
typedef struct {
    void  *raw;
    size_t bytes;
} block_head;

void *assay_allocate(assay_context *context, size_t count, size_t size)
{
    const size_t extra = ALIGNMENT + sizeof(block_head);
    if (size && count > (SIZE_MAX - extra) / size) {
        atomic_store(&context->memory_refused, SIZE_MAX);
        return NULL;
    }
    const size_t          bytes     = count * size;
    const assay_allocator allocator = context->options.allocator;
    if (!assay_memory_charge(context, bytes + extra)) {
        return NULL;
    }
    const block_head head = {allocator.allocate(allocator.user, bytes + extra), bytes + extra};
    if (!head.raw) {
        assay_memory_discharge(context, head.bytes);
        atomic_store(&context->memory_refused, head.bytes);
        return NULL;
    }
    const uintptr_t start   = (uintptr_t)head.raw + sizeof head;
    char           *aligned = (char *)head.raw + sizeof head + (-start & (ALIGNMENT - 1));
    memcpy(aligned - sizeof head, &head, sizeof head);
    memset(aligned, 0, bytes);
    return aligned;
}

void assay_release(assay_context *context, void *memory)
{
    if (!memory) {
        return;
    }
    block_head head;
    memcpy(&head, (char *)memory - sizeof head, sizeof head);
    assay_memory_discharge(context, head.bytes);
    context->options.allocator.release(context->options.allocator.user, head.raw);
}

assay_status assay_grow(assay_context *context, void **array, size_t *capacity, size_t needed,
                        size_t size)
{
    if (needed <= *capacity) {
        return ASSAY_OK;
    }
    size_t wanted = *capacity < SIZE_MAX / 2 ? *capacity * 2 : needed;
    if (wanted < needed) {
        wanted = needed;
    }
    if (wanted < 8) {
        wanted = 8;
    }
    void *grown = assay_allocate(context, wanted, size);
    if (!grown) {
        return assay_fail_memory(context, "a growing array");
    }
    if (*array) {
        memcpy(grown, *array, *capacity * size);
        assay_release(context, *array);
    }
    *array    = grown;
    *capacity = wanted;
    return ASSAY_OK;
}

char *assay_copy_text(assay_context *context, const char *text)
{
    const size_t bytes = strlen(text) + 1;
    char        *copy  = assay_allocate(context, bytes, 1);
    if (copy) {
        memcpy(copy, text, bytes);
    }
    return copy;
}

void assay_text_destroy(assay_context *context, char *text) { assay_release(context, text); }
