/* test_bvh_decision.c - the decision about one triangle against the same geometry in 113 bits, and
 * against hits that are known exactly. */
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
#include "trace/bvh_decision.h"

#if defined(__aarch64__)
typedef long double wide;
#else
typedef __float128 wide;
#endif

typedef struct {
    wide x, y, z;
} wide3;

/* ---- the judge in 113 bits ---- */

typedef struct {
    const float *corner; /* 9 floats */
    assay_ray    ray;
    double       magnitude; /* M, m */
} wide_case;

static wide3 in_ray_frame(const wide_case *c, const uint32_t axis[3], int corner)
{
    const float *p    = c->corner + 3 * corner;
    const double o[3] = {c->ray.origin.x, c->ray.origin.y, c->ray.origin.z};
    const double d[3] = {c->ray.direction.x, c->ray.direction.y, c->ray.direction.z};
    const wide   x = (wide)p[axis[0]] - o[axis[0]], y = (wide)p[axis[1]] - o[axis[1]];
    const wide   z = (wide)p[axis[2]] - o[axis[2]];
    return (wide3){x - z * d[axis[0]] / d[axis[2]], y - z * d[axis[1]] / d[axis[2]], z};
}

static double length_2d(wide3 a, wide3 b)
{
    const double x = (double)(b.x - a.x), y = (double)(b.y - a.y);
    return sqrt(x * x + y * y);
}

/* How far the ray passes inside the triangle, seen along the ray: the least signed distance from
 * its edges, in units of M; negative outside. */
static double depth_inside(const wide_case *c)
{
    const assay_vec3 d       = c->ray.direction;
    const uint32_t   kz      = bvh_largest_axis(fabs(d.x), fabs(d.y), fabs(d.z));
    const uint32_t   axis[3] = {(kz + 1) % 3, (kz + 2) % 3, kz};
    wide3            p[3];
    for (int i = 0; i < 3; i++) {
        p[i] = in_ray_frame(c, axis, i);
    }
    const wide area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
    const double side  = area < 0 ? -1.0 : 1.0;
    double       depth = INFINITY;
    for (int i = 0; i < 3; i++) {
        const wide3  a = p[i], b = p[(i + 1) % 3];
        const double distance = side * (double)(a.x * b.y - a.y * b.x) / length_2d(a, b);
        depth                 = fmin(depth, distance / c->magnitude);
    }
    return depth;
}

/* Largest difference of a coordinate between o + t d and the point of u and v, in units of M. */
static double mismatch(const wide_case *c, const assay_hit *hit)
{
    const double o[3]  = {c->ray.origin.x, c->ray.origin.y, c->ray.origin.z};
    const double d[3]  = {c->ray.direction.x, c->ray.direction.y, c->ray.direction.z};
    double       worst = 0.0;
    for (int k = 0; k < 3; k++) {
        const wide p = ((wide)1 - hit->u - hit->v) * c->corner[k] +
                       (wide)hit->u * c->corner[3 + k] + (wide)hit->v * c->corner[6 + k];
        const wide q = o[k] + (wide)hit->t * d[k];
        worst        = fmax(worst, fabs((double)(p - q)) / c->magnitude);
    }
    return worst;
}

/* ---- rays at a triangle, from straight on to edge-on ---- */

static double uniform(assay_random *r, double low, double high)
{
    return low + (high - low) * assay_random_next(r);
}

static assay_vec3 in_cube(assay_random *r)
{
    const double x = uniform(r, -1, 1), y = uniform(r, -1, 1);
    return vec3(x, y, uniform(r, -1, 1));
}

static assay_vec3 corner_vec(const float *corner) { return vec3(corner[0], corner[1], corner[2]); }

/* Aims at a point inside, or a little outside; the ray is tilted out of the plane by 1 to 2^-50. */
static wide_case make_case(float *corner, uint64_t i)
{
    assay_random     random = assay_random_start(41, ASSAY_STAGE_TEST, i, 0);
    const double     size   = ldexp(1.0, -(int)uniform(&random, 0, 12));
    const assay_vec3 centre = in_cube(&random);
    for (int c = 0; c < 3; c++) {
        const assay_vec3 p = vec3_mad(centre, size, in_cube(&random));
        corner[3 * c]      = (float)p.x;
        corner[3 * c + 1]  = (float)p.y;
        corner[3 * c + 2]  = (float)p.z;
    }
    const assay_vec3 a = corner_vec(corner), e = vec3_sub(corner_vec(corner + 3), a);
    const assay_vec3 f      = vec3_sub(corner_vec(corner + 6), a);
    const assay_vec3 normal = vec3_normalize(vec3_cross(e, f));
    const double     u = uniform(&random, -0.1, 1.1), v = uniform(&random, -0.1, 1.1 - u);
    const double     s = uniform(&random, -1, 1), t = uniform(&random, -1, 1);
    const double     tilt   = ldexp(1.0, -(int)uniform(&random, 0, 50));
    const assay_vec3 along  = vec3_normalize(vec3_add(vec3_scale(e, s), vec3_scale(f, t)));
    const assay_vec3 d      = vec3_mad(along, tilt, normal);
    const assay_vec3 target = vec3_mad(vec3_mad(a, u, e), v, f);
    wide_case        c      = {.corner = corner};
    c.ray = assay_ray_start(vec3_mad(target, -uniform(&random, 0.1, 2.0), d), d, INFINITY);
    return c;
}

typedef struct {
    uint64_t must_hit, must_miss, wrong;
} tally;

/* Inside by 2^-46 M: a hit; outside by 2^-39 M: none; and every hit lies where u, v and t say, to
 * 2^-39 M. */
static void judge(const bvh_tuning *tuning, uint64_t i, tally *result)
{
    float     corner[9];
    wide_case c   = make_case(corner, i);
    assay_bvh bvh = {.tuning = *tuning};
    for (int k = 0; k < 9; k++) {
        bvh.extent = fmax(bvh.extent, fabs((double)corner[k]));
    }
    bvh_query query;
    bvh_query_start(&query, &bvh, &c.ray);
    c.magnitude        = query.shear.magnitude;
    assay_hit    hit   = {0};
    const bool   found = bvh_query_try(&query, corner, 3, 1, 0) && bvh_query_finish(&query, &hit);
    const double depth = depth_inside(&c);
    result->must_hit += depth > 0x1p-46;
    result->must_miss += depth < -0x1p-39;
    result->wrong += (depth > 0x1p-46 && !found) || (depth < -0x1p-39 && found) ||
                     (found && mismatch(&c, &hit) > 0x1p-39);
}

static tally judge_many(const bvh_tuning *tuning)
{
    tally result = {0};
    for (uint64_t i = 0; i < case_count(); i++) {
        judge(tuning, i, &result);
    }
    return result;
}

static void agrees_with_113_bits(void **state)
{
    (void)state;
    const bvh_tuning tuning = bvh_tuning_default();
    const tally      result = judge_many(&tuning);
    print_message("#| %llu clear hits, %llu clear misses\n", (unsigned long long)result.must_hit,
                  (unsigned long long)result.must_miss);
    assert_true(result.must_hit > case_count() / 4 && result.must_miss > case_count() / 10);
    assert_int_equal(result.wrong, 0);
}

static void plain_arithmetic_does_not(void **state)
{
    (void)state;
    bvh_tuning tuning     = bvh_tuning_default();
    tuning.residual_limit = INFINITY;
    assert_true(judge_many(&tuning).wrong > 0);
}

/* ---- hits that are known exactly ---- */

static const float    square[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
static const uint32_t twice[]  = {3, 1, 2, 0, 1, 2, 2, 1, 0, 0, 0, 1, 0, 1, 2};

/* The far half of a square, then its near half three times, and once without area. */
static assay_bvh *known_tree(assay_context *context)
{
    const assay_triangles triangles = {square, twice, 4, 5};
    assay_bvh            *bvh       = NULL;
    assert_int_equal(assay_bvh_create(context, &triangles, &bvh), ASSAY_OK);
    return bvh;
}

static void exact_hits(void **state)
{
    (void)state;
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assay_bvh *bvh = known_tree(context);
    assay_ray  ray = assay_ray_start(vec3(0.25, 0.5, 2), vec3(0, 0, -4), INFINITY);
    assay_hit  hit = {-1, -1, -1, 77};

    assert_true(assay_bvh_closest(bvh, &ray, &hit));
    assert_true(hit.t == 0.5 && hit.u == 0.25 && hit.v == 0.5 && hit.triangle == 1);
    ray.t_after        = hit.t;
    ray.triangle_after = 1;
    assert_true(assay_bvh_closest(bvh, &ray, &hit));
    assert_true(hit.t == 0.5 && hit.u == 0.25 && hit.v == 0.25 && hit.triangle == 2);
    ray.triangle_after = 2;
    assert_true(assay_bvh_closest(bvh, &ray, &hit) && hit.triangle == 4);
    ray.triangle_after = 4;
    assert_false(assay_bvh_closest(bvh, &ray, &hit));
    assert_true(hit.triangle == 4);
    assert_false(assay_bvh_occluded(bvh, &ray));
    assay_bvh_destroy(bvh);
    assay_context_destroy(context);
}

/* t must be > t_after and < t_max; never 0 or negative to begin with. */
static void ends_of_a_ray(void **state)
{
    (void)state;
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assay_bvh *bvh = known_tree(context);
    assay_hit  hit;
    assay_ray  ray = assay_ray_start(vec3(0.25, 0.5, 2), vec3(0, 0, -1), 2.0);
    assert_false(assay_bvh_closest(bvh, &ray, &hit) || assay_bvh_occluded(bvh, &ray));
    ray.t_max = nextafter(2.0, 3.0);
    assert_true(assay_bvh_closest(bvh, &ray, &hit) && assay_bvh_occluded(bvh, &ray));
    ray.t_after = 2.0;
    assert_false(assay_bvh_closest(bvh, &ray, &hit) || assay_bvh_occluded(bvh, &ray));
    ray.t_after = nextafter(2.0, 1.0);
    assert_true(assay_bvh_closest(bvh, &ray, &hit) && assay_bvh_occluded(bvh, &ray));
    ray = assay_ray_start(vec3(0.25, 0.5, 0), vec3(0, 0, -1), INFINITY);
    assert_false(assay_bvh_closest(bvh, &ray, &hit) || assay_bvh_occluded(bvh, &ray));
    ray = assay_ray_start(vec3(0.25, 0.5, -1), vec3(0, 0, -1), INFINITY);
    assert_false(assay_bvh_closest(bvh, &ray, &hit) || assay_bvh_occluded(bvh, &ray));
    ray.t_after = -10.0;
    assert_true(assay_bvh_closest(bvh, &ray, &hit) && hit.t == -1.0);
    assay_bvh_destroy(bvh);
    assay_context_destroy(context);
}

/* The common edge and the corners belong to both halves: the lower number answers. */
static void edges_and_corners_belong(void **state)
{
    (void)state;
    static const double points[][2] = {{0.5, 0.5}, {0.25, 0.75}, {1, 0},     {0, 1},   {1, 1},
                                       {0, 0},     {0.5, 0},     {0, 0.125}, {1, 0.5}, {0.75, 1}};
    assay_context      *context     = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assay_bvh *bvh = known_tree(context);
    for (size_t i = 0; i < sizeof points / sizeof *points; i++) {
        const double    x = points[i][0], y = points[i][1];
        const assay_ray ray = assay_ray_start(vec3(x, y, 1), vec3(0, 0, -1), INFINITY);
        assay_hit       hit;
        assert_true(assay_bvh_closest(bvh, &ray, &hit));
        assert_true(hit.t == 1.0 && hit.triangle == (x + y >= 1.0 ? 0 : 1));
    }
    assay_bvh_destroy(bvh);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agrees_with_113_bits),
        cmocka_unit_test(plain_arithmetic_does_not),
        cmocka_unit_test(exact_hits),
        cmocka_unit_test(ends_of_a_ray),
        cmocka_unit_test(edges_and_corners_belong),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
