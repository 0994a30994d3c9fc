/* seen.h - scenes of a few polygons and spheres, and hemispheres filled with what is seen of them.
 *
 * Directions and hits are computed here by the textbook, in double: what the tests know exactly is
 * what such a scene gives in closed form. */
#ifndef ASSAY_TESTS_SEEN_H
#define ASSAY_TESTS_SEEN_H

#include <stdint.h>

#include "gather/hemisphere.h"

enum { SEEN_VERTICES = 8 };

typedef enum { SEEN_POLYGON, SEEN_SPHERE } seen_shape;

/* A flat convex polygon, seen from both sides, or a sphere, seen from outside and inside.  Radiance
 * at point q, m: radiance (1 + slope . q)^2. */
typedef struct {
    seen_shape shape;
    assay_vec3 vertices[SEEN_VERTICES];
    int        count; /* of vertices */
    assay_vec3 centre;
    double     radius;
    assay_rgb  radiance;
    assay_vec3 slope;
} seen_object;

typedef struct {
    const seen_object *objects;
    int                count;
    assay_vec3         eye;   /* the hemisphere's point, m      */
    assay_frame3       frame; /* its local frame in the world   */
} seen_scene;

/* The scene at the origin, local frame = world. */
seen_scene seen_from_origin(const seen_object *objects, int count);

/* A parallelogram about its centre, spanned by half edges a and b; radiance grey. */
seen_object seen_quad(assay_vec3 centre, assay_vec3 a, assay_vec3 b, double radiance);
seen_object seen_sphere(assay_vec3 centre, double radius, double radiance);

/* What a local direction sees; direction set. */
assay_cell seen_cell(const seen_scene *scene, assay_vec3 direction);

/* Every cell, at its centre or (layout.jitter) at a place that depends on seed and cell alone. */
void seen_fill(const seen_scene *scene, uint64_t seed, assay_hemisphere *hemisphere);

/* A hemisphere of M x N cells filled with the scene; fails the test without memory. */
assay_hemisphere *seen_hemisphere(assay_context *context, const seen_scene *scene, int m, int n,
                                  assay_strata strata, bool jitter, uint64_t seed);

#endif
