/* transform.h - affine maps of nodes, in double. */
#ifndef ASSAY_SCENE_TRANSFORM_H
#define ASSAY_SCENE_TRANSFORM_H

#include "math/vec.h"

/* x -> (x y z columns) x + t. */
typedef struct {
    assay_vec3 x, y, z, t;
} assay_affine;

/* Translation (m), rotation (quaternion x y z w), scale of a node. */
typedef struct {
    double translation[3], rotation[4], scale[3];
} assay_pose;

static inline assay_affine affine_identity(void)
{
    return (assay_affine){{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
}

static inline assay_vec3 affine_vector(const assay_affine *a, assay_vec3 v)
{
    return vec3_mad(vec3_mad(vec3_scale(a->x, v.x), v.y, a->y), v.z, a->z);
}

static inline assay_vec3 affine_point(const assay_affine *a, assay_vec3 p)
{
    return vec3_add(affine_vector(a, p), a->t);
}

/* First b, then a. */
static inline assay_affine affine_multiply(const assay_affine *a, const assay_affine *b)
{
    return (assay_affine){affine_vector(a, b->x), affine_vector(a, b->y), affine_vector(a, b->z),
                          affine_point(a, b->t)};
}

/* Of the linear part. */
static inline double affine_determinant(const assay_affine *a)
{
    return vec3_dot(a->x, vec3_cross(a->y, a->z));
}

/* The map of normals: cofactors, which are the determinant times the inverse transpose but exist
 * for singular maps too, turned for mirrors so that outside stays outside.  Lengths are not kept.
 */
static inline assay_affine affine_normal_map(const assay_affine *a)
{
    const double s = affine_determinant(a) < 0.0 ? -1.0 : 1.0;
    return (assay_affine){vec3_scale(vec3_cross(a->y, a->z), s),
                          vec3_scale(vec3_cross(a->z, a->x), s),
                          vec3_scale(vec3_cross(a->x, a->y), s),
                          {0, 0, 0}};
}

/* sum += weight * a */
static inline void affine_add(assay_affine *sum, double weight, const assay_affine *a)
{
    sum->x = vec3_mad(sum->x, weight, a->x);
    sum->y = vec3_mad(sum->y, weight, a->y);
    sum->z = vec3_mad(sum->z, weight, a->z);
    sum->t = vec3_mad(sum->t, weight, a->t);
}

/* From 16 numbers in column-major order; the last row is taken as 0 0 0 1. */
static inline assay_affine affine_from_columns(const double m[16])
{
    return (assay_affine){
        {m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}, {m[12], m[13], m[14]}};
}

/* T * R * S; the quaternion is normalised, of length zero it is no rotation. */
static inline assay_affine affine_from_pose(const assay_pose *pose)
{
    const double *q = pose->rotation, *s = pose->scale, *t = pose->translation;
    const double  square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    const double  k      = square > 0.0 ? 2.0 / square : 0.0;
    const double  x = q[0], y = q[1], z = q[2], w = q[3];
    return (assay_affine){
        vec3_scale(vec3(1.0 - k * (y * y + z * z), k * (x * y + z * w), k * (x * z - y * w)), s[0]),
        vec3_scale(vec3(k * (x * y - z * w), 1.0 - k * (x * x + z * z), k * (y * z + x * w)), s[1]),
        vec3_scale(vec3(k * (x * z + y * w), k * (y * z - x * w), 1.0 - k * (x * x + y * y)), s[2]),
        vec3(t[0], t[1], t[2])};
}

static inline bool affine_finite(const assay_affine *a)
{
    return vec3_finite(a->x) && vec3_finite(a->y) && vec3_finite(a->z) && vec3_finite(a->t);
}

#endif
