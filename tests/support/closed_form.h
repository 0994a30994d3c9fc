/* closed_form.h - irradiance that is known exactly. Evaluated in long double with libm. */
#ifndef ASSAY_TESTS_CLOSED_FORM_H
#define ASSAY_TESTS_CLOSED_FORM_H

#include "math/vec.h"

/* From a uniform polygon of radiance 1, clipped at the receiver's horizon: Lambert's formula,
 * E = 1/2 sum theta_i n . gamma_i over the edges (theta: angle an edge subtends, gamma: unit normal
 * of its plane through the receiver).  At most 8 vertices, in either winding. */
long double closed_polygon(const assay_vec3 *vertices, int count, assay_vec3 p, assay_vec3 n);

/* Its vector: the integral of L w over the part above the horizon, 1/2 sum theta_i gamma_i, which
 * points to the polygon.  E = n . vector; the rotational gradient is n x vector. */
assay_vec3 closed_polygon_vector(const assay_vec3 *vertices, int count, assay_vec3 p, assay_vec3 n);

/* Gradient of closed_polygon with respect to p, W/m3, by central differences of the closed form
 * (error about 1e-12 of it). */
assay_vec3 closed_polygon_gradient(const assay_vec3 *vertices, int count, assay_vec3 p,
                                   assay_vec3 n);

/* Rotational gradient g: E(n') = E(n) + (n x n') . g.  By the same differences. */
assay_vec3 closed_polygon_rotation(const assay_vec3 *vertices, int count, assay_vec3 p,
                                   assay_vec3 n);

/* From a sphere of radiance 1 that lies wholly above the horizon: pi R^2 n . r / |r|^3. */
long double closed_sphere(assay_vec3 centre, double radius, assay_vec3 p, assay_vec3 n);

/* Gradient of the same with respect to p. */
assay_vec3 closed_sphere_gradient(assay_vec3 centre, double radius, assay_vec3 p, assay_vec3 n);

/* Form factor between two equal parallel squares of side a at distance c, directly opposed. */
long double closed_parallel_squares(double a, double c);

#endif
