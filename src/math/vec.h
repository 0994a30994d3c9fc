/* vec.h - three-vectors and RGB triples, by value. */
#ifndef ASSAY_MATH_VEC_H
#define ASSAY_MATH_VEC_H

#include <math.h>
#include <stdbool.h>

#include "assay/types.h"

static inline assay_vec3 vec3(double x, double y, double z) { return (assay_vec3){x, y, z}; }

static inline assay_vec3 vec3_add(assay_vec3 a, assay_vec3 b)
{
    return vec3(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline assay_vec3 vec3_sub(assay_vec3 a, assay_vec3 b)
{
    return vec3(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline assay_vec3 vec3_scale(assay_vec3 a, double s)
{
    return vec3(a.x * s, a.y * s, a.z * s);
}

/* a + s b */
static inline assay_vec3 vec3_mad(assay_vec3 a, double s, assay_vec3 b)
{
    return vec3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline assay_vec3 vec3_negate(assay_vec3 a) { return vec3(-a.x, -a.y, -a.z); }

static inline double vec3_dot(assay_vec3 a, assay_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline assay_vec3 vec3_cross(assay_vec3 a, assay_vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double vec3_length(assay_vec3 a) { return sqrt(vec3_dot(a, a)); }

/* Zero stays zero. */
static inline assay_vec3 vec3_normalize(assay_vec3 a)
{
    const double length = vec3_length(a);
    return length > 0.0 ? vec3_scale(a, 1.0 / length) : a;
}

static inline bool vec3_finite(assay_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

static inline assay_vec3 vec3_min(assay_vec3 a, assay_vec3 b)
{
    return vec3(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}

static inline assay_vec3 vec3_max(assay_vec3 a, assay_vec3 b)
{
    return vec3(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}

static inline assay_rgb rgb(double r, double g, double b) { return (assay_rgb){r, g, b}; }
static inline assay_rgb rgb_grey(double v) { return rgb(v, v, v); }

static inline assay_rgb rgb_add(assay_rgb a, assay_rgb b)
{
    return rgb(a.r + b.r, a.g + b.g, a.b + b.b);
}

static inline assay_rgb rgb_sub(assay_rgb a, assay_rgb b)
{
    return rgb(a.r - b.r, a.g - b.g, a.b - b.b);
}

static inline assay_rgb rgb_mul(assay_rgb a, assay_rgb b)
{
    return rgb(a.r * b.r, a.g * b.g, a.b * b.b);
}

static inline assay_rgb rgb_scale(assay_rgb a, double s) { return rgb(a.r * s, a.g * s, a.b * s); }

/* (1 - t) a + t b */
static inline assay_rgb rgb_mix(assay_rgb a, assay_rgb b, double t)
{
    return rgb_add(rgb_scale(a, 1.0 - t), rgb_scale(b, t));
}

static inline double rgb_max(assay_rgb a)
{
    const double m = a.r > a.g ? a.r : a.g;
    return m > a.b ? m : a.b;
}

static inline bool rgb_is_black(assay_rgb a) { return a.r == 0.0 && a.g == 0.0 && a.b == 0.0; }

static inline bool rgb_finite(assay_rgb a)
{
    return isfinite(a.r) && isfinite(a.g) && isfinite(a.b);
}

/* Relative luminance, Rec. 709 (ITU-R BT.709-6, 3.2). */
static inline double rgb_luminance(assay_rgb a)
{
    return 0.2126 * a.r + 0.7152 * a.g + 0.0722 * a.b;
}

#endif
