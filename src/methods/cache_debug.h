/* cache_debug.h - pictures of what a cache does, in the place of the colour. */
#ifndef ASSAY_METHODS_CACHE_DEBUG_H
#define ASSAY_METHODS_CACHE_DEBUG_H

#include "methods/cached_image.h"
#include "record/irradiance_cache.h"

typedef enum {
    ASSAY_CACHE_DEBUG_OFF,
    ASSAY_CACHE_DEBUG_RECORDS, /* records as dots, the borders of their zones ([gautron06] fig. 2.3)
                                  over the dimmed image */
    ASSAY_CACHE_DEBUG_WEIGHTS, /* heat of the sum of weights times a: black 1, white 1000 and more
                                */
    ASSAY_CACHE_DEBUG_ERROR    /* heat of |E - E_ref| / (E_ref + 0.01 mean) of the indirect
                                  irradiance, green: black 0, white 0.2 and more                   */
} assay_cache_debug_kind;

typedef struct {
    assay_cache_debug_kind kind;
    assay_image           *reference; /* of ERROR: owned */
    const float           *expected;  /* its IrradianceIndirect.G */
    double                 mean;
} assay_cache_debug;

/* reference: an image with the layer IrradianceIndirect of the frame's size, for ERROR alone.
 * Errors: ARGUMENT (ERROR without a reference, or of another size or layers), and those of reading
 * it. */
assay_status assay_cache_debug_open(const assay_frame *frame, assay_cache_debug_kind kind,
                                    const char *reference, assay_cache_debug *debug_out);
void         assay_cache_debug_close(assay_cache_debug *debug);

/* The picture's colour at a point; limit and worker as in assay_irradiance_cache_look_up. */
assay_status assay_cache_debug_paint(const assay_cache_debug *debug, assay_irradiance_cache *cache,
                                     const assay_cached_point *point, uint32_t limit, int worker,
                                     assay_rgb color, assay_rgb *picture_out);

#endif
