/* verify_channel.c - from the channels of images to a noisy pair, its sums and its noise model.
 *
 * Invariant: a pair is tested only where every value is finite and every variance is finite and not
 * negative; a variance of one sample, which is 0 in files, counts as not known. */
#include "oracle/image/verify_channel.h"

#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "oracle/image/run_spread.h"
#include "oracle/image/student.h"
#include "oracle/metrics/sample_counts.h"

/* A mean of n rounded values: u per operation, and sums that err by a few sqrt(n) u rather than by
 * n u [higham19]. */
static double rounding_of(double unit, double samples)
{
    return unit * (2.0 + 4.0 * sqrt(fmax(samples, 1.0)));
}

static const float *find_float(const assay_image *image, const char *prefix, const char *name)
{
    char          full[ASSAY_CHANNEL_NAME + 16];
    assay_channel channel;
    snprintf(full, sizeof full, "%s%s", prefix, name);
    return assay_image_find_channel(image, full, &channel) && channel.type == ASSAY_CHANNEL_FLOAT
               ? channel.data.f32
               : NULL;
}

static double most_samples(const assay_noisy_channel *channel, size_t pixels)
{
    uint32_t most = 0; /* a whole number: gcc 12 for aarch64 fails on a largest double */
    for (size_t i = 0; channel->count && i < pixels; i++) {
        most = channel->count[i] > most ? channel->count[i] : most;
    }
    return fmax(channel->samples, most);
}

static assay_noisy_channel find_noisy(const assay_image *image, const char *name, uint32_t samples,
                                      double unit)
{
    const size_t pixels = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
    assay_noisy_channel channel = {.mean     = find_float(image, "", name),
                                   .variance = find_float(image, "Variance.", name),
                                   .count    = samples ? NULL : assay_sample_counts(image, name),
                                   .samples  = samples};
    channel.rounding            = rounding_of(unit, most_samples(&channel, pixels));
    return channel;
}

/* ---- what cannot be tested ---- */

static bool refuse(assay_verify_channel *channel, const char *test, const char *problem,
                   size_t pixel, double value)
{
    channel->problem       = problem;
    channel->problem_test  = test;
    channel->problem_value = value;
    if (pixel != SIZE_MAX) {
        const size_t width     = (size_t)channel->pair.width;
        channel->problem_place = assay_place_pixel((int)(pixel % width), (int)(pixel / width));
    }
    return false;
}

static size_t first_bad(const float *values, size_t count, bool negative_is_bad)
{
    for (size_t i = 0; values && i < count; i++) {
        if (!isfinite(values[i]) || (negative_is_bad && values[i] < 0.0f)) {
            return i;
        }
    }
    return SIZE_MAX;
}

static bool check_values(assay_verify_channel *channel, const assay_noisy_channel *noisy,
                         bool candidate)
{
    const size_t pixels = (size_t)channel->pair.width * (size_t)channel->pair.height;
    size_t       bad    = first_bad(noisy->mean, pixels, false);
    if (bad != SIZE_MAX) {
        return refuse(channel, "finite",
                      candidate ? "The candidate holds a value that is NaN or infinite."
                                : "The reference holds a value that is NaN or infinite.",
                      bad, candidate ? noisy->mean[bad] : NAN);
    }
    bad = first_bad(noisy->variance, pixels, true);
    if (bad != SIZE_MAX) {
        return refuse(channel, "variance",
                      candidate ? "The candidate's variance is NaN, infinite or negative here."
                                : "The reference's variance is NaN, infinite or negative here.",
                      bad, NAN);
    }
    return true;
}

/* Whether a variance says something: not where a pixel has a single sample, nor where it is 0
 * everywhere and nobody says of how many samples.  Pixels without any, where nothing is hit, are 0
 * in both images. */
static bool variance_known(const assay_noisy_channel *noisy, size_t pixels)
{
    bool zero = true;
    for (size_t i = 0; noisy->variance && i < pixels; i++) {
        zero = zero && noisy->variance[i] == 0.0f;
        if (noisy->count && noisy->count[i] == 1) {
            return false;
        }
    }
    return noisy->variance && !(noisy->samples == 1.0) &&
           !(zero && !noisy->count && noisy->samples == 0.0);
}

static bool has_channel(const assay_image *image, const assay_verify_channel *channel)
{
    return assay_image_find_channel(image, channel->name, NULL);
}

static bool check_reference(const assay_image *reference, const assay_verify_options *options,
                            assay_verify_channel *channel)
{
    assay_noisy_channel *r      = &channel->pair.reference;
    const size_t         pixels = (size_t)channel->pair.width * (size_t)channel->pair.height;
    if (!r->mean) {
        return refuse(channel, "channel",
                      has_channel(reference, channel)
                          ? "The reference's channel is not of floats: it is no mean."
                          : "The reference does not have this channel.",
                      SIZE_MAX, NAN);
    }
    if (options->reference_exact) {
        r->variance = NULL;
    } else if (!variance_known(r, pixels)) {
        return refuse(channel, "variance",
                      "The reference's variance is not known: it needs a Variance channel of two "
                      "samples a pixel or more.",
                      SIZE_MAX, NAN);
    }
    return check_values(channel, r, false);
}

/* ---- runs ---- */

static assay_status take_runs(assay_context *context, const assay_image *const *candidates,
                              int count, assay_verify_channel *channel)
{
    const size_t pixels = (size_t)channel->pair.width * (size_t)channel->pair.height;
    const float *runs[ASSAY_VERIFY_MAX_RUNS];
    for (int k = 0; k < count; k++) {
        runs[k] = find_float(candidates[k], "", channel->name);
        if (!runs[k]) {
            refuse(channel, "channel",
                   has_channel(candidates[k], channel)
                       ? "The channel of a run of the candidate is not of floats: it is no mean."
                       : "A run of the candidate does not have this channel.",
                   SIZE_MAX, NAN);
            return ASSAY_OK;
        }
        const size_t bad = first_bad(runs[k], pixels, false);
        if (bad != SIZE_MAX) {
            refuse(channel, "finite",
                   "A run of the candidate holds a value that is NaN or infinite.", bad,
                   runs[k][bad]);
            return ASSAY_OK;
        }
    }
    channel->run_mean     = assay_allocate(context, pixels, sizeof(float));
    channel->run_variance = assay_allocate(context, pixels, sizeof(float));
    if (!channel->run_mean || !channel->run_variance) {
        return assay_fail_memory(context, "the mean of the runs");
    }
    assay_run_spread_pixels(runs, count, pixels, channel->run_mean, channel->run_variance);
    channel->pair.candidate.mean     = channel->run_mean;
    channel->pair.candidate.variance = channel->run_variance;
    channel->pair.candidate.count    = NULL;
    channel->pair.candidate.samples  = count;
    return ASSAY_OK;
}

static assay_status fit_runs(assay_context *context, const assay_image *const *candidates,
                             int count, assay_verify_channel *channel)
{
    const float *runs[ASSAY_VERIFY_MAX_RUNS];
    for (int k = 0; k < count; k++) {
        runs[k] = find_float(candidates[k], "", channel->name);
    }
    assay_run_spread   spread;
    const assay_status status =
        assay_run_spread_make(context, runs, count, &channel->pair, &channel->sums, &spread);
    if (status == ASSAY_OK) {
        memcpy(channel->design, spread.design, sizeof channel->design);
        channel->whole_run_variance = spread.whole_variance;
        channel->whole_degrees      = spread.whole_degrees;
    }
    return status;
}

/* ---- together ---- */

/* Where equivalence is tested, a candidate without variance is taken as it is, and a biased
 * method's samples may well be less noisy than the reference's. */
static assay_noise_model_kind model_kind(const assay_verify_channel *channel,
                                         const assay_verify_options *options)
{
    const bool equivalence = !isnan(options->allow) || !isnan(options->allow_absolute);
    if (channel->source == ASSAY_NOISE_ALONE) {
        return equivalence ? ASSAY_NOISE_MODEL_FIXED : ASSAY_NOISE_MODEL_ALONE;
    }
    return channel->source == ASSAY_NOISE_OWN && !equivalence && !options->reference_exact
               ? ASSAY_NOISE_MODEL_COUNTED
               : ASSAY_NOISE_MODEL_BOTH;
}

static void find_pair(const assay_image *const *candidates, int count, const assay_image *reference,
                      const assay_verify_options *options, assay_verify_channel *channel)
{
    const double unit      = options->precision == ASSAY_PRECISION_HALF ? 0x1p-11 : 0x1p-24;
    channel->problem_value = NAN;
    channel->pair.width    = assay_image_width(reference);
    channel->pair.height   = assay_image_height(reference);
    channel->pair.candidate =
        find_noisy(candidates[0], channel->name, options->candidate_samples, unit);
    channel->pair.reference =
        find_noisy(reference, channel->name, options->reference_samples, 0x1p-24);
    for (int i = 0; i <= ASSAY_TILE_LEVELS; i++) {
        channel->design[i] = 1.0;
    }
    channel->source = count > 1 ? ASSAY_NOISE_RUNS : ASSAY_NOISE_OWN;
}

static assay_status check_candidate(assay_context *context, const assay_image *const *candidates,
                                    int count, assay_verify_channel *channel)
{
    assay_noisy_channel *c      = &channel->pair.candidate;
    const size_t         pixels = (size_t)channel->pair.width * (size_t)channel->pair.height;
    if (!c->mean) {
        refuse(channel, "channel",
               has_channel(candidates[0], channel)
                   ? "The candidate's channel is not of floats: it is no mean."
                   : "The candidate does not have this channel.",
               SIZE_MAX, NAN);
        return ASSAY_OK;
    }
    if (count > 1) {
        return take_runs(context, candidates, count, channel);
    }
    if (!variance_known(c, pixels)) {
        channel->source = ASSAY_NOISE_ALONE;
        c->variance     = NULL;
    }
    check_values(channel, c, true);
    return ASSAY_OK;
}

assay_status assay_verify_channel_prepare(assay_context            *context,
                                          const assay_image *const *candidates, int count,
                                          const assay_image          *reference,
                                          const assay_verify_options *options,
                                          assay_verify_channel       *channel)
{
    find_pair(candidates, count, reference, options, channel);
    assay_status status = check_candidate(context, candidates, count, channel);
    if (status != ASSAY_OK || channel->problem || !check_reference(reference, options, channel)) {
        return status;
    }
    status = assay_tile_sums_make(context, &channel->pair, options->tile, &channel->sums);
    if (status == ASSAY_OK) {
        status = assay_noise_model_fit(context, &channel->sums.levels[0],
                                       model_kind(channel, options), &channel->model);
    }
    status = status != ASSAY_OK ? status : assay_tile_sums_gather(&channel->sums);
    if (status == ASSAY_OK) {
        assay_noise_model_light(&channel->sums);
    }
    if (status == ASSAY_OK && channel->source == ASSAY_NOISE_RUNS) {
        status = fit_runs(context, candidates, count, channel);
    }
    return status;
}

void assay_verify_channel_release(assay_context *context, assay_verify_channel *channel)
{
    assay_release(context, channel->run_mean);
    assay_release(context, channel->run_variance);
    channel->run_mean = channel->run_variance = NULL;
    assay_noise_model_release(&channel->model);
    if (channel->sums.context) {
        assay_tile_sums_release(&channel->sums);
    }
}

assay_noise assay_verify_channel_noise(const assay_verify_channel *channel, int level,
                                       const assay_noisy_sums *sums)
{
    assay_noise noise = assay_noise_of_region(&channel->model, sums, channel->design[level]);
    if (level == ASSAY_TILE_LEVELS && channel->whole_degrees > 0.0) {
        assay_noise_add(&noise, channel->whole_run_variance + sums->reference_variance,
                        channel->whole_degrees);
    }
    return noise;
}
