/* analysis.h - what a function is integrated against to become coefficients in a basis.
 *
 * For an orthonormal basis these are its own functions (Makhotkin's times their weight).  SH on the
 * hemisphere are not orthonormal: there (LSOSH) the function is integrated against an orthonormal
 * basis of the same space, and a triangular system turns those numbers into coefficients of SH. */
#ifndef ASSAY_BASIS_ANALYSIS_H
#define ASSAY_BASIS_ANALYSIS_H

#include "assay/basis.h"

typedef struct assay_analysis assay_analysis;

/* solve: whether assay_analysis_finish will be called; without it LSOSH works at every order.
 * The basis is borrowed.  Errors: DOMAIN (LSOSH is singular to working precision), MEMORY. */
assay_status assay_analysis_create(assay_context *context, const assay_basis *basis, bool solve,
                                   assay_analysis **analysis_out);
void         assay_analysis_destroy(assay_analysis *analysis);

/* values_out: count; the integral of f times them over the domain is what finish takes.
 * Errors: DOMAIN. */
assay_status assay_analysis_evaluate(const assay_analysis *analysis, assay_vec3 direction,
                                     double *values_out);

/* The same for many directions: rows of count. */
assay_status assay_analysis_evaluate_many(const assay_analysis *analysis, size_t direction_count,
                                          const assay_vec3 *directions, double *values_out);

/* Whether finish changes anything: it is linear, so it may also be applied to single samples. */
bool assay_analysis_needs_finish(const assay_analysis *analysis);
void assay_analysis_finish(const assay_analysis *analysis, double *coefficients);

#endif
