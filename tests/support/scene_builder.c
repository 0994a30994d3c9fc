/* scene_builder.c - one mesh a material; buffers as base64 data URIs. */
#include "scene_builder.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { MAX_MATERIALS = 32 };

typedef struct {
    char  *bytes;
    size_t size, capacity;
} text;

typedef struct {
    float *vertices;        /* 9 a triangle */
    size_t count, capacity; /* triangles */
} soup;

struct scene_builder {
    text materials, nodes, top, cameras;
    int  material_count, node_count, camera_count;
    soup soups[MAX_MATERIALS];
};

static void grow(void **block, size_t *capacity, size_t needed, size_t size)
{
    if (needed > *capacity) {
        *capacity = 2 * needed + 64;
        *block    = realloc(*block, *capacity * size);
        assert_non_null(*block);
    }
}

static void append(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void append(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    grow((void **)&t->bytes, &t->capacity, t->size + (size_t)length + 1, 1);
    va_start(arguments, format);
    vsnprintf(t->bytes + t->size, (size_t)length + 1, format, arguments);
    va_end(arguments);
    t->size += (size_t)length;
}

scene_builder *scene_builder_create(void)
{
    scene_builder *builder = calloc(1, sizeof *builder);
    assert_non_null(builder);
    return builder;
}

int scene_builder_material(scene_builder *builder, const char *json)
{
    assert_true(builder->material_count < MAX_MATERIALS);
    append(&builder->materials, "%s{%s}", builder->material_count ? "," : "", json);
    return builder->material_count++;
}

int scene_builder_diffuse(scene_builder *builder, double reflectance, double emission,
                          bool double_sided)
{
    char json[512];
    snprintf(json, sizeof json,
             "\"doubleSided\":%s,\"emissiveFactor\":[1,1,1],\"pbrMetallicRoughness\":{"
             "\"baseColorFactor\":[%.17g,%.17g,%.17g,1],\"metallicFactor\":0},\"extensions\":{"
             "\"KHR_materials_specular\":{\"specularFactor\":0},"
             "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":%.17g}}",
             double_sided ? "true" : "false", reflectance, reflectance, reflectance, emission);
    return scene_builder_material(builder, json);
}

static void add_triangle(scene_builder *builder, int material, assay_vec3 a, assay_vec3 b,
                         assay_vec3 c)
{
    soup *s = &builder->soups[material];
    grow((void **)&s->vertices, &s->capacity, s->count + 1, 9 * sizeof(float));
    const assay_vec3 corners[3] = {a, b, c};
    for (size_t i = 0; i < 3; i++) {
        s->vertices[9 * s->count + 3 * i]     = (float)corners[i].x;
        s->vertices[9 * s->count + 3 * i + 1] = (float)corners[i].y;
        s->vertices[9 * s->count + 3 * i + 2] = (float)corners[i].z;
    }
    s->count++;
}

void scene_builder_quad(scene_builder *builder, int material, assay_vec3 a, assay_vec3 b,
                        assay_vec3 c, assay_vec3 d)
{
    add_triangle(builder, material, a, b, c);
    add_triangle(builder, material, a, c, d);
}

void scene_builder_box(scene_builder *builder, int material, assay_vec3 low, assay_vec3 high,
                       bool inside)
{
    assay_vec3 v[8];
    for (int i = 0; i < 8; i++) {
        v[i] = vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    }
    /* counter-clockwise from outside */
    static const int FACES[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int f = 0; f < 6; f++) {
        const int *q = FACES[f];
        if (inside) {
            scene_builder_quad(builder, material, v[q[3]], v[q[2]], v[q[1]], v[q[0]]);
        } else {
            scene_builder_quad(builder, material, v[q[0]], v[q[1]], v[q[2]], v[q[3]]);
        }
    }
}

static void subdivide(scene_builder *builder, int material, assay_vec3 centre, double radius,
                      assay_vec3 a, assay_vec3 b, assay_vec3 c, int levels)
{
    if (levels == 0) {
        add_triangle(builder, material, vec3_mad(centre, radius, a), vec3_mad(centre, radius, b),
                     vec3_mad(centre, radius, c));
        return;
    }
    const assay_vec3 ab = vec3_normalize(vec3_add(a, b));
    const assay_vec3 bc = vec3_normalize(vec3_add(b, c));
    const assay_vec3 ca = vec3_normalize(vec3_add(c, a));
    subdivide(builder, material, centre, radius, a, ab, ca, levels - 1);
    subdivide(builder, material, centre, radius, b, bc, ab, levels - 1);
    subdivide(builder, material, centre, radius, c, ca, bc, levels - 1);
    subdivide(builder, material, centre, radius, ab, bc, ca, levels - 1);
}

void scene_builder_sphere(scene_builder *builder, int material, assay_vec3 centre, double radius,
                          int levels)
{
    const double     g        = 0.5 * (1.0 + sqrt(5.0));
    const assay_vec3 v[12]    = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                 {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                 {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    static const int F[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int i = 0; i < 20; i++) {
        subdivide(builder, material, centre, radius, vec3_normalize(v[F[i][0]]),
                  vec3_normalize(v[F[i][1]]), vec3_normalize(v[F[i][2]]), levels);
    }
}

void scene_builder_node(scene_builder *builder, const char *json)
{
    append(&builder->nodes, "%s{%s}", builder->node_count ? "," : "", json);
    builder->node_count++;
}

void scene_builder_top(scene_builder *builder, const char *json)
{
    append(&builder->top, ",%s", json);
}

void scene_builder_camera(scene_builder *builder, assay_vec3 eye, assay_vec3 target, double yfov)
{
    const assay_vec3 back  = vec3_normalize(vec3_sub(eye, target));
    const assay_vec3 right = vec3_normalize(vec3_cross(vec3(0, 1, 0), back));
    const assay_vec3 up    = vec3_cross(back, right);
    char             json[640];
    snprintf(
        json, sizeof json,
        "\"camera\":%d,\"matrix\":[%.17g,%.17g,%.17g,0,%.17g,%.17g,%.17g,0,%.17g,%.17g,%.17g,0,"
        "%.17g,%.17g,%.17g,1]",
        builder->camera_count, right.x, right.y, right.z, up.x, up.y, up.z, back.x, back.y, back.z,
        eye.x, eye.y, eye.z);
    scene_builder_node(builder, json);
    append(&builder->cameras,
           "%s{\"type\":\"perspective\",\"perspective\":{\"yfov\":%.17g,\"znear\":0.01}}",
           builder->camera_count ? "," : "", yfov);
    builder->camera_count++;
}

static void append_base64(text *t, const unsigned char *bytes, size_t count)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    grow((void **)&t->bytes, &t->capacity, t->size + 4 * (count / 3 + 1) + 1, 1);
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t word = (uint32_t)bytes[i] << 16 |
                              (i + 1 < count ? (uint32_t)bytes[i + 1] << 8 : 0) |
                              (i + 2 < count ? (uint32_t)bytes[i + 2] : 0);
        t->bytes[t->size++] = DIGITS[word >> 18];
        t->bytes[t->size++] = DIGITS[word >> 12 & 63];
        t->bytes[t->size++] = i + 1 < count ? DIGITS[word >> 6 & 63] : '=';
        t->bytes[t->size++] = i + 2 < count ? DIGITS[word & 63] : '=';
    }
    t->bytes[t->size] = '\0';
}

static void write_meshes(scene_builder *builder, text *out)
{
    text views = {0}, accessors = {0}, meshes = {0}, buffers = {0};
    int  count = 0;
    for (int m = 0; m < builder->material_count; m++) {
        const soup *s = &builder->soups[m];
        if (s->count == 0) {
            continue;
        }
        float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
        for (size_t i = 0; i < 9 * s->count; i++) {
            low[i % 3]  = fminf(low[i % 3], s->vertices[i]);
            high[i % 3] = fmaxf(high[i % 3], s->vertices[i]);
        }
        const char *comma = count ? "," : "";
        append(&buffers, "%s{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,",
               comma, s->count * 36);
        append_base64(&buffers, (const unsigned char *)s->vertices, s->count * 36);
        append(&buffers, "\"}");
        append(&views, "%s{\"buffer\":%d,\"byteLength\":%zu}", comma, count, s->count * 36);
        append(&accessors,
               "%s{\"bufferView\":%d,\"componentType\":5126,\"type\":\"VEC3\",\"count\":%zu,"
               "\"min\":[%.9g,%.9g,%.9g],\"max\":[%.9g,%.9g,%.9g]}",
               comma, count, s->count * 3, low[0], low[1], low[2], high[0], high[1], high[2]);
        append(&meshes, "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%d},\"material\":%d}]}",
               comma, count, m);
        char node[32];
        snprintf(node, sizeof node, "\"mesh\":%d", count++);
        scene_builder_node(builder, node);
    }
    if (count) {
        append(out, ",\"buffers\":[%s],\"bufferViews\":[%s],\"accessors\":[%s],\"meshes\":[%s]",
               buffers.bytes, views.bytes, accessors.bytes, meshes.bytes);
    }
    free(views.bytes);
    free(accessors.bytes);
    free(meshes.bytes);
    free(buffers.bytes);
}

static void write_file(scene_builder *builder, text *out)
{
    append(out, "{\"asset\":{\"version\":\"2.0\"}");
    write_meshes(builder, out);
    if (builder->material_count) {
        append(out, ",\"materials\":[%s]", builder->materials.bytes);
    }
    if (builder->camera_count) {
        append(out, ",\"cameras\":[%s]", builder->cameras.bytes);
    }
    append(out, "%s", builder->top.bytes ? builder->top.bytes : "");
    if (builder->node_count) {
        append(out, ",\"nodes\":[%s],\"scenes\":[{\"nodes\":[", builder->nodes.bytes);
        for (int i = 0; i < builder->node_count; i++) {
            append(out, "%s%d", i ? "," : "", i);
        }
        append(out, "]}]");
    }
    append(out, "}");
}

assay_scene *scene_builder_load(scene_builder *builder, assay_context *context,
                                const assay_scene_options *options)
{
    text out = {0};
    write_file(builder, &out);
    char      path[] = "/tmp/assay-test-XXXXXX.gltf";
    const int file   = mkstemps(path, 5);
    assert_true(file >= 0);
    assert_int_equal(write(file, out.bytes, out.size), out.size);
    close(file);
    assay_scene       *scene  = NULL;
    const assay_status status = assay_scene_load(context, path, options, &scene);
    unlink(path);
    if (status != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    for (int m = 0; m < MAX_MATERIALS; m++) {
        free(builder->soups[m].vertices);
    }
    free(builder->materials.bytes);
    free(builder->nodes.bytes);
    free(builder->top.bytes);
    free(builder->cameras.bytes);
    free(builder);
    free(out.bytes);
    return scene;
}
