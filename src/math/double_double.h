/* double_double.h - numbers of about 106 bits as unevaluated sums of two doubles [dekker71].
 *
 * |lo| is at most half a unit of the last place of hi.  Results are within a few 2^-104 of the
 * exact ones, relatively, as long as nothing comes near the ends of double's range. */
#ifndef ASSAY_MATH_DOUBLE_DOUBLE_H
#define ASSAY_MATH_DOUBLE_DOUBLE_H

#include <math.h>

typedef struct {
    double hi, lo;
} dd;

static inline dd dd_of(double a) { return (dd){a, 0.0}; }
/* Rounded to nearest. */
static inline double dd_round(dd a) { return a.hi + a.lo; }
static inline dd     dd_negate(dd a) { return (dd){-a.hi, -a.lo}; }

/* a + b exactly, in any order of size. */
static inline dd dd_two_sum(double a, double b)
{
    const double s = a + b, t = s - a;
    return (dd){s, (a - (s - t)) + (b - t)};
}

/* a + b exactly, |a| >= |b|. */
static inline dd dd_quick_sum(double a, double b)
{
    const double s = a + b;
    return (dd){s, b - (s - a)};
}

/* a * b exactly. */
static inline dd dd_two_product(double a, double b)
{
    const double p = a * b;
    return (dd){p, fma(a, b, -p)};
}

static inline dd dd_add(dd a, dd b)
{
    const dd s = dd_two_sum(a.hi, b.hi), t = dd_two_sum(a.lo, b.lo);
    const dd u = dd_quick_sum(s.hi, s.lo + t.hi);
    return dd_quick_sum(u.hi, u.lo + t.lo);
}

static inline dd dd_sub(dd a, dd b) { return dd_add(a, dd_negate(b)); }

static inline dd dd_mul(dd a, dd b)
{
    const dd p = dd_two_product(a.hi, b.hi);
    return dd_quick_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

static inline dd dd_scale(dd a, double b)
{
    const dd p = dd_two_product(a.hi, b);
    return dd_quick_sum(p.hi, p.lo + a.lo * b);
}

static inline dd dd_div(dd a, dd b)
{
    const double q = a.hi / b.hi;
    const dd     r = dd_sub(a, dd_scale(b, q));
    const double p = r.hi / b.hi;
    const dd     t = dd_sub(r, dd_scale(b, p));
    return dd_add(dd_quick_sum(q, p), dd_of(t.hi / b.hi));
}

static inline dd dd_div_double(dd a, double b)
{
    const double q = a.hi / b;
    return dd_quick_sum(q, (fma(-q, b, a.hi) + a.lo) / b);
}

/* a >= 0. */
static inline dd dd_sqrt(dd a)
{
    if (!(a.hi > 0.0)) {
        return dd_of(0.0);
    }
    const double x = sqrt(a.hi);
    const dd     r = dd_sub(a, dd_two_product(x, x));
    return dd_quick_sum(x, r.hi / (2.0 * x));
}

#endif
