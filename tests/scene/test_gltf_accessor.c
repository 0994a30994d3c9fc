/* test_gltf_accessor.c - every way to store numbers, against the formulas of glTF 2.0, 3.6.2. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/gltf_maker.h"

static const assay_primitive *first_primitive(const assay_scene *scene)
{
    return &scene->meshes[0].primitives[0];
}

/* ---- component types ---- */

/* A component type: nine values of it as bytes, and what each stands for. */
typedef struct {
    int    code, size;
    double largest; /* of the type: what normalized integers are divided by */
    double values[9];
} component;

static const component components[] = {
    {5120, 1, 127.0, {-128, -127, -126, -1, 0, 1, 64, 126, 127}},
    {5121, 1, 255.0, {0, 1, 2, 127, 128, 129, 200, 254, 255}},
    {5122, 2, 32767.0, {-32768, -32767, -32766, -1, 0, 1, 256, 32766, 32767}},
    {5123, 2, 65535.0, {0, 1, 255, 256, 32767, 32768, 40000, 65534, 65535}},
    {5126, 4, 0.0, {-1.5, 0.25, 3e38, -3e-38, 0, 1, 0x1p-149, 7, 0.1f}},
};

/* Signed or not, the low bytes are those of the two's complement. */
static size_t store(const component *c, uint8_t *bytes)
{
    for (int i = 0; i < 9; i++) {
        const int32_t whole = c->code == 5126 ? 0 : (int32_t)c->values[i];
        const float   real  = (float)c->values[i];
        memcpy(bytes + i * c->size, c->code == 5126 ? (const void *)&real : (const void *)&whole,
               (size_t)c->size);
    }
    return 9 * (size_t)c->size;
}

typedef double (*decoder)(const component *c, double value, bool normalized);

static double decode(const component *c, double value, bool normalized)
{
    return normalized && c->code != 5126 ? fmax(value / c->largest, -1.0) : value;
}

/* Mutant: OpenGL's older rule for signed integers. */
static double decode_wrongly(const component *c, double value, bool normalized)
{
    return normalized && c->code != 5126 ? (2.0 * value + 1.0) / (2.0 * c->largest + 1.0) : value;
}

static bool positions_agree(const component *c, bool normalized, decoder expected)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    uint8_t        bytes[36];
    const size_t   count = store(c, bytes);
    const int      view  = gltf_view(maker, bytes, count, 0);
    const int      accessor =
        gltf_add(maker, "accessors",
                 "\"bufferView\":%d,\"componentType\":%d,\"normalized\":%s,\"count\":3,"
                 "\"type\":\"VEC3\"",
                 view, c->code, normalized ? "true" : "false");
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d}", accessor);
    assay_scene *scene = gltf_load(maker, context);
    bool         agree = true;
    for (int i = 0; i < 9; i++) {
        const float value = first_primitive(scene)->positions[i];
        agree             = agree && value == (float)expected(c, c->values[i], normalized);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return agree;
}

static void test_component_types(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof components / sizeof *components; i++) {
        assert_true(positions_agree(&components[i], false, decode));
        if (components[i].code != 5126) {
            assert_true(positions_agree(&components[i], true, decode));
            assert_false(positions_agree(&components[i], true, decode_wrongly));
        }
    }
}

static void test_index_types(void **state)
{
    static const uint32_t wanted[6]   = {2, 0, 1, 1, 0, 3};
    static const float    corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    (void)state;
    for (int size = 1; size <= 4; size *= 2) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        uint8_t        bytes[24];
        for (int i = 0; i < 6; i++) {
            memcpy(bytes + i * size, &wanted[i], (size_t)size);
        }
        const int positions = gltf_floats(maker, "VEC3", 4, corners);
        const int view      = gltf_view(maker, bytes, 6 * (size_t)size, 0);
        const int indices =
            gltf_add(maker, "accessors",
                     "\"bufferView\":%d,\"componentType\":%d,\"count\":6,\"type\":\"SCALAR\"", view,
                     size == 1   ? 5121
                     : size == 2 ? 5123
                                 : 5125);
        gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d},\"indices\":%d", positions,
                        indices);
        assay_scene *scene = gltf_load(maker, context);
        assert_int_equal(scene->triangle_count, 2);
        assert_memory_equal(first_primitive(scene)->indices, wanted, sizeof wanted);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* ---- layouts ---- */

/* Positions and texture coordinates interleaved, behind an offset in the view. */
static void test_strides_and_offsets(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    float          data[2 + 3 * 6];
    (void)state;
    for (int i = 0; i < 20; i++) {
        data[i] = (float)(i * i);
    }
    const int view = gltf_view(maker, data, sizeof data, 24);
    const int position =
        gltf_add(maker, "accessors",
                 "\"bufferView\":%d,\"byteOffset\":8,\"componentType\":5126,\"count\":3,"
                 "\"type\":\"VEC3\"",
                 view);
    const int texcoord =
        gltf_add(maker, "accessors",
                 "\"bufferView\":%d,\"byteOffset\":20,\"componentType\":5126,\"count\":3,"
                 "\"type\":\"VEC2\"",
                 view);
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d,\"TEXCOORD_0\":%d}", position,
                    texcoord);
    assay_scene           *scene = gltf_load(maker, context);
    const assay_primitive *p     = first_primitive(scene);
    for (int v = 0; v < 3; v++) {
        for (int c = 0; c < 3; c++) {
            assert_true(p->positions[3 * v + c] == data[2 + 6 * v + c]);
        }
        for (int c = 0; c < 2; c++) {
            assert_true(p->uv[0][2 * v + c] == data[5 + 6 * v + c]);
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Six vertices, of which the sparse accessor replaces 1 and 4. With or without values below, with
 * every index type, and with vertices that no triangle uses. */
static void check_sparse(bool with_base, int index_size, bool all_used)
{
    static const uint32_t replaced[2] = {1, 4};
    static const float    news[6]     = {100, 101, 102, 103, 104, 105};
    static const uint16_t some[3]     = {0, 4, 5};
    assay_context        *context     = gltf_context();
    gltf_maker           *maker       = gltf_maker_create();
    float                 base[18];
    uint8_t               indices[8];
    char                  below[64] = "";
    for (int i = 0; i < 18; i++) {
        base[i] = (float)(i + 1);
    }
    for (int i = 0; i < 2; i++) {
        memcpy(indices + i * index_size, &replaced[i], (size_t)index_size);
    }
    if (with_base) {
        snprintf(below, sizeof below, "\"bufferView\":%d,", gltf_view(maker, base, sizeof base, 0));
    }
    const int index_view = gltf_view(maker, indices, 2 * (size_t)index_size, 0);
    const int value_view = gltf_view(maker, news, sizeof news, 0);
    const int position   = gltf_add(
          maker, "accessors",
          "%s\"componentType\":5126,\"count\":6,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
            "\"indices\":{\"bufferView\":%d,\"componentType\":%d},\"values\":{\"bufferView\":%d}}",
          below, index_view,
        index_size == 1   ? 5121
          : index_size == 2 ? 5123
                            : 5125,
          value_view);
    if (all_used) {
        gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d}", position);
    } else {
        gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d},\"indices\":%d", position,
                        gltf_shorts(maker, 3, some));
    }
    assay_scene           *scene = gltf_load(maker, context);
    const assay_primitive *p     = first_primitive(scene);
    assert_int_equal(p->vertex_count, all_used ? 6 : 3);
    for (uint32_t v = 0; v < p->vertex_count; v++) {
        const uint32_t old = all_used ? v : some[v];
        for (uint32_t c = 0; c < 3; c++) {
            const float plain    = with_base ? base[3 * old + c] : 0.0f;
            const float expected = old == 1 ? news[c] : old == 4 ? news[3 + c] : plain;
            assert_true(p->positions[3 * v + c] == expected);
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_sparse(void **state)
{
    (void)state;
    for (int size = 1; size <= 4; size *= 2) {
        for (int k = 0; k < 4; k++) {
            check_sparse(k & 1, size, k & 2);
        }
    }
}

static void test_no_view_is_zeros(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    const int zeros =
        gltf_add(maker, "accessors", "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"");
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d}", zeros);
    assay_scene *scene = gltf_load(maker, context);
    for (int i = 0; i < 9; i++) {
        assert_true(first_primitive(scene)->positions[i] == 0.0f);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- attributes with rules of their own ---- */

/* RGB gets alpha 1; floats outside of [0, 1] are clamped. */
static void test_colors(void **state)
{
    static const float    corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float    floats[12] = {-1, 0.5f, 2, 0.25f, 0, 1, 0.75f, 0.125f, 1, 1, 1, 1};
    static const uint16_t shorts[12] = {0, 65535, 13107, 7, 1, 2, 3, 4, 5, 6, 7, 8};
    (void)state;
    for (int rows = 3; rows <= 4; rows++) {
        for (int use_floats = 0; use_floats < 2; use_floats++) {
            assay_context *context   = gltf_context();
            gltf_maker    *maker     = gltf_maker_create();
            const int      positions = gltf_floats(maker, "VEC3", 3, corners);
            const int      view      = gltf_view(maker, use_floats ? (const void *)floats : shorts,
                                       use_floats ? sizeof floats : sizeof shorts, 0);
            const int      colors =
                gltf_add(maker, "accessors",
                         "\"bufferView\":%d,\"componentType\":%d,\"normalized\":%s,\"count\":3,"
                         "\"type\":\"VEC%d\"",
                         view, use_floats ? 5126 : 5123, use_floats ? "false" : "true", rows);
            gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d,\"COLOR_0\":%d}", positions,
                            colors);
            assay_scene *scene = gltf_load(maker, context);
            for (int v = 0; v < 3; v++) {
                for (int c = 0; c < 4; c++) {
                    const double stored =
                        use_floats ? floats[v * rows + c < 12 ? v * rows + c : 0]
                                   : shorts[v * rows + c < 12 ? v * rows + c : 0] / 65535.0;
                    const double expected = c >= rows ? 1.0 : fmin(fmax(stored, 0.0), 1.0);
                    assert_true(first_primitive(scene)->colors[4 * v + c] == (float)expected);
                }
            }
            assay_scene_destroy(scene);
            assay_context_destroy(context);
        }
    }
}

static void test_both_texture_coordinates(void **state)
{
    static const float   corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float   first[6]   = {0, 1, -2, 3.5f, 4, 5};
    static const uint8_t second[12] = {0, 255, 0, 0, 51, 102, 0, 0, 1, 2, 0, 0};
    assay_context       *context    = gltf_context();
    gltf_maker          *maker      = gltf_maker_create();
    (void)state;
    const int positions = gltf_floats(maker, "VEC3", 3, corners);
    const int uv0       = gltf_floats(maker, "VEC2", 3, first);
    const int view      = gltf_view(maker, second, sizeof second, 4);
    const int uv1       = gltf_add(maker, "accessors",
                                   "\"bufferView\":%d,\"componentType\":5121,\"normalized\":true,"
                                         "\"count\":3,\"type\":\"VEC2\"",
                                   view);
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d,\"TEXCOORD_0\":%d,\"TEXCOORD_1\":%d}",
                    positions, uv0, uv1);
    assay_scene           *scene = gltf_load(maker, context);
    const assay_primitive *p     = first_primitive(scene);
    assert_memory_equal(p->uv[0], first, sizeof first);
    for (int i = 0; i < 6; i++) {
        assert_true(p->uv[1][i] == (float)(second[i / 2 * 4 + i % 2] / 255.0));
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_component_types),          cmocka_unit_test(test_index_types),
        cmocka_unit_test(test_strides_and_offsets),      cmocka_unit_test(test_sparse),
        cmocka_unit_test(test_no_view_is_zeros),         cmocka_unit_test(test_colors),
        cmocka_unit_test(test_both_texture_coordinates),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
