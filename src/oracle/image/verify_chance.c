/* verify_chance.c - what a candidate's number of samples has to do with a lack of light.
 *
 * Invariant: a failure of a candidate without variance is a failure for every number of samples
 * that it may have, or says for which, or is none.
 *
 * Light that one sample in a thousand finds is missing in most images of few samples, and then no
 * difference between pixels tells that there are few.  The reference saw it and knows its variance
 * v; if the candidate's samples are as noisy as the reference's, the difference of k times fewer
 * samples has variance (1 + k) v.  So a size d is too much at t deviations as long as
 *
 *     k < d^2 / (t^2 v) - 1.
 *
 * The lower tail of non-negative samples is no heavier than the normal one of that variance
 * [maurer03]; too much light is judged elsewhere. */
#include "oracle/image/verify_chance.h"

#include <stdio.h>

double assay_chance_share(const assay_verify_channel *channel, int level,
                          const assay_noisy_sums *sums, assay_critical_values *critical)
{
    const double v = channel->design[level] * sums->reference_variance;
    if (channel->source == ASSAY_NOISE_OWN || sums->difference >= 0.0 || !(v > 0.0)) {
        return 0.0;
    }
    const double degrees =
        sums->reference_spread > 0.0
            ? sums->reference_variance * sums->reference_variance / sums->reference_spread
            : INFINITY;
    const double size  = assay_noisy_size(sums) / assay_critical_value(critical, degrees);
    const double fewer = size * size / v - 1.0;
    return fewer > 0.0 ? 1.0 / fewer : INFINITY;
}

/* Samples that the candidate took a pixel, all runs together; 0: nobody says. */
static double taken(const assay_judgement *j, const assay_verify_channel *c,
                    const assay_noisy_sums *sums)
{
    return c->source == ASSAY_NOISE_RUNS ? j->options->candidate_samples * c->pair.candidate.samples
                                         : sums->candidate_samples / sums->pixels;
}

void assay_chance_ask(assay_finding *finding, const assay_judgement *judgement,
                      const assay_verify_channel *channel, const assay_noisy_sums *sums,
                      double share, char text[ASSAY_CHANCE_TEXT])
{
    const double has    = taken(judgement, channel, sums);
    const double of     = sums->reference_samples / sums->pixels;
    const double needed = of > 0.0 ? fmax(1.0, ceil(share * of)) : INFINITY;
    const bool   runs   = channel->source == ASSAY_NOISE_RUNS;
    char         least[64], said[64] = "--samples says so";
    if (finding->kind != ASSAY_VERDICT_FAIL || !(share > 0.0) || fmax(has, 1.0) >= needed) {
        return;
    }
    if (!runs) {
        finding->kind = ASSAY_VERDICT_CANNOT_TELL;
    }
    snprintf(least, sizeof least,
             of > 0.0 ? "%.0f samples a pixel" : "%.3g of the reference's samples",
             of > 0.0 ? needed : share);
    if (has > 0.0) {
        snprintf(said, sizeof said, "%s %.3g", runs ? "they took" : "it took", has);
    } else if (!(of > 0.0)) {
        snprintf(said, sizeof said, "--samples and --reference-samples say so");
    }
    snprintf(text, ASSAY_CHANCE_TEXT,
             "%s%sNo chance if %s took %s or more (%s): light that few samples find may be missing "
             "by chance.",
             finding->meaning ? finding->meaning : "", finding->meaning ? " " : "",
             runs ? "the runs together" : "the candidate", least, said);
    finding->meaning = text;
}
