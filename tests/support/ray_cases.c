/* ray_cases.c - every ray is a pure function of (kind, seed, number). */
#include "ray_cases.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "math/vec.h"

enum { MAX_VERTICES = 3 * 8192 };

const char *const case_names[CASE_KINDS] = {"random",  "surface",  "edge",    "vertex",
                                            "axis",    "in-plane", "grazing", "far",
                                            "farther", "lengths",  "bounded"};

uint64_t case_count(void)
{
    const char *full = getenv("ASSAY_TEST_FULL");
    return full && strcmp(full, "1") == 0 ? 1000000 : 100000;
}

static double uniform(assay_random *r, double low, double high)
{
    return low + (high - low) * assay_random_next(r);
}

static int integer(assay_random *r, int low, int high)
{
    return low + (int)(assay_random_next(r) * (high - low + 1));
}

/* From 1 to 2^octaves, about evenly on a logarithmic scale; no libm, so the same everywhere. */
static double magnitude(assay_random *r, int octaves)
{
    const int octave = integer(r, 0, octaves - 1);
    return ldexp(1.0 + assay_random_next(r), octave);
}

static assay_vec3 in_cube(assay_random *r, double side)
{
    const double x = uniform(r, -side, side), y = uniform(r, -side, side);
    return vec3(x, y, uniform(r, -side, side));
}

/* ---- meshes ---- */

static case_mesh *new_mesh(void)
{
    case_mesh *m = calloc(1, sizeof *m);
    assert_non_null(m);
    m->positions = calloc(3 * (size_t)MAX_VERTICES, sizeof *m->positions);
    assert_non_null(m->positions);
    return m;
}

void case_mesh_destroy(case_mesh *mesh)
{
    if (mesh) {
        free(mesh->positions);
        free(mesh);
    }
}

static uint32_t add_vertex(case_mesh *m, assay_vec3 p)
{
    assert_true(m->vertex_count < MAX_VERTICES);
    float *at = m->positions + 3 * (size_t)m->vertex_count;
    at[0]     = (float)p.x;
    at[1]     = (float)p.y;
    at[2]     = (float)p.z;
    return m->vertex_count++;
}

static void add_triangle(case_mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *at = m->indices + 3 * (size_t)m->triangle_count++;
    assert_true(m->triangle_count <= 8192);
    at[0] = a;
    at[1] = b;
    at[2] = c;
}

case_mesh *case_soup(uint32_t triangle_count, uint64_t seed)
{
    case_mesh   *m      = new_mesh();
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 1, 0);
    for (uint32_t i = 0; i < triangle_count; i++) {
        const double     size   = 1.0 / magnitude(&random, 6);
        const assay_vec3 centre = in_cube(&random, 1.0);
        const assay_vec3 e = in_cube(&random, size), f = in_cube(&random, size);
        const uint32_t   a    = add_vertex(m, centre);
        const uint32_t   b    = add_vertex(m, vec3_add(centre, e));
        const double     thin = i % 5 == 0 ? 1e-4 : 1.0;
        const uint32_t c = i % 17 == 0 ? b : add_vertex(m, vec3_mad(vec3_add(centre, e), thin, f));
        add_triangle(m, a, b, c);
        if (i % 7 == 0) {
            add_triangle(m, b, c, a);
        }
    }
    return m;
}

case_mesh *case_lattice(uint32_t triangle_count, uint64_t seed)
{
    case_mesh   *m      = new_mesh();
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 2, 0);
    for (uint32_t i = 0; i < triangle_count; i++) {
        uint32_t corner[3];
        for (int c = 0; c < 3; c++) {
            const int x = integer(&random, -16, 16), y = integer(&random, -16, 16);
            corner[c] = add_vertex(m, vec3(x, y, integer(&random, -16, 16)));
        }
        add_triangle(m, corner[0], corner[1], corner[2]);
    }
    return m;
}

/* The vertex halfway between two, made once. */
static uint32_t midpoint(case_mesh *m, uint32_t a, uint32_t b)
{
    const float *p = m->positions + 3 * (size_t)a, *q = m->positions + 3 * (size_t)b;
    const float  x = 0.5F * (p[0] + q[0]), y = 0.5F * (p[1] + q[1]), z = 0.5F * (p[2] + q[2]);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const float *v = m->positions + 3 * (size_t)i;
        if (v[0] == x && v[1] == y && v[2] == z) {
            return i;
        }
    }
    return add_vertex(m, vec3(x, y, z));
}

static void divide(case_mesh *m, int level, uint32_t a, uint32_t b, uint32_t c)
{
    if (level == 0) {
        add_triangle(m, a, b, c);
        return;
    }
    const uint32_t ab = midpoint(m, a, b), bc = midpoint(m, b, c), ca = midpoint(m, c, a);
    divide(m, level - 1, a, ab, ca);
    divide(m, level - 1, ab, b, bc);
    divide(m, level - 1, ca, bc, c);
    divide(m, level - 1, ab, bc, ca);
}

case_mesh *case_star(int level, uint64_t seed)
{
    case_mesh *m = new_mesh();
    uint32_t   x[2], y[2], z[2];
    for (int i = 0; i < 2; i++) {
        const double side = i ? 1.0 : -1.0;
        x[i]              = add_vertex(m, vec3(side, 0, 0));
        y[i]              = add_vertex(m, vec3(0, side, 0));
        z[i]              = add_vertex(m, vec3(0, 0, side));
    }
    for (int i = 0; i < 8; i++) {
        divide(m, level, x[i & 1], y[i >> 1 & 1], z[i >> 2]);
    }
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 3, 0);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        float           *p = m->positions + 3 * (size_t)i;
        const assay_vec3 v =
            vec3_scale(vec3_normalize(vec3(p[0], p[1], p[2])), uniform(&random, 0.7, 1.0));
        p[0] = (float)v.x;
        p[1] = (float)v.y;
        p[2] = (float)v.z;
    }
    return m;
}

/* The square of a cube's side: axis k, corner (x, y, z). */
static void add_square(case_mesh *m, int k, int x, int y, int z)
{
    uint32_t corner[4];
    for (int i = 0; i < 4; i++) {
        int p[3] = {x, y, z};
        p[(k + 1) % 3] += i == 1 || i == 2;
        p[(k + 2) % 3] += i >= 2;
        corner[i] = add_vertex(m, vec3(p[0], p[1], p[2]));
    }
    const int turn = (x + y + z) & 1;
    add_triangle(m, corner[turn], corner[1 + turn], corner[2 + turn]);
    add_triangle(m, corner[turn], corner[2 + turn], corner[(3 + turn) % 4]);
}

case_mesh *case_cubes(uint64_t seed)
{
    enum { N = 7, HALF = 3 };
    static const int none[N + 2][N + 2][N + 2];
    int              filled[N + 2][N + 2][N + 2];
    case_mesh       *m      = new_mesh();
    assay_random     random = assay_random_start(seed, ASSAY_STAGE_TEST, 4, 0);
    memcpy(filled, none, sizeof filled);
    for (int x = 1; x <= N; x++) {
        for (int y = 1; y <= N; y++) {
            for (int z = 1; z <= N; z++) {
                filled[x][y][z] = assay_random_next(&random) < 0.6;
            }
        }
    }
    filled[HALF + 1][HALF + 1][HALF + 1] = 1;
    for (int x = 0; x <= N; x++) {
        for (int y = 0; y <= N; y++) {
            for (int z = 0; z <= N; z++) {
                const int here = filled[x][y][z];
                const int p = x - HALF - 1, q = y - HALF - 1, r = z - HALF - 1;
                if (here != filled[x + 1][y][z]) {
                    add_square(m, 0, p + 1, q, r);
                }
                if (here != filled[x][y + 1][z]) {
                    add_square(m, 1, p, q + 1, r);
                }
                if (here != filled[x][y][z + 1]) {
                    add_square(m, 2, p, q, r + 1);
                }
            }
        }
    }
    return m;
}

void case_mesh_scale(case_mesh *mesh, double factor)
{
    for (size_t i = 0; i < 3 * (size_t)mesh->vertex_count; i++) {
        mesh->positions[i] = (float)(mesh->positions[i] * factor);
    }
}

assay_triangles case_triangles(const case_mesh *mesh)
{
    return (assay_triangles){mesh->positions, mesh->indices, mesh->vertex_count,
                             mesh->triangle_count};
}

assay_vec3 case_corner(const case_mesh *mesh, uint32_t triangle, int corner)
{
    const float *p =
        mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)triangle + (size_t)corner];
    return vec3(p[0], p[1], p[2]);
}

/* ---- rays ---- */

static double mesh_size(const case_mesh *m)
{
    double size = 0.0;
    for (size_t i = 0; i < 3 * (size_t)m->vertex_count; i++) {
        size = fmax(size, fabs((double)m->positions[i]));
    }
    return size;
}

static assay_vec3 inside_triangle(assay_random *r, const case_mesh *m, uint32_t triangle)
{
    const double     u = assay_random_next(r), v = assay_random_next(r) * (1.0 - u);
    const assay_vec3 a = case_corner(m, triangle, 0);
    const assay_vec3 e = vec3_sub(case_corner(m, triangle, 1), a);
    const assay_vec3 f = vec3_sub(case_corner(m, triangle, 2), a);
    return vec3_mad(vec3_mad(a, u, e), v, f);
}

/* In the triangle's plane; without rounding where its corners are integers. */
static assay_ray in_plane(assay_random *r, const case_mesh *m, uint32_t triangle)
{
    const assay_vec3 a = case_corner(m, triangle, 0);
    const assay_vec3 e = vec3_sub(case_corner(m, triangle, 1), a);
    const assay_vec3 f = vec3_sub(case_corner(m, triangle, 2), a);
    const double     i = integer(r, -8, 8) * 0.25, j = integer(r, -8, 8) * 0.25;
    const double     k = integer(r, -8, 8) * 0.25, l = integer(r, -8, 8) * 0.25;
    const assay_vec3 o = vec3_mad(vec3_mad(a, i, e), j, f);
    const assay_vec3 d = vec3_add(vec3_scale(e, k), vec3_scale(f, l));
    return assay_ray_start(o, vec3_length(d) > 0.0 ? d : vec3(1, 0, 0), INFINITY);
}

static assay_ray along_axis(assay_random *r, const case_mesh *m, uint32_t triangle)
{
    const assay_vec3 p    = case_corner(m, triangle, integer(r, 0, 2));
    const assay_vec3 q    = case_corner(m, (triangle + 1) % m->triangle_count, integer(r, 0, 2));
    double           d[3] = {0, 0, 0};
    const int        k    = integer(r, 0, 2);
    d[k]                  = integer(r, 0, 1) ? 1.0 : -1.0;
    if (integer(r, 0, 1)) {
        d[(k + 1) % 3] = integer(r, -2, 2);
    }
    if (integer(r, 0, 3) == 0) {
        d[(k + 2) % 3] = -0.0;
    }
    /* Each coordinate from one corner or the other: on many planes of boxes and triangles. */
    const double     x = integer(r, 0, 1) ? p.x : q.x, y = integer(r, 0, 1) ? p.y : q.y;
    const assay_vec3 mixed     = vec3(x, y, integer(r, 0, 1) ? p.z : q.z);
    const assay_vec3 direction = vec3(d[0], d[1], d[2]);
    const double     back      = integer(r, 0, 1) ? 0.0 : 4.0 * mesh_size(m);
    return assay_ray_start(vec3_mad(mixed, -back, direction), direction, INFINITY);
}

/* From around the mesh, or out of it, to a target. */
static assay_ray toward(assay_random *r, double size, assay_vec3 target)
{
    const assay_vec3 o = in_cube(r, integer(r, 0, 1) ? 3.0 * size : size);
    return assay_ray_start(o, vec3_sub(target, o), INFINITY);
}

static assay_ray from_afar(assay_random *r, double size, double factor, assay_vec3 target)
{
    const assay_vec3 way = vec3_normalize(in_cube(r, 1.0));
    const assay_vec3 o   = vec3_mad(target, factor * size, way);
    return assay_ray_start(o, integer(r, 0, 1) ? vec3_sub(target, o) : vec3_negate(way), INFINITY);
}

static assay_vec3 odd_lengths(assay_random *r, assay_vec3 d)
{
    double    c[3]    = {d.x, d.y, d.z};
    const int smaller = integer(r, 0, 2);
    c[smaller] *= ldexp(1.0, -integer(r, 0, 80));
    if (integer(r, 0, 3) == 0) {
        c[integer(r, 0, 2)] = 0.0;
    }
    const assay_vec3 scaled = vec3_scale(vec3(c[0], c[1], c[2]), ldexp(1.0, integer(r, -300, 300)));
    return vec3_length(scaled) > 0.0 ? scaled : vec3(0, 1, 0);
}

static assay_ray bounded(assay_random *r, const case_mesh *m, assay_ray ray)
{
    ray.t_after = integer(r, 0, 1) ? 0.0 : uniform(r, 0.0, 1.5);
    ray.t_max   = integer(r, 0, 1) ? INFINITY : uniform(r, ray.t_after, 2.0);
    if (integer(r, 0, 1)) {
        ray.triangle_after = (uint32_t)integer(r, 0, (int)m->triangle_count - 1);
    }
    return ray;
}

assay_ray case_ray(const case_mesh *mesh, case_kind kind, uint64_t seed, uint64_t i)
{
    assay_random   random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)kind << 40 | i, 9);
    assay_random  *r      = &random;
    const double   size   = mesh_size(mesh);
    const uint32_t t      = (uint32_t)integer(r, 0, (int)mesh->triangle_count - 1);
    const int      corner = integer(r, 0, 2);
    const assay_vec3 a = case_corner(mesh, t, corner), b = case_corner(mesh, t, (corner + 1) % 3);
    const assay_vec3 inside  = inside_triangle(r, mesh, t);
    const double     part    = integer(r, 0, 64) / 64.0;
    const assay_vec3 on_edge = vec3_mad(a, part, vec3_sub(b, a));
    assay_ray        ray;
    switch (kind) {
    case CASE_SURFACE: return assay_ray_start(inside, in_cube(r, 1.0), INFINITY);
    case CASE_EDGE: return toward(r, size, on_edge);
    case CASE_VERTEX: return toward(r, size, a);
    case CASE_AXIS: return along_axis(r, mesh, t);
    case CASE_IN_PLANE: return in_plane(r, mesh, t);
    case CASE_GRAZING:
        ray           = in_plane(r, mesh, t);
        ray.direction = vec3_add(ray.direction, in_cube(r, size * ldexp(1.0, -integer(r, 10, 60))));
        return ray;
    case CASE_FAR: return from_afar(r, size, 1e5, part < 0.5 ? inside : on_edge);
    case CASE_FARTHER: return from_afar(r, size, magnitude(r, 46), part < 0.5 ? inside : a);
    case CASE_LENGTHS:
        ray           = toward(r, size, inside);
        ray.direction = odd_lengths(r, ray.direction);
        return ray;
    case CASE_BOUNDED: return bounded(r, mesh, toward(r, size, inside));
    default: return toward(r, size, in_cube(r, size));
    }
}
