/* bundle_compare.h - an array of a candidate against what a stage makes of the candidate's inputs.
 *
 *     bundle_comparison c = {.out = out, .values = theirs, .stored = how their file rounds};
 *     status = bundle_compare(context, &c);
 *     if (bundle_compare_kind(&c) == ASSAY_VERDICT_FAIL) { ... c.worst ... } */
#ifndef ASSAY_ORACLE_BUNDLE_COMPARE_H
#define ASSAY_ORACLE_BUNDLE_COMPARE_H

#include "assay/verdict.h"
#include "oracle/stage/stage.h"

typedef struct {
    const stage_output *out;
    const double       *values; /* the candidate's */
    rounding            stored; /* `given`: how their type rounds, where it is coarser; else 0 */
    /* What is found. */
    size_t count, unknown;  /* numbers, and those of which nothing is known                     */
    size_t vacuous;         /* whose bound is as large as themselves                            */
    size_t beyond, worst;   /* how many are beyond their bounds; the farthest                   */
    double worst_in_bounds; /* below 0: of none anything is known                              */
    double width, width_90; /* bound / |number|: the median, and what one in ten exceeds; NaN
                               where all numbers are 0                                         */
} bundle_comparison;

/* Errors: MEMORY. */
assay_status bundle_compare(assay_context *context, bundle_comparison *comparison);

double             bundle_compare_bound(const bundle_comparison *comparison, size_t index);
assay_verdict_kind bundle_compare_kind(const bundle_comparison *comparison);

/* |theirs - mine| in units of the last place of mine; NaN where either is not finite. */
double bundle_compare_ulps(assay_precision precision, double mine, double theirs);

/* A sentence or two on what was found, "" where there is nothing to say. */
void bundle_compare_describe(const bundle_comparison *comparison, char *words, size_t size);

#endif
