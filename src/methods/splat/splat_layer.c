/* splat_layer.c - the steps of algorithm 4.
 *
 * Invariant: a pixel is asked after all records that were made for pixels before it were splatted.
 * Its sum of weights has then been added in the order of the records' numbers, as a query adds it,
 * so that algorithm 4 makes the very records that algorithm 1 makes with the same order of pixels.
 *
 * Step 5 as printed splats "for all cache records" onto a buffer that step 2 left with the old ones
 * in it; where old records meet new ones they count twice.  The text says that the new ones alone
 * are splatted.  Corrected, there is nothing left to do: one buffer took the new ones in step 4. */
#include "methods/splat/splat_layer.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"

assay_status splat_layer_open(assay_context *context, int width, int height,
                              assay_irradiance_cache *cache, splat_layer *layer_out)
{
    splat_layer  layer  = {.cache = cache};
    assay_status status = assay_splat_buffer_create(context, width, height, &layer.buffer);
    layer.fate          = assay_allocate(context, (size_t)width * (size_t)height, 1);
    if (status == ASSAY_OK && !layer.fate) {
        status = assay_fail_memory(context, "a splat buffer");
    }
    if (status != ASSAY_OK) {
        splat_layer_close(context, &layer);
        return status;
    }
    layer.source.store = assay_irradiance_cache_store(cache);
    layer.source.rules = *assay_record_store_rules(layer.source.store);
    layer.old          = assay_record_store_count(layer.source.store);
    *layer_out         = layer;
    return ASSAY_OK;
}

void splat_layer_close(assay_context *context, splat_layer *layer)
{
    if (context) {
        assay_splat_buffer_destroy(layer->buffer);
        assay_release(context, layer->fate);
    }
    *layer = (splat_layer){0};
}

static uint32_t count_of(const splat_layer *layer)
{
    return assay_record_store_count(layer->source.store);
}

/* Eq. 4.8; a weight of [tabellion04] says enough wherever it is. */
static bool knows_enough(const splat_layer *layer, size_t pixel)
{
    const assay_record_rules *rules  = &layer->source.rules;
    const double              weight = assay_splat_weight(layer->buffer, pixel);
    return weight > 0.0 && (rules->weight == ASSAY_WEIGHT_TABELLION || weight >= rules->a);
}

static assay_status tell(const splat_listener *listener, const splat_layer *layer)
{
    return listener ? listener->tell(listener->user, layer, count_of(layer)) : ASSAY_OK;
}

/* A record at the pixel, which knows too little. */
static assay_status serve(splat_layer *layer, const splat_rules *rules, const splat_order *order,
                          uint32_t pixel, const splat_listener *listener)
{
    const uint32_t number = count_of(layer);
    if (number >= rules->max_records || layer->made >= rules->max_new) {
        layer->fate[pixel] = SPLAT_MISSED;
        return ASSAY_OK;
    }
    assay_status status = assay_irradiance_cache_make(layer->cache, &order->points[pixel]);
    status =
        status ? status : assay_splat_records(layer->buffer, &layer->source, number, number + 1);
    if (status != ASSAY_OK) {
        return status;
    }
    layer->fate[pixel] = SPLAT_MADE;
    layer->made++;
    return rules->batch > 0 && layer->made % rules->batch == 0 ? tell(listener, layer) : ASSAY_OK;
}

/* Step 4.  A pixel whose own record a billboard loses is not asked again. */
static assay_status detect(splat_layer *layer, const splat_rules *rules, const splat_order *order,
                           const splat_listener *listener)
{
    assay_status status = ASSAY_OK;
    for (size_t i = 0; i < order->count && status == ASSAY_OK; i++) {
        const uint32_t pixel = order->pixels[i];
        if (assay_splat_has_point(layer->buffer, pixel) && layer->fate[pixel] != SPLAT_MADE &&
            !knows_enough(layer, pixel)) {
            const uint32_t before = count_of(layer);
            status                = serve(layer, rules, order, pixel, listener);
            if (status == ASSAY_OK && count_of(layer) > before) {
                status = assay_progress(assay_splat_context(layer->buffer), order->phase,
                                        order->before, order->total);
            }
        }
    }
    return status;
}

/* A record that shrinks others leaves their old splats behind: those are done again, and points
 * that they covered are asked again.  Each round makes a record at a pixel that had none, so it
 * ends. */
static assay_status detect_again(splat_layer *layer, const splat_rules *rules,
                                 const splat_order *order, const splat_listener *listener)
{
    uint32_t     before = 0;
    assay_status status = ASSAY_OK;
    do {
        before = count_of(layer);
        status = detect(layer, rules, order, listener);
        assay_splat_buffer_clear(layer->buffer);
        status = status ? status
                        : assay_splat_records(layer->buffer, &layer->source, 0, count_of(layer));
    } while (status == ASSAY_OK && count_of(layer) > before);
    return status;
}

/* Step 5, and figure 4.12. */
static assay_status finish(splat_layer *layer, const splat_rules *rules)
{
    assay_splat_source source = layer->source;
    const bool         other  = rules->accuracy > 0.0 && rules->accuracy != source.rules.a;
    assay_status       status = ASSAY_OK;
    if (!other && rules->variant == SPLAT_CORRECTED) {
        return ASSAY_OK;
    }
    source.rules.a = other ? rules->accuracy : source.rules.a;
    assay_splat_buffer_clear(layer->buffer);
    if (rules->variant == SPLAT_PUBLISHED) {
        status = assay_splat_records(layer->buffer, &source, 0, layer->old);
    }
    return status ? status : assay_splat_records(layer->buffer, &source, 0, count_of(layer));
}

assay_status splat_layer_fill(splat_layer *layer, const splat_rules *rules,
                              const splat_order *order, const splat_listener *listener)
{
    assay_status status  = assay_splat_buffer_close(layer->buffer);
    layer->source.bounds = rules->bounds;
    for (size_t i = 0; i < order->count; i++) {
        layer->fate[order->pixels[i]] = SPLAT_COVERED;
    }
    status =
        status ? status : assay_splat_records(layer->buffer, &layer->source, 0, count_of(layer));
    status = status ? status : tell(listener, layer);
    if (status == ASSAY_OK) {
        status = (rules->again ? detect_again : detect)(layer, rules, order, listener);
    }
    status = status ? status : finish(layer, rules);
    return status ? status : tell(listener, layer);
}
