/* key_table.c - open addressing with linear probing.
 *
 * Invariant: at least half of the slots are empty, so a search ends; a slot holds a number + 1, or
 * 0. Numbers depend on the order of the keys alone, never on where a hash puts them. */
#include "scene/key_table.h"

#include <string.h>

#include "core/alloc.h"

bool assay_key_table_open(assay_context *context, assay_key_table *table, uint32_t width,
                          size_t capacity)
{
    size_t slots = 16;
    while (slots < 2 * capacity) {
        slots *= 2;
    }
    *table       = (assay_key_table){.width = width, .mask = slots - 1};
    table->slots = assay_allocate(context, slots, sizeof *table->slots);
    table->keys  = assay_allocate(context, capacity, width * sizeof *table->keys);
    return table->slots && table->keys;
}

void assay_key_table_close(assay_context *context, assay_key_table *table)
{
    assay_release(context, table->slots);
    assay_release(context, table->keys);
}

uint32_t assay_key_table_number(assay_key_table *table, const uint32_t *key)
{
    uint64_t hash = 0;
    for (uint32_t i = 0; i < table->width; i++) {
        hash = (hash ^ key[i]) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 29;
    }
    const size_t bytes = table->width * sizeof *key;
    for (size_t slot = (size_t)hash & table->mask;; slot = (slot + 1) & table->mask) {
        const uint32_t known = table->slots[slot];
        if (known == 0) {
            memcpy(table->keys + (size_t)table->count * table->width, key, bytes);
            table->slots[slot] = ++table->count;
            return table->count - 1;
        }
        if (memcmp(table->keys + (size_t)(known - 1) * table->width, key, bytes) == 0) {
            return known - 1;
        }
    }
}
