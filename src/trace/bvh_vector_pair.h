/* bvh_vector_pair.h - vectors of eight floats as two of four, for bvh_kernel.h.
 *
 * The including file defines v4 and its operations. */
typedef struct {
    v4 a, b;
} v8;

static inline v8 v8_load(const float *p) { return (v8){v4_load(p), v4_load(p + 4)}; }
static inline v8 v8_set1(float x)
{
    const v4 v = v4_set1(x);
    return (v8){v, v};
}
static inline v8 v8_multiply_subtract(v8 p, v8 q, v8 r)
{
    return (v8){v4_multiply_subtract(p.a, q.a, r.a), v4_multiply_subtract(p.b, q.b, r.b)};
}
static inline v8   v8_min(v8 p, v8 q) { return (v8){v4_min(p.a, q.a), v4_min(p.b, q.b)}; }
static inline v8   v8_max(v8 p, v8 q) { return (v8){v4_max(p.a, q.a), v4_max(p.b, q.b)}; }
static inline void v8_store(float *p, v8 v)
{
    v4_store(p, v.a);
    v4_store(p + 4, v.b);
}
static inline unsigned v8_less_equal(v8 p, v8 q)
{
    return v4_less_equal(p.a, q.a) | v4_less_equal(p.b, q.b) << 4;
}
