/* compare.c - differences of two images, channel by channel.
 *
 * Invariant: sums run in pixel order and are compensated ([neumaier74]), so a result is the same on
 * every machine and exact to a few units whatever the size of the image. */
#include "assay/compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/compare_channels.h"

struct assay_comparison {
    assay_context            *context;
    assay_channel_difference *channels;
    int                       count;
    bool                      identical;
};

typedef struct {
    double sum, lost;
} accumulator;

static void add(accumulator *a, double x)
{
    const double next = a->sum + x;
    a->lost += fabs(a->sum) >= fabs(x) ? (a->sum - next) + x : (x - next) + a->sum;
    a->sum = next;
}

/* NaN over nothing; what is not finite stays so. */
static double mean(const accumulator *a, uint64_t count)
{
    const double total = isfinite(a->sum) ? a->sum + a->lost : a->sum;
    return count ? total / (double)count : NAN;
}

size_t assay_image_pixels(const assay_image *image)
{
    return (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
}

double assay_channel_value(const assay_channel *channel, size_t pixel)
{
    return channel->type == ASSAY_CHANNEL_UINT ? channel->data.u32[pixel]
                                               : channel->data.f32[pixel];
}

double assay_channel_mean(const assay_channel *a, const assay_channel *b, size_t pixels)
{
    accumulator sum   = {0};
    uint64_t    count = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double x = assay_channel_value(a, i);
        if (isfinite(x) && isfinite(assay_channel_value(b, i))) {
            add(&sum, x);
            count++;
        }
    }
    return mean(&sum, count);
}

static bool differ(const assay_channel *a, const assay_channel *b, size_t pixel)
{
    const double x = assay_channel_value(a, pixel), y = assay_channel_value(b, pixel);
    if (isnan(x) && isnan(y)) {
        return false;
    }
    return a->type == b->type ? a->data.u32[pixel] != b->data.u32[pixel] : x != y;
}

/* Both channels of variance, where both images have them. */
static bool find_variances(const assay_image *a, const assay_image *b, const char *name,
                           assay_channel variances[2])
{
    char variance[300];
    snprintf(variance, sizeof variance, "Variance.%s", name);
    return assay_image_find_channel(a, variance, &variances[0]) &&
           assay_image_find_channel(b, variance, &variances[1]);
}

/* rms of the difference in units of its expected standard deviation. */
static double z_rms(const assay_channel *a, const assay_channel *b, const assay_channel *variances,
                    size_t pixels)
{
    accumulator squares = {0};
    uint64_t    count   = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double d = assay_channel_value(b, i) - assay_channel_value(a, i);
        const double variance =
            assay_channel_value(&variances[0], i) + assay_channel_value(&variances[1], i);
        if (isfinite(d) && isfinite(variance) && variance > 0.0) {
            add(&squares, d * d / variance);
            count++;
        }
    }
    return sqrt(mean(&squares, count));
}

/* x / scale, where nothing of nothing is nothing. */
static double ratio(double x, double scale) { return x == 0.0 ? 0.0 : x / scale; }

static void compare_pixels(const assay_channel *a, const assay_channel *b, size_t pixels, int width,
                           assay_channel_difference *out)
{
    const double floor_squared = 1e-2 * out->mean_a * out->mean_a;
    accumulator  squares = {0}, relative = {0}, errors = {0};
    out->max_x = out->max_y = -1;
    for (size_t i = 0; i < pixels; i++) {
        const double x = assay_channel_value(a, i), y = assay_channel_value(b, i);
        out->differing += differ(a, b, i);
        if (!isfinite(x) || !isfinite(y)) {
            out->not_finite += !(isnan(x) && isnan(y)) && !(x == y);
            continue;
        }
        const double d = y - x;
        add(&errors, d);
        add(&squares, d * d);
        add(&relative, ratio(d * d, x * x + floor_squared));
        if (out->max_x < 0 || fabs(d) > out->max_abs) {
            out->max_abs = fabs(d);
            out->max_x   = (int)(i % (size_t)width);
            out->max_y   = (int)(i / (size_t)width);
        }
        out->pixels++;
    }
    out->mean_error    = mean(&errors, out->pixels);
    out->rmse          = sqrt(mean(&squares, out->pixels));
    out->relative_rmse = sqrt(mean(&relative, out->pixels));
}

static assay_channel_difference compare_channel(const assay_image *image_a,
                                                const assay_image *image_b, const assay_channel *a,
                                                const assay_channel *b)
{
    const size_t             pixels = assay_image_pixels(image_a);
    assay_channel            variances[2];
    assay_channel_difference out = {.channel = a->name, .z_rms = NAN};
    out.mean_a                   = assay_channel_mean(a, b, pixels);
    out.mean_b                   = assay_channel_mean(b, a, pixels);
    compare_pixels(a, b, pixels, assay_image_width(image_a), &out);
    if (find_variances(image_a, image_b, a->name, variances)) {
        out.z_rms = z_rms(a, b, variances, pixels);
    }
    return out;
}

static bool identical_images(const assay_image *a, const assay_image *b)
{
    const int count = assay_image_channel_count(a);
    if (count != assay_image_channel_count(b)) {
        return false;
    }
    for (int i = 0; i < count; i++) {
        const assay_channel x = assay_image_channel_at(a, i), y = assay_image_channel_at(b, i);
        if (strcmp(x.name, y.name) != 0 || x.type != y.type ||
            memcmp(x.data.u32, y.data.u32, assay_image_pixels(a) * sizeof *x.data.u32) != 0) {
            return false;
        }
    }
    return true;
}

assay_status assay_images_check_sizes(const assay_image *a, const assay_image *b)
{
    if (assay_image_width(a) == assay_image_width(b) &&
        assay_image_height(a) == assay_image_height(b)) {
        return ASSAY_OK;
    }
    return assay_fail(assay_image_context(a), ASSAY_ERR_ARGUMENT,
                      "the images differ in size: %d x %d and %d x %d pixels", assay_image_width(a),
                      assay_image_height(a), assay_image_width(b), assay_image_height(b));
}

assay_status assay_image_compare(const assay_image *a, const assay_image *b,
                                 assay_comparison **comparison_out)
{
    assay_context     *context = assay_image_context(a);
    const assay_status status  = assay_images_check_sizes(a, b);
    if (status != ASSAY_OK) {
        return status;
    }
    const int         channels   = assay_image_channel_count(a);
    assay_comparison *comparison = assay_allocate(context, 1, sizeof *comparison);
    if (!comparison) {
        return assay_fail_memory(context, "a comparison");
    }
    comparison->context  = context;
    comparison->channels = assay_allocate(context, (size_t)channels, sizeof *comparison->channels);
    if (!comparison->channels) {
        assay_comparison_destroy(comparison);
        return assay_fail_memory(context, "a comparison");
    }
    for (int i = 0; i < channels; i++) {
        const assay_channel x = assay_image_channel_at(a, i);
        assay_channel       y;
        if (assay_image_find_channel(b, x.name, &y)) {
            comparison->channels[comparison->count++] = compare_channel(a, b, &x, &y);
        }
    }
    if (comparison->count == 0) {
        assay_comparison_destroy(comparison);
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "the images have no channel in common");
    }
    comparison->identical = identical_images(a, b);
    *comparison_out       = comparison;
    return ASSAY_OK;
}

void assay_comparison_destroy(assay_comparison *comparison)
{
    if (comparison) {
        assay_release(comparison->context, comparison->channels);
        assay_release(comparison->context, comparison);
    }
}

int assay_comparison_count(const assay_comparison *comparison) { return comparison->count; }

assay_channel_difference assay_comparison_at(const assay_comparison *comparison, int index)
{
    return comparison->channels[index];
}

bool assay_comparison_identical(const assay_comparison *comparison)
{
    return comparison->identical;
}
