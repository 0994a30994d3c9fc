/* test_gltf_broken.c - a sound file with everything in it, and what happens when one thing of it is
 * not: each case states the status and what the message must name. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "support/gltf_everything.h"
#include "support/gltf_maker.h"

/* The text with the first `find` replaced; fails the test where there is none. */
static char *replace(const char *text, const char *find, const char *with)
{
    const char *at = strstr(text, find);
    if (!at) {
        fail_msg("no '%s' to replace", find);
    }
    char *changed = malloc(strlen(text) + strlen(with) + 1);
    sprintf(changed, "%.*s%s%s", (int)(at - text), text, with, at + strlen(find));
    return changed;
}

static assay_status load(const char *text, char *message, size_t size)
{
    assay_context     *context = gltf_context();
    assay_scene       *scene   = NULL;
    const assay_status status  = gltf_load_text(context, text, &scene);
    snprintf(message, size, "%s", assay_context_error(context));
    if (status == ASSAY_OK) {
        assert_int_equal(assay_scene_set_time(scene, 0.5), ASSAY_OK);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return status;
}

static void test_the_sound_file_loads(void **state)
{
    char *text = gltf_everything(&gltf_sound_content), message[1024];
    (void)state;
    if (load(text, message, sizeof message) != ASSAY_OK) {
        fail_msg("%s", message);
    }
    free(text);
}

/* ---- wrong text ---- */

typedef struct {
    const char  *find, *with;
    assay_status status;
    const char  *message;
} text_case;

#define FORMAT ASSAY_ERR_FORMAT
#define UNSUPPORTED ASSAY_ERR_UNSUPPORTED
#define LIMIT ASSAY_ERR_LIMIT

static const text_case text_cases[] = {
    /* asset and extensions */
    {"\"version\":\"2.0\"", "\"version\":\"1.0\"", UNSUPPORTED, "asset/version: glTF 1.0"},
    {"\"version\":\"2.0\"", "\"version\":\"3.0\"", UNSUPPORTED, "asset/version: glTF 3.0"},
    {"\"version\":\"2.0\"", "\"version\":2", FORMAT, "asset/version"},
    {"\"version\":\"2.0\"", "\"version\":\"2.0\",\"minVersion\":\"2.1\"", UNSUPPORTED, "glTF 2.1"},
    {"\"asset\":{\"version\":\"2.0\"},", "", FORMAT, "asset/version: is missing"},
    {"\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],",
     UNSUPPORTED, "extensionsRequired: KHR_draco_mesh_compression is not supported"},
    {"\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"EXT_meshopt_compression\"],",
     UNSUPPORTED, "EXT_meshopt_compression"},
    {"\"scene\":0,", "\"scene\":0,\"extensionsRequired\":[\"KHR_texture_basisu\"],", UNSUPPORTED,
     "KHR_texture_basisu"},
    {"\"scene\":0,", "\"scene\":0,\"extensionsRequired\":\"KHR_texture_basisu\",", FORMAT,
     "extensionsRequired: must be an array"},
    {"\"scene\":0,", "\"scene\":0,\"extensionsUsed\":[3],", FORMAT, "extensionsUsed/0"},
    {"\"extensions\":{\"KHR_materials_ior\"", "\"extensions\":[],\"x\":{\"KHR_materials_ior\"",
     FORMAT, "materials/0/extensions: must be an object"},
    /* types */
    {"\"mesh\":0,\"skin\":0", "\"mesh\":\"0\",\"skin\":0", FORMAT,
     "nodes/0/mesh: must be an index"},
    {"\"mesh\":0,\"skin\":0", "\"mesh\":0.5,\"skin\":0", FORMAT, "nodes/0/mesh: is 0.5"},
    {"\"mesh\":0,\"skin\":0", "\"mesh\":-1,\"skin\":0", FORMAT, "nodes/0/mesh: is -1"},
    {"\"mesh\":0,\"skin\":0", "\"mesh\":0,\"skin\":null", FORMAT, "nodes/0/skin: must be an index"},
    {"\"name\":\"hips\"", "\"name\":7", FORMAT, "nodes/0/name: must be a string"},
    {"\"rotation\":[0,0,0,1]", "\"rotation\":[0,0,1]", FORMAT, "nodes/1/rotation: must have 4"},
    {"\"rotation\":[0,0,0,1]", "\"rotation\":[0,0,0,\"1\"]", FORMAT, "nodes/1/rotation/3"},
    {"\"rotation\":[0,0,0,1]", "\"rotation\":{\"x\":1}", FORMAT,
     "nodes/1/rotation: must be an arr"},
    {"\"nodes\":[{", "\"nodes\":[7,{", FORMAT, "nodes/0: must be an object"},
    {"\"animations\":[", "\"animations\":7,\"x\":[", FORMAT, "animations: must be an array"},
    {"\"name\":\"hips\",", "\"name\":\"hips\",\"mesh\":1,", FORMAT, "nodes/0/mesh: is given twice"},
    {"\"mode\":4", "\"mode\":7", FORMAT, "meshes/0/primitives/0/mode: is 7"},
    {"\"mode\":4", "\"mode\":\"TRIANGLES\"", FORMAT,
     "meshes/0/primitives/0/mode: must be a number"},
    {"\"magFilter\":9729", "\"magFilter\":9984", FORMAT, "samplers/0/magFilter: is 9984"},
    {"\"magFilter\":9729", "\"wrapS\":1", FORMAT, "samplers/0/wrapS: is 1"},
    {"\"alphaMode\":\"OPAQUE\"", "\"alphaMode\":\"opaque\"", FORMAT, "materials/0/alphaMode"},
    {"\"interpolation\":\"STEP\"", "\"interpolation\":\"SMOOTH\"", FORMAT,
     "animations/0/samplers/2/interpolation: is SMOOTH"},
    {"\"path\":\"translation\"", "\"path\":\"colour\"", FORMAT,
     "animations/0/channels/0/target/path: is colour"},
    {"\"type\":\"perspective\"", "\"type\":\"fisheye\"", FORMAT, "cameras/0/type: is fisheye"},
    {"\"type\":\"perspective\"", "\"type\":\"orthographic\"", FORMAT,
     "cameras/0/orthographic: is missing"},
    {"\"type\":\"spot\"", "\"type\":\"area\"", FORMAT, "lights/0/type: is area"},
    {"\"primitives\":[{\"attributes\":{\"POSITION\":0}", "\"primitives\":[{\"attributes\":[0]",
     FORMAT, "meshes/1/primitives/0/attributes: must be an object"},
    {"\"primitives\":[{\"attributes\":{\"POSITION\":0}", "\"primitives\":[{\"x\":0", FORMAT,
     "meshes/1/primitives/0/attributes: is missing"},
    /* indices out of range */
    {"\"scene\":0", "\"scene\":1", FORMAT, "scene: is 1, but there are 1 scenes"},
    {"\"mesh\":0,\"skin\":0", "\"mesh\":2,\"skin\":0", FORMAT,
     "nodes/0/mesh: is 2, but there are 2"},
    {"\"mesh\":0,\"skin\":0", "\"mesh\":0,\"skin\":1", FORMAT, "nodes/0/skin: is 1"},
    {"\"camera\":0", "\"camera\":4294967296", FORMAT, "nodes/2/camera: is 4.29496"},
    {"\"children\":[2]", "\"children\":[4]", FORMAT, "nodes/1/children/0: is 4"},
    {"\"light\":0", "\"light\":1", FORMAT,
     "KHR_lights_punctual/light: is 1, but there are 1 lights"},
    {"\"indices\":2,\"material\"", "\"indices\":11,\"material\"", FORMAT, "indices: is 11"},
    {"\"material\":0", "\"material\":2", FORMAT, "meshes/0/primitives/0/material: is 2"},
    {"\"NORMAL\":1", "\"NORMAL\":99", FORMAT, "meshes/0/primitives/0/attributes/NORMAL: is 99"},
    {"\"POSITION\":10", "\"POSITION\":11", FORMAT, "meshes/1/primitives/0/targets/0/POSITION"},
    {"\"bufferView\":0,\"componentType\"", "\"bufferView\":10,\"componentType\"", FORMAT,
     "accessors/0/bufferView: is 10"},
    {"\"values\":{\"bufferView\":0}", "\"values\":{\"bufferView\":77}", FORMAT,
     "accessors/10/sparse/values/bufferView"},
    {"\"buffer\":0", "\"buffer\":1", FORMAT, "bufferViews/0/buffer: is 1"},
    {"\"source\":0", "\"source\":1", FORMAT, "textures/0/source: is 1"},
    {"\"sampler\":0}", "\"sampler\":1}", FORMAT, "textures/0/sampler: is 1"},
    {"\"alphaMode\":\"OPAQUE\"",
     "\"emissiveFactor\":[1e200,0,0],\"extensions\":{\"KHR_materials_emissive_strength\":{"
     "\"emissiveStrength\":1e200}},\"x\":{},\"extensionz\":{}",
     FORMAT, "materials/0/extensions: is given twice"},
    {"\"extensions\":{\"KHR_materials_ior\":{\"ior\":1.5}}",
     "\"emissiveFactor\":[1e200,0,0],\"extensions\":{\"KHR_materials_emissive_strength\":{"
     "\"emissiveStrength\":1e200}}",
     FORMAT, "materials/0 (paint): the emission overflows"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":\"3\",\"type\":\"VEC3\"", FORMAT,
     "accessors/0/count: must be a whole number, is a string"},
    {"\"alphaMode\":\"OPAQUE\"", "\"alphaMode\":1", FORMAT, "alphaMode: must be a string"},
    {"\"index\":0", "\"index\":1", FORMAT, "baseColorTexture/index: is 1"},
    {"\"joints\":[1]", "\"joints\":[9]", FORMAT, "skins/0/joints/0: is 9"},
    {"\"inverseBindMatrices\":5", "\"inverseBindMatrices\":50", FORMAT, "inverseBindMatrices"},
    {"\"sampler\":2,\"target\"", "\"sampler\":3,\"target\"", FORMAT,
     "animations/0/channels/2: sampler is 3, but there are 3"},
    {"\"node\":1,\"path\":\"trans", "\"node\":4,\"path\":\"trans", FORMAT, "target/node: is 4"},
    {"\"input\":6,\"output\":7", "\"input\":3,\"output\":7", FORMAT,
     "accessor 3 (input): the components must be float"},
    {"\"input\":6,\"output\":7", "\"input\":6,\"output\":11", FORMAT, "samplers/0/output: is 11"},
    {"\"nodes\":[0,1,3]", "\"nodes\":[0,1,7]", FORMAT, "scenes/0/nodes/2: is 7"},
    /* the graph */
    {"\"children\":[2]", "\"children\":[1]", FORMAT, "nodes/1 (bone): is its own ancestor"},
    {"\"children\":[2]", "\"children\":[2,0]", FORMAT,
     "scenes/0/nodes/0: nodes/0 (hips) is no root"},
    {"\"children\":[2]", "\"children\":[2,2]", FORMAT, "nodes/2 (): is a child of nodes/1 and of"},
    {"\"mesh\":1,\"camera\"", "\"children\":[1],\"mesh\":1,\"camera\"", FORMAT, "its own ancestor"},
    {"\"matrix\":[1", "\"scale\":[1,1,1],\"matrix\":[1", FORMAT,
     "nodes/3 (): has a matrix besides"},
    {"0,0,0,0,1],\"extensions\"", "0,0,0,1,1],\"extensions\"", ASSAY_OK, NULL}, /* a translation */
    {"\"matrix\":[1,0,0,0,", "\"matrix\":[1,0,0,0.5,", FORMAT, "nodes/3 (): the last row"},
    {"\"rotation\":[0,0,0,1]", "\"rotation\":[0,0,0,0]", FORMAT, "nodes/1 (bone): its rotation"},
    {"\"rotation\":[0,0,0,1]", "\"scale\":[1e300,1e300,1e300]", FORMAT, "is not finite"},
    /* accessors and buffers */
    {"\"byteLength\":36", "\"byteLength\":4000", FORMAT,
     "bufferViews/0: bytes 0 to 4000 lie beyond"},
    {"\"byteOffset\":0,", "\"byteOffset\":250,", FORMAT, "bufferViews/0: bytes 250 to 286"},
    {"\"byteOffset\":0,", "\"byteOffset\":4000,", FORMAT, "bufferViews/0: bytes 4000 to 4036"},
    {"\"byteOffset\":0,", "\"byteOffset\":-4,", FORMAT, "bufferViews/0/byteOffset: is -4"},
    {"\"byteOffset\":0,", "\"byteOffset\":99999999999999,", FORMAT, "lie beyond buffers/0"},
    {"\"byteOffset\":0,", "\"byteOffset\":1e15,", FORMAT, "bufferViews/0/byteOffset"},
    {"\"byteLength\":36", "\"byteLength\":0", FORMAT, "bufferViews/0/byteLength: is 0"},
    {"\"byteLength\":36", "\"byteLength\":35", FORMAT,
     "end at byte 36 of bufferViews/0, which has 35"},
    {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":8", FORMAT, "byteStride 8"},
    {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":2", FORMAT, "byteStride: is 2"},
    {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":256", FORMAT, "byteStride: is 256"},
    {"\"byteLength\":36", "\"byteLength\":36,\"byteStride\":16", FORMAT, "end at byte 44"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":4,\"type\":\"VEC3\"", FORMAT, "(POSITION)"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":0,\"type\":\"VEC3\"", FORMAT, "accessors/0/count"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":2147483648,\"type\":\"VEC3\"", LIMIT,
     "accessor 0 (POSITION): has 2147483648 elements"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":99999999999999,\"type\":\"VEC3\"", LIMIT,
     "accessor 0 (POSITION)"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":1e300,\"type\":\"VEC3\"", FORMAT,
     "accessors/0/count"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":3.5,\"type\":\"VEC3\"", FORMAT,
     "accessors/0/count"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":3,\"type\":\"VEC2\"", FORMAT,
     "accessor 0 (POSITION): the type has 2 components, not 3"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":3,\"type\":\"VEC5\"", FORMAT, "accessors/0/type"},
    {"\"count\":3,\"type\":\"VEC3\"", "\"count\":3", FORMAT, "accessors/0/type: is missing"},
    {"\"componentType\":5126", "\"componentType\":5124", FORMAT,
     "accessors/0/componentType: is 5124"},
    {"\"componentType\":5126", "\"componentType\":5130", FORMAT,
     "accessors/0/componentType: is 5130"},
    {"\"componentType\":5126", "\"componentType\":5125", FORMAT, "must not be 32-bit integers"},
    {"\"componentType\":5123", "\"componentType\":5126", FORMAT,
     "accessor 2 (indices): the components must be unsigned integers"},
    {"\"componentType\":5123,\"count\"", "\"componentType\":5122,\"count\"", FORMAT,
     "accessor 2 (indices): the components must be unsigned integers"},
    {"\"componentType\":5121", "\"componentType\":5125", FORMAT, "accessor 3 (JOINTS)"},
    {"\"componentType\":5121", "\"componentType\":5121,\"normalized\":true", FORMAT, "(JOINTS)"},
    {"\"bufferView\":2,\"componentType\":5123,\"count\"", "\"componentType\":5123,\"count\"",
     FORMAT, "accessor[2]"},
    {"\"sparse\":{\"count\":2", "\"sparse\":{\"count\":4", FORMAT,
     "4 sparse elements are more than its 3"},
    {"\"sparse\":{\"count\":2", "\"sparse\":{\"count\":3", ASSAY_OK, NULL}, /* legal */
    {"\"indices\":{\"bufferView\":2,\"componentType\":5123}",
     "\"indices\":{\"bufferView\":2,\"byteOffset\":4,\"componentType\":5123}", FORMAT,
     "2 elements end at byte 8 of bufferViews/2"},
    {"\"indices\":{\"bufferView\":2,\"componentType\":5123}",
     "\"indices\":{\"bufferView\":6,\"componentType\":5125}", FORMAT,
     "sparse index 1 is 1065353216"},
    {"\"indices\":{\"bufferView\":2,\"componentType\":5123}",
     "\"indices\":{\"bufferView\":3,\"componentType\":5121}", FORMAT,
     "sparse index 1 is 0, must rise"},
    {"\"values\":{\"bufferView\":0}", "\"values\":{\"bufferView\":0,\"byteOffset\":13}", FORMAT,
     "end at byte 37 of bufferViews/0"},
    {"\"buffers\":[{\"byteLength\":", "\"buffers\":[{\"byteLength\":9", FORMAT,
     "buffers/0: byteLength is 9"},
    {"\"buffers\":[{", "\"buffers\":[{\"x\":", FORMAT, "line 1"},
    {"\"uri\":\"data:application", "\"urn\":\"data:application", FORMAT,
     "buffers/0: has no uri, and there is no binary chunk"},
    {"\"uri\":\"data:application", "\"uri\":\"daten:application", UNSUPPORTED,
     "buffers/0: the URI"},
    {"\"uri\":\"data:application/octet-stream;base64,", "\"uri\":\"outside.bin\",\"x\":\"",
     ASSAY_ERR_NOT_FOUND, "buffers/0: 'outside.bin' lies outside"},
    /* meshes */
    {"\"indices\":2,\"material\":0,\"mode\":4",
     "\"indices\":2,\"material\":0,\"mode\":4,\"targets\":"
     "[{}]",
     ASSAY_OK, NULL}, /* legal */
    {"\"WEIGHTS_0\":4", "\"WEIGHTS_1\":4", FORMAT, "JOINTS_0 and WEIGHTS_0 must come together"},
    {"\"JOINTS_0\":3,", "", FORMAT, "JOINTS_0 and WEIGHTS_0 must come together"},
    {"\"JOINTS_0\":3,\"WEIGHTS_0\":4", "\"_X\":3", FORMAT, "has no joints for skins/0"},
    {"\"JOINTS_0\":3", "\"JOINTS_0\":3,\"JOINTS_4\":3", UNSUPPORTED, "more than 4 sets of joints"},
    {"\"NORMAL\":1", "\"NORMAL\":7", FORMAT,
     "accessor 7 (NORMAL): has 2 elements, but POSITION has 3"},
    {"\"NORMAL\":1", "\"TEXCOORD_0\":1", FORMAT, "(TEXCOORD_0): the type has 3 components, not 2"},
    {"\"NORMAL\":1", "\"COLOR_0\":3", FORMAT, "(COLOR_0): the components must be float or normal"},
    {"\"NORMAL\":1", "\"NORMAL\":1,\"TANGENT\":1", FORMAT, "(TANGENT)"},
    {"\"NORMAL\":1", "\"NORMAL\":1,\"NORMAL\":1", FORMAT, "attributes/NORMAL: is given twice"},
    {"\"weights\":[0.5]", "\"weights\":[0.5,1]", FORMAT, "meshes/1: has 2 weights for 1 morph"},
    {"\"weights\":[0.25]", "\"weights\":[]", ASSAY_OK, NULL}, /* legal */
    {"\"weights\":[0.25]", "\"weights\":[0.25,1]", FORMAT, "nodes/2 (): has 2 weights for 1 morph"},
    {"\"name\":\"hips\",", "\"weights\":[1],", FORMAT, "nodes/0 (): has 1 weights for 0 morph"},
    {"\"targets\":[{\"POSITION\":10}]", "\"targets\":[{\"POSITION\":7}]", FORMAT,
     "accessor 7 (target POSITION): has 2 elements"},
    {"\"targets\":[{\"POSITION\":10}]}]",
     "\"targets\":[{\"POSITION\":10}]},{\"attributes\":{\"POSITION\":0}}]", FORMAT,
     "meshes/1/primitives/1: has 0 morph targets, the first primitive has 1"},
    /* skins, animations */
    {"\"joints\":[1]", "\"joints\":[]", FORMAT, "skins/0: has no joints"},
    {"\"joints\":[1]", "\"joints\":[1,2]", FORMAT, "has 1 matrices for 2 joints"},
    {"\"joints\":[1],\"inverseBindMatrices\":5", "\"inverseBindMatrices\":5", FORMAT,
     "skins/0/joints: is missing"},
    {"\"inverseBindMatrices\":5", "\"inverseBindMatrices\":4", FORMAT, "accessor 4 (inverseBind"},
    {"\"input\":6,\"output\":7", "\"input\":7,\"output\":7", FORMAT, "accessor 7 (input)"},
    {"\"input\":6,\"output\":7", "\"input\":6,\"output\":8", FORMAT,
     "animations/0/channels/0: accessor 8 (output): the type has 4"},
    {"\"input\":6,\"output\":7", "\"input\":6,\"output\":0", FORMAT, "has 3 elements, must have 2"},
    {"\"output\":8", "\"output\":8,\"interpolation\":\"CUBICSPLINE\"", FORMAT,
     "(output): has 2 elements, must have 6"},
    {"\"node\":1,\"path\":\"trans", "\"node\":3,\"path\":\"trans", FORMAT,
     "nodes/3 () has a matrix, which cannot be animated"},
    {"\"node\":2,\"path\":\"weights\"", "\"node\":0,\"path\":\"weights\"", FORMAT,
     "nodes/0 (hips) has no morph targets"},
    /* materials, textures, cameras, lights */
    {"\"roughnessFactor\":0.5", "\"roughnessFactor\":1.5", FORMAT, "roughnessFactor: is 1.5"},
    {"\"roughnessFactor\":0.5", "\"metallicFactor\":-0.5", FORMAT, "metallicFactor: is -0.5"},
    {"[1,1,1,1]", "[1,1,1]", FORMAT, "baseColorFactor: must have 4 elements, has 3"},
    {"[1,1,1,1]", "[1,1,2,1]", FORMAT, "baseColorFactor/2: is 2, must be in [0, 1]"},
    {"\"ior\":1.5", "\"ior\":0.5", FORMAT, "materials/0 (paint): ior is 0.5"},
    {"\"ior\":1.5", "\"ior\":\"glass\"", FORMAT, "KHR_materials_ior/ior: must be a number"},
    {"\"texCoord\":0", "\"texCoord\":2", UNSUPPORTED, "baseColorTexture reads TEXCOORD_2"},
    {"\"source\":0,\"sampler\":0", "\"sampler\":0", UNSUPPORTED, "textures/0, which has no source"},
    {"\"images\":[{\"uri\"", "\"images\":[{\"bufferView\":0,\"uri\"", FORMAT,
     "images/0: must have eit"},
    {"\"images\":[{\"uri\"", "\"images\":[{\"name\"", FORMAT,
     "images/0: must have either a uri or"},
    {"iVBORw0KGgoAAAANSUhEUgAAAAEAAAAB", "AAAA", UNSUPPORTED, "images/0 ("},
    {"iVBORw0KGgo", "iVBOR!0KGgo", FORMAT, "images/0: a data URI that is not base64"},
    {"\"exponent\":20", "\"exponent\":-1", FORMAT,
     "materials/1 (gloss): extras/assay/exponent: is -1"},
    {"\"exponent\":20", "\"exponents\":20", FORMAT, "exponents: is not known here"},
    {"\"exponent\":20,", "", FORMAT, "extras/assay/exponent: is missing"},
    {"\"brdf\":\"phong\"", "\"brdf\":\"blinn\"", FORMAT, "extras/assay/brdf: is blinn"},
    {"\"brdf\":\"phong\"", "\"brdf\":\"ward\"", FORMAT, "extras/assay/exponent: is not known here"},
    {"\"specular\":[0.5,", "\"specular\":[0.6,", FORMAT,
     "materials/1 (gloss): extras/assay: diffuse 0.5 and specular 0.6 of channel R"},
    {"\"extras\":{\"assay\"", "\"extensions\":{\"KHR_materials_unlit\":{}},\"extras\":{\"assay\"",
     FORMAT, "a BRDF on an unlit material"},
    {"\"yfov\":0.75", "\"yfov\":0", FORMAT, "cameras/0/perspective/yfov: is 0"},
    {"\"yfov\":0.75", "\"yfov\":3.15", FORMAT, "yfov: is 3.15"},
    {"\"znear\":0.1", "\"zfar\":1", FORMAT, "znear: is missing"},
    {"\"intensity\":2", "\"intensity\":-2", FORMAT, "lights/0/intensity: is -2"},
    {"\"intensity\":2", "\"color\":[1e300,1,1],\"intensity\":1e300", FORMAT,
     "lights/0: color * inten"},
    {"\"intensity\":2", "\"range\":0", FORMAT, "lights/0/range: is 0"},
    {"\"innerConeAngle\":0.1", "\"innerConeAngle\":1", FORMAT,
     "lights/0: innerConeAngle 1 must be"},
    {"\"innerConeAngle\":0.1", "\"outerConeAngle\":2", FORMAT, "outerConeAngle: is 2"},
};

static void test_wrong_text(void **state)
{
    char *text = gltf_everything(&gltf_sound_content);
    int   bad = 0, refused = 0;
    (void)state;
    for (size_t i = 0; i < sizeof text_cases / sizeof *text_cases; i++) {
        const text_case *c       = &text_cases[i];
        char            *changed = replace(text, c->find, c->with), message[1024];
        assay_status     status  = load(changed, message, sizeof message);
        const bool as_said = c->message ? status == c->status && strstr(message, c->message) &&
                                              strncmp(message, "test.gltf: ", 11) == 0 &&
                                              !strpbrk(message, "\r\n")
                                        : status == ASSAY_OK;
        if (!as_said) {
            print_error("%s -> %s: status %d, %s\n", c->find, c->with, status, message);
            bad++;
        }
        refused += status != ASSAY_OK;
        free(changed);
    }
    print_message("%d changes of the text were refused\n", refused);
    free(text);
    assert_int_equal(bad, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_sound_file_loads),
        cmocka_unit_test(test_wrong_text),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
