/* sampling.h - points and directions from uniform numbers, each with its density.
 *
 * u1, u2 are uniform in [0, 1) and independent.  Directions are unit vectors about +z; densities
 * are per steradian or per unit of area.  Pure functions: no state, the same bits everywhere. */
#ifndef ASSAY_MATH_SAMPLING_H
#define ASSAY_MATH_SAMPLING_H

#include "core/numerics.h"
#include "math/vec.h"

/* The direction at height z (cosine of the polar angle) and radius r (its sine), an azimuth of
 * `turns` full turns from +x. */
static inline assay_vec3 assay_direction_about_z(double z, double r, double turns)
{
    const assay_sincos azimuth = assay_sincos_turns(turns);
    return vec3(r * azimuth.cos, r * azimuth.sin, z);
}

/* Uniform on the unit sphere. */
static inline assay_vec3 assay_sample_sphere(double u1, double u2)
{
    /* 1 - z^2 = 4 u1 (1 - u1), without the cancellation. */
    return assay_direction_about_z(1.0 - 2.0 * u1, 2.0 * sqrt(u1 * (1.0 - u1)), u2);
}

static inline double assay_sphere_pdf(void) { return 0.5 * ASSAY_INV_PI * 0.5; }

/* Uniform on the hemisphere z > 0. */
static inline assay_vec3 assay_sample_hemisphere(double u1, double u2)
{
    return assay_direction_about_z(1.0 - u1, sqrt(u1 * (2.0 - u1)), u2);
}

static inline double assay_hemisphere_pdf(double z) { return z > 0.0 ? 0.5 * ASSAY_INV_PI : 0.0; }

/* Density z / pi on the hemisphere z > 0. */
static inline assay_vec3 assay_sample_cosine_hemisphere(double u1, double u2)
{
    return assay_direction_about_z(sqrt(1.0 - u1), sqrt(u1), u2);
}

static inline double assay_cosine_hemisphere_pdf(double z)
{
    return z > 0.0 ? z * ASSAY_INV_PI : 0.0;
}

/* Uniform in the cone about +z whose half angle has the cosine 1 - height, 0 < height <= 2.  The
 * height is asked for, not the cosine, so that narrow cones keep their precision. */
static inline assay_vec3 assay_sample_cone(double height, double u1, double u2)
{
    const double below = u1 * height;
    return assay_direction_about_z(1.0 - below, sqrt(below * (2.0 - below)), u2);
}

/* The rim counts in, with the rounding of z. */
static inline double assay_cone_pdf(double height, double z)
{
    return 1.0 - z <= height + 0x1p-52 ? 0.5 * ASSAY_INV_PI / height : 0.0;
}

/* A point in the plane, or two barycentric coordinates. */
typedef struct {
    double x, y;
} assay_point2;

/* Uniform in the unit disk, in polar coordinates; density 1 / pi. */
static inline assay_point2 assay_sample_disk(double u1, double u2)
{
    const double       r       = sqrt(u1);
    const assay_sincos azimuth = assay_sincos_turns(u2);
    return (assay_point2){r * azimuth.cos, r * azimuth.sin};
}

/* Uniform in a triangle: the barycentric weights x of its second and y of its third vertex;
 * density 1 / area ([turk90]). */
static inline assay_point2 assay_sample_triangle(double u1, double u2)
{
    const double root = sqrt(u1);
    return (assay_point2){root * (1.0 - u2), root * u2};
}

#endif
