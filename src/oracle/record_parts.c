/* record_parts.c - Invariant: a record that may or may not count weighs from 0 on. */
#include "oracle/record_parts.h"

#include "core/alloc.h"
#include "oracle/record_bound.h"

static void add(const stage_records *records, const rounding *r, const assay_record *record,
                assay_vec3 p, assay_vec3 n, tracked_sum *weights, record_parts *parts)
{
    const weight_bound w = record_weight_bound(r, records->exact, record, &records->rules, p, n);
    if (w.member == BOUND_OUT) {
        return;
    }
    mean_part *part = &parts->items[parts->count++];
    part->low       = w.member == BOUND_IN ? w.low : 0.0;
    part->high      = w.high;
    record_said_bound(r, records->exact, record, &records->rules, p, n, part->said);
    if (weights) {
        const double counts = assay_record_weight(record, &records->rules, p, n);
        tracked_sum_add(weights, (tracked){counts, fmax(w.high - counts, counts - part->low)});
    }
}

assay_status record_parts_collect(const stage_records *records, const rounding *r,
                                  assay_octree_walk *walk, uint32_t end, assay_vec3 p, assay_vec3 n,
                                  tracked_sum *weights, record_parts *parts)
{
    void        *grown  = parts->items;
    assay_status status = stage_records_near(records, walk, p, &parts->near);
    if (status == ASSAY_OK) {
        status = assay_grow(records->context, &grown, &parts->capacity, parts->near.count + 1,
                            sizeof *parts->items);
    }
    if (status != ASSAY_OK) {
        return ASSAY_ERR_MEMORY;
    }
    parts->items = grown;
    parts->count = 0;
    for (size_t i = 0; i < parts->near.count && parts->near.items[i] < end; i++) {
        add(records, r, &records->records[parts->near.items[i]], p, n, weights, parts);
    }
    return ASSAY_OK;
}

void record_parts_release(assay_context *context, record_parts *parts)
{
    assay_release(context, parts->near.items);
    assay_release(context, parts->items);
}
