/* report_source.c - Invariant: a source that was read has float channels R, G and B, and its
 * metadata are attributes of its image, also where they come from a bundle's manifest.
 *
 * Only the channels that a report shows are read of an EXR file: all layers of a render are four to
 * eight times as much. */
#include "oracle/report/report_source.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/image_decode.h"
#include "io/read_file.h"
#include "oracle/metrics/sample_counts.h"
#include "scene/scene_text.h"

enum { STATS_LIMIT = 1 << 20 };

static const char *const WANTED[] = {"R",          "G",          "B",           "Variance.R",
                                     "Variance.G", "Variance.B", "SampleCount", NULL};

/* Where the arrays of a bundle go. */
static const struct {
    const char        *array, *channels;
    const char *const *names; /* of the image */
    bool               needed;
} PARTS[] = {{"radiance/total", "R G B", WANTED, true},
             {"radiance/total_variance", "R G B", WANTED + 3, false},
             {"radiance/samples", "SampleCount", WANTED + 6, false}};

bool assay_report_is_bundle(const char *path)
{
    struct stat info;
    char        manifest[ASSAY_REPORT_PATH_SIZE + 16];
    snprintf(manifest, sizeof manifest, "%.4095s/manifest.json", path);
    return stat(manifest, &info) == 0;
}

void assay_report_name_of(const char *path, char name_out[ASSAY_REPORT_NAME_SIZE])
{
    char copy[ASSAY_REPORT_PATH_SIZE];
    snprintf(copy, sizeof copy, "%s", path);
    size_t length = strlen(copy);
    while (length > 1 && copy[length - 1] == '/') {
        copy[--length] = '\0';
    }
    char *last = strrchr(copy, '/');
    last       = last && last[1] ? last + 1 : copy;
    char *dot  = strrchr(last, '.');
    if (dot && dot > last && (strcmp(dot, ".exr") == 0 || strcmp(dot, ".hdr") == 0)) {
        *dot = '\0';
    }
    assay_text_clean(last, name_out, ASSAY_REPORT_NAME_SIZE);
}

static assay_status read_image(assay_context *context, assay_report_source *source)
{
    uint8_t     *bytes  = NULL;
    size_t       count  = 0;
    assay_status status = assay_read_file(context, source->path, (uint64_t)1 << 32, &bytes, &count);
    if (status == ASSAY_OK) {
        status = assay_image_decode(context, bytes, count, source->path, WANTED, &source->image);
    }
    assay_release(context, bytes);
    return status;
}

/* The size that the manifest gives the image. */
static assay_status make_image(assay_context *context, assay_report_source *source)
{
    assay_bundle_entry entry;
    const assay_status status = assay_bundle_entry_of(source->bundle, PARTS[0].array, &entry);
    if (status != ASSAY_OK) {
        return status;
    }
    if (!entry.image || entry.dimensions < 2 || entry.shape[0] > ASSAY_IMAGE_MAX_SIDE ||
        entry.shape[1] > ASSAY_IMAGE_MAX_SIDE) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: bundle: '%s' is no image", source->path,
                          PARTS[0].array);
    }
    return assay_image_create(context, (int)entry.shape[1], (int)entry.shape[0], &source->image);
}

static assay_status add_channel(assay_image *image, const char *name, const assay_array *table,
                                size_t column)
{
    const bool         whole = strcmp(name, "SampleCount") == 0;
    const size_t       rows = assay_array_rows(table), columns = assay_array_columns(table);
    const double      *values = assay_array_values(table);
    assay_channel      channel;
    const assay_status status = assay_image_add_channel(
        image, name, whole ? ASSAY_CHANNEL_UINT : ASSAY_CHANNEL_FLOAT, &channel);
    for (size_t i = 0; status == ASSAY_OK && i < rows; i++) {
        const double value = values[i * columns + column];
        if (whole) {
            channel.data.u32[i] = value > 0.0 && value < 4294967296.0 ? (uint32_t)value : 0;
        } else {
            channel.data.f32[i] = (float)value;
        }
    }
    return status;
}

static assay_status add_part(assay_context *context, assay_report_source *source, size_t part)
{
    assay_array *table = NULL;
    assay_status status =
        assay_bundle_read_array(source->bundle, PARTS[part].array, PARTS[part].channels, &table);
    const size_t pixels =
        (size_t)assay_image_width(source->image) * (size_t)assay_image_height(source->image);
    if (status == ASSAY_OK && assay_array_rows(table) != pixels) {
        status = assay_fail(context, ASSAY_ERR_FORMAT, "%s: bundle: '%s' is of another size",
                            source->path, PARTS[part].array);
    }
    for (size_t c = 0; status == ASSAY_OK && c < assay_array_columns(table); c++) {
        status = add_channel(source->image, PARTS[part].names[c], table, c);
    }
    assay_array_destroy(table);
    return status;
}

static assay_status read_bundle(assay_context *context, assay_report_source *source)
{
    assay_status status = assay_bundle_open(context, source->path, &source->bundle);
    status              = status ? status : make_image(context, source);
    for (size_t i = 0; status == ASSAY_OK && i < sizeof PARTS / sizeof PARTS[0]; i++) {
        if (PARTS[i].needed || assay_bundle_has(source->bundle, PARTS[i].array)) {
            status = add_part(context, source, i);
        }
    }
    const int texts = status == ASSAY_OK ? assay_bundle_text_count(source->bundle) : 0;
    for (int i = 0; status == ASSAY_OK && i < texts; i++) {
        const char *value;
        const char *key = assay_bundle_text_at(source->bundle, i, &value);
        if (key && value && *key && strlen(key) < ASSAY_REPORT_NAME_SIZE) {
            status = assay_image_set_attribute(source->image, key, value);
        }
    }
    return status;
}

static assay_status check_channels(assay_context *context, const assay_report_source *source)
{
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        if (!assay_image_find_channel(source->image, WANTED[c], &channel) ||
            channel.type != ASSAY_CHANNEL_FLOAT) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "%s: the image has no channels R, G and B of floats", source->path);
        }
    }
    return ASSAY_OK;
}

/* NAME.json beside NAME.exr or the folder NAME, where it is what `assay render --stats` writes; any
 * other file of that name is somebody else's. */
static void read_stats(assay_context *context, assay_report_source *source)
{
    char path[ASSAY_REPORT_PATH_SIZE + 8];
    snprintf(path, sizeof path, "%s", source->path);
    size_t length = strlen(path);
    while (length > 1 && path[length - 1] == '/') {
        path[--length] = '\0';
    }
    char *dot = strrchr(path, '.');
    snprintf(dot && strcmp(dot, ".exr") == 0 ? dot : path + length, 8, ".json");
    struct stat info;
    uint8_t    *bytes = NULL;
    size_t      count = 0;
    if (stat(path, &info) != 0 ||
        assay_read_file(context, path, STATS_LIMIT, &bytes, &count) != ASSAY_OK) {
        return;
    }
    source->stats = cJSON_ParseWithLength((const char *)bytes, count);
    assay_release(context, bytes);
    if (!cJSON_IsObject(cJSON_GetObjectItemCaseSensitive(source->stats, "seconds")) ||
        !cJSON_IsString(cJSON_GetObjectItemCaseSensitive(source->stats, "method"))) {
        cJSON_Delete(source->stats);
        source->stats = NULL;
    }
}

assay_status assay_report_source_read(assay_context *context, const char *path,
                                      assay_report_source *source_out)
{
    assay_report_source source = {.image = NULL};
    if (snprintf(source.path, sizeof source.path, "%s", path) >= (int)sizeof source.path) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "%.64s...: the name is too long", path);
    }
    assay_report_name_of(path, source.name);
    snprintf(source.label, sizeof source.label, "%s", source.name);
    assay_status status =
        assay_report_is_bundle(path) ? read_bundle(context, &source) : read_image(context, &source);
    status = status ? status : check_channels(context, &source);
    if (status != ASSAY_OK) {
        assay_report_source_release(&source);
        return status;
    }
    read_stats(context, &source);
    *source_out = source;
    return ASSAY_OK;
}

void assay_report_source_release(assay_report_source *source)
{
    assay_image_destroy(source->image);
    assay_bundle_close(source->bundle);
    cJSON_Delete(source->stats);
    memset(source, 0, sizeof *source);
}

const char *assay_report_source_method(const assay_report_source *source)
{
    return assay_image_get_attribute(source->image, "assay:method");
}

double assay_report_source_samples(const assay_report_source *source)
{
    const uint32_t *samples = assay_sample_counts(source->image, "R");
    const size_t    pixels =
        (size_t)assay_image_width(source->image) * (size_t)assay_image_height(source->image);
    double sum = 0.0;
    for (size_t i = 0; samples && i < pixels; i++) {
        sum += samples[i];
    }
    return sum / (double)pixels;
}

double assay_report_source_stat(const assay_report_source *source, const char *name,
                                const char *inside)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(source->stats, name);
    item              = inside ? cJSON_GetObjectItemCaseSensitive(item, inside) : item;
    return cJSON_IsNumber(item) ? item->valuedouble : (double)NAN;
}
