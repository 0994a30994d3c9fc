/* numerics.h - elementary functions that give the same bits on every machine.
 *
 * libm's sin, exp, pow ... change their last bit with the CPU; SLEEF's plain-C, FMA-free variants
 * do not.  Nothing outside this file calls either.  sqrt, fabs, floor and division are exact by
 * IEEE 754 and need no care. */
#ifndef ASSAY_CORE_NUMERICS_H
#define ASSAY_CORE_NUMERICS_H

#include <math.h>
#include <sleef.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define ASSAY_PI 3.14159265358979323846
#define ASSAY_INV_PI 0.31830988618379067154
#define ASSAY_TWO_PI 6.28318530717958647693

/* Within 1.0 unit of the last place. */
static inline double assay_sin(double x) { return Sleef_cinz_sind1_u10purec(x); }
static inline double assay_cos(double x) { return Sleef_cinz_cosd1_u10purec(x); }
static inline double assay_tan(double x) { return Sleef_cinz_tand1_u10purec(x); }
static inline double assay_asin(double x) { return Sleef_cinz_asind1_u10purec(x); }
static inline double assay_acos(double x) { return Sleef_cinz_acosd1_u10purec(x); }
static inline double assay_atan(double x) { return Sleef_cinz_atand1_u10purec(x); }
static inline double assay_atan2(double y, double x) { return Sleef_cinz_atan2d1_u10purec(y, x); }
static inline double assay_exp(double x) { return Sleef_cinz_expd1_u10purec(x); }
static inline double assay_exp2(double x) { return Sleef_cinz_exp2d1_u10purec(x); }
static inline double assay_expm1(double x) { return Sleef_cinz_expm1d1_u10purec(x); }
static inline double assay_log(double x) { return Sleef_cinz_logd1_u10purec(x); }
static inline double assay_log1p(double x) { return Sleef_cinz_log1pd1_u10purec(x); }
static inline double assay_pow(double x, double y) { return Sleef_cinz_powd1_u10purec(x, y); }

/* The cube root of a normal number x > 0, within 5 units of the last place; nothing is promised for
 * others.  SLEEF's takes ten times as long, and images ask for it six times a pixel.  A third of
 * the bits taken from a constant is x^(-1/3) times 1 + e, where r = 1 - x y^3 is within 0.103; each
 * step multiplies by the expansion of (1 - r)^(-1/3) to r^3 and leaves 35/81 r^4. */
static inline double assay_cbrt(double x)
{
    uint64_t bits;
    double   y;
    memcpy(&bits, &x, sizeof bits);
    bits = 0x553ee90000000000u - bits / 3;
    memcpy(&y, &bits, sizeof y);
    for (int step = 0; step < 2; step++) {
        const double r = 1.0 - x * y * (y * y);
        y += y * (r * (1.0 / 3.0 + r * (2.0 / 9.0 + r * (14.0 / 81.0))));
    }
    return x * y * y;
}

/* floor without a call: without SSE4.1, which is not asked for, floor is a function. */
static inline double assay_floor(double x)
{
    if (!(fabs(x) < 0x1p52)) {
        return x; /* whole already, or no number */
    }
    const double truncated = (double)(int64_t)x;
    return truncated > x ? truncated - 1.0 : truncated;
}

typedef struct {
    double sin, cos;
} assay_sincos;

/* sin and cos of 2 pi x: the azimuth of a uniform number, without the rounding of 2 pi.  Every
 * vertex of a path asks for it once or twice, so it is written out: the Taylor polynomials of
 * sin(pi r / 2) and cos(pi r / 2) for |r| <= 1/2 of a quarter turn, to where the next term is below
 * 2^-63; r is exact.  Within 2 units of the last place, of sine and cosine each. */
static inline assay_sincos assay_sincos_turns(double x)
{
    const double turns = fabs(x);
    const double t     = 4.0 * (turns - assay_floor(turns)); /* exact; NaN of what is not finite */
    if (!(t <= 4.0)) {
        return (assay_sincos){t, t};
    }
    const int    quarter = (int)(t + 0.5);
    const double r = t - quarter, z = r * r;
    double       sine = 0x1.aaec32af93359p-38;
    sine              = sine * z - 0x1.6fadb9f155744p-31;
    sine              = sine * z + 0x1.e8f434d018d63p-25;
    sine              = sine * z - 0x1.e3074fde8871fp-19;
    sine              = sine * z + 0x1.50783487ee782p-13;
    sine              = sine * z - 0x1.32d2cce62bd86p-8;
    sine              = sine * z + 0x1.466bc6775aae2p-4;
    sine              = sine * z - 0x1.4abbce625be53p-1;
    sine              = (sine * z + 0x1.921fb54442d18p+0) * r;
    double cosine     = -0x1.2a0c591af8314p-41;
    cosine            = cosine * z + 0x1.20c62c2f2d7f5p-34;
    cosine            = cosine * z - 0x1.b6e24f44b128fp-28;
    cosine            = cosine * z + 0x1.f9d38a3763cc3p-22;
    cosine            = cosine * z - 0x1.a6d1f2a204a8cp-16;
    cosine            = cosine * z + 0x1.e1f506891babbp-11;
    cosine            = cosine * z - 0x1.55d3c7e3cbffap-6;
    cosine            = cosine * z + 0x1.03c1f081b5ac4p-2;
    cosine            = cosine * z - 0x1.3bd3cc9be45dep+0;
    cosine            = cosine * z + 1.0;
    const bool   odd  = quarter & 1;
    const double a = odd ? cosine : sine, b = odd ? sine : cosine;
    return (assay_sincos){((quarter & 2) != 0) != (x < 0.0) ? -a : a, (quarter + 1) & 2 ? -b : b};
}

static inline assay_sincos assay_sincos_radians(double x)
{
    const Sleef_double_2 s = Sleef_cinz_sincosd1_u10purec(x);
    return (assay_sincos){s.x, s.y};
}

#endif
