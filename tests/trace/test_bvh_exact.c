/* test_bvh_exact.c - the tree against the judge that tries every triangle: the same bits, for every
 * kernel, every shape of the tree, and every kind of ray. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/hash.h"
#include "math/vec.h"
#include "support/ray_cases.h"
#include "trace/bvh_decision.h"

enum { MAX_TREES = 8 };

typedef struct {
    assay_context *context;
    assay_bvh     *bvh[MAX_TREES];
    int            count;
} forest;

static const bvh_kernel *kernels[] = {
#if defined(__x86_64__)
    &bvh_kernel_avx2, &bvh_kernel_sse2,
#elif defined(__aarch64__)
    &bvh_kernel_neon,
#endif
    &bvh_kernel_double};
enum { KERNELS = sizeof kernels / sizeof *kernels };

static void grow(forest *f, const case_mesh *mesh, const bvh_tuning *tuning,
                 const bvh_kernel *kernel)
{
    const assay_triangles triangles = case_triangles(mesh);
    if (kernel->supported()) {
        assert_int_equal(
            bvh_create_tuned(f->context, &triangles, tuning, kernel, &f->bvh[f->count++]),
            ASSAY_OK);
    }
}

/* Every kernel on the usual tree, then the first on trees of other shapes. */
static forest plant(const case_mesh *mesh, const bvh_tuning *tuning)
{
    forest f = {0};
    assert_int_equal(assay_context_create(NULL, &f.context), ASSAY_OK);
    for (int i = 0; i < KERNELS; i++) {
        grow(&f, mesh, tuning, kernels[i]);
    }
    bvh_tuning narrow = *tuning, small = *tuning;
    narrow.width    = 2;
    small.leaf_size = 1;
    grow(&f, mesh, &narrow, f.bvh[0]->kernel);
    grow(&f, mesh, &small, f.bvh[0]->kernel);
    return f;
}

static void fell(forest *f)
{
    for (int i = 0; i < f->count; i++) {
        assay_bvh_destroy(f->bvh[i]);
    }
    assay_context_destroy(f->context);
}

static bool same_hit(bool found_a, const assay_hit *a, bool found_b, const assay_hit *b)
{
    return found_a == found_b && (!found_a || (memcmp(&a->t, &b->t, 3 * sizeof(double)) == 0 &&
                                               a->triangle == b->triangle));
}

/* How many of the trees' answers are not the judge's. */
static int disagreements(const forest *f, const assay_ray *ray, uint64_t *hits)
{
    assay_hit  truth = {0};
    const bool hit   = assay_bvh_closest_brute_force(f->bvh[0], ray, &truth);
    int        count = 0;
    *hits += hit;
    for (int i = 0; i < f->count; i++) {
        assay_hit  found = {0};
        const bool any   = assay_bvh_closest(f->bvh[i], ray, &found);
        count += !same_hit(hit, &truth, any, &found);
        count += assay_bvh_occluded(f->bvh[i], ray) != hit;
    }
    return count;
}

static uint64_t wrong_answers(const case_mesh *mesh, const bvh_tuning *tuning, case_kind kind,
                              uint64_t count, uint64_t *hits)
{
    forest   f     = plant(mesh, tuning);
    uint64_t wrong = 0;
    for (uint64_t i = 0; i < count; i++) {
        const assay_ray ray = case_ray(mesh, kind, 1, i);
        wrong += (uint64_t)disagreements(&f, &ray, hits);
    }
    fell(&f);
    return wrong;
}

/* Half of the rays on each of two meshes. */
static void check_kind(case_kind kind)
{
    const bvh_tuning tuning = bvh_tuning_default();
    case_mesh       *soup = case_soup(80, 7), *lattice = case_lattice(100, 8);
    uint64_t         hits = 0;
    const uint64_t   half = case_count() / 2;
    assert_int_equal(wrong_answers(soup, &tuning, kind, half, &hits), 0);
    assert_int_equal(wrong_answers(lattice, &tuning, kind, half, &hits), 0);
    print_message("#| %s: %llu rays, %llu hit, every answer the judge's\n", case_names[kind],
                  (unsigned long long)(2 * half), (unsigned long long)hits);
    assert_true(hits > half / 10);
    case_mesh_destroy(soup);
    case_mesh_destroy(lattice);
}

static void random_rays(void **state) { (void)state, check_kind(CASE_RANDOM); }
static void surface_rays(void **state) { (void)state, check_kind(CASE_SURFACE); }
static void edge_rays(void **state) { (void)state, check_kind(CASE_EDGE); }
static void vertex_rays(void **state) { (void)state, check_kind(CASE_VERTEX); }
static void axis_rays(void **state) { (void)state, check_kind(CASE_AXIS); }
static void in_plane_rays(void **state) { (void)state, check_kind(CASE_IN_PLANE); }
static void grazing_rays(void **state) { (void)state, check_kind(CASE_GRAZING); }
static void far_rays(void **state) { (void)state, check_kind(CASE_FAR); }
static void farther_rays(void **state) { (void)state, check_kind(CASE_FARTHER); }
static void odd_rays(void **state) { (void)state, check_kind(CASE_LENGTHS); }
static void bounded_rays(void **state) { (void)state, check_kind(CASE_BOUNDED); }

/* From coordinates that are subnormal floats to such that nearly overflow. */
static void scenes_of_any_size(void **state)
{
    (void)state;
    static const double scales[] = {0x1p-146, 0x1p-126, 1e-30, 0x1p-61, 1e-6,
                                    1e6,      0x1p59,   1e30,  0x1p120};
    const bvh_tuning    tuning   = bvh_tuning_default();
    for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
        case_mesh *mesh = case_lattice(60, 11);
        uint64_t   hits = 0;
        case_mesh_scale(mesh, scales[s]);
        for (case_kind kind = 0; kind < CASE_KINDS; kind++) {
            const uint64_t count = case_count() / 100;
            assert_int_equal(wrong_answers(mesh, &tuning, kind, count, &hits), 0);
        }
        assert_true(hits > case_count() / 100);
        case_mesh_destroy(mesh);
    }
}

/* One corner far out makes the margins of all boxes huge, and may not change an answer. */
static void one_outlier(void **state)
{
    (void)state;
    const bvh_tuning tuning = bvh_tuning_default();
    case_mesh       *mesh   = case_soup(60, 12);
    uint64_t         hits   = 0;
    mesh->positions[3]      = 3e4F;
    for (case_kind kind = 0; kind < CASE_FAR; kind++) {
        assert_int_equal(wrong_answers(mesh, &tuning, kind, case_count() / 100, &hits), 0);
    }
    mesh->positions[3] = 1e30F;
    assert_int_equal(wrong_answers(mesh, &tuning, CASE_EDGE, case_count() / 100, &hits), 0);
    case_mesh_destroy(mesh);
}

/* ---- walking through all hits ---- */

typedef struct {
    double   t;
    uint32_t triangle;
} step;

static int compare_steps(const void *a, const void *b)
{
    const step *x = a, *y = b;
    return x->t != y->t ? (x->t > y->t) - (x->t < y->t)
                        : (x->triangle > y->triangle) - (x->triangle < y->triangle);
}

/* All hits of a ray, each triangle asked by itself, then sorted. */
static size_t all_hits(const assay_bvh *bvh, const assay_ray *ray, step *steps)
{
    size_t count = 0;
    for (uint32_t i = 0; i < bvh->triangles.triangle_count; i++) {
        float corner[3][3];
        for (size_t c = 0; c < 3; c++) {
            memcpy(corner[c],
                   bvh->triangles.positions + 3 * (size_t)bvh->triangles.indices[3 * i + c],
                   sizeof corner[c]);
        }
        bvh_query query;
        bvh_query_start(&query, bvh, ray);
        if (!bvh_triangle_is_degenerate(&bvh->triangles, i) &&
            bvh_query_try(&query, corner[0], 3, 1, i)) {
            steps[count++] = (step){query.best_t, i};
        }
    }
    qsort(steps, count, sizeof *steps, compare_steps);
    return count;
}

static void walk_all(const forest *f, const assay_ray *start, const step *steps, size_t count)
{
    for (int i = 0; i < f->count; i++) {
        assay_ray ray = *start;
        assay_hit hit;
        for (size_t s = 0; s < count; s++) {
            assert_true(assay_bvh_closest(f->bvh[i], &ray, &hit));
            assert_true(hit.t == steps[s].t && hit.triangle == steps[s].triangle);
            ray.t_after        = hit.t;
            ray.triangle_after = hit.triangle;
        }
        assert_false(assay_bvh_closest(f->bvh[i], &ray, &hit));
        assert_false(assay_bvh_occluded(f->bvh[i], &ray));
    }
}

/* Going on past each hit meets every triangle once, in the order (t, triangle); ties included: the
 * soup has triangles twice. */
static void continued_rays(void **state)
{
    (void)state;
    static const case_kind kinds[] = {CASE_RANDOM, CASE_SURFACE,  CASE_EDGE, CASE_VERTEX,
                                      CASE_AXIS,   CASE_IN_PLANE, CASE_FAR};
    const bvh_tuning       tuning  = bvh_tuning_default();
    uint64_t               ties = 0, hits = 0;
    case_mesh             *meshes[2] = {case_soup(100, 13), case_lattice(100, 14)};
    for (int m = 0; m < 2; m++) {
        forest f     = plant(meshes[m], &tuning);
        step  *steps = calloc(meshes[m]->triangle_count, sizeof *steps);
        assert_non_null(steps);
        for (uint64_t i = 0; i < case_count() / 10; i++) {
            const assay_ray ray   = case_ray(meshes[m], kinds[i % 7], 2, i);
            const size_t    count = all_hits(f.bvh[0], &ray, steps);
            walk_all(&f, &ray, steps, count);
            hits += count;
            for (size_t s = 1; s < count; s++) {
                ties += steps[s].t == steps[s - 1].t;
            }
        }
        free(steps);
        fell(&f);
        case_mesh_destroy(meshes[m]);
    }
    print_message("#| continued: %llu hits in order, %llu ties\n", (unsigned long long)hits,
                  (unsigned long long)ties);
    assert_true(ties > case_count() / 200);
}

/* ---- what the checks above would see ---- */

static void narrow_boxes_are_seen(void **state)
{
    (void)state;
    bvh_tuning tuning  = bvh_tuning_default();
    tuning.box_margin  = 0.0;
    case_mesh *lattice = case_lattice(150, 8);
    uint64_t   hits    = 0;
    assert_true(wrong_answers(lattice, &tuning, CASE_FAR, 20000, &hits) > 0);
    assert_true(wrong_answers(lattice, &tuning, CASE_VERTEX, 20000, &hits) > 0);
    case_mesh_destroy(lattice);
}

/* Without the residual's limit, rounding noise passes for hits far outside the triangle's box. */
static void unguarded_decisions_are_seen(void **state)
{
    (void)state;
    bvh_tuning tuning     = bvh_tuning_default();
    tuning.residual_limit = INFINITY;
    case_mesh *lattice    = case_lattice(150, 8);
    uint64_t   hits       = 0;
    assert_true(wrong_answers(lattice, &tuning, CASE_IN_PLANE, 20000, &hits) > 0);
    case_mesh_destroy(lattice);
}

/* Bits of all answers to a fixed set of rays, to compare builds by. */
static void digest_of_answers(void **state)
{
    (void)state;
    const bvh_tuning tuning    = bvh_tuning_default();
    case_mesh       *mesh      = case_lattice(150, 15);
    forest           f         = plant(mesh, &tuning);
    char             first[65] = "";
    for (int k = 0; k < f.count; k++) {
        assay_hash hash;
        char       digest[65];
        assay_hash_start(&hash);
        for (uint64_t i = 0; i < 20000; i++) {
            const assay_ray ray = case_ray(mesh, (case_kind)(i % CASE_KINDS), 3, i);
            assay_hit       hit = {0};
            if (assay_bvh_closest(f.bvh[k], &ray, &hit)) {
                assay_hash_add(&hash, &hit.t, sizeof hit.t);
                assay_hash_add(&hash, &hit.u, sizeof hit.u);
                assay_hash_add(&hash, &hit.v, sizeof hit.v);
                assay_hash_add(&hash, &hit.triangle, sizeof hit.triangle);
            }
        }
        assay_hash_finish(&hash, digest);
        if (k == 0) {
            memcpy(first, digest, sizeof first);
        }
        assert_string_equal(digest, first);
    }
    print_message("#| digest of 20000 answers: %.16s\n", first);
    fell(&f);
    case_mesh_destroy(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_rays),
        cmocka_unit_test(surface_rays),
        cmocka_unit_test(edge_rays),
        cmocka_unit_test(vertex_rays),
        cmocka_unit_test(axis_rays),
        cmocka_unit_test(in_plane_rays),
        cmocka_unit_test(grazing_rays),
        cmocka_unit_test(far_rays),
        cmocka_unit_test(farther_rays),
        cmocka_unit_test(odd_rays),
        cmocka_unit_test(bounded_rays),
        cmocka_unit_test(scenes_of_any_size),
        cmocka_unit_test(one_outlier),
        cmocka_unit_test(continued_rays),
        cmocka_unit_test(narrow_boxes_are_seen),
        cmocka_unit_test(unguarded_decisions_are_seen),
        cmocka_unit_test(digest_of_answers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
