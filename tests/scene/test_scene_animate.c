/* test_scene_animate.c - key frames, skins and morph targets at a time, against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* A triangle on node 0 whose `path` one track moves. */
static assay_scene *load_track(assay_context *context, const char *path, const char *interpolation,
                               int keys, const float *times, const char *type, int values,
                               const float *output)
{
    gltf_maker *maker = gltf_maker_create();
    gltf_shown_triangle(maker);
    const int in  = gltf_floats(maker, "SCALAR", keys, times);
    const int out = gltf_floats(maker, type, values, output);
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"%s\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d,\"interpolation\":\"%s\"}]",
             path, in, out, interpolation);
    return gltf_load(maker, context);
}

/* ---- interpolation (glTF 2.0, appendix C) ---- */

static const float times4[4]  = {1.0f, 2.0f, 4.0f, 5.0f};
static const float moves4[12] = {0, 0, 0, 1, 10, 100, 3, -30, 0.5f, 7, 7, 7};

static void test_linear_and_step(void **state)
{
    /* before, on, between and after the keys: which key, and how far to the next */
    static const struct {
        double time, fraction;
        int    key;
    } cases[] = {{-5, 0, 0},     {0, 0, 0},   {1, 0, 0},       {1.25, 0.25, 0}, {2, 0, 1},
                 {2.5, 0.25, 1}, {3, 0.5, 1}, {4.75, 0.75, 2}, {5, 0, 3},       {1e9, 0, 3}};
    (void)state;
    for (int step = 0; step < 2; step++) {
        assay_context *context = gltf_context();
        assay_scene *scene = load_track(context, "translation", step ? "STEP" : "LINEAR", 4, times4,
                                        "VEC3", 4, moves4);
        assert_true(assay_scene_describe(scene).duration == 5.0);
        for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
            const float *a = moves4 + 3 * cases[i].key, *b = a + (cases[i].fraction > 0.0 ? 3 : 0);
            const double s = step ? 0.0 : cases[i].fraction;
            assert_int_equal(assay_scene_set_time(scene, cases[i].time), ASSAY_OK);
            assert_vec_near(
                vertex(scene, 0),
                vec3(a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])),
                1e-6 * 100.0);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* A cubic is its own Hermite spline: x(t) = t^3 - 2 t, tangents x'(t) = 3 t^2 - 2. */
static double cubic(double t) { return t * t * t - 2.0 * t; }

static bool spline_agrees(double tangent_scale)
{
    static const float times[3] = {0.0f, 0.5f, 2.0f};
    assay_context     *context  = gltf_context();
    float              output[27];
    bool               agree = true;
    for (int k = 0; k < 3; k++) {
        const double tangent = tangent_scale * (3.0 * times[k] * times[k] - 2.0);
        for (int c = 0; c < 3; c++) {
            output[9 * k + c]     = (float)(tangent * (c + 1)); /* in  */
            output[9 * k + 3 + c] = (float)(cubic(times[k]) * (c + 1));
            output[9 * k + 6 + c] = (float)(tangent * (c + 1)); /* out */
        }
    }
    assay_scene *scene =
        load_track(context, "translation", "CUBICSPLINE", 3, times, "VEC3", 9, output);
    for (double t = 0.0; t <= 2.0; t += 0.0625) {
        const assay_vec3 x = vec3(cubic(t), 2.0 * cubic(t), 3.0 * cubic(t));
        assert_int_equal(assay_scene_set_time(scene, t), ASSAY_OK);
        agree = agree && vec3_length(vec3_sub(vertex(scene, 0), x)) < 1e-5;
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return agree;
}

static void test_cubic_spline(void **state)
{
    (void)state;
    assert_true(spline_agrees(1.0));
    assert_false(spline_agrees(0.99)); /* mutant: tangents off by a hundredth */
}

/* From angle a to b about z: slerp turns evenly. Vertex 1 is (1, 0, 0). */
static void test_slerp(void **state)
{
    static const double angles[][2] = {{0.0, 2.0},  {0.3, 0.3},       {0.0, 1e-7},
                                       {-1.0, 2.1}, {3.0, 3.0 + 3.1}, {0.5, 0.5 + 1e-3}};
    static const float  times[2]    = {0.0f, 1.0f};
    (void)state;
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        for (int sign = -1; sign <= 1; sign += 2) { /* -q is the same rotation: the short way */
            assay_context *context = gltf_context();
            const double   a = angles[i][0], b = angles[i][1];
            const float    q[8] = {0, 0, (float)sin(0.5 * a),          (float)cos(0.5 * a),
                                   0, 0, (float)(sign * sin(0.5 * b)), (float)(sign * cos(0.5 * b))};
            assay_scene *scene  = load_track(context, "rotation", "LINEAR", 2, times, "VEC4", 2, q);
            for (double t = 0.0; t <= 1.0; t += 0.125) {
                const double angle = a + t * (b - a);
                assert_int_equal(assay_scene_set_time(scene, t), ASSAY_OK);
                assert_vec_near(vertex(scene, 1), vec3(cos(angle), sin(angle), 0.0), 3e-7);
            }
            assay_scene_destroy(scene);
            assay_context_destroy(context);
        }
    }
}

/* Opposite quaternions: any half turn is as short; the result is still a rotation. */
static void test_slerp_opposite(void **state)
{
    static const float times[2] = {0.0f, 1.0f}, q[8] = {0, 0, 0, 1, 0, 0, 1, 0};
    assay_context     *context = gltf_context();
    assay_scene       *scene   = load_track(context, "rotation", "LINEAR", 2, times, "VEC4", 2, q);
    (void)state;
    assert_int_equal(assay_scene_set_time(scene, 0.5), ASSAY_OK);
    assert_near(vec3_length(vertex(scene, 1)), 1.0, 1e-6);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Cubic splines of rotations are normalised afterwards. */
static void test_cubic_rotation(void **state)
{
    static const float times[2]   = {0.0f, 1.0f};
    static const float output[24] = {0, 0, 0, 0, 0, 0, 0,    1,    0, 0, 0, 0,
                                     0, 0, 0, 0, 0, 0, 0.6f, 0.8f, 0, 0, 0, 0};
    assay_context     *context    = gltf_context();
    assay_scene       *scene =
        load_track(context, "rotation", "CUBICSPLINE", 2, times, "VEC4", 6, output);
    (void)state;
    assert_int_equal(assay_scene_set_time(scene, 0.5), ASSAY_OK);
    /* q = (0, 0, 0.3, 0.9) / |.|, so the angle's cosine is (0.81 - 0.09) / 0.9 */
    assert_vec_near(vertex(scene, 1), vec3(0.8, 0.6, 0.0), 1e-7);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_scale_and_short_quaternions(void **state)
{
    static const float   times[2] = {0.0f, 1.0f}, scales[6] = {1, 1, 1, 3, 5, 7};
    static const int16_t shorts[8] = {0, 0, 0, 32767, 0, 0, 32767, 0};
    (void)state;
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    gltf_shown_triangle(maker);
    const int in   = gltf_floats(maker, "SCALAR", 2, times);
    const int out  = gltf_floats(maker, "VEC3", 2, scales);
    const int view = gltf_view(maker, shorts, sizeof shorts, 0);
    const int turn = gltf_add(maker, "accessors",
                              "\"bufferView\":%d,\"componentType\":5122,\"normalized\":true,"
                              "\"count\":2,\"type\":\"VEC4\"",
                              view);
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"scale\"}},"
             "{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"rotation\"}},"
             "{\"sampler\":1,\"target\":{\"path\":\"rotation\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d},{\"input\":%d,\"output\":%d}]",
             in, out, in, turn);
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(scene->animations[0].track_count, 2); /* a channel without node is none */
    assert_int_equal(assay_scene_set_time(scene, 1.0), ASSAY_OK);
    assert_vec_near(vertex(scene, 1), vec3(-3.0, 0.0, 0.0), 1e-6);
    assert_int_equal(assay_scene_set_time(scene, 0.5), ASSAY_OK);
    assert_vec_near(vertex(scene, 1), vec3(0.0, 2.0, 0.0), 1e-6);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Two animations of one property: the later one in the file wins; others play along. */
static void test_later_animation_wins(void **state)
{
    static const float time[1] = {0.0f}, one[3] = {1, 0, 0}, two[3] = {2, 0, 0}, big[3] = {9, 9, 9};
    assay_context     *context = gltf_context();
    gltf_maker        *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_triangle(maker);
    const int in = gltf_floats(maker, "SCALAR", 1, time);
    const int a = gltf_floats(maker, "VEC3", 1, one), b = gltf_floats(maker, "VEC3", 1, two);
    const int c = gltf_floats(maker, "VEC3", 1, big);
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}},"
             "{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"scale\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d},{\"input\":%d,\"output\":%d}]",
             in, a, in, c);
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d}]",
             in, b);
    assay_scene *scene = gltf_load(maker, context);
    assert_vec_near(vertex(scene, 0), vec3(2.0, 0.0, 0.0), 0.0);
    assert_vec_near(vertex(scene, 1), vec3(11.0, 0.0, 0.0), 0.0);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* A time gives the same bits whatever came before. */
static void test_no_memory_of_other_times(void **state)
{
    assay_context *context = gltf_context();
    assay_scene *scene = load_track(context, "translation", "LINEAR", 4, times4, "VEC3", 4, moves4);
    float        before[9];
    (void)state;
    assert_int_equal(assay_scene_set_time(scene, 3.3), ASSAY_OK);
    memcpy(before, scene->positions, sizeof before);
    for (double t = -1.0; t < 7.0; t += 0.37) {
        assert_int_equal(assay_scene_set_time(scene, t), ASSAY_OK);
    }
    assert_int_equal(assay_scene_set_time(scene, 3.3), ASSAY_OK);
    assert_memory_equal(before, scene->positions, sizeof before);
    assert_int_equal(assay_scene_set_time(scene, NAN), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_scene_set_time(scene, INFINITY), ASSAY_ERR_DOMAIN);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_cameras_and_lights_move(void **state)
{
    static const float times[2] = {0.0f, 1.0f}, moves[6] = {0, 0, 0, 0, 8, 0};
    assay_context     *context = gltf_context();
    gltf_maker        *maker   = gltf_maker_create();
    (void)state;
    const int in  = gltf_floats(maker, "SCALAR", 2, times),
              out = gltf_floats(maker, "VEC3", 2, moves);
    gltf_root(maker,
              "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\"}]}}");
    gltf_add(maker, "cameras", "\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}");
    gltf_add(maker, "nodes", "\"camera\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}");
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"translation\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d}]",
             in, out);
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(assay_scene_set_time(scene, 0.25), ASSAY_OK);
    assert_vec_near(scene->world_cameras[0].position, vec3(0.0, 2.0, 0.0), 0.0);
    assert_vec_near(scene->punctual[0].position, vec3(0.0, 2.0, 0.0), 0.0);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Geometry that overflows only later is refused then. */
static void test_overflow_at_a_time(void **state)
{
    static const float times[2] = {0.0f, 1.0f}, scales[6] = {1, 1, 1, 3e38f, 3e38f, 3e38f};
    assay_context     *context = gltf_context();
    gltf_maker        *maker   = gltf_maker_create();
    (void)state;
    gltf_shown_triangle(maker);
    gltf_add(maker, "nodes", "\"mesh\":0,\"scale\":[10,10,10],\"name\":\"a\\nb\"");
    const int in  = gltf_floats(maker, "SCALAR", 2, times);
    const int out = gltf_floats(maker, "VEC3", 2, scales);
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,\"path\":\"scale\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d}]",
             in, out);
    gltf_add(maker, "nodes", "\"children\":[1]");
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(assay_scene_set_time(scene, 1.0), ASSAY_ERR_FORMAT);
    assert_string_equal(
        assay_context_error(context),
        "test.gltf: nodes/1 (a?b), meshes/0/primitives/0: vertex 1 is not finite in "
        "the world at 1 s");
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- morph targets ---- */

static void test_morph_targets(void **state)
{
    static const float corners[9]   = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const float normals[9]   = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float tangents[12] = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1};
    static const float d1[9] = {0, 0, 4, 0, 0, 8, 0, 0, 12}, d2[9] = {2, 0, 0, 0, 2, 0, 0, 0, 2};
    static const float dn[9] = {2, 0, 0, 2, 0, 0, 2, 0, 0}, dt[9] = {0, 2, 0, 0, 2, 0, 0, 2, 0};
    static const float times[2] = {0.0f, 1.0f}, weights[4] = {0.25f, 0, 0.5f, 1};
    assay_context     *context = gltf_context();
    gltf_maker        *maker   = gltf_maker_create();
    (void)state;
    const int p = gltf_floats(maker, "VEC3", 3, corners),
              n = gltf_floats(maker, "VEC3", 3, normals);
    const int t = gltf_floats(maker, "VEC4", 3, tangents), a = gltf_floats(maker, "VEC3", 3, d1);
    const int b = gltf_floats(maker, "VEC3", 3, d2), c = gltf_floats(maker, "VEC3", 3, dn);
    const int d = gltf_floats(maker, "VEC3", 3, dt);
    gltf_add(maker, "meshes",
             "\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d},"
             "\"targets\":[{\"POSITION\":%d},{\"POSITION\":%d,\"NORMAL\":%d,\"TANGENT\":%d}]}],"
             "\"weights\":[0.5,0]",
             p, n, t, a, b, c, d);
    gltf_add(maker, "nodes", "\"mesh\":0");                     /* the mesh's weights  */
    gltf_add(maker, "nodes", "\"mesh\":0,\"weights\":[0,0.5]"); /* its own             */
    gltf_add(maker, "nodes", "\"mesh\":0,\"weights\":[9,9]");   /* animated            */
    const int in  = gltf_floats(maker, "SCALAR", 2, times);
    const int out = gltf_floats(maker, "SCALAR", 4, weights);
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,\"path\":\"weights\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d}]",
             in, out);
    assay_scene *scene = gltf_load(maker, context);
    assert_vec_near(vertex(scene, 1), vec3(1.0, 0.0, 4.0), 0.0);
    assert_vec_near(vertex(scene, 3), vec3(1.0, 0.0, 0.0), 0.0);
    assert_vec_near(vertex(scene, 4), vec3(1.0, 1.0, 0.0), 0.0);
    /* normal (0 0 1) + 0.5 (2 0 0), tangent (1 0 0) + 0.5 (0 2 0), both then unit */
    const assay_shape *s = &scene->shapes[1];
    assert_near(s->normals[0], sqrt(0.5), 1e-7);
    assert_near(s->normals[2], sqrt(0.5), 1e-7);
    assert_near(s->tangents[0], sqrt(0.5), 1e-7);
    assert_near(s->tangents[1], sqrt(0.5), 1e-7);
    assert_true(s->tangents[3] == 1.0f);
    assert_int_equal(assay_scene_set_time(scene, 0.5), ASSAY_OK); /* weights 0.375, 0.5 */
    assert_vec_near(vertex(scene, 6), vec3(1.0, 0.0, 1.5), 1e-7);
    assert_vec_near(vertex(scene, 7), vec3(1.0, 1.0, 3.0), 1e-7);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- skins ---- */

/* Two joints, one at (0, 1, 0) turned by 90 degrees about z, one moved to (5, 0, 0). */
static gltf_maker *make_skin(const float *weights, const uint8_t *joints, bool bind, int sets)
{
    static const float corners[9]    = {0, 1, 0, 1, 1, 0, 0, 2, 0};
    static const float normals[9]    = {1, 0, 0, 1, 0, 0, 1, 0, 0};
    static const float binds[32]     = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1,
                                        1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1};
    gltf_maker        *maker         = gltf_maker_create();
    char               skinning[128] = "";
    const int          p             = gltf_floats(maker, "VEC3", 3, corners),
              n                      = gltf_floats(maker, "VEC3", 3, normals);
    const int b                      = gltf_floats(maker, "MAT4", 2, binds);
    for (int set = 0; set < sets; set++) {
        const int    w    = gltf_floats(maker, "VEC4", 3, weights + 12 * set);
        const int    view = gltf_view(maker, joints + 12 * set, 12, 0);
        const int    j    = gltf_add(maker, "accessors",
                                     "\"bufferView\":%d,\"componentType\":5121,\"count\":3,"
                                           "\"type\":\"VEC4\"",
                                     view);
        const size_t used = strlen(skinning);
        snprintf(skinning + used, sizeof skinning - used, ",\"JOINTS_%d\":%d,\"WEIGHTS_%d\":%d",
                 set, j, set, w);
    }
    gltf_add(maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d%s}}]",
             p, n, skinning);
    gltf_add(maker, "nodes", "\"mesh\":0,\"skin\":0,\"translation\":[100,100,100]"); /* ignored */
    gltf_add(maker, "nodes",
             "\"translation\":[0,1,0],\"rotation\":[0,0,0.7071067811865476,0.7071067811865476]");
    gltf_add(maker, "nodes", "\"translation\":[5,0,0]");
    if (bind) {
        gltf_add(maker, "skins", "\"joints\":[1,2],\"inverseBindMatrices\":%d", b);
    } else {
        gltf_add(maker, "skins", "\"joints\":[1,2]");
    }
    return maker;
}

static void test_skin(void **state)
{
    /* all of joint 0; all of joint 1; half and half, with weights that sum to 4 */
    static const float   weights[12] = {1, 0, 0, 0, 0, 1, 0, 0, 2, 2, 0, 0};
    static const uint8_t joints[12]  = {0, 9, 9, 9, 9, 1, 9, 9, 0, 1, 9, 9};
    assay_context       *context     = gltf_context();
    assay_scene         *scene       = gltf_load(make_skin(weights, joints, true, 1), context);
    const float         *n           = scene->shapes[0].normals;
    (void)state;
    /* joint 0: about (0, 1, 0), a quarter turn: (0,1,0) stays */
    assert_vec_near(vertex(scene, 0), vec3(0.0, 1.0, 0.0), 1e-7);
    assert_vec_near(vertex(scene, 1), vec3(6.0, 1.0, 0.0), 1e-7);
    /* (0,2,0): joint 0 takes it to (-1,1,0), joint 1 to (5,2,0) */
    assert_vec_near(vertex(scene, 2), vec3(2.0, 1.5, 0.0), 1e-6);
    assert_vec_near(vec3(n[0], n[1], n[2]), vec3(0.0, 1.0, 0.0), 1e-7);
    assert_vec_near(vec3(n[3], n[4], n[5]), vec3(1.0, 0.0, 0.0), 1e-7);
    assert_vec_near(vec3(n[6], n[7], n[8]), vec3(sqrt(0.5), sqrt(0.5), 0.0), 1e-7);
    assert_false(scene->shapes[0].flipped);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_skin_without_inverse_bind(void **state)
{
    static const float   weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    static const uint8_t joints[12]  = {0};
    assay_context       *context     = gltf_context();
    assay_scene         *scene       = gltf_load(make_skin(weights, joints, false, 1), context);
    (void)state;
    /* the joint's world alone: (0,1,0) -> (-1,0,0) -> (-1,1,0) */
    assert_vec_near(vertex(scene, 0), vec3(-1.0, 1.0, 0.0), 1e-7);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_two_sets_of_joints(void **state)
{
    static const float   weights[24] = {0,    0, 0, 0.5f, 0,    0, 0, 0.5f, 0,    0, 0, 0.5f,
                                        0.5f, 0, 0, 0,    0.5f, 0, 0, 0,    0.5f, 0, 0, 0};
    static const uint8_t joints[24]  = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                        1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    assay_context       *context     = gltf_context();
    assay_scene         *scene       = gltf_load(make_skin(weights, joints, true, 2), context);
    (void)state;
    assert_int_equal(scene->meshes[0].primitives[0].joint_sets, 2);
    assert_vec_near(vertex(scene, 2), vec3(2.0, 1.5, 0.0), 1e-6);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* A mesh with joints under a node without skin is rigid. */
static void test_joints_without_skin(void **state)
{
    static const float   weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    static const uint8_t joints[12]  = {0};
    assay_context       *context     = gltf_context();
    gltf_maker          *maker       = make_skin(weights, joints, true, 1);
    (void)state;
    gltf_add(maker, "nodes", "\"mesh\":0,\"translation\":[0,0,7]");
    assay_scene *scene = gltf_load(maker, context);
    assert_vec_near(vertex(scene, 4), vec3(1.0, 1.0, 7.0), 0.0);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear_and_step),
        cmocka_unit_test(test_cubic_spline),
        cmocka_unit_test(test_slerp),
        cmocka_unit_test(test_slerp_opposite),
        cmocka_unit_test(test_cubic_rotation),
        cmocka_unit_test(test_scale_and_short_quaternions),
        cmocka_unit_test(test_later_animation_wins),
        cmocka_unit_test(test_no_memory_of_other_times),
        cmocka_unit_test(test_cameras_and_lights_move),
        cmocka_unit_test(test_overflow_at_a_time),
        cmocka_unit_test(test_morph_targets),
        cmocka_unit_test(test_skin),
        cmocka_unit_test(test_skin_without_inverse_bind),
        cmocka_unit_test(test_two_sets_of_joints),
        cmocka_unit_test(test_joints_without_skin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
