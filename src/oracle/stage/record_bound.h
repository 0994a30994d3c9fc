/* record_bound.h - between which numbers the weight of a record, and what it says, may lie where
 * they are computed with less precision than ours. */
#ifndef ASSAY_ORACLE_RECORD_BOUND_H
#define ASSAY_ORACLE_RECORD_BOUND_H

#include "oracle/stage/tracked.h"
#include "record/record.h"

/* Whether a record contributes. */
typedef enum { BOUND_OUT, BOUND_MAYBE, BOUND_IN } bound_membership;

/* A weight that is counted is in [low, high]; what is MAYBE may as well be 0. */
typedef struct {
    bound_membership member;
    double           value; /* as record.h says it, or would if the record contributed */
    double           low, high;
} weight_bound;

/* exact: equal numbers that are given are equal in the candidate, too (nothing was lost when they
 * were stored). */
weight_bound record_weight_bound(const rounding *r, bool exact, const assay_record *record,
                                 const assay_record_rules *rules, assay_vec3 position,
                                 assay_vec3 normal);

/* What the record says, per channel. */
void record_said_bound(const rounding *r, bool exact, const assay_record *record,
                       const assay_record_rules *rules, assay_vec3 position, assay_vec3 normal,
                       tracked said_out[3]);

/* How far away a record may be and still contribute, m: beyond it it is BOUND_OUT.  coordinate: no
 * smaller than |coordinates| of points, m. */
double record_reach_bound(const rounding *r, const assay_record *record,
                          const assay_record_rules *rules, double coordinate);

#endif
