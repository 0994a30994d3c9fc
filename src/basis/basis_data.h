/* basis_data.h - inside a basis: every kind is the same three things.
 *
 * A function is  scale q_k(t) Re or Im b^m:  b a complex number whose length is the sine of an
 * angle, q_k a Jacobi polynomial of parameters (alpha, beta) that depend on m, divided by its value
 * at an end of [-1, 1] (docs/methods/basis.md, "Algorithm"). */
#ifndef ASSAY_BASIS_DATA_H
#define ASSAY_BASIS_DATA_H

#include "assay/basis.h"

/* Degree k of one m: its place among the values, and the way to degree k + 1,
 *     q_{k+1} = (1 + c - a (1 - t)) q_k - c q_{k-1}. */
typedef struct {
    double a, c;
    double scale;
    int    plus, minus; /* index of the functions m and -m; -1: not in the basis */
} basis_step;

/* Directions are treated differently near an end of t and away from it.  Kinds with alpha = beta:
 * zone 0 is |t| >= 1/2, both ends, and zone 1 the middle.  Others: zone 0 is t >= 0, normalised at
 * t = 1, and zone 1 the rest, normalised at t = -1. */
enum { BASIS_ZONES = 2 };

struct assay_basis {
    assay_context   *context;
    assay_basis_kind kind;
    assay_convention convention;
    int              order;
    size_t           count;
    bool             symmetric;                    /* alpha = beta                       */
    int              steps[ASSAY_BASIS_MAX_ORDER]; /* degrees for each m                 */
    basis_step      *zone[BASIS_ZONES];            /* by m, then k                       */
    signed char      l[ASSAY_BASIS_MAX_ORDER * ASSAY_BASIS_MAX_ORDER];
    signed char      m[ASSAY_BASIS_MAX_ORDER * ASSAY_BASIS_MAX_ORDER];
};

/* How functions l, |m| of a kind come by their polynomial: degree k = (l - |m|) / stride. */
static inline int basis_stride(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_ZERNIKE ? 2 : 1;
}

/* Whether only l + m even is in the basis. */
static inline bool basis_is_even(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_ZERNIKE || kind == ASSAY_BASIS_ESH;
}

/* Whether t = z (and not 2 z - 1). */
static inline bool basis_is_spherical(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_SH || kind == ASSAY_BASIS_ESH || kind == ASSAY_BASIS_LSOSH;
}

/* Index of function (l, m). */
size_t basis_index(const assay_basis *basis, int l, int m);

/* Fills the constants of every step; l, m and the indices are there. */
void basis_constants(assay_basis *basis);

/* ASSAY_OK or ASSAY_ERR_DOMAIN. */
assay_status basis_check_direction(const assay_basis *basis, assay_vec3 direction);

#endif
