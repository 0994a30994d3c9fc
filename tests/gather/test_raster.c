/* test_raster.c - rasterised views against ray casting through the same pixels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/numerics.h"
#include "support/failing_context.h"
#include "support/lit_world.h"
#include "support/measure.h"
#include "support/raster_judge.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE };

static lit_world open_file(const char *path, int threads)
{
    lit_world w = {.context = measure_context(threads)};
    assert_int_equal(assay_scene_load(w.context, path, NULL, &w.scene), ASSAY_OK);
    assert_int_equal(assay_world_create(w.scene, &w.world), ASSAY_OK);
    return w;
}

static void add(raster_verdict *sum, raster_verdict v)
{
    sum->same += v.same;
    sum->tie += v.tie;
    sum->wrong += v.wrong;
    sum->hits += v.hits;
}

static raster_verdict judge(const lit_world *w, const assay_raster_view *view)
{
    assay_raster_sample *samples =
        malloc((size_t)view->columns * (size_t)view->rows * sizeof *samples);
    assert_non_null(samples);
    assert_int_equal(assay_raster_draw(w->world, view, samples), ASSAY_OK);
    const raster_verdict v = raster_judge(w->world, view, samples);
    free(samples);
    return v;
}

/* From points all over a scene, in frames turned at random: no pixel is off, and ties are rare. */
static void agrees_from_surfaces(const lit_world *w, const char *name, int views)
{
    raster_verdict sum = {0, 0, 0, 0};
    for (int i = 0; i < views; i++) {
        /* Fields of view of 127 degrees as published, wider ones and narrower ones. */
        static const double     halves[] = {2.0, 2.0, 0.7, 10.0};
        const assay_raster_view view =
            raster_judge_view(w->world, 7, (uint64_t)i, halves[i % 4], SIDE);
        add(&sum, judge(w, &view));
    }
    print_message("%s, %d views: %d pixels the same (%d of the rays hit), %d ties, %d wrong\n",
                  name, views, sum.same, sum.hits, sum.tie, sum.wrong);
    assert_int_equal(sum.wrong, 0);
    assert_true(sum.tie <= sum.same / 5000);
    assert_true(sum.hits > views * PIXELS / 10);
}

static void cornell_box(void **state)
{
    (void)state;
    lit_world w = open_file("scenes/cornell-box/cornell-box.gltf", 2);
    agrees_from_surfaces(&w, "Cornell box", 60);
    lit_world_close(&w);
}

static void colonnade(void **state)
{
    (void)state;
    lit_world w = open_file("scenes/colonnade/colonnade.gltf", 2);
    agrees_from_surfaces(&w, "colonnade", 40);
    lit_world_close(&w);
}

static void sponza(void **state)
{
    (void)state;
    const char *folder = measure_shared_scenes();
    char        path[512];
    snprintf(path, sizeof path, "%s/sponza_dabrovic/sponza_dabrovic.glb", folder ? folder : "");
    if (!folder || access(path, R_OK) != 0) {
        skip();
    }
    lit_world w = open_file(path, 2);
    agrees_from_surfaces(&w, "Sponza", 40);
    lit_world_close(&w);
}

/* Along the axes from the middle of a box and from places on its grid, where centres of pixels fall
 * on edges: whatever differs is a tie. */
static void ties_are_at_edges(void **state)
{
    (void)state;
    lit_world      w   = open_file("scenes/cornell-box/cornell-box.gltf", 1);
    raster_verdict sum = {0, 0, 0, 0};
    for (int i = 0; i < 24; i++) {
        const assay_vec3 axes[3] = {vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)};
        const assay_vec3 z       = vec3_scale(axes[i % 3], i % 2 ? 1.0 : -1.0);
        const assay_vec3 middle =
            vec3_scale(vec3_add(w.scene->bounds_min, w.scene->bounds_max), 0.5);
        const assay_raster_view view = {
            .eye     = vec3_mad(middle, i < 12 ? 0.0 : 0.125 * (i - 11) / 12.0, axes[(i + 1) % 3]),
            .frame   = frame3_from_zx(z, axes[(i + 1) % 3]),
            .half    = i % 4 < 2 ? 1.0 : 2.0,
            .columns = SIDE + i % 2,
            .rows    = SIDE + i % 2};
        add(&sum, judge(&w, &view));
    }
    print_message("along axes: %d the same, %d ties, %d wrong\n", sum.same, sum.tie, sum.wrong);
    assert_int_equal(sum.wrong, 0);
    assert_true(sum.tie < sum.same / 20);
    lit_world_close(&w);
}

/* ---- rules ---- */

static assay_raster_view looking_up(int columns, int rows)
{
    return (assay_raster_view){
        .frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .half = 2.0, .columns = columns, .rows = rows};
}

static void quad(scene_builder *b, int material, double x0, double x1, double y0, double y1,
                 double z)
{
    scene_builder_quad(b, material, vec3(x0, y0, z), vec3(x1, y0, z), vec3(x1, y1, z),
                       vec3(x0, y1, z));
}

/* Two faces in one plane: the lower number is seen, wherever both are; what is nearer than `near`,
 * or exactly as near, is not there. */
static void depth_and_near(void **state)
{
    (void)state;
    scene_builder *b = scene_builder_create();
    const int      m = scene_builder_diffuse(b, 0.5, 0.0, true);
    quad(b, m, -4, 4, -4, 4, 2);
    quad(b, m, -4, 4, -4, 4, 1);
    quad(b, m, -4, 4, -4, 4, 1);
    quad(b, m, -4, 4, -4, 4, -1);
    lit_world           w    = lit_world_open(b, 1);
    assay_raster_view   view = looking_up(9, 5);
    assay_raster_sample samples[45];
    assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_OK);
    for (int i = 0; i < 45; i++) {
        assert_in_range(samples[i].triangle, 2, 3);
        assert_true(samples[i].depth == 1.0);
    }
    static const struct {
        double near, depth;
    } cases[] = {{0.999999, 1.0}, {1.0, 2.0}, {1.9, 2.0}, {2.0, INFINITY}};
    for (int k = 0; k < 4; k++) {
        view.near = cases[k].near;
        assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_OK);
        for (int i = 0; i < 45; i++) {
            assert_true(samples[i].depth == cases[k].depth);
        }
    }
    lit_world_close(&w);
}

/* Edges belong to both sides, whichever way a face is wound: the diagonal of a square through the
 * centres of pixels has no hole, and there the lower number is seen. */
static void edges_belong(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        scene_builder *b = scene_builder_create();
        const double   x = k == 0 ? 4.0 : -4.0;
        quad(b, scene_builder_diffuse(b, 0.5, 0.0, true), -x, x, -4, 4, 1);
        lit_world               w    = lit_world_open(b, 1);
        const assay_raster_view view = looking_up(9, 9);
        assay_raster_sample     samples[81];
        assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_OK);
        int first = 0;
        for (int i = 0; i < 81; i++) {
            assert_true(samples[i].depth == 1.0);
            first += samples[i].triangle == 0;
        }
        assert_int_equal(first, 45);
        assert_int_equal(judge(&w, &view).same, 81);
        lit_world_close(&w);
    }
}

/* A floor that starts before the eye and ends behind it, seen along it; near cuts it exactly. */
static void crosses_the_eye(void **state)
{
    (void)state;
    scene_builder *b = scene_builder_create();
    const int      m = scene_builder_diffuse(b, 0.5, 0.0, true);
    scene_builder_quad(b, m, vec3(-50, -1, -50), vec3(50, -1, -50), vec3(50, -1, 80),
                       vec3(-50, -1, 80));
    scene_builder_quad(b, m, vec3(-3, 5, -50), vec3(-2.9, -9, 20), vec3(-2.9, -9, 80),
                       vec3(-3, 5, 8));
    lit_world           w    = lit_world_open(b, 1);
    assay_raster_view   view = looking_up(41, 63);
    assay_raster_sample samples[41 * 63];
    for (int k = 0; k < 3; k++) {
        view.near              = k == 0 ? 0.0 : k == 1 ? 0.6 : 4.0;
        const raster_verdict v = judge(&w, &view);
        assert_int_equal(v.wrong + v.tie, 0);
        assert_true(v.hits > 100);
        assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_OK);
        for (int i = 0; i < 41 * 63; i++) {
            const double y = assay_raster_centre(&view, i % 41, i / 41).y;
            if (samples[i].triangle < 2) { /* the floor is at depth -1 / Y */
                assert_true(fabs(samples[i].depth * y + 1.0) < 1e-12);
                assert_true(samples[i].depth > view.near);
            }
        }
    }
    lit_world_close(&w);
}

/* Parallel views: depth along z, the near limit may be behind the eye. */
static void parallel_views(void **state)
{
    (void)state;
    lit_world      w   = open_file("scenes/colonnade/colonnade.gltf", 1);
    raster_verdict sum = {0, 0, 0, 0};
    for (int i = 0; i < 6; i++) {
        assay_raster_view view = raster_judge_view(w.world, 3, (uint64_t)i, 1.0, SIDE);
        view.parallel          = true;
        view.half              = 2.0 + i;
        view.near              = i % 2 ? -3.0 : 0.0;
        if (view.near < 0.0) { /* rays of the judge start there */
            view.eye  = vec3_mad(view.eye, view.near, view.frame.z);
            view.near = 0.0;
        }
        add(&sum, judge(&w, &view));
    }
    assert_int_equal(sum.wrong, 0);
    assert_true(sum.tie < 20 && sum.hits > PIXELS);
    lit_world_close(&w);
}

/* A mask is tested where the pixel is, and what blends counts from a half on. */
static void masks(void **state)
{
    (void)state;
    static const char *const materials[3] = {
        "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.5,\"pbrMetallicRoughness\":{\"baseColorFactor\":"
        "[1,1,1,0.4]}",
        "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.49]}",
        "\"alphaMode\":\"BLEND\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1,1,0.5]}"};
    scene_builder *b = scene_builder_create();
    for (int i = 0; i < 3; i++) {
        quad(b, scene_builder_material(b, materials[i]), -9, 9, -9, 9, 1 + i);
    }
    lit_world               w    = lit_world_open(b, 1);
    const assay_raster_view view = looking_up(8, 8);
    assay_raster_sample     samples[64];
    assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_OK);
    for (int i = 0; i < 64; i++) {
        assert_true(samples[i].depth == 3.0);
    }
    lit_world_close(&w);
}

/* A closed mesh has no holes, from inside, whatever the frame. */
static void closed_from_inside(void **state)
{
    (void)state;
    scene_builder *b = scene_builder_create();
    scene_builder_sphere(b, scene_builder_diffuse(b, 0.5, 0.0, true), vec3(0.1, 0.2, 0.3), 1.0, 4);
    lit_world            w       = lit_world_open(b, 2);
    assay_raster_sample *samples = malloc(PIXELS * sizeof *samples);
    assert_non_null(samples);
    for (int i = 0; i < 30; i++) {
        assay_raster_view view = raster_judge_view(w.world, 11, (uint64_t)i, 30.0, SIDE);
        view.eye = vec3_mad(vec3(0.1, 0.2, 0.3), i % 3 ? 0.01 * i : 0.0, view.frame.x);
        assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_OK);
        for (int k = 0; k < PIXELS; k++) {
            assert_true(samples[k].triangle != ASSAY_NO_TRIANGLE);
        }
    }
    free(samples);
    lit_world_close(&w);
}

/* ---- the same bits, and what is refused ---- */

static void threads_do_not_matter(void **state)
{
    (void)state;
    lit_world one = open_file("scenes/colonnade/colonnade.gltf", 1);
    lit_world two = open_file("scenes/colonnade/colonnade.gltf", 5);
    for (int i = 0; i < 4; i++) {
        const assay_raster_view    view = raster_judge_view(one.world, 5, (uint64_t)i, 2.0, SIDE);
        static assay_raster_sample a[PIXELS], b[PIXELS];
        assert_int_equal(assay_raster_draw(one.world, &view, a), ASSAY_OK);
        assert_int_equal(assay_raster_draw(two.world, &view, b), ASSAY_OK);
        for (int k = 0; k < PIXELS; k++) {
            assert_true(memcmp(&a[k].depth, &b[k].depth, sizeof(double)) == 0);
            assert_int_equal(a[k].triangle, b[k].triangle);
        }
    }
    lit_world_close(&one);
    lit_world_close(&two);
}

static void refuses(void **state)
{
    (void)state;
    lit_world           w    = lit_world_furnace(1);
    assay_raster_view   view = looking_up(8, 8);
    assay_raster_sample samples[64];
    memset(samples, 0x5a, sizeof samples);
    static const struct {
        int    columns, rows;
        double half, near;
    } bad[] = {{0, 8, 1, 0},   {8, 0, 1, 0},        {8193, 8, 1, 0}, {8, 8193, 1, 0}, {8, 8, 0, 0},
               {8, 8, NAN, 0}, {8, 8, INFINITY, 0}, {8, 8, 1, -1},   {8, 8, 1, NAN}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        view.columns = bad[i].columns;
        view.rows    = bad[i].rows;
        view.half    = bad[i].half;
        view.near    = bad[i].near;
        assert_int_equal(assay_raster_draw(w.world, &view, samples), ASSAY_ERR_ARGUMENT);
        assert_int_equal(samples[0].triangle, 0x5a5a5a5a);
    }
    lit_world_close(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cornell_box),
        cmocka_unit_test(colonnade),
        cmocka_unit_test(sponza),
        cmocka_unit_test(ties_are_at_edges),
        cmocka_unit_test(depth_and_near),
        cmocka_unit_test(edges_belong),
        cmocka_unit_test(crosses_the_eye),
        cmocka_unit_test(parallel_views),
        cmocka_unit_test(masks),
        cmocka_unit_test(closed_from_inside),
        cmocka_unit_test(threads_do_not_matter),
        cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
