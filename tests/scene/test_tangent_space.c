/* test_tangent_space.c - MikkTSpace's rules on meshes whose tangents are known.
 *
 * Where nothing is said, coordinates are u to the right and v down, as images lie: the tangent then
 * points to +X and w is 1.  Expected means are summed in long double with libm. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/alloc.h"
#include "scene/tangent_space.h"
#include "scene/texture.h"
#include "support/measure.h"
#include "support/near.h"

typedef struct {
    assay_context    *context;
    assay_primitive   p;
    assay_texture_ref ref;
} mesh;

static void *copy(assay_context *context, const void *from, size_t count, size_t size)
{
    void *to = assay_allocate(context, count, size);
    assert_non_null(to);
    memcpy(to, from, count * size);
    return to;
}

/* normals may be NULL: flat. */
static mesh make(assay_context *context, uint32_t vertices, const float *positions,
                 const float *normals, const float *uv, uint32_t triangles, const uint32_t *indices)
{
    mesh m             = {.context = context, .ref = {.texture = ASSAY_NONE, .scale = {1.0, 1.0}}};
    m.p.vertex_count   = vertices;
    m.p.triangle_count = triangles;
    m.p.positions      = copy(context, positions, vertices, 12);
    m.p.normals        = normals ? copy(context, normals, vertices, 12) : NULL;
    m.p.uv[0]          = copy(context, uv, vertices, 8);
    m.p.indices        = copy(context, indices, triangles, 12);
    assay_texture_ref_prepare(&m.ref);
    return m;
}

static void run(mesh *m)
{
    assert_int_equal(assay_primitive_make_tangents(m->context, &m->p, &m->ref), ASSAY_OK);
    assert_non_null(m->p.tangents);
}

static void destroy(mesh *m)
{
    void *const arrays[] = {m->p.positions, m->p.normals, m->p.uv[0],
                            m->p.indices,   m->p.colors,  m->p.tangents};
    for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
        assay_release(m->context, arrays[i]);
    }
}

/* The tangent of corner i of a triangle. */
static const float *tangent(const mesh *m, uint32_t triangle, uint32_t i)
{
    return m->p.tangents + (size_t)m->p.indices[3 * triangle + i] * 4;
}

static double off(const float *t, double x, double y, double z, double w)
{
    return fmax(fmax(fabs(t[0] - x), fabs(t[1] - y)), fmax(fabs(t[2] - z), fabs(t[3] - w)));
}

static const float FRONT[4 * 3 * 3] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1,
                                       0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};

/* ---- surfaces ---- */

enum { SIDE = 6, GRID = SIDE * SIDE, QUADS = (SIDE - 1) * (SIDE - 1) };

static void grid_indices(uint32_t *indices)
{
    for (uint32_t q = 0; q < QUADS; q++) {
        const uint32_t a       = q / (SIDE - 1) * SIDE + q % (SIDE - 1);
        const uint32_t quad[6] = {a, a + 1, a + SIDE + 1, a, a + SIDE + 1, a + SIDE};
        memcpy(indices + 6 * (size_t)q, quad, sizeof quad);
    }
}

/* Affine coordinates on a plane: du/dx ... in `map`; the tangent is the direction in which u grows
 * with v held, w the sign of the triangle's image. */
static void plane(void **state)
{
    (void)state;
    static const double maps[][4] = {{1, 0, 0, -1}, {3, 0, 0, -0.1},       {-1, 0, 0, -1},
                                     {1, 0, 0, 1},  {0.6, 0.8, 0.8, -0.6}, {1, 0.5, 0, -1}};
    float               positions[GRID * 3], normals[GRID * 3], uv[GRID * 2];
    uint32_t            indices[QUADS * 6];
    grid_indices(indices);
    for (size_t k = 0; k < sizeof maps / sizeof maps[0]; k++) {
        const double  *a       = maps[k];
        assay_context *context = measure_context(1);
        for (int i = 0; i < GRID; i++) {
            const double x = i % SIDE * 0.25, y = i / SIDE * 0.5;
            memcpy(positions + 3 * i, (float[3]){(float)x, (float)y, 0}, 12);
            memcpy(normals + 3 * i, FRONT, 12);
            uv[2 * i]     = (float)(a[0] * x + a[1] * y);
            uv[2 * i + 1] = (float)(a[2] * x + a[3] * y);
        }
        mesh m = make(context, GRID, positions, normals, uv, 2 * QUADS, indices);
        run(&m);
        const double determinant = a[0] * a[3] - a[1] * a[2];
        const double x = a[3] / determinant, y = -a[2] / determinant, length = hypot(x, y);
        assert_int_equal(m.p.vertex_count, GRID);
        for (uint32_t c = 0; c < QUADS * 6; c++) {
            const float *t = tangent(&m, c / 3, c % 3);
            assert_near(off(t, x / length, y / length, 0, determinant < 0 ? 1 : -1), 0.0, 1e-6);
        }
        destroy(&m);
        assay_context_destroy(context);
    }
}

/* A cylinder about +Y, u once round it against the clock as seen from above, with a seam: the
 * chords of its facets, laid into the planes of the true normals, all run along the circle. */
static void cylinder(void **state)
{
    (void)state;
    float          positions[GRID * 3], normals[GRID * 3], uv[GRID * 2];
    uint32_t       indices[QUADS * 6];
    assay_context *context = measure_context(1);
    grid_indices(indices);
    for (int i = 0; i < GRID; i++) {
        const double turn = i % SIDE / (SIDE - 1.0), phi = 2.0 * M_PI * turn;
        const float  n[3] = {(float)sin(phi), 0, (float)cos(phi)};
        memcpy(normals + 3 * i, n, sizeof n);
        memcpy(positions + 3 * i, n, sizeof n);
        positions[3 * i + 1] = (float)(i / SIDE);
        uv[2 * i]            = (float)turn;
        uv[2 * i + 1]        = -(float)(i / SIDE);
    }
    mesh m = make(context, GRID, positions, normals, uv, 2 * QUADS, indices);
    run(&m);
    assert_int_equal(m.p.vertex_count, GRID);
    for (int i = 0; i < GRID; i++) {
        const float *n = normals + 3 * i;
        assert_near(off(m.p.tangents + 4 * i, n[2], 0, -n[0], 1), 0.0, 1e-6);
    }
    destroy(&m);
    assay_context_destroy(context);
}

/* ---- the mean ---- */

/* Two triangles at an edge, corners of 90 and 45 degrees at the origin.  The first has u along +X;
 * of the second u grows along (1, 1) and is stretched.  NORMAL leans at all vertices. */
static const float    PAIR[4 * 3]    = {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 1, 0};
static const float    PAIR_UV[4 * 2] = {0, 0, 1, 0, 0, -1, -1, -2};
static const uint32_t PAIR_AT[6]     = {0, 1, 2, 0, 2, 3};

typedef struct {
    long double x, y, z;
} wide;

static long double dot(wide a, wide b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static wide        lay(wide v, wide n)
{
    const long double k      = dot(v, n);
    const wide        r      = {v.x - k * n.x, v.y - k * n.y, v.z - k * n.z};
    const long double length = sqrtl(dot(r, r));
    return (wide){r.x / length, r.y / length, r.z / length};
}

/* weighted: by the angles between edges a, b of the first and b, c of the second; else equally. */
static wide mean(wide n, wide a, wide b, wide c, bool weighted)
{
    const wide        t[2] = {lay((wide){1, 0, 0}, n), lay((wide){1, 1, 0}, n)};
    const wide        pa = lay(a, n), pb = lay(b, n), pc = lay(c, n);
    const long double w0   = weighted ? acosl(dot(pa, pb)) : 1.0L;
    const long double w1   = weighted ? acosl(dot(pb, pc)) : 1.0L;
    const wide        sum  = {w0 * t[0].x + w1 * t[1].x, w0 * t[0].y + w1 * t[1].y,
                              w0 * t[0].z + w1 * t[1].z};
    const wide        unit = lay(sum, n);
    return unit;
}

static void weights_are_angles(void **state)
{
    (void)state;
    static const float leaning[3] = {0.48F, -0.36F, 0.8F};
    assay_context     *context    = measure_context(1);
    for (int k = 0; k < 2; k++) {
        float normals[12];
        for (int i = 0; i < 4; i++) {
            memcpy(normals + 3 * i, k ? leaning : FRONT, 12);
        }
        mesh m = make(context, 4, PAIR, normals, PAIR_UV, 2, PAIR_AT);
        run(&m);
        const wide n      = lay((wide){normals[0], normals[1], normals[2]}, (wide){0, 0, 0});
        const wide origin = mean(n, (wide){1, 0, 0}, (wide){0, 1, 0}, (wide){-1, 1, 0}, true);
        const wide above  = mean(n, (wide){1, -1, 0}, (wide){0, -1, 0}, (wide){-1, 0, 0}, true);
        const wide equal  = mean(n, (wide){1, 0, 0}, (wide){0, 1, 0}, (wide){-1, 1, 0}, false);
        const wide first  = lay((wide){1, 0, 0}, n);
        assert_int_equal(m.p.vertex_count, 4);
        for (uint32_t t = 0; t < 2; t++) {
            const float *o = tangent(&m, t, 0), *a = tangent(&m, t, 2 - t);
            assert_near(off(o, (double)origin.x, (double)origin.y, (double)origin.z, 1), 0, 1e-6);
            assert_near(off(a, (double)above.x, (double)above.y, (double)above.z, 1), 0, 1e-6);
            /* Mutant: equal weights. */
            assert_true(off(o, (double)equal.x, (double)equal.y, (double)equal.z, 1) > 0.05);
        }
        assert_near(off(tangent(&m, 0, 1), (double)first.x, (double)first.y, (double)first.z, 1), 0,
                    1e-6);
        destroy(&m);
    }
    assay_context_destroy(context);
}

/* ---- what belongs together ---- */

/* Corners of their own with the same numbers are one vertex; -0 is 0. */
static void vertices_are_welded(void **state)
{
    (void)state;
    static const uint32_t apart[6] = {0, 1, 2, 3, 4, 5};
    float                 positions[18], uv[12];
    assay_context        *context = measure_context(1);
    for (int c = 0; c < 6; c++) {
        memcpy(positions + 3 * c, PAIR + 3 * (size_t)PAIR_AT[c], 12);
        memcpy(uv + 2 * c, PAIR_UV + 2 * (size_t)PAIR_AT[c], 8);
    }
    positions[9] = positions[10] = -0.0F;
    mesh a                       = make(context, 4, PAIR, FRONT, PAIR_UV, 2, PAIR_AT);
    mesh b                       = make(context, 6, positions, FRONT, uv, 2, apart);
    run(&a);
    run(&b);
    assert_int_equal(b.p.vertex_count, 6);
    for (uint32_t c = 0; c < 6; c++) {
        assert_memory_equal(tangent(&a, c / 3, c % 3), tangent(&b, c / 3, c % 3), 16);
    }
    destroy(&a);
    destroy(&b);
    /* Mutant: another coordinate in the last place, and they are strangers. */
    uv[6]  = 1e-7F;
    mesh c = make(context, 6, positions, FRONT, uv, 2, apart);
    run(&c);
    assert_near(off(tangent(&c, 0, 0), 1, 0, 0, 1), 0.0, 1e-6);
    assert_true(off(tangent(&c, 1, 0), 1, 0, 0, 1) > 0.1);
    destroy(&c);
    assay_context_destroy(context);
}

static const float    SEAM[18]    = {-1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, 1, 0};
static const float    SEAM_UV[12] = {1, 0, 0, 0, 1, 0, 1, -1, 0, -1, 1, -1};
static const uint16_t SEAM_AT[12] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};

/* An image and its mirror image meet at x = 0, with shared vertices: each side keeps its own, and
 * the vertices of the seam are doubled with all that they have. */
static void mirrored_seam(void **state)
{
    (void)state;
    float          colors[24];
    uint32_t       at[12];
    assay_context *context = measure_context(1);
    for (int i = 0; i < 24; i++) {
        colors[i] = (float)i;
    }
    for (int c = 0; c < 12; c++) {
        at[c] = SEAM_AT[c];
    }
    mesh m     = make(context, 6, SEAM, FRONT, SEAM_UV, 4, at);
    m.p.colors = copy(context, colors, 6, 16);
    run(&m);
    assert_int_equal(m.p.vertex_count, 8);
    for (uint32_t c = 0; c < 12; c++) {
        const uint32_t v = m.p.indices[c];
        assert_near(off(tangent(&m, c / 3, c % 3), c < 6 ? -1 : 1, 0, 0, c < 6 ? -1 : 1), 0, 1e-6);
        assert_memory_equal(m.p.positions + 3 * (size_t)v, SEAM + 3 * (size_t)at[c], 12);
        assert_memory_equal(m.p.normals + 3 * (size_t)v, FRONT, 12);
        assert_memory_equal(m.p.uv[0] + 2 * (size_t)v, SEAM_UV + 2 * (size_t)at[c], 8);
        assert_memory_equal(m.p.colors + 4 * (size_t)v, colors + 4 * (size_t)at[c], 16);
        assert_true(v == at[c] || v >= 6);
    }
    destroy(&m);
    assay_context_destroy(context);
}

/* A vertex alone does not connect; neither does an edge that both run the same way. */
static void strangers(void **state)
{
    (void)state;
    static const float    bow[15]    = {0, 0, 0, 1, 0, 0, 1, 1, 0, -1, 0, 0, -1, -1, 0};
    static const float    bow_uv[10] = {0, 0, 1, 0, 1, -1, -1, 1, -1, 2};
    static const uint32_t bow_at[6]  = {0, 1, 2, 0, 3, 4};
    static const uint32_t same[6]    = {0, 1, 2, 0, 3, 2};
    assay_context        *context    = measure_context(1);
    mesh                  m          = make(context, 5, bow, FRONT, bow_uv, 2, bow_at);
    run(&m);
    assert_int_equal(m.p.vertex_count, 6);
    assert_near(off(tangent(&m, 0, 0), 1, 0, 0, 1), 0.0, 1e-6);
    assert_near(off(tangent(&m, 1, 0), sqrt(0.5), -sqrt(0.5), 0, 1), 0.0, 1e-6);
    destroy(&m);
    m = make(context, 4, PAIR, FRONT, PAIR_UV, 2, same);
    run(&m);
    assert_near(off(tangent(&m, 0, 0), 1, 0, 0, 1), 0.0, 1e-6);
    destroy(&m);
    assay_context_destroy(context);
}

/* ---- no image, no area ---- */

static void blank_and_point_triangles(void **state)
{
    (void)state;
    /* A square, whose second half has no image; a triangle with two corners at one place; and one
     * without an image, far from all. */
    static const float    positions[27] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 1, 0,
                                           0, 5, 0, 0, 6, 0, 0, 5, 1, 0, 2, 2, 0};
    static const float    normals[27]   = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0,
                                           1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float    uv[18]  = {0, 0, 1, 0, 0, -1, 0.5F, -0.5F, 1, 0, 0, 0, 0, 0, 0, 0, 3, 3};
    static const uint32_t at[12]  = {0, 1, 2, 1, 3, 2, 1, 4, 8, 5, 6, 7};
    assay_context        *context = measure_context(1);
    mesh                  m       = make(context, 9, positions, normals, uv, 4, at);
    run(&m);
    for (uint32_t t = 0; t < 2; t++) {
        for (uint32_t i = 0; i < 3; i++) {
            if (t == 1 && i == 1) { /* only its own triangle, which says nothing */
                assert_near(off(tangent(&m, t, i), 0, 0, 0, 1), 0.0, 0.0);
            } else {
                assert_near(off(tangent(&m, t, i), 1, 0, 0, 1), 0.0, 1e-6);
            }
        }
    }
    assert_near(off(tangent(&m, 2, 0), 1, 0, 0, 1), 0.0, 1e-6);
    assert_near(off(tangent(&m, 2, 1), 1, 0, 0, 1), 0.0, 1e-6);
    for (uint32_t i = 0; i < 3; i++) {
        assert_near(off(tangent(&m, 3, i), 0, 0, 0, 1), 0.0, 0.0);
    }
    destroy(&m);
    assay_context_destroy(context);
}

/* A blank triangle between two others connects them: at the origin as in the pair above. */
static void blank_triangles_connect(void **state)
{
    (void)state;
    static const float    positions[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 1, 0, -1, 0, 0};
    static const float    normals[15]   = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float    uv[10]        = {0, 0, 1, 0, 0, -1, 0, -2, -1, -1};
    static const uint32_t at[9]         = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    const wide            n             = {0, 0, 1};
    const wide            t = mean(n, (wide){1, 0, 0}, (wide){0, 1, 0}, (wide){-1, 1, 0}, true);
    assay_context        *context = measure_context(1);
    mesh                  m       = make(context, 5, positions, normals, uv, 3, at);
    run(&m);
    for (uint32_t k = 0; k < 3; k++) {
        assert_near(off(tangent(&m, k, 0), (double)t.x, (double)t.y, 0, 1), 0.0, 1e-6);
    }
    destroy(&m);
    assay_context_destroy(context);
}

/* Coordinates that are no numbers count as no image. */
static void odd_coordinates(void **state)
{
    (void)state;
    static const float odd[4]  = {NAN, INFINITY, -INFINITY, 3e38F};
    assay_context     *context = measure_context(1);
    for (int k = 0; k < 4; k++) {
        float uv[8];
        memcpy(uv, PAIR_UV, sizeof uv);
        uv[6]  = odd[k];
        mesh m = make(context, 4, PAIR, FRONT, uv, 2, PAIR_AT);
        run(&m);
        for (uint32_t v = 0; v < m.p.vertex_count * 4; v++) {
            assert_true(isfinite(m.p.tangents[v]));
        }
        destroy(&m);
    }
    assay_context_destroy(context);
}

/* ---- order ---- */

static double noise(uint32_t i)
{
    i = (i ^ 61U ^ (i >> 16)) * 0x9E3779B1U;
    i = (i ^ (i >> 15)) * 0x85EBCA77U;
    return (i ^ (i >> 13)) / 4294967296.0;
}

/* A bumpy sheet with crooked coordinates, part of them mirrored; then the same with its triangles
 * in another order and their corners turned. */
static void order_of_triangles_does_not_matter(void **state)
{
    (void)state;
    float    positions[GRID * 3], normals[GRID * 3], uv[GRID * 2];
    uint32_t indices[QUADS * 6], other[QUADS * 6], from[2 * QUADS];
    grid_indices(indices);
    for (uint32_t i = 0; i < GRID; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            const double flat    = k == 0 ? i % SIDE : k == 1 ? (double)(i / SIDE) : 0.0;
            positions[3 * i + k] = (float)(flat + 0.3 * noise(8 * i + k));
            normals[3 * i + k]   = (float)((k == 2) + 0.4 * noise(8 * i + 3 + k));
        }
        uv[2 * i]     = (float)(fabs(i % SIDE - 2.0) + 0.3 * noise(8 * i + 6));
        uv[2 * i + 1] = (float)(-(double)(i / SIDE) + 0.3 * noise(8 * i + 7));
    }
    for (uint32_t t = 0; t < 2 * QUADS; t++) {
        from[t] = 17 * t % (2 * QUADS);
        for (uint32_t i = 0; i < 3; i++) {
            other[3 * t + i] = indices[3 * from[t] + (i + t) % 3];
        }
    }
    assay_context *context = measure_context(1);
    mesh           a       = make(context, GRID, positions, normals, uv, 2 * QUADS, indices);
    mesh           b       = make(context, GRID, positions, normals, uv, 2 * QUADS, other);
    run(&a);
    run(&b);
    assert_true(a.p.vertex_count > GRID && a.p.vertex_count == b.p.vertex_count);
    for (uint32_t t = 0; t < 2 * QUADS; t++) {
        for (uint32_t i = 0; i < 3; i++) {
            const float *x = tangent(&a, from[t], (i + t) % 3), *y = tangent(&b, t, i);
            assert_near(off(x, y[0], y[1], y[2], y[3]), 0.0, 1e-6);
        }
    }
    destroy(&a);
    destroy(&b);
    assay_context_destroy(context);
}

/* ---- flat, transformed ---- */

/* Without normals, triangles of one plane share; over a crease they do not. */
static void flat_meshes(void **state)
{
    (void)state;
    float          bent[12];
    assay_context *context = measure_context(1);
    mesh           m       = make(context, 4, PAIR, NULL, PAIR_UV, 2, PAIR_AT);
    run(&m);
    assert_int_equal(m.p.vertex_count, 4);
    assert_memory_equal(tangent(&m, 0, 0), tangent(&m, 1, 0), 16);
    destroy(&m);
    memcpy(bent, PAIR, sizeof bent);
    bent[11] = 1.0F;
    m        = make(context, 4, bent, NULL, PAIR_UV, 2, PAIR_AT);
    run(&m);
    assert_int_equal(m.p.vertex_count, 6);
    assert_near(off(tangent(&m, 0, 0), 1, 0, 0, 1), 0.0, 1e-6);
    destroy(&m);
    assay_context_destroy(context);
}

/* The transform of the reference turns what u is. */
static void transforms(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    mesh           m       = make(context, 4, PAIR, FRONT, PAIR_UV, 1, PAIR_AT);
    m.ref.rotation         = 0.5 * M_PI; /* u' = v, v' = -u */
    assay_texture_ref_prepare(&m.ref);
    run(&m);
    assert_near(off(tangent(&m, 0, 0), 0, -1, 0, 1), 0.0, 1e-6);
    destroy(&m);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plane),
        cmocka_unit_test(cylinder),
        cmocka_unit_test(weights_are_angles),
        cmocka_unit_test(vertices_are_welded),
        cmocka_unit_test(mirrored_seam),
        cmocka_unit_test(strangers),
        cmocka_unit_test(blank_and_point_triangles),
        cmocka_unit_test(blank_triangles_connect),
        cmocka_unit_test(odd_coordinates),
        cmocka_unit_test(order_of_triangles_does_not_matter),
        cmocka_unit_test(flat_meshes),
        cmocka_unit_test(transforms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
