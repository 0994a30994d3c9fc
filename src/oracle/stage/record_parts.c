/* record_parts.c - Invariant: a record that may or may not count weighs from 0 on. */
#include "oracle/stage/record_parts.h"

#include "core/alloc.h"
#include "oracle/stage/record_bound.h"

static void add(const stage_records *records, const rounding *r, uint32_t number, assay_vec3 p,
                assay_vec3 n, tracked_sum *weights, record_parts *parts)
{
    const assay_record *record = &records->records[number];
    const weight_bound  w = record_weight_bound(r, records->exact, record, &records->rules, p, n);
    if (w.member == BOUND_OUT) {
        return;
    }
    mean_part *part                = &parts->items[parts->count];
    parts->numbers[parts->count++] = number;
    *part = (mean_part){.low = w.member == BOUND_IN ? w.low : 0.0, .high = w.high};
    if (records->said) {
        record_said_bound(r, records->exact, record, &records->rules, p, n, part->said);
    }
    if (weights) {
        const double counts = assay_record_weight(record, &records->rules, p, n);
        tracked_sum_add(weights, (tracked){counts, fmax(w.high - counts, counts - part->low)});
    }
}

static assay_status make_room(assay_context *context, record_parts *parts)
{
    const size_t wanted = parts->near.count + 1;
    void        *items = parts->items, *numbers = parts->numbers;
    assay_status status =
        assay_grow(context, &items, &parts->capacity, wanted, sizeof *parts->items);
    parts->items = items;
    if (status == ASSAY_OK) {
        status =
            assay_grow(context, &numbers, &parts->number_capacity, wanted, sizeof *parts->numbers);
        parts->numbers = numbers;
    }
    return status;
}

assay_status record_parts_collect(const stage_records *records, const rounding *r,
                                  assay_octree_walk *walk, uint32_t end, assay_vec3 p, assay_vec3 n,
                                  tracked_sum *weights, record_parts *parts)
{
    const assay_status status = stage_records_near(records, walk, p, &parts->near);
    if (status != ASSAY_OK || make_room(records->context, parts) != ASSAY_OK) {
        return ASSAY_ERR_MEMORY;
    }
    parts->count = 0;
    for (size_t i = 0; i < parts->near.count && parts->near.items[i] < end; i++) {
        add(records, r, parts->near.items[i], p, n, weights, parts);
    }
    return ASSAY_OK;
}

void record_parts_release(assay_context *context, record_parts *parts)
{
    assay_release(context, parts->near.items);
    assay_release(context, parts->items);
    assay_release(context, parts->numbers);
}
