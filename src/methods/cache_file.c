/* cache_file.c - a cache is believed where its light would come out the same. */
#include "methods/cache_file.h"

#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "io/bundle_read.h"
#include "record/radiance_bundle.h"
#include "record/record_bundle.h"
#include "scene/scene_moment.h"

/* What the records' light depends on; the last two of radiance records alone. */
enum { KEY_COUNT = 8, IRRADIANCE_KEYS = 6, TEXT_SIZE = 80 };

static const char *const KEYS[KEY_COUNT] = {"content", "scene.digest",        "scene.moment",
                                            "bounces", "secondary",           "gather",
                                            "order",   "coefficient_gradient"};

/* A plane's view and shadow maps leave their mark; the number of cells is a matter of noise. */
static void describe_gathering(const assay_irradiance_cache_settings *settings,
                               char                                   text[TEXT_SIZE])
{
    static const char *const missing[] = {"plane", "ratio", "border", "border-corrected"};
    const char              *shadow    = settings->shadow == ASSAY_SHADOW_MAP ? " shadow=map" : "";
    if (settings->layout.strata == ASSAY_STRATA_PLANE) {
        snprintf(text, TEXT_SIZE, "raster %.17g %s%s", settings->layout.fov,
                 missing[settings->layout.missing], shadow);
    } else {
        snprintf(text, TEXT_SIZE, "rays%s", shadow);
    }
}

static const char RADIANCE_PREFIX[] = "radiance_records";

typedef struct {
    int  count;
    char values[KEY_COUNT][TEXT_SIZE];
} description;

static description describe(const assay_frame *frame, const assay_cache_set *caches)
{
    static const char *const secondary[] = {"direct", "path", "cache"};
    static const char *const gradient[]  = {"none", "points", "walls"};
    const assay_scene       *scene       = frame->world->scene;
    const int                bounces     = caches->settings->path.bounces;
    description              d           = {.count = caches->glossy ? KEY_COUNT : IRRADIANCE_KEYS};
    snprintf(d.values[0], TEXT_SIZE,
             caches->glossy ? "irradiance and radiance records" : "irradiance records");
    snprintf(d.values[1], TEXT_SIZE, "%s", scene->digest);
    assay_scene_moment(scene, d.values[2]);
    snprintf(d.values[3], TEXT_SIZE, bounces == ASSAY_BOUNCES_INF ? "inf" : "%d", bounces);
    snprintf(d.values[4], TEXT_SIZE, "%s", secondary[caches->settings->secondary]);
    describe_gathering(caches->settings, d.values[5]);
    if (caches->glossy) {
        snprintf(d.values[6], TEXT_SIZE, "%d", caches->glossy->order);
        snprintf(d.values[7], TEXT_SIZE, "%s", gradient[caches->glossy->gradient]);
    }
    return d;
}

static void prefix_of(int level, char prefix[TEXT_SIZE])
{
    if (level == 0) {
        snprintf(prefix, TEXT_SIZE, "records");
    } else {
        snprintf(prefix, TEXT_SIZE, "records.%d", level);
    }
}

assay_status assay_cache_file_add(assay_context *context, assay_bundle *bundle,
                                  const assay_cache_set *caches)
{
    assay_irradiance_cache *cache  = caches->irradiance;
    assay_status            status = ASSAY_OK;
    for (int level = 0; cache && status == ASSAY_OK; level++) {
        char prefix[TEXT_SIZE];
        prefix_of(level, prefix);
        status =
            assay_record_bundle_add(context, bundle, prefix, assay_irradiance_cache_store(cache));
        cache = assay_irradiance_cache_next(cache);
    }
    return status || !caches->radiance
               ? status
               : assay_radiance_bundle_add(context, bundle, RADIANCE_PREFIX, caches->radiance);
}

assay_status assay_cache_file_finish(const assay_frame *frame, const assay_cache_set *caches,
                                     assay_bundle *bundle)
{
    const description d      = describe(frame, caches);
    assay_status      status = ASSAY_OK;
    for (int i = 0; i < d.count && status == ASSAY_OK; i++) {
        status = assay_bundle_describe(bundle, KEYS[i], d.values[i]);
    }
    status = status ? status : assay_cache_file_add(frame->context, bundle, caches);
    return status ? status : assay_bundle_finish(bundle);
}

static assay_status check(const assay_frame *frame, const assay_cache_set *caches,
                          const assay_bundle_reader *reader)
{
    const description d = describe(frame, caches);
    for (int i = 0; i < d.count; i++) {
        const char *saved = assay_bundle_text(reader, KEYS[i]);
        if (!saved || strcmp(saved, d.values[i]) != 0) {
            return assay_fail(frame->context, ASSAY_ERR_ARGUMENT,
                              "%s: a cache for other light: its '%s' is '%.70s', not '%s'",
                              assay_bundle_path(reader), KEYS[i], saved ? saved : "missing",
                              d.values[i]);
        }
    }
    return ASSAY_OK;
}

static assay_status read_levels(assay_context *context, assay_bundle_reader *reader,
                                assay_irradiance_cache *cache)
{
    assay_status status = ASSAY_OK;
    for (int level = 0; cache && status == ASSAY_OK; level++) {
        char prefix[TEXT_SIZE];
        prefix_of(level, prefix);
        /* A cache of fewer levels leaves the lower ones to be filled. */
        if (level == 0 || assay_record_bundle_is_there(reader, prefix)) {
            status = assay_record_bundle_read(context, reader, prefix, SIZE_MAX,
                                              assay_irradiance_cache_store(cache));
        }
        cache = assay_irradiance_cache_next(cache);
    }
    return status;
}

assay_status assay_cache_file_read(const assay_frame *frame, const assay_cache_set *caches,
                                   const char *path)
{
    assay_bundle_reader *reader = NULL;
    assay_status         status = assay_bundle_open(frame->context, path, &reader);
    status                      = status ? status : check(frame, caches, reader);
    status = status ? status : read_levels(frame->context, reader, caches->irradiance);
    /* With another glossy_accuracy there may have been none. */
    if (status == ASSAY_OK && caches->radiance &&
        assay_record_bundle_is_there(reader, RADIANCE_PREFIX)) {
        status =
            assay_radiance_bundle_read(frame->context, reader, RADIANCE_PREFIX, caches->radiance);
    }
    assay_bundle_close(reader);
    return status;
}
