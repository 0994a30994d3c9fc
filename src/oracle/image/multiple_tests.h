/* multiple_tests.h - which of many tests reject, so that all of them together hold a level.
 *
 *     assay_multiple_tests tests = assay_multiple_tests_start(context, level);
 *     assay_multiple_tests_add(&tests, log_p, item);        for each of the tests, in any order
 *     status = assay_multiple_tests_decide(&tests, ASSAY_CORRECTION_HOLM, &decision);
 *     assay_multiple_tests_end(&tests);
 *
 * Only those with p <= level are kept (no rule rejects others), so memory is small where nothing is
 * wrong. */
#ifndef ASSAY_ORACLE_MULTIPLE_TESTS_H
#define ASSAY_ORACLE_MULTIPLE_TESTS_H

#include <stddef.h>

#include "assay/verify.h"

typedef struct {
    double   log_p;
    uint64_t item;
} assay_small_p;

typedef struct {
    assay_context *context;
    double         level, log_level;
    uint64_t       count; /* tests added, kept or not */
    assay_small_p *kept;  /* those with p <= level    */
    size_t         kept_count, capacity;
    bool           failed; /* out of memory            */
} assay_multiple_tests;

typedef struct {
    uint64_t tests;     /* that were made                                                        */
    uint64_t rejected;  /* of them                                                               */
    double   log_bound; /* what is rejected has a log p at or below it, what is not above it     */
} assay_multiple_decision;

assay_multiple_tests assay_multiple_tests_start(assay_context *context, double level);

/* log_p NaN counts as a test that does not reject. */
void assay_multiple_tests_add(assay_multiple_tests *tests, double log_p, uint64_t item);

/* Adds tests that are known not to reject, p > level. */
void assay_multiple_tests_add_large(assay_multiple_tests *tests, uint64_t count);

/* Adds what another list, of the same level, holds. */
void assay_multiple_tests_append(assay_multiple_tests *tests, const assay_multiple_tests *more);

/* Holm's step-down rule [holm79] (no false rejection, with probability 1 - level, however the tests
 * depend on one another) or that of [benjamini95] (share of false ones among the rejected at most
 * level on average).  Afterwards kept is sorted by (log_p, item) and its first `rejected` are those
 * that are rejected.  Errors: MEMORY. */
assay_status assay_multiple_tests_decide(assay_multiple_tests *tests, assay_correction correction,
                                         assay_multiple_decision *decision_out);

void assay_multiple_tests_end(assay_multiple_tests *tests);

#endif
