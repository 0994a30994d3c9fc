/* gltf_loader.c - what every step of loading shares: messages, limits, release. */
#include "scene/gltf_loader.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/scene_text.h"

assay_status assay_gltf_fail(const assay_gltf_loader *loader, assay_status status,
                             const char *format, ...)
{
    char    message[768], clean[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    assay_text_clean(message, clean, sizeof clean);
    return assay_fail(loader->context, status, "%s: %s", loader->file, clean);
}

assay_status assay_gltf_count_decoded(assay_gltf_loader *loader, uint64_t elements, uint64_t size)
{
    const uint64_t left = ASSAY_GLTF_MAX_DECODED_BYTES - loader->bytes_decoded;
    if (elements > left / size) {
        return assay_gltf_fail(loader, ASSAY_ERR_LIMIT,
                               "accessors amount to more than %llu bytes when decoded",
                               (unsigned long long)ASSAY_GLTF_MAX_DECODED_BYTES);
    }
    loader->bytes_decoded += elements * size;
    return ASSAY_OK;
}

assay_status assay_gltf_step(assay_gltf_loader *loader)
{
    loader->steps_done += loader->steps_done < loader->steps;
    return assay_progress(loader->context, "load", loader->steps_done, loader->steps);
}

static void release_mesh(assay_context *context, assay_gltf_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->primitive_count; i++) {
        assay_release(context, mesh->primitives[i].targets);
    }
    assay_release(context, mesh->primitives);
    assay_release(context, mesh->weights);
    assay_release(context, mesh->name);
}

static void release_animation(assay_context *context, assay_gltf_animation *animation)
{
    assay_release(context, animation->name);
    assay_release(context, animation->channels);
    assay_release(context, animation->samplers);
}

static void release_nodes(assay_context *context, assay_gltf_document *document)
{
    for (uint32_t i = 0; document->nodes && i < document->node_count; i++) {
        assay_release(context, document->nodes[i].name);
        assay_release(context, document->nodes[i].weights);
    }
    for (uint32_t i = 0; document->children && i < document->node_count; i++) {
        assay_release(context, document->children[i].children);
    }
    assay_release(context, document->nodes);
    assay_release(context, document->children);
}

void assay_gltf_document_release(assay_context *context, assay_gltf_document *document)
{
    for (uint32_t i = 0; i < document->mesh_count; i++) {
        release_mesh(context, &document->meshes[i]);
    }
    for (uint32_t i = 0; i < document->scene_count; i++) {
        assay_release(context, document->scenes[i].nodes);
    }
    for (uint32_t i = 0; i < document->skin_count; i++) {
        assay_release(context, document->skins[i].joints);
    }
    for (uint32_t i = 0; i < document->animation_count; i++) {
        release_animation(context, &document->animations[i]);
    }
    for (uint32_t i = 0; document->cameras && i < document->camera_count; i++) {
        assay_release(context, document->cameras[i].name);
    }
    release_nodes(context, document);
    assay_release(context, document->views);
    assay_release(context, document->accessors);
    assay_release(context, document->meshes);
    assay_release(context, document->scenes);
    assay_release(context, document->skins);
    assay_release(context, document->animations);
    assay_release(context, document->textures);
    assay_release(context, document->samplers);
    assay_release(context, document->cameras);
    *document = (assay_gltf_document){0};
}

void assay_gltf_loader_release(assay_gltf_loader *loader)
{
    for (uint32_t i = 0; loader->buffers && i < loader->buffer_count; i++) {
        assay_gltf_release_bytes(loader->context, &loader->buffers[i]);
    }
    assay_release(loader->context, loader->buffers);
    loader->buffers = NULL;
    assay_gltf_document_release(loader->context, &loader->document);
    assay_json_release(loader->context, &loader->json);
}

char *assay_gltf_copy_name(assay_context *context, const char *name)
{
    char clean[ASSAY_GLTF_MAX_NAME + 1];
    assay_text_clean(name, clean, sizeof clean);
    return assay_copy_text(context, clean);
}
