/* vector.h - three floats. */
#ifndef BACKEND_VECTOR_H
#define BACKEND_VECTOR_H

#include <math.h>

typedef struct {
    float x, y, z;
} vec;

static inline vec   vec_of(const float *v) { return (vec){v[0], v[1], v[2]}; }
static inline vec   add(vec a, vec b) { return (vec){a.x + b.x, a.y + b.y, a.z + b.z}; }
static inline vec   sub(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y, a.z - b.z}; }
static inline vec   scale(vec a, float s) { return (vec){a.x * s, a.y * s, a.z * s}; }
static inline float dot(vec a, vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec   cross(vec a, vec b)
{
    return (vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline float length(vec a) { return sqrtf(dot(a, a)); }
static inline vec   unit(vec a) { return scale(a, 1.0f / length(a)); }

#endif
