/* verify_judge.h - from channels that are ready to the findings of a verdict. */
#ifndef ASSAY_ORACLE_VERIFY_JUDGE_H
#define ASSAY_ORACLE_VERIFY_JUDGE_H

#include "oracle/image/critical_values.h"
#include "oracle/image/verify_channel.h"

/* Shares of the level: a third each for pixels, tiles and the whole. */
#define ASSAY_CLASS_COUNT 3

/* Tests of one class over all channels; items say which channel, level and tile or pixel. */
typedef struct {
    assay_multiple_tests    tests;
    assay_multiple_decision decision;
    assay_critical_values   critical; /* of the decision */
} assay_test_class;

typedef struct {
    assay_context              *context;
    const assay_verify_options *options;
    assay_verify_channel       *channels;
    int                         count;
    assay_test_class            pixels, tiles, whole;
    assay_critical_values       power;  /* of what is called visible          */
    assay_critical_values       within; /* of equivalence, at the whole level */
} assay_judgement;

/* "channel << 48 | level << 40 | tile or pixel"; level is ASSAY_TILE_LEVELS for the whole. */
static inline uint64_t assay_test_item(int channel, int level, uint64_t index)
{
    return (uint64_t)channel << 48 | (uint64_t)level << 40 | index;
}
static inline int assay_test_channel(uint64_t item) { return (int)(item >> 48); }
static inline int assay_test_level(uint64_t item) { return (int)(item >> 40 & 0xff); }

assay_judgement assay_judgement_start(assay_context *context, const assay_verify_options *options,
                                      assay_verify_channel *channels, int count);
void            assay_judgement_end(assay_judgement *judgement);

/* Tests a prepared channel's pixels (its images must be there) and regions. Errors: MEMORY,
 * CANCELLED. */
assay_status assay_judge_channel(assay_judgement *judgement, int channel);

/* Decides over all channels, and adds the findings.  Errors: MEMORY. */
assay_status assay_judge(assay_judgement *judgement, assay_verdict *verdict);

/* Allowance of a region for the sum of its differences, as --allow says; NaN where none. */
double assay_judge_allowance(const assay_judgement *judgement, const assay_verify_channel *channel,
                             const assay_noisy_sums *sums);
bool   assay_judge_equivalence(const assay_verify_options *options);

/* ---- verify_findings.c ---- */

assay_status assay_judge_add_pixels(assay_judgement *judgement, int channel,
                                    assay_verdict *verdict);
assay_status assay_judge_add_tiles(assay_judgement *judgement, int channel, int level,
                                   assay_verdict *verdict);
assay_status assay_judge_add_whole(assay_judgement *judgement, int channel, assay_verdict *verdict);
assay_status assay_judge_add_problem(const assay_verify_channel *channel, assay_verdict *verdict);

/* ---- verify_equivalence.c ---- */

assay_status assay_judge_add_equivalence(assay_judgement *judgement, int channel, int level,
                                         assay_verdict *verdict);

/* ---- verify_meaning.c ---- */

/* What a finding of this channel could mean, from all that is known: a constant. */
const char *assay_meaning_of_whole(const assay_judgement *judgement, int channel);
const char *assay_meaning_of_tile(const assay_judgement *judgement, int channel, int level,
                                  uint64_t rejected, double difference);
const char *assay_meaning_of_pixel(const assay_judgement *judgement, int channel, uint64_t rejected,
                                   double difference);

enum { ASSAY_MEANING_SIZE = 640 };

/* The meaning of a failure, and a warning where neighbours of a single image share their noise. */
void assay_meaning_with_neighbours(const assay_verify_channel *channel, const char *meaning,
                                   char words[ASSAY_MEANING_SIZE]);

#endif
