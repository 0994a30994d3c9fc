/* turned_solids.c - profiles turned about an axis, drawn round a rectangle or along an arch.
 *
 * Every solid is closed: each edge is met by its reverse, and no triangle has zero area. */
#include "solid_mesh.h"
#include "turn.h"

/* ---- revolution ---- */

/* Point i of `segments` of the ring that profile point p makes. */
static assay_vec3 ring_point(const profile_point *p, int i, int segments)
{
    const int    k = (i + segments) % segments;
    const turn   a = turn_by((double)k / segments);
    const double r = p->u * (k % 2 ? 1.0 - p->flute : 1.0);
    return vec3(r * a.cos, p->v, r * a.sin);
}

/* Outward normal at ring point i of profile point j, for the band from `low` to `high`. */
static assay_vec3 ring_normal(const profile_point *profile, size_t low, size_t high, size_t j,
                              int i, int segments)
{
    if (profile[j].u == 0.0) {
        return vec3(0.0, profile[high].u > profile[low].u ? -1.0 : 1.0, 0.0);
    }
    const assay_vec3 up =
        vec3_sub(ring_point(&profile[high], i, segments), ring_point(&profile[low], i, segments));
    const assay_vec3 round = vec3_sub(ring_point(&profile[j], i + 1, segments),
                                      ring_point(&profile[j], i - 1, segments));
    return vec3_normalize(vec3_cross(up, round));
}

/* Vertices of profile point j for the band (low, high); returns the first. */
static uint32_t add_ring(solid_mesh *mesh, const profile_point *profile, size_t low, size_t high,
                         size_t j, int segments)
{
    const uint32_t first = (uint32_t)mesh->vertex_count;
    const int      count = profile[j].u == 0.0 ? 1 : segments;
    for (int i = 0; i < count; i++) {
        mesh_vertex(mesh, ring_point(&profile[j], i, segments),
                    ring_normal(profile, low, high, j, i, segments));
    }
    return first;
}

void mesh_revolve(solid_mesh *mesh, const profile_point *profile, size_t count, int segments)
{
    uint32_t above = 0;
    for (size_t j = 0; j + 1 < count; j++) {
        const bool     low_smooth  = j > 0 && profile[j].smooth;
        const bool     high_smooth = j + 2 < count && profile[j + 1].smooth;
        const uint32_t below = low_smooth ? above : add_ring(mesh, profile, j, j + 1, j, segments);
        above = add_ring(mesh, profile, j, high_smooth ? j + 2 : j + 1, j + 1, segments);
        const bool low_pole = profile[j].u == 0.0, high_pole = profile[j + 1].u == 0.0;
        for (int i = 0; i < segments; i++) {
            const uint32_t k = (uint32_t)i, next = (uint32_t)((i + 1) % segments);
            const uint32_t b0 = below + (low_pole ? 0 : k), b1 = below + (low_pole ? 0 : next);
            const uint32_t t0 = above + (high_pole ? 0 : k), t1 = above + (high_pole ? 0 : next);
            if (!high_pole) {
                mesh_triangle(mesh, b0, t0, t1);
            }
            if (!low_pole) {
                mesh_triangle(mesh, b0, t1, b1);
            }
        }
    }
}

/* ---- profiles drawn along a path ---- */

/* Normal (in the profile's plane) of the edge from p to q of a counter-clockwise profile. */
static profile_point edge_normal(const profile_point *p, const profile_point *q)
{
    const double du = q->u - p->u, dv = q->v - p->v, length = sqrt(du * du + dv * dv);
    return (profile_point){.u = dv / length, .v = -du / length};
}

/* Normal at corner `at` (which bounds edge `edge` to edge + 1): the edge's own, or where the corner
 * is smooth the mean of its two edges'. */
static profile_point corner_normal(const profile_point *profile, size_t count, size_t edge,
                                   size_t at)
{
    const profile_point own = edge_normal(&profile[edge], &profile[(edge + 1) % count]);
    if (!profile[at].smooth) {
        return own;
    }
    const size_t        next  = at == edge ? (edge + count - 1) % count : at;
    const profile_point other = edge_normal(&profile[next], &profile[(next + 1) % count]);
    const double        u = own.u + other.u, v = own.v + other.v, length = sqrt(u * u + v * v);
    return (profile_point){.u = u / length, .v = v / length};
}

void mesh_rectangular_ring(solid_mesh *mesh, const profile_point *profile, size_t count,
                           double half_x, double half_z)
{
    static const double corner[4][2]  = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    static const double outward[4][2] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    for (int side = 0; side < 4; side++) {
        for (size_t e = 0; e < count; e++) {
            const uint32_t first = (uint32_t)mesh->vertex_count;
            for (int i = 0; i < 4; i++) {
                const size_t         at = i == 1 || i == 2 ? (e + 1) % count : e;
                const double        *c  = corner[i < 2 ? side : (side + 1) % 4];
                const profile_point *p  = &profile[at];
                const profile_point  n  = corner_normal(profile, count, e, at);
                mesh_vertex(mesh, vec3(c[0] * (half_x + p->u), p->v, c[1] * (half_z + p->u)),
                            vec3(outward[side][0] * n.u, n.v, outward[side][1] * n.u));
            }
            mesh_triangle(mesh, first, first + 1, first + 2);
            mesh_triangle(mesh, first, first + 2, first + 3);
        }
    }
}

/* A half circle that goes on straight downwards at both ends. */
typedef struct {
    int    segments;
    double z0, right_foot, left_foot; /* m */
} arch_path;

/* Station s of the path of an archivolt: the frame's direction of u, and the shift upwards. */
typedef struct {
    double cos, sin, shift;
} arch_station;

static arch_station archivolt_station(const arch_path *path, int s)
{
    if (s == 0) {
        return (arch_station){1.0, 0.0, -path->right_foot};
    }
    if (s == path->segments + 2) {
        return (arch_station){-1.0, 0.0, -path->left_foot};
    }
    const turn a = turn_by(0.5 * (s - 1) / path->segments);
    return (arch_station){a.cos, a.sin, 0.0};
}

static assay_vec3 archivolt_point(const arch_path *path, const profile_point *p, arch_station s)
{
    return vec3(p->u * s.cos, s.shift + p->u * s.sin, path->z0 - p->v);
}

/* Closes an end with a fan (the profile is convex); `reversed` at the near one. */
static void archivolt_end(solid_mesh *mesh, const arch_path *path, const profile_point *profile,
                          size_t count, int station, bool reversed)
{
    const arch_station s     = archivolt_station(path, station);
    const uint32_t     first = (uint32_t)mesh->vertex_count;
    for (size_t j = 0; j < count; j++) {
        mesh_vertex(mesh, archivolt_point(path, &profile[j], s), vec3(0.0, -1.0, 0.0));
    }
    for (uint32_t j = 1; j + 1 < count; j++) {
        mesh_triangle(mesh, first, first + (reversed ? j + 1 : j), first + (reversed ? j : j + 1));
    }
}

void mesh_archivolt(solid_mesh *mesh, const profile_point *profile, size_t count, int segments,
                    double z0, double right_foot, double left_foot)
{
    const arch_path path = {segments, z0, right_foot, left_foot};
    for (int s = 0; s < segments + 2; s++) {
        const arch_station near = archivolt_station(&path, s);
        const arch_station far  = archivolt_station(&path, s + 1);
        for (size_t e = 0; e < count; e++) {
            const uint32_t first = (uint32_t)mesh->vertex_count;
            for (int i = 0; i < 4; i++) {
                const size_t        at = i == 1 || i == 2 ? (e + 1) % count : e;
                const arch_station  st = i < 2 ? near : far;
                const profile_point n  = corner_normal(profile, count, e, at);
                mesh_vertex(mesh, archivolt_point(&path, &profile[at], st),
                            vec3(n.u * st.cos, n.u * st.sin, -n.v));
            }
            mesh_triangle(mesh, first, first + 1, first + 2);
            mesh_triangle(mesh, first, first + 2, first + 3);
        }
    }
    archivolt_end(mesh, &path, profile, count, 0, true);
    archivolt_end(mesh, &path, profile, count, segments + 2, false);
}

/* ---- arcade ---- */

/* The lower edge of an arcade wall: points (x, y) from left to right, and the arch each belongs to
 * (its centre), so that the soffit can be smooth. */
typedef struct {
    double x, y;
} edge_point;

static edge_point arch_point(const arcade_shape *a, int bay, int i)
{
    const double centre = (bay - 0.5 * (a->bays - 1)) * a->bay;
    const turn   angle  = turn_by(0.5 - 0.5 * i / a->segments);
    if (i == 0 || i == a->segments) {
        return (edge_point){centre + (i ? a->radius : -a->radius), a->springing};
    }
    return (edge_point){centre + a->radius * angle.cos, a->springing + a->radius * angle.sin};
}

/* The wall over one step of its lower edge; n0, n1: normals of the soffit at both ends. */
static void arcade_slice(solid_mesh *mesh, const arcade_shape *a, edge_point p, edge_point q,
                         assay_vec3 n0, assay_vec3 n1)
{
    const double h = 0.5 * a->thickness;
    mesh_quad(mesh, vec3(p.x, p.y, h), vec3(q.x, q.y, h), vec3(q.x, a->top, h),
              vec3(p.x, a->top, h));
    mesh_quad(mesh, vec3(q.x, q.y, -h), vec3(p.x, p.y, -h), vec3(p.x, a->top, -h),
              vec3(q.x, a->top, -h));
    mesh_quad(mesh, vec3(p.x, a->top, h), vec3(q.x, a->top, h), vec3(q.x, a->top, -h),
              vec3(p.x, a->top, -h));
    const uint32_t first = mesh_vertex(mesh, vec3(p.x, p.y, -h), n0);
    mesh_vertex(mesh, vec3(q.x, q.y, -h), n1);
    mesh_vertex(mesh, vec3(q.x, q.y, h), n1);
    mesh_vertex(mesh, vec3(p.x, p.y, h), n0);
    mesh_triangle(mesh, first, first + 1, first + 2);
    mesh_triangle(mesh, first, first + 2, first + 3);
}

void mesh_arcade(solid_mesh *mesh, const arcade_shape *a)
{
    const double     half = 0.5 * a->bays * a->bay - a->margin, h = 0.5 * a->thickness;
    const assay_vec3 down = vec3(0.0, -1.0, 0.0);
    edge_point       last = {-half, a->springing};
    for (int bay = 0; bay < a->bays; bay++) {
        const double centre = (bay - 0.5 * (a->bays - 1)) * a->bay;
        arcade_slice(mesh, a, last, arch_point(a, bay, 0), down, down);
        for (int i = 0; i < a->segments; i++) {
            const edge_point p = arch_point(a, bay, i), q = arch_point(a, bay, i + 1);
            arcade_slice(mesh, a, p, q, vec3_normalize(vec3(centre - p.x, a->springing - p.y, 0.0)),
                         vec3_normalize(vec3(centre - q.x, a->springing - q.y, 0.0)));
        }
        last = arch_point(a, bay, a->segments);
    }
    arcade_slice(mesh, a, last, (edge_point){half, a->springing}, down, down);
    mesh_quad(mesh, vec3(half, a->springing, h), vec3(half, a->springing, -h),
              vec3(half, a->top, -h), vec3(half, a->top, h));
    mesh_quad(mesh, vec3(-half, a->springing, -h), vec3(-half, a->springing, h),
              vec3(-half, a->top, h), vec3(-half, a->top, -h));
}

/* ---- sheets ---- */

void mesh_sheet(solid_mesh *mesh, int columns, int rows,
                assay_vec3 (*at)(const void *user, double u, double v), const void *user)
{
    const uint32_t first = (uint32_t)mesh->vertex_count, stride = (uint32_t)columns + 1;
    const double   step = 1e-4;
    for (int j = 0; j <= rows; j++) {
        for (int i = 0; i <= columns; i++) {
            const double     u = (double)i / columns, v = (double)j / rows;
            const assay_vec3 du = vec3_sub(at(user, u + step, v), at(user, u - step, v));
            const assay_vec3 dv = vec3_sub(at(user, u, v + step), at(user, u, v - step));
            mesh_vertex(mesh, at(user, u, v), vec3_normalize(vec3_cross(du, dv)));
        }
    }
    for (int j = 0; j < rows; j++) {
        for (int i = 0; i < columns; i++) {
            const uint32_t k = first + (uint32_t)j * stride + (uint32_t)i;
            mesh_triangle(mesh, k, k + 1, k + 1 + stride);
            mesh_triangle(mesh, k, k + 1 + stride, k + stride);
        }
    }
}
