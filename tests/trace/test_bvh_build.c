/* test_bvh_build.c - trees over nothing, over one triangle a hundred thousand times, and over what
 * has no area; builds that are cancelled or run out of memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

#include "math/vec.h"
#include "support/failing_context.h"
#include "support/ray_cases.h"
#include "trace/bvh_tree.h"

static assay_context *new_context(void)
{
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    return context;
}

static assay_bvh *build(assay_context *context, const assay_triangles *triangles)
{
    assay_bvh *bvh = NULL;
    assert_int_equal(assay_bvh_create(context, triangles, &bvh), ASSAY_OK);
    return bvh;
}

/* The tree answers as the judge does to a few rays of each kind. */
static uint64_t check_answers(const assay_bvh *bvh, const case_mesh *mesh, uint64_t count)
{
    uint64_t hits = 0;
    for (uint64_t i = 0; i < count; i++) {
        const assay_ray ray = case_ray(mesh, (case_kind)(i % CASE_KINDS), 51, i);
        assay_hit       a = {0}, b = {0};
        const bool      found = assay_bvh_closest(bvh, &ray, &a);
        assert_int_equal(found, assay_bvh_closest_brute_force(bvh, &ray, &b));
        assert_int_equal(found, assay_bvh_occluded(bvh, &ray));
        assert_true(!found || (a.t == b.t && a.triangle == b.triangle));
        hits += found;
    }
    return hits;
}

static void no_triangle(void **state)
{
    (void)state;
    assay_context        *context = new_context();
    const assay_triangles nothing = {0};
    assay_bvh            *bvh     = build(context, &nothing);
    const assay_ray       ray     = assay_ray_start(vec3(0, 0, 0), vec3(0, 0, 1), INFINITY);
    assay_hit             hit;
    assert_false(assay_bvh_closest(bvh, &ray, &hit));
    assert_false(assay_bvh_occluded(bvh, &ray));
    assert_false(assay_bvh_closest_brute_force(bvh, &ray, &hit));
    assert_true(assay_bvh_bytes(bvh) < 1000);
    assay_bvh_destroy(bvh);
    assay_bvh_destroy(NULL);
    assay_context_destroy(context);
}

/* 1, 2, 3, ... triangles: a leaf alone, then the first inner nodes. */
static void few_triangles(void **state)
{
    (void)state;
    assay_context *context = new_context();
    for (uint32_t n = 1; n <= 40; n++) {
        case_mesh      *mesh      = case_lattice(n, n);
        assay_triangles triangles = case_triangles(mesh);
        assay_bvh      *bvh       = build(context, &triangles);
        assert_true(check_answers(bvh, mesh, 600) > 0);
        assay_bvh_destroy(bvh);
        case_mesh_destroy(mesh);
    }
    assay_context_destroy(context);
}

static void one_triangle_many_times(void **state)
{
    (void)state;
    enum { COPIES = 100000 };
    static const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    assay_context     *context     = new_context();
    uint32_t          *indices     = calloc(3 * COPIES, sizeof *indices);
    assert_non_null(indices);
    for (int i = 0; i < COPIES; i++) {
        indices[3 * i + 1] = 1;
        indices[3 * i + 2] = 2;
    }
    const assay_triangles triangles = {positions, indices, 3, COPIES};
    assay_bvh            *bvh       = build(context, &triangles);
    assert_true(bvh->depth <= 16);
    assert_true(assay_bvh_bytes(bvh) < 130 * (uint64_t)COPIES);
    assay_ray ray = assay_ray_start(vec3(0.25, 0.25, 1), vec3(0, 0, -1), INFINITY);
    assay_hit hit;
    for (uint32_t i = 0; i < 10; i++) {
        assert_true(assay_bvh_closest(bvh, &ray, &hit) && hit.t == 1.0 && hit.triangle == i);
        ray.t_after        = hit.t;
        ray.triangle_after = hit.triangle;
    }
    ray.triangle_after = COPIES - 2;
    assert_true(assay_bvh_closest(bvh, &ray, &hit) && hit.triangle == COPIES - 1);
    ray.triangle_after = COPIES - 1;
    assert_false(assay_bvh_closest(bvh, &ray, &hit));
    assay_bvh_destroy(bvh);
    free(indices);
    assay_context_destroy(context);
}

/* Points, segments and folded triangles, at places where float and double round. */
static void nothing_has_area(void **state)
{
    (void)state;
    assay_context *context = new_context();
    case_mesh     *mesh    = case_soup(200, 52);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t *corner = mesh->indices + 3 * (size_t)i;
        corner[i % 3]    = corner[(i + 1) % 3];
        corner[2]        = i % 4 ? corner[2] : corner[0];
    }
    const assay_triangles triangles = case_triangles(mesh);
    assay_bvh            *bvh       = build(context, &triangles);
    assert_int_equal(check_answers(bvh, mesh, 10000), 0);
    assert_null(bvh->memory);
    assay_bvh_destroy(bvh);
    case_mesh_destroy(mesh);
    assay_context_destroy(context);
}

/* Three corners on one line with the middle one in between: no area, but other corners. */
static void collinear_corners_are_never_hit(void **state)
{
    (void)state;
    static const float    positions[] = {1, 2, 3, 4, 6, 8, 7, 10, 13, 0.1F, 0.1F, 0.1F};
    static const uint32_t indices[]   = {0, 1, 2, 3, 3, 3};
    assay_context        *context     = new_context();
    const assay_triangles triangles   = {positions, indices, 4, 2};
    assert_true(bvh_triangle_is_degenerate(&triangles, 0));
    assert_true(bvh_triangle_is_degenerate(&triangles, 1));
    assay_bvh *bvh = build(context, &triangles);
    for (int i = 0; i < 1000; i++) {
        const assay_vec3 o    = vec3(0.01 * i, -3, 20 - 0.03 * i);
        const double     part = i / 999.0;
        const assay_vec3 on   = vec3(1 + 6 * part, 2 + 8 * part, 3 + 10 * part);
        const assay_ray  ray  = assay_ray_start(o, vec3_sub(on, o), INFINITY);
        assay_hit        hit;
        assert_false(assay_bvh_closest(bvh, &ray, &hit));
        assert_false(assay_bvh_closest_brute_force(bvh, &ray, &hit));
    }
    assay_bvh_destroy(bvh);
    assay_context_destroy(context);
}

static void memory_is_bounded(void **state)
{
    (void)state;
    assay_context  *context   = new_context();
    case_mesh      *mesh      = case_star(5, 53);
    assay_triangles triangles = case_triangles(mesh);
    assay_bvh      *bvh       = build(context, &triangles);
    const uint64_t  bytes     = assay_bvh_bytes(bvh);
    print_message("#| %.1f bytes a triangle, depth %u\n", (double)bytes / mesh->triangle_count,
                  bvh->depth);
    assert_true(bytes < 130 * (uint64_t)mesh->triangle_count);
    assay_bvh_destroy(bvh);
    case_mesh_destroy(mesh);
    assay_context_destroy(context);
}

/* ---- refusals ---- */

static assay_status build_star(assay_context *context, void *user)
{
    const assay_triangles triangles = case_triangles(user);
    assay_bvh            *bvh       = NULL;
    const assay_status    status    = assay_bvh_create(context, &triangles, &bvh);
    assert_true((status == ASSAY_OK) == (bvh != NULL));
    assay_bvh_destroy(bvh);
    return status;
}

static void refused_memory(void **state)
{
    (void)state;
    case_mesh *star = case_star(3, 54);
    assert_int_equal(failing_each(build_star, star), 3);
    case_mesh_destroy(star);
}

/* Embree is refused memory at every stage of its work. */
static void refused_memory_of_embree(void **state)
{
    (void)state;
    case_mesh *star    = case_star(5, 58);
    bvh_tuning tuning  = bvh_tuning_default();
    int        refused = 0;
    for (tuning.embree_limit = 1;; tuning.embree_limit += 40000) {
        failing_memory        memory    = {0};
        assay_context        *context   = failing_context(&memory);
        const assay_triangles triangles = case_triangles(star);
        assay_bvh            *bvh       = NULL;
        const assay_status    status = bvh_create_tuned(context, &triangles, &tuning, NULL, &bvh);
        if (status != ASSAY_OK) {
            assert_int_equal(status, ASSAY_ERR_MEMORY);
            assert_true(strlen(assay_context_error(context)) > 0);
            assert_null(bvh);
            refused++;
        }
        assay_bvh_destroy(bvh);
        assert_int_equal(memory.live, 1);
        assay_context_destroy(context);
        if (status == ASSAY_OK) {
            break;
        }
    }
    print_message("#| Embree refused memory %d times\n", refused);
    assert_true(refused > 3);
    case_mesh_destroy(star);
}

typedef struct {
    int calls, cancel_at;
} stopper;

static bool stop_at(void *user, const char *phase, double fraction)
{
    stopper *s = user;
    assert_string_equal(phase, "build");
    assert_true(fraction >= 0.0 && fraction <= 1.0);
    return ++s->calls != s->cancel_at;
}

static void cancelled_build(void **state)
{
    (void)state;
    case_mesh *star = case_star(5, 55);
    stopper    s    = {0};
    for (s.cancel_at = 1; s.cancel_at < 10000; s.cancel_at++) {
        const assay_context_options options = {.threads = 1, .progress = stop_at, .user = &s};
        assay_context              *context = NULL;
        s.calls                             = 0;
        assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
        const assay_status status = build_star(context, star);
        assert_int_equal(status, s.calls >= s.cancel_at ? ASSAY_ERR_CANCELLED : ASSAY_OK);
        assert_true(status == ASSAY_OK || s.calls == s.cancel_at);
        assay_context_destroy(context);
        if (status == ASSAY_OK) {
            break;
        }
    }
    print_message("#| %d calls of progress\n", s.calls);
    assert_true(s.calls > 0);
    case_mesh_destroy(star);
}

static void unknown_isa(void **state)
{
    (void)state;
    setenv("ASSAY_ISA", "avx3", 1);
    assay_context        *context = new_context();
    const assay_triangles nothing = {0};
    assay_bvh            *bvh     = NULL;
    assert_int_equal(assay_bvh_create(context, &nothing, &bvh), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(context), "avx3"));
    assert_null(bvh);
    assay_context_destroy(context);
    unsetenv("ASSAY_ISA");
}

/* ASSAY_ISA lowers Embree's vectors and ours; the answers stay. */
static void every_isa_builds(void **state)
{
    (void)state;
    static const char *isas[] = {"sse2", "avx2", "avx512"};
    case_mesh         *mesh   = case_lattice(200, 56);
    for (size_t i = 0; i < sizeof isas / sizeof *isas; i++) {
        setenv("ASSAY_ISA", isas[i], 1);
        assay_context        *context   = new_context();
        const assay_triangles triangles = case_triangles(mesh);
        assay_bvh            *bvh       = build(context, &triangles);
#if defined(__x86_64__)
        const bool narrow = i == 0 || !bvh_kernel_avx2.supported();
        assert_string_equal(bvh->kernel->name, narrow ? "sse2" : "avx2");
#endif
        assert_true(check_answers(bvh, mesh, 10000) > 1000);
        assay_bvh_destroy(bvh);
        assay_context_destroy(context);
    }
    unsetenv("ASSAY_ISA");
    case_mesh_destroy(mesh);
}

/* Embree may not leave denormals flushed behind. */
static void float_environment_is_kept(void **state)
{
    (void)state;
#if defined(__x86_64__)
    const unsigned        before    = _mm_getcsr() & ~0x3FU; /* without the sticky flags */
    assay_context        *context   = new_context();
    case_mesh            *mesh      = case_star(4, 57);
    const assay_triangles triangles = case_triangles(mesh);
    assay_bvh            *bvh       = build(context, &triangles);
    assert_int_equal(_mm_getcsr() & ~0x3FU, before);
    assay_bvh_destroy(bvh);
    assert_int_equal(_mm_getcsr() & ~0x3FU, before);
    case_mesh_destroy(mesh);
    assay_context_destroy(context);
#else
    skip();
#endif
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_triangle),
        cmocka_unit_test(few_triangles),
        cmocka_unit_test(one_triangle_many_times),
        cmocka_unit_test(nothing_has_area),
        cmocka_unit_test(collinear_corners_are_never_hit),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(refused_memory),
        cmocka_unit_test(refused_memory_of_embree),
        cmocka_unit_test(cancelled_build),
        cmocka_unit_test(unknown_isa),
        cmocka_unit_test(every_isa_builds),
        cmocka_unit_test(float_environment_is_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
