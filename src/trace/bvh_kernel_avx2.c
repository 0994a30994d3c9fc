/* bvh_kernel_avx2.c - the walk for AVX2 and FMA: eight boxes, or four corners, in one vector.
 *
 * Machines with AVX-512 use it too: nodes of eight children and leaves of four triangles have
 * nothing to put into wider vectors. */
#include "trace/bvh_tree.h"

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2,fma,bmi"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,fma,bmi")
#endif
#include <immintrin.h>

#include "trace/bvh_vector_x86.h"

typedef __m256  v8;
typedef __m256d d4;

static inline v8   v8_load(const float *p) { return _mm256_load_ps(p); }
static inline v8   v8_set1(float x) { return _mm256_set1_ps(x); }
static inline v8   v8_multiply_subtract(v8 a, v8 b, v8 c) { return _mm256_fmsub_ps(a, b, c); }
static inline v8   v8_min(v8 a, v8 b) { return _mm256_min_ps(a, b); }
static inline v8   v8_max(v8 a, v8 b) { return _mm256_max_ps(a, b); }
static inline void v8_store(float *p, v8 a) { _mm256_store_ps(p, a); }

static inline unsigned v8_less_equal(v8 a, v8 b)
{
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
}

static inline d4   d4_load(const float *p) { return _mm256_cvtps_pd(_mm_load_ps(p)); }
static inline void d4_store(double *p, d4 a) { _mm256_store_pd(p, a); }
static inline d4   d4_set1(double x) { return _mm256_set1_pd(x); }
static inline d4   d4_add(d4 a, d4 b) { return _mm256_add_pd(a, b); }
static inline d4   d4_subtract(d4 a, d4 b) { return _mm256_sub_pd(a, b); }
static inline d4   d4_multiply(d4 a, d4 b) { return _mm256_mul_pd(a, b); }
static inline d4   d4_divide(d4 a, d4 b) { return _mm256_div_pd(a, b); }
static inline d4   d4_min(d4 a, d4 b) { return _mm256_min_pd(a, b); }
static inline d4   d4_max(d4 a, d4 b) { return _mm256_max_pd(a, b); }
static inline d4   d4_absolute(d4 a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
static inline d4   d4_greater(d4 a, d4 b) { return _mm256_cmp_pd(a, b, _CMP_GT_OQ); }
static inline d4   d4_greater_equal(d4 a, d4 b) { return _mm256_cmp_pd(a, b, _CMP_GE_OQ); }

static inline unsigned d4_and_bits(d4 a, d4 b)
{
    return (unsigned)_mm256_movemask_pd(_mm256_and_pd(a, b));
}

static inline unsigned d4_or_bits(d4 a, d4 b)
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
