/* bvh_kernel_sse2.c - the walk for any x86-64: eight boxes in two vectors of four. */
#include "trace/bvh_tree.h"

#if defined(__x86_64__)
#include <emmintrin.h>

typedef __m128 v4;

static inline v4   v4_load(const float *p) { return _mm_load_ps(p); }
static inline void v4_store(float *p, v4 a) { _mm_store_ps(p, a); }
static inline v4   v4_set1(float x) { return _mm_set1_ps(x); }
static inline v4   v4_set(float x, float y, float z) { return _mm_setr_ps(x, y, z, 1.0F); }
static inline v4   v4_add(v4 a, v4 b) { return _mm_add_ps(a, b); }
static inline v4   v4_subtract(v4 a, v4 b) { return _mm_sub_ps(a, b); }
static inline v4   v4_divide(v4 a, v4 b) { return _mm_div_ps(a, b); }
static inline v4   v4_multiply(v4 a, v4 b) { return _mm_mul_ps(a, b); }
static inline v4   v4_multiply_add(v4 a, v4 b, v4 c) { return _mm_add_ps(_mm_mul_ps(a, b), c); }
static inline v4 v4_multiply_subtract(v4 a, v4 b, v4 c) { return _mm_sub_ps(_mm_mul_ps(a, b), c); }
static inline v4 v4_negative_multiply_add(v4 a, v4 b, v4 c)
{
    return _mm_sub_ps(c, _mm_mul_ps(a, b));
}
static inline v4 v4_min(v4 a, v4 b) { return _mm_min_ps(a, b); }
static inline v4 v4_max(v4 a, v4 b) { return _mm_max_ps(a, b); }
static inline v4 v4_absolute(v4 a) { return _mm_andnot_ps(_mm_set1_ps(-0.0F), a); }
static inline v4 v4_copy_sign(v4 positive, v4 sign)
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

typedef __m128d d2;
typedef struct {
    d2 a, b;
} d4;
#define PAIR(op)                                                                                   \
    (d4) { op(p.a, q.a), op(p.b, q.b) }
static inline d4 d4_load(const float *p)
{
    const v4 v = v4_load(p);
    return (d4){_mm_cvtps_pd(v), _mm_cvtps_pd(_mm_movehl_ps(v, v))};
}
static inline void d4_store(double *p, d4 a)
{
    _mm_store_pd(p, a.a);
    _mm_store_pd(p + 2, a.b);
}
static inline d4 d4_set1(double x) { return (d4){_mm_set1_pd(x), _mm_set1_pd(x)}; }
static inline d4 d4_add(d4 p, d4 q) { return PAIR(_mm_add_pd); }
static inline d4 d4_subtract(d4 p, d4 q) { return PAIR(_mm_sub_pd); }
static inline d4 d4_multiply(d4 p, d4 q) { return PAIR(_mm_mul_pd); }
static inline d4 d4_divide(d4 p, d4 q) { return PAIR(_mm_div_pd); }
static inline d4 d4_min(d4 p, d4 q) { return PAIR(_mm_min_pd); }
static inline d4 d4_max(d4 p, d4 q) { return PAIR(_mm_max_pd); }
static inline d4 d4_absolute(d4 p)
{
    return (d4){_mm_andnot_pd(_mm_set1_pd(-0.0), p.a), _mm_andnot_pd(_mm_set1_pd(-0.0), p.b)};
}
static inline d4       d4_greater(d4 p, d4 q) { return PAIR(_mm_cmpgt_pd); }
static inline d4       d4_greater_equal(d4 p, d4 q) { return PAIR(_mm_cmpge_pd); }
static inline unsigned d4_mask(d4 p)
{
    return (unsigned)_mm_movemask_pd(p.a) | (unsigned)_mm_movemask_pd(p.b) << 2;
}
static inline unsigned d4_and_mask(d4 p, d4 q) { return d4_mask(PAIR(_mm_and_pd)); }
static inline unsigned d4_or_mask(d4 p, d4 q) { return d4_mask(PAIR(_mm_or_pd)); }

#include "trace/bvh_vector_pair.h"

#include "trace/bvh_kernel.h"

static bool supported(void) { return true; }

const bvh_kernel bvh_kernel_sse2 = {"sse2", supported, closest, occluded};
#endif
