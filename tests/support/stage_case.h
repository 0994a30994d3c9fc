/* stage_case.h - a bundle that a test makes of its own numbers, and a stage run on it; arithmetic
 * of few digits, as a candidate would do it. */
#ifndef ASSAY_TESTS_STAGE_CASE_H
#define ASSAY_TESTS_STAGE_CASE_H

#include "core/random.h"
#include "io/bundle.h"
#include "oracle/stage/stage.h"

/* ---- bundles ---- */

typedef struct {
    assay_context       *context;
    char                 root[256], path[300];
    assay_bundle        *bundle;
    assay_bundle_reader *reader;
    const assay_scene   *scene; /* of stages that look at one; NULL */
    stage_run            run;
} stage_case;

stage_case stage_case_begin(assay_context *context);
void       stage_case_text(const stage_case *c, const char *key, const char *value);
void       stage_case_table(const stage_case *c, const char *name, const char *unit, size_t rows,
                            size_t columns, const double *values);
/* Finishes the bundle and runs a stage, which must succeed. */
void stage_case_run(stage_case *c, const char *stage, assay_precision precision);
/* Finishes the bundle alone. */
void stage_case_finish(const stage_case *c);
/* An output of the stage by its name; must be there. */
const stage_output *stage_case_output(const stage_case *c, const char *name);
void                stage_case_end(stage_case *c);

/* ---- few digits ---- */

/* What a candidate computes with, and the order in which it adds. */
typedef struct {
    int          digits; /* 11, 24, 53: of the significand */
    assay_random random;
} few_digits;

/* To the nearest number of so many digits, ties to even.  (Not by a cast to float and back: gcc 12
 * leaves that out where it does two of them at once.) */
double few(const few_digits *f, double x);
/* The sum of terms that have so few digits, in an order of chance: one by one, or in halves.
 * Terms are shuffled. */
double few_sum(few_digits *f, size_t count, double *terms);
double few_dot(few_digits *f, size_t count, const double *a, const double *b);

/* ---- comparing ---- */

typedef struct {
    double most;   /* largest |value - right| / bound           */
    size_t beyond; /* how many are above 1                      */
} bound_use;

void bound_use_add(bound_use *use, double value, double right, double bound);

#endif
