/* solid_mesh.h - triangles as they are being modelled, and the shapes that scenes are put together
 * from.
 *
 * Metres, right-handed, +Y up; fronts are counter-clockwise and face outwards of solids.  A mesh is
 * either flat (no normals) or has a normal at every vertex. */
#ifndef ASSAY_SCENES_SOLID_MESH_H
#define ASSAY_SCENES_SOLID_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "math/vec.h"

typedef struct {
    assay_vec3 *positions;
    assay_vec3 *normals; /* unit; not used where flat   */
    uint32_t   *indices; /* 3 a triangle                */
    size_t      vertex_count, vertex_capacity, index_count, index_capacity;
    bool        flat;
} solid_mesh;

void mesh_init(solid_mesh *mesh, bool flat);
void mesh_release(solid_mesh *mesh);

/* Room for one more element; ends the program when there is none.  Returns the array. */
void *tool_grow(void *array, size_t count, size_t *capacity, size_t element_size);

uint32_t mesh_vertex(solid_mesh *mesh, assay_vec3 position, assay_vec3 normal);
void     mesh_triangle(solid_mesh *mesh, uint32_t a, uint32_t b, uint32_t c);

/* Counter-clockwise corners seen from the front; two triangles, split from a to c. */
void mesh_quad(solid_mesh *mesh, assay_vec3 a, assay_vec3 b, assay_vec3 c, assay_vec3 d);

/* A box; its fronts look outwards, or inwards (a room). */
void mesh_box(solid_mesh *mesh, assay_vec3 low, assay_vec3 high, bool inwards);

/* A sphere: an icosahedron whose triangles were halved `levels` times (20 * 4^levels triangles). */
void mesh_icosphere(solid_mesh *mesh, assay_vec3 centre, double radius, int levels);

/* A point of a profile.  u: distance from the axis or outwards, v: up (m).  smooth: the surface
 * bends here without an edge.  flute: how deep every second meridian is cut in, as a part of u. */
typedef struct {
    double u, v;
    bool   smooth;
    double flute;
} profile_point;

/* Turns a profile that begins and ends on the axis (u = 0), bottom to top, about the Y axis. */
void mesh_revolve(solid_mesh *mesh, const profile_point *profile, size_t count, int segments);

/* Draws a closed profile (counter-clockwise in (u, v)) round the rectangle |x| <= half_x,
 * |z| <= half_z with mitred corners; u points outwards. */
void mesh_rectangular_ring(solid_mesh *mesh, const profile_point *profile, size_t count,
                           double half_x, double half_z);

/* A wall along x with a row of round arches cut from below.  Arch k is centred at
 * (k - (bays - 1) / 2) * bay; the wall reaches `margin` short of half a bay beyond the last. */
typedef struct {
    int    bays, segments;
    double bay, radius, margin, springing, top, thickness; /* m */
} arcade_shape;
void mesh_arcade(solid_mesh *mesh, const arcade_shape *a);

/* A convex profile (u: radius, v: outwards, towards -z; counter-clockwise in (u, v)) drawn along
 * the upper half circle about (0, 0, z0), which it leaves straight downwards by a foot at each end.
 */
void mesh_archivolt(solid_mesh *mesh, const profile_point *profile, size_t count, int segments,
                    double z0, double right_foot, double left_foot);

/* A rectangular sheet of columns * rows quads; at(user, u, v), u and v in [0, 1], gives its points.
 * Its front is where u to the right and v upwards are seen as such. */
void mesh_sheet(solid_mesh *mesh, int columns, int rows,
                assay_vec3 (*at)(const void *user, double u, double v), const void *user);

#endif
