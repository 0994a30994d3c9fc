/* bernstein.h - where bounds for Gauss's rule are taken: on Bernstein ellipses, with foci -1 and 1.
 * Pieces are balls that cover their part of the curve. */
#ifndef BERNSTEIN_H
#define BERNSTEIN_H

#include <acb.h>

/* Piece i of n of the upper half of the ellipse whose half-axes have the sum rho > 1.  Functions
 * that are real on [-1, 1] have the conjugate values on the lower half. */
void bernstein_ellipse_piece(acb_t out, double rho, slong i, slong n, slong precision);

/* Piece i of n of [-1, 1]. */
void bernstein_segment_piece(acb_t out, slong i, slong n, slong precision);

#endif
