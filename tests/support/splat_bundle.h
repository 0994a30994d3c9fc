/* splat_bundle.h - bundles of a small room that is splatted, for verdicts on them: what a right
 * candidate in float would dump, to be spoiled by a test. */
#ifndef ASSAY_TESTS_SPLAT_BUNDLE_H
#define ASSAY_TESTS_SPLAT_BUNDLE_H

#include "assay/replay.h"
#include "support/stage_case.h"

enum { SPLAT_RECORDS = 200, SPLAT_SIDE = 16, SPLAT_PIXELS = SPLAT_SIDE * SPLAT_SIDE };

/* Its arrays. */
enum {
    SPLAT_RECORD_POSITION,
    SPLAT_RECORD_NORMAL,
    SPLAT_RECORD_RADIUS,
    SPLAT_RECORD_IRRADIANCE,
    SPLAT_RECORD_ROTATION,
    SPLAT_RECORD_TRANSLATION,
    SPLAT_POSITION,
    SPLAT_FRAME,
    SPLAT_ALBEDO,
    SPLAT_WEIGHT,
    SPLAT_SUM,
    SPLAT_RESULT,
    SPLAT_DIRECT,
    SPLAT_INDIRECT,
    SPLAT_TOTAL,
    SPLAT_IRRADIANCE_DIRECT,
    SPLAT_IRRADIANCE_INDIRECT,
    SPLAT_IRRADIANCE_TOTAL,
    SPLAT_ARRAY_COUNT
};
enum {
    SPLAT_JUDGED = 6,  /* findings of stages: splat's two, four of one each               */
    SPLAT_INPUTS = 13, /* arrays that no stage makes                                      */
    SPLAT_STANDS = 33, /* a pixel at record 5: its weight is 1e12, or what a float has of it */
    SPLAT_MOST   = 9 * SPLAT_PIXELS
};

typedef struct {
    const char *name, *unit;
    size_t      rows, columns;
} splat_array;

extern const splat_array splat_arrays[SPLAT_ARRAY_COUNT];

typedef struct {
    double values[SPLAT_ARRAY_COUNT][SPLAT_MOST];
} splat_data;

/* To be freed.  Everything is a float. */
splat_data *splat_make_data(assay_context *context);
splat_data *splat_copy(const splat_data *data);
/* All numbers to floats. */
void splat_round(splat_data *data);
/* Stages of our own make what comes after the inputs, rounded to floats. */
void splat_make_stages(assay_context *context, splat_data *data);

/* Adds texts of a manifest and all arrays but `without` (-1: all). */
void splat_add_arrays(const stage_case *c, const splat_data *data, int without);

/* Bundles of both, verified; reference NULL: the candidate alone. */
assay_verdict *splat_verify(assay_context *context, const splat_data *candidate,
                            const splat_data *reference, assay_precision precision);
/* Two bundles that tests have made, not finished yet, of float; ends both. */
assay_verdict *splat_verify_cases(stage_case *candidate, stage_case *reference);

/* Findings of a stage. */
int splat_count_of(const assay_verdict *verdict, const char *stage);
/* The finding to read first. */
assay_finding splat_first(const assay_verdict *verdict);

#endif
