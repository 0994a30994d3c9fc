/* flip_tone.c - from what a scene sends out to what a display shows.
 *
 * Invariant: the exposures depend on the reference and the options alone, never on the candidate:
 * two candidates are judged at the same ones. */
#include "oracle/metrics/flip_tone.h"

#include <math.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "oracle/metrics/float_sort.h"

/* What a tone-mapped luminance of the brightest and of the median pixel has to be. */
static const double TARGET = 0.85;

/* [hable10]: A B C D E F, the white point, and an exposure that the published curve adds. */
static assay_tone_curve hable(void)
{
    const double a = 0.15, b = 0.5, c = 0.1, d = 0.2, e = 0.02, f = 0.3, white = 11.2, bias = 2.0;
    const double k0 = a * f - a * e, k1 = c * b * f - b * e;
    const double k3 = a * f, k4 = b * f, k5 = d * f * f;
    const double scale = (k3 * white * white + k4 * white + k5) / (k0 * white * white + k1 * white);
    return (assay_tone_curve){
        .k = {bias * bias * k0 * scale, bias * k1 * scale, 0.0, bias * bias * k3, bias * k4, k5}};
}

/* [narkowicz16]'s fit of ACES without its exposure of 0.6. */
static assay_tone_curve aces(void)
{
    const double s = 0.6;
    return (assay_tone_curve){.k = {s * s * 2.51, s * 0.03, 0.0, s * s * 2.43, s * 0.59, 0.14}};
}

assay_tone_curve assay_tone_curve_of(assay_tone_mapper mapper)
{
    switch (mapper) {
    case ASSAY_TONE_HABLE: return hable();
    case ASSAY_TONE_REINHARD:
        return (assay_tone_curve){.k = {0.0, 1.0, 0.0, 0.0, 1.0, 1.0}, .by_luminance = true};
    case ASSAY_TONE_ACES:
    default: return aces();
    }
}

const char *assay_tone_mapper_name(assay_tone_mapper mapper)
{
    switch (mapper) {
    case ASSAY_TONE_ACES: return "aces";
    case ASSAY_TONE_HABLE: return "hable";
    case ASSAY_TONE_REINHARD: return "reinhard";
    default: return NULL;
    }
}

static double luminance(assay_rgb c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

/* Comparisons: fmax may give either zero of two. */
static double clamp_low(double x) { return x > 0.0 ? x : 0.0; }
static double clamp_unit(double x) { return x < 1.0 ? clamp_low(x) : 1.0; }

static double numerator(const assay_tone_curve *curve, double x)
{
    return (curve->k[0] * x + curve->k[1]) * x + curve->k[2];
}

static double denominator(const assay_tone_curve *curve, double x)
{
    return (curve->k[3] * x + curve->k[4]) * x + curve->k[5];
}

assay_rgb assay_tone_map(const assay_tone_curve *curve, assay_rgb exposed)
{
    const assay_rgb c = {clamp_low(exposed.r), clamp_low(exposed.g), clamp_low(exposed.b)};
    if (curve->by_luminance) {
        const double d = denominator(curve, luminance(c));
        return (assay_rgb){clamp_unit(c.r / d), clamp_unit(c.g / d), clamp_unit(c.b / d)};
    }
    return (assay_rgb){clamp_unit(numerator(curve, c.r) / denominator(curve, c.r)),
                       clamp_unit(numerator(curve, c.g) / denominator(curve, c.g)),
                       clamp_unit(numerator(curve, c.b) / denominator(curve, c.b))};
}

double assay_tone_inverse(const assay_tone_curve *curve, double t)
{
    const double *k = curve->k;
    const double  a = k[0] - t * k[3], b = k[1] - t * k[4], c = k[2] - t * k[5];
    if (a == 0.0) {
        return -c / b;
    }
    const double half = -0.5 * b / a;
    return half + sqrt(half * half - c / a);
}

/* Luminances of the reference, sorted. */
static assay_status sorted_luminances(const assay_picture_pair *pair, float *values)
{
    const size_t pixels = (size_t)pair->width * (size_t)pair->height;
    for (size_t i = 0; i < pixels; i++) {
        const assay_rgb c = {clamp_low(pair->a[0][i]), clamp_low(pair->a[1][i]),
                             clamp_low(pair->a[2][i])};
        values[i]         = (float)luminance(c);
    }
    return assay_float_sort(pair->context, values, pixels);
}

static double median(const float *sorted, size_t count)
{
    return 0.5 * ((double)sorted[(count - 1) / 2] + (double)sorted[count / 2]);
}

/* Where more than half of the picture is black the published stop would be infinite: the median is
 * then that of what is not black.  A black picture has the exposure 0 alone. */
static void find_from(const float *sorted, size_t count, double bright, assay_exposure_range *range)
{
    size_t black = 0;
    while (black < count && !(sorted[black] > 0.0F)) {
        black++;
    }
    if (black == count) {
        range->start = range->stop = 0.0;
        return;
    }
    double middle = median(sorted, count);
    middle        = middle > 0.0 ? middle : median(sorted + black, count - black);
    range->start  = (assay_log(bright) - assay_log(sorted[count - 1])) / assay_log(2.0);
    range->stop   = (assay_log(bright) - assay_log(middle)) / assay_log(2.0);
}

static assay_status find_both(const assay_picture_pair *pair, const assay_metrics_options *options,
                              assay_exposure_range *range)
{
    const size_t           pixels = (size_t)pair->width * (size_t)pair->height;
    const assay_tone_curve curve  = assay_tone_curve_of(options->tone_mapper);
    float                 *values = assay_allocate(pair->context, pixels, sizeof *values);
    if (!values) {
        return assay_fail_memory(pair->context, "the exposures of FLIP");
    }
    const assay_status status = sorted_luminances(pair, values);
    if (status == ASSAY_OK) {
        find_from(values, pixels, assay_tone_inverse(&curve, TARGET), range);
    }
    assay_release(pair->context, values);
    return status;
}

assay_status assay_exposure_range_find(const assay_picture_pair    *pair,
                                       const assay_metrics_options *options,
                                       assay_exposure_range        *range_out)
{
    assay_exposure_range range = {options->start_exposure, options->stop_exposure, 0};
    if (isnan(range.start) || isnan(range.stop)) {
        assay_exposure_range found  = {0};
        const assay_status   status = find_both(pair, options, &found);
        if (status != ASSAY_OK) {
            return status;
        }
        range.start = isnan(range.start) ? found.start : range.start;
        range.stop  = isnan(range.stop) ? found.stop : range.stop;
    }
    if (range.start > range.stop) {
        return assay_fail(pair->context, ASSAY_ERR_ARGUMENT,
                          "the exposures start at %g stops, after their stop at %g", range.start,
                          range.stop);
    }
    range.count =
        options->exposures ? options->exposures : (int)fmax(2.0, ceil(range.stop - range.start));
    *range_out = range;
    return ASSAY_OK;
}

double assay_exposure_at(const assay_exposure_range *range, int i)
{
    return range->count < 2
               ? range->start
               : range->start + i * ((range->stop - range->start) / (range->count - 1));
}
