/* test_bvh_watertight.c - no ray from inside a closed surface gets out: not through its edges, not
 * through its corners, not along its faces. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/random.h"
#include "math/vec.h"
#include "support/ray_cases.h"
#include "trace/bvh_tree.h"

/* A million rays where they are cheap. */
static uint64_t leak_count(void) { return 10 * case_count(); }

static assay_bvh *tree_of(assay_context *context, const case_mesh *mesh, const bvh_kernel *kernel)
{
    const assay_triangles triangles = case_triangles(mesh);
    const bvh_tuning      tuning    = bvh_tuning_default();
    assay_bvh            *bvh       = NULL;
    assert_int_equal(bvh_create_tuned(context, &triangles, &tuning, kernel, &bvh), ASSAY_OK);
    return bvh;
}

/* A point inside the star: well within its least radius of 0.7 cos(half an edge). */
static assay_vec3 inside_star(assay_random *r)
{
    const double x = assay_random_next(r), y = assay_random_next(r);
    return vec3(0.3 * (2 * x - 1), 0.3 * (2 * y - 1), 0.3 * (2 * assay_random_next(r) - 1));
}

/* Through corners, points of edges in binary fractions, and anywhere on a triangle. */
static assay_vec3 target_on(const case_mesh *mesh, assay_random *r, uint64_t i)
{
    const uint32_t   t      = (uint32_t)(assay_random_next(r) * mesh->triangle_count);
    const int        corner = (int)(assay_random_next(r) * 3);
    const double     u = (int)(assay_random_next(r) * 65) / 64.0, v = assay_random_next(r);
    const assay_vec3 a = case_corner(mesh, t, corner), b = case_corner(mesh, t, (corner + 1) % 3);
    const assay_vec3 c = case_corner(mesh, t, (corner + 2) % 3);
    const assay_vec3 p = vec3_mad(a, u, vec3_sub(b, a));
    return i % 3 == 0 ? a : i % 3 == 1 ? p : vec3_mad(p, v, vec3_sub(c, p));
}

/* Stars flattened in x by this much leave nearly every ray grazing. */
static const double flatness = 0x1p-20;

static uint64_t flat_leaks(const assay_bvh *bvh, const case_mesh *mesh, uint64_t count)
{
    uint64_t leaks = 0;
    for (uint64_t i = 0; i < count; i++) {
        assay_random random = assay_random_start(24, ASSAY_STAGE_TEST, i, 0);
        assay_vec3   o      = inside_star(&random);
        o.x *= flatness;
        const assay_vec3 target = target_on(mesh, &random, i);
        const assay_ray  ray    = assay_ray_start(o, vec3_sub(target, o), INFINITY);
        assay_hit        hit;
        leaks += !assay_bvh_closest(bvh, &ray, &hit);
    }
    return leaks;
}

static uint64_t star_leaks(const assay_bvh *bvh, const case_mesh *mesh, uint64_t count)
{
    uint64_t leaks = 0;
    for (uint64_t i = 0; i < count; i++) {
        assay_random     random = assay_random_start(21, ASSAY_STAGE_TEST, i, 0);
        const assay_vec3 o      = inside_star(&random);
        const assay_vec3 target = target_on(mesh, &random, i);
        const assay_ray  ray    = assay_ray_start(o, vec3_sub(target, o), INFINITY);
        assay_hit        hit;
        leaks += !assay_bvh_closest(bvh, &ray, &hit);
    }
    return leaks;
}

/* From the middle of the cube around (0.5, 0.5, 0.5), and from points of a fine lattice in it,
 * through points of the lattice: many rays run exactly along faces, edges and diagonals. */
static uint64_t cube_leaks(const assay_bvh *bvh, uint64_t count)
{
    uint64_t leaks = 0;
    for (uint64_t i = 0; i < count; i++) {
        assay_random random = assay_random_start(22, ASSAY_STAGE_TEST, i, 0);
        double       o[3], d[3];
        for (int k = 0; k < 3; k++) {
            o[k] = (1 + (int)(assay_random_next(&random) * 7)) / 8.0;
            d[k] = (int)(assay_random_next(&random) * 65 - 32) / 8.0 - o[k];
        }
        d[i % 3] += d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0;
        const assay_ray ray =
            assay_ray_start(vec3(o[0], o[1], o[2]), vec3(d[0], d[1], d[2]), INFINITY);
        assay_hit hit;
        leaks += !assay_bvh_closest(bvh, &ray, &hit);
    }
    return leaks;
}

typedef uint64_t (*leak_test)(const assay_bvh *bvh, const case_mesh *mesh, uint64_t count);

static uint64_t cubes_of(const assay_bvh *bvh, const case_mesh *mesh, uint64_t count)
{
    (void)mesh;
    return cube_leaks(bvh, count);
}

/* The million with the machine's best kernel, a tenth of it with each other. */
static void check(const case_mesh *mesh, leak_test leaks)
{
    static const bvh_kernel *others[] = {
#if defined(__x86_64__)
        &bvh_kernel_sse2,
#endif
        &bvh_kernel_double
    };
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assay_bvh *best = tree_of(context, mesh, NULL);
    assert_int_equal(leaks(best, mesh, leak_count()), 0);
    assay_bvh_destroy(best);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        assay_bvh *bvh = tree_of(context, mesh, others[k]);
        assert_int_equal(leaks(bvh, mesh, leak_count() / 10), 0);
        assay_bvh_destroy(bvh);
    }
    assay_context_destroy(context);
}

static void no_leak_through_an_irregular_surface(void **state)
{
    (void)state;
    case_mesh *star = case_star(4, 31);
    assert_int_equal(star->triangle_count, 2048);
    check(star, star_leaks);
    case_mesh_destroy(star);
}

static void no_leak_through_a_flat_surface(void **state)
{
    (void)state;
    case_mesh *star = case_star(4, 34);
    for (uint32_t i = 0; i < star->vertex_count; i++) {
        star->positions[3 * i] *= (float)flatness;
    }
    check(star, flat_leaks);
    case_mesh_destroy(star);
}

static void no_leak_through_cubes(void **state)
{
    (void)state;
    case_mesh *cubes = case_cubes(32);
    check(cubes, cubes_of);
    case_mesh_destroy(cubes);
}

/* A missing triangle is seen: so the surface is closed only as a whole. */
static void a_hole_leaks(void **state)
{
    (void)state;
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    case_mesh *star = case_star(3, 31);
    memset(star->indices, 0, 3 * sizeof *star->indices);
    assay_bvh *bvh = tree_of(context, star, NULL);
    assert_true(star_leaks(bvh, star, 100000) > 50);
    assay_bvh_destroy(bvh);
    case_mesh_destroy(star);
    assay_context_destroy(context);
}

/* Closed once more: from outside through every corner and edge towards the middle. */
static void no_way_in_unseen(void **state)
{
    (void)state;
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    case_mesh *star = case_star(4, 33);
    assay_bvh *bvh  = tree_of(context, star, NULL);
    for (uint64_t i = 0; i < case_count(); i++) {
        assay_random     random   = assay_random_start(23, ASSAY_STAGE_TEST, i, 0);
        const assay_vec3 on       = target_on(star, &random, i);
        const double     distance = ldexp(1.0, (int)(20.0 * assay_random_next(&random)));
        const assay_vec3 o        = vec3_scale(on, 1.5 * distance);
        const assay_ray  ray      = assay_ray_start(o, vec3_sub(on, o), INFINITY);
        assay_hit        hit;
        assert_true(assay_bvh_closest(bvh, &ray, &hit));
        assert_true(fabs(hit.t - 1.0) < 1e-6);
    }
    assay_bvh_destroy(bvh);
    case_mesh_destroy(star);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_leak_through_an_irregular_surface),
        cmocka_unit_test(no_leak_through_a_flat_surface),
        cmocka_unit_test(no_leak_through_cubes),
        cmocka_unit_test(a_hole_leaks),
        cmocka_unit_test(no_way_in_unseen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
