/* radiance_bound.h - how far what a record of radiance says at a point may be from ours. */
#ifndef ASSAY_ORACLE_RADIANCE_BOUND_H
#define ASSAY_ORACLE_RADIANCE_BOUND_H

#include "oracle/stage/turn_bound.h"
#include "record/radiance_rows.h"

/* A worker's own; released by radiance_desk_release. */
typedef struct {
    double *said;           /* 3 rows: what a record says, in the point's frame               */
    double *errors;         /* 3 rows of pairs: how far that may be off                       */
    double *moved;          /* 3 rows: before it is turned                                    */
    double *before, *after; /* 3 rows of pairs: sizes                                  */
    double *scratch;
} radiance_desk;

/* Errors: MEMORY, without a message. */
assay_status radiance_desk_create(assay_context *context, const turn_bound *bound, size_t count,
                                  radiance_desk *desk_out);
void         radiance_desk_release(assay_context *context, radiance_desk *desk);

/* Sets desk->said to what record `number` says at a point, in frame3_from_z of its normal, and
 * desk->errors.  exact: equal numbers that are given are equal to the candidate.  Errors: MEMORY,
 * DOMAIN. */
assay_status radiance_said_bound(const turn_bound *bound, const rounding *r, bool exact,
                                 const assay_radiance_rows *rows, const assay_record *record,
                                 uint32_t number, assay_vec3 position, assay_vec3 normal,
                                 int worker, radiance_desk *desk);

#endif
