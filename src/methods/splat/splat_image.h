/* splat_image.h - an image by splatting: G-buffer, splat buffers, and what pixels take from them.
 */
#ifndef ASSAY_METHODS_SPLAT_IMAGE_H
#define ASSAY_METHODS_SPLAT_IMAGE_H

#include "methods/cache_session.h"
#include "methods/splat/splat_gloss.h"
#include "methods/splat/splat_layer.h"

/* What pixels show that no record reaches. */
typedef enum { SPLAT_NEAREST, SPLAT_BLACK } splat_uncovered;

typedef struct {
    assay_context             *context;
    const assay_frame         *frame;
    const assay_cache_set     *caches; /* borrowed */
    const glossy_materials    *materials;
    assay_cache_session       *session;
    const assay_path_settings *path;
    splat_rules                rules;
    splat_uncovered            uncovered;
    bool                       centres; /* samples take the light of their pixel's centre */

    splat_layer  diffuse, glossy; /* glossy: zeros where no material is within reach */
    splat_gloss *gloss;

    /* the G-buffer; of a sweep */
    assay_cache_point *points;  /* a pixel */
    assay_rgb         *lambert; /* a pixel: albedo of the Lambertian part */
    uint32_t          *order;   /* in which pixels came */
    size_t             count;
    bool               begun;

    bool      dumped;    /* the steps of the first sweep */
    uint64_t  lost;      /* contributions, to billboards */
    uint64_t *unreached; /* a worker: looks at pixels that no irradiance record reaches */
} splat_image;

/* Makes room for a frame's pixels; the fields before the layers are set.  Errors: MEMORY. */
assay_status splat_image_open(splat_image *image);
void         splat_image_close(splat_image *image);

/* What the driver of cached images asks; its user is the image. */
assay_cached_light splat_image_light(splat_image *image);

uint64_t splat_image_unreached(const splat_image *image);

#endif
