/* surface_material.c - a material's values at a point.
 *
 * Channels as glTF 2.0 and its extensions assign them: metallic in B and roughness in G,
 * transmission in R, the specular factor in A; base colour, emission and specular colour are sRGB.
 */
#include "scene/surface_material.h"

#include "scene/surface.h"

static inline void look_up(const assay_scene *scene, const assay_texture_ref *ref,
                           const assay_surface *surface, bool srgb, double texel_out[4])
{
    if (ref->texture == ASSAY_NONE) {
        texel_out[0] = texel_out[1] = texel_out[2] = texel_out[3] = 1.0;
    } else {
        assay_texture_sample(scene, ref, surface->uv[ref->texcoord & 1u], srgb, texel_out);
    }
}

void assay_surface_prefetch(const assay_scene *scene, const assay_surface *surface)
{
    const assay_texture_ref *ref = &scene->materials[surface->material].base_color_texture;
    if (ref->texture != ASSAY_NONE) {
        assay_texture_prefetch(scene, ref, surface->uv[ref->texcoord & 1u]);
    }
}

void assay_surface_base_color(const assay_scene *scene, const assay_surface *surface,
                              assay_rgb *color_out, double *coverage_out)
{
    const assay_material *material = &scene->materials[surface->material];
    double                texel[4];
    double                value[4];
    look_up(scene, &material->base_color_texture, surface, true, texel);
    for (int i = 0; i < 4; i++) {
        value[i] = material->base_color[i] * texel[i] * surface->color[i];
    }
    *color_out =
        rgb(assay_clamp_unit(value[0]), assay_clamp_unit(value[1]), assay_clamp_unit(value[2]));
    *coverage_out = assay_material_coverage(material, value[3]);
}

bool assay_material_emits(const assay_material *material)
{
    return material->model != ASSAY_MATERIAL_UNLIT && !rgb_is_black(material->emissive);
}

assay_rgb assay_surface_emission(const assay_scene *scene, const assay_surface *surface, bool front)
{
    const assay_material *material = &scene->materials[surface->material];
    if (material->model == ASSAY_MATERIAL_UNLIT) {
        assay_rgb color = rgb_grey(0.0);
        double    coverage;
        if (front || material->double_sided) {
            assay_surface_base_color(scene, surface, &color, &coverage);
        }
        return color;
    }
    if (rgb_is_black(material->emissive) || !(front || material->emission_two_sided)) {
        return rgb_grey(0.0);
    }
    double texel[4];
    look_up(scene, &material->emissive_texture, surface, true, texel);
    return rgb_mul(material->emissive, rgb(texel[0], texel[1], texel[2]));
}

void assay_surface_material_at(const assay_scene *scene, const assay_surface *surface,
                               assay_surface_material *material_out)
{
    const assay_material   *material = &scene->materials[surface->material];
    assay_surface_material *m        = material_out;
    assay_surface_base_color(scene, surface, &m->base_color, &m->coverage);
    m->metallic        = material->metallic;
    m->roughness       = material->roughness;
    m->transmission    = material->transmission;
    m->specular_factor = material->specular_factor;
    m->specular_color  = material->specular_color;
    if (material->model == ASSAY_MATERIAL_LAMBERT || material->model == ASSAY_MATERIAL_UNLIT) {
        return;
    }
    double texel[4];
    if (material->metallic_roughness_texture.texture != ASSAY_NONE) {
        look_up(scene, &material->metallic_roughness_texture, surface, false, texel);
        m->roughness *= texel[1];
        m->metallic *= texel[2];
    }
    if (material->transmission_texture.texture != ASSAY_NONE) {
        look_up(scene, &material->transmission_texture, surface, false, texel);
        m->transmission *= texel[0];
    }
    if (material->specular_texture.texture != ASSAY_NONE) {
        look_up(scene, &material->specular_texture, surface, false, texel);
        m->specular_factor *= texel[3];
    }
    if (material->specular_color_texture.texture != ASSAY_NONE) {
        look_up(scene, &material->specular_color_texture, surface, true, texel);
        m->specular_color = rgb_mul(m->specular_color, rgb(texel[0], texel[1], texel[2]));
    }
}
