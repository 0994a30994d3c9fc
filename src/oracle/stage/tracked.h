/* tracked.h - a number, and how far from it one that was computed with less precision may be.
 *
 * Running error analysis [higham02] 3.3: an operation in a precision of unit roundoff u gives
 * fl(a op b) = (a op b)(1 + d) + t with |d| <= u and |t| <= tiny (underflow).  `v` is the value in
 * double, `e` bounds |x - v| for every x that correctly rounded operations on operands within their
 * own bounds can give; terms of second order are kept, so nothing is left to "small enough".  What
 * contracts a * b + c or keeps more digits than u rounds less, and is covered. */
#ifndef ASSAY_ORACLE_TRACKED_H
#define ASSAY_ORACLE_TRACKED_H

#include "core/numerics.h"
#include "math/vec.h"

typedef struct {
    double v, e;
} tracked;

/* How results are rounded, and how well operands are known that come from outside. */
typedef struct {
    double u;     /* unit roundoff of the operations; that of our own double arithmetic included */
    double tiny;  /* what an operation may lose to underflow                                      */
    double given; /* relative error of every number that is given: it is rounded once when it is
                     stored or taken in                                                          */
    double given_tiny; /* what a given number may lose to underflow then                         */
} rounding;

static inline tracked tracked_rounded(const rounding *r, double v, double e)
{
    return (tracked){v, e + r->u * (fabs(v) + e) + r->tiny};
}

/* How far a number that is given may be from v: nothing is rounded by more than itself. */
static inline double given_error(const rounding *r, double v)
{
    return r->given * fabs(v) + fmin(r->given_tiny, fabs(v));
}

/* A number that is given. */
static inline tracked tracked_given(const rounding *r, double v)
{
    return (tracked){v, given_error(r, v)};
}

/* A constant, or a number of a table, rounded once. */
static inline tracked tracked_constant(const rounding *r, double v)
{
    return (tracked){v, r->u * fabs(v)};
}

static inline tracked tracked_exact(double v) { return (tracked){v, 0.0}; }

static inline tracked tracked_add(const rounding *r, tracked a, tracked b)
{
    return tracked_rounded(r, a.v + b.v, a.e + b.e);
}

static inline tracked tracked_sub(const rounding *r, tracked a, tracked b)
{
    return tracked_rounded(r, a.v - b.v, a.e + b.e);
}

/* The product's error before it is rounded. */
static inline double tracked_product_error(tracked a, tracked b)
{
    return fabs(a.v) * b.e + fabs(b.v) * a.e + a.e * b.e;
}

static inline tracked tracked_mul(const rounding *r, tracked a, tracked b)
{
    return tracked_rounded(r, a.v * b.v, tracked_product_error(a, b));
}

/* e is INFINITY where the divisor may be 0. */
static inline tracked tracked_div(const rounding *r, tracked a, tracked b)
{
    const double least = fabs(b.v) - b.e;
    const double v     = a.v / b.v;
    if (!(least > 0.0)) {
        return (tracked){v, INFINITY};
    }
    return tracked_rounded(r, v, (a.e + fabs(v) * b.e) / least);
}

/* sqrt(max(0, a)) */
static inline tracked tracked_sqrt(const rounding *r, tracked a)
{
    const double middle = a.v > 0.0 ? sqrt(a.v) : 0.0;
    const double high = a.v + a.e > 0.0 ? sqrt(a.v + a.e) : 0.0, lowest = a.v - a.e;
    const double low = lowest > 0.0 ? sqrt(lowest) : 0.0;
    return tracked_rounded(r, middle, fmax(high - middle, middle - low));
}

static inline tracked tracked_negate(tracked a) { return (tracked){-a.v, a.e}; }

static inline double tracked_low(tracked a) { return a.v - a.e; }
static inline double tracked_high(tracked a) { return a.v + a.e; }

/* (1 + u)^n - 1: what n roundings one on the other amount to. */
static inline double rounding_growth(const rounding *r, double n)
{
    return n * r->u < 1e-3 ? n * r->u * (1.0 + n * r->u)
                           : assay_expm1(n * assay_log1p(r->u)) * (1.0 + 1e-9);
}

/* A sum of n terms in any order and any grouping: no term goes through more than n - 1 additions
 * [higham02] 4.2. */
typedef struct {
    double v;         /* the sum                                */
    double size, own; /* of |terms|, with their errors; of these */
    double n;
} tracked_sum;

static inline void tracked_sum_add(tracked_sum *sum, tracked a)
{
    sum->v += a.v;
    sum->size += fabs(a.v) + a.e;
    sum->own += a.e;
    sum->n += 1.0;
}

static inline tracked tracked_sum_of(const rounding *r, const tracked_sum *sum)
{
    const double grown = sum->n > 1.0 ? rounding_growth(r, sum->n - 1.0) * sum->size : 0.0;
    return (tracked){sum->v, sum->own + grown + r->tiny * sum->n};
}

typedef struct {
    tracked x, y, z;
} tracked3;

static inline tracked3 tracked3_given(const rounding *r, assay_vec3 a)
{
    return (tracked3){tracked_given(r, a.x), tracked_given(r, a.y), tracked_given(r, a.z)};
}

static inline void tracked_sum_dot(const rounding *r, tracked_sum *sum, const tracked3 *a,
                                   const tracked3 *b)
{
    tracked_sum_add(sum, tracked_mul(r, a->x, b->x));
    tracked_sum_add(sum, tracked_mul(r, a->y, b->y));
    tracked_sum_add(sum, tracked_mul(r, a->z, b->z));
}

static inline tracked tracked3_dot(const rounding *r, const tracked3 *a, const tracked3 *b)
{
    tracked_sum sum = {0};
    tracked_sum_dot(r, &sum, a, b);
    return tracked_sum_of(r, &sum);
}

static inline tracked3 tracked3_sub(const rounding *r, const tracked3 *a, const tracked3 *b)
{
    return (tracked3){tracked_sub(r, a->x, b->x), tracked_sub(r, a->y, b->y),
                      tracked_sub(r, a->z, b->z)};
}

static inline tracked tracked_cross_part(const rounding *r, tracked a, tracked b, tracked c,
                                         tracked d)
{
    return tracked_sub(r, tracked_mul(r, a, b), tracked_mul(r, c, d));
}

static inline tracked3 tracked3_cross(const rounding *r, const tracked3 *a, const tracked3 *b)
{
    return (tracked3){tracked_cross_part(r, a->y, b->z, a->z, b->y),
                      tracked_cross_part(r, a->z, b->x, a->x, b->z),
                      tracked_cross_part(r, a->x, b->y, a->y, b->x)};
}

#endif
