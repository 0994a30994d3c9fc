/* ray_cases.h - meshes and rays that are hard on a ray tracer. */
#ifndef ASSAY_TESTS_RAY_CASES_H
#define ASSAY_TESTS_RAY_CASES_H

#include "trace/bvh.h"

typedef struct {
    float   *positions;
    uint32_t indices[3 * 8192];
    uint32_t vertex_count, triangle_count;
} case_mesh;

/* Triangles of all sizes and shapes in a cube of side 2, some of them twice, some without area. */
case_mesh *case_soup(uint32_t triangle_count, uint64_t seed);
/* Triangles whose corners have integer coordinates up to 16. */
case_mesh *case_lattice(uint32_t triangle_count, uint64_t seed);
/* A closed star-shaped surface about the origin, radius 0.7 to 1: an octahedron, each face divided
 * into 4^level, every vertex moved along its own direction. */
case_mesh *case_star(int level, uint64_t seed);
/* The closed surface of unit cubes with integer corners; (0.5, 0.5, 0.5) is inside, and rays from
 * there run along many faces. */
case_mesh *case_cubes(uint64_t seed);
void       case_mesh_destroy(case_mesh *mesh);

/* Multiplies all positions by a factor, rounded to float. */
void case_mesh_scale(case_mesh *mesh, double factor);

assay_triangles case_triangles(const case_mesh *mesh);
assay_vec3      case_corner(const case_mesh *mesh, uint32_t triangle, int corner);

typedef enum {
    CASE_RANDOM,   /* from anywhere to anywhere                                         */
    CASE_SURFACE,  /* from a point on a triangle                                        */
    CASE_EDGE,     /* through a point of an edge                                        */
    CASE_VERTEX,   /* through a corner                                                  */
    CASE_AXIS,     /* along an axis or a coordinate plane, through lattice points       */
    CASE_IN_PLANE, /* in the plane of a triangle, exactly so for integer coordinates    */
    CASE_GRAZING,  /* nearly in the plane of a triangle                                 */
    CASE_FAR,      /* from 1e5 times the mesh away                                      */
    CASE_FARTHER,  /* from up to 7e13 times the mesh away                               */
    CASE_LENGTHS,  /* directions of lengths 2^-300 to 2^300, with components near zero  */
    CASE_BOUNDED,  /* with t_after, triangle_after and t_max in the way                 */
    CASE_KINDS
} case_kind;

extern const char *const case_names[CASE_KINDS];

/* Ray number i of a kind. */
assay_ray case_ray(const case_mesh *mesh, case_kind kind, uint64_t seed, uint64_t i);

/* 100000, or a million where ASSAY_TEST_FULL is set to 1. */
uint64_t case_count(void);

#endif
