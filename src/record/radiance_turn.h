/* radiance_turn.h - coefficients of incident radiance, turned from one surface point's frame into
 * another's.
 *
 * A turn is Rz(alpha) Ry(beta) Rz(gamma): about z in closed form, about y by one of the ways of
 * include/assay/basis.h [gautron06] 3.4.  Three channels go together. */
#ifndef ASSAY_RECORD_RADIANCE_TURN_H
#define ASSAY_RECORD_RADIANCE_TURN_H

#include "assay/basis.h"
#include "math/frame.h"

typedef struct {
    assay_hsh_rotation_way way;
    int    steps;    /* TABLE, DIGON: intervals of the table of matrices, >= 1                   */
    int    sh_order; /* CONVERSION: of the SH between, 1 ... ASSAY_BASIS_MAX_ORDER               */
    double tilt_max; /* rad, (0, pi]: larger tilts are not asked for; DIGON, ANALYTICAL: pi / 2 at
                        most, as eq. 3.30 is undefined beyond                                    */
} assay_radiance_turn_settings;

typedef struct assay_radiance_turn assay_radiance_turn;

/* hsh must outlive it.  workers: that may turn at the same time.  Errors: ARGUMENT, MEMORY,
 * CANCELLED. */
assay_status assay_radiance_turn_create(assay_context *context, const assay_basis *hsh,
                                        const assay_radiance_turn_settings *settings, int workers,
                                        assay_radiance_turn **turn_out);
void         assay_radiance_turn_destroy(assay_radiance_turn *turn);

/* 3 rows of coefficients in the frame `from` become those in `to`, in place; tilts above tilt_max
 * are taken for it.  Allocates nothing.  Errors: DOMAIN (frames that are not orthonormal). */
assay_status assay_radiance_turn_apply(assay_radiance_turn *turn, int worker,
                                       const assay_frame3 *from, const assay_frame3 *to,
                                       double *coefficients);

/* For those who judge others' turns: matrix number `step` of TABLE, 0 ... steps, c' = M c, count *
 * count of the basis; its tilt is returned, rad. */
double assay_radiance_turn_step(const assay_radiance_turn *turn, int step, double *matrix_out);

#endif
