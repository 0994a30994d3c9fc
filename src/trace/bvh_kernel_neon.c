/* bvh_kernel_neon.c - the walk for aarch64: eight boxes in two vectors of four. */
#include "trace/bvh_tree.h"

#if defined(__aarch64__)
#include <arm_neon.h>

typedef float32x4_t v4;

static inline v4   v4_load(const float *p) { return vld1q_f32(p); }
static inline void v4_store(float *p, v4 a) { vst1q_f32(p, a); }
static inline v4   v4_set1(float x) { return vdupq_n_f32(x); }
static inline v4   v4_subtract(v4 a, v4 b) { return vsubq_f32(a, b); }
static inline v4   v4_multiply(v4 a, v4 b) { return vmulq_f32(a, b); }
static inline v4   v4_multiply_add(v4 a, v4 b, v4 c) { return vfmaq_f32(c, a, b); }
static inline v4   v4_multiply_subtract(v4 a, v4 b, v4 c) { return vfmaq_f32(vnegq_f32(c), a, b); }
static inline v4   v4_negative_multiply_add(v4 a, v4 b, v4 c) { return vfmsq_f32(c, a, b); }
static inline v4   v4_min(v4 a, v4 b) { return vminq_f32(a, b); }
static inline v4   v4_max(v4 a, v4 b) { return vmaxq_f32(a, b); }
static inline v4   v4_negate(v4 a) { return vnegq_f32(a); }
static inline unsigned v4_less_equal(v4 a, v4 b)
{
    static const uint32_t bit[4] = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(vcleq_f32(a, b), vld1q_u32(bit)));
}

#include "trace/bvh_vector_pair.h"

#include "trace/bvh_kernel.h"

static bool supported(void) { return true; }

const bvh_kernel bvh_kernel_neon = {"neon", supported, closest, occluded};
#endif
