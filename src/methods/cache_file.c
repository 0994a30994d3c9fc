/* cache_file.c - a cache is believed where its light would come out the same. */
#include "methods/cache_file.h"

#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "io/bundle_read.h"
#include "record/record_bundle.h"

/* What the records' light depends on. */
enum { KEY_COUNT = 6, TEXT_SIZE = 80 };

static const char *const KEYS[KEY_COUNT] = {"content", "scene.digest", "scene.time",
                                            "bounces", "secondary",    "gather"};

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

static void describe(const assay_frame *frame, const assay_irradiance_cache_settings *settings,
                     char values[KEY_COUNT][TEXT_SIZE])
{
    static const char *const secondary[] = {"direct", "path", "cache"};
    const assay_scene       *scene       = frame->world->scene;
    snprintf(values[0], TEXT_SIZE, "irradiance records");
    snprintf(values[1], TEXT_SIZE, "%s", scene->digest);
    snprintf(values[2], TEXT_SIZE, "%.17g", scene->time);
    if (settings->path.bounces == ASSAY_BOUNCES_INF) {
        snprintf(values[3], TEXT_SIZE, "inf");
    } else {
        snprintf(values[3], TEXT_SIZE, "%d", settings->path.bounces);
    }
    snprintf(values[4], TEXT_SIZE, "%s", secondary[settings->secondary]);
    describe_gathering(settings, values[5]);
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
                                  assay_irradiance_cache *cache)
{
    assay_status status = ASSAY_OK;
    for (int level = 0; cache && status == ASSAY_OK; level++) {
        char prefix[TEXT_SIZE];
        prefix_of(level, prefix);
        status =
            assay_record_bundle_add(context, bundle, prefix, assay_irradiance_cache_store(cache));
        cache = assay_irradiance_cache_next(cache);
    }
    return status;
}

assay_status assay_cache_file_create(const assay_frame                     *frame,
                                     const assay_irradiance_cache_settings *settings,
                                     const char *path, assay_bundle **bundle_out)
{
    char          values[KEY_COUNT][TEXT_SIZE];
    assay_bundle *bundle = NULL;
    assay_status  status = assay_bundle_create(frame->context, path, &bundle);
    describe(frame, settings, values);
    for (int i = 0; i < KEY_COUNT && status == ASSAY_OK; i++) {
        status = assay_bundle_describe(bundle, KEYS[i], values[i]);
    }
    if (status != ASSAY_OK) {
        assay_bundle_destroy(bundle);
        return status;
    }
    *bundle_out = bundle;
    return ASSAY_OK;
}

static assay_status check(const assay_frame *frame, const assay_irradiance_cache_settings *settings,
                          const assay_bundle_reader *reader)
{
    char values[KEY_COUNT][TEXT_SIZE];
    describe(frame, settings, values);
    for (int i = 0; i < KEY_COUNT; i++) {
        const char *saved = assay_bundle_text(reader, KEYS[i]);
        if (!saved || strcmp(saved, values[i]) != 0) {
            return assay_fail(frame->context, ASSAY_ERR_ARGUMENT,
                              "%s: a cache for other light: its '%s' is '%.70s', not '%s'",
                              assay_bundle_path(reader), KEYS[i], saved ? saved : "missing",
                              values[i]);
        }
    }
    return ASSAY_OK;
}

assay_status assay_cache_file_read(const assay_frame                     *frame,
                                   const assay_irradiance_cache_settings *settings,
                                   const char *path, assay_irradiance_cache *cache)
{
    assay_bundle_reader *reader = NULL;
    assay_status         status = assay_bundle_open(frame->context, path, &reader);
    status                      = status ? status : check(frame, settings, reader);
    for (int level = 0; cache && status == ASSAY_OK; level++) {
        char prefix[TEXT_SIZE];
        prefix_of(level, prefix);
        /* A cache of fewer levels leaves the lower ones to be filled. */
        if (level == 0 || assay_record_bundle_is_there(reader, prefix)) {
            status = assay_record_bundle_read(frame->context, reader, prefix,
                                              assay_irradiance_cache_store(cache));
        }
        cache = assay_irradiance_cache_next(cache);
    }
    assay_bundle_close(reader);
    return status;
}
