/* bvh_kernel_avx2.c - the walk for AVX2 and FMA: eight boxes in one vector.
 *
 * AVX-512 machines use it too: wider vectors have nothing to hold where nodes have eight children.
 */
#include "trace/bvh_tree.h"

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma,bmi"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma,bmi")
#endif
#include <immintrin.h>

typedef __m256 v8;
typedef __m128 v4;

static inline v8       v8_load(const float *p) { return _mm256_load_ps(p); }
static inline v8       v8_set1(float x) { return _mm256_set1_ps(x); }
static inline v8       v8_multiply_subtract(v8 a, v8 b, v8 c) { return _mm256_fmsub_ps(a, b, c); }
static inline v8       v8_min(v8 a, v8 b) { return _mm256_min_ps(a, b); }
static inline v8       v8_max(v8 a, v8 b) { return _mm256_max_ps(a, b); }
static inline void     v8_store(float *p, v8 a) { _mm256_store_ps(p, a); }
static inline unsigned v8_less_equal(v8 a, v8 b)
{
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}
static inline v4   v4_load(const float *p) { return _mm_load_ps(p); }
static inline void v4_store(float *p, v4 a) { _mm_store_ps(p, a); }
static inline v4   v4_set1(float x) { return _mm_set1_ps(x); }
static inline v4   v4_set(float x, float y, float z) { return _mm_setr_ps(x, y, z, 1.0F); }
static inline v4   v4_add(v4 a, v4 b) { return _mm_add_ps(a, b); }
static inline v4   v4_subtract(v4 a, v4 b) { return _mm_sub_ps(a, b); }
static inline v4   v4_divide(v4 a, v4 b) { return _mm_div_ps(a, b); }
static inline v4   v4_multiply(v4 a, v4 b) { return _mm_mul_ps(a, b); }
static inline v4   v4_multiply_add(v4 a, v4 b, v4 c) { return _mm_fmadd_ps(a, b, c); }
static inline v4   v4_multiply_subtract(v4 a, v4 b, v4 c) { return _mm_fmsub_ps(a, b, c); }
static inline v4   v4_negative_multiply_add(v4 a, v4 b, v4 c) { return _mm_fnmadd_ps(a, b, c); }
static inline v4   v4_min(v4 a, v4 b) { return _mm_min_ps(a, b); }
static inline v4   v4_max(v4 a, v4 b) { return _mm_max_ps(a, b); }
static inline v4   v4_absolute(v4 a) { return _mm_andnot_ps(_mm_set1_ps(-0.0F), a); }
static inline v4   v4_copy_sign(v4 positive, v4 sign)
{
    return _mm_or_ps(positive, _mm_and_ps(_mm_set1_ps(-0.0F), sign));
}
static inline unsigned v4_signs(v4 a) { return (unsigned)_mm_movemask_ps(a); }
static inline float    v4_largest_of_three(v4 a)
{
    const v4 b = _mm_max_ss(a, _mm_shuffle_ps(a, a, 1));
    return _mm_cvtss_f32(_mm_max_ss(b, _mm_movehl_ps(a, a)));
}
static inline v4       v4_negate(v4 a) { return _mm_xor_ps(a, _mm_set1_ps(-0.0F)); }
static inline unsigned v4_less_equal(v4 a, v4 b)
{
    return (unsigned)_mm_movemask_ps(_mm_cmple_ps(a, b));
}

typedef __m256d        d4;
static inline d4       d4_load(const float *p) { return _mm256_cvtps_pd(_mm_load_ps(p)); }
static inline void d4_store(double *p, d4 a)
{
    _mm256_store_pd(p, a);
}
static inline d4 d4_set1(double x) { return _mm256_set1_pd(x); }
static inline d4       d4_add(d4 a, d4 b) { return _mm256_add_pd(a, b); }
static inline d4       d4_subtract(d4 a, d4 b) { return _mm256_sub_pd(a, b); }
static inline d4       d4_multiply(d4 a, d4 b) { return _mm256_mul_pd(a, b); }
static inline d4       d4_divide(d4 a, d4 b) { return _mm256_div_pd(a, b); }
static inline d4       d4_min(d4 a, d4 b) { return _mm256_min_pd(a, b); }
static inline d4       d4_max(d4 a, d4 b) { return _mm256_max_pd(a, b); }
static inline d4       d4_absolute(d4 a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
static inline d4       d4_greater(d4 a, d4 b) { return _mm256_cmp_pd(a, b, _CMP_GT_OQ); }
static inline d4       d4_greater_equal(d4 a, d4 b) { return _mm256_cmp_pd(a, b, _CMP_GE_OQ); }
static inline unsigned d4_and_mask(d4 a, d4 b)
{
    return (unsigned)_mm256_movemask_pd(_mm256_and_pd(a, b));
}
static inline unsigned d4_or_mask(d4 a, d4 b)
{
    return (unsigned)_mm256_movemask_pd(_mm256_or_pd(a, b));
}

#include "trace/bvh_kernel.h"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

static bool supported(void)
{
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi");
}

const bvh_kernel bvh_kernel_avx2 = {"avx2", supported, closest, occluded};
#endif
