/* numerics.h - elementary functions that give the same bits on every machine.
 *
 * libm's sin, exp, pow ... change their last bit with the CPU; SLEEF's plain-C, FMA-free variants
 * do not.  Nothing outside this file calls either.  sqrt, fabs, floor and division are exact by
 * IEEE 754 and need no care. */
#ifndef ASSAY_CORE_NUMERICS_H
#define ASSAY_CORE_NUMERICS_H

#include <math.h>
#include <sleef.h>
#include <stdint.h>

#define ASSAY_PI 3.14159265358979323846
#define ASSAY_INV_PI 0.31830988618379067154
#define ASSAY_TWO_PI 6.28318530717958647693

/* All but assay_sincos_turns within 1.0 unit of the last place. */
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

/* sin and cos of 2 pi x, within 3.5 units of the last place: the azimuth of a uniform number,
 * without the rounding of 2 pi. */
static inline assay_sincos assay_sincos_turns(double x)
{
    const Sleef_double_2 s = Sleef_cinz_sincospid1_u35purec(2.0 * x);
    return (assay_sincos){s.x, s.y};
}

static inline assay_sincos assay_sincos_radians(double x)
{
    const Sleef_double_2 s = Sleef_cinz_sincosd1_u10purec(x);
    return (assay_sincos){s.x, s.y};
}

#endif
