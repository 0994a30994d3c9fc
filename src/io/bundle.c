/* bundle.c - arrays first, the manifest last, the folder's name at the very end. */
#include "io/bundle.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/hash.h"
#include "core/json.h"
#include "io/read_file.h"

enum { PATH_SIZE = 4096 };

struct assay_bundle {
    assay_context *context;
    char           target[PATH_SIZE], folder[PATH_SIZE]; /* folder: while it is being made */
    cJSON         *manifest, *arrays;
    bool           finished;
};

static assay_status fail_write(assay_bundle *bundle, const char *path)
{
    return assay_fail(bundle->context, ASSAY_ERR_WRITE, "%s: cannot write: %s", path,
                      strerror(errno));
}

static assay_status make_folder(assay_bundle *bundle, const char *path)
{
    struct stat info;
    size_t      length = strlen(path);
    while (length > 1 && path[length - 1] == '/') {
        length--;
    }
    if (length + 8 > PATH_SIZE) {
        errno = ENAMETOOLONG;
        return fail_write(bundle, path);
    }
    snprintf(bundle->target, PATH_SIZE, "%.*s", (int)length, path);
    if (lstat(bundle->target, &info) == 0) {
        return assay_fail(bundle->context, ASSAY_ERR_WRITE,
                          "%s: is there already; a bundle replaces nothing, give another name",
                          path);
    }
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%.*s.XXXXXX", (int)length, path);
    if (!mkdtemp(folder) || chmod(folder, 0755) != 0) {
        return fail_write(bundle, path);
    }
    memcpy(bundle->folder, folder, sizeof folder);
    return ASSAY_OK;
}

assay_status assay_bundle_create(assay_context *context, const char *path,
                                 assay_bundle **bundle_out)
{
    assay_bundle *bundle = assay_allocate(context, 1, sizeof *bundle);
    if (!bundle) {
        return assay_fail_memory(context, "a bundle");
    }
    bundle->context     = context;
    assay_status status = make_folder(bundle, path);
    bundle->manifest    = cJSON_CreateObject();
    const bool complete = bundle->manifest &&
                          cJSON_AddStringToObject(bundle->manifest, "format", "assay-bundle") &&
                          cJSON_AddNumberToObject(bundle->manifest, "version", 1) &&
                          cJSON_AddStringToObject(bundle->manifest, "tool", assay_version()) &&
                          (bundle->arrays = cJSON_AddArrayToObject(bundle->manifest, "arrays"));
    if (status == ASSAY_OK && !complete) {
        status = assay_fail_memory(context, "a bundle's manifest");
    }
    if (status != ASSAY_OK) {
        assay_bundle_destroy(bundle);
        return status;
    }
    *bundle_out = bundle;
    return ASSAY_OK;
}

assay_status assay_bundle_describe(assay_bundle *bundle, const char *key, const char *value)
{
    return cJSON_AddStringToObject(bundle->manifest, key, value)
               ? ASSAY_OK
               : assay_fail_memory(bundle->context, "a bundle's manifest");
}

/* FOLDER/NAME.EXTENSION, with the folders that the name holds. */
static assay_status place(assay_bundle *bundle, const char *name, const char *extension,
                          char path[PATH_SIZE])
{
    if (snprintf(path, PATH_SIZE, "%s/%s.%s", bundle->folder, name, extension) >= PATH_SIZE) {
        errno = ENAMETOOLONG;
        return fail_write(bundle, name);
    }
    for (char *slash = path + strlen(bundle->folder) + 1; (slash = strchr(slash, '/')); slash++) {
        *slash           = '\0';
        const bool there = mkdir(path, 0755) == 0 || errno == EEXIST;
        *slash           = '/';
        if (!there) {
            return fail_write(bundle, path);
        }
    }
    return ASSAY_OK;
}

static assay_status file_digest(assay_bundle *bundle, const char *path, char digest[65])
{
    uint8_t           *bytes = NULL;
    size_t             count = 0;
    const assay_status status =
        assay_read_file(bundle->context, path, (uint64_t)1 << 40, &bytes, &count);
    if (status == ASSAY_OK) {
        assay_hash hash;
        assay_hash_start(&hash);
        assay_hash_add(&hash, bytes, count);
        assay_hash_finish(&hash, digest);
        assay_release(bundle->context, bytes);
    }
    return status;
}

static assay_status list(assay_bundle *bundle, const char *name, const char *unit,
                         const char *dtype, const double shape[3], const char *path)
{
    char         digest[65];
    assay_status status = file_digest(bundle, path, digest);
    if (status != ASSAY_OK) {
        return status;
    }
    cJSON *entry    = assay_json_append_object(bundle->arrays);
    cJSON *sizes    = NULL;
    bool   complete = entry && cJSON_AddStringToObject(entry, "name", name) &&
                    cJSON_AddStringToObject(entry, "file", path + strlen(bundle->folder) + 1) &&
                    cJSON_AddStringToObject(entry, "unit", unit) &&
                    cJSON_AddStringToObject(entry, "dtype", dtype) &&
                    (sizes = cJSON_AddArrayToObject(entry, "shape")) &&
                    cJSON_AddStringToObject(entry, "sha256", digest);
    for (int i = 0; i < 3 && shape[i] > 0.0 && complete; i++) {
        complete = cJSON_AddItemToArray(sizes, cJSON_CreateNumber(shape[i]));
    }
    return complete ? ASSAY_OK : assay_fail_memory(bundle->context, "a bundle's manifest");
}

assay_status assay_bundle_add_image(assay_bundle *bundle, const char *name, const char *unit,
                                    const assay_image *image)
{
    char         path[PATH_SIZE];
    assay_status status = place(bundle, name, "exr", path);
    if (status == ASSAY_OK) {
        status = assay_image_write_exr(image, path);
    }
    if (status == ASSAY_OK) {
        const bool   whole    = assay_image_channel_at(image, 0).type == ASSAY_CHANNEL_UINT;
        const double shape[3] = {assay_image_height(image), assay_image_width(image),
                                 assay_image_channel_count(image)};
        status                = list(bundle, name, unit, whole ? "uint32" : "float32", shape, path);
    }
    return status;
}

assay_status assay_bundle_add_table(assay_bundle *bundle, const char *name, const char *unit,
                                    const assay_array *table)
{
    char         path[PATH_SIZE];
    assay_status status = place(bundle, name, "npy", path);
    if (status == ASSAY_OK) {
        status = assay_array_write_npy(table, path);
    }
    if (status == ASSAY_OK) {
        const double shape[3] = {(double)assay_array_rows(table),
                                 (double)assay_array_columns(table), 0.0};
        status                = list(bundle, name, unit, "float64", shape, path);
    }
    return status;
}

assay_status assay_bundle_finish(assay_bundle *bundle)
{
    char  path[PATH_SIZE + 16];
    char *text = cJSON_Print(bundle->manifest);
    if (!text) {
        return assay_fail_memory(bundle->context, "a bundle's manifest");
    }
    snprintf(path, sizeof path, "%s/manifest.json", bundle->folder);
    assay_status status = assay_text_write(bundle->context, path, text);
    cJSON_free(text);
    if (status == ASSAY_OK && rename(bundle->folder, bundle->target) != 0) {
        status = fail_write(bundle, bundle->target);
    }
    bundle->finished = status == ASSAY_OK;
    return status;
}

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    (void)info;
    (void)kind;
    (void)at;
    return remove(path);
}

void assay_bundle_destroy(assay_bundle *bundle)
{
    if (bundle) {
        if (!bundle->finished && bundle->folder[0]) {
            nftw(bundle->folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
        }
        cJSON_Delete(bundle->manifest);
        assay_release(bundle->context, bundle);
    }
}
