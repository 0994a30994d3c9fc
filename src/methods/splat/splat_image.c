/* splat_image.c - a sweep's points into the G-buffer, and the buffers' means out of it.
 *
 * Invariant: between the end of a sweep's filling and the beginning of the next one's, the buffers
 * hold the light at that sweep's points, so a point is found by its pixel. */
#include "methods/splat/splat_image.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "methods/splat/splat_dump.h"

static size_t pixels_of(const splat_image *image)
{
    return (size_t)image->frame->width * (size_t)image->frame->height;
}

/* ---- room ---- */

static assay_status open_glossy(splat_image *image)
{
    assay_radiance_cache *radiance = image->caches->radiance;
    assay_status          status =
        splat_layer_open(image->context, image->frame->width, image->frame->height,
                         assay_radiance_cache_records(radiance), &image->glossy);
    status                    = status ? status
                                       : splat_gloss_create(image->context, pixels_of(image), radiance, &image->gloss);
    image->glossy.source.say  = splat_gloss_say;
    image->glossy.source.user = image->gloss;
    return status;
}

assay_status splat_image_open(splat_image *image)
{
    image->count           = 0;
    image->begun           = false;
    image->dumped          = false;
    image->lost            = 0;
    assay_context *context = image->context;
    const size_t   pixels  = pixels_of(image);
    assay_status   status  = splat_layer_open(context, image->frame->width, image->frame->height,
                                              image->caches->irradiance, &image->diffuse);
    if (status == ASSAY_OK && image->caches->radiance) {
        status = open_glossy(image);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    image->points  = assay_allocate(context, pixels, sizeof *image->points);
    image->lambert = assay_allocate(context, pixels, sizeof *image->lambert);
    image->order   = assay_allocate(context, pixels, sizeof *image->order);
    image->unreached =
        assay_allocate(context, (size_t)assay_context_threads(context), sizeof *image->unreached);
    return image->points && image->lambert && image->order && image->unreached
               ? ASSAY_OK
               : assay_fail_memory(context, "a G-buffer");
}

void splat_image_close(splat_image *image)
{
    if (image->context) {
        splat_layer_close(image->context, &image->diffuse);
        splat_layer_close(image->context, &image->glossy);
        splat_gloss_destroy(image->gloss);
        assay_release(image->context, image->points);
        assay_release(image->context, image->lambert);
        assay_release(image->context, image->order);
        assay_release(image->context, image->unreached);
    }
    image->gloss     = NULL;
    image->points    = NULL;
    image->lambert   = NULL;
    image->order     = NULL;
    image->unreached = NULL;
}

/* ---- the G-buffer ---- */

static const assay_material_grids *grids_at(const splat_image        *image,
                                            const assay_cached_point *point)
{
    return image->gloss && point->hit ? glossy_materials_at(image->materials, &point->vertex)
                                      : NULL;
}

static void begin_sweep(splat_image *image)
{
    assay_splat_buffer_look(image->diffuse.buffer, image->frame->camera);
    if (image->gloss) {
        assay_splat_buffer_look(image->glossy.buffer, image->frame->camera);
        splat_gloss_begin(image->gloss);
    }
    image->count = 0;
    image->begun = true;
}

static void set_point(splat_image *image, const assay_cached_point *point,
                      const assay_cache_point *asked)
{
    const size_t                pixel = point->pixel;
    const assay_material_grids *grids = grids_at(image, point);
    image->points[pixel]              = *asked;
    image->lambert[pixel] = point->hit ? assay_cached_point_lambert(point) : rgb_grey(0.0);
    if (asked->wanted) {
        assay_splat_buffer_set(image->diffuse.buffer, pixel, asked->site.position,
                               asked->site.frame.z);
    }
    if (grids) {
        const assay_frame3 frame = assay_material_frame(&point->vertex);
        assay_splat_buffer_set(image->glossy.buffer, pixel, point->vertex.surface.position,
                               frame.z);
        splat_gloss_set(image->gloss, pixel, grids, &point->vertex);
    }
}

static assay_status fill(void *user, const char *phase, uint64_t before, uint64_t total,
                         size_t count, const assay_cached_point *points, uint32_t *limits_out)
{
    splat_image       *image  = user;
    const assay_status status = assay_cache_session_ask(image->session, count, points);
    (void)phase;
    (void)before;
    (void)total;
    if (status != ASSAY_OK) {
        return status;
    }
    if (!image->begun) {
        begin_sweep(image);
    }
    for (size_t i = 0; i < count; i++) {
        set_point(image, &points[i], &image->session->points[i]);
        image->order[image->count++] = (uint32_t)points[i].pixel;
        limits_out[i]                = UINT32_MAX;
    }
    return ASSAY_OK;
}

static assay_status fill_layer(splat_image *image, splat_layer *layer, const splat_order *order,
                               const char *name)
{
    splat_dump           dump     = {0};
    const splat_listener listener = {splat_dump_tell, &dump};
    const bool           dumps    = image->frame->dump && !image->dumped;
    assay_status         status   = ASSAY_OK;
    if (dumps) {
        status = splat_dump_begin(image, layer, name, &dump);
    }
    status =
        status ? status : splat_layer_fill(layer, &image->rules, order, dumps ? &listener : NULL);
    image->lost += assay_splat_lost(layer->buffer);
    if (dumps) {
        status = status ? status : splat_dump_finish(&dump);
        splat_dump_release(&dump);
    }
    return status;
}

static assay_status complete(void *user, const char *phase, uint64_t before, uint64_t total)
{
    splat_image      *image  = user;
    const splat_order order  = {.pixels = image->order,
                                .count  = image->count,
                                .points = image->points,
                                .phase  = phase,
                                .before = before,
                                .total  = total};
    assay_status      status = fill_layer(image, &image->diffuse, &order, "splat");
    if (status == ASSAY_OK && image->gloss) {
        status = fill_layer(image, &image->glossy, &order, "splat_glossy");
    }
    image->begun  = false;
    image->dumped = true;
    return status;
}

/* ---- light ---- */

static assay_status irradiance_at(const splat_image *image, size_t pixel, int worker,
                                  assay_rgb *irradiance_out)
{
    const assay_gather_site *site = &image->points[pixel].site;
    if (assay_splat_weight(image->diffuse.buffer, pixel) > 0.0) {
        *irradiance_out = assay_splat_mean(image->diffuse.buffer, pixel);
        return ASSAY_OK;
    }
    image->unreached[worker]++;
    if (image->uncovered == SPLAT_NEAREST && image->points[pixel].wanted) {
        return assay_irradiance_cache_look_up(image->caches->irradiance, site->position,
                                              site->frame.z, UINT32_MAX, worker, irradiance_out);
    }
    *irradiance_out = rgb_grey(0.0);
    return ASSAY_OK;
}

static assay_status irradiance(void *user, const assay_cached_point *point, uint32_t limit,
                               int worker, assay_rgb *irradiance_out)
{
    (void)limit;
    return irradiance_at(user, point->pixel, worker, irradiance_out);
}

/* The normalised splat buffers; *found_out: glossy light is among it. */
static assay_status splatted(const splat_image *image, const assay_cached_point *point, int worker,
                             assay_rgb *radiance_out, bool *found_out)
{
    const size_t    pixel   = point->pixel;
    const bool      found   = image->gloss && assay_splat_weight(image->glossy.buffer, pixel) > 0.0;
    const assay_rgb lambert = image->lambert[pixel];
    const assay_rgb gloss   = found ? assay_splat_mean(image->glossy.buffer, pixel) : rgb_grey(0.0);
    assay_rgb       e       = rgb_grey(0.0);
    const assay_status status =
        rgb_is_black(lambert) ? ASSAY_OK : irradiance_at(image, pixel, worker, &e);
    if (status == ASSAY_OK) {
        *radiance_out = assay_cached_point_sum(lambert, e, found ? &gloss : NULL,
                                               image->diffuse.source.rules.clamp_negative);
        *found_out    = found;
    }
    return status;
}

static assay_status radiance(void *user, const assay_cached_point *point, uint32_t limit,
                             assay_random *random, assay_ray_counts *counts, int worker,
                             assay_rgb *radiance_out)
{
    const splat_image *image  = user;
    assay_rgb          sum    = rgb_grey(0.0);
    bool               found  = false;
    const assay_status status = splatted(image, point, worker, &sum, &found);
    (void)limit;
    if (status != ASSAY_OK) {
        return status;
    }
    if (!found) {
        sum = rgb_add(
            sum, assay_cached_point_rest(image->frame->world, image->path, point, random, counts));
    }
    *radiance_out = sum;
    return ASSAY_OK;
}

/* Records and weights are those of the caches; the error is that of what was splatted. */
static assay_status picture(void *user, const assay_cached_point *point, uint32_t limit, int worker,
                            assay_rgb color, assay_rgb *picture_out)
{
    const splat_image       *image  = user;
    const assay_cache_debug *debug  = &image->session->debug;
    const bool               glossy = grids_at(image, point) != NULL;
    assay_rgb                light  = rgb_grey(0.0);
    bool                     found  = false;
    if (debug->kind != ASSAY_CACHE_DEBUG_ERROR || !point->hit) {
        return assay_cache_debug_paint(debug, glossy ? image->glossy.cache : image->diffuse.cache,
                                       point, limit, worker, color, picture_out);
    }
    const assay_status status = glossy ? splatted(image, point, worker, &light, &found)
                                       : irradiance_at(image, point->pixel, worker, &light);
    if (status == ASSAY_OK) {
        *picture_out = assay_cache_debug_error(glossy ? &debug->radiance : &debug->irradiance,
                                               point->pixel, light.g);
    }
    return status;
}

assay_cached_light splat_image_light(splat_image *image)
{
    return (assay_cached_light){
        .user       = image,
        .fill       = fill,
        .complete   = complete,
        .radiance   = radiance,
        .irradiance = irradiance,
        .picture    = image->session->debug_kind == ASSAY_CACHE_DEBUG_OFF ? NULL : picture,
    };
}

uint64_t splat_image_unreached(const splat_image *image)
{
    uint64_t sum = 0;
    for (int i = 0; i < assay_context_threads(image->context); i++) {
        sum += image->unreached[i];
    }
    return sum;
}
