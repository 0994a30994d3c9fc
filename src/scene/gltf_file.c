/* gltf_file.c - Invariant: only regular files of bounded size are opened, without ever blocking,
 * and every byte that a scene is made from went through the hash. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"
#include "scene/scene_text.h"

void assay_gltf_release_bytes(assay_context *context, assay_gltf_bytes *bytes)
{
    assay_release(context, bytes->owned);
    *bytes = (assay_gltf_bytes){0};
}

/* Against the limit of all files and data URIs together. */
static assay_status count_read(assay_gltf_loader *loader, uint64_t count, const char *name)
{
    if (count > ASSAY_GLTF_MAX_TOTAL_BYTES - loader->bytes_read) {
        return assay_fail(loader->context, ASSAY_ERR_LIMIT,
                          "%s: with it the files of the scene have more than %llu bytes", name,
                          (unsigned long long)ASSAY_GLTF_MAX_TOTAL_BYTES);
    }
    loader->bytes_read += count;
    return ASSAY_OK;
}

/* Of an open file, to `capacity` bytes or its end. */
static assay_status read_all(const assay_gltf_loader *loader, int file, const char *name,
                             uint8_t *bytes, uint64_t capacity, uint64_t *count_out)
{
    uint64_t used = 0;
    while (used < capacity) {
        const ssize_t more = read(file, bytes + used, (size_t)(capacity - used));
        if (more < 0 && errno == EINTR) {
            continue;
        }
        if (more < 0) {
            return assay_fail(loader->context, ASSAY_ERR_NOT_FOUND, "%s: cannot be read: %s", name,
                              strerror(errno));
        }
        if (more == 0) {
            break;
        }
        used += (uint64_t)more;
    }
    *count_out = used;
    return ASSAY_OK;
}

static assay_status read_open_file(assay_gltf_loader *loader, int file, const char *name,
                                   assay_gltf_bytes *out)
{
    struct stat about;
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode)) {
        return assay_fail(loader->context, ASSAY_ERR_NOT_FOUND, "%s: is not a regular file", name);
    }
    const uint64_t size = (uint64_t)about.st_size;
    if (size > ASSAY_GLTF_MAX_FILE_BYTES) {
        return assay_fail(loader->context, ASSAY_ERR_LIMIT,
                          "%s: has %llu bytes, at most %llu are read", name,
                          (unsigned long long)size, (unsigned long long)ASSAY_GLTF_MAX_FILE_BYTES);
    }
    assay_status status = count_read(loader, size, name);
    if (status != ASSAY_OK) {
        return status;
    }
    out->owned = assay_allocate(loader->context, (size_t)size + 1, 1);
    if (!out->owned) {
        return assay_fail_memory(loader->context, "a file of the scene");
    }
    out->bytes = out->owned;
    status     = read_all(loader, file, name, out->owned, size, &out->count);
    if (status == ASSAY_OK && out->count == 0) {
        status = assay_fail(loader->context, ASSAY_ERR_FORMAT, "%s: is empty", name);
    }
    return status;
}

assay_status assay_gltf_read_file(assay_gltf_loader *loader, const char *path, const char *name,
                                  assay_gltf_bytes *bytes_out)
{
    assay_gltf_bytes bytes = {0};
    if (!*path) {
        return assay_fail(loader->context, ASSAY_ERR_NOT_FOUND, "the name of a file is empty");
    }
    const int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) {
        return assay_fail(loader->context, ASSAY_ERR_NOT_FOUND, "%s: cannot be opened: %s", name,
                          strerror(errno));
    }
    const assay_status status = read_open_file(loader, file, name, &bytes);
    close(file);
    if (status != ASSAY_OK) {
        assay_gltf_release_bytes(loader->context, &bytes);
        return status;
    }
    assay_hash_add(&loader->hash, &bytes.count, sizeof bytes.count);
    assay_hash_add(&loader->hash, bytes.bytes, (size_t)bytes.count);
    *bytes_out = bytes;
    return ASSAY_OK;
}

/* ---- data URIs ---- */

/* data:[media type][;base64],content */
static assay_status read_data_uri(assay_gltf_loader *loader, const char *uri, const char *place,
                                  assay_gltf_bytes *out)
{
    const char *comma = strchr(uri, ',');
    if (!comma) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: a data URI without a comma", place);
    }
    const bool         base64 = comma - uri >= 7 && strncmp(comma - 7, ";base64", 7) == 0;
    const assay_status status = count_read(loader, strlen(comma + 1), loader->file);
    if (status != ASSAY_OK) {
        return status;
    }
    char *content = assay_copy_text(loader->context, comma + 1);
    if (!content) {
        return assay_fail_memory(loader->context, "a data URI");
    }
    size_t count = 0;
    assay_gltf_uri_decode(content, &count);
    const bool sound = !base64 || assay_gltf_base64_decode(content, count, &count);
    if (!sound || count == 0) {
        assay_release(loader->context, content);
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: a data URI that %s", place,
                               sound ? "is empty" : "is not base64");
    }
    *out = (assay_gltf_bytes){(const uint8_t *)content, count, content};
    return ASSAY_OK;
}

/* ---- relative URIs ---- */

/* folder/uri with %XX decoded. */
static assay_status make_path(const assay_gltf_loader *loader, const char *uri, const char *place,
                              char *path, size_t size)
{
    const size_t folder_length = strlen(loader->folder);
    const char  *slash         = folder_length ? "/" : "";
    const int    length        = snprintf(path, size, "%s%s%s", loader->folder, slash, uri);
    size_t       decoded       = 0;
    if (length < 0 || (size_t)length >= size) {
        return assay_gltf_fail(loader, ASSAY_ERR_LIMIT, "%s: the path is longer than %zu bytes",
                               place, size - 1);
    }
    if (!assay_gltf_uri_decode(path + folder_length + strlen(slash), &decoded)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: a URI with %%00", place);
    }
    return ASSAY_OK;
}

assay_status assay_gltf_read_uri(assay_gltf_loader *loader, const char *uri, const char *place,
                                 assay_gltf_bytes *bytes_out)
{
    char path[4096], name[512], clean[512];
    if (strncmp(uri, "data:", 5) == 0) {
        return read_data_uri(loader, uri, place, bytes_out);
    }
    if (assay_gltf_uri_has_scheme(uri) || uri[0] == '/' || uri[0] == 0) {
        return assay_gltf_fail(loader, ASSAY_ERR_UNSUPPORTED,
                               "%s: the URI '%.100s' is neither a relative path nor a data URI",
                               place, uri);
    }
    if (!loader->folder) {
        return assay_gltf_fail(loader, ASSAY_ERR_NOT_FOUND,
                               "%s: '%.100s' lies outside of the scene's memory", place, uri);
    }
    const assay_status status = make_path(loader, uri, place, path, sizeof path);
    if (status != ASSAY_OK) {
        return status;
    }
    snprintf(name, sizeof name, "%.200s: %s: %.200s", loader->file, place, path);
    assay_text_clean(name, clean, sizeof clean);
    return assay_gltf_read_file(loader, path, clean, bytes_out);
}
