/* cached_image.h - an image whose indirect light comes from caches: what the caching methods share.
 *
 * Visible points are the pixels' centres first, then every camera sample.  Caches are asked to know
 * enough at all of them, in a fixed order, and then (or at once, in a single pass) the samples are
 * evaluated: emission and direct light by the path tracer, indirect light from the caches. */
#ifndef ASSAY_METHODS_CACHED_IMAGE_H
#define ASSAY_METHODS_CACHED_IMAGE_H

#include "gather/gather.h"
#include "methods/method.h"

typedef enum {
    ASSAY_ORDER_SCANLINE,    /* row by row                                                     */
    ASSAY_ORDER_HIERARCHICAL /* every 2^k-th pixel of every 2^k-th row, then those between, ... */
} assay_pixel_order;

/* A point that is looked at. */
typedef struct {
    bool         hit;
    bool         centre; /* of a pixel: irradiance is asked here, whatever the surface          */
    assay_vertex vertex; /* dressed                              */
    double       footprint; /* m: size of a pixel there             */
    uint64_t     pixel;     /* row by row                           */
} assay_cached_point;

/* Albedo of the Lambertian part that the point shows (assay_bsdf_view_lambert). */
assay_rgb assay_cached_point_lambert(const assay_cached_point *point);

/* What the caches say of the light towards the point's wo: lambert / pi times the indirect
 * irradiance, and what the rest of its BSDF reflects, or NULL where that is none of theirs.  clamp:
 * truncated harmonics ring; a sum with them that is below 0 counts as 0. */
assay_rgb assay_cached_point_sum(assay_rgb lambert, assay_rgb irradiance, const assay_rgb *gloss,
                                 bool clamp);

/* One path for that rest; black for a Lambertian. */
assay_rgb assay_cached_point_rest(const assay_world *world, const assay_path_settings *path,
                                  const assay_cached_point *point, assay_random *random,
                                  assay_ray_counts *counts);

typedef struct {
    void *user;
    /* Makes the caches know enough at the points, in their order; limits_out: what had been made
     * when each was served.  phase, before, total: for the progress. */
    assay_status (*fill)(void *user, const char *phase, uint64_t before, uint64_t total,
                         size_t count, const assay_cached_point *points, uint32_t *limits_out);
    /* NULL, or called when fill was given all points of a sweep (the centres of all pixels, or one
     * sample of each), before any of them is evaluated; the limits are then of no use. */
    assay_status (*complete)(void *user, const char *phase, uint64_t before, uint64_t total);
    /* Indirect radiance towards the point's wo, from what had been made within the limit. */
    assay_status (*radiance)(void *user, const assay_cached_point *point, uint32_t limit,
                             assay_random *random, assay_ray_counts *counts, int worker,
                             assay_rgb *radiance_out);
    /* Indirect irradiance on the viewer's side. */
    assay_status (*irradiance)(void *user, const assay_cached_point *point, uint32_t limit,
                               int worker, assay_rgb *irradiance_out);
    /* A picture instead of the colour, or NULL: of the point, whose colour would be `color`. */
    assay_status (*picture)(void *user, const assay_cached_point *point, uint32_t limit, int worker,
                            assay_rgb color, assay_rgb *picture_out);
} assay_cached_light;

typedef struct {
    assay_path_settings path; /* bounces, estimator, roulette */
    uint32_t            spp;
    assay_pixel_order   order;   /* of the pixels' centres        */
    int                 passes;  /* 1: evaluated as the caches grow; 2: when they are complete */
    bool                centres; /* fill and complete are given the centres alone              */
} assay_cached_image_settings;

/* Errors: MEMORY, DOMAIN, CANCELLED, and those of the caches. */
assay_status assay_cached_image_render(const assay_frame                 *frame,
                                       const assay_cached_image_settings *settings,
                                       const assay_cached_light *light, assay_film *film,
                                       assay_ray_counts *counts);

#endif
