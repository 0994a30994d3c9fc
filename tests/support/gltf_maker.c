/* gltf_maker.c - arrays of the root as growing texts, one buffer as growing bytes. */
#include "support/gltf_maker.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_build.h"

enum { MAX_ARRAYS = 20, MAX_NODES = 256 };

typedef struct {
    char  *bytes;
    size_t size, capacity;
} text;

typedef struct {
    char name[32];
    text objects;
    int  count;
} array;

struct gltf_maker {
    array arrays[MAX_ARRAYS];
    int   array_count;
    text  root, buffer;
};

static void append_bytes(text *t, const void *bytes, size_t count)
{
    if (t->size + count + 1 > t->capacity) {
        t->capacity = 2 * (t->size + count) + 256;
        t->bytes    = realloc(t->bytes, t->capacity);
        assert_non_null(t->bytes);
    }
    memcpy(t->bytes + t->size, bytes, count);
    t->size += count;
    t->bytes[t->size] = 0;
}

static void append_list(text *t, const char *format, va_list arguments)
{
    char   *line = NULL;
    va_list copy;
    va_copy(copy, arguments);
    const int length = vsnprintf(NULL, 0, format, copy);
    va_end(copy);
    line = malloc((size_t)length + 1);
    assert_non_null(line);
    vsnprintf(line, (size_t)length + 1, format, arguments);
    append_bytes(t, line, (size_t)length);
    free(line);
}

static void append(text *t, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void append(text *t, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    append_list(t, format, arguments);
    va_end(arguments);
}

gltf_maker *gltf_maker_create(void)
{
    gltf_maker *maker = calloc(1, sizeof *maker);
    assert_non_null(maker);
    return maker;
}

void gltf_maker_destroy(gltf_maker *maker)
{
    for (int i = 0; i < maker->array_count; i++) {
        free(maker->arrays[i].objects.bytes);
    }
    free(maker->root.bytes);
    free(maker->buffer.bytes);
    free(maker);
}

static array *find_array(gltf_maker *maker, const char *name)
{
    for (int i = 0; i < maker->array_count; i++) {
        if (strcmp(maker->arrays[i].name, name) == 0) {
            return &maker->arrays[i];
        }
    }
    assert_true(maker->array_count < MAX_ARRAYS);
    array *a = &maker->arrays[maker->array_count++];
    snprintf(a->name, sizeof a->name, "%s", name);
    return a;
}

int gltf_add(gltf_maker *maker, const char *name, const char *format, ...)
{
    array  *a = find_array(maker, name);
    va_list arguments;
    append(&a->objects, "%s{", a->count ? ",\n" : "");
    va_start(arguments, format);
    append_list(&a->objects, format, arguments);
    va_end(arguments);
    append(&a->objects, "}");
    return a->count++;
}

void gltf_root(gltf_maker *maker, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    append_list(&maker->root, format, arguments);
    va_end(arguments);
    append(&maker->root, ",");
}

int gltf_view(gltf_maker *maker, const void *bytes, size_t count, int stride)
{
    static const char zeros[4] = {0};
    char              more[32] = "";
    append_bytes(&maker->buffer, zeros, (4 - maker->buffer.size % 4) % 4);
    const size_t offset = maker->buffer.size;
    append_bytes(&maker->buffer, bytes, count);
    if (stride) {
        snprintf(more, sizeof more, ",\"byteStride\":%d", stride);
    }
    return gltf_add(maker, "bufferViews", "\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s",
                    offset, count, more);
}

int gltf_floats(gltf_maker *maker, const char *type, int count, const float *values)
{
    const size_t width = strcmp(type, "SCALAR") == 0 ? 1
                         : strcmp(type, "MAT4") == 0 ? 16
                                                     : (size_t)(type[3] - '0');
    const int    view  = gltf_view(maker, values, (size_t)count * width * sizeof *values, 0);
    return gltf_add(maker, "accessors",
                    "\"bufferView\":%d,\"componentType\":5126,\"count\":%d,\"type\":\"%s\"", view,
                    count, type);
}

int gltf_shorts(gltf_maker *maker, int count, const uint16_t *values)
{
    const int view = gltf_view(maker, values, (size_t)count * sizeof *values, 0);
    return gltf_add(maker, "accessors",
                    "\"bufferView\":%d,\"componentType\":5123,\"count\":%d,\"type\":\"SCALAR\"",
                    view, count);
}

int gltf_shown_mesh(gltf_maker *maker, const char *format, ...)
{
    text    inside = {0};
    va_list arguments;
    va_start(arguments, format);
    append_list(&inside, format, arguments);
    va_end(arguments);
    const int mesh = gltf_add(maker, "meshes", "\"primitives\":[{%s}]", inside.bytes);
    free(inside.bytes);
    return gltf_add(maker, "nodes", "\"mesh\":%d", mesh);
}

int gltf_shown_triangle(gltf_maker *maker)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const int          positions  = gltf_floats(maker, "VEC3", 3, corners);
    const int          mesh =
        gltf_add(maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":%d}}]", positions);
    gltf_add(maker, "nodes", "\"mesh\":%d", mesh);
    return mesh;
}

/* ---- the file ---- */

static void append_base64(text *t, const uint8_t *bytes, size_t count)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < count; i += 3) {
        const uint32_t b1 = i + 1 < count ? bytes[i + 1] : 0, b2 = i + 2 < count ? bytes[i + 2] : 0;
        const uint32_t bits    = (uint32_t)bytes[i] << 16 | b1 << 8 | b2;
        const char     four[4] = {digits[bits >> 18 & 63], digits[bits >> 12 & 63],
                              i + 1 < count ? digits[bits >> 6 & 63] : '=',
                              i + 2 < count ? digits[bits & 63] : '='};
        append_bytes(t, four, 4);
    }
}

/* Scene 0 with every node that no node names as a child. */
static void append_scene(gltf_maker *maker, text *out)
{
    const array *nodes            = find_array(maker, "nodes");
    bool         child[MAX_NODES] = {0};
    const char  *p                = nodes->count ? nodes->objects.bytes : "";
    assert_true(nodes->count <= MAX_NODES);
    while ((p = strstr(p, "\"children\":["))) {
        for (p += 12; *p && *p != ']'; p += *p == ',') {
            child[strtol(p, (char **)&p, 10) % MAX_NODES] = true;
        }
    }
    bool first = true;
    append(out, "\"scenes\":[{\"nodes\":[");
    for (int i = 0; i < nodes->count; i++) {
        if (!child[i]) {
            append(out, "%s%d", first ? "" : ",", i);
            first = false;
        }
    }
    append(out, "]}],");
}

static char *make_text(gltf_maker *maker, bool embed)
{
    text        out  = {0};
    const char *root = maker->root.size ? maker->root.bytes : "";
    append(&out, "{%s", root);
    if (!strstr(root, "\"asset\"")) {
        append(&out, "\"asset\":{\"version\":\"2.0\"},");
    }
    if (!strstr(root, "\"scenes\"") && find_array(maker, "nodes")->count) {
        append_scene(maker, &out);
    }
    if (maker->buffer.size && !find_array(maker, "buffers")->count) {
        append(&out, "\"buffers\":[{\"byteLength\":%zu", maker->buffer.size);
        if (embed) {
            append(&out, ",\"uri\":\"data:application/octet-stream;base64,");
            append_base64(&out, (const uint8_t *)maker->buffer.bytes, maker->buffer.size);
            append(&out, "\"");
        }
        append(&out, "}],");
    }
    for (int i = 0; i < maker->array_count; i++) {
        if (maker->arrays[i].count) {
            append(&out, "\"%s\":[%s],\n", maker->arrays[i].name, maker->arrays[i].objects.bytes);
        }
    }
    append(&out, "\"extras\":null}");
    return out.bytes;
}

char *gltf_text(gltf_maker *maker) { return make_text(maker, true); }

uint8_t *gltf_glb(gltf_maker *maker, size_t *count_out)
{
    char          *json      = make_text(maker, false);
    text           out       = {0};
    const uint32_t json_size = (uint32_t)((strlen(json) + 3) / 4 * 4);
    const uint32_t bin_size  = (uint32_t)((maker->buffer.size + 3) / 4 * 4);
    const uint32_t total     = 12 + 8 + json_size + (bin_size ? 8 + bin_size : 0);
    const uint32_t header[5] = {0x46546C67, 2, total, json_size, 0x4E4F534A};
    append_bytes(&out, header, sizeof header);
    append_bytes(&out, json, strlen(json));
    append_bytes(&out, "   ", json_size - strlen(json));
    if (bin_size) {
        const uint32_t chunk[2] = {bin_size, 0x004E4942};
        append_bytes(&out, chunk, sizeof chunk);
        append_bytes(&out, maker->buffer.bytes, maker->buffer.size);
        append_bytes(&out, "\0\0\0", bin_size - maker->buffer.size);
    }
    free(json);
    *count_out = out.size;
    return (uint8_t *)out.bytes;
}

assay_status gltf_load_status(gltf_maker *maker, assay_context *context,
                              const assay_scene_options *options, assay_scene **scene_out)
{
    char              *json   = gltf_text(maker);
    const assay_status status = assay_scene_load_memory(
        context, (const uint8_t *)json, strlen(json), "test.gltf", NULL, options, scene_out);
    free(json);
    gltf_maker_destroy(maker);
    return status;
}

assay_scene *gltf_load(gltf_maker *maker, assay_context *context)
{
    assay_scene *scene = NULL;
    if (gltf_load_status(maker, context, NULL, &scene) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    return scene;
}

assay_status gltf_load_text(assay_context *context, const char *json, assay_scene **scene_out)
{
    return assay_scene_load_memory(context, (const uint8_t *)json, strlen(json), "test.gltf", NULL,
                                   NULL, scene_out);
}

assay_context *gltf_context(void)
{
    const assay_context_options options = {.threads = 1};
    assay_context              *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    return context;
}
