/* gltf_everything.c - the accessors first, so that their numbers are known. */
#include "support/gltf_everything.h"

#include "support/gltf_maker.h"

const gltf_content gltf_sound_content = {
    .positions = {0, 0, 0, 1, 0, 0, 0, 1, 0},
    .normals   = {0, 0, 1, 0, 0, 1, 0, 0, 1},
    .times     = {0, 1},
    .moves     = {0, 0, 0, 1, 2, 3},
    .turns     = {0, 0, 0, 1, 0, 0, 1, 0},
    .weights   = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
    .bind      = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
    .morph     = {0, 1},
    .indices   = {0, 1, 2},
};

static const char png[] =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmM"
    "IQAAAABJRU5ErkJggg==";

static void add_accessors(gltf_maker *maker, const gltf_content *c)
{
    gltf_floats(maker, "VEC3", 3, c->positions);
    gltf_floats(maker, "VEC3", 3, c->normals);
    gltf_shorts(maker, 3, c->indices);
    gltf_add(maker, "accessors",
             "\"bufferView\":%d,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"",
             gltf_view(maker, c->joints, sizeof c->joints, 0));
    gltf_floats(maker, "VEC4", 3, c->weights);
    gltf_floats(maker, "MAT4", 1, c->bind);
    gltf_floats(maker, "SCALAR", 2, c->times);
    gltf_floats(maker, "VEC3", 2, c->moves);
    gltf_floats(maker, "VEC4", 2, c->turns);
    gltf_floats(maker, "SCALAR", 2, c->morph);
    gltf_add(
        maker, "accessors",
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
        "\"indices\":{\"bufferView\":2,\"componentType\":5123},\"values\":{\"bufferView\":0}}");
}

char *gltf_everything(const gltf_content *c)
{
    gltf_maker *maker = gltf_maker_create();
    add_accessors(maker, c);
    gltf_add(maker, "images", "\"uri\":\"%s\"", png);
    gltf_add(maker, "samplers", "\"magFilter\":9729");
    gltf_add(maker, "textures", "\"source\":0,\"sampler\":0");
    gltf_add(maker, "materials",
             "\"name\":\"paint\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,1],"
             "\"roughnessFactor\":0.5,\"baseColorTexture\":{\"index\":0,\"texCoord\":0}},"
             "\"alphaMode\":\"OPAQUE\",\"extensions\":{\"KHR_materials_ior\":{\"ior\":1.5}}");
    gltf_add(maker, "materials",
             "\"name\":\"gloss\",\"extras\":{\"assay\":{\"brdf\":\"phong\",\"exponent\":20,"
             "\"diffuse\":[0.5,0.5,0.5],\"specular\":[0.5,0.5,0.5]}}");
    gltf_add(maker, "meshes",
             "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"JOINTS_0\":3,"
             "\"WEIGHTS_0\":4},\"indices\":2,\"material\":0,\"mode\":4}]");
    gltf_add(maker, "meshes",
             "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":10}]}],"
             "\"weights\":[0.5]");
    gltf_add(maker, "cameras",
             "\"type\":\"perspective\",\"perspective\":{\"yfov\":0.75,\"znear\":0.1}");
    gltf_add(maker, "nodes", "\"name\":\"hips\",\"mesh\":0,\"skin\":0");
    gltf_add(maker, "nodes", "\"name\":\"bone\",\"rotation\":[0,0,0,1],\"children\":[2]");
    gltf_add(maker, "nodes", "\"mesh\":1,\"camera\":0,\"weights\":[0.25]");
    gltf_add(maker, "nodes",
             "\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],\"extensions\":{"
             "\"KHR_lights_punctual\":{\"light\":0}}");
    gltf_add(maker, "skins", "\"joints\":[1],\"inverseBindMatrices\":5");
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}},"
             "{\"sampler\":1,\"target\":{\"node\":1,\"path\":\"rotation\"}},"
             "{\"sampler\":2,\"target\":{\"node\":2,\"path\":\"weights\"}}],"
             "\"samplers\":[{\"input\":6,\"output\":7},{\"input\":6,\"output\":8},"
             "{\"input\":6,\"output\":9,\"interpolation\":\"STEP\"}]");
    gltf_root(maker, "\"scene\":0,\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{"
                     "\"type\":\"spot\",\"intensity\":2,\"spot\":{\"innerConeAngle\":0.1}}]}}");
    char *text = gltf_text(maker);
    gltf_maker_destroy(maker);
    return text;
}
