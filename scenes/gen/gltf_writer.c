/* gltf_writer.c - the document as it is put together.
 *
 * Invariant: every index handed out is an index into the array of its kind, in the order of the
 * calls; arrays of one kind share one buffer view, so that the JSON stays short. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "writer_document.h"

gltf_document *gltf_create(const char *name, const char *description)
{
    size_t         capacity = 0;
    gltf_document *document = tool_grow(NULL, 0, &capacity, sizeof *document);
    *document               = (gltf_document){.name = name, .description = description};
    return document;
}

void gltf_destroy(gltf_document *document)
{
    if (!document) {
        return;
    }
    for (int v = 0; v < GLTF_VIEW_COUNT; v++) {
        free(document->views[v].bytes);
    }
    free(document->accessors);
    free(document->materials);
    free(document->meshes);
    free(document->nodes);
    free(document->cameras);
    free(document->lights);
    free(document->channels);
    free(document->skins);
    free(document);
}

/* ---- arrays ---- */

static void put_bytes(gltf_view_bytes *view, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++) {
        view->bytes               = tool_grow(view->bytes, view->size, &view->capacity, 1);
        view->bytes[view->size++] = (uint8_t)(value >> (8 * i));
    }
}

static void put_float(gltf_view_bytes *view, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_bytes(view, bits, 4);
}

static gltf_accessor *add_accessor(gltf_document *d, gltf_view view, size_t count, const char *type,
                                   int *index_out)
{
    d->accessors =
        tool_grow(d->accessors, d->accessor_count, &d->accessor_capacity, sizeof *d->accessors);
    gltf_accessor *const a = &d->accessors[d->accessor_count];
    *a         = (gltf_accessor){.view = view, .offset = d->views[view].size, .count = count};
    a->type    = type;
    *index_out = (int)d->accessor_count++;
    return a;
}

/* values: count * components floats. */
static int add_floats(gltf_document *d, gltf_view view, const float *values, size_t count,
                      int components, bool bounds)
{
    static const char *const types[5] = {NULL, "SCALAR", "VEC2", "VEC3", "VEC4"};
    int                      index;
    gltf_accessor *const     a = add_accessor(d, view, count, types[components], &index);
    a->bound_count             = bounds ? components : 0;
    for (size_t i = 0; i < count * (size_t)components; i++) {
        const size_t c = i % (size_t)components;
        const float  v = values[i];
        put_float(&d->views[view], v);
        a->low[c]  = i < (size_t)components || v < a->low[c] ? v : a->low[c];
        a->high[c] = i < (size_t)components || v > a->high[c] ? v : a->high[c];
    }
    return index;
}

/* Negative zero would be another byte and the same place: it is written as zero. */
static float to_float(double value) { return (float)value + 0.0f; }

static int add_vectors(gltf_document *d, const assay_vec3 *vectors, size_t count, bool bounds)
{
    float *const values = malloc((count ? count : 1) * 3 * sizeof *values);
    if (!values) {
        fputs("make_scenes: out of memory\n", stderr);
        exit(1);
    }
    for (size_t i = 0; i < count; i++) {
        values[3 * i]     = to_float(vectors[i].x);
        values[3 * i + 1] = to_float(vectors[i].y);
        values[3 * i + 2] = to_float(vectors[i].z);
    }
    const int index = add_floats(d, GLTF_VIEW_VECTORS, values, count, 3, bounds);
    free(values);
    return index;
}

static int add_indices(gltf_document *d, const uint32_t *indices, size_t count)
{
    int index;
    add_accessor(d, GLTF_VIEW_INDICES, count, "SCALAR", &index)->is_u16 = true;
    for (size_t i = 0; i < count; i++) {
        put_bytes(&d->views[GLTF_VIEW_INDICES], indices[i], 2);
    }
    return index;
}

/* ---- materials, meshes ---- */

gltf_material gltf_lambertian(const char *name, double r, double g, double b)
{
    return (gltf_material){.name              = name,
                           .base_color        = {r, g, b},
                           .roughness         = 1.0,
                           .emissive_strength = 1.0,
                           .ior               = 1.5};
}

int gltf_add_material(gltf_document *d, gltf_material material)
{
    d->materials =
        tool_grow(d->materials, d->material_count, &d->material_capacity, sizeof *d->materials);
    d->materials[d->material_count] = material;
    return (int)d->material_count++;
}

static int push_mesh(gltf_document *d, gltf_mesh mesh)
{
    d->meshes = tool_grow(d->meshes, d->mesh_count, &d->mesh_capacity, sizeof *d->meshes);
    d->meshes[d->mesh_count] = mesh;
    return (int)d->mesh_count++;
}

int gltf_add_mesh(gltf_document *d, const char *name, const solid_mesh *mesh, int material)
{
    if (mesh->vertex_count > 65535) {
        fprintf(stderr, "make_scenes: %s: more vertices than 16-bit indices reach\n", name);
        exit(1);
    }
    gltf_mesh added = {.name = name, .material = material, .normal = -1, .morph = -1, .joints = -1};
    added.position  = add_vectors(d, mesh->positions, mesh->vertex_count, true);
    if (!mesh->flat) {
        added.normal = add_vectors(d, mesh->normals, mesh->vertex_count, false);
    }
    added.indices = add_indices(d, mesh->indices, mesh->index_count);
    return push_mesh(d, added);
}

int gltf_add_mesh_like(gltf_document *d, const char *name, int mesh, int material)
{
    gltf_mesh copy = d->meshes[mesh];
    copy.name      = name;
    copy.material  = material;
    return push_mesh(d, copy);
}

void gltf_add_morph_target(gltf_document *d, int mesh, const assay_vec3 *displacements,
                           size_t count, double weight)
{
    d->meshes[mesh].morph        = add_vectors(d, displacements, count, true);
    d->meshes[mesh].morph_weight = weight;
}

void gltf_bind_to_joints(gltf_document *d, int mesh, const double *weights, size_t count)
{
    int index;
    add_accessor(d, GLTF_VIEW_JOINTS, count, "VEC4", &index)->is_u8 = true;
    for (size_t i = 0; i < count; i++) {
        put_bytes(&d->views[GLTF_VIEW_JOINTS], weights[i] > 0.0 ? 0x0100 : 0, 4);
    }
    d->meshes[mesh].joints = index;
    add_accessor(d, GLTF_VIEW_WEIGHTS, count, "VEC4", &index);
    for (size_t i = 0; i < count; i++) {
        put_float(&d->views[GLTF_VIEW_WEIGHTS], to_float(1.0 - weights[i]));
        put_float(&d->views[GLTF_VIEW_WEIGHTS], to_float(weights[i]));
        put_float(&d->views[GLTF_VIEW_WEIGHTS], 0.0f);
        put_float(&d->views[GLTF_VIEW_WEIGHTS], 0.0f);
    }
    d->meshes[mesh].weights = index;
}

/* ---- nodes, cameras, lights ---- */

gltf_node gltf_node_default(const char *name)
{
    return (gltf_node){.name     = name,
                       .parent   = -1,
                       .mesh     = -1,
                       .camera   = -1,
                       .light    = -1,
                       .skin     = -1,
                       .rotation = {0.0, 0.0, 0.0, 1.0},
                       .axes     = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

int gltf_add_node(gltf_document *d, gltf_node node)
{
    d->nodes = tool_grow(d->nodes, d->node_count, &d->node_capacity, sizeof *d->nodes);
    gltf_stored_node *const stored = &d->nodes[d->node_count];
    stored->node                   = node;
    snprintf(stored->name, sizeof stored->name, "%s", node.name);
    return (int)d->node_count++;
}

int gltf_add_mesh_node(gltf_document *d, const char *name, int mesh, assay_vec3 at)
{
    gltf_node  node  = gltf_node_default(name);
    const bool here  = at.x == 0.0 && at.y == 0.0 && at.z == 0.0;
    node.mesh        = mesh;
    node.transform   = here ? GLTF_IDENTITY : GLTF_TRS;
    node.translation = at;
    return gltf_add_node(d, node);
}

/* The quaternion that takes -Z to `forward` and keeps +Y upwards (seen along forward); straight up
 * or down, -Z of the world is up. */
static void look_rotation(assay_vec3 forward, double q[4])
{
    const assay_vec3 z        = vec3_normalize(vec3_negate(forward));
    const bool       vertical = z.x == 0.0 && z.z == 0.0;
    const assay_vec3 up       = vertical ? vec3(0.0, 0.0, -1.0) : vec3(0.0, 1.0, 0.0);
    const assay_vec3 x = vec3_normalize(vec3_cross(up, z)), y = vec3_cross(z, x);
    /* [shepperd78]: the largest of the four is taken from the diagonal, the others from it. */
    const double diagonal[4] = {1.0 + x.x - y.y - z.z, 1.0 - x.x + y.y - z.z, 1.0 - x.x - y.y + z.z,
                                1.0 + x.x + y.y + z.z};
    const double sums[4][4]  = {{0.0, x.y + y.x, x.z + z.x, y.z - z.y},
                                {x.y + y.x, 0.0, y.z + z.y, z.x - x.z},
                                {x.z + z.x, y.z + z.y, 0.0, x.y - y.x},
                                {y.z - z.y, z.x - x.z, x.y - y.x, 0.0}};
    int          largest     = 3;
    for (int i = 2; i >= 0; i--) {
        largest = diagonal[i] > diagonal[largest] ? i : largest;
    }
    const double twice = sqrt(diagonal[largest]);
    for (int i = 0; i < 4; i++) {
        q[i] = i == largest ? 0.5 * twice : 0.5 * sums[largest][i] / twice;
    }
}

static int add_camera(gltf_document *d, const char *name, gltf_camera camera, assay_vec3 eye,
                      assay_vec3 target)
{
    d->cameras = tool_grow(d->cameras, d->camera_count, &d->camera_capacity, sizeof *d->cameras);
    d->cameras[d->camera_count] = camera;
    gltf_node node              = gltf_node_default(name);
    node.camera                 = (int)d->camera_count++;
    node.transform              = GLTF_TRS;
    node.translation            = eye;
    look_rotation(vec3_sub(target, eye), node.rotation);
    return gltf_add_node(d, node);
}

int gltf_add_perspective(gltf_document *d, const char *name, double yfov, assay_vec3 eye,
                         assay_vec3 target)
{
    return add_camera(d, name, (gltf_camera){.name = name, .yfov = yfov}, eye, target);
}

int gltf_add_orthographic(gltf_document *d, const char *name, double xmag, double ymag,
                          assay_vec3 eye, assay_vec3 target)
{
    return add_camera(d, name, (gltf_camera){.name = name, .xmag = xmag, .ymag = ymag}, eye,
                      target);
}

int gltf_add_sun(gltf_document *d, const char *name, const double color[3], double intensity,
                 assay_vec3 direction)
{
    d->lights = tool_grow(d->lights, d->light_count, &d->light_capacity, sizeof *d->lights);
    d->lights[d->light_count] =
        (gltf_light){.name = name, .color = {color[0], color[1], color[2]}, .intensity = intensity};
    gltf_node node = gltf_node_default(name);
    node.light     = (int)d->light_count++;
    node.transform = GLTF_TRS;
    look_rotation(direction, node.rotation);
    return gltf_add_node(d, node);
}

/* ---- animation ---- */

static const int path_width[4] = {3, 4, 3, 1};

void gltf_add_channel(gltf_document *d, int node, gltf_path path, gltf_interpolation interpolation,
                      const float *times, size_t key_count, const float *values)
{
    const size_t count  = key_count * (interpolation == GLTF_CUBICSPLINE ? 3 : 1);
    const int    input  = add_floats(d, GLTF_VIEW_KEYS, times, key_count, 1, true);
    const int    output = add_floats(d, GLTF_VIEW_KEYS, values, count, path_width[path], false);
    d->channels =
        tool_grow(d->channels, d->channel_count, &d->channel_capacity, sizeof *d->channels);
    d->channels[d->channel_count++] = (gltf_channel){node, path, interpolation, input, output};
}

int gltf_add_skin(gltf_document *d, const int *joints, const assay_vec3 *inverse_bind, size_t count)
{
    gltf_skin skin = {.joint_count = count};
    if (count > sizeof skin.joints / sizeof *skin.joints) {
        fputs("make_scenes: more joints than a skin holds\n", stderr);
        exit(1);
    }
    add_accessor(d, GLTF_VIEW_KEYS, count, "MAT4", &skin.inverse_bind);
    for (size_t j = 0; j < count; j++) {
        const assay_vec3 t     = inverse_bind[j];
        const double     m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t.x, t.y, t.z, 1};
        skin.joints[j]         = joints[j];
        for (int i = 0; i < 16; i++) {
            put_float(&d->views[GLTF_VIEW_KEYS], to_float(m[i]));
        }
    }
    d->skins = tool_grow(d->skins, d->skin_count, &d->skin_capacity, sizeof *d->skins);
    d->skins[d->skin_count] = skin;
    return (int)d->skin_count++;
}
