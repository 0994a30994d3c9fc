/* cache_debug.c - one colour a point, from what the cache knows there. */
#include "methods/cache_debug.h"

#include <math.h>

#include "assay/image.h"
#include "core/context.h"
#include "core/numerics.h"
#include "io/heat_color.h"

/* In pixels: of a record's dot, and of a zone's border. */
static const double DOT_RADIUS = 1.5, BORDER_WIDTH = 1.0;

static const double DIMMED = 0.3, LARGEST_ERROR = 0.2;

static bool find_truth(const assay_frame *frame, const assay_image *image, const char *name,
                       assay_cache_debug_truth *truth_out)
{
    const size_t  pixels = (size_t)frame->width * (size_t)frame->height;
    assay_channel channel;
    if (assay_image_width(image) != frame->width || assay_image_height(image) != frame->height ||
        !assay_image_find_channel(image, name, &channel) || channel.type != ASSAY_CHANNEL_FLOAT) {
        return false;
    }
    assay_cache_debug_truth truth = {.values = channel.data.f32};
    for (size_t i = 0; i < pixels; i++) {
        truth.mean += truth.values[i] / (double)pixels;
    }
    *truth_out = truth;
    return true;
}

assay_status assay_cache_debug_open(const assay_frame *frame, assay_cache_debug_kind kind,
                                    const char *reference, bool with_radiance,
                                    assay_cache_debug *debug_out)
{
    const char *layers =
        with_radiance ? "layers IrradianceIndirect and Indirect" : "layer IrradianceIndirect";
    assay_cache_debug debug = {.kind = kind};
    if (kind != ASSAY_CACHE_DEBUG_ERROR) {
        *debug_out = debug;
        return ASSAY_OK;
    }
    if (!reference) {
        return assay_fail(frame->context, ASSAY_ERR_ARGUMENT,
                          "debug=error needs a reference: an image with the %s", layers);
    }
    const assay_status status = assay_image_read(frame->context, reference, &debug.reference);
    if (status != ASSAY_OK) {
        return status;
    }
    if (!find_truth(frame, debug.reference, "IrradianceIndirect.G", &debug.irradiance) ||
        (with_radiance && !find_truth(frame, debug.reference, "Indirect.G", &debug.radiance))) {
        assay_image_destroy(debug.reference);
        return assay_fail(frame->context, ASSAY_ERR_ARGUMENT,
                          "%s: as the reference of debug=error it must have %d x %d pixels and the "
                          "%s",
                          reference, frame->width, frame->height, layers);
    }
    *debug_out = debug;
    return ASSAY_OK;
}

void assay_cache_debug_close(assay_cache_debug *debug) { assay_image_destroy(debug->reference); }

/* ---- records ---- */

static assay_rgb paint_records(assay_irradiance_cache *cache, const assay_contributions *found,
                               const assay_cached_point *point, assay_rgb color)
{
    const assay_record_store *store    = assay_irradiance_cache_store(cache);
    const double              a        = assay_record_store_rules(store)->a;
    const assay_vec3          position = point->vertex.surface.position;
    assay_rgb                 picture  = rgb_scale(color, DIMMED);
    for (size_t i = 0; i < found->count; i++) {
        const assay_record *record = assay_record_store_at(store, found->items[i].number);
        const double        d      = vec3_length(vec3_sub(record->position, position));
        if (d <= DOT_RADIUS * point->footprint) {
            return rgb_grey(1.0);
        }
        /* Eq. 2.5 solved for the distance: how far it is from here to where the record ends. */
        const double reach = (a - 1.0 / found->items[i].weight) * record->radius;
        if (assay_record_store_rules(store)->weight == ASSAY_WEIGHT_WARD &&
            reach <= BORDER_WIDTH * point->footprint) {
            picture = rgb(1.0, 0.5, 0.0);
        }
    }
    return picture;
}

static assay_rgb paint_weights(const assay_contributions *found, double a)
{
    const double sum = found->weight * a;
    return assay_heat_color(sum > 1.0 ? assay_log(sum) / assay_log(1000.0) : 0.0);
}

assay_rgb assay_cache_debug_error(const assay_cache_debug_truth *truth, uint64_t pixel,
                                  double value)
{
    const double expected = truth->values[pixel];
    const double scale    = expected + 0.01 * truth->mean;
    const double error    = fabs(value - expected);
    /* Where a reference is all black, every light is an error. */
    return assay_heat_color(error > 0.0 ? (scale > 0.0 ? error / scale / LARGEST_ERROR : 1.0)
                                        : 0.0);
}

assay_status assay_cache_debug_paint(const assay_cache_debug *debug, assay_irradiance_cache *cache,
                                     const assay_cached_point *point, uint32_t limit, int worker,
                                     assay_rgb color, assay_rgb *picture_out)
{
    const assay_contributions *found = NULL;
    if (!point->hit) {
        *picture_out =
            debug->kind == ASSAY_CACHE_DEBUG_RECORDS ? rgb_scale(color, DIMMED) : rgb_grey(0.0);
        return ASSAY_OK;
    }
    const assay_gather_site site = assay_gather_site_of(&point->vertex);
    assay_rgb               e    = rgb_grey(0.0);
    const assay_status      status =
        debug->kind == ASSAY_CACHE_DEBUG_ERROR
                 ? assay_irradiance_cache_look_up(cache, site.position, site.frame.z, limit, worker, &e)
                 : assay_irradiance_cache_find(cache, site.position, site.frame.z, limit, worker,
                                               &found);
    if (status != ASSAY_OK) {
        return status;
    }
    switch (debug->kind) {
    case ASSAY_CACHE_DEBUG_OFF: *picture_out = color; break;
    case ASSAY_CACHE_DEBUG_RECORDS: *picture_out = paint_records(cache, found, point, color); break;
    case ASSAY_CACHE_DEBUG_WEIGHTS:
        *picture_out =
            paint_weights(found, assay_record_store_rules(assay_irradiance_cache_store(cache))->a);
        break;
    case ASSAY_CACHE_DEBUG_ERROR:
        *picture_out = assay_cache_debug_error(&debug->irradiance, point->pixel, e.g);
        break;
    }
    return ASSAY_OK;
}
