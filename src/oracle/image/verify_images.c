/* verify_images.c - which channels are compared, in the order of the light's way, and what the
 * verdict says of how.
 *
 * Invariant: a channel that was asked for and cannot be tested is a finding, so that it never
 * passes. */
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "oracle/image/verify_channels.h"
#include "oracle/image/verify_judge.h"
#include "oracle/image/verify_metadata.h"
#include "oracle/image/verify_variance.h"
#include "oracle/verdict/verdict_data.h"

assay_verify_options assay_verify_options_default(void)
{
    return (assay_verify_options){.level          = 0.01,
                                  .correction     = ASSAY_CORRECTION_HOLM,
                                  .tile           = 16,
                                  .allow          = NAN,
                                  .allow_absolute = NAN,
                                  .detect         = NAN,
                                  .detect_tile    = NAN,
                                  .precision      = ASSAY_PRECISION_FLOAT};
}

static bool absent_or_positive(double x) { return isnan(x) || (x > 0.0 && isfinite(x)); }

static assay_status check_options(assay_context *context, const assay_verify_options *o, int count)
{
    const char *problem = NULL;
    if (!(o->level > 0.0 && o->level < 0.5)) {
        problem = "the level lies between 0 and 0.5";
    } else if (o->tile < 4 || o->tile > 256) {
        problem = "a tile has a side of 4 to 256 pixels";
    } else if (!absent_or_positive(o->allow) || !absent_or_positive(o->allow_absolute)) {
        problem = "an allowance is more than 0";
    } else if (!absent_or_positive(o->detect) || !absent_or_positive(o->detect_tile)) {
        problem = "a bias to detect is more than 0";
    } else if (count < 1 || count > ASSAY_VERIFY_MAX_RUNS) {
        problem = "a candidate has 1 to 64 runs";
    }
    return problem ? assay_fail(context, ASSAY_ERR_ARGUMENT, "%s", problem) : ASSAY_OK;
}

static assay_status check_images(assay_context *context, const assay_image *const *candidates,
                                 int count, const assay_image *reference,
                                 const assay_verify_options *options)
{
    for (int k = 0; k < count; k++) {
        const assay_image *c = candidates[k];
        if (assay_image_width(c) != assay_image_width(reference) ||
            assay_image_height(c) != assay_image_height(reference)) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "the candidate has %d x %d pixels, the reference %d x %d",
                              assay_image_width(c), assay_image_height(c),
                              assay_image_width(reference), assay_image_height(reference));
        }
        const assay_status status =
            options->ignore_metadata ? ASSAY_OK : assay_verify_metadata(context, c, reference);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

static const float *floats_of(const assay_image *image, const char *name)
{
    assay_channel channel;
    return assay_image_find_channel(image, name, &channel) && channel.type == ASSAY_CHANNEL_FLOAT
               ? channel.data.f32
               : NULL;
}

static bool same_values(const assay_image *a, const assay_image *b,
                        const assay_verify_channel *channels, int count)
{
    const size_t pixels = (size_t)assay_image_width(a) * (size_t)assay_image_height(a);
    int          same   = 0;
    for (int i = 0; i < count; i++) {
        const float *x = floats_of(a, channels[i].name), *y = floats_of(b, channels[i].name);
        if (x && y && memcmp(x, y, pixels * sizeof *x) != 0) {
            return false;
        }
        same += x && y;
    }
    return same > 0;
}

/* The spread of runs is their noise only where their random numbers differ. */
static assay_status check_runs(assay_context *context, const assay_image *const *candidates,
                               int count, const assay_verify_channel *channels, int channel_count)
{
    for (int i = 1; i < count; i++) {
        for (int k = 0; k < i; k++) {
            const bool same = same_values(candidates[k], candidates[i], channels, channel_count);
            if (same || assay_verify_shared_seed(candidates[k], candidates[i])) {
                return assay_fail(context, ASSAY_ERR_ARGUMENT,
                                  "runs %d and %d of the candidate %s: runs differ in their random "
                                  "numbers",
                                  k + 1, i + 1, same ? "are the same image" : "have the same seed");
            }
        }
    }
    return ASSAY_OK;
}

/* ---- what the verdict says of itself ---- */

/* The worst over channels of what a class could have seen, in parts of the mean. */
static double worst_visible(const assay_verdict *verdict, int first, const char *prefix)
{
    double worst = NAN, mean = NAN;
    for (int i = first; i < assay_verdict_count(verdict); i++) {
        const assay_finding f = assay_verdict_at(verdict, i);
        /* Each channel's findings begin with the whole, which has its mean. */
        if (strcmp(f.test, "whole") == 0) {
            mean = f.reference;
        }
        if (strncmp(f.test, prefix, strlen(prefix)) == 0 && f.visible / fabs(mean) >= 0.0) {
            worst = fmax(isnan(worst) ? 0.0 : worst, f.visible / fabs(mean));
        }
    }
    return worst;
}

static assay_status describe_power(assay_verdict *verdict, int first, int tile)
{
    char         tiles[16];
    const double whole = worst_visible(verdict, first, "whole");
    if (isnan(whole)) {
        return ASSAY_OK;
    }
    snprintf(tiles, sizeof tiles, "tile-%d", tile);
    const double       in_tile = worst_visible(verdict, first, tiles);
    const double       pixel   = worst_visible(verdict, first, "welch");
    assay_text_builder text    = assay_text_start(verdict->context);
    assay_text_add(
        &text,
        "Where noise is largest it would have seen, with a probability of 0.9, a bias of "
        "%.3g percent of the mean everywhere, or of %.3g percent of it in a typical tile "
        "of %d x %d",
        100.0 * whole, 100.0 * in_tile, tile, tile);
    if (pixel < 1000.0) {
        assay_text_add(&text, ", or of %.3g percent in a typical pixel", 100.0 * pixel);
    }
    assay_text_add_char(&text, '.');
    char        *sentence = NULL;
    assay_status status   = assay_text_finish(&text, "a verdict's power", &sentence);
    status = status != ASSAY_OK ? status : assay_verdict_set(verdict, "power", sentence);
    assay_text_destroy(verdict->context, sentence);
    return status;
}

static const char *source_text(const assay_verify_channel *channels, int count)
{
    for (int i = 0; i < count; i++) {
        if (!channels[i].problem) {
            switch (channels[i].source) {
            case ASSAY_NOISE_OWN: return "its own variance";
            case ASSAY_NOISE_RUNS: return "differences of its runs";
            case ASSAY_NOISE_ALONE: return "differences to the reference";
            }
        }
    }
    return "none";
}

static assay_status set_number(assay_verdict *verdict, const char *key, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    return isnan(value) ? ASSAY_OK : assay_verdict_set(verdict, key, text);
}

static assay_status describe(assay_verdict *verdict, int first, const assay_verify_options *o,
                             const assay_verify_channel *channels, int count, bool shared)
{
    const struct {
        const char *key;
        double      value;
    } numbers[]         = {{"level", o->level},   {"tile", o->tile},
                           {"allow", o->allow},   {"allow_absolute", o->allow_absolute},
                           {"detect", o->detect}, {"detect_tile", o->detect_tile}};
    assay_status status = ASSAY_OK;
    for (size_t i = 0; status == ASSAY_OK && i < sizeof numbers / sizeof numbers[0]; i++) {
        status = set_number(verdict, numbers[i].key, numbers[i].value);
    }
    status = status ? status
                    : assay_verdict_set(verdict, "correction",
                                        o->correction == ASSAY_CORRECTION_HOLM ? "holm" : "bh");
    status = status ? status
                    : assay_verdict_set(verdict, "candidate_noise", source_text(channels, count));
    if (status == ASSAY_OK && (o->allow > 0.0 || o->allow_absolute > 0.0)) {
        status = assay_verdict_set(verdict, "shown", "every region is within the allowance");
    }
    if (status == ASSAY_OK && shared) {
        status = assay_verdict_set(
            verdict, "shared_seed",
            "the same random numbers in both make differences look smaller than they are");
    }
    /* Within an allowance a variance that is too large makes nothing pass. */
    if (status == ASSAY_OK && !assay_judge_equivalence(o)) {
        status = assay_verify_variances(verdict, channels, count);
    }
    return status ? status : describe_power(verdict, first, o->tile);
}

/* ---- the way ---- */

static assay_status judge_all(assay_context *context, const assay_image *const *candidates,
                              int count, const assay_image *reference,
                              const assay_verify_options *options, assay_verify_channel *channels,
                              int channel_count, assay_verdict *verdict)
{
    assay_judgement judgement = assay_judgement_start(context, options, channels, channel_count);
    assay_status    status    = ASSAY_OK;
    for (int i = 0; status == ASSAY_OK && i < channel_count; i++) {
        status = assay_verify_channel_prepare(context, candidates, count, reference, options,
                                              &channels[i]);
        if (status == ASSAY_OK && !channels[i].problem) {
            status = assay_judge_channel(&judgement, i);
        }
    }
    status = status != ASSAY_OK ? status : assay_judge(&judgement, verdict);
    assay_judgement_end(&judgement);
    return status;
}

assay_status assay_verify_images(const assay_image *const *candidates, int count,
                                 const assay_image *reference, const assay_verify_options *options,
                                 assay_verdict *verdict)
{
    assay_context        *context       = verdict->context;
    const int             first         = assay_verdict_count(verdict);
    assay_verify_channel *channels      = NULL;
    int                   channel_count = 0;
    assay_status          status        = check_options(context, options, count);
    status = status ? status : check_images(context, candidates, count, reference, options);
    status = status ? status
                    : assay_verify_channels_choose(context, candidates[0], reference,
                                                   options->channels, &channels, &channel_count);
    status = status ? status : check_runs(context, candidates, count, channels, channel_count);
    if (status == ASSAY_OK) {
        status = judge_all(context, candidates, count, reference, options, channels, channel_count,
                           verdict);
    }
    if (status == ASSAY_OK) {
        status = describe(verdict, first, options, channels, channel_count,
                          assay_verify_shared_seed(candidates[0], reference));
    }
    if (status != ASSAY_OK) {
        assay_verdict_truncate(verdict, first);
    }
    for (int i = 0; i < channel_count; i++) {
        assay_verify_channel_release(context, &channels[i]);
    }
    assay_release(context, channels);
    return status;
}
