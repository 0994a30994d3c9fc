/* own_gltf.c - JSON to triangles, with every step checked. */
#include "own_gltf.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "temporary.h"

static void *tool_alloc(size_t bytes)
{
    void *const memory = malloc(bytes ? bytes : 1);
    assert_non_null(memory);
    return memory;
}

/* ---- looking into the document ---- */

static const cJSON *at(const cJSON *json, const char *array, int index)
{
    return cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, array), index);
}

static int count_of(const cJSON *json, const char *array)
{
    return cJSON_GetArraySize(cJSON_GetObjectItemCaseSensitive(json, array));
}

static double number(const cJSON *object, const char *key, double absent)
{
    const cJSON *const item = cJSON_GetObjectItemCaseSensitive(object, key);
    return cJSON_IsNumber(item) ? item->valuedouble : absent;
}

static int integer(const cJSON *object, const char *key) { return (int)number(object, key, -1.0); }

static const cJSON *primitive_of(const cJSON *mesh)
{
    return cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(mesh, "primitives"), 0);
}

static int attribute(const cJSON *primitive, const char *name)
{
    return integer(cJSON_GetObjectItemCaseSensitive(primitive, "attributes"), name);
}

static size_t element_size(const cJSON *accessor)
{
    static const struct {
        const char *type;
        size_t      components;
    } types[5] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const char *const type =
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(accessor, "type"));
    const int component = integer(accessor, "componentType");
    for (int i = 0; type && i < 5; i++) {
        if (strcmp(type, types[i].type) == 0) {
            return types[i].components * (component == 5126 ? 4 : component == 5123 ? 2 : 1);
        }
    }
    return 0;
}

static const uint8_t *accessor_bytes(const cJSON *json, const uint8_t *bin, int index)
{
    const cJSON *const a = at(json, "accessors", index);
    return bin + integer(at(json, "bufferViews", integer(a, "bufferView")), "byteOffset") +
           integer(a, "byteOffset");
}

static float float_at(const uint8_t *bytes, size_t index)
{
    float value;
    memcpy(&value, bytes + 4 * index, sizeof value);
    return value;
}

static uint32_t index_at(const uint8_t *bytes, size_t index)
{
    return (uint32_t)bytes[2 * index] | (uint32_t)bytes[2 * index + 1] << 8;
}

/* ---- defects ---- */

static const char *buffer_defect(const cJSON *json, size_t bin_size)
{
    if (count_of(json, "buffers") != 1 ||
        number(at(json, "buffers", 0), "byteLength", -1.0) != (double)bin_size) {
        return "buffer length";
    }
    for (int i = 0; i < count_of(json, "bufferViews"); i++) {
        const cJSON *const view = at(json, "bufferViews", i);
        if (integer(view, "byteOffset") < 0 || integer(view, "byteLength") <= 0 ||
            (size_t)integer(view, "byteOffset") + (size_t)integer(view, "byteLength") > bin_size) {
            return "buffer view outside the buffer";
        }
    }
    for (int i = 0; i < count_of(json, "accessors"); i++) {
        const cJSON *const a    = at(json, "accessors", i);
        const cJSON *const view = at(json, "bufferViews", integer(a, "bufferView"));
        const size_t       size = element_size(a);
        if (!view || size == 0 || integer(a, "count") < 1 || integer(a, "byteOffset") < 0 ||
            (size_t)integer(a, "byteOffset") + size * (size_t)integer(a, "count") >
                (size_t)integer(view, "byteLength")) {
            return "accessor outside its view";
        }
    }
    return NULL;
}

static const char *positions_defect(const cJSON *accessor, const uint8_t *bytes)
{
    const size_t count = (size_t)integer(accessor, "count");
    for (int c = 0; c < 3; c++) {
        float low = INFINITY, high = -INFINITY;
        for (size_t v = 0; v < count; v++) {
            const float x = float_at(bytes, 3 * v + (size_t)c);
            if (!isfinite(x)) {
                return "position not finite";
            }
            low  = x < low ? x : low;
            high = x > high ? x : high;
        }
        const cJSON *const min =
            cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(accessor, "min"), c);
        const cJSON *const max =
            cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(accessor, "max"), c);
        if (!min || !max || (float)min->valuedouble != low || (float)max->valuedouble != high) {
            return "bounds of positions";
        }
    }
    return NULL;
}

static const char *mesh_defect(const cJSON *json, const uint8_t *bin, const cJSON *mesh)
{
    const cJSON *const p        = primitive_of(mesh);
    const int          position = attribute(p, "POSITION"), indices = integer(p, "indices");
    const cJSON *const points = at(json, "accessors", position);
    const cJSON *const list   = at(json, "accessors", indices);
    if (!points || !list || integer(list, "componentType") != 5123 ||
        integer(list, "count") % 3 != 0 || !at(json, "materials", integer(p, "material"))) {
        return "references of a primitive";
    }
    const int normal = attribute(p, "NORMAL");
    if (normal >= 0 &&
        integer(at(json, "accessors", normal), "count") != integer(points, "count")) {
        return "count of normals";
    }
    const uint8_t *const bytes = accessor_bytes(json, bin, indices);
    for (size_t i = 0; i < (size_t)integer(list, "count"); i++) {
        if (index_at(bytes, i) >= (uint32_t)integer(points, "count")) {
            return "vertex index";
        }
    }
    return positions_defect(points, accessor_bytes(json, bin, position));
}

static const char *node_defect(const cJSON *json, const cJSON *node)
{
    static const char *const keys[3]   = {"mesh", "camera", "skin"};
    static const char *const arrays[3] = {"meshes", "cameras", "skins"};
    for (int k = 0; k < 3; k++) {
        if (cJSON_HasObjectItem(node, keys[k]) && !at(json, arrays[k], integer(node, keys[k]))) {
            return "reference of a node";
        }
    }
    const cJSON *const q       = cJSON_GetObjectItemCaseSensitive(node, "rotation");
    double             squares = 0.0;
    for (int i = 0; q && i < 4; i++) {
        const double x = cJSON_GetArrayItem(q, i)->valuedouble;
        squares += x * x;
    }
    return q && fabs(squares - 1.0) > 1e-8 ? "rotation that is not a unit quaternion" : NULL;
}

const char *own_gltf_defect(const cJSON *json, const uint8_t *bin, size_t bin_size)
{
    const char *defect = buffer_defect(json, bin_size);
    for (int i = 0; !defect && i < count_of(json, "meshes"); i++) {
        defect = mesh_defect(json, bin, at(json, "meshes", i));
    }
    for (int i = 0; !defect && i < count_of(json, "nodes"); i++) {
        defect = node_defect(json, at(json, "nodes", i));
    }
    return defect;
}

/* ---- reading ---- */

static float *read_vectors(const own_gltf *scene, int accessor, size_t count)
{
    const uint8_t *const bytes = accessor_bytes(scene->json, scene->bin, accessor);
    float *const         out   = tool_alloc(3 * count * sizeof *out);
    for (size_t i = 0; i < 3 * count; i++) {
        out[i] = float_at(bytes, i);
    }
    return out;
}

static own_mesh read_mesh(const own_gltf *scene, const cJSON *json)
{
    const cJSON *const p       = primitive_of(json);
    const int          indices = integer(p, "indices"), position = attribute(p, "POSITION");
    own_mesh           mesh = {0};
    snprintf(mesh.name, sizeof mesh.name, "%s",
             cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(json, "name")));
    mesh.vertex_count   = (size_t)integer(at(scene->json, "accessors", position), "count");
    mesh.triangle_count = (size_t)integer(at(scene->json, "accessors", indices), "count") / 3;
    mesh.positions      = read_vectors(scene, position, mesh.vertex_count);
    if (attribute(p, "NORMAL") >= 0) {
        mesh.normals = read_vectors(scene, attribute(p, "NORMAL"), mesh.vertex_count);
    }
    const uint8_t *const bytes = accessor_bytes(scene->json, scene->bin, indices);
    mesh.indices               = tool_alloc(3 * mesh.triangle_count * sizeof *mesh.indices);
    for (size_t i = 0; i < 3 * mesh.triangle_count; i++) {
        mesh.indices[i] = index_at(bytes, i);
    }
    return mesh;
}

own_gltf own_gltf_read(const char *root, const char *name)
{
    own_gltf scene = {0};
    char     path[512];
    size_t   size;
    snprintf(path, sizeof path, "%s/%s/%s.gltf", root, name, name);
    uint8_t *const text = temporary_read(path, &size);
    scene.json          = cJSON_ParseWithLength((const char *)text, size);
    free(text);
    assert_non_null(scene.json);
    snprintf(path, sizeof path, "%s/%s/%s.bin", root, name, name);
    scene.bin                = temporary_read(path, &scene.bin_size);
    const char *const defect = own_gltf_defect(scene.json, scene.bin, scene.bin_size);
    if (defect) {
        fail_msg("%s: %s", name, defect);
    }
    scene.mesh_count = count_of(scene.json, "meshes");
    scene.meshes     = tool_alloc((size_t)scene.mesh_count * sizeof *scene.meshes);
    for (int i = 0; i < scene.mesh_count; i++) {
        scene.meshes[i] = read_mesh(&scene, at(scene.json, "meshes", i));
    }
    return scene;
}

void own_mesh_release(own_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->indices);
    *mesh = (own_mesh){0};
}

void own_gltf_release(own_gltf *scene)
{
    for (int i = 0; i < scene->mesh_count; i++) {
        own_mesh_release(&scene->meshes[i]);
    }
    free(scene->meshes);
    free(scene->bin);
    cJSON_Delete(scene->json);
    *scene = (own_gltf){0};
}

const own_mesh *own_gltf_mesh(const own_gltf *scene, const char *name)
{
    for (int i = 0; i < scene->mesh_count; i++) {
        if (strcmp(scene->meshes[i].name, name) == 0) {
            return &scene->meshes[i];
        }
    }
    fail_msg("no mesh named %s", name);
    return NULL;
}

/* ---- world space ---- */

/* Rows of an affine transform. */
typedef struct {
    double m[3][4];
} affine;

static double component(const cJSON *array, int index, double absent)
{
    const cJSON *const item = cJSON_GetArrayItem(array, index);
    return item ? item->valuedouble : absent;
}

static affine node_transform(const cJSON *node)
{
    const cJSON *const matrix = cJSON_GetObjectItemCaseSensitive(node, "matrix");
    const cJSON *const shift  = cJSON_GetObjectItemCaseSensitive(node, "translation");
    affine             t      = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; matrix && column < 4; column++) {
            t.m[row][column] = component(matrix, 4 * column + row, 0.0);
        }
        if (shift) {
            t.m[row][3] = component(shift, row, 0.0);
        }
    }
    return t;
}

static void put_point(own_mesh *out, size_t vertex, const affine *t, const float *p)
{
    for (int row = 0; row < 3; row++) {
        out->positions[3 * vertex + (size_t)row] =
            (float)(t->m[row][0] * (double)p[0] + t->m[row][1] * (double)p[1] +
                    t->m[row][2] * (double)p[2] + t->m[row][3]);
    }
}

static own_mesh empty_soup(size_t triangles)
{
    own_mesh mesh  = {.name = "soup", .vertex_count = 3 * triangles};
    mesh.positions = tool_alloc(9 * triangles * sizeof *mesh.positions);
    mesh.indices   = tool_alloc(3 * triangles * sizeof *mesh.indices);
    return mesh;
}

static void append(own_mesh *soup, const own_mesh *mesh, const affine *t)
{
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const size_t at_vertex   = 3 * soup->triangle_count + i;
        soup->indices[at_vertex] = (uint32_t)at_vertex;
        put_point(soup, at_vertex, t, mesh->positions + 3 * (size_t)mesh->indices[i]);
    }
    soup->triangle_count += mesh->triangle_count;
}

/* A skinned mesh stands where its first joint does. */
static const cJSON *placing_node(const cJSON *json, const cJSON *node)
{
    const cJSON *const skin = at(json, "skins", integer(node, "skin"));
    const cJSON *const first =
        cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(skin, "joints"), 0);
    return first ? at(json, "nodes", first->valueint) : node;
}

own_mesh own_gltf_flatten(const own_gltf *scene)
{
    size_t triangles = 0;
    for (int i = 0; i < count_of(scene->json, "nodes"); i++) {
        const int mesh = integer(at(scene->json, "nodes", i), "mesh");
        triangles += mesh >= 0 ? scene->meshes[mesh].triangle_count : 0;
    }
    own_mesh soup = empty_soup(triangles);
    for (int i = 0; i < count_of(scene->json, "nodes"); i++) {
        const cJSON *const node = at(scene->json, "nodes", i);
        if (integer(node, "mesh") >= 0) {
            const affine t = node_transform(placing_node(scene->json, node));
            append(&soup, &scene->meshes[integer(node, "mesh")], &t);
        }
    }
    return soup;
}

own_mesh own_gltf_join(const own_gltf *scene, const char *const *names, int count)
{
    const affine identity  = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    size_t       triangles = 0;
    for (int i = 0; i < count; i++) {
        triangles += own_gltf_mesh(scene, names[i])->triangle_count;
    }
    own_mesh soup = empty_soup(triangles);
    for (int i = 0; i < count; i++) {
        append(&soup, own_gltf_mesh(scene, names[i]), &identity);
    }
    return soup;
}
