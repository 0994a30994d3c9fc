/* verify_equivalence.c - two one-sided tests [schuirmann87] of every region against its allowance.
 *
 * Invariant: a channel's regions of one size pass only where each of them is shown to be within its
 * allowance, each at the full level: for all of them together that needs no correction, since the
 * claim is wrong only where one of its parts is [berger82].  They fail where one is shown to be
 * beyond it, corrected as every difference is.  What is neither cannot be told. */
#include <stdio.h>

#include "core/numerics.h"
#include "oracle/image/critical_values.h"
#include "oracle/image/student.h"
#include "oracle/image/verify_judge.h"

typedef struct {
    size_t worst;        /* region with the least sure equivalence     */
    double worst_log_p;  /* of its two tests, the larger               */
    size_t shown, count; /* equivalent; regions                        */
} equivalence;

static const assay_noisy_sums *region(const assay_verify_channel *c, int level, size_t i)
{
    return level == ASSAY_TILE_LEVELS ? &c->sums.whole : &c->sums.levels[level].sums[i];
}

static equivalence look(const assay_judgement *j, const assay_verify_channel *c, int level)
{
    const double log_level = assay_log(j->options->level);
    equivalence  e         = {.worst_log_p = -INFINITY};
    e.count                = level == ASSAY_TILE_LEVELS ? 1 : c->sums.levels[level].count;
    for (size_t i = 0; i < e.count; i++) {
        const assay_noisy_sums *sums  = region(c, level, i);
        const assay_noise       noise = assay_verify_channel_noise(c, level, sums);
        /* Of the two one-sided tests the less sure one. */
        const double log_p = assay_noise_log_p_one_sided(&noise, assay_judge_allowance(j, c, sums) -
                                                                     fabs(sums->difference));
        if (log_p > e.worst_log_p) {
            e.worst       = i;
            e.worst_log_p = log_p;
        }
        e.shown += log_p <= log_level;
    }
    return e;
}

/* The rejected region with the least p of this channel and level. */
static bool find_beyond(const assay_judgement *j, int channel, int level, size_t *region_out,
                        double *log_p_out)
{
    const assay_test_class *class_of = level == ASSAY_TILE_LEVELS ? &j->whole : &j->tiles;
    for (uint64_t i = 0; i < class_of->decision.rejected; i++) {
        const uint64_t item = class_of->tests.kept[i].item;
        if (assay_test_channel(item) == channel && assay_test_level(item) == level) {
            *region_out = (size_t)(item - assay_test_item(channel, level, 0));
            *log_p_out  = class_of->tests.kept[i].log_p;
            return true;
        }
    }
    return false;
}

static void fill(assay_judgement *j, const assay_verify_channel *c, int level, size_t at,
                 assay_finding *f)
{
    const assay_noisy_sums *sums      = region(c, level, at);
    const assay_noise       noise     = assay_verify_channel_noise(c, level, sums);
    const double            allowance = assay_judge_allowance(j, c, sums);
    const double            n         = sums->pixels;
    const double            margin    = assay_noise_bound(&noise, &j->within, NULL);
    f->candidate                      = sums->candidate / n;
    f->reference                      = sums->reference / n;
    f->effect = sums->reference != 0.0 ? sums->difference / fabs(sums->reference) : NAN;
    f->bound  = allowance / n;
    f->in_bounds =
        (fabs(sums->difference) + (f->kind == ASSAY_VERDICT_FAIL ? 0.0 : margin)) / allowance;
    f->visible = (allowance + margin) / n;
    if (level != ASSAY_TILE_LEVELS) {
        f->place = assay_tile_place(&c->sums, level, at);
    }
}

assay_status assay_judge_add_equivalence(assay_judgement *j, int channel, int level,
                                         assay_verdict *verdict)
{
    const assay_verify_channel *c        = &j->channels[channel];
    const equivalence           e        = look(j, c, level);
    size_t                      at       = e.worst;
    char                        test[24] = "tost-whole";
    if (level != ASSAY_TILE_LEVELS) {
        snprintf(test, sizeof test, "tost-%d", c->sums.levels[level].side);
    }
    assay_finding f = assay_finding_default();
    f.stage         = c->stage;
    f.array         = c->name;
    f.test          = test;
    f.values        = e.count;
    if (find_beyond(j, channel, level, &at, &f.log_p)) {
        f.p       = assay_exp(f.log_p);
        f.kind    = ASSAY_VERDICT_FAIL;
        f.meaning = "A difference beyond the allowance is shown: more than the method's bias was "
                    "said to be.";
    } else if (e.shown < e.count) {
        f.kind    = ASSAY_VERDICT_CANNOT_TELL;
        f.meaning = "Neither within nor beyond the allowance is shown: too much noise for an "
                    "allowance so near to the difference.";
    }
    fill(j, c, level, at, &f);
    if (f.kind != ASSAY_VERDICT_FAIL) {
        f.log_p = e.worst_log_p;
        f.p     = assay_exp(f.log_p);
    }
    return assay_verdict_add(verdict, &f);
}
