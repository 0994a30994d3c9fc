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
                                  irradiance (or radiance), green: black 0, white 0.2 and more     */
} assay_cache_debug_kind;

/* A channel that ERROR compares with, and its mean. */
typedef struct {
    const float *values;
    double       mean;
} assay_cache_debug_truth;

typedef struct {
    assay_cache_debug_kind  kind;
    assay_image            *reference;  /* of ERROR: owned             */
    assay_cache_debug_truth irradiance; /* its IrradianceIndirect.G    */
    assay_cache_debug_truth radiance;   /* its Indirect.G, where asked */
} assay_cache_debug;

/* reference: an image of the frame's size with the layer IrradianceIndirect, and with_radiance the
 * layer Indirect, for ERROR alone.  Errors: ARGUMENT (ERROR without a reference, or of another size
 * or layers), and those of reading it. */
assay_status assay_cache_debug_open(const assay_frame *frame, assay_cache_debug_kind kind,
                                    const char *reference, bool with_radiance,
                                    assay_cache_debug *debug_out);
void         assay_cache_debug_close(assay_cache_debug *debug);

/* The colour of ERROR where `value` is what the cache says of a pixel. */
assay_rgb assay_cache_debug_error(const assay_cache_debug_truth *truth, uint64_t pixel,
                                  double value);

/* The picture's colour at a point; limit and worker as in assay_irradiance_cache_look_up. */
assay_status assay_cache_debug_paint(const assay_cache_debug *debug, assay_irradiance_cache *cache,
                                     const assay_cached_point *point, uint32_t limit, int worker,
                                     assay_rgb color, assay_rgb *picture_out);

#endif
