/* bundle_read.c - the manifest first; an array is read where the manifest's digest is its file's.
 *
 * Invariant: a file's path is made of the folder and of the name that was asked for, never of what
 * the manifest says. */
#include "io/bundle_read.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

#include "assay/image.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/hash.h"
#include "io/array_data.h"
#include "io/npy.h"
#include "io/read_file.h"

enum { PATH_SIZE = 4096, MANIFEST_LIMIT = 16 << 20 };

struct assay_bundle_reader {
    assay_context *context;
    char           folder[PATH_SIZE];
    cJSON         *manifest;
};

static assay_status fail_format(const assay_bundle_reader *reader, const char *what)
{
    return assay_fail(reader->context, ASSAY_ERR_FORMAT, "%s: bundle: %s", reader->folder, what);
}

static assay_status read_manifest(assay_bundle_reader *reader)
{
    char     path[PATH_SIZE + 16];
    uint8_t *bytes = NULL;
    size_t   count = 0;
    snprintf(path, sizeof path, "%s/manifest.json", reader->folder);
    const assay_status status =
        assay_read_file(reader->context, path, MANIFEST_LIMIT, &bytes, &count);
    if (status != ASSAY_OK) {
        return status;
    }
    reader->manifest = cJSON_ParseWithLength((const char *)bytes, count);
    assay_release(reader->context, bytes);
    if (!reader->manifest) {
        return fail_format(reader, "manifest.json is not JSON");
    }
    const char  *format  = assay_bundle_text(reader, "format");
    const cJSON *version = cJSON_GetObjectItemCaseSensitive(reader->manifest, "version");
    if (!format || strcmp(format, "assay-bundle") != 0) {
        return fail_format(reader, "manifest.json is not of a bundle");
    }
    if (!cJSON_IsNumber(version) || version->valuedouble != 1.0) {
        return fail_format(reader, "its version is not 1");
    }
    if (!cJSON_IsArray(cJSON_GetObjectItemCaseSensitive(reader->manifest, "arrays"))) {
        return fail_format(reader, "manifest.json: 'arrays' is not a list");
    }
    return ASSAY_OK;
}

assay_status assay_bundle_open(assay_context *context, const char *path,
                               assay_bundle_reader **reader_out)
{
    assay_bundle_reader *reader = assay_allocate(context, 1, sizeof *reader);
    if (!reader) {
        return assay_fail_memory(context, "a bundle");
    }
    reader->context     = context;
    assay_status status = ASSAY_OK;
    if (snprintf(reader->folder, PATH_SIZE, "%s", path) >= PATH_SIZE) {
        status = assay_fail(context, ASSAY_ERR_NOT_FOUND, "%.64s...: the name is too long", path);
    }
    status = status ? status : read_manifest(reader);
    if (status != ASSAY_OK) {
        assay_bundle_close(reader);
        return status;
    }
    *reader_out = reader;
    return ASSAY_OK;
}

void assay_bundle_close(assay_bundle_reader *reader)
{
    if (reader) {
        cJSON_Delete(reader->manifest);
        assay_release(reader->context, reader);
    }
}

const char *assay_bundle_path(const assay_bundle_reader *reader) { return reader->folder; }

const char *assay_bundle_text(const assay_bundle_reader *reader, const char *key)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(reader->manifest, key));
}

static const cJSON *find_entry(const assay_bundle_reader *reader, const char *name)
{
    const cJSON *arrays = cJSON_GetObjectItemCaseSensitive(reader->manifest, "arrays");
    const cJSON *entry  = NULL;
    cJSON_ArrayForEach(entry, arrays)
    {
        const char *listed = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, "name"));
        if (listed && strcmp(listed, name) == 0) {
            return entry;
        }
    }
    return NULL;
}

static const char *text_of(const cJSON *entry, const char *key)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, key));
}

static const char *listed_digest(const assay_bundle_reader *reader, const char *name)
{
    return text_of(find_entry(reader, name), "sha256");
}

bool assay_bundle_lists(const assay_bundle_reader *reader, const char *name)
{
    return listed_digest(reader, name) != NULL;
}

bool assay_bundle_has(const assay_bundle_reader *reader, const char *name)
{
    return find_entry(reader, name) != NULL;
}

int assay_bundle_text_count(const assay_bundle_reader *reader)
{
    return cJSON_GetArraySize(reader->manifest);
}

const char *assay_bundle_text_at(const assay_bundle_reader *reader, int index,
                                 const char **value_out)
{
    const cJSON *item = cJSON_GetArrayItem(reader->manifest, index);
    *value_out        = cJSON_GetStringValue(item);
    return item->string;
}

/* ---- what the manifest lists ---- */

static bool read_shape(const cJSON *shape, assay_bundle_entry *entry)
{
    const cJSON *size = NULL;
    cJSON_ArrayForEach(size, shape)
    {
        const double n = cJSON_IsNumber(size) ? size->valuedouble : -1.0;
        if (entry->dimensions == 3 || !(n >= 0.0 && n <= 0x1p40) || n != (double)(size_t)n) {
            return false;
        }
        entry->shape[entry->dimensions++] = (size_t)n;
    }
    return entry->dimensions > 0;
}

static bool is_plain(const char *name)
{
    return name && *name && strlen(name) < ASSAY_BUNDLE_NAME && *name != '/' &&
           !strstr(name, "..") && !strchr(name, '\\');
}

int assay_bundle_count(const assay_bundle_reader *reader)
{
    return cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(reader->manifest, "arrays"));
}

static assay_status describe(const assay_bundle_reader *reader, const cJSON *json,
                             assay_bundle_entry *entry_out)
{
    assay_bundle_entry entry = {.name   = text_of(json, "name"),
                                .file   = text_of(json, "file"),
                                .unit   = text_of(json, "unit"),
                                .dtype  = text_of(json, "dtype"),
                                .digest = text_of(json, "sha256")};
    if (!is_plain(entry.name)) {
        fail_format(reader, "manifest.json lists an array without a name of a file");
        return ASSAY_ERR_FORMAT;
    }
    const size_t length = strlen(entry.name);
    const bool   named  = entry.file && strncmp(entry.file, entry.name, length) == 0;
    entry.image         = named && strcmp(entry.file + length, ".exr") == 0;
    const char *what    = !entry.image && !(named && strcmp(entry.file + length, ".npy") == 0)
                              ? "its 'file' is not its name and .npy or .exr"
                          : !entry.unit  ? "it has no 'unit' (\"\" where there is none)"
                          : !entry.dtype ? "it has no 'dtype'"
                          : !read_shape(cJSON_GetObjectItemCaseSensitive(json, "shape"), &entry)
                              ? "its 'shape' is not one to three sizes"
                          : !entry.digest && cJSON_HasObjectItem(json, "sha256")
                              ? "its 'sha256' is not a text"
                              : NULL;
    if (what) {
        assay_fail(reader->context, ASSAY_ERR_FORMAT, "%s: bundle: manifest.json, array '%s': %s",
                   reader->folder, entry.name, what);
        return ASSAY_ERR_FORMAT;
    }
    *entry_out = entry;
    return ASSAY_OK;
}

assay_status assay_bundle_entry_at(const assay_bundle_reader *reader, int index,
                                   assay_bundle_entry *entry_out)
{
    const cJSON *arrays = cJSON_GetObjectItemCaseSensitive(reader->manifest, "arrays");
    return describe(reader, cJSON_GetArrayItem(arrays, index), entry_out);
}

assay_status assay_bundle_entry_of(const assay_bundle_reader *reader, const char *name,
                                   assay_bundle_entry *entry_out)
{
    const cJSON *entry = find_entry(reader, name);
    if (!entry) {
        assay_fail(reader->context, ASSAY_ERR_FORMAT,
                   "%s: bundle: the manifest lists no array '%s'", reader->folder, name);
        return ASSAY_ERR_FORMAT;
    }
    return describe(reader, entry, entry_out);
}

/* ---- arrays ---- */

/* The bytes of an array's file, where their digest is the one that is listed (NULL: none is). */
static assay_status read_bytes(const assay_bundle_reader *reader, const char *name,
                               const char *path, const char *listed, uint8_t **bytes_out,
                               size_t *count_out)
{
    uint8_t     *bytes  = NULL;
    size_t       count  = 0;
    assay_status status = assay_read_file(reader->context, path, (uint64_t)1 << 40, &bytes, &count);
    if (status != ASSAY_OK) {
        return status;
    }
    if (listed) {
        assay_hash hash;
        char       digest[65];
        assay_hash_start(&hash);
        assay_hash_add(&hash, bytes, count);
        assay_hash_finish(&hash, digest);
        if (strcmp(digest, listed) != 0) {
            assay_release(reader->context, bytes);
            return assay_fail(reader->context, ASSAY_ERR_FORMAT,
                              "%s: bundle: the file of '%s' is not the one that the manifest lists",
                              reader->folder, name);
        }
    }
    *bytes_out = bytes;
    *count_out = count;
    return ASSAY_OK;
}

static assay_status read_npy(const assay_bundle_reader *reader, const char *name,
                             const char *listed, assay_array **table_out)
{
    char     path[PATH_SIZE + 128];
    uint8_t *bytes = NULL;
    size_t   count = 0;
    snprintf(path, sizeof path, "%s/%.100s.npy", reader->folder, name);
    assay_status status = read_bytes(reader, name, path, listed, &bytes, &count);
    if (status == ASSAY_OK) {
        status = assay_array_decode_npy(reader->context, bytes, count, path, table_out);
        assay_release(reader->context, bytes);
    }
    return status;
}

assay_status assay_bundle_read_table(assay_bundle_reader *reader, const char *name, size_t rows,
                                     size_t columns, assay_array **table_out)
{
    assay_array *table  = NULL;
    const char  *listed = listed_digest(reader, name);
    if (!listed) {
        return assay_fail(reader->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: the manifest lists no array '%s'", reader->folder, name);
    }
    assay_status status = read_npy(reader, name, listed, &table);
    if (status == ASSAY_OK && (assay_array_columns(table) != columns ||
                               (rows != SIZE_MAX && assay_array_rows(table) != rows))) {
        status =
            assay_fail(reader->context, ASSAY_ERR_FORMAT,
                       "%s: bundle: '%s' is of %zu x %zu numbers, which does not fit the "
                       "other arrays",
                       reader->folder, name, assay_array_rows(table), assay_array_columns(table));
    }
    if (status != ASSAY_OK) {
        assay_array_destroy(table);
        return status;
    }
    *table_out = table;
    return ASSAY_OK;
}

/* ---- arrays of any kind ---- */

static const char *dtype_of(size_t bytes)
{
    return bytes == 8 ? "float64" : bytes == 4 ? "float32" : "float16";
}

static assay_status fail_entry(const assay_bundle_reader *reader, const assay_bundle_entry *entry,
                               const char *what)
{
    return assay_fail(reader->context, ASSAY_ERR_FORMAT,
                      "%s: bundle: the file of '%s' has not the %s that the manifest lists",
                      reader->folder, entry->name, what);
}

static assay_status read_listed_npy(const assay_bundle_reader *reader,
                                    const assay_bundle_entry *entry, assay_array **table_out)
{
    assay_array *table  = NULL;
    assay_status status = read_npy(reader, entry->name, entry->digest, &table);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t columns = entry->dimensions == 1 ? 1 : entry->shape[1];
    if (entry->dimensions > 2 || assay_array_rows(table) != entry->shape[0] ||
        assay_array_columns(table) != columns) {
        status = fail_entry(reader, entry, "shape");
    } else if (strcmp(entry->dtype, dtype_of(table->file_bytes)) != 0) {
        status = fail_entry(reader, entry, "dtype");
    }
    if (status != ASSAY_OK) {
        assay_array_destroy(table);
        return status;
    }
    *table_out = table;
    return ASSAY_OK;
}

static bool find_channel(const assay_image *image, const char *channels, size_t column,
                         assay_channel *channel_out)
{
    char name[ASSAY_BUNDLE_NAME];
    if (!channels) {
        *channel_out = assay_image_channel_at(image, (int)column);
        return true;
    }
    for (; column > 0; column--) {
        channels += strcspn(channels, " ");
        channels += *channels == ' ';
    }
    snprintf(name, sizeof name, "%.*s", (int)strcspn(channels, " "), channels);
    return assay_image_find_channel(image, name, channel_out);
}

/* Channel by channel into the columns of a row a pixel. */
static assay_status take_channels(const assay_bundle_reader *reader,
                                  const assay_bundle_entry *entry, const assay_image *image,
                                  const char *channels, assay_array *table)
{
    const size_t pixels = assay_array_rows(table), columns = assay_array_columns(table);
    for (size_t c = 0; c < columns; c++) {
        assay_channel channel;
        if (!find_channel(image, channels, c, &channel)) {
            return assay_fail(reader->context, ASSAY_ERR_FORMAT,
                              "%s: bundle: the image of '%s' has not the channels %s",
                              reader->folder, entry->name, channels);
        }
        const bool whole = channel.type == ASSAY_CHANNEL_UINT;
        if (strcmp(entry->dtype, whole ? "uint32" : "float32") != 0) {
            return fail_entry(reader, entry, "dtype");
        }
        double *out = assay_array_data(table) + c;
        for (size_t i = 0; i < pixels; i++, out += columns) {
            *out = whole ? (double)channel.data.u32[i] : (double)channel.data.f32[i];
        }
    }
    return ASSAY_OK;
}

static size_t words_in(const char *text)
{
    size_t words = 1;
    for (; *text; text++) {
        words += *text == ' ';
    }
    return words;
}

static assay_status read_listed_image(const assay_bundle_reader *reader,
                                      const assay_bundle_entry *entry, const char *channels,
                                      assay_array **table_out)
{
    char         path[PATH_SIZE + 128];
    uint8_t     *bytes = NULL;
    size_t       count = 0;
    assay_image *image = NULL;
    assay_array *table = NULL;
    snprintf(path, sizeof path, "%s/%.100s.exr", reader->folder, entry->name);
    assay_status status = read_bytes(reader, entry->name, path, entry->digest, &bytes, &count);
    if (status == ASSAY_OK) {
        assay_release(reader->context, bytes);
        status = assay_image_read(reader->context, path, &image);
    }
    if (status == ASSAY_OK) {
        const size_t height = (size_t)assay_image_height(image);
        const size_t width  = (size_t)assay_image_width(image);
        const size_t depth  = (size_t)assay_image_channel_count(image);
        const bool   fits   = entry->dimensions == 3 && entry->shape[0] == height &&
                          entry->shape[1] == width && entry->shape[2] == depth &&
                          (!channels || depth == words_in(channels));
        status = fits ? assay_array_create(reader->context, height * width, depth, &table)
                      : fail_entry(reader, entry, "shape");
    }
    status = status ? status : take_channels(reader, entry, image, channels, table);
    assay_image_destroy(image);
    if (status != ASSAY_OK) {
        assay_array_destroy(table);
        return status;
    }
    *table_out = table;
    return ASSAY_OK;
}

assay_status assay_bundle_read_array(const assay_bundle_reader *reader, const char *name,
                                     const char *channels, assay_array **table_out)
{
    assay_bundle_entry entry  = {.name = NULL};
    const assay_status status = assay_bundle_entry_of(reader, name, &entry);
    if (status != ASSAY_OK) {
        return status;
    }
    return entry.image ? read_listed_image(reader, &entry, channels, table_out)
                       : read_listed_npy(reader, &entry, table_out);
}
