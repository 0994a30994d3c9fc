/* scene_report.c - what was loaded: counts, and the same in words of JSON. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "scene/environment.h"
#include "scene/gltf_limits.h"
#include "scene/scene_text.h"
#include "scene/surface.h"

void assay_scene_warn(assay_scene *scene, const char *format, ...)
{
    char    message[768], clean[768];
    va_list arguments;
    if (scene->warning_count >= ASSAY_GLTF_MAX_WARNINGS) {
        return;
    }
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    assay_text_clean(scene->warning_count + 1 == ASSAY_GLTF_MAX_WARNINGS
                         ? "there are more warnings, which are not listed"
                         : message,
                     clean, sizeof clean);
    char *kept = assay_copy_text(scene->context, clean);
    if (!kept ||
        assay_grow(scene->context, (void **)&scene->warnings, &scene->warning_capacity,
                   scene->warning_count + (size_t)1, sizeof *scene->warnings) != ASSAY_OK) {
        assay_release(scene->context, kept);
        scene->warnings_lost = true;
        return;
    }
    scene->warnings[scene->warning_count++] = kept;
    assay_inform(scene->context, ASSAY_LOG_WARNING, "%s: %s", scene->path, kept);
}

/* ---- counts ---- */

static void count_lights(const assay_scene *scene, assay_scene_info *info)
{
    for (uint32_t i = 0; i < scene->punctual_count; i++) {
        const assay_punctual_light *light = &scene->punctual[i];
        info->point_lights += light->kind == ASSAY_LIGHT_POINT;
        info->spot_lights += light->kind == ASSAY_LIGHT_SPOT;
        info->directional_lights += light->kind == ASSAY_LIGHT_DIRECTIONAL;
        info->has_light = info->has_light || !rgb_is_black(light->intensity);
    }
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        if (assay_material_emits(&scene->materials[scene->shapes[i].material])) {
            info->emissive_triangles += scene->shapes[i].triangle_count;
        }
    }
    info->has_environment = scene->environment != NULL;
    info->has_light =
        info->has_light || info->emissive_triangles > 0 ||
        !rgb_is_black(scene->environment ? assay_environment_integral(scene->environment)
                                         : scene->options.background);
}

assay_scene_info assay_scene_describe(const assay_scene *scene)
{
    assay_scene_info info = {
        .triangles  = scene->triangle_count,
        .vertices   = scene->vertex_count,
        .meshes     = scene->mesh_count,
        .instances  = scene->instance_count,
        .materials  = scene->material_count - 1, /* without the default one */
        .textures   = scene->texture_count,
        .images     = scene->image_count,
        .nodes      = scene->node_count,
        .skins      = scene->skin_count,
        .animations = scene->animation_count,
        .cameras    = scene->camera_count,
        .bounds_min = scene->bounds_min,
        .bounds_max = scene->bounds_max,
        .warnings   = scene->warning_count,
    };
    for (uint32_t i = 0; i < scene->animation_count; i++) {
        info.duration = fmax(info.duration, scene->animations[i].duration);
    }
    count_lights(scene, &info);
    return info;
}

const char *assay_scene_camera_name(const assay_scene *scene, uint32_t index)
{
    return index < scene->camera_count ? scene->cameras[index].name : NULL;
}

const char *assay_scene_warning(const assay_scene *scene, uint32_t index)
{
    return index < scene->warning_count ? scene->warnings[index] : NULL;
}

const char *assay_scene_digest(const assay_scene *scene) { return scene->digest; }

const char *assay_scene_files_digest(const assay_scene *scene) { return scene->files_digest; }

/* ---- JSON ---- */

static bool add_number(cJSON *object, const char *name, double value)
{
    return cJSON_AddNumberToObject(object, name, value) != NULL;
}

static bool add_text(cJSON *object, const char *name, const char *value)
{
    return cJSON_AddStringToObject(object, name, value) != NULL;
}

static bool add_bool(cJSON *object, const char *name, bool value)
{
    return cJSON_AddBoolToObject(object, name, value) != NULL;
}

static bool add_triple(cJSON *object, const char *name, double x, double y, double z)
{
    const double values[3] = {x, y, z};
    cJSON       *array     = cJSON_CreateDoubleArray(values, 3);
    const bool   sound     = array && cJSON_AddItemToObject(object, name, array);
    if (!sound) {
        cJSON_Delete(array);
    }
    return sound;
}

/* A new object at the end of an array; NULL when memory is refused. */
static cJSON *add_element(cJSON *array)
{
    cJSON *object = cJSON_CreateObject();
    if (object && !cJSON_AddItemToArray(array, object)) {
        cJSON_Delete(object);
        return NULL;
    }
    return object;
}

static bool add_counts(cJSON *root, const assay_scene_info *info)
{
    return add_number(root, "triangles", info->triangles) &&
           add_number(root, "vertices", info->vertices) &&
           add_number(root, "meshes", info->meshes) &&
           add_number(root, "instances", info->instances) &&
           add_number(root, "materials", info->materials) &&
           add_number(root, "textures", info->textures) &&
           add_number(root, "images", info->images) && add_number(root, "nodes", info->nodes) &&
           add_number(root, "skins", info->skins) &&
           add_number(root, "emissive_triangles", info->emissive_triangles) &&
           add_bool(root, "has_light", info->has_light);
}

static bool add_cameras(cJSON *root, const assay_scene *scene)
{
    static const double degrees = 180.0 / ASSAY_PI;
    cJSON              *array   = cJSON_AddArrayToObject(root, "cameras");
    for (uint32_t i = 0; array && i < scene->camera_count; i++) {
        const assay_camera_desc *camera = &scene->cameras[i];
        cJSON                   *object = add_element(array);
        if (!object || !add_text(object, "name", camera->name) ||
            !add_text(object, "type", camera->orthographic ? "orthographic" : "perspective") ||
            !(camera->orthographic ? add_number(object, "xmag", camera->xmag) &&
                                         add_number(object, "ymag", camera->ymag)
                                   : add_number(object, "yfov_deg", camera->yfov * degrees)) ||
            !add_number(object, "znear", camera->znear)) {
            return false;
        }
    }
    return array != NULL;
}

static bool add_lights(cJSON *root, const assay_scene *scene)
{
    static const char *const kinds[] = {"point", "spot", "directional"};
    cJSON                   *array   = cJSON_AddArrayToObject(root, "lights");
    for (uint32_t i = 0; array && i < scene->node_count; i++) {
        const assay_node *node = &scene->nodes[i];
        if (!node->in_scene || node->light == ASSAY_NONE) {
            continue;
        }
        const assay_light_desc *light  = &scene->lights[node->light];
        const assay_rgb         power  = light->intensity;
        cJSON                  *object = add_element(array);
        if (!object || !add_text(object, "kind", kinds[light->kind]) ||
            !add_text(object, "name", light->name[0] ? light->name : node->name) ||
            !add_triple(object, "intensity", power.r, power.g, power.b)) {
            return false;
        }
    }
    return array != NULL;
}

static bool add_animations(cJSON *root, const assay_scene *scene)
{
    cJSON *array = cJSON_AddArrayToObject(root, "animations");
    for (uint32_t i = 0; array && i < scene->animation_count; i++) {
        cJSON *object = add_element(array);
        if (!object || !add_text(object, "name", scene->animations[i].name) ||
            !add_number(object, "duration", scene->animations[i].duration) ||
            !add_number(object, "channels", scene->animations[i].track_count)) {
            return false;
        }
    }
    return array != NULL;
}

static bool add_texts(cJSON *root, const char *name, char *const *texts, uint32_t count)
{
    cJSON *array = cJSON_AddArrayToObject(root, name);
    for (uint32_t i = 0; array && i < count; i++) {
        cJSON *text = cJSON_CreateString(texts[i]);
        if (!text || !cJSON_AddItemToArray(array, text)) {
            cJSON_Delete(text);
            return false;
        }
    }
    return array != NULL;
}

static bool add_environment(cJSON *root, const assay_scene *scene)
{
    const assay_rgb b = scene->options.background;
    if (!scene->environment) {
        return cJSON_AddNullToObject(root, "environment") &&
               add_triple(root, "background", b.r, b.g, b.b);
    }
    char clean[512];
    assay_text_clean(scene->options.environment_path, clean, sizeof clean);
    cJSON *object = cJSON_AddObjectToObject(root, "environment");
    return object && add_text(object, "path", clean) &&
           add_number(object, "scale", scene->options.environment_scale) &&
           add_number(object, "rotation_deg",
                      scene->options.environment_rotation * 180.0 / ASSAY_PI);
}

static bool add_bounds(cJSON *root, const assay_scene_info *info)
{
    cJSON           *object = cJSON_AddObjectToObject(root, "bounds");
    const assay_vec3 a = info->bounds_min, b = info->bounds_max;
    return object && add_triple(object, "min", a.x, a.y, a.z) &&
           add_triple(object, "max", b.x, b.y, b.z);
}

static bool fill(cJSON *root, const assay_scene *scene)
{
    const assay_scene_info info = assay_scene_describe(scene);
    return add_text(root, "path", scene->path) && add_text(root, "digest", scene->digest) &&
           add_text(root, "files_digest", scene->files_digest) &&
           add_number(root, "time", scene->time) && add_counts(root, &info) &&
           add_bounds(root, &info) && add_cameras(root, scene) && add_lights(root, scene) &&
           add_animations(root, scene) && add_number(root, "duration", info.duration) &&
           add_environment(root, scene) &&
           add_texts(root, "extensions_used", scene->extensions, scene->extension_count) &&
           add_texts(root, "warnings", scene->warnings, scene->warning_count);
}

assay_status assay_scene_report_json(const assay_scene *scene, char **text_out)
{
    cJSON *root = cJSON_CreateObject();
    char  *json = root && fill(root, scene) ? cJSON_Print(root) : NULL;
    char  *text = json ? assay_copy_text(scene->context, json) : NULL;
    cJSON_free(json);
    cJSON_Delete(root);
    if (!text) {
        return assay_fail_memory(scene->context, "the scene's report");
    }
    *text_out = text;
    return ASSAY_OK;
}
