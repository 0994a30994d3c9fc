/* basis_data.h - inside a basis: every kind is the same three things.
 *
 * A function is  scale p_k(t) Re or Im b^m:  t = z or 2 z - 1, b a complex number whose length is
 * the sine of an angle, p_k a Jacobi polynomial whose parameters depend on m, scaled so that it is
 * at most 1 in size (docs/methods/basis.md, "Algorithm"). */
#ifndef ASSAY_BASIS_DATA_H
#define ASSAY_BASIS_DATA_H

#include "assay/basis.h"

/* Degree k of one m: its place among the values, and the way to degree k + 1,
 *     p_{k+1} = 2^exponent (t - b) p_k - g p_{k-1}.
 * Pairs hi + lo: hi is a multiple of 2^-26, lo what is left, rounded. */
typedef struct {
    double g_hi, g_lo;
    double scale;
    double b_hi, b_lo;
    short  plus, minus; /* index of the functions m and -m; -1: not in the basis */
    int    exponent;    /* -1, 0, 1 */
} basis_step;

struct assay_basis {
    assay_context   *context;
    assay_basis_kind kind;
    assay_convention convention;
    int              order;
    size_t           count;
    bool             wide;                         /* use basis_evaluate_wide */
    int              steps[ASSAY_BASIS_MAX_ORDER]; /* degrees of each m    */
    basis_step      *step;                         /* by m, then by degree */
    short            l[ASSAY_BASIS_MAX_ORDER * ASSAY_BASIS_MAX_ORDER];
    short            m[ASSAY_BASIS_MAX_ORDER * ASSAY_BASIS_MAX_ORDER];
};

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

/* Whether the parameters of the polynomials are equal, so that all b are 0. */
static inline bool basis_is_symmetric(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_HSH || basis_is_spherical(kind);
}

/* Index of function (l, m). */
size_t basis_index(const assay_basis *basis, int l, int m);

/* Fills the constants of every step; l, m and the indices are there. */
void basis_constants(assay_basis *basis);

/* ASSAY_OK or ASSAY_ERR_DOMAIN. */
assay_status basis_check_direction(const assay_basis *basis, assay_vec3 direction);

/* All functions at 1 ... BASIS_PAIR or BASIS_WIDE directions that pass the check. */
enum { BASIS_PAIR = 2, BASIS_WIDE = 4 };
void basis_evaluate_pair(const assay_basis *basis, size_t count, const assay_vec3 *directions,
                         double *values);
void basis_evaluate_wide(const assay_basis *basis, size_t count, const assay_vec3 *directions,
                         double *values);
bool basis_has_wide(void);

#endif
