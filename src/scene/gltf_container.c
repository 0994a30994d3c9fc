/* gltf_container.c - .gltf or .glb.
 *
 * Invariant: text and chunk lie inside of the bytes that were given.  Lengths are read in 64 bits,
 * so a lie cannot wrap around. */
#include <string.h>

#include "scene/gltf_loader.h"

enum { HEADER_BYTES = 12, CHUNK_HEADER_BYTES = 8 };

static const uint32_t chunk_json = 0x4E4F534A, chunk_binary = 0x004E4942;

static uint32_t read_u32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

/* One chunk from `at`; *at_end is where the next one starts. */
static assay_status take_chunk(assay_gltf_loader *loader, const uint8_t *bytes, uint64_t at,
                               uint64_t total, uint64_t *at_end)
{
    if (at + CHUNK_HEADER_BYTES > total) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "GLB: the chunk at byte %llu has no room for its header",
                               (unsigned long long)at);
    }
    const uint64_t length = read_u32(bytes + at);
    const uint32_t type   = read_u32(bytes + at + 4);
    const uint64_t start  = at + CHUNK_HEADER_BYTES;
    const bool     first  = at == HEADER_BYTES;
    if (length > total - start) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "GLB: the chunk at byte %llu claims %llu bytes, %llu are left",
                               (unsigned long long)at, (unsigned long long)length,
                               (unsigned long long)(total - start));
    }
    if (first != (type == chunk_json)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "GLB: the first chunk, and only that, must be JSON");
    }
    if (first) {
        loader->text       = (const char *)bytes + start;
        loader->text_count = (size_t)length;
    } else if (type == chunk_binary && !loader->chunk) {
        loader->chunk       = bytes + start;
        loader->chunk_count = (size_t)length;
    }
    *at_end = start + length;
    return ASSAY_OK;
}

static assay_status split_binary(assay_gltf_loader *loader, const uint8_t *bytes, uint64_t count)
{
    const uint32_t version = count >= HEADER_BYTES ? read_u32(bytes + 4) : 0;
    const uint64_t total   = count >= HEADER_BYTES ? read_u32(bytes + 8) : 0;
    if (count < HEADER_BYTES) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "GLB: the header is cut short");
    }
    if (version != 2) {
        return assay_gltf_fail(loader, ASSAY_ERR_UNSUPPORTED,
                               "GLB: version %u is not supported, only 2 is", version);
    }
    if (total > count || total < HEADER_BYTES) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "GLB: the header claims %llu bytes, the file has %llu",
                               (unsigned long long)total, (unsigned long long)count);
    }
    if (total < count) {
        assay_scene_warn(loader->scene, "GLB: %llu bytes after its end are ignored",
                         (unsigned long long)(count - total));
    }
    uint64_t at = HEADER_BYTES;
    do {
        const assay_status status = take_chunk(loader, bytes, at, total, &at);
        if (status != ASSAY_OK) {
            return status;
        }
    } while (at < total);
    return ASSAY_OK;
}

assay_status assay_gltf_split(assay_gltf_loader *loader, const uint8_t *bytes, size_t count)
{
    if (count >= 4 && memcmp(bytes, "glTF", 4) == 0) {
        const assay_status status = split_binary(loader, bytes, count);
        /* Some writers pad with NUL instead of spaces. */
        while (loader->text_count && loader->text[loader->text_count - 1] == 0) {
            loader->text_count--;
        }
        return status;
    }
    loader->text       = (const char *)bytes;
    loader->text_count = count;
    return ASSAY_OK;
}
