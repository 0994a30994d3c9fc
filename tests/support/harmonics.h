/* harmonics.h - scenes whose coefficients in a hemispherical basis are known at every point. */
#ifndef ASSAY_TESTS_HARMONICS_H
#define ASSAY_TESTS_HARMONICS_H

#include "support/seen.h"

enum { HARMONICS_ORDER = 6, HARMONICS_COUNT = HARMONICS_ORDER * HARMONICS_ORDER };

/* A basis of HARMONICS_ORDER, and a context. */
typedef struct {
    assay_context *context;
    assay_basis   *basis;
} harmonics_bench;
harmonics_bench harmonics_open(assay_basis_kind kind);
void            harmonics_close(harmonics_bench *b);

/* Inside of the unit sphere, its radiance a smooth function of place. */
seen_object harmonics_room(void);
/* Two objects: a lamp overhead and something dark before it. */
const seen_object *harmonics_hidden(void);

/* Coefficients of the green channel of what the eye sees, local frame = world; at most
 * HARMONICS_COUNT.  The room by Gauss over directions, any basis; the lamp by Gauss over areas. */
typedef void (*harmonics_exact)(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                                double *out);
void harmonics_of_room(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                       double *out);
void harmonics_of_hidden(const assay_basis *basis, assay_context *context, assay_vec3 eye,
                         double *out);

/* Their gradients with respect to the eye, by differences of fourth order: right to 1e-8 or so;
 * bases of HARMONICS_COUNT functions. */
void harmonics_differences(harmonics_exact exact, const assay_basis *basis, assay_context *context,
                           assay_vec3 eye, assay_vec3 *out);

/* Length of the difference of two vectors of coefficients over that of the exact one; of gradients,
 * HARMONICS_COUNT of them, with or without z. */
double harmonics_value_error(const double *a, const double *exact, size_t count);
double harmonics_gradient_error(const assay_vec3 *a, const assay_vec3 *exact, bool tangential);

#endif
