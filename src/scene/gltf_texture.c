/* gltf_texture.c - textures, and the images that some material looks at.
 *
 * Invariant: every texture that a material refers to has a decoded image.  Others are not read: a
 * fallback in a format that assay does not know harms nobody as long as nothing uses it. */
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"
#include "scene/scene_text.h"
#include "scene/texture.h"

/* Marks the images that materials use. */
static void mark_images(const assay_scene *scene, bool *used)
{
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const assay_material          *m      = &scene->materials[i];
        const assay_texture_ref *const refs[] = {
            &m->base_color_texture,  &m->metallic_roughness_texture, &m->normal_texture,
            &m->emissive_texture,    &m->specular_texture,           &m->specular_color_texture,
            &m->transmission_texture};
        for (int k = 0; k < 7; k++) {
            if (refs[k]->texture != ASSAY_NONE) {
                used[scene->textures[refs[k]->texture].image] = true;
            }
        }
    }
}

/* "scene.gltf: images/3 (bricks.png)" */
static void name_image(const assay_gltf_loader *loader, const assay_json *json, uint32_t index,
                       char *name_out, size_t size)
{
    char        text[512];
    const char *uri  = assay_json_text(json, "uri", "");
    const char *name = assay_json_text(json, "name", strncmp(uri, "data:", 5) ? uri : "");
    snprintf(text, sizeof text, "%.200s: images/%u (%.100s)", loader->file, index, name);
    assay_text_clean(text, name_out, size);
}

static assay_status load_image(assay_gltf_loader *loader, const assay_json *json, uint32_t index,
                               bool used, assay_texture_image *image)
{
    const char      *uri   = assay_json_text(json, "uri", NULL);
    const uint32_t   view  = assay_json_index(json, "bufferView");
    assay_gltf_bytes bytes = {0};
    assay_status     status;
    char             place[32], name[512];
    snprintf(place, sizeof place, "images/%u", index);
    if ((uri == NULL) == (view == ASSAY_NONE)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "%s: must have either a uri or a bufferView", place);
    }
    if (!used) {
        return ASSAY_OK;
    }
    if (uri) {
        status = assay_gltf_read_uri(loader, uri, place, &bytes);
    } else {
        status = assay_gltf_view_bytes(loader, view, &bytes.bytes, &bytes.count);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    name_image(loader, json, index, name, sizeof name);
    status =
        assay_texture_image_decode(loader->context, bytes.bytes, (size_t)bytes.count, name, image);
    assay_gltf_release_bytes(loader->context, &bytes);
    loader->texel_bytes += (uint64_t)image->width * image->height * image->bits / 2;
    if (status == ASSAY_OK && loader->texel_bytes > ASSAY_GLTF_MAX_TEXEL_BYTES) {
        status = assay_gltf_fail(loader, ASSAY_ERR_LIMIT,
                                 "%s: with it the images have more than %llu bytes when decoded",
                                 place, (unsigned long long)ASSAY_GLTF_MAX_TEXEL_BYTES);
    }
    return status != ASSAY_OK ? status : assay_texture_image_tile(loader->context, image);
}

static assay_status load_images(assay_gltf_loader *loader, bool *used)
{
    const assay_json *array = assay_json_member(loader->json.nodes, "images");
    assay_scene      *scene = loader->scene;
    mark_images(scene, used);
    uint32_t index = 0;
    for (const assay_json *i = array ? array->child : NULL; i; i = i->next, index++) {
        assay_status status = load_image(loader, i, index, used[index], &scene->images[index]);
        if (status == ASSAY_OK) {
            status = assay_gltf_step(loader);
        }
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

assay_status assay_gltf_load_textures(assay_gltf_loader *loader)
{
    const assay_gltf_document *document = &loader->document;
    assay_scene               *scene    = loader->scene;
    const uint32_t             images   = loader->schema.lengths[ASSAY_GLTF_IMAGES];
    scene->images = assay_allocate(loader->context, images, sizeof *scene->images);
    scene->textures =
        assay_allocate(loader->context, document->texture_count, sizeof *scene->textures);
    bool *used = assay_allocate(loader->context, images, sizeof *used);
    if (!scene->images || !scene->textures || !used) {
        assay_release(loader->context, used);
        return assay_fail_memory(loader->context, "the scene's textures");
    }
    scene->image_count   = images;
    scene->texture_count = document->texture_count;
    for (uint32_t i = 0; i < document->texture_count; i++) {
        const assay_gltf_texture *from = &document->textures[i];
        scene->textures[i].image       = from->image;
        if (from->sampler != ASSAY_NONE) {
            scene->textures[i].wrap_u  = document->samplers[from->sampler].wrap_u;
            scene->textures[i].wrap_v  = document->samplers[from->sampler].wrap_v;
            scene->textures[i].nearest = document->samplers[from->sampler].nearest;
        }
    }
    const assay_status status = load_images(loader, used);
    assay_release(loader->context, used);
    return status;
}
