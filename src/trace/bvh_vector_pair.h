/* bvh_vector_pair.h - the wide vectors of bvh_kernel.h as pairs of vectors of 16 bytes.
 *
 * The including file defines v4 (four floats) and d2 (two doubles) and their operations. */
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

static inline v8 v8_min(v8 p, v8 q) { return (v8){v4_min(p.a, q.a), v4_min(p.b, q.b)}; }

static inline v8 v8_max(v8 p, v8 q) { return (v8){v4_max(p.a, q.a), v4_max(p.b, q.b)}; }

static inline void v8_store(float *p, v8 v)
{
    v4_store(p, v.a);
    v4_store(p + 4, v.b);
}

static inline unsigned v8_less_equal(v8 p, v8 q)
{
    return v4_less_equal(p.a, q.a) | v4_less_equal(p.b, q.b) << 4;
}

typedef struct {
    d2 a, b;
} d4;

static inline d4 d4_load(const float *p)
{
    const v4 v = v4_load(p);
    return (d4){d2_low_of(v), d2_high_of(v)};
}

static inline void d4_store(double *p, d4 v)
{
    d2_store(p, v.a);
    d2_store(p + 2, v.b);
}

static inline d4 d4_set1(double x)
{
    const d2 v = d2_set1(x);
    return (d4){v, v};
}

static inline d4 d4_add(d4 p, d4 q) { return (d4){d2_add(p.a, q.a), d2_add(p.b, q.b)}; }

static inline d4 d4_subtract(d4 p, d4 q)
{
    return (d4){d2_subtract(p.a, q.a), d2_subtract(p.b, q.b)};
}

static inline d4 d4_multiply(d4 p, d4 q)
{
    return (d4){d2_multiply(p.a, q.a), d2_multiply(p.b, q.b)};
}

static inline d4 d4_divide(d4 p, d4 q) { return (d4){d2_divide(p.a, q.a), d2_divide(p.b, q.b)}; }

static inline d4 d4_min(d4 p, d4 q) { return (d4){d2_min(p.a, q.a), d2_min(p.b, q.b)}; }

static inline d4 d4_max(d4 p, d4 q) { return (d4){d2_max(p.a, q.a), d2_max(p.b, q.b)}; }

static inline d4 d4_absolute(d4 p) { return (d4){d2_absolute(p.a), d2_absolute(p.b)}; }

static inline d4 d4_greater(d4 p, d4 q) { return (d4){d2_greater(p.a, q.a), d2_greater(p.b, q.b)}; }

static inline d4 d4_greater_equal(d4 p, d4 q)
{
    return (d4){d2_greater_equal(p.a, q.a), d2_greater_equal(p.b, q.b)};
}

static inline unsigned d4_and_bits(d4 p, d4 q)
{
    return d2_bits(d2_and(p.a, q.a)) | d2_bits(d2_and(p.b, q.b)) << 2;
}

static inline unsigned d4_or_bits(d4 p, d4 q)
{
    return d2_bits(d2_or(p.a, q.a)) | d2_bits(d2_or(p.b, q.b)) << 2;
}
