/* splat_layer.h - [gautron06] algorithm 4 over the records of one cache: old records are splatted,
 * what is missing is found and made, new records are splatted at once. */
#ifndef ASSAY_METHODS_SPLAT_LAYER_H
#define ASSAY_METHODS_SPLAT_LAYER_H

#include "record/irradiance_cache.h"
#include "record/splat.h"

typedef enum {
    SPLAT_CORRECTED, /* step 5 adds nothing, as new records were added when they were made      */
    SPLAT_PUBLISHED  /* step 5 adds all records to a buffer that has the old ones already       */
} splat_variant;

typedef struct {
    splat_variant           variant;
    assay_splat_bounds_kind bounds;
    double                  accuracy;    /* of the last splatting; 0: the cache's own           */
    uint32_t                max_records; /* in all                                              */
    uint32_t                max_new;     /* a frame                                             */
    bool                    again;       /* records may shrink: look until nothing is missing   */
    uint32_t batch; /* told after so many new records, if that is not 0                        */
} splat_rules;

/* What became of a pixel. */
enum { SPLAT_COVERED, SPLAT_MADE, SPLAT_MISSED };

typedef struct {
    assay_irradiance_cache *cache;  /* borrowed */
    assay_splat_buffer     *buffer; /* owned    */
    assay_splat_source      source;
    uint8_t                *fate; /* a pixel: of the last filling */
    uint32_t                old;  /* records when the layer was opened */
    uint32_t                made; /* since then                        */
} splat_layer;

/* Told after the old records (step 2), after every batch of new ones, and at the end. */
typedef struct {
    assay_status (*tell)(void *user, const splat_layer *layer, uint32_t end);
    void *user;
} splat_listener;

/* For a frame.  Zeros are a layer that may be closed.  Errors: MEMORY. */
assay_status splat_layer_open(assay_context *context, int width, int height,
                              assay_irradiance_cache *cache, splat_layer *layer_out);
void         splat_layer_close(assay_context *context, splat_layer *layer);

/* The order in which pixels are asked. */
typedef struct {
    const uint32_t          *pixels;
    size_t                   count;
    const assay_cache_point *points; /* a pixel of the image */
    const char              *phase;  /* of the progress */
    uint64_t                 before, total;
} splat_order;

/* Steps 2 to 5.  Pixels that have a point in the buffer are asked.  Errors: those of making records
 * and of splatting; of the listener. */
assay_status splat_layer_fill(splat_layer *layer, const splat_rules *rules,
                              const splat_order *order, const splat_listener *listener);

#endif
