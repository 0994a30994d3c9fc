/* multiple_tests.c - step-down and step-up rules on the small p alone.
 *
 * Invariant: kept holds exactly the tests with p <= level; both rules compare with at most level,
 * so what was left out could not be rejected.  Order of adding never changes a decision. */
#include "oracle/image/multiple_tests.h"

#include <math.h>
#include <stdlib.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

assay_multiple_tests assay_multiple_tests_start(assay_context *context, double level)
{
    return (assay_multiple_tests){
        .context = context, .level = level, .log_level = assay_log(level)};
}

static bool make_room(assay_multiple_tests *tests, size_t more)
{
    tests->failed =
        tests->failed || assay_grow(tests->context, (void **)&tests->kept, &tests->capacity,
                                    tests->kept_count + more, sizeof *tests->kept) != ASSAY_OK;
    return !tests->failed;
}

void assay_multiple_tests_add(assay_multiple_tests *tests, double log_p, uint64_t item)
{
    tests->count++;
    if (log_p <= tests->log_level && make_room(tests, 1)) {
        tests->kept[tests->kept_count++] = (assay_small_p){log_p, item};
    }
}

void assay_multiple_tests_add_large(assay_multiple_tests *tests, uint64_t count)
{
    tests->count += count;
}

void assay_multiple_tests_append(assay_multiple_tests *tests, const assay_multiple_tests *more)
{
    tests->count += more->count;
    tests->failed = tests->failed || more->failed;
    if (make_room(tests, more->kept_count)) {
        for (size_t i = 0; i < more->kept_count; i++) {
            tests->kept[tests->kept_count++] = more->kept[i];
        }
    }
}

static int compare(const void *a, const void *b)
{
    const assay_small_p *x = a, *y = b;
    if (x->log_p != y->log_p) {
        return x->log_p < y->log_p ? -1 : 1;
    }
    return (x->item > y->item) - (x->item < y->item);
}

/* The first i tests are rejected while p(i) <= level / (tests - i + 1), i from 1. */
static uint64_t holm(const assay_multiple_tests *tests)
{
    size_t i = 0;
    while (i < tests->kept_count &&
           tests->kept[i].log_p <= tests->log_level - assay_log((double)(tests->count - i))) {
        i++;
    }
    return i;
}

/* The first i are rejected for the largest i with p(i) <= i level / tests. */
static uint64_t benjamini_hochberg(const assay_multiple_tests *tests)
{
    const double log_count = assay_log((double)tests->count);
    size_t       i         = tests->kept_count;
    while (i > 0 &&
           tests->kept[i - 1].log_p > tests->log_level + assay_log((double)i) - log_count) {
        i--;
    }
    return i;
}

assay_status assay_multiple_tests_decide(assay_multiple_tests *tests, assay_correction correction,
                                         assay_multiple_decision *decision_out)
{
    if (tests->failed) {
        return assay_fail_memory(tests->context, "the tests that reject");
    }
    if (tests->kept_count > 1) {
        qsort(tests->kept, tests->kept_count, sizeof *tests->kept, compare);
    }
    const bool     holms    = correction == ASSAY_CORRECTION_HOLM;
    const uint64_t rejected = holms ? holm(tests) : benjamini_hochberg(tests);
    /* The step at which the rule stopped. */
    const double last = holms ? 1.0 / fmax(1.0, (double)(tests->count - rejected))
                              : fmax(1.0, (double)rejected) / fmax(1.0, (double)tests->count);
    *decision_out     = (assay_multiple_decision){.tests     = tests->count,
                                                  .rejected  = rejected,
                                                  .log_bound = tests->log_level + assay_log(last)};
    return ASSAY_OK;
}

void assay_multiple_tests_end(assay_multiple_tests *tests)
{
    assay_release(tests->context, tests->kept);
    tests->kept = NULL;
}
