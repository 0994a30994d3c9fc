/* gltf_schema_table.c - the glTF 2.0 specification's property reference, and that of the extensions
 * that are supported, as far as assay reads them. */
#include <math.h>
#include <string.h>

#include "core/numerics.h"
#include "scene/gltf_schema.h"

#define COUNT_OF(array) ((int)(sizeof(array) / sizeof(array)[0]))

#define COMPONENT_TYPES "5120|5121|5122|5123|5125|5126"

static const assay_gltf_rule root_rules[] = {
    {.member = "asset", .kind = ASSAY_GLTF_OBJECT, .required = true, .what = "asset"},
    {.member = "extensionsUsed", .kind = ASSAY_GLTF_TEXTS},
    {.member = "extensionsRequired", .kind = ASSAY_GLTF_TEXTS},
    {.member = "scene", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_SCENES},
    {.member = "scenes", .kind = ASSAY_GLTF_OBJECTS, .what = "scene"},
    {.member = "nodes", .kind = ASSAY_GLTF_OBJECTS, .what = "node"},
    {.member = "meshes", .kind = ASSAY_GLTF_OBJECTS, .what = "mesh"},
    {.member = "accessors", .kind = ASSAY_GLTF_OBJECTS, .what = "accessor"},
    {.member = "bufferViews", .kind = ASSAY_GLTF_OBJECTS, .what = "bufferView"},
    {.member = "buffers", .kind = ASSAY_GLTF_OBJECTS, .what = "buffer"},
    {.member = "materials", .kind = ASSAY_GLTF_OBJECTS, .what = "material"},
    {.member = "textures", .kind = ASSAY_GLTF_OBJECTS, .what = "texture"},
    {.member = "images", .kind = ASSAY_GLTF_OBJECTS, .what = "image"},
    {.member = "samplers", .kind = ASSAY_GLTF_OBJECTS, .what = "sampler"},
    {.member = "skins", .kind = ASSAY_GLTF_OBJECTS, .what = "skin"},
    {.member = "cameras", .kind = ASSAY_GLTF_OBJECTS, .what = "camera"},
    {.member = "animations", .kind = ASSAY_GLTF_OBJECTS, .what = "animation"},
};

static const assay_gltf_rule asset_rules[] = {
    {.member = "version", .kind = ASSAY_GLTF_TEXT, .required = true},
    {.member = "minVersion", .kind = ASSAY_GLTF_TEXT},
};

static const assay_gltf_rule scene_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "nodes", .kind = ASSAY_GLTF_INDICES, .array = ASSAY_GLTF_NODES},
};

static const assay_gltf_rule node_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "children", .kind = ASSAY_GLTF_INDICES, .array = ASSAY_GLTF_NODES},
    {.member = "mesh", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_MESHES},
    {.member = "skin", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_SKINS},
    {.member = "camera", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_CAMERAS},
    {.member = "matrix", .kind = ASSAY_GLTF_NUMBERS, .count = 16},
    {.member = "translation", .kind = ASSAY_GLTF_NUMBERS, .count = 3},
    {.member = "rotation", .kind = ASSAY_GLTF_NUMBERS, .count = 4},
    {.member = "scale", .kind = ASSAY_GLTF_NUMBERS, .count = 3},
    {.member = "weights", .kind = ASSAY_GLTF_NUMBERS},
};

static const assay_gltf_rule node_light_rules[] = {
    {.member = "light", .kind = ASSAY_GLTF_INDEX, .required = true, .array = ASSAY_GLTF_LIGHTS},
};

static const assay_gltf_rule mesh_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "primitives", .kind = ASSAY_GLTF_OBJECTS, .required = true, .what = "primitive"},
    {.member = "weights", .kind = ASSAY_GLTF_NUMBERS},
};

static const assay_gltf_rule primitive_rules[] = {
    {.member   = "attributes",
     .kind     = ASSAY_GLTF_INDEX_MAP,
     .required = true,
     .array    = ASSAY_GLTF_ACCESSORS},
    {.member = "indices", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_ACCESSORS},
    {.member = "material", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_MATERIALS},
    {.member = "mode", .kind = ASSAY_GLTF_CODE, .what = "0|1|2|3|4|5|6"},
    {.member = "targets", .kind = ASSAY_GLTF_INDEX_MAPS, .array = ASSAY_GLTF_ACCESSORS},
};

static const assay_gltf_rule accessor_rules[] = {
    {.member = "bufferView", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_BUFFER_VIEWS},
    {.member = "byteOffset", .kind = ASSAY_GLTF_COUNT},
    {.member = "componentType", .kind = ASSAY_GLTF_CODE, .required = true, .what = COMPONENT_TYPES},
    {.member = "normalized", .kind = ASSAY_GLTF_BOOL},
    {.member = "count", .kind = ASSAY_GLTF_COUNT, .required = true, .minimum = 1},
    {.member   = "type",
     .kind     = ASSAY_GLTF_WORD,
     .required = true,
     .what     = "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"},
    {.member = "sparse", .kind = ASSAY_GLTF_OBJECT, .what = "sparse"},
};

static const assay_gltf_rule sparse_rules[] = {
    {.member = "count", .kind = ASSAY_GLTF_COUNT, .required = true, .minimum = 1},
    {.member = "indices", .kind = ASSAY_GLTF_OBJECT, .required = true, .what = "sparse indices"},
    {.member = "values", .kind = ASSAY_GLTF_OBJECT, .required = true, .what = "sparse values"},
};

static const assay_gltf_rule sparse_indices_rules[] = {
    {.member   = "bufferView",
     .kind     = ASSAY_GLTF_INDEX,
     .required = true,
     .array    = ASSAY_GLTF_BUFFER_VIEWS},
    {.member = "byteOffset", .kind = ASSAY_GLTF_COUNT, .maximum = 2147483647},
    {.member   = "componentType",
     .kind     = ASSAY_GLTF_CODE,
     .required = true,
     .what     = "5121|5123|5125"},
};

static const assay_gltf_rule sparse_values_rules[] = {
    {.member   = "bufferView",
     .kind     = ASSAY_GLTF_INDEX,
     .required = true,
     .array    = ASSAY_GLTF_BUFFER_VIEWS},
    {.member = "byteOffset", .kind = ASSAY_GLTF_COUNT, .maximum = 2147483647},
};

static const assay_gltf_rule buffer_view_rules[] = {
    {.member = "buffer", .kind = ASSAY_GLTF_INDEX, .required = true, .array = ASSAY_GLTF_BUFFERS},
    {.member = "byteOffset", .kind = ASSAY_GLTF_COUNT},
    {.member = "byteLength", .kind = ASSAY_GLTF_COUNT, .required = true, .minimum = 1},
    {.member = "byteStride", .kind = ASSAY_GLTF_COUNT, .minimum = 4, .maximum = 252},
};

static const assay_gltf_rule buffer_rules[] = {
    {.member = "uri", .kind = ASSAY_GLTF_TEXT},
    {.member = "byteLength", .kind = ASSAY_GLTF_COUNT, .required = true, .minimum = 1},
};

static const assay_gltf_rule texture_rules[] = {
    {.member = "sampler", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_SAMPLERS},
    {.member = "source", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_IMAGES},
};

static const assay_gltf_rule image_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "uri", .kind = ASSAY_GLTF_TEXT},
    {.member = "bufferView", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_BUFFER_VIEWS},
    {.member = "mimeType", .kind = ASSAY_GLTF_TEXT},
};

static const assay_gltf_rule sampler_rules[] = {
    {.member = "magFilter", .kind = ASSAY_GLTF_CODE, .what = "9728|9729"},
    {.member = "minFilter", .kind = ASSAY_GLTF_CODE, .what = "9728|9729|9984|9985|9986|9987"},
    {.member = "wrapS", .kind = ASSAY_GLTF_CODE, .what = "33071|33648|10497"},
    {.member = "wrapT", .kind = ASSAY_GLTF_CODE, .what = "33071|33648|10497"},
};

static const assay_gltf_rule skin_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "joints", .kind = ASSAY_GLTF_INDICES, .required = true, .array = ASSAY_GLTF_NODES},
    {.member = "inverseBindMatrices", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_ACCESSORS},
    {.member = "skeleton", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_NODES},
};

static const assay_gltf_rule camera_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member   = "type",
     .kind     = ASSAY_GLTF_WORD,
     .required = true,
     .what     = "perspective|orthographic"},
    {.member = "perspective", .kind = ASSAY_GLTF_OBJECT, .what = "perspective"},
    {.member = "orthographic", .kind = ASSAY_GLTF_OBJECT, .what = "orthographic"},
};

static const assay_gltf_rule perspective_rules[] = {
    {.member   = "yfov",
     .kind     = ASSAY_GLTF_NUMBER,
     .required = true,
     .above    = true,
     .maximum  = 3.1415926},
    {.member = "aspectRatio", .kind = ASSAY_GLTF_NUMBER, .above = true, .maximum = HUGE_VAL},
    {.member   = "znear",
     .kind     = ASSAY_GLTF_NUMBER,
     .required = true,
     .above    = true,
     .maximum  = HUGE_VAL},
    {.member = "zfar", .kind = ASSAY_GLTF_NUMBER, .above = true, .maximum = HUGE_VAL},
};

static const assay_gltf_rule orthographic_rules[] = {
    {.member   = "xmag",
     .kind     = ASSAY_GLTF_NUMBER,
     .required = true,
     .above    = true,
     .maximum  = HUGE_VAL},
    {.member   = "ymag",
     .kind     = ASSAY_GLTF_NUMBER,
     .required = true,
     .above    = true,
     .maximum  = HUGE_VAL},
    {.member = "znear", .kind = ASSAY_GLTF_NUMBER, .required = true, .maximum = HUGE_VAL},
    {.member   = "zfar",
     .kind     = ASSAY_GLTF_NUMBER,
     .required = true,
     .above    = true,
     .maximum  = HUGE_VAL},
};

static const assay_gltf_rule animation_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "channels", .kind = ASSAY_GLTF_OBJECTS, .required = true, .what = "channel"},
    {.member   = "samplers",
     .kind     = ASSAY_GLTF_OBJECTS,
     .required = true,
     .what     = "animation sampler"},
};

static const assay_gltf_rule channel_rules[] = {
    {.member = "sampler", .kind = ASSAY_GLTF_COUNT, .required = true, .maximum = 2147483647},
    {.member = "target", .kind = ASSAY_GLTF_OBJECT, .required = true, .what = "target"},
};

static const assay_gltf_rule target_rules[] = {
    {.member = "node", .kind = ASSAY_GLTF_INDEX, .array = ASSAY_GLTF_NODES},
    {.member   = "path",
     .kind     = ASSAY_GLTF_WORD,
     .required = true,
     .what     = "translation|rotation|scale|weights|pointer"},
};

static const assay_gltf_rule animation_sampler_rules[] = {
    {.member = "input", .kind = ASSAY_GLTF_INDEX, .required = true, .array = ASSAY_GLTF_ACCESSORS},
    {.member = "output", .kind = ASSAY_GLTF_INDEX, .required = true, .array = ASSAY_GLTF_ACCESSORS},
    {.member = "interpolation", .kind = ASSAY_GLTF_WORD, .what = "LINEAR|STEP|CUBICSPLINE"},
};

/* ---- materials ---- */

static const assay_gltf_rule material_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "pbrMetallicRoughness", .kind = ASSAY_GLTF_OBJECT, .what = "pbrMetallicRoughness"},
    {.member = "normalTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
    {.member = "occlusionTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
    {.member = "emissiveTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
    {.member = "emissiveFactor", .kind = ASSAY_GLTF_NUMBERS, .count = 3, .maximum = HUGE_VAL},
    {.member = "alphaMode", .kind = ASSAY_GLTF_WORD, .what = "OPAQUE|MASK|BLEND"},
    {.member = "alphaCutoff", .kind = ASSAY_GLTF_NUMBER, .maximum = HUGE_VAL},
    {.member = "doubleSided", .kind = ASSAY_GLTF_BOOL},
};

static const assay_gltf_rule pbr_rules[] = {
    {.member = "baseColorFactor", .kind = ASSAY_GLTF_NUMBERS, .count = 4, .maximum = 1},
    {.member = "baseColorTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
    {.member = "metallicFactor", .kind = ASSAY_GLTF_NUMBER, .maximum = 1},
    {.member = "roughnessFactor", .kind = ASSAY_GLTF_NUMBER, .maximum = 1},
    {.member = "metallicRoughnessTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
};

static const assay_gltf_rule texture_info_rules[] = {
    {.member = "index", .kind = ASSAY_GLTF_INDEX, .required = true, .array = ASSAY_GLTF_TEXTURES},
    {.member = "texCoord", .kind = ASSAY_GLTF_COUNT, .maximum = 2147483647},
    {.member = "scale", .kind = ASSAY_GLTF_NUMBER},
};

static const assay_gltf_rule texture_transform_rules[] = {
    {.member = "offset", .kind = ASSAY_GLTF_NUMBERS, .count = 2},
    {.member = "rotation", .kind = ASSAY_GLTF_NUMBER},
    {.member = "scale", .kind = ASSAY_GLTF_NUMBERS, .count = 2},
    {.member = "texCoord", .kind = ASSAY_GLTF_COUNT, .maximum = 2147483647},
};

static const assay_gltf_rule emissive_strength_rules[] = {
    {.member = "emissiveStrength", .kind = ASSAY_GLTF_NUMBER, .maximum = HUGE_VAL},
};

static const assay_gltf_rule ior_rules[] = {
    {.member = "ior", .kind = ASSAY_GLTF_NUMBER, .maximum = HUGE_VAL},
};

static const assay_gltf_rule specular_rules[] = {
    {.member = "specularFactor", .kind = ASSAY_GLTF_NUMBER, .maximum = 1},
    {.member = "specularTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
    {.member = "specularColorFactor", .kind = ASSAY_GLTF_NUMBERS, .count = 3, .maximum = HUGE_VAL},
    {.member = "specularColorTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
};

static const assay_gltf_rule transmission_rules[] = {
    {.member = "transmissionFactor", .kind = ASSAY_GLTF_NUMBER, .maximum = 1},
    {.member = "transmissionTexture", .kind = ASSAY_GLTF_OBJECT, .what = "textureInfo"},
};

static const assay_gltf_rule volume_rules[] = {
    {.member = "thicknessFactor", .kind = ASSAY_GLTF_NUMBER, .maximum = HUGE_VAL},
    {.member  = "attenuationDistance",
     .kind    = ASSAY_GLTF_NUMBER,
     .above   = true,
     .maximum = HUGE_VAL},
    {.member = "attenuationColor", .kind = ASSAY_GLTF_NUMBERS, .count = 3, .maximum = 1},
};

/* ---- lights ---- */

static const assay_gltf_rule lights_rules[] = {
    {.member = "lights", .kind = ASSAY_GLTF_OBJECTS, .required = true, .what = "light"},
};

static const assay_gltf_rule light_rules[] = {
    {.member = "name", .kind = ASSAY_GLTF_TEXT},
    {.member = "type", .kind = ASSAY_GLTF_WORD, .required = true, .what = "point|spot|directional"},
    {.member = "color", .kind = ASSAY_GLTF_NUMBERS, .count = 3, .maximum = HUGE_VAL},
    {.member = "intensity", .kind = ASSAY_GLTF_NUMBER, .maximum = HUGE_VAL},
    {.member = "range", .kind = ASSAY_GLTF_NUMBER, .above = true, .maximum = HUGE_VAL},
    {.member = "spot", .kind = ASSAY_GLTF_OBJECT, .what = "spot"},
};

/* The outer cone may come rounded up from pi / 2 to a float. */
static const assay_gltf_rule spot_rules[] = {
    {.member = "innerConeAngle", .kind = ASSAY_GLTF_NUMBER, .maximum = ASSAY_PI / 2},
    {.member = "outerConeAngle", .kind = ASSAY_GLTF_NUMBER, .above = true, .maximum = 1.5707964},
};

/* ---- extras.assay of a material ---- */

static const assay_gltf_rule brdf_rules[] = {
    {.member = "brdf", .kind = ASSAY_GLTF_WORD, .required = true, .what = "phong|ward"},
};

static const assay_gltf_rule phong_rules[] = {
    {.member = "brdf", .kind = ASSAY_GLTF_WORD, .required = true, .what = "phong"},
    {.member = "exponent", .kind = ASSAY_GLTF_NUMBER, .required = true, .maximum = 1e6},
    {.member = "diffuse", .kind = ASSAY_GLTF_NUMBERS, .count = 3, .maximum = 1},
    {.member = "specular", .kind = ASSAY_GLTF_NUMBERS, .required = true, .count = 3, .maximum = 1},
};

static const assay_gltf_rule ward_rules[] = {
    {.member = "brdf", .kind = ASSAY_GLTF_WORD, .required = true, .what = "ward"},
    {.member   = "alpha",
     .kind     = ASSAY_GLTF_NUMBERS,
     .required = true,
     .count    = 2,
     .minimum  = 1e-3,
     .maximum  = 1},
    {.member = "diffuse", .kind = ASSAY_GLTF_NUMBERS, .count = 3, .maximum = 1},
    {.member = "specular", .kind = ASSAY_GLTF_NUMBERS, .required = true, .count = 3, .maximum = 1},
    {.member = "variant", .kind = ASSAY_GLTF_WORD, .what = "published|corrected"},
};

#define TYPE(name, rules)                                                                          \
    {                                                                                              \
        name, rules, COUNT_OF(rules), false                                                        \
    }
#define STRICT_TYPE(name, rules)                                                                   \
    {                                                                                              \
        name, rules, COUNT_OF(rules), true                                                         \
    }

static const assay_gltf_type types[] = {
    TYPE("root", root_rules),
    TYPE("asset", asset_rules),
    TYPE("scene", scene_rules),
    TYPE("node", node_rules),
    TYPE("node.KHR_lights_punctual", node_light_rules),
    TYPE("mesh", mesh_rules),
    TYPE("primitive", primitive_rules),
    TYPE("accessor", accessor_rules),
    TYPE("sparse", sparse_rules),
    TYPE("sparse indices", sparse_indices_rules),
    TYPE("sparse values", sparse_values_rules),
    TYPE("bufferView", buffer_view_rules),
    TYPE("buffer", buffer_rules),
    TYPE("texture", texture_rules),
    TYPE("image", image_rules),
    TYPE("sampler", sampler_rules),
    TYPE("skin", skin_rules),
    TYPE("camera", camera_rules),
    TYPE("perspective", perspective_rules),
    TYPE("orthographic", orthographic_rules),
    TYPE("animation", animation_rules),
    TYPE("channel", channel_rules),
    TYPE("target", target_rules),
    TYPE("animation sampler", animation_sampler_rules),
    TYPE("material", material_rules),
    TYPE("pbrMetallicRoughness", pbr_rules),
    TYPE("textureInfo", texture_info_rules),
    TYPE("textureInfo.KHR_texture_transform", texture_transform_rules),
    TYPE("material.KHR_materials_emissive_strength", emissive_strength_rules),
    TYPE("material.KHR_materials_ior", ior_rules),
    TYPE("material.KHR_materials_specular", specular_rules),
    TYPE("material.KHR_materials_transmission", transmission_rules),
    TYPE("material.KHR_materials_volume", volume_rules),
    {"material.KHR_materials_unlit", NULL, 0, false},
    TYPE("root.KHR_lights_punctual", lights_rules),
    TYPE("light", light_rules),
    TYPE("spot", spot_rules),
    TYPE("brdf", brdf_rules),
    STRICT_TYPE("phong", phong_rules),
    STRICT_TYPE("ward", ward_rules),
};

const assay_gltf_type *assay_gltf_find_type(const char *name)
{
    for (int i = 0; i < COUNT_OF(types); i++) {
        if (strcmp(types[i].name, name) == 0) {
            return &types[i];
        }
    }
    return NULL;
}

bool assay_gltf_extension_supported(const char *name)
{
    static const char *const supported[] = {
        "KHR_lights_punctual",    "KHR_materials_emissive_strength", "KHR_materials_ior",
        "KHR_materials_specular", "KHR_materials_transmission",      "KHR_materials_unlit",
        "KHR_materials_volume",   "KHR_mesh_quantization",           "KHR_texture_transform",
    };
    for (int i = 0; i < COUNT_OF(supported); i++) {
        if (strcmp(supported[i], name) == 0) {
            return true;
        }
    }
    return false;
}
