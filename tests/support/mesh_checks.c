/* mesh_checks.c - topology from sorted edges, overlap from sorted planes. */
#include "mesh_checks.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void *check_alloc(size_t bytes)
{
    void *const memory = malloc(bytes ? bytes : 1);
    assert_non_null(memory);
    return memory;
}

static assay_vec3 double_area_normal(const own_mesh *mesh, size_t t)
{
    const assay_vec3 a = own_mesh_corner(mesh, t, 0);
    return vec3_cross(vec3_sub(own_mesh_corner(mesh, t, 1), a),
                      vec3_sub(own_mesh_corner(mesh, t, 2), a));
}

size_t mesh_degenerate_triangles(const own_mesh *mesh)
{
    size_t count = 0;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        double longest = 0.0;
        for (int c = 0; c < 3; c++) {
            const double side = vec3_length(
                vec3_sub(own_mesh_corner(mesh, t, (c + 1) % 3), own_mesh_corner(mesh, t, c)));
            longest = side > longest ? side : longest;
        }
        count += !(vec3_length(double_area_normal(mesh, t)) > 1e-6 * longest * longest);
    }
    return count;
}

/* ---- corners and edges ---- */

typedef struct {
    assay_vec3 p;
    size_t     corner;
} placed_corner;

static int compare_double(double a, double b) { return (a > b) - (a < b); }

static int compare_place(const void *a, const void *b)
{
    const assay_vec3 p = ((const placed_corner *)a)->p, q = ((const placed_corner *)b)->p;
    const int        x = compare_double(p.x, q.x), y = compare_double(p.y, q.y);
    return x ? x : y ? y : compare_double(p.z, q.z);
}

/* A number for every corner, the same where the places are the same. Release with free. */
static uint32_t *weld(const own_mesh *mesh)
{
    const size_t         count   = 3 * mesh->triangle_count;
    placed_corner *const corners = check_alloc(count * sizeof *corners);
    uint32_t *const      ids     = check_alloc(count * sizeof *ids);
    for (size_t i = 0; i < count; i++) {
        corners[i] = (placed_corner){own_mesh_corner(mesh, i / 3, (int)(i % 3)), i};
    }
    qsort(corners, count, sizeof *corners, compare_place);
    uint32_t id = 0;
    for (size_t i = 0; i < count; i++) {
        id += i > 0 && compare_place(&corners[i - 1], &corners[i]) != 0;
        ids[corners[i].corner] = id;
    }
    free(corners);
    return ids;
}

typedef struct {
    uint32_t low, high;
    bool     reversed;
    size_t   triangle;
    int      corner; /* where the edge begins */
} mesh_edge;

static int compare_edge(const void *a, const void *b)
{
    const mesh_edge *p = a, *q = b;
    if (p->low != q->low) {
        return p->low < q->low ? -1 : 1;
    }
    if (p->high != q->high) {
        return p->high < q->high ? -1 : 1;
    }
    return (int)p->reversed - (int)q->reversed;
}

static mesh_edge *sorted_edges(const own_mesh *mesh, const uint32_t *ids)
{
    const size_t     count = 3 * mesh->triangle_count;
    mesh_edge *const edges = check_alloc(count * sizeof *edges);
    for (size_t i = 0; i < count; i++) {
        const uint32_t a = ids[i], b = ids[i % 3 == 2 ? i - 2 : i + 1];
        edges[i] = (mesh_edge){a < b ? a : b, a < b ? b : a, a > b, i / 3, (int)(i % 3)};
    }
    qsort(edges, count, sizeof *edges, compare_edge);
    return edges;
}

/* Edges from index i on that join the same two places. */
static size_t run_length(const mesh_edge *edges, size_t count, size_t i)
{
    size_t n = 1;
    while (i + n < count && edges[i + n].low == edges[i].low &&
           edges[i + n].high == edges[i].high) {
        n++;
    }
    return n;
}

size_t mesh_unmatched_edges(const own_mesh *mesh, bool (*may_be_open)(assay_vec3 a, assay_vec3 b))
{
    const size_t     count     = 3 * mesh->triangle_count;
    uint32_t *const  ids       = weld(mesh);
    mesh_edge *const edges     = sorted_edges(mesh, ids);
    size_t           unmatched = 0;
    for (size_t i = 0, n; i < count; i += n) {
        n = run_length(edges, count, i);
        if (n == 2 && edges[i].reversed != edges[i + 1].reversed) {
            continue;
        }
        const assay_vec3 a = own_mesh_corner(mesh, edges[i].triangle, edges[i].corner);
        const assay_vec3 b = own_mesh_corner(mesh, edges[i].triangle, (edges[i].corner + 1) % 3);
        unmatched += !(n == 1 && may_be_open && may_be_open(a, b));
    }
    free(edges);
    free(ids);
    return unmatched;
}

size_t mesh_concave_edges(const own_mesh *mesh)
{
    const size_t     count   = 3 * mesh->triangle_count;
    uint32_t *const  ids     = weld(mesh);
    mesh_edge *const edges   = sorted_edges(mesh, ids);
    size_t           concave = 0;
    for (size_t i = 0; i + 1 < count; i++) {
        if (run_length(edges, count, i) == 2) {
            const size_t     t = edges[i].triangle, other = edges[i + 1].triangle;
            const assay_vec3 apex = own_mesh_corner(mesh, other, (edges[i + 1].corner + 2) % 3);
            const assay_vec3 to   = vec3_sub(apex, own_mesh_corner(mesh, t, 0));
            concave += vec3_dot(to, double_area_normal(mesh, t)) > 0.0;
        }
    }
    free(edges);
    free(ids);
    return concave;
}

/* ---- volume ---- */

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i          = parents[i];
    }
    return i;
}

void mesh_volumes(const own_mesh *mesh, double *smallest_out, double *sum_out)
{
    const size_t    count   = 3 * mesh->triangle_count;
    uint32_t *const ids     = weld(mesh);
    uint32_t *const parents = check_alloc(count * sizeof *parents);
    double *const   volumes = check_alloc(count * sizeof *volumes);
    for (size_t i = 0; i < count; i++) {
        parents[i] = (uint32_t)i;
        volumes[i] = 0.0;
    }
    for (size_t i = 0; i < count; i++) {
        parents[root_of(parents, ids[i])] = root_of(parents, ids[i - i % 3]);
    }
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        volumes[root_of(parents, ids[3 * t])] +=
            vec3_dot(own_mesh_corner(mesh, t, 0), double_area_normal(mesh, t)) / 6.0;
    }
    double smallest = INFINITY, sum = 0.0;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const double v = volumes[root_of(parents, ids[3 * t])];
        smallest       = v < smallest ? v : smallest;
    }
    for (size_t i = 0; i < count; i++) {
        sum += volumes[i];
    }
    *smallest_out = smallest;
    *sum_out      = sum;
    free(volumes);
    free(parents);
    free(ids);
}

/* ---- normals ---- */

size_t mesh_wrong_normals(const own_mesh *mesh)
{
    size_t count = 0;
    for (size_t t = 0; mesh->normals && t < mesh->triangle_count; t++) {
        const assay_vec3 ng = vec3_normalize(double_area_normal(mesh, t));
        for (size_t c = 0; c < 3; c++) {
            const float     *n  = mesh->normals + 3 * (size_t)mesh->indices[3 * t + c];
            const assay_vec3 ns = vec3((double)n[0], (double)n[1], (double)n[2]);
            count += !(fabs(vec3_length(ns) - 1.0) < 1e-6 && vec3_dot(ns, ng) > 0.1);
        }
    }
    return count;
}

/* ---- overlap in a plane ---- */

typedef struct {
    assay_vec3 n; /* unit, its first component that is not about zero positive */
    double     d;
    size_t     triangle;
} mesh_plane;

static int compare_plane(const void *a, const void *b)
{
    return compare_double(((const mesh_plane *)a)->d, ((const mesh_plane *)b)->d);
}

static mesh_plane plane_of(const own_mesh *mesh, size_t t)
{
    assay_vec3   n     = vec3_normalize(double_area_normal(mesh, t));
    const double first = fabs(n.x) > 1e-6 ? n.x : fabs(n.y) > 1e-6 ? n.y : n.z;
    n                  = first < 0.0 ? vec3_negate(n) : n;
    return (mesh_plane){n, vec3_dot(n, own_mesh_corner(mesh, t, 0)), t};
}

/* Whether a line along one edge of s, in the plane of normal n, has s and t on its two sides; a
 * common strip of less than 1e-6 m does not count. */
static bool edge_separates(const own_mesh *mesh, size_t s, size_t t, assay_vec3 n)
{
    for (int e = 0; e < 3; e++) {
        const assay_vec3 a = own_mesh_corner(mesh, s, e);
        assay_vec3       side =
            vec3_normalize(vec3_cross(n, vec3_sub(own_mesh_corner(mesh, s, (e + 1) % 3), a)));
        const double inside = vec3_dot(side, vec3_sub(own_mesh_corner(mesh, s, (e + 2) % 3), a));
        side                = inside < 0.0 ? vec3_negate(side) : side;
        bool beyond         = true;
        for (int c = 0; c < 3; c++) {
            beyond &= vec3_dot(side, vec3_sub(own_mesh_corner(mesh, t, c), a)) < 1e-6;
        }
        if (beyond) {
            return true;
        }
    }
    return false;
}

size_t mesh_coplanar_overlaps(const own_mesh *mesh)
{
    mesh_plane *const planes = check_alloc(mesh->triangle_count * sizeof *planes);
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        planes[t] = plane_of(mesh, t);
    }
    qsort(planes, mesh->triangle_count, sizeof *planes, compare_plane);
    size_t overlaps = 0;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        for (size_t j = i + 1; j < mesh->triangle_count && planes[j].d - planes[i].d < 2e-6; j++) {
            const size_t s = planes[i].triangle, t = planes[j].triangle;
            overlaps += vec3_dot(planes[i].n, planes[j].n) > 1.0 - 1e-9 &&
                        !edge_separates(mesh, s, t, planes[i].n) &&
                        !edge_separates(mesh, t, s, planes[i].n);
        }
    }
    free(planes);
    return overlaps;
}
