/* bvh_kernel_neon.c - the walk for aarch64: wide vectors are pairs. */
#include "trace/bvh_tree.h"

#if defined(__aarch64__)
#include <arm_neon.h>

typedef float32x4_t v4;

static inline v4   v4_load(const float *p) { return vld1q_f32(p); }
static inline void v4_store(float *p, v4 a) { vst1q_f32(p, a); }
static inline v4   v4_set1(float x) { return vdupq_n_f32(x); }
static inline v4   v4_add(v4 a, v4 b) { return vaddq_f32(a, b); }
static inline v4   v4_subtract(v4 a, v4 b) { return vsubq_f32(a, b); }
static inline v4   v4_multiply(v4 a, v4 b) { return vmulq_f32(a, b); }
static inline v4   v4_divide(v4 a, v4 b) { return vdivq_f32(a, b); }
static inline v4   v4_min(v4 a, v4 b) { return vminq_f32(a, b); }
static inline v4   v4_max(v4 a, v4 b) { return vmaxq_f32(a, b); }
static inline v4   v4_absolute(v4 a) { return vabsq_f32(a); }

static inline v4 v4_set(float x, float y, float z) { return (v4){x, y, z, 1.0F}; }

static inline v4 v4_multiply_subtract(v4 a, v4 b, v4 c) { return vfmaq_f32(vnegq_f32(c), a, b); }

static inline v4 v4_copy_sign(v4 positive, v4 sign)
{
    return vbslq_f32(vdupq_n_u32(0x80000000U), sign, positive);
}

/* Bit i of the sum: lane i, whose bits are all ones or all zeros. */
static inline unsigned v4_bits(uint32x4_t a)
{
    const uint32x4_t bit = {1, 2, 4, 8};
    return vaddvq_u32(vandq_u32(a, bit));
}

static inline unsigned v4_signs(v4 a)
{
    return v4_bits(vreinterpretq_u32_s32(vshrq_n_s32(vreinterpretq_s32_f32(a), 31)));
}

static inline unsigned v4_less_equal(v4 a, v4 b) { return v4_bits(vcleq_f32(a, b)); }

static inline float v4_largest_of_three(v4 a)
{
    return vmaxvq_f32(vsetq_lane_f32(0.0F, a, 3)); /* of numbers >= 0 */
}

typedef float64x2_t d2;

static inline d2   d2_low_of(v4 a) { return vcvt_f64_f32(vget_low_f32(a)); }
static inline d2   d2_high_of(v4 a) { return vcvt_high_f64_f32(a); }
static inline void d2_store(double *p, d2 a) { vst1q_f64(p, a); }
static inline d2   d2_set1(double x) { return vdupq_n_f64(x); }
static inline d2   d2_add(d2 a, d2 b) { return vaddq_f64(a, b); }
static inline d2   d2_subtract(d2 a, d2 b) { return vsubq_f64(a, b); }
static inline d2   d2_multiply(d2 a, d2 b) { return vmulq_f64(a, b); }
static inline d2   d2_divide(d2 a, d2 b) { return vdivq_f64(a, b); }
static inline d2   d2_min(d2 a, d2 b) { return vminq_f64(a, b); }
static inline d2   d2_max(d2 a, d2 b) { return vmaxq_f64(a, b); }
static inline d2   d2_absolute(d2 a) { return vabsq_f64(a); }
static inline d2   d2_greater(d2 a, d2 b) { return vreinterpretq_f64_u64(vcgtq_f64(a, b)); }
static inline d2   d2_greater_equal(d2 a, d2 b) { return vreinterpretq_f64_u64(vcgeq_f64(a, b)); }

static inline d2 d2_and(d2 a, d2 b)
{
    return vreinterpretq_f64_u64(vandq_u64(vreinterpretq_u64_f64(a), vreinterpretq_u64_f64(b)));
}

static inline d2 d2_or(d2 a, d2 b)
{
    return vreinterpretq_f64_u64(vorrq_u64(vreinterpretq_u64_f64(a), vreinterpretq_u64_f64(b)));
}

static inline unsigned d2_bits(d2 a)
{
    const uint64x2_t bit = {1, 2};
    return (unsigned)vaddvq_u64(vandq_u64(vreinterpretq_u64_f64(a), bit));
}

#include "trace/bvh_vector_pair.h"

#include "trace/bvh_kernel.h"

static bool supported(void) { return true; }

const bvh_kernel bvh_kernel_neon = {"neon", supported, closest, occluded};
#endif
