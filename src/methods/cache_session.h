/* cache_session.h - what every caching method does around its caches: begin with saved ones, ask
 * them at the points of an image, draw what they do, dump and save them. */
#ifndef ASSAY_METHODS_CACHE_SESSION_H
#define ASSAY_METHODS_CACHE_SESSION_H

#include "methods/cache_debug.h"
#include "methods/cache_file.h"
#include "methods/cached_image.h"

/* Rows of a parameter table, read by assay_cache_session_create. */
/* clang-format off */
#define ASSAY_CACHE_SESSION_PARAMS                                                                \
    {"cache_in", ASSAY_PARAM_PATH, "", "", 0, 0, NULL,                                            \
     "Folder of a saved cache to begin with, of the same scene and the same light.",              \
     ""},                                                                                         \
    {"cache_out", ASSAY_PARAM_PATH, "", "", 0, 0, NULL,                                           \
     "Folder to make for the cache when the image, or the last of its frames, is done.",                                      \
     ""},                                                                                         \
    {"debug", ASSAY_PARAM_CHOICE, "", "off", 0, 0, "off|records|weights|error",                   \
     "A picture instead of the colour: records and their zones, weights, or the error of what "   \
     "the cache says.",                                                                           \
     "[gautron06] fig. 2.3"},                                                                     \
    {"reference", ASSAY_PARAM_PATH, "", "", 0, 0, NULL,                                           \
     "Image with the layers IrradianceIndirect and Indirect that debug=error compares with.",     \
     ""}
/* clang-format on */

typedef struct {
    assay_context         *context;
    char                  *cache_in, *cache_out, *reference; /* NULL: none                       */
    assay_cache_debug_kind debug_kind;
    assay_cache_debug      debug; /* of this frame                                                */
    assay_bundle          *saved; /* what becomes cache_out; NULL before the first frame and at the
                                     end                                                          */
    assay_cache_point *points;    /* of a wave, by assay_cache_session_ask                      */
    size_t             capacity;
} assay_cache_session;

/* Reads the parameters.  Zeros are a session that may be released.  Errors: MEMORY. */
assay_status assay_cache_session_create(assay_context *context, const assay_params *params,
                                        assay_cache_session *session);
void         assay_cache_session_release(assay_cache_session *session);

/* Before a frame: the reference is read; into caches that are new (frame->frames_before is 0: the
 * method made them, empty) the saved records; the counts of others begin again.  Errors: WRITE
 * (cache_out), those of assay_cache_debug_open and assay_cache_file_read. */
assay_status assay_cache_session_begin(assay_cache_session *session, const assay_frame *frame,
                                       const assay_cache_set *caches);

/* Sets session->points to what an irradiance cache is asked at these points: everywhere at centres,
 * at samples where they show something Lambertian.  Errors: MEMORY. */
assay_status assay_cache_session_ask(assay_cache_session *session, size_t count,
                                     const assay_cached_point *points);

/* The image by assay_cached_image_render, what it cost, and then the caches into the frame's dump
 * and after the last frame into cache_out.  Errors: those of assay_cached_image_render; WRITE. */
assay_status assay_cache_session_render(assay_cache_session *session, const assay_frame *frame,
                                        const assay_cache_set             *caches,
                                        const assay_cached_image_settings *image,
                                        const assay_cached_light *light, assay_film *film,
                                        assay_ray_counts *counts);

#endif
