/* frame.h - right-handed orthonormal frames about a unit vector. */
#ifndef ASSAY_MATH_FRAME_H
#define ASSAY_MATH_FRAME_H

#include "math/vec.h"

/* x, y, z = tangent, bitangent, normal; z = x cross y. */
typedef struct {
    assay_vec3 x, y, z;
} assay_frame3;

/* A frame whose z is the unit vector n; continuous but on z = 0 ([duff17], listing 3). */
static inline assay_frame3 frame3_from_z(assay_vec3 n)
{
    const double sign = copysign(1.0, n.z);
    const double a    = -1.0 / (sign + n.z);
    const double b    = n.x * n.y * a;
    return (assay_frame3){vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
                          vec3(b, sign + n.y * n.y * a, -n.y), n};
}

/* A frame whose z is the unit vector n and whose x is as near to t as may be; frame3_from_z where t
 * is parallel to n or zero. */
static inline assay_frame3 frame3_from_zx(assay_vec3 n, assay_vec3 t)
{
    const assay_vec3 x      = vec3_mad(t, -vec3_dot(n, t), n);
    const double     length = vec3_length(x);
    if (!(length > 1e-9 * vec3_length(t))) {
        return frame3_from_z(n);
    }
    const assay_vec3 unit = vec3_scale(x, 1.0 / length);
    return (assay_frame3){unit, vec3_cross(n, unit), n};
}

static inline assay_vec3 frame3_to_world(const assay_frame3 *f, assay_vec3 local)
{
    return vec3_mad(vec3_mad(vec3_scale(f->x, local.x), local.y, f->y), local.z, f->z);
}

static inline assay_vec3 frame3_to_local(const assay_frame3 *f, assay_vec3 world)
{
    return vec3(vec3_dot(f->x, world), vec3_dot(f->y, world), vec3_dot(f->z, world));
}

#endif
