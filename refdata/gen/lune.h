/* lune.h - proven integrals over the part of the hemisphere that a turn about +y leaves above the
 * horizon: H - I = { z > 0 and z' > 0 }, w' = R_y(beta) w, x' = x cos b + z sin b,
 * z' = -x sin b + z cos b (ERRATA T7), 0 < |beta| < pi.
 *
 * Coordinates about the y axis, w = (cos p sin a, sin p, cos p cos a), make it a rectangle:
 * z = cos p cos a, z' = cos p cos(a + b).  With A + B = pi - |b| =: l and
 *
 *     A = l sin^2 w,  B = l cos^2 w,  cos p = cos^2 v,  0 <= w, v <= pi / 2   (y >= 0)
 *
 * the turned and the unturned direction have (z, x) = cos^2 v (sin A, -cos A) and
 * cos^2 v (sin B, cos B) (b > 0; the other way round for b < 0), and
 *
 *     sqrt(z) = cos v sin w sqrt(l sinc A),   y = sin v sqrt(1 + cos^2 v),
 *     dw = 2 l sin w cos w dw  2 cos^3 v / sqrt(1 + cos^2 v) dv
 *
 * are analytic about the whole closed square: Gauss's rule converges geometrically, with a bound
 * from values on Bernstein ellipses (lune.c). */
#ifndef LUNE_H
#define LUNE_H

#include <acb.h>

/* A direction and the direction it is turned to. */
typedef struct {
    acb_t x, y, z, root_z;
    acb_t x2, z2, root_z2; /* y2 = y */
    acb_t weight;          /* solid angle; at nodes: times the node's weight */
} lune_point;

typedef struct {
    /* Adds weight times the integrands. */
    void (*add)(void *user, const lune_point *p, slong precision);
    /* Upper bound of the absolute values of all integrands (without weight) for points in p. */
    void (*bound)(void *user, arb_t out, const lune_point *p, slong precision);
    void *user;
} lune_integrand;

/* Integrates functions that are even in y; each sum that was added up is within error_out of its
 * integral, and error_out < 2^-precision. */
void lune_integrate(arb_t error_out, const lune_integrand *f, const arb_t beta, slong precision);

#endif
