/* gltf_buffer.c - Invariant: a buffer is loaded with exactly the bytes that its byteLength states,
 * and a view's bytes lie inside of its buffer. */
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"

static assay_status load_buffer(assay_gltf_loader *loader, const assay_json *json, uint32_t index)
{
    const uint64_t    length = (uint64_t)assay_json_number(json, "byteLength", 0.0);
    const char       *uri    = assay_json_text(json, "uri", NULL);
    assay_gltf_bytes *buffer = &loader->buffers[index];
    assay_status      status = ASSAY_OK;
    char              place[32];
    snprintf(place, sizeof place, "buffers/%u", index);
    if (uri) {
        status = assay_gltf_read_uri(loader, uri, place, buffer);
    } else if (index == 0 && loader->chunk) {
        buffer->bytes = loader->chunk;
        buffer->count = loader->chunk_count;
    } else {
        status = assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                 "%s: has no uri, and there is no binary chunk for it", place);
    }
    if (status == ASSAY_OK && buffer->count < length) {
        status = assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                 "%s: byteLength is %llu, but there are only %llu bytes", place,
                                 (unsigned long long)length, (unsigned long long)buffer->count);
    }
    buffer->count = length;
    return status;
}

assay_status assay_gltf_load_buffers(assay_gltf_loader *loader)
{
    const assay_json *array = assay_json_member(loader->json.nodes, "buffers");
    const uint32_t    count = array ? array->count : 0;
    loader->buffers         = assay_allocate(loader->context, count, sizeof *loader->buffers);
    if (!loader->buffers) {
        return assay_fail_memory(loader->context, "the scene's buffers");
    }
    loader->buffer_count = count;
    uint32_t index       = 0;
    for (const assay_json *b = array ? array->child : NULL; b; b = b->next, index++) {
        assay_status status = load_buffer(loader, b, index);
        if (status == ASSAY_OK) {
            status = assay_gltf_step(loader);
        }
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

assay_status assay_gltf_view_bytes(const assay_gltf_loader *loader, uint32_t view,
                                   const uint8_t **bytes_out, uint64_t *count_out)
{
    const assay_gltf_view  *v      = &loader->document.views[view];
    const assay_gltf_bytes *buffer = &loader->buffers[v->buffer];
    const uint64_t          end    = v->offset + v->length;
    if (v->offset > buffer->count || v->length > buffer->count - v->offset) {
        return assay_gltf_fail(
            loader, ASSAY_ERR_FORMAT,
            "bufferViews/%u: bytes %llu to %llu lie beyond buffers/%u, which has "
            "%llu",
            view, (unsigned long long)v->offset, (unsigned long long)end, v->buffer,
            (unsigned long long)buffer->count);
    }
    *bytes_out = buffer->bytes + v->offset;
    *count_out = v->length;
    return ASSAY_OK;
}
