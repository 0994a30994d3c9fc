/* record_parts.h - what the records near a point may weigh and say there, for the bound of their
 * mean. */
#ifndef ASSAY_ORACLE_RECORD_PARTS_H
#define ASSAY_ORACLE_RECORD_PARTS_H

#include "oracle/stage/mean_bound.h"
#include "oracle/stage/stage_records.h"

/* A worker's own, begun as {0}. */
typedef struct {
    stage_candidates near;
    mean_part       *items;
    uint32_t        *numbers; /* of the records, ascending */
    size_t           count, capacity, number_capacity;
} record_parts;

/* Of the records below number `end` that may contribute at p with unit normal n; what is said is 0
 * where records have no light.  weights, if it is
 * not NULL, is given the weight of each with its error.  Errors: MEMORY. */
assay_status record_parts_collect(const stage_records *records, const rounding *r,
                                  assay_octree_walk *walk, uint32_t end, assay_vec3 p, assay_vec3 n,
                                  tracked_sum *weights, record_parts *parts);

void record_parts_release(assay_context *context, record_parts *parts);

#endif
