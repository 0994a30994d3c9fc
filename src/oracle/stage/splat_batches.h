/* splat_batches.h - which records each batch of a splatting has, and at what accuracy. */
#ifndef ASSAY_ORACLE_SPLAT_BATCHES_H
#define ASSAY_ORACLE_SPLAT_BATCHES_H

#include "oracle/stage/stage.h"

/* Records [0, old) once more, and [0, end). */
typedef struct {
    int      number;
    uint32_t old, end;
    double   a;
} splat_batch;

/* The parameters that it reads, beside `a`. */
/* clang-format off */
#define STAGE_BATCH_PARAMS                                                                         \
    {"splat_a", ASSAY_PARAM_REAL, "", "0", 0, 1e3, NULL,                                           \
     "Accuracy of the last batch; 0: a.", "[gautron06] fig. 4.12"},                                \
    {"variant", ASSAY_PARAM_CHOICE, "", "corrected", 0, 0, "corrected|published",                  \
     "published: the last batch has the records of the first one twice.",                          \
     "[gautron06] algorithm 4"},                                                                   \
    {"neighbour_clamp", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                   \
     STAGE_SHRINK_SUMMARY, "[krivanek06]"}
/* Beside splat_a, of the last batch alone. */
#define STAGE_LAST_BATCH_PARAMS                                                                    \
    {"variant", ASSAY_PARAM_CHOICE, "", "corrected", 0, 0, "corrected|published",                  \
     "published: records that count twice are not replayed.", "[gautron06] algorithm 4"},          \
    {"neighbour_clamp", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                   \
     STAGE_SHRINK_SUMMARY, "[krivanek06]"}
#define STAGE_SHRINK_SUMMARY                                                                       \
    "Records shrink while others are made: the last batch alone can be replayed, and it only if "  \
    "no later sweep made records."
/* clang-format on */

/* Whether records are not what they were when they were splatted: a later sweep over other samples
 * has made some, which are beyond the last end, and shrunk those before. */
bool splat_batches_are_stale(const stage_run *run, int ends, size_t records);

/* Records of the last batch, by the input `ends`; without it all.  Errors: DOMAIN. */
assay_status splat_batches_last_end(const stage_run *run, int ends, size_t records,
                                    uint32_t *end_out);

/* From the input `ends` (a row a batch; without it one batch has all); none where they are stale.
 * Release what is made.  Errors: DOMAIN, MEMORY. */
assay_status splat_batches_read(stage_run *run, int ends, size_t records, splat_batch **batches_out,
                                size_t *count_out);

#endif
