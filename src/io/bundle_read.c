/* bundle_read.c - the manifest first; an array is read where the manifest's digest is its file's.
 *
 * Invariant: a file's path is made of the folder and of the name that was asked for, never of what
 * the manifest says. */
#include "io/bundle_read.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/hash.h"
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

static const char *listed_digest(const assay_bundle_reader *reader, const char *name)
{
    const cJSON *arrays = cJSON_GetObjectItemCaseSensitive(reader->manifest, "arrays");
    const cJSON *entry  = NULL;
    cJSON_ArrayForEach(entry, arrays)
    {
        const char *listed = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, "name"));
        if (listed && strcmp(listed, name) == 0) {
            return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, "sha256"));
        }
    }
    return NULL;
}

bool assay_bundle_lists(const assay_bundle_reader *reader, const char *name)
{
    return listed_digest(reader, name) != NULL;
}

static assay_status check_digest(assay_bundle_reader *reader, const char *name, const char *path,
                                 const char *listed)
{
    uint8_t           *bytes = NULL;
    size_t             count = 0;
    const assay_status status =
        assay_read_file(reader->context, path, (uint64_t)1 << 40, &bytes, &count);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_hash hash;
    char       digest[65];
    assay_hash_start(&hash);
    assay_hash_add(&hash, bytes, count);
    assay_hash_finish(&hash, digest);
    assay_release(reader->context, bytes);
    if (strcmp(digest, listed) != 0) {
        return assay_fail(reader->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: the file of '%s' is not the one that the manifest lists",
                          reader->folder, name);
    }
    return ASSAY_OK;
}

assay_status assay_bundle_read_table(assay_bundle_reader *reader, const char *name, size_t rows,
                                     size_t columns, assay_array **table_out)
{
    char         path[PATH_SIZE + 128];
    assay_array *table  = NULL;
    const char  *listed = listed_digest(reader, name);
    if (!listed) {
        return assay_fail(reader->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: the manifest lists no array '%s'", reader->folder, name);
    }
    snprintf(path, sizeof path, "%s/%.100s.npy", reader->folder, name);
    assay_status status = check_digest(reader, name, path, listed);
    status              = status ? status : assay_array_read_npy(reader->context, path, &table);
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
