/* key_table.h - numbers for keys, 0, 1, 2, ... in the order in which they are first seen. */
#ifndef ASSAY_SCENE_KEY_TABLE_H
#define ASSAY_SCENE_KEY_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

typedef struct {
    uint32_t  width, count; /* words a key; keys so far */
    size_t    mask;
    uint32_t *slots, *keys;
} assay_key_table;

/* Room for `capacity` different keys.  False where memory is refused; closing is due all the same.
 */
bool assay_key_table_open(assay_context *context, assay_key_table *table, uint32_t width,
                          size_t capacity);
void assay_key_table_close(assay_context *context, assay_key_table *table);

/* The number of the key: its own, or table->count, which then grows. */
uint32_t assay_key_table_number(assay_key_table *table, const uint32_t *key);

#endif
