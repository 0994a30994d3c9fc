/* verdict.h - what a candidate was found to be: findings in the order of the data's way, the first
 * that is wrong, and the same for people, programs and build servers.
 *
 * A stage is judged by adding findings, in the order in which its arrays are made:
 *
 *     assay_finding finding = assay_finding_default();
 *     finding.stage = "records";  finding.array = "records/irradiance";  finding.test = "rounding";
 *     finding.kind  = worst > 1.0 ? ASSAY_VERDICT_FAIL : ASSAY_VERDICT_PASS;
 *     finding.place = assay_place_row(row, column);
 *     finding.candidate = c;  finding.reference = r;  finding.bound = b;  finding.in_bounds =
 * worst; status = assay_verdict_add(verdict, &finding);
 *
 * What a test does not have stays as assay_finding_default made it and is left out of the outputs.
 * Stages are added in the order of the data's way: "gbuffer" before "image". */
#ifndef ASSAY_VERDICT_H
#define ASSAY_VERDICT_H

#include "assay/context.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The values are exit codes of `assay verify`. */
typedef enum {
    ASSAY_VERDICT_PASS        = 0,
    ASSAY_VERDICT_FAIL        = 1,
    ASSAY_VERDICT_CANNOT_TELL = 2 /* the data do not suffice for either */
} assay_verdict_kind;

typedef enum {
    ASSAY_PLACE_NONE,  /* all of the array                                          */
    ASSAY_PLACE_ROW,   /* of a table: row, column, from 0                           */
    ASSAY_PLACE_PIXEL, /* of an image: x, y, from the top left                      */
    ASSAY_PLACE_TILE   /* of an image: x, y of its top left pixel, width and height */
} assay_place_kind;

typedef struct {
    assay_place_kind kind;
    uint64_t         row;
    int              column;
    int              x, y, width, height;
} assay_place;

/* One test of one array.  Texts are copied when it is added; numbers that a test does not have are
 * NaN. */
typedef struct {
    const char        *stage;   /* "image"                                       */
    const char        *array;   /* "R", "records/irradiance"                     */
    const char        *channel; /* of an array that has several; NULL            */
    const char        *test;    /* "welch", "rounding"                           */
    assay_verdict_kind kind;
    uint64_t           values;    /* that were tested                              */
    uint64_t           unjudged;  /* of the same array, of which nothing is known  */
    uint64_t           vacuous;   /* of `values`: whose bound is as large as they  */
    assay_place        place;     /* the worst of them, also where all pass        */
    double             candidate; /* there, in the array's unit                    */
    double             reference;
    double             effect; /* size of the difference as the test weighs it, signed: of a mean,
                                  relative to the reference's                                   */
    double bound;              /* largest |candidate - reference| that passes, array's unit     */
    double in_bounds;          /* what was found in units of what passes: above 1 is too much   */
    double ulps;               /* |candidate - reference| in units of the last place            */
    double p;                  /* of a difference this large, if there is none; two-sided,
                                  before correction for the number of tests                     */
    double log_p;              /* natural logarithm of p, also where p itself is 0              */
    double visible;            /* smallest bias that would have been seen, array's unit         */
    double width;              /* of the bounds of an array without noise, bound / |value|: the
                                  median, a smaller change of a typical value passes; infinite  */
    double      width_90;      /* likewise: one value in ten may change by more                 */
    const char *meaning;       /* a sentence: what it could mean; NULL                          */
} assay_finding;

/* Passes, says nothing: NaN, NULL, 0. */
ASSAY_API assay_finding assay_finding_default(void);
ASSAY_API assay_place   assay_place_row(uint64_t row, int column);
ASSAY_API assay_place   assay_place_pixel(int x, int y);
ASSAY_API assay_place   assay_place_tile(int x, int y, int width, int height);

typedef struct assay_verdict assay_verdict;

/* candidate and reference are names of what is compared (files), copied.  Errors: MEMORY. */
ASSAY_API assay_status assay_verdict_create(assay_context *context, const char *candidate,
                                            const char *reference, assay_verdict **verdict_out);
ASSAY_API void         assay_verdict_destroy(assay_verdict *verdict);

/* Adds a finding behind the others.  Errors: ARGUMENT (stage, array or test missing or empty, no
 * such kind), MEMORY. */
ASSAY_API assay_status assay_verdict_add(assay_verdict *verdict, const assay_finding *finding);

/* How the tests were made ("level", "0.01"), for the outputs; replaces what has this key.
 * Errors: ARGUMENT (empty key), MEMORY. */
ASSAY_API assay_status assay_verdict_set(assay_verdict *verdict, const char *key,
                                         const char *value);
/* A borrowed text, NULL where there is none. */
ASSAY_API const char *assay_verdict_get(const assay_verdict *verdict, const char *key);

ASSAY_API int assay_verdict_count(const assay_verdict *verdict);
/* Its texts are borrowed from the verdict. */
ASSAY_API assay_finding assay_verdict_at(const assay_verdict *verdict, int index);

/* FAIL where any finding fails; else CANNOT_TELL where any cannot tell, or where there is none:
 * what was not looked at does not pass. */
ASSAY_API assay_verdict_kind assay_verdict_whole(const assay_verdict *verdict);

/* The finding to read first: in the first stage that has a finding of the verdict's kind, the one
 * of that kind farthest from its bound (in_bounds; the first of several).  -1 where all passes. */
ASSAY_API int assay_verdict_first(const assay_verdict *verdict);

/* "pass", "fail", "cannot tell". */
ASSAY_API const char *assay_verdict_kind_text(assay_verdict_kind kind);

/* ---- outputs: texts, to be released with assay_text_destroy; errors: MEMORY ---- */

/* One paragraph for people. */
ASSAY_API assay_status assay_verdict_paragraph(const assay_verdict *verdict, char **text_out);

/* JSON after docs/verdict.schema.json. */
ASSAY_API assay_status assay_verdict_json(const assay_verdict *verdict, char **text_out);

/* JUnit XML: a suite a stage, a case a finding.  What cannot be told is an error there, so that no
 * build server takes it for a pass. */
ASSAY_API assay_status assay_verdict_junit(const assay_verdict *verdict, char **text_out);

/* GitHub's workflow commands, a line a finding that does not pass: `::error ...` where it fails,
 * `::warning ...` where it cannot tell; "" where all passes. */
ASSAY_API assay_status assay_verdict_annotations(const assay_verdict *verdict, char **text_out);

#ifdef __cplusplus
}
#endif
#endif
