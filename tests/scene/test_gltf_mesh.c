/* test_gltf_mesh.c - topologies, shared and unused vertices, what agrees among attributes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "support/gltf_maker.h"

static const float grid[18] = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0};

/* The scene of one primitive over the six vertices of the grid. */
static assay_scene *load_mode(assay_context *context, int mode, int index_count,
                              const uint16_t *indices)
{
    gltf_maker *maker     = gltf_maker_create();
    const int   positions = gltf_floats(maker, "VEC3", 6, grid);
    if (indices) {
        gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d},\"mode\":%d,\"indices\":%d",
                        positions, mode, gltf_shorts(maker, index_count, indices));
    } else {
        gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d},\"mode\":%d", positions, mode);
    }
    return gltf_load(maker, context);
}

/* ---- topologies: the equations of glTF 2.0, 3.7.2.1 ---- */

typedef void (*topology)(int i, int corner[3]);

static void list_corners(int i, int corner[3])
{
    for (int k = 0; k < 3; k++) {
        corner[k] = 3 * i + k;
    }
}
static void strip_corners(int i, int corner[3])
{
    corner[0] = i;
    corner[1] = i + (1 + i % 2);
    corner[2] = i + (2 - i % 2);
}
static void fan_corners(int i, int corner[3])
{
    corner[0] = i + 1;
    corner[1] = i + 2;
    corner[2] = 0;
}
/* Mutant: a strip whose every second triangle shows its back. */
static void careless_strip_corners(int i, int corner[3])
{
    for (int k = 0; k < 3; k++) {
        corner[k] = i + k;
    }
}
/* Mutant: the fan's centre first, which moves texture coordinates' barycentrics. */
static void careless_fan_corners(int i, int corner[3])
{
    corner[0] = 0;
    corner[1] = i + 1;
    corner[2] = i + 2;
}

/* Whether the world's triangles are those of the topology over the sequence of vertices. */
static bool triangles_agree(int mode, const uint16_t *indices, int count, int triangles,
                            topology expected)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = load_mode(context, mode, count, indices);
    bool           agree   = scene->triangle_count == (uint32_t)triangles;
    for (int i = 0; agree && i < triangles; i++) {
        int corner[3];
        expected(i, corner);
        for (int k = 0; k < 3; k++) {
            const int    vertex = indices ? indices[corner[k]] : corner[k];
            const float *p      = scene->positions + (size_t)scene->indices[3 * i + k] * 3;
            agree               = agree && memcmp(p, grid + 3 * vertex, 12) == 0;
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return agree;
}

static void test_topologies(void **state)
{
    static const uint16_t indices[6] = {5, 3, 4, 2, 1, 0};
    (void)state;
    for (int indexed = 0; indexed < 2; indexed++) {
        const uint16_t *from = indexed ? indices : NULL;
        assert_true(triangles_agree(4, from, 6, 2, list_corners));
        assert_true(triangles_agree(5, from, 6, 4, strip_corners));
        assert_true(triangles_agree(6, from, 6, 4, fan_corners));
        assert_false(triangles_agree(5, from, 6, 4, careless_strip_corners));
        assert_false(triangles_agree(6, from, 6, 4, careless_fan_corners));
    }
}

/* All triangles of the strip look the same way: to -Z, as the grid lies. */
static void test_strip_fronts(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = load_mode(context, 5, 0, NULL);
    (void)state;
    for (uint32_t i = 0; i < scene->triangle_count; i++) {
        assay_vec3 p[3];
        for (int k = 0; k < 3; k++) {
            const float *v = scene->positions + (size_t)scene->indices[3 * i + (uint32_t)k] * 3;
            p[k]           = vec3(v[0], v[1], v[2]);
        }
        const assay_vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
        assert_true(n.z == -1.0);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_points_and_lines_are_told_of(void **state)
{
    (void)state;
    for (int mode = 0; mode < 4; mode++) {
        assay_context *context = gltf_context();
        assay_scene   *scene   = load_mode(context, mode, 0, NULL);
        assert_int_equal(scene->triangle_count, 0);
        assert_string_equal(assay_scene_warning(scene, 0),
                            "meshes/0/primitives/0: points and lines are not rendered");
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

static void test_no_positions_is_told_of(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_mesh(maker, "\"attributes\":{\"NORMAL\":%d}", gltf_floats(maker, "VEC3", 6, grid));
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(scene->triangle_count, 0);
    assert_non_null(strstr(assay_scene_warning(scene, 0), "has no POSITION"));
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- vertices ---- */

static void test_unused_vertices_are_dropped(void **state)
{
    static const uint16_t indices[3] = {5, 1, 3};
    static const uint32_t compact[3] = {2, 0, 1};
    assay_context        *context    = gltf_context();
    gltf_maker           *maker      = gltf_maker_create();
    float                 uv[12];
    (void)state;
    for (int i = 0; i < 12; i++) {
        uv[i] = (float)i;
    }
    const int positions = gltf_floats(maker, "VEC3", 6, grid);
    const int texcoords = gltf_floats(maker, "VEC2", 6, uv);
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d,\"TEXCOORD_0\":%d},\"indices\":%d",
                    positions, texcoords, gltf_shorts(maker, 3, indices));
    assay_scene           *scene = gltf_load(maker, context);
    const assay_primitive *p     = &scene->meshes[0].primitives[0];
    assert_int_equal(p->vertex_count, 3);
    assert_memory_equal(p->indices, compact, sizeof compact);
    for (int k = 0; k < 3; k++) {
        const int old = 2 * k + 1;
        assert_memory_equal(p->positions + 3 * k, grid + 3 * old, 12);
        assert_memory_equal(p->uv[0] + 2 * k, uv + 2 * old, 8);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_instances_share_a_mesh(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    const int mesh = gltf_shown_triangle(maker);
    gltf_add(maker, "nodes", "\"mesh\":%d,\"translation\":[0,0,5]", mesh);
    gltf_add(maker, "nodes", "\"mesh\":%d,\"translation\":[0,0,-5]", mesh);
    assay_scene           *scene = gltf_load(maker, context);
    const assay_scene_info info  = assay_scene_describe(scene);
    assert_int_equal(info.meshes, 1);
    assert_int_equal(info.instances, 3);
    assert_int_equal(info.triangles, 3);
    assert_int_equal(info.vertices, 9);
    for (uint32_t i = 0; i < 3; i++) {
        static const float depth[3] = {0, 5, -5};
        assert_int_equal(scene->triangle_shape[i], i);
        assert_int_equal(scene->shapes[i].node, i);
        assert_int_equal(scene->indices[3 * i], 3 * i);
        assert_true(scene->positions[(size_t)scene->indices[3 * i] * 3 + 2] == depth[i]);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Without normals a mesh is flat, and its tangents are ignored. */
static void test_normals_and_tangents(void **state)
{
    static const float normals[18]  = {0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 0};
    static const float tangents[24] = {3, 0, 0, 1,     3, 0, 0, -1, 3, 0, 0, -0.5f,
                                       3, 0, 0, 0.25f, 3, 0, 0, 1,  3, 0, 0, 1};
    (void)state;
    for (int with_normals = 0; with_normals < 2; with_normals++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        const int      p       = gltf_floats(maker, "VEC3", 6, grid);
        const int      n       = gltf_floats(maker, "VEC3", 6, normals);
        const int      t       = gltf_floats(maker, "VEC4", 6, tangents);
        if (with_normals) {
            gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d}",
                            p, n, t);
        } else {
            gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d,\"TANGENT\":%d}", p, t);
        }
        assay_scene       *scene = gltf_load(maker, context);
        const assay_shape *shape = &scene->shapes[0];
        assert_int_equal(shape->normals != NULL, with_normals);
        assert_int_equal(shape->tangents != NULL, with_normals);
        for (int v = 0; with_normals && v < 6; v++) {
            static const float w[6] = {1, -1, -1, 1, 1, 1};
            assert_true(shape->normals[3 * v + 2] == (v == 5 ? 0.0f : 1.0f));
            assert_true(shape->tangents[4 * v] == 1.0f);
            assert_true(shape->tangents[4 * v + 3] == w[v]);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

static void test_default_material_is_last(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    const int positions = gltf_floats(maker, "VEC3", 6, grid);
    gltf_add(maker, "materials", "\"name\":\"one\"");
    gltf_add(maker, "materials", "\"name\":\"two\"");
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d},\"material\":1", positions);
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d}", positions);
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(scene->material_count, 3);
    assert_int_equal(assay_scene_describe(scene).materials, 2);
    assert_int_equal(scene->shapes[0].material, 1);
    assert_int_equal(scene->shapes[1].material, 2);
    assert_string_equal(scene->materials[2].name, "default");
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_topologies),
        cmocka_unit_test(test_strip_fronts),
        cmocka_unit_test(test_points_and_lines_are_told_of),
        cmocka_unit_test(test_no_positions_is_told_of),
        cmocka_unit_test(test_unused_vertices_are_dropped),
        cmocka_unit_test(test_instances_share_a_mesh),
        cmocka_unit_test(test_normals_and_tangents),
        cmocka_unit_test(test_default_material_is_last),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
