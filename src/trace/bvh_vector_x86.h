/* bvh_vector_x86.h - vectors of four floats for bvh_kernel.h, in SSE2.
 *
 * To be included after the intrinsics, under the instruction set of the including file. */
typedef __m128 v4;

static inline v4       v4_set(float x, float y, float z) { return _mm_setr_ps(x, y, z, 1.0F); }
static inline v4       v4_set1(float x) { return _mm_set1_ps(x); }
static inline void     v4_store(float *p, v4 a) { _mm_store_ps(p, a); }
static inline v4       v4_add(v4 a, v4 b) { return _mm_add_ps(a, b); }
static inline v4       v4_subtract(v4 a, v4 b) { return _mm_sub_ps(a, b); }
static inline v4       v4_multiply(v4 a, v4 b) { return _mm_mul_ps(a, b); }
static inline v4       v4_divide(v4 a, v4 b) { return _mm_div_ps(a, b); }
static inline v4       v4_max(v4 a, v4 b) { return _mm_max_ps(a, b); }
static inline v4       v4_absolute(v4 a) { return _mm_andnot_ps(_mm_set1_ps(-0.0F), a); }
static inline unsigned v4_signs(v4 a) { return (unsigned)_mm_movemask_ps(a); }

static inline v4 v4_copy_sign(v4 positive, v4 sign)
{
    return _mm_or_ps(positive, _mm_and_ps(_mm_set1_ps(-0.0F), sign));
}

static inline float v4_largest_of_three(v4 a)
{
    const v4 b = _mm_max_ss(a, _mm_shuffle_ps(a, a, 1));
    return _mm_cvtss_f32(_mm_max_ss(b, _mm_movehl_ps(a, a)));
}
