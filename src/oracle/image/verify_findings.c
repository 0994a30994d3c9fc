/* verify_findings.c - a finding a channel and size of region: its worst place, and what could have
 * been seen.
 *
 * Invariant: the kind comes from the decision over all channels, the numbers from the place with
 * the least p, also where nothing is rejected. */
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/select.h"
#include "oracle/image/critical_values.h"
#include "oracle/image/student.h"
#include "oracle/image/verify_chance.h"

static assay_finding start(const assay_verify_channel *channel, const char *test)
{
    assay_finding finding = assay_finding_default();
    finding.stage         = channel->stage;
    finding.array         = channel->name;
    finding.test          = test;
    return finding;
}

/* Numbers of a region or pixel, per pixel.  log_bound: log p at which a difference is too much. */
static void fill(assay_finding *f, const assay_noisy_sums *sums, const assay_noise *noise,
                 double log_bound)
{
    assay_critical_values critical = assay_critical_values_exact(log_bound);
    const double          n = sums->pixels, size = assay_noisy_size(sums);
    const double          bound = assay_noise_bound(noise, &critical, NULL);
    f->candidate                = sums->candidate / n;
    f->reference                = sums->reference / n;
    f->effect    = sums->reference != 0.0 ? sums->difference / fabs(sums->reference) : NAN;
    f->bound     = (bound + sums->rounding) / n;
    f->in_bounds = size > 0.0 ? size / bound : 0.0;
    f->log_p     = assay_noise_log_p(noise, size);
    f->p         = assay_exp(f->log_p);
}

/* Smallest bias a pixel that is seen with the power that was meant [cohen88]. */
static double visible(const assay_noisy_sums *sums, const assay_noise *noise,
                      assay_critical_values *critical, assay_critical_values *power)
{
    return (assay_noise_bound(noise, critical, power) + sums->rounding) / sums->pixels;
}

/* How many of a channel's tests at a level are rejected. */
static uint64_t count_rejected(const assay_test_class *class_of, int channel, int level)
{
    uint64_t count = 0;
    for (uint64_t i = 0; i < class_of->decision.rejected; i++) {
        const uint64_t item = class_of->tests.kept[i].item;
        count += assay_test_channel(item) == channel && assay_test_level(item) == level;
    }
    return count;
}

/* Where something should have been seen that could not: no pass. */
static void ask_detection(assay_finding *f, double asked, double could, double unit)
{
    if (f->kind == ASSAY_VERDICT_PASS && !isnan(asked) && !(could <= asked * fabs(unit))) {
        f->kind    = ASSAY_VERDICT_CANNOT_TELL;
        f->meaning = "Too much noise: a bias as small as was asked for would not have been seen; "
                     "more samples are needed, of whichever image has the larger variance.";
    }
}

/* Nobody asked, but a test that would let a black image pass is none. */
static void ask_black(assay_finding *f)
{
    if (f->kind == ASSAY_VERDICT_PASS && !(f->visible <= fabs(f->reference))) {
        f->kind    = ASSAY_VERDICT_CANNOT_TELL;
        f->meaning = "Too much noise: a black image, or one twice as bright, would have passed.";
    }
}

assay_status assay_judge_add_problem(const assay_verify_channel *channel, assay_verdict *verdict)
{
    assay_finding finding = start(channel, channel->problem_test);
    finding.kind          = ASSAY_VERDICT_CANNOT_TELL;
    finding.place         = channel->problem_place;
    finding.meaning       = channel->problem;
    if (!isnan(channel->problem_value) || channel->problem_place.kind == ASSAY_PLACE_PIXEL) {
        finding.candidate = channel->problem_value;
    }
    return assay_verdict_add(verdict, &finding);
}

assay_status assay_judge_add_whole(assay_judgement *j, int channel, assay_verdict *verdict)
{
    const assay_verify_channel *c       = &j->channels[channel];
    const assay_noisy_sums     *sums    = &c->sums.whole;
    const assay_noise           noise   = assay_verify_channel_noise(c, ASSAY_TILE_LEVELS, sums);
    assay_finding               finding = start(c, "whole");
    char                        words[ASSAY_MEANING_SIZE];
    finding.values = (uint64_t)sums->pixels;
    fill(&finding, sums, &noise, j->whole.decision.log_bound);
    finding.visible = visible(sums, &noise, &j->whole.critical, &j->power);
    char text[ASSAY_CHANCE_TEXT];
    if (count_rejected(&j->whole, channel, ASSAY_TILE_LEVELS) > 0) {
        finding.kind = ASSAY_VERDICT_FAIL;
        assay_meaning_with_neighbours(c, assay_meaning_of_whole(j, channel), words);
        finding.meaning = words;
        assay_chance_ask(&finding, j, c, sums,
                         assay_chance_share(c, ASSAY_TILE_LEVELS, sums, &j->whole.critical), text);
    }
    ask_detection(&finding, j->options->detect, finding.visible, finding.reference);
    ask_black(&finding);
    return assay_verdict_add(verdict, &finding);
}

typedef struct {
    size_t worst;
    double worst_log_p;
    double visible_median, visible_largest;
} tile_summary;

static assay_status summarise(assay_judgement *j, const assay_verify_channel *c, int level,
                              tile_summary *summary_out)
{
    const assay_tile_level *tiles   = &c->sums.levels[level];
    tile_summary            summary = {.worst_log_p = 1.0};
    double                 *seen    = assay_allocate(j->context, tiles->count, sizeof *seen);
    if (!seen) {
        return assay_fail_memory(j->context, "what tiles could show");
    }
    for (size_t i = 0; i < tiles->count; i++) {
        const assay_noise noise = assay_verify_channel_noise(c, level, &tiles->sums[i]);
        const double      log_p = assay_noise_log_p(&noise, assay_noisy_size(&tiles->sums[i]));
        seen[i]                 = visible(&tiles->sums[i], &noise, &j->tiles.critical, &j->power);
        summary.visible_largest = fmax(summary.visible_largest, seen[i]);
        if (log_p < summary.worst_log_p) {
            summary.worst       = i;
            summary.worst_log_p = log_p;
        }
    }
    summary.visible_median = assay_select(seen, tiles->count, tiles->count / 2);
    assay_release(j->context, seen);
    *summary_out = summary;
    return ASSAY_OK;
}

/* The rejected tile of which chance is ruled out most surely. */
static const assay_noisy_sums *surest_tile(assay_judgement *j, int channel, int level,
                                           double *share_out)
{
    const assay_verify_channel *c      = &j->channels[channel];
    const assay_noisy_sums     *surest = NULL;
    for (uint64_t i = 0; i < j->tiles.decision.rejected; i++) {
        const uint64_t item = j->tiles.tests.kept[i].item;
        if (assay_test_channel(item) == channel && assay_test_level(item) == level) {
            const assay_noisy_sums *tile =
                &c->sums.levels[level].sums[item - assay_test_item(channel, level, 0)];
            const double share = assay_chance_share(c, level, tile, &j->tiles.critical);
            if (!surest || share < *share_out) {
                surest     = tile;
                *share_out = share;
            }
        }
    }
    return surest;
}

assay_status assay_judge_add_tiles(assay_judgement *j, int channel, int level,
                                   assay_verdict *verdict)
{
    const assay_verify_channel *c       = &j->channels[channel];
    tile_summary                summary = {0};
    const assay_status          status  = summarise(j, c, level, &summary);
    if (status != ASSAY_OK) {
        return status;
    }
    const assay_noisy_sums *sums  = &c->sums.levels[level].sums[summary.worst];
    const assay_noise       noise = assay_verify_channel_noise(c, level, sums);
    const uint64_t          bad   = count_rejected(&j->tiles, channel, level);
    double                  share = 0.0;
    char                    test[16], words[ASSAY_MEANING_SIZE], text[ASSAY_CHANCE_TEXT];
    snprintf(test, sizeof test, "tile-%d", c->sums.levels[level].side);
    assay_finding finding = start(c, test);
    finding.values        = c->sums.levels[level].count;
    finding.place         = assay_tile_place(&c->sums, level, summary.worst);
    fill(&finding, sums, &noise, j->tiles.decision.log_bound);
    finding.visible = summary.visible_median;
    if (bad > 0) {
        finding.kind = ASSAY_VERDICT_FAIL;
        assay_meaning_with_neighbours(
            c, assay_meaning_of_tile(j, channel, level, bad, sums->difference), words);
        finding.meaning                = words;
        const assay_noisy_sums *surest = surest_tile(j, channel, level, &share);
        assay_chance_ask(&finding, j, c, surest, share, text);
    }
    if (level == 0) {
        ask_detection(&finding, j->options->detect_tile, summary.visible_largest,
                      c->sums.whole.reference / c->sums.whole.pixels);
    }
    return assay_verdict_add(verdict, &finding);
}

/* ---- pixels ---- */

static assay_place pixel_place(const assay_verify_channel *c, size_t pixel)
{
    return assay_place_pixel((int)(pixel % (size_t)c->pair.width),
                             (int)(pixel / (size_t)c->pair.width));
}

/* |a - b| in units of the last place of a float of b's size. */
static double float_ulps(double a, double b)
{
    int exponent;
    (void)frexp(fmax(fabs(b), 0x1p-126), &exponent);
    return fabs(a - b) / ldexp(1.0, exponent - 24);
}

static assay_status add_fireflies(const assay_verify_channel *c, const assay_fireflies *flies,
                                  const char *test, const char *meaning, assay_verdict *verdict)
{
    if (flies->count == 0) {
        return ASSAY_OK;
    }
    const assay_noisy_sums worst   = assay_noisy_pixel(&c->pair, flies->worst);
    assay_finding          finding = start(c, test);
    finding.values                 = flies->count;
    finding.place                  = pixel_place(c, flies->worst);
    finding.candidate              = worst.candidate;
    finding.reference              = worst.reference;
    finding.meaning                = meaning;
    finding.effect =
        c->sums.whole.reference != 0.0 ? flies->excess / fabs(c->sums.whole.reference) : NAN;
    return assay_verdict_add(verdict, &finding);
}

/* The pixel with the least p that is small, else with the largest t. */
static size_t worst_pixel(const assay_judgement *j, int channel)
{
    const assay_multiple_tests *tests = &j->pixels.tests;
    for (size_t i = 0; i < tests->kept_count; i++) {
        if (assay_test_channel(tests->kept[i].item) == channel) {
            return (size_t)(tests->kept[i].item - assay_test_item(channel, 0, 0));
        }
    }
    return j->channels[channel].pixels.worst;
}

/* Without a variance of its own, a candidate's pixel may be a firefly or wrong. */
static void judge_outlier(assay_finding *finding)
{
    if (finding->in_bounds > 1.0) {
        finding->kind    = ASSAY_VERDICT_CANNOT_TELL;
        finding->meaning = "The candidate has no variance, so this may be a firefly or wrong: "
                           "give it a Variance channel, or several runs.";
    }
}

assay_status assay_judge_add_pixels(assay_judgement *j, int channel, assay_verdict *verdict)
{
    const assay_verify_channel *c     = &j->channels[channel];
    const bool                  alone = c->source == ASSAY_NOISE_ALONE;
    const size_t                pixel = worst_pixel(j, channel);
    const assay_noisy_sums      sums  = assay_noisy_pixel(&c->pair, pixel);
    const assay_noise           noise = assay_noise_of_pixel(&c->model, &c->pair, pixel);
    const uint64_t              bad   = count_rejected(&j->pixels, channel, 0);
    /* Where no test of pixels decides, the outliers are those that would have been named in it. */
    const double bound = alone ? j->pixels.tests.log_level - assay_log(c->sums.whole.pixels)
                               : j->pixels.decision.log_bound;
    assay_critical_values critical = assay_critical_values_at(bound);
    assay_finding         finding  = start(c, alone ? "outlier" : "welch");
    char                  words[ASSAY_MEANING_SIZE];
    finding.values = (uint64_t)c->sums.whole.pixels;
    finding.place  = pixel_place(c, pixel);
    fill(&finding, &sums, &noise, bound);
    finding.ulps                   = float_ulps(sums.candidate, sums.reference);
    const assay_noisy_sums usual   = assay_noisy_pixel(&c->pair, c->pixels.typical);
    const assay_noise      typical = assay_noise_of_pixel(&c->model, &c->pair, c->pixels.typical);
    finding.visible                = visible(&usual, &typical, &critical, &j->power);
    if (alone) {
        judge_outlier(&finding);
    } else if (bad > 0) {
        finding.kind = ASSAY_VERDICT_FAIL;
        assay_meaning_with_neighbours(c, assay_meaning_of_pixel(j, channel, bad, sums.difference),
                                      words);
        finding.meaning = words;
    }
    assay_status status = assay_verdict_add(verdict, &finding);
    if (status == ASSAY_OK && !alone) {
        status = add_fireflies(c, &c->pixels.candidate, "fireflies",
                               "Pixels of the candidate that few samples outweigh; not judged, "
                               "their variance says as much.",
                               verdict);
    }
    return status == ASSAY_OK && !alone
               ? add_fireflies(c, &c->pixels.reference, "reference-fireflies",
                               "Pixels of the reference that few samples outweigh; there it shows "
                               "little.",
                               verdict)
               : status;
}
