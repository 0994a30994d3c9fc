/* quadrature.h - nodes and weights of Gauss-Legendre rules. */
#ifndef ASSAY_MATH_QUADRATURE_H
#define ASSAY_MATH_QUADRATURE_H

/* The rule of n >= 1 nodes on [-1, 1], exact for polynomials of degree < 2 n: nodes_out ascending
 * and exactly symmetric, weights_out positive.  Both within 1 unit of the last place for n up to
 * some thousands; takes about n^2 / 2 steps. */
void assay_gauss_legendre(int n, double *nodes_out, double *weights_out);

/* The same rule carried over to [a, b]. */
void assay_gauss_legendre_on(double a, double b, int n, double *nodes_out, double *weights_out);

#endif
