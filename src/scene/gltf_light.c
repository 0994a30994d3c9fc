/* gltf_light.c - KHR_lights_punctual: what the lights are; nodes say where (gltf_node.c).
 *
 * Photometric numbers are taken as radiometric ones: candela as W/sr, lux as W/m2, one for one in
 * each of R, G, B, as emissive factors (nits) are taken as W/(m2 sr). */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "scene/gltf_loader.h"

static assay_status load_light(assay_gltf_loader *loader, const assay_json *json, uint32_t index,
                               assay_light_desc *light)
{
    const char       *type      = assay_json_text(json, "type", "");
    const assay_json *spot      = assay_json_member(json, "spot");
    const double      intensity = assay_json_number(json, "intensity", 1.0);
    double            color[3]  = {1.0, 1.0, 1.0};
    assay_json_numbers(json, "color", 3, color);
    light->kind       = strcmp(type, "point") == 0  ? ASSAY_LIGHT_POINT
                        : strcmp(type, "spot") == 0 ? ASSAY_LIGHT_SPOT
                                                    : ASSAY_LIGHT_DIRECTIONAL;
    light->intensity  = rgb_scale(rgb(color[0], color[1], color[2]), intensity);
    light->range      = light->kind == ASSAY_LIGHT_DIRECTIONAL
                            ? INFINITY
                            : assay_json_number(json, "range", INFINITY);
    light->inner_cone = assay_json_number(spot, "innerConeAngle", 0.0);
    light->outer_cone =
        fmin(assay_json_number(spot, "outerConeAngle", ASSAY_PI / 4.0), ASSAY_PI / 2);
    light->name = assay_gltf_copy_name(loader->context, assay_json_text(json, "name", ""));
    if (!light->name) {
        return assay_fail_memory(loader->context, "the scene's lights");
    }
    if (!rgb_finite(light->intensity)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "lights/%u: color * intensity overflows",
                               index);
    }
    if (light->kind == ASSAY_LIGHT_SPOT && light->inner_cone >= light->outer_cone) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "lights/%u: innerConeAngle %g must be below outerConeAngle %g",
                               index, light->inner_cone, light->outer_cone);
    }
    return ASSAY_OK;
}

assay_status assay_gltf_load_lights(assay_gltf_loader *loader)
{
    const assay_json *extension = assay_json_member(
        assay_json_member(loader->json.nodes, "extensions"), "KHR_lights_punctual");
    const assay_json *array = assay_json_member(extension, "lights");
    assay_scene      *scene = loader->scene;
    const uint32_t    count = array ? array->count : 0;
    scene->lights           = assay_allocate(loader->context, count, sizeof *scene->lights);
    if (!scene->lights) {
        return assay_fail_memory(loader->context, "the scene's lights");
    }
    scene->light_count = count;
    uint32_t index     = 0;
    for (const assay_json *l = array ? array->child : NULL; l; l = l->next, index++) {
        const assay_status status = load_light(loader, l, index, &scene->lights[index]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}
