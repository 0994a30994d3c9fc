/* film.h - what a render measures in each pixel, and the image it becomes.
 *
 * A pixel belongs to one worker at a time and takes its samples in order, so sums never depend on
 * threads.  Means and variances are kept by Welford's recurrence [welford62]. */
#ifndef ASSAY_IO_FILM_H
#define ASSAY_IO_FILM_H

#include <stdint.h>

#include "assay/image.h"
#include "assay/render.h"
#include "math/vec.h"

/* Groups of layers that can be asked for. */
typedef enum {
    ASSAY_LAYERS_COLOR      = 1, /* R G B, Variance, SampleCount                               */
    ASSAY_LAYERS_GBUFFER    = 2, /* Albedo P N Ns Z UV MaterialId PrimitiveId                  */
    ASSAY_LAYERS_SPLIT      = 4, /* Direct, Indirect                                           */
    ASSAY_LAYERS_IRRADIANCE = 8, /* Irradiance, IrradianceDirect, IrradianceIndirect           */
    ASSAY_LAYERS_ALL        = 15
} assay_layer_set;

/* "color,gbuffer" or "all" (NULL is "all").  Errors: ARGUMENT. */
assay_status assay_layers_parse(assay_context *context, const char *text,
                                assay_layer_set *layers_out);

/* A quantity estimated by samples. */
typedef enum {
    ASSAY_FILM_COLOR,
    ASSAY_FILM_DIRECT,
    ASSAY_FILM_INDIRECT,
    ASSAY_FILM_IRRADIANCE,
    ASSAY_FILM_IRRADIANCE_DIRECT,
    ASSAY_FILM_IRRADIANCE_INDIRECT,
    ASSAY_FILM_COUNT
} assay_film_quantity;

/* The visible point of a pixel: where the ray through its centre ends. */
typedef struct {
    bool       hit; /* false: all below is 0 and the ids are UINT32_MAX        */
    assay_rgb  albedo;
    assay_vec3 position; /* m                                                       */
    assay_vec3 ng, ns;   /* unit, on the viewer's side                              */
    double     z;        /* m along the viewing axis                                */
    double     uv[2];
    uint32_t   material, primitive; /* glTF material; triangle in the flattened scene */
} assay_visible_point;

typedef struct assay_film assay_film;

/* Errors: LIMIT (more pixels than ASSAY_RENDER_MAX_PIXELS), MEMORY. */
assay_status assay_film_create(assay_context *context, int width, int height,
                               assay_layer_set layers, assay_film **film_out);
void         assay_film_destroy(assay_film *film);

/* Bytes of a pixel of a film, and of the image that it becomes. */
uint64_t assay_film_pixel_bytes(assay_layer_set layers);

/* Whether a film of this size, the image that it becomes, and `more` bytes a pixel will find room.
 * Errors: as assay_film_create, with a message that says how much is wanted. */
assay_status assay_film_ask(assay_context *context, int width, int height, assay_layer_set layers,
                            uint64_t more);

/* The largest sample: its square, and so the variance, is a float yet. */
#define ASSAY_FILM_MAX_VALUE 0x1p63

/* Adds a sample to a quantity of a pixel; quantities of layers that were not asked for are dropped.
 * False, and nothing added, where it is not finite or larger than ASSAY_FILM_MAX_VALUE. */
bool assay_film_add(assay_film *film, uint64_t pixel, assay_film_quantity quantity,
                    assay_rgb value);

void assay_film_set_visible(assay_film *film, uint64_t pixel, const assay_visible_point *point);

/* Samples of a pixel's quantity so far. */
uint32_t  assay_film_samples(const assay_film *film, uint64_t pixel, assay_film_quantity quantity);
assay_rgb assay_film_mean(const assay_film *film, uint64_t pixel, assay_film_quantity quantity);
/* Variance of the mean, per channel; 0 with less than two samples. */
assay_rgb assay_film_variance(const assay_film *film, uint64_t pixel, assay_film_quantity quantity);

/* Mean over pixels of the standard error of the pixel's luminance (the channels' errors added as if
 * they were fully correlated: never too small), divided by the mean luminance of the image; 0 for a
 * black image.  NaN where it cannot be known: without the layer group color, or where a pixel has
 * less than two samples. */
double assay_film_relative_error(const assay_film *film);

/* Whether the error that was asked for was reached; NONE until it is set. */
void               assay_film_set_target(assay_film *film, assay_error_target target);
assay_error_target assay_film_target(const assay_film *film);

/* All layers as an image.  Errors: MEMORY. */
assay_status assay_film_develop(const assay_film *film, assay_image **image_out);

#endif
