/* report_maps.c - Invariant: what is not finite in one of the images is not finite in its maps, and
 * counted apart in the histograms: a page never shows it as a match. */
#include "oracle/report/report_maps.h"

#include <math.h>
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "oracle/metrics/sample_counts.h"

static const double LOG10_OF_E = 0.43429448190325183, LOG2_OF_E = 1.4426950408889634;

static const char *const NAMES[3] = {"R", "G", "B"};

typedef struct {
    const float *value[3];    /* R, G, B                        */
    const float *variance[3]; /* of the mean; NULL: not known   */
    double       mean[3];     /* over the finite pixels         */
} planes;

static void take_planes(const assay_image *image, planes *out)
{
    const size_t pixels = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
    for (int c = 0; c < 3; c++) {
        char          name[32];
        assay_channel channel;
        assay_image_find_channel(image, NAMES[c], &channel);
        out->value[c] = channel.data.f32;
        snprintf(name, sizeof name, "Variance.%s", NAMES[c]);
        out->variance[c] =
            assay_image_find_channel(image, name, &channel) && channel.type == ASSAY_CHANNEL_FLOAT
                ? channel.data.f32
                : NULL;
        double sum = 0.0, count = 0.0;
        for (size_t i = 0; i < pixels; i++) {
            if (isfinite(out->value[c][i])) {
                sum += out->value[c][i];
                count += 1.0;
            }
        }
        out->mean[c] = count > 0.0 ? sum / count : 0.0;
    }
}

/* One sample has no variance, whatever its channel says. */
static bool has_one_sample(const assay_image *image)
{
    const size_t    pixels  = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
    const uint32_t *samples = assay_sample_counts(image, "R");
    for (size_t i = 0; samples && i < pixels; i++) {
        if (samples[i] > 1) {
            return false;
        }
    }
    return samples != NULL;
}

static bool has_noise(const assay_image *image, const planes *p)
{
    return p->variance[0] && p->variance[1] && p->variance[2] && !has_one_sample(image);
}

static void count_value(assay_report_histogram *h, double value)
{
    if (isnan(value)) {
        h->not_finite++;
        return;
    }
    const double bin = assay_floor((value - h->low) / h->step);
    if (bin < 0.0) {
        h->below++;
    } else if (bin >= h->bins) {
        h->above++;
    } else {
        h->count[(int)bin]++;
    }
}

static void count_difference(assay_report_histogram *h, double difference, double value)
{
    if (difference == 0.0) {
        h->equal++;
    } else {
        count_value(h, value);
    }
}

static void judge_pixel(const planes *a, const planes *b, size_t i, assay_report_maps *maps)
{
    double difference = 0.0, relative = 0.0, worst = 0.0;
    for (int c = 0; c < 3; c++) {
        const double reference = a->value[c][i];
        const double d         = b->value[c][i] - reference;
        const double scale     = fabs(reference) + 0.01 * fabs(a->mean[c]);
        const double r         = d == 0.0 ? 0.0 : isfinite(d) ? fabs(d) / scale : (double)NAN;
        difference += d / 3.0;
        relative += r / 3.0;
        count_difference(&maps->relative_histogram, d,
                         r > 0.0 ? assay_log(r) * LOG10_OF_E : (double)NAN);
        if (maps->z) {
            const double variance =
                (maps->noise & ASSAY_NOISE_REFERENCE ? a->variance[c][i] : 0.0) +
                (maps->noise & ASSAY_NOISE_CANDIDATE ? b->variance[c][i] : 0.0);
            const double z = d == 0.0 ? 0.0 : d / sqrt(variance);
            count_difference(&maps->z_histogram, d, z);
            worst = isnan(z) || fabs(z) > fabs(worst) ? z : worst;
        }
    }
    maps->difference[i] = (float)difference;
    maps->relative[i]   = (float)relative;
    if (maps->z) {
        maps->z[i] = (float)worst;
    }
}

assay_status assay_report_maps_create(assay_context *context, const assay_image *reference,
                                      const assay_image *candidate, assay_report_maps *maps_out)
{
    planes       a, b;
    const size_t pixels =
        (size_t)assay_image_width(reference) * (size_t)assay_image_height(reference);
    take_planes(reference, &a);
    take_planes(candidate, &b);
    assay_report_maps maps = {
        .noise = (has_noise(reference, &a) ? ASSAY_NOISE_REFERENCE : 0u) |
                 (has_noise(candidate, &b) ? ASSAY_NOISE_CANDIDATE : 0u),
        .relative_histogram = {.low = -6.0, .step = 0.125, .bins = 64},
        .z_histogram        = {.low = -6.0, .step = 0.25, .bins = 48},
    };
    maps.difference = assay_allocate(context, pixels, sizeof *maps.difference);
    maps.relative   = assay_allocate(context, pixels, sizeof *maps.relative);
    maps.z          = maps.noise ? assay_allocate(context, pixels, sizeof *maps.z) : NULL;
    if (!maps.difference || !maps.relative || (maps.noise && !maps.z)) {
        assay_report_maps_release(context, &maps);
        return assay_fail_memory(context, "maps of difference");
    }
    for (size_t i = 0; i < pixels; i++) {
        judge_pixel(&a, &b, i, &maps);
    }
    *maps_out = maps;
    return ASSAY_OK;
}

void assay_report_maps_release(assay_context *context, assay_report_maps *maps)
{
    assay_release(context, maps->difference);
    assay_release(context, maps->relative);
    assay_release(context, maps->z);
    maps->difference = maps->relative = maps->z = NULL;
}

void assay_report_luminance(const assay_image *image, assay_report_histogram *histogram_out)
{
    planes       p;
    const size_t pixels      = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
    assay_report_histogram h = {.low = -20.0, .step = 0.5, .bins = 64};
    take_planes(image, &p);
    for (size_t i = 0; i < pixels; i++) {
        const double luminance =
            0.2126 * p.value[0][i] + 0.7152 * p.value[1][i] + 0.0722 * p.value[2][i];
        count_value(&h, luminance > 0.0    ? assay_log(luminance) * LOG2_OF_E
                        : isnan(luminance) ? (double)NAN
                                           : -HUGE_VAL);
    }
    *histogram_out = h;
}

double assay_report_exposure(const assay_image *image)
{
    planes p;
    take_planes(image, &p);
    const double mean = (p.mean[0] + p.mean[1] + p.mean[2]) / 3.0;
    return mean > 0.0
               ? fmax(-12.0, fmin(12.0, assay_floor(0.5 - assay_log(3.0 * mean) * LOG2_OF_E)))
               : 0.0;
}
