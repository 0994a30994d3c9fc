/* bvh_kernel_sse2.c - the walk for any x86-64: wide vectors are pairs. */
#include "trace/bvh_tree.h"

#if defined(__x86_64__)
#include <emmintrin.h>

#include "trace/bvh_vector_x86.h"

static inline v4 v4_load(const float *p) { return _mm_load_ps(p); }
static inline v4 v4_min(v4 a, v4 b) { return _mm_min_ps(a, b); }

static inline v4 v4_multiply_subtract(v4 a, v4 b, v4 c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }

static inline unsigned v4_less_equal(v4 a, v4 b)
{
    return (unsigned)_mm_movemask_ps(_mm_cmple_ps(a, b));
}

typedef __m128d d2;

static inline d2       d2_low_of(v4 a) { return _mm_cvtps_pd(a); }
static inline d2       d2_high_of(v4 a) { return _mm_cvtps_pd(_mm_movehl_ps(a, a)); }
static inline void     d2_store(double *p, d2 a) { _mm_store_pd(p, a); }
static inline d2       d2_set1(double x) { return _mm_set1_pd(x); }
static inline d2       d2_add(d2 a, d2 b) { return _mm_add_pd(a, b); }
static inline d2       d2_subtract(d2 a, d2 b) { return _mm_sub_pd(a, b); }
static inline d2       d2_multiply(d2 a, d2 b) { return _mm_mul_pd(a, b); }
static inline d2       d2_divide(d2 a, d2 b) { return _mm_div_pd(a, b); }
static inline d2       d2_min(d2 a, d2 b) { return _mm_min_pd(a, b); }
static inline d2       d2_max(d2 a, d2 b) { return _mm_max_pd(a, b); }
static inline d2       d2_absolute(d2 a) { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
static inline d2       d2_greater(d2 a, d2 b) { return _mm_cmpgt_pd(a, b); }
static inline d2       d2_greater_equal(d2 a, d2 b) { return _mm_cmpge_pd(a, b); }
static inline d2       d2_and(d2 a, d2 b) { return _mm_and_pd(a, b); }
static inline d2       d2_or(d2 a, d2 b) { return _mm_or_pd(a, b); }
static inline unsigned d2_bits(d2 a) { return (unsigned)_mm_movemask_pd(a); }

#include "trace/bvh_vector_pair.h"

#include "trace/bvh_kernel.h"

static bool supported(void) { return true; }

const bvh_kernel bvh_kernel_sse2 = {"sse2", supported, closest, occluded};
#endif
