/* test_scene_nodes.c - the graph, transforms, mirrors, cameras, scenes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_build.h"
#include "support/gltf_maker.h"
#include "support/near.h"

static assay_vec3 vertex(const assay_scene *scene, uint32_t index)
{
    const float *p = scene->positions + (size_t)index * 3;
    return vec3(p[0], p[1], p[2]);
}

static void assert_vec_near(assay_vec3 v, assay_vec3 expected, double tolerance)
{
    assert_near(v.x, expected.x, tolerance);
    assert_near(v.y, expected.y, tolerance);
    assert_near(v.z, expected.z, tolerance);
}

/* ---- transforms ---- */

/* T R S with a quarter turn about z: (x, y, z) -> (tx - sy y, ty + sx x, tz + sz z), exact. */
static void test_trs_and_matrix_agree(void **state)
{
    static const float corners[9] = {1, 2, 3, 4, 5, 6, -1, 0, 1};
    (void)state;
    for (int matrix = 0; matrix < 2; matrix++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        const int      p       = gltf_floats(maker, "VEC3", 3, corners);
        const int      mesh =
            gltf_add(maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":%d}}]", p);
        gltf_add(maker, "nodes",
                 matrix ? "\"matrix\":[0,2,0,0, -3,0,0,0, 0,0,4,0, 10,20,30,1],\"mesh\":%d"
                        : "\"translation\":[10,20,30],\"scale\":[2,3,4],"
                          "\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],\"mesh\":%d",
                 mesh);
        assay_scene *scene = gltf_load(maker, context);
        for (uint32_t v = 0; v < 3; v++) {
            const float *c = corners + 3 * v;
            assert_vec_near(vertex(scene, v),
                            vec3(10.0 - 3.0 * c[1], 20.0 + 2.0 * c[0], 30.0 + 4.0 * c[2]),
                            matrix ? 0.0 : 1e-6);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* An unnormalised quaternion is the same rotation; -q is too. */
static void test_quaternions(void **state)
{
    static const char *const same[] = {"[0,0,0.6,0.8]", "[0,0,6,8]", "[0,0,-0.6,-0.8]"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        gltf_shown_triangle(maker);
        gltf_add(maker, "nodes", "\"mesh\":0,\"rotation\":%s", same[i]);
        assay_scene *scene = gltf_load(maker, context);
        /* cos = 0.8^2 - 0.6^2, sin = 2 * 0.6 * 0.8 */
        assert_vec_near(vertex(scene, 4), vec3(0.28, 0.96, 0.0), 1e-7);
        assert_vec_near(vertex(scene, 5), vec3(-0.96, 0.28, 0.0), 1e-7);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* Children listed before their parents; the product runs from the root. */
static void test_hierarchy(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_triangle(maker);
    gltf_add(maker, "nodes", "\"mesh\":0,\"translation\":[1,0,0]");
    gltf_add(maker, "nodes", "\"children\":[1],\"scale\":[2,2,2]");
    gltf_add(maker, "nodes", "\"children\":[2],\"translation\":[0,100,0]");
    assay_scene *scene = gltf_load(maker, context);
    assert_vec_near(vertex(scene, 3), vec3(2.0, 100.0, 0.0), 0.0);
    assert_vec_near(vertex(scene, 4), vec3(4.0, 100.0, 0.0), 0.0);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Half of a coordinate's last place survives: rounding happens once, at the end. */
static void test_rounded_once(void **state)
{
    static const float corners[9] = {1.00000012f, 0, 0, 0, 1, 0, 0, 0, 1};
    assay_context     *context    = gltf_context();
    gltf_maker        *maker      = gltf_maker_create();
    (void)state;
    const int p = gltf_floats(maker, "VEC3", 3, corners);
    const int mesh =
        gltf_add(maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":%d}}]", p);
    gltf_add(maker, "nodes", "\"children\":[1],\"translation\":[-16777216,0,0]");
    gltf_add(maker, "nodes", "\"mesh\":%d,\"translation\":[16777216,0,0]", mesh);
    assay_scene *scene = gltf_load(maker, context);
    assert_true(scene->positions[0] == corners[0]);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- normals ---- */

typedef assay_vec3 (*normal_rule)(const assay_affine *map, assay_vec3 n);

/* The inverse transpose by Cramer's rule, row by row: a second way to the same direction. */
static assay_vec3 inverse_transpose(const assay_affine *a, assay_vec3 n)
{
    const double d    = affine_determinant(a);
    const double m[9] = {a->x.x, a->y.x, a->z.x, a->x.y, a->y.y, a->z.y, a->x.z, a->y.z, a->z.z};
    double       inv[9];
    inv[0] = (m[4] * m[8] - m[5] * m[7]) / d;
    inv[1] = (m[2] * m[7] - m[1] * m[8]) / d;
    inv[2] = (m[1] * m[5] - m[2] * m[4]) / d;
    inv[3] = (m[5] * m[6] - m[3] * m[8]) / d;
    inv[4] = (m[0] * m[8] - m[2] * m[6]) / d;
    inv[5] = (m[2] * m[3] - m[0] * m[5]) / d;
    inv[6] = (m[3] * m[7] - m[4] * m[6]) / d;
    inv[7] = (m[1] * m[6] - m[0] * m[7]) / d;
    inv[8] = (m[0] * m[4] - m[1] * m[3]) / d;
    return vec3_normalize(vec3(inv[0] * n.x + inv[3] * n.y + inv[6] * n.z,
                               inv[1] * n.x + inv[4] * n.y + inv[7] * n.z,
                               inv[2] * n.x + inv[5] * n.y + inv[8] * n.z));
}

/* Mutant: normals moved like points. */
static assay_vec3 like_points(const assay_affine *a, assay_vec3 n)
{
    return vec3_normalize(affine_vector(a, n));
}

static bool normals_agree(normal_rule rule)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float normals[9] = {0, 0, 1, 0.6f, 0, 0.8f, 0.36f, 0.48f, 0.8f};
    assay_context     *context    = gltf_context();
    gltf_maker        *maker      = gltf_maker_create();
    const int          p          = gltf_floats(maker, "VEC3", 3, corners);
    const int          n          = gltf_floats(maker, "VEC3", 3, normals);
    const int          mesh       = gltf_add(
                       maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d}}]", p, n);
    gltf_add(maker, "nodes", "\"mesh\":%d,\"matrix\":[1,2,0,0, 0,3,1,0, -1,0,2,0, 5,6,7,1]", mesh);
    gltf_add(maker, "nodes", "\"mesh\":%d,\"matrix\":[-1,2,0,0, 0,3,1,0, -1,0,2,0, 5,6,7,1]", mesh);
    assay_scene *scene = gltf_load(maker, context);
    bool         agree = true;
    for (uint32_t s = 0; s < 2; s++) {
        const assay_affine *map = &scene->node_worlds[scene->shapes[s].node];
        for (int v = 0; v < 3; v++) {
            const float     *stored = scene->shapes[s].normals + 3 * v;
            const assay_vec3 expected =
                rule(map, vec3(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]));
            const assay_vec3 error = vec3_sub(vec3(stored[0], stored[1], stored[2]), expected);
            agree                  = agree && vec3_length(error) < 1e-6;
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return agree;
}

static void test_normals(void **state)
{
    (void)state;
    assert_true(normals_agree(inverse_transpose));
    assert_false(normals_agree(like_points));
}

/* Flattened to a plane, a mesh keeps the plane's normal although no inverse exists. */
static void test_singular_scale(void **state)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float normals[9] = {0, 0, 1, 0.6f, 0, 0.8f, 0, 0.6f, 0.8f};
    assay_context     *context    = gltf_context();
    gltf_maker        *maker      = gltf_maker_create();
    (void)state;
    const int p    = gltf_floats(maker, "VEC3", 3, corners);
    const int n    = gltf_floats(maker, "VEC3", 3, normals);
    const int mesh = gltf_add(
        maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d}}]", p, n);
    gltf_add(maker, "nodes", "\"mesh\":%d,\"scale\":[2,3,0]", mesh);
    gltf_add(maker, "nodes", "\"mesh\":%d,\"scale\":[0,0,0]", mesh);
    assay_scene *scene = gltf_load(maker, context);
    for (int v = 0; v < 3; v++) {
        assert_true(scene->shapes[0].normals[3 * v + 2] == 1.0f);
        assert_true(scene->shapes[1].normals[3 * v + 2] == 0.0f);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- mirrors ---- */

/* A tetrahedron's fronts look outward and its bitangents follow, mirrored or not. */
static void test_mirrors(void **state)
{
    static const float    corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const uint16_t faces[12]   = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    static const char    *scales[4]   = {"[1,1,1]", "[-1,1,1]", "[-1,-2,1]", "[-1,-2,-3]"};
    (void)state;
    for (int i = 0; i < 4; i++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        const int      p       = gltf_floats(maker, "VEC3", 4, corners);
        const int      f       = gltf_shorts(maker, 12, faces);
        const int      mesh =
            gltf_add(maker, "meshes",
                     "\"primitives\":[{\"attributes\":{\"POSITION\":%d},\"indices\":%d}]", p, f);
        gltf_add(maker, "nodes", "\"mesh\":%d,\"scale\":%s,\"rotation\":[0.5,0.5,0.5,0.5]", mesh,
                 scales[i]);
        assay_scene *scene  = gltf_load(maker, context);
        assay_vec3   centre = {0, 0, 0};
        for (uint32_t v = 0; v < 4; v++) {
            centre = vec3_mad(centre, 0.25, vertex(scene, v));
        }
        assert_int_equal(scene->shapes[0].flipped, i % 2);
        for (uint32_t t = 0; t < 4; t++) {
            const assay_vec3 a = vertex(scene, scene->indices[3 * t]);
            const assay_vec3 b = vertex(scene, scene->indices[3 * t + 1]);
            const assay_vec3 c = vertex(scene, scene->indices[3 * t + 2]);
            const assay_vec3 n = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
            assert_true(vec3_dot(n, vec3_sub(a, centre)) > 0.0);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* Bitangent in the world = map of the bitangent in the mesh. */
static void test_mirrored_tangents(void **state)
{
    static const float corners[9]   = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float normals[9]   = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float tangents[12] = {1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1};
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        const int      p       = gltf_floats(maker, "VEC3", 3, corners);
        const int      n       = gltf_floats(maker, "VEC3", 3, normals);
        const int      t       = gltf_floats(maker, "VEC4", 3, tangents);
        const int      mesh    = gltf_add(maker, "meshes",
                                          "\"primitives\":[{\"attributes\":{\"POSITION\":%d,"
                                                  "\"NORMAL\":%d,\"TANGENT\":%d}}]",
                                          p, n, t);
        gltf_add(maker, "nodes", "\"mesh\":%d,\"rotation\":[0.1,0.2,0.3,0.9],\"scale\":[%d,1,1]",
                 mesh, mirrored ? -1 : 1);
        assay_scene        *scene = gltf_load(maker, context);
        const assay_shape  *s     = &scene->shapes[0];
        const assay_affine *map   = &scene->node_worlds[0];
        const assay_vec3    wn    = vec3(s->normals[0], s->normals[1], s->normals[2]);
        const assay_vec3    wt    = vec3(s->tangents[0], s->tangents[1], s->tangents[2]);
        const assay_vec3    b     = vec3_scale(vec3_cross(wn, wt), s->tangents[3]);
        /* in the mesh: cross(z, x) * -1 = -y */
        assert_vec_near(b, affine_vector(map, vec3(0.0, -1.0, 0.0)), 1e-6);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* ---- depth ---- */

/* A chain of 100000 nodes that each move by 1: no recursion, no loss. */
static void test_deep_chain(void **state)
{
    enum { DEPTH = 100000 };
    assay_context *context = gltf_context();
    char          *text = malloc(DEPTH * 64 + 1024), *p = text;
    assay_scene   *scene = NULL;
    (void)state;
    p += sprintf(p,
                 "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"cameras\":[{"
                 "\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}}],\"nodes\":[");
    for (int i = 0; i < DEPTH; i++) {
        p += sprintf(p, "{\"translation\":[1,0,0],\"children\":[%d]},", i + 1);
    }
    p += sprintf(p, "{\"camera\":0}]}");
    assert_int_equal(gltf_load_text(context, text, &scene), ASSAY_OK);
    assert_true(scene->world_cameras[0].position.x == DEPTH);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    free(text);
}

/* ---- scenes ---- */

static void test_several_scenes(void **state)
{
    (void)state;
    for (int wanted = -1; wanted <= 2; wanted++) {
        assay_context      *context = gltf_context();
        gltf_maker         *maker   = gltf_maker_create();
        assay_scene_options options = assay_scene_options_default();
        assay_scene        *scene   = NULL;
        gltf_shown_triangle(maker);
        gltf_add(maker, "nodes", "\"mesh\":0,\"translation\":[0,0,1]");
        gltf_add(maker, "nodes", "\"mesh\":0,\"translation\":[0,0,2]");
        gltf_add(maker, "nodes", "\"children\":[4]"); /* of no scene, its child neither */
        gltf_add(maker, "nodes", "\"mesh\":0");
        gltf_root(maker, "\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[1,2]}]");
        options.scene_index       = wanted;
        const assay_status status = gltf_load_status(maker, context, &options, &scene);
        if (wanted == 2) {
            assert_int_equal(status, ASSAY_ERR_ARGUMENT);
            assert_string_equal(assay_context_error(context),
                                "test.gltf: scene 2 is asked for, but the file has 2");
        } else {
            assert_int_equal(status, ASSAY_OK);
            assert_int_equal(scene->triangle_count, wanted == 0 ? 1 : 2);
            assert_int_equal(assay_scene_describe(scene).instances, wanted == 0 ? 1 : 2);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

static void test_no_scene_takes_all_nodes(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = NULL;
    (void)state;
    assert_int_equal(gltf_load_text(context,
                                    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"children\":[1]}"
                                    ",{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
                                    "\"POSITION\":0}}]}],\"accessors\":[{\"componentType\":5126,"
                                    "\"count\":3,\"type\":\"VEC3\"}]}",
                                    &scene),
                     ASSAY_OK);
    assert_int_equal(scene->triangle_count, 1);
    assert_non_null(strstr(assay_scene_warning(scene, 0), "no scene"));
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- cameras ---- */

static void test_cameras(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_triangle(maker);
    gltf_add(maker, "cameras",
             "\"type\":\"perspective\",\"name\":\"eye\",\"perspective\":{\"yfov\":0.75,"
             "\"znear\":0.01}");
    gltf_add(maker, "cameras",
             "\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,\"ymag\":3,\"znear\":0,"
             "\"zfar\":10}");
    /* scaled, mirrored and skewed, it still is a right-handed rotation */
    gltf_add(maker, "nodes",
             "\"camera\":1,\"name\":\"node\",\"matrix\":[-2,0,0,0, 1,3,0,0, 0,0,5,0,"
             "7,8,9,1]");
    gltf_add(maker, "nodes",
             "\"camera\":0,\"rotation\":[0,0.7071067811865476,0,0.7071067811865476]");
    gltf_add(maker, "nodes", "\"camera\":1");
    gltf_add(maker, "nodes", "\"camera\":1,\"matrix\":[1,0,0,0, 0,0,1,0, 0,0,1,0, 0,0,0,1]");
    gltf_add(maker, "nodes", "\"camera\":1,\"scale\":[0,0,0]");
    assay_scene        *scene = gltf_load(maker, context);
    const assay_camera *c     = scene->world_cameras;
    assert_int_equal(scene->world_camera_count, 5);
    assert_false(scene->camera_is_made);
    assert_string_equal(assay_scene_camera_name(scene, 0), "node");
    assert_string_equal(assay_scene_camera_name(scene, 1), "eye");
    assert_string_equal(assay_scene_camera_name(scene, 2), "camera 2");
    assert_null(assay_scene_camera_name(scene, 5));
    assert_true(c[0].orthographic && c[0].xmag == 2.0 && c[0].ymag == 3.0);
    assert_vec_near(c[0].position, vec3(7.0, 8.0, 9.0), 0.0);
    assert_vec_near(c[0].forward, vec3(0.0, 0.0, -1.0), 1e-15);
    assert_true(!c[1].orthographic && c[1].yfov == 0.75);
    assert_vec_near(c[1].forward, vec3(-1.0, 0.0, 0.0), 1e-15);
    assert_vec_near(c[1].up, vec3(0.0, 1.0, 0.0), 1e-15);
    assert_vec_near(c[1].right, vec3(0.0, 0.0, -1.0), 1e-15);
    for (int i = 0; i < 5; i++) {
        assert_near(vec3_length(c[i].up), 1.0, 1e-15);
        assert_near(vec3_dot(c[i].up, c[i].forward), 0.0, 1e-15);
        assert_vec_near(vec3_cross(c[i].forward, c[i].up), c[i].right, 1e-15);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Every vertex lies inside of the frustum of a square image of 45 degrees. */
static void test_framing_camera(void **state)
{
    static const char *const matrices[] = {
        "[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]", "[1000,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]",
        "[1,0,0,0, 0,0,1,0, 0,1,0,0, -1e6,0,1e6,1]", "[0,0,0,0, 0,0,0,0, 0,0,0,0, 3,4,5,1]"};
    (void)state;
    for (int i = 0; i < 4; i++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        const int      mesh    = gltf_shown_triangle(maker);
        gltf_add(maker, "nodes", "\"mesh\":%d,\"matrix\":%s", mesh, matrices[i]);
        gltf_root(maker, "\"scenes\":[{\"nodes\":[1]}]");
        assay_scene        *scene = gltf_load(maker, context);
        const assay_camera *c     = &scene->world_cameras[0];
        assert_true(scene->camera_is_made);
        assert_int_equal(assay_scene_describe(scene).cameras, 0);
        assert_near(c->yfov, atan(1.0), 1e-15);
        for (uint32_t v = 0; v < scene->vertex_count; v++) {
            const assay_vec3 d     = vec3_sub(vertex(scene, v), c->position);
            const double     depth = vec3_dot(d, c->forward), edge = depth * tan(0.5 * c->yfov);
            assert_true(depth > 0.0);
            assert_true(fabs(vec3_dot(d, c->right)) <= edge * (1.0 + 1e-9));
            assert_true(fabs(vec3_dot(d, c->up)) <= edge * (1.0 + 1e-9));
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_trs_and_matrix_agree),
        cmocka_unit_test(test_quaternions),
        cmocka_unit_test(test_hierarchy),
        cmocka_unit_test(test_rounded_once),
        cmocka_unit_test(test_normals),
        cmocka_unit_test(test_singular_scale),
        cmocka_unit_test(test_mirrors),
        cmocka_unit_test(test_mirrored_tangents),
        cmocka_unit_test(test_deep_chain),
        cmocka_unit_test(test_several_scenes),
        cmocka_unit_test(test_no_scene_takes_all_nodes),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_framing_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
