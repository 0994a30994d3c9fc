#include "basis_judge.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = ASSAY_BASIS_MAX_ORDER + 1 };

typedef judged number;

static number of(double x) { return (number){x, 0.0}; }

static number sum_of(double a, double b)
{
    const double s = a + b;
    const double v = s - a;
    return (number){s, (a - (s - v)) + (b - v)};
}

static number add(number a, number b)
{
    const number high = sum_of(a.hi, b.hi);
    const number low  = sum_of(a.lo, b.lo);
    const number part = sum_of(high.hi, high.lo + low.hi);
    return sum_of(part.hi, part.lo + low.lo);
}

static number negate(number a) { return (number){-a.hi, -a.lo}; }
static number subtract(number a, number b) { return add(a, negate(b)); }

static number multiply(number a, number b)
{
    const double p = a.hi * b.hi;
    return sum_of(p, fma(a.hi, b.hi, -p) + (a.hi * b.lo + a.lo * b.hi));
}

static number times(double a, number b) { return multiply(of(a), b); }

/* Long division, three digits of a double each. */
static number divide(number a, number b)
{
    const double q1 = a.hi / b.hi;
    const number r1 = subtract(a, times(q1, b));
    const double q2 = r1.hi / b.hi;
    const number r2 = subtract(r1, times(q2, b));
    return add(sum_of(q1, q2), of(r2.hi / b.hi));
}

static number root(number a)
{
    if (a.hi <= 0.0) {
        return of(0.0);
    }
    number x = of(sqrt(a.hi));
    for (int i = 0; i < 2; i++) {
        x = times(0.5, add(x, divide(a, x)));
    }
    return x;
}

static number factorial_ratio(int top, int bottom) /* top! / bottom! */
{
    number product = of(1.0);
    for (int i = bottom + 1; i <= top; i++) {
        product = times(i, product);
    }
    for (int i = top + 1; i <= bottom; i++) {
        product = divide(product, of(i));
    }
    return product;
}

/* P_0 ... P_count-1 of the parameters a, b [dlmf] 18.9.2. */
static void jacobi(double a, double b, int count, number t, number *p)
{
    const double s = a + b;
    p[0]           = of(1.0);
    p[1]           = times(0.5, add(of(a - b), times(s + 2.0, t)));
    for (int k = 1; k + 1 < count; k++) {
        const double below = 2.0 * (k + 1.0) * (k + s + 1.0) * (2.0 * k + s);
        const number slope = add(times((2.0 * k + s + 2.0) * (2.0 * k + s), t), of(a * a - b * b));
        const number here  = times(2.0 * k + s + 1.0, multiply(slope, p[k]));
        const number last  = times(2.0 * (k + a) * (k + b) * (2.0 * k + s + 2.0), p[k - 1]);
        p[k + 1]           = divide(subtract(here, last), of(below));
    }
}

/* [gautron06] eq. 3.4 to 3.6 without the sign, over (1 - t^2)^(m/2). */
static void legendre(int m, int count, number t, number *p)
{
    p[0] = of(1.0);
    for (int i = 1; i <= m; i++) {
        p[0] = times(2.0 * i - 1.0, p[0]);
    }
    p[1] = times(2.0 * m + 1.0, multiply(t, p[0]));
    for (int k = 2; k < count; k++) {
        const int l = m + k;
        p[k]        = divide(
                   subtract(times(2.0 * l - 1.0, multiply(t, p[k - 1])), times(l + m - 1.0, p[k - 2])),
                   of(k));
    }
}

static bool is_legendre(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_SH || kind == ASSAY_BASIS_HSH || kind == ASSAY_BASIS_ESH ||
           kind == ASSAY_BASIS_LSOSH;
}

/* Square of the length of b over that of (x, y). */
static number squared_length(assay_basis_kind kind, number z)
{
    switch (kind) {
    case ASSAY_BASIS_HSH: return divide(times(4.0, z), add(of(1.0), z));
    case ASSAY_BASIS_ZERNIKE: return divide(of(1.0), add(of(1.0), z));
    case ASSAY_BASIS_MAKHOTKIN:
    case ASSAY_BASIS_MAKHOTKIN_SQRT: return divide(z, add(of(1.0), z));
    default: return of(1.0);
    }
}

/* docs/methods/basis.md: squares of the norms. */
static number squared_norm(assay_basis_kind kind, int l, int m)
{
    const number pi  = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
    const double two = m == 0 ? 1.0 : 2.0;
    if (kind == ASSAY_BASIS_ZERNIKE) {
        return divide(of((l + 1.0) * two), times(2.0, pi));
    }
    if (!is_legendre(kind)) {
        const int    k = l - m;
        const number h =
            divide(multiply(factorial_ratio(k + m, k), factorial_ratio(k + m + 1, k + 2 * m + 1)),
                   of(2.0 * (k + m + 1.0)));
        return divide(of(two), times(2.0, multiply(pi, h)));
    }
    const bool   half   = kind == ASSAY_BASIS_HSH || kind == ASSAY_BASIS_ESH;
    const number square = times((2.0 * l + 1.0) * two, factorial_ratio(l - m, l + m));
    return divide(square, times(half ? 2.0 : 4.0, pi));
}

static void polynomials(assay_basis_kind kind, int m, int order, number z, number *p)
{
    const number shifted = subtract(times(2.0, z), of(1.0));
    if (is_legendre(kind)) {
        legendre(m, order - m + 1, kind == ASSAY_BASIS_HSH ? shifted : z, p);
    } else if (kind == ASSAY_BASIS_ZERNIKE) {
        jacobi(0.0, m, order - m + 1, negate(shifted), p);
    } else {
        jacobi(m, m + 1.0, order - m + 1, shifted, p);
    }
}

void basis_judge(const assay_basis *basis, assay_vec3 d, judged *values_out)
{
    const assay_basis_kind kind  = assay_basis_kind_of(basis);
    const int              order = assay_basis_order(basis);
    const number           dd    = add(add(multiply(of(d.x), of(d.x)), multiply(of(d.y), of(d.y))),
                                       multiply(of(d.z), of(d.z)));
    const number           size  = root(dd);
    const number           z     = divide(of(d.z), size);
    const number           r     = divide(root(squared_length(kind, z)), size);
    const number           x = times(d.x, r), y = times(d.y, r);
    const number           weight = kind == ASSAY_BASIS_MAKHOTKIN_SQRT ? root(z) : of(1.0);
    const bool             signs =
        is_legendre(kind) && assay_basis_convention_of(basis) == ASSAY_CONVENTION_THESIS;
    number re = weight, im = of(0.0);
    for (int m = 0; m < order; m++) {
        number p[SIDE + 1];
        polynomials(kind, m, order, z, p);
        for (size_t i = 0; i < assay_basis_count(basis); i++) {
            int l = 0, number_of = 0;
            assay_basis_function(basis, i, &l, &number_of);
            if (abs(number_of) != m) {
                continue;
            }
            const int    k     = kind == ASSAY_BASIS_ZERNIKE ? (l - m) / 2 : l - m;
            const number norm  = root(squared_norm(kind, l, m));
            const number value = multiply(multiply(norm, p[k]), number_of < 0 ? im : re);
            values_out[i]      = signs && m % 2 != 0 ? negate(value) : value;
        }
        const number next = subtract(multiply(re, x), multiply(im, y));
        im                = add(multiply(re, y), multiply(im, x));
        re                = next;
    }
}

double basis_judge_error(double value, judged truth) { return fabs((value - truth.hi) - truth.lo); }
