/* compare.c - differences of two images, channel by channel.
 *
 * Invariant: a channel belongs to one worker, its sums run in pixel order and are compensated, so a
 * result is the same on every machine and exact to a few units whatever the size of the image. */
#include "assay/compare.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "io/image_access.h"
#include "math/running_sum.h"
#include "oracle/metrics/channel_mean.h"
#include "oracle/metrics/picture.h"

struct assay_comparison {
    assay_context            *context;
    assay_channel_difference *channels;
    int                       count;
    bool                      identical;
};

double assay_channel_mean(const assay_channel *a, const assay_channel *b, size_t pixels)
{
    running_sum sum   = {0};
    uint64_t    count = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double x = assay_channel_value(a, i);
        if (isfinite(x) && isfinite(assay_channel_value(b, i))) {
            running_sum_add(&sum, x);
            count++;
        }
    }
    return running_sum_mean(&sum, count);
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
    running_sum squares = {0};
    uint64_t    count   = 0;
    for (size_t i = 0; i < pixels; i++) {
        const double d = assay_channel_value(b, i) - assay_channel_value(a, i);
        const double variance =
            assay_channel_value(&variances[0], i) + assay_channel_value(&variances[1], i);
        if (isfinite(d) && isfinite(variance) && variance > 0.0) {
            running_sum_add(&squares, d * d / variance);
            count++;
        }
    }
    return sqrt(running_sum_mean(&squares, count));
}

/* x / scale, where nothing of nothing is nothing. */
static double ratio(double x, double scale) { return x == 0.0 ? 0.0 : x / scale; }

static void compare_pixels(const assay_channel *a, const assay_channel *b, size_t pixels, int width,
                           assay_channel_difference *out)
{
    const double floor_squared = 1e-2 * out->mean_a * out->mean_a;
    running_sum  squares = {0}, relative = {0}, to_scale = {0}, errors = {0};
    out->max_x = out->max_y = -1;
    for (size_t i = 0; i < pixels; i++) {
        const double x = assay_channel_value(a, i), y = assay_channel_value(b, i);
        out->differing += differ(a, b, i);
        if (!isfinite(x) || !isfinite(y)) {
            out->not_finite += !(isnan(x) && isnan(y)) && !(x == y);
            continue;
        }
        const double d = y - x;
        running_sum_add(&errors, d);
        running_sum_add(&squares, d * d);
        running_sum_add(&relative, d * d / (x * x + ASSAY_RELATIVE_MSE_FLOOR));
        running_sum_add(&to_scale, ratio(d * d, x * x + floor_squared));
        if (out->max_x < 0 || fabs(d) > out->max_abs) {
            out->max_abs = fabs(d);
            out->max_x   = (int)(i % (size_t)width);
            out->max_y   = (int)(i / (size_t)width);
        }
        out->pixels++;
    }
    out->mean_error    = running_sum_mean(&errors, out->pixels);
    out->mse           = running_sum_mean(&squares, out->pixels);
    out->rmse          = sqrt(out->mse);
    out->relative_mse  = running_sum_mean(&relative, out->pixels);
    out->relative_rmse = sqrt(running_sum_mean(&to_scale, out->pixels));
}

typedef struct {
    const assay_image        *a, *b;
    assay_channel_difference *channels; /* their names are set */
} compare_job;

static assay_status compare_one(void *user, uint64_t index, int worker)
{
    const compare_job        *job    = user;
    assay_channel_difference *out    = &job->channels[index];
    const size_t              pixels = assay_image_pixels(job->a);
    assay_channel             a, b, variances[2];
    (void)worker;
    if (!assay_image_find_channel(job->a, out->channel, &a) ||
        !assay_image_find_channel(job->b, out->channel, &b)) {
        return ASSAY_ERR_INTERNAL;
    }
    out->mean_a = assay_channel_mean(&a, &b, pixels);
    out->mean_b = assay_channel_mean(&b, &a, pixels);
    out->z_rms  = find_variances(job->a, job->b, out->channel, variances)
                      ? z_rms(&a, &b, variances, pixels)
                      : NAN;
    compare_pixels(&a, &b, pixels, assay_image_width(job->a), out);
    return ASSAY_OK;
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

assay_status assay_image_compare(const assay_image *a, const assay_image *b,
                                 assay_comparison **comparison_out)
{
    assay_context *context = assay_image_context(a);
    assay_status   status  = assay_images_check_sizes(a, b);
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
        const char *name = assay_image_channel_at(a, i).name;
        if (assay_image_find_channel(b, name, NULL)) {
            comparison->channels[comparison->count++].channel = name;
        }
    }
    if (comparison->count == 0) {
        assay_comparison_destroy(comparison);
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "the images have no channel in common");
    }
    compare_job job = {.a = a, .b = b, .channels = comparison->channels};
    status = assay_parallel_for(context, "compare", (uint64_t)comparison->count, compare_one, &job);
    if (status != ASSAY_OK) {
        assay_comparison_destroy(comparison);
        return status;
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

static const assay_channel_difference *find_difference(const assay_comparison *comparison,
                                                       const char             *name)
{
    for (int i = 0; i < comparison->count; i++) {
        if (strcmp(comparison->channels[i].channel, name) == 0) {
            return &comparison->channels[i];
        }
    }
    return NULL;
}

bool assay_comparison_color(const assay_comparison *comparison, const char *layer,
                            assay_color_difference *difference_out)
{
    assay_color_difference out           = {0};
    double                 relative_rmse = 0.0;
    for (int c = 0; c < 3; c++) {
        char name[ASSAY_LAYER_NAME];
        assay_layer_channel(layer, c, name);
        const assay_channel_difference *d = find_difference(comparison, name);
        if (!d) {
            return false;
        }
        out.mean_a += d->mean_a / 3.0;
        out.mean_error += d->mean_error / 3.0;
        out.mse += d->mse / 3.0;
        out.relative_mse += d->relative_mse / 3.0;
        relative_rmse += d->relative_rmse * d->relative_rmse / 3.0;
    }
    out.rmse          = sqrt(out.mse);
    out.relative_rmse = sqrt(relative_rmse);
    *difference_out   = out;
    return true;
}
