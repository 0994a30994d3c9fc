/* mesh_checks.h - what a well-modelled mesh keeps to.  Corners are the same where their floats are
 * equal, whatever their indices. */
#ifndef ASSAY_TESTS_MESH_CHECKS_H
#define ASSAY_TESTS_MESH_CHECKS_H

#include "own_gltf.h"

/* Triangles whose smallest height is under 1e-6 of their longest side. */
size_t mesh_degenerate_triangles(const own_mesh *mesh);

/* Edges that are not met by exactly one reverse, but for those that `may_be_open` (or NULL) lets
 * pass. */
size_t mesh_unmatched_edges(const own_mesh *mesh, bool (*may_be_open)(assay_vec3 a, assay_vec3 b));

/* Volume (m3) enclosed by each connected part, positive where fronts face outwards; the smallest of
 * them, and their sum. */
void mesh_volumes(const own_mesh *mesh, double *smallest_out, double *sum_out);

/* Corners whose normal is not of unit length within 1e-6 or leans more than 84 degrees from the
 * triangle's own normal; 0 where the mesh has none. */
size_t mesh_wrong_normals(const own_mesh *mesh);

/* Pairs of triangles that lie in one plane (either way round) and overlap by more than an edge. */
size_t mesh_coplanar_overlaps(const own_mesh *mesh);

/* Edges over which the solid is not convex. */
size_t mesh_concave_edges(const own_mesh *mesh);

#endif
