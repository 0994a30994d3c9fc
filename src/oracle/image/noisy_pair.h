/* noisy_pair.h - one channel of a candidate and of a reference, with what is known of their noise.
 *
 * Pixels are taken as independent of one another (a renderer that filters over pixels makes them
 * not so: docs/verdicts.md).  Borrows everything. */
#ifndef ASSAY_ORACLE_NOISY_PAIR_H
#define ASSAY_ORACLE_NOISY_PAIR_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    const float    *mean;
    const float    *variance; /* of the mean; NULL: not known, or none, as said below       */
    const uint32_t *count;    /* samples of each pixel; NULL: `samples` in all              */
    double          samples;  /* 0: not known, and then as few as give a variance, 2        */
    double          rounding; /* largest relative error of a mean from rounding             */
} assay_noisy_channel;

typedef struct {
    int                 width, height;
    assay_noisy_channel candidate, reference; /* reference.variance NULL: it is exact        */
} assay_noisy_pair;

/* Of one pixel, or summed over several. */
typedef struct {
    double pixels;
    double difference;           /* candidate - reference                                       */
    double candidate, reference; /* means                                                       */
    double rounding;             /* that the difference may have from rounding, at most         */
    double candidate_variance, reference_variance;
    double candidate_spread, reference_spread; /* squares of variances over their degrees        */
    double squares;                            /* of the difference                             */
    double candidate_samples, reference_samples; /* 0: of some pixel not known                  */
    /* What the noise model makes of either image's variance alone; 0 before it was asked. */
    double by_reference, by_reference_spread;
    double by_candidate, by_candidate_spread;
    double by_reference_light, by_candidate_light;
} assay_noisy_sums;

static inline double assay_noisy_samples(const assay_noisy_channel *channel, size_t pixel)
{
    return channel->count ? (double)channel->count[pixel] : channel->samples;
}

static inline double assay_noisy_degrees(const assay_noisy_channel *channel, size_t pixel)
{
    const double samples = assay_noisy_samples(channel, pixel);
    return samples > 2.0 ? samples - 1.0 : 1.0;
}

static inline assay_noisy_sums assay_noisy_pixel(const assay_noisy_pair *pair, size_t pixel)
{
    const assay_noisy_channel *c = &pair->candidate, *r = &pair->reference;
    const double               x = c->mean[pixel], y = r->mean[pixel], d = x - y;
    const double               vc = c->variance ? c->variance[pixel] : 0.0;
    const double               vr = r->variance ? r->variance[pixel] : 0.0;
    return (assay_noisy_sums){.pixels             = 1.0,
                              .difference         = d,
                              .candidate          = x,
                              .reference          = y,
                              .rounding           = c->rounding * fabs(x) + r->rounding * fabs(y),
                              .candidate_variance = vc,
                              .reference_variance = vr,
                              .candidate_spread   = vc * vc / assay_noisy_degrees(c, pixel),
                              .reference_spread   = vr * vr / assay_noisy_degrees(r, pixel),
                              .squares            = d * d,
                              .candidate_samples  = assay_noisy_samples(c, pixel),
                              .reference_samples  = assay_noisy_samples(r, pixel)};
}

static inline void assay_noisy_add(assay_noisy_sums *sums, const assay_noisy_sums *more)
{
    sums->pixels += more->pixels;
    sums->difference += more->difference;
    sums->candidate += more->candidate;
    sums->reference += more->reference;
    sums->rounding += more->rounding;
    sums->candidate_variance += more->candidate_variance;
    sums->reference_variance += more->reference_variance;
    sums->candidate_spread += more->candidate_spread;
    sums->reference_spread += more->reference_spread;
    sums->squares += more->squares;
    sums->candidate_samples += more->candidate_samples;
    sums->reference_samples += more->reference_samples;
    sums->by_reference += more->by_reference;
    sums->by_reference_spread += more->by_reference_spread;
    sums->by_candidate += more->by_candidate;
    sums->by_candidate_spread += more->by_candidate_spread;
    sums->by_reference_light += more->by_reference_light;
    sums->by_candidate_light += more->by_candidate_light;
}

#endif
