/* verify_meaning.c - what a difference could mean, from where it is and what sign it has.
 *
 * Invariant: a sentence says "could" of what no statistic can prove; it is advice where to look,
 * and decides nothing. */
#include <stdio.h>

#include "core/numerics.h"
#include "oracle/image/verify_judge.h"

static bool whole_rejected(const assay_judgement *j, int channel)
{
    for (uint64_t i = 0; i < j->whole.decision.rejected; i++) {
        if (assay_test_channel(j->whole.tests.kept[i].item) == channel) {
            return true;
        }
    }
    return false;
}

static double relative_difference(const assay_verify_channel *c)
{
    return c->sums.whole.reference != 0.0 ? c->sums.whole.difference / fabs(c->sums.whole.reference)
                                          : 0.0;
}

/* Whether one channel of a stage has too much, another too little: no light that is missing or
 * counted twice does that. */
static bool colours_differ(const assay_judgement *j, int channel)
{
    const assay_verify_channel *c    = &j->channels[channel];
    const double                mine = relative_difference(c);
    for (int i = 0; i < j->count; i++) {
        const assay_verify_channel *other = &j->channels[i];
        if (i != channel && !other->problem && other->stage == c->stage && whole_rejected(j, i) &&
            relative_difference(other) * mine < 0.0) {
            return true;
        }
    }
    return false;
}

/* Share of the difference that lies in the brightest tenth of the small tiles. */
static double share_of_bright(const assay_verify_channel *c)
{
    const assay_tile_level *tiles = &c->sums.levels[0];
    const double            mean  = c->sums.whole.reference / c->sums.whole.pixels;
    double                  all = 0.0, bright = 0.0;
    for (size_t i = 0; i < tiles->count; i++) {
        const double d = tiles->sums[i].difference;
        all += d;
        bright += tiles->sums[i].reference > 3.0 * mean * tiles->sums[i].pixels ? d : 0.0;
    }
    return all != 0.0 ? bright / all : 0.0;
}

/* Spread over small tiles of candidate / reference, weighted by light: 0 for one factor. */
static double factor_spread(const assay_verify_channel *c)
{
    const assay_tile_level *tiles  = &c->sums.levels[0];
    const double            ratio  = c->sums.whole.candidate / c->sums.whole.reference;
    double                  excess = 0.0, total = 0.0;
    for (size_t i = 0; i < tiles->count; i++) {
        const assay_noisy_sums *s     = &tiles->sums[i];
        const assay_noise       noise = assay_verify_channel_noise(c, 0, s);
        const double            off   = s->candidate - ratio * s->reference;
        excess += off * off - assay_noise_variance(&noise);
        total += s->difference * s->difference;
    }
    return total > 0.0 && excess > 0.0 ? sqrt(excess / total) : 0.0;
}

const char *assay_meaning_of_whole(const assay_judgement *judgement, int channel)
{
    const assay_verify_channel *c    = &judgement->channels[channel];
    const bool                  dark = c->sums.whole.difference < 0.0;
    if (colours_differ(judgement, channel)) {
        return "One channel is too bright, another too dark: this could be another colour space, "
               "swapped channels, or the wrong colour of a light or material.";
    }
    if (dark && share_of_bright(c) > 0.7) {
        return "The bright parts are too dark: this could be clamped highlights or samples, or a "
               "light that is missing.";
    }
    if (factor_spread(c) < 0.2) {
        return dark
                   ? "Everything is too dark by one factor: this could be energy lost in sampling "
                     "or weights, a wrong constant, or another exposure."
                   : "Everything is too bright by one factor: this could be light counted twice, a "
                     "wrong constant such as pi, or another exposure.";
    }
    return dark ? "Too dark, more in some parts than in others: this could be bounces that are "
                  "missing, paths that end too early, or clamped samples."
                : "Too bright, more in some parts than in others: this could be light that leaks, "
                  "or "
                  "a part of it counted twice.";
}

const char *assay_meaning_of_tile(const assay_judgement *judgement, int channel, int level,
                                  uint64_t rejected, double difference)
{
    const assay_verify_channel *c = &judgement->channels[channel];
    if (rejected * 4 > c->sums.levels[level].count) {
        return "Many tiles differ: see the whole image, or a stage before it.";
    }
    return difference > 0.0
               ? "Few tiles are too bright: this could be light that leaks, a shadow that is "
                 "missing, or a caustic that only the candidate has."
               : "Few tiles are too dark: this could be a shadow that is too large, a light that "
                 "is missing there, or clamped highlights.";
}

const char *assay_meaning_of_pixel(const assay_judgement *judgement, int channel, uint64_t rejected,
                                   double difference)
{
    const double pixels = judgement->channels[channel].sums.whole.pixels;
    if (!whole_rejected(judgement, channel) && (double)rejected < 0.2 * pixels) {
        return "Single pixels differ, and the whole does not: this could be edges that are shifted "
               "or filtered in another way, or a variance that is too small.";
    }
    return difference < 0.0 ? "Pixels are too dark beyond their noise, or the candidate's variance "
                              "is too small."
                            : "Pixels are too bright beyond their noise, or the candidate's "
                              "variance is too small.";
}

void assay_meaning_with_neighbours(const assay_verify_channel *channel, const char *meaning,
                                   char words[ASSAY_MEANING_SIZE])
{
    const assay_neighbours *n = &channel->neighbours;
    if (assay_neighbours_share_noise(n)) {
        snprintf(words, ASSAY_MEANING_SIZE,
                 "%s But signs of the differences agree more often side by side (correlation "
                 "%.2f) than four pixels apart (%.2f), as where a filter, a denoiser or a cache "
                 "shares noise among pixels; these tests take that for a bias. Give several runs, "
                 "or an allowance (--allow).",
                 meaning, n->near, n->far);
    } else {
        snprintf(words, ASSAY_MEANING_SIZE, "%s", meaning);
    }
}
