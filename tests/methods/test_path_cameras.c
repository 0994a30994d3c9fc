/* test_path_cameras.c - where the rays of a pixel go: the orthographic camera by hand, and the
 * camera of a scene without one, which must have everything in its view. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/random.h"
#include "math/vec.h"
#include "support/gltf_maker.h"
#include "support/measure.h"
#include "support/near.h"

/* ---- orthographic ---- */

/* Looks down from (1, 3, 2) on the floor y = 0; up in the image is -Z. */
static assay_scene *floor_from_above(assay_context *context, double xmag, double ymag)
{
    static const float    corners[12] = {-9, 0, 9, 9, 0, 9, 9, 0, -9, -9, 0, -9};
    static const uint16_t indices[6]  = {0, 1, 2, 0, 2, 3};
    gltf_maker           *m           = gltf_maker_create();
    const int             positions   = gltf_floats(m, "VEC3", 4, corners);
    gltf_shown_mesh(m, "\"attributes\":{\"POSITION\":%d},\"indices\":%d", positions,
                    gltf_shorts(m, 6, indices));
    gltf_add(m, "cameras",
             "\"type\":\"orthographic\",\"orthographic\":{\"xmag\":%.17g,\"ymag\":%.17g,"
             "\"znear\":0,\"zfar\":9}",
             xmag, ymag);
    gltf_add(m, "nodes",
             "\"camera\":0,\"translation\":[1,3,2],\"rotation\":[-0.70710678118654752440,0,0,"
             "0.70710678118654752440]");
    return gltf_load(m, context);
}

static double deviation(const assay_image *image, double half_width, double half_height)
{
    const int     width = assay_image_width(image), height = assay_image_height(image);
    double        worst = 0.0;
    assay_channel x, y, z, depth;
    assert_true(assay_image_find_channel(image, "P.X", &x));
    assert_true(assay_image_find_channel(image, "P.Y", &y));
    assert_true(assay_image_find_channel(image, "P.Z", &z));
    assert_true(assay_image_find_channel(image, "Z", &depth));
    for (int k = 0; k < width * height; k++) {
        const double sx = 2.0 * (k % width + 0.5) / width - 1.0;
        const double sy = 1.0 - 2.0 * (k / width + 0.5) / height;
        worst           = fmax(worst, fabs((double)x.data.f32[k] - (1.0 + sx * half_width)));
        worst           = fmax(worst, fabs((double)z.data.f32[k] - (2.0 - sy * half_height)));
        worst           = fmax(worst, fabs((double)y.data.f32[k]));
        worst           = fmax(worst, fabs((double)depth.data.f32[k] - 3.0));
    }
    return worst;
}

/* The image holds the camera's rectangle whatever its own shape. */
static void check_orthographic(double xmag, double ymag, int width, int height, double half_width,
                               double half_height)
{
    const setting  settings[] = {{"spp", "1"}, {NULL, NULL}};
    assay_context *context    = measure_context(1);
    assay_scene   *scene      = floor_from_above(context, xmag, ymag);
    assay_image   *image      = measure_render(scene, settings, width, height, "gbuffer");
    assert_near(deviation(image, half_width, half_height), 0.0, 1e-6);
    /* Mutants: xmag and ymag taken for whole lengths; exchanged. */
    assert_true(deviation(image, 0.5 * half_width, 0.5 * half_height) > 0.1);
    assert_true(half_width == half_height || deviation(image, half_height, half_width) > 0.1);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void orthographic(void **state)
{
    (void)state;
    check_orthographic(1.5, 1.0, 15, 10, 1.5, 1.0);
    check_orthographic(1.5, 1.0, 30, 10, 3.0, 1.0);
    check_orthographic(1.5, 1.0, 10, 10, 1.5, 1.5);
    check_orthographic(1.5, 1.0, 10, 20, 1.5, 3.0);
    check_orthographic(1.0, 2.0, 20, 10, 4.0, 2.0);
}

static void orthographic_metadata(void **state)
{
    (void)state;
    assay_context *context    = measure_context(1);
    assay_scene   *scene      = floor_from_above(context, 1.0, 1.0);
    const setting  settings[] = {{"spp", "4"}, {"bounces", "0"}, {NULL, NULL}};
    assay_image   *image      = measure_render(scene, settings, 4, 4, NULL);
    assert_string_equal(assay_image_get_attribute(image, "assay:camera.xmag"), "1");
    assert_string_equal(assay_image_get_attribute(image, "assay:camera.ymag"), "1");
    assert_null(assay_image_get_attribute(image, "assay:camera.yfov"));
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- the camera that frames ---- */

enum { CLOUD = 60 };

/* Vertices of triangles in a box about a centre. */
static void make_cloud(assay_vec3 centre, assay_vec3 extent, uint64_t seed, float out[9 * CLOUD])
{
    for (int i = 0; i < 3 * CLOUD; i++) {
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        out[3 * i]          = (float)(centre.x + extent.x * (assay_random_next(&random) - 0.5));
        out[3 * i + 1]      = (float)(centre.y + extent.y * (assay_random_next(&random) - 0.5));
        out[3 * i + 2]      = (float)(centre.z + extent.z * (assay_random_next(&random) - 0.5));
    }
}

typedef struct {
    assay_vec3 position, forward, right, up;
    double     yfov;
} view;

static assay_vec3 read_vector(const assay_image *image, const char *name)
{
    assay_vec3  v    = {0};
    const char *text = assay_image_get_attribute(image, name);
    assert_non_null(text);
    assert_int_equal(sscanf(text, "%lf %lf %lf", &v.x, &v.y, &v.z), 3);
    return v;
}

static view read_view(const assay_image *image)
{
    view v = {.position = read_vector(image, "assay:camera.position"),
              .forward  = read_vector(image, "assay:camera.forward"),
              .right    = read_vector(image, "assay:camera.right"),
              .up       = read_vector(image, "assay:camera.up")};
    assert_int_equal(sscanf(assay_image_get_attribute(image, "assay:camera.yfov"), "%lf", &v.yfov),
                     1);
    return v;
}

/* How far the farthest vertex is from the middle of the image: 1 at its edge. */
static double reach(view v, double aspect, const float *vertices, int count)
{
    const double half  = tan(0.5 * v.yfov);
    double       worst = 0.0;
    for (int i = 0; i < count; i++) {
        const float     *at = vertices + 3 * i;
        const assay_vec3 d =
            vec3_sub(vec3((double)at[0], (double)at[1], (double)at[2]), v.position);
        const double depth = vec3_dot(d, v.forward);
        if (!(depth > 0.0)) {
            return INFINITY;
        }
        worst = fmax(worst, fabs(vec3_dot(d, v.right)) / (depth * half * aspect));
        worst = fmax(worst, fabs(vec3_dot(d, v.up)) / (depth * half));
    }
    return worst;
}

static void check_framing(assay_vec3 centre, assay_vec3 extent, int width, int height)
{
    float          vertices[9 * CLOUD];
    const setting  settings[] = {{"spp", "1"}, {NULL, NULL}};
    assay_context *context    = measure_context(1);
    gltf_maker    *m          = gltf_maker_create();
    make_cloud(centre, extent, (uint64_t)width, vertices);
    gltf_shown_mesh(m, "\"attributes\":{\"POSITION\":%d}",
                    gltf_floats(m, "VEC3", 3 * CLOUD, vertices));
    assay_scene *scene = gltf_load(m, context);
    assay_image *image = measure_render(scene, settings, width, height, "gbuffer");
    view         v     = read_view(image);
    const double shown = reach(v, (double)width / height, vertices, 3 * CLOUD);
    if (!(shown <= 1.0) || shown < 0.01) {
        fail_msg("%d x %d: the scene reaches %.3g of the way to the edge", width, height, shown);
    }
    /* Mutant: 45 degrees from top to bottom in images that are higher than wide. */
    if (height > 2 * width && extent.x == extent.y) {
        v.yfov = 0.78539816339744830962;
        assert_true(reach(v, (double)width / height, vertices, 3 * CLOUD) > 1.0);
    }
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void framing(void **state)
{
    (void)state;
    static const int        sizes[][2] = {{16, 16}, {32, 8}, {8, 32}, {3, 64}, {64, 1}};
    static const assay_vec3 extents[]  = {{1, 1, 1},   {100, 1, 1}, {1, 100, 1},
                                          {1, 1, 100}, {5, 0, 5},   {1e-3, 1e-3, 1e-3}};
    static const assay_vec3 centres[]  = {{0, 0, 0}, {300, -20, 7}};
    for (size_t s = 0; s < 5; s++) {
        for (size_t e = 0; e < 6; e++) {
            for (size_t c = 0; c < 2; c++) {
                check_framing(centres[c], extents[e], sizes[s][0], sizes[s][1]);
            }
        }
    }
}

/* Nothing to frame: a camera there is. */
static void framing_nothing(void **state)
{
    (void)state;
    const setting  settings[] = {{"spp", "1"}, {NULL, NULL}};
    assay_context *context    = measure_context(1);
    assay_scene   *scene      = gltf_load(gltf_maker_create(), context);
    assay_image   *image      = measure_render(scene, settings, 5, 7, NULL);
    const view     v          = read_view(image);
    assert_true(vec3_finite(v.position) && v.yfov > 0.0 && v.yfov < 3.1);
    assert_true(measure_mean(image, "R").value == 0.0);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orthographic),
        cmocka_unit_test(orthographic_metadata),
        cmocka_unit_test(framing),
        cmocka_unit_test(framing_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
