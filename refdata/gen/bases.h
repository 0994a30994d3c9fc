/* bases.h - the bases in ball arithmetic, for real and complex arguments.
 *
 * All have the form N f(z) p(z) C_m(x, y), where C_m = Re (x + i y)^m for m >= 0 and
 * Im (x + i y)^|m| for m < 0, p is a Jacobi polynomial (given as an explicit sum, no recurrence),
 * and f is a product of powers of sqrt(z) and sqrt(1 + z).  Written so, they are analytic functions
 * of x, y, z and sqrt(z), which is what proven quadrature needs. */
#ifndef BASES_H
#define BASES_H

#include <acb.h>

typedef enum {
    BASIS_SH,            /* thesis signs, index l*l + l + m                              */
    BASIS_HSH,           /* the same                                                     */
    BASIS_ZERNIKE,       /* degree l < order, l - |m| even: index l (l + 1) / 2 + (l + m) / 2 */
    BASIS_MAKHOTKIN,     /* orthonormal under cos(theta) dw; index l*l + l + m           */
    BASIS_MAKHOTKIN_SQRT /* times sqrt(cos(theta)): orthonormal under dw                 */
} basis_kind;

typedef struct basis basis;

basis *basis_create(basis_kind kind, slong order, slong precision);
void   basis_destroy(basis *b);
slong  basis_count(basis_kind kind, slong order);
slong  basis_index(basis_kind kind, slong l, slong m);
/* First l >= m of the basis with this m, and the step to the next. */
slong basis_band_step(basis_kind kind);

/* C_0 ... C_{order-1} of (x, y): cosines and sines have room for order numbers. */
void basis_azimuth(acb_ptr cosines, acb_ptr sines, slong order, const acb_t x, const acb_t y,
                   slong precision);

/* All values.  root_z: an analytic branch of sqrt(z) that is >= 0 on the hemisphere (not looked at
 * for SH).  1 + z must stay off the negative axis: else the result is not finite. */
void basis_values(acb_ptr out, const basis *b, acb_srcptr cosines, acb_srcptr sines, const acb_t z,
                  const acb_t root_z, slong precision);

/* N p(z) of SH, or N p(z) with f left out, for 0 <= m <= l, and the derivative of p(z). */
void basis_polynomial(acb_t value, acb_t derivative, const basis *b, slong l, slong m,
                      const acb_t z, slong precision);

#endif
