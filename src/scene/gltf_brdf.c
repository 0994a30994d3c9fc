/* gltf_brdf.c - a material's extras.assay: the two reflection models of the papers' scenes.
 *
 * Invariant: diffuse and specular reflectance together are at most 1 in every channel, so neither
 * model makes energy. */
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "scene/gltf_loader.h"

/* 0.7 + 0.3 in binary may lie a rounding above 1. */
static const double energy_tolerance = 1e-9;

static assay_status check_energy(const assay_gltf_loader *loader, const assay_material *material,
                                 const char *place)
{
    static const char channel_names[] = "RGB";
    const double      specular[3]     = {material->specular_color.r, material->specular_color.g,
                                         material->specular_color.b};
    for (int c = 0; c < 3; c++) {
        if (material->base_color[c] + specular[c] > 1.0 + energy_tolerance) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "%s: diffuse %g and specular %g of channel %c reflect more than "
                                   "arrives; make their sum at most 1",
                                   place, material->base_color[c], specular[c], channel_names[c]);
        }
    }
    return ASSAY_OK;
}

assay_status assay_gltf_load_brdf(assay_gltf_loader *loader, const assay_json *extras,
                                  const char *place, assay_material *material)
{
    const assay_json *brdf =
        extras && extras->type == ASSAY_JSON_OBJECT ? assay_json_member(extras, "assay") : NULL;
    double specular[3] = {0.0, 0.0, 0.0}, alpha[2] = {1.0, 1.0};
    char   here[128];
    snprintf(here, sizeof here, "%.90s: extras/assay", place);
    if (!brdf) {
        return ASSAY_OK;
    }
    assay_status status = assay_gltf_check_object(&loader->schema, brdf, "brdf", here);
    if (status == ASSAY_OK) {
        status =
            assay_gltf_check_object(&loader->schema, brdf, assay_json_text(brdf, "brdf", ""), here);
    }
    if (status == ASSAY_OK && material->model == ASSAY_MATERIAL_UNLIT) {
        status = assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: a BRDF on an unlit material", here);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    const char *variant = assay_json_text(brdf, "variant", "corrected");
    material->model = strcmp(assay_json_text(brdf, "brdf", ""), "phong") == 0 ? ASSAY_MATERIAL_PHONG
                      : strcmp(variant, "published") == 0 ? ASSAY_MATERIAL_WARD_PUBLISHED
                                                          : ASSAY_MATERIAL_WARD;
    material->exponent = assay_json_number(brdf, "exponent", 0.0);
    assay_json_numbers(brdf, "diffuse", 3, material->base_color);
    assay_json_numbers(brdf, "specular", 3, specular);
    assay_json_numbers(brdf, "alpha", 2, alpha);
    material->specular_color = rgb(specular[0], specular[1], specular[2]);
    material->alpha_x        = alpha[0];
    material->alpha_y        = alpha[1];
    return check_energy(loader, material, here);
}
