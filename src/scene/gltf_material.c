/* gltf_material.c - materials, straight from the checked JSON: tinygltf leaves extensions untyped.
 *
 * Invariant: factors are in the ranges that the specification gives (the schema saw to it), and a
 * texture is only referred to with a set of texture coordinates that is kept. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"
#include "scene/texture.h"

static assay_material default_material(void)
{
    assay_texture_ref none = {.texture = ASSAY_NONE, .scale = {1.0, 1.0}};
    assay_texture_ref_prepare(&none);
    return (assay_material){
        .model                      = ASSAY_MATERIAL_PBR,
        .base_color                 = {1.0, 1.0, 1.0, 1.0},
        .metallic                   = 1.0,
        .roughness                  = 1.0,
        .normal_scale               = 1.0,
        .alpha_mode                 = ASSAY_ALPHA_OPAQUE,
        .alpha_cutoff               = 0.5,
        .ior                        = 1.5,
        .specular_factor            = 1.0,
        .specular_color             = {1.0, 1.0, 1.0},
        .attenuation_distance       = INFINITY,
        .attenuation_color          = {1.0, 1.0, 1.0},
        .alpha_x                    = 1.0,
        .alpha_y                    = 1.0,
        .base_color_texture         = none,
        .metallic_roughness_texture = none,
        .normal_texture             = none,
        .emissive_texture           = none,
        .specular_texture           = none,
        .specular_color_texture     = none,
        .transmission_texture       = none,
    };
}

static const assay_json *extension(const assay_json *object, const char *name)
{
    return assay_json_member(assay_json_member(object, "extensions"), name);
}

static assay_status load_ref(assay_gltf_loader *loader, const assay_json *object,
                             const char *member, const char *place, assay_texture_ref *ref)
{
    const assay_json *info      = assay_json_member(object, member);
    const assay_json *transform = extension(info, "KHR_texture_transform");
    if (!info) {
        return ASSAY_OK;
    }
    const double texcoord = assay_json_number(info, "texCoord", 0.0);
    ref->texture          = assay_json_index(info, "index");
    ref->texcoord         = (uint32_t)assay_json_number(transform, "texCoord", texcoord);
    ref->rotation         = assay_json_number(transform, "rotation", 0.0);
    assay_json_numbers(transform, "offset", 2, ref->offset);
    assay_json_numbers(transform, "scale", 2, ref->scale);
    if (ref->texcoord > 1) {
        return assay_gltf_fail(loader, ASSAY_ERR_UNSUPPORTED,
                               "%s: %s reads TEXCOORD_%u, but only sets 0 and 1 are supported",
                               place, member, ref->texcoord);
    }
    if (loader->document.textures[ref->texture].image == ASSAY_NONE) {
        return assay_gltf_fail(loader, ASSAY_ERR_UNSUPPORTED,
                               "%s: %s is textures/%u, which has no source that is supported",
                               place, member, ref->texture);
    }
    assay_texture_ref_prepare(ref);
    return ASSAY_OK;
}

/* pbrMetallicRoughness, normal, emission, alpha. */
static assay_status load_core(assay_gltf_loader *loader, const assay_json *json, const char *place,
                              assay_material *material)
{
    const assay_json *pbr         = assay_json_member(json, "pbrMetallicRoughness");
    const assay_json *strength    = extension(json, "KHR_materials_emissive_strength");
    const char       *alpha       = assay_json_text(json, "alphaMode", "OPAQUE");
    double            emissive[3] = {0.0, 0.0, 0.0};
    assay_json_numbers(pbr, "baseColorFactor", 4, material->base_color);
    material->metallic  = assay_json_number(pbr, "metallicFactor", 1.0);
    material->roughness = assay_json_number(pbr, "roughnessFactor", 1.0);
    material->normal_scale =
        assay_json_number(assay_json_member(json, "normalTexture"), "scale", 1.0);
    material->alpha_mode         = strcmp(alpha, "MASK") == 0    ? ASSAY_ALPHA_MASK
                                   : strcmp(alpha, "BLEND") == 0 ? ASSAY_ALPHA_BLEND
                                                                 : ASSAY_ALPHA_OPAQUE;
    material->alpha_cutoff       = assay_json_number(json, "alphaCutoff", 0.5);
    material->double_sided       = assay_json_bool(json, "doubleSided", false);
    material->emission_two_sided = material->double_sided;
    assay_json_numbers(json, "emissiveFactor", 3, emissive);
    if (fmax(emissive[0], fmax(emissive[1], emissive[2])) > 1.0) {
        assay_scene_warn(loader->scene, "%s: emissiveFactor above 1 is taken as it is", place);
    }
    material->emissive = rgb_scale(rgb(emissive[0], emissive[1], emissive[2]),
                                   assay_json_number(strength, "emissiveStrength", 1.0));
    if (!rgb_finite(material->emissive)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: the emission overflows", place);
    }
    assay_status status =
        load_ref(loader, pbr, "baseColorTexture", place, &material->base_color_texture);
    if (status == ASSAY_OK) {
        status = load_ref(loader, pbr, "metallicRoughnessTexture", place,
                          &material->metallic_roughness_texture);
    }
    if (status == ASSAY_OK) {
        status = load_ref(loader, json, "normalTexture", place, &material->normal_texture);
    }
    return status == ASSAY_OK
               ? load_ref(loader, json, "emissiveTexture", place, &material->emissive_texture)
               : status;
}

static assay_status load_extensions(assay_gltf_loader *loader, const assay_json *json,
                                    const char *place, assay_material *material)
{
    const assay_json *specular     = extension(json, "KHR_materials_specular");
    const assay_json *transmission = extension(json, "KHR_materials_transmission");
    const assay_json *volume       = extension(json, "KHR_materials_volume");
    double            color[3] = {1.0, 1.0, 1.0}, attenuation[3] = {1.0, 1.0, 1.0};
    assay_json_numbers(specular, "specularColorFactor", 3, color);
    assay_json_numbers(volume, "attenuationColor", 3, attenuation);
    if (extension(json, "KHR_materials_unlit")) {
        material->model = ASSAY_MATERIAL_UNLIT;
    }
    material->ior             = assay_json_number(extension(json, "KHR_materials_ior"), "ior", 1.5);
    material->specular_factor = assay_json_number(specular, "specularFactor", 1.0);
    material->specular_color  = rgb(color[0], color[1], color[2]);
    material->transmission    = assay_json_number(transmission, "transmissionFactor", 0.0);
    material->attenuation_distance = assay_json_number(volume, "attenuationDistance", INFINITY);
    material->attenuation_color    = rgb(attenuation[0], attenuation[1], attenuation[2]);
    material->solid =
        volume ? assay_json_number(volume, "thicknessFactor", 0.0) > 0.0
               : loader->scene->options.solid_transmission && material->transmission > 0.0;
    if (material->ior != 0.0 && material->ior < 1.0) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: ior is %g, must be 0 or at least 1",
                               place, material->ior);
    }
    assay_status status =
        load_ref(loader, specular, "specularTexture", place, &material->specular_texture);
    if (status == ASSAY_OK) {
        status = load_ref(loader, specular, "specularColorTexture", place,
                          &material->specular_color_texture);
    }
    return status == ASSAY_OK ? load_ref(loader, transmission, "transmissionTexture", place,
                                         &material->transmission_texture)
                              : status;
}

/* Base colour on both sides and emission as it was: nothing else remains.  factor is the file's
 * baseColorFactor: a diffuse reflectance of extras.assay goes with the model that it belongs to. */
static void make_diffuse(assay_material *material, const double factor[4])
{
    const assay_material from    = *material;
    *material                    = default_material();
    material->name               = from.name;
    material->model              = ASSAY_MATERIAL_LAMBERT;
    material->metallic           = 0.0;
    material->double_sided       = true;
    material->emission_two_sided = from.emission_two_sided;
    material->emissive           = from.emissive;
    material->base_color_texture = from.base_color_texture;
    material->emissive_texture   = from.emissive_texture;
    for (int c = 0; c < 3; c++) {
        material->base_color[c] = factor[c];
    }
}

static assay_status load_material(assay_gltf_loader *loader, const assay_json *json, uint32_t index,
                                  assay_material *material)
{
    char place[96];
    *material      = default_material();
    material->name = assay_gltf_copy_name(loader->context, assay_json_text(json, "name", ""));
    if (!material->name) {
        return assay_fail_memory(loader->context, "the scene's materials");
    }
    snprintf(place, sizeof place, "materials/%u (%.60s)", index, material->name);
    assay_status status = load_core(loader, json, place, material);
    if (status == ASSAY_OK) {
        status = load_extensions(loader, json, place, material);
    }
    double factor[4];
    memcpy(factor, material->base_color, sizeof factor);
    if (status == ASSAY_OK) {
        status = assay_gltf_load_brdf(loader, assay_json_member(json, "extras"), place, material);
    }
    if (status == ASSAY_OK && loader->scene->options.force_diffuse) {
        make_diffuse(material, factor);
    }
    return status;
}

assay_status assay_gltf_load_materials(assay_gltf_loader *loader)
{
    const assay_json *array = assay_json_member(loader->json.nodes, "materials");
    assay_scene      *scene = loader->scene;
    const uint32_t    count = (array ? array->count : 0) + 1;
    scene->materials        = assay_allocate(loader->context, count, sizeof *scene->materials);
    if (!scene->materials) {
        return assay_fail_memory(loader->context, "the scene's materials");
    }
    scene->material_count = count;
    uint32_t index        = 0;
    for (const assay_json *m = array ? array->child : NULL; m; m = m->next, index++) {
        const assay_status status = load_material(loader, m, index, &scene->materials[index]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    static const assay_json nothing = {.type = ASSAY_JSON_OBJECT};
    assay_material         *last    = &scene->materials[index];
    const assay_status      status  = load_material(loader, &nothing, index, last);
    if (status == ASSAY_OK) {
        assay_release(loader->context, last->name);
        last->name = assay_copy_text(loader->context, "default");
    }
    return last->name ? status : assay_fail_memory(loader->context, "the scene's materials");
}
