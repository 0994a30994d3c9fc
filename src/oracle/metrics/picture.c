/* picture.c - what every measure of pictures asks of its input before it begins.
 *
 * Invariant: no measure ever meets a NaN or an infinity, so none can turn one into a verdict. */
#include "oracle/metrics/picture.h"

#include <math.h>
#include <stdio.h>

#include "assay/compare.h"
#include "core/context.h"
#include "io/image_access.h"

assay_metrics_options assay_metrics_defaults(void)
{
    return (assay_metrics_options){.layer             = "",
                                   .pixels_per_degree = ASSAY_PIXELS_PER_DEGREE,
                                   .tone_mapper       = ASSAY_TONE_ACES,
                                   .start_exposure    = NAN,
                                   .stop_exposure     = NAN};
}

void assay_layer_channel(const char *layer, int c, char name[ASSAY_LAYER_NAME])
{
    snprintf(name, ASSAY_LAYER_NAME, "%.255s%s%c", layer, layer[0] ? "." : "", "RGB"[c]);
}

/* `whose` begins the message: "the reference's ", or nothing. */
static assay_status check_channel(const assay_image *image, const assay_channel *channel,
                                  const char *whose)
{
    const size_t width = (size_t)assay_image_width(image);
    for (size_t i = 0; i < assay_image_pixels(image); i++) {
        const float value = channel->data.f32[i];
        if (!isfinite(value)) {
            return assay_fail(assay_image_context(image), ASSAY_ERR_DOMAIN,
                              "%schannel \"%s\" is %s at pixel (%zu, %zu)", whose, channel->name,
                              isnan(value) ? "NaN" : "infinite", i % width, i / width);
        }
    }
    return ASSAY_OK;
}

assay_status assay_image_check_finite(const assay_image *image)
{
    assay_status status = ASSAY_OK;
    for (int i = 0; i < assay_image_channel_count(image) && status == ASSAY_OK; i++) {
        const assay_channel channel = assay_image_channel_at(image, i);
        if (channel.type == ASSAY_CHANNEL_FLOAT) {
            status = check_channel(image, &channel, "");
        }
    }
    return status;
}

/* One image's three channels. */
static assay_status open_layer(assay_context *context, const assay_image *image, const char *whose,
                               const char *layer, const float *values_out[3])
{
    for (int c = 0; c < 3; c++) {
        char          name[ASSAY_LAYER_NAME];
        assay_channel channel;
        assay_layer_channel(layer, c, name);
        if (!assay_image_find_channel(image, name, &channel)) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT, "%schannel \"%s\" is missing", whose,
                              name);
        }
        if (channel.type != ASSAY_CHANNEL_FLOAT) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "%schannel \"%s\" holds whole numbers, not light", whose, name);
        }
        const assay_status status = check_channel(image, &channel, whose);
        if (status != ASSAY_OK) {
            return status;
        }
        values_out[c] = channel.data.f32;
    }
    return ASSAY_OK;
}

assay_status assay_picture_pair_open(const assay_image *a, const assay_image *b, const char *layer,
                                     assay_picture_pair *pair_out)
{
    assay_picture_pair pair   = {.context = assay_image_context(a),
                                 .width   = assay_image_width(a),
                                 .height  = assay_image_height(a)};
    assay_status       status = assay_images_check_sizes(a, b);
    if (status == ASSAY_OK) {
        status = open_layer(pair.context, a, "the reference's ", layer, pair.a);
    }
    if (status == ASSAY_OK) {
        status = open_layer(pair.context, b, "the candidate's ", layer, pair.b);
    }
    if (status == ASSAY_OK) {
        *pair_out = pair;
    }
    return status;
}

static bool in_range(double x, double low, double high) { return x >= low && x <= high; }

assay_status assay_metrics_check(assay_context *context, const assay_metrics_options *o)
{
    if (!o->layer) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "the layer has no name; \"\" is R, G, B");
    }
    if (!in_range(o->exposure, -100.0, 100.0) ||
        (!isnan(o->start_exposure) && !in_range(o->start_exposure, -100.0, 100.0)) ||
        (!isnan(o->stop_exposure) && !in_range(o->stop_exposure, -100.0, 100.0))) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "an exposure is not within -100 to 100 stops");
    }
    if (!in_range(o->pixels_per_degree, ASSAY_PIXELS_PER_DEGREE_MIN, ASSAY_PIXELS_PER_DEGREE_MAX)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "%g pixels per degree: must be %g to %g",
                          o->pixels_per_degree, ASSAY_PIXELS_PER_DEGREE_MIN,
                          ASSAY_PIXELS_PER_DEGREE_MAX);
    }
    if (!assay_tone_mapper_name(o->tone_mapper)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "there is no tone mapper %d",
                          (int)o->tone_mapper);
    }
    if (o->exposures < 0 || o->exposures > ASSAY_FLIP_MAX_EXPOSURES) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "%d exposures: must be 0 (automatic) to %d",
                          o->exposures, ASSAY_FLIP_MAX_EXPOSURES);
    }
    return ASSAY_OK;
}
