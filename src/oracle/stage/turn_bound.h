/* turn_bound.h - how far coefficients in HSH that are turned from one frame into another may be
 * from ours, where frames, angles, matrices and sums are computed with less precision.
 *
 * What a turn about z leaves alone is the Euclidean norm of a pair, (l, m) with (l, -m).  So sizes
 * and errors are kept a pair, in the order l (l + 1) / 2 + m, m >= 0. */
#ifndef ASSAY_ORACLE_TURN_BOUND_H
#define ASSAY_ORACLE_TURN_BOUND_H

#include "assay/basis.h"
#include "math/frame.h"
#include "oracle/stage/tracked.h"
#include "record/radiance_turn.h"

typedef struct {
    tracked3 x, y, z;
} tracked_frame;

/* frame3_from_z of a normal that is given, brought to unit length. */
tracked_frame tracked_frame_from_z(const rounding *once, assay_vec3 n);
/* A frame that is given, made orthonormal. */
tracked_frame tracked_frame_given(const rounding *once, const assay_frame3 *frame);

typedef struct turn_bound turn_bound;

/* Ways that are analysed: EXACT, TABLE. */
bool turn_bound_covers(assay_hsh_rotation_way way);

/* turn: made with these settings, and not used later; NULL where only the primitives below are
 * asked.  hsh is borrowed.  Errors: MEMORY. */
assay_status turn_bound_create(assay_context *context, const assay_basis *hsh,
                               const assay_radiance_turn          *turn,
                               const assay_radiance_turn_settings *settings,
                               turn_bound                        **bound_out);
void         turn_bound_destroy(turn_bound *bound);

size_t turn_bound_pairs(const turn_bound *bound);
/* The pair of function i. */
size_t turn_bound_pair_of(const turn_bound *bound, size_t function);
/* Norms of the pairs of a row. */
void turn_bound_sizes(const turn_bound *bound, const double *row, double *sizes_out);

/* Errors of 3 rows of pairs, in place, through a turn from one frame into another.  before, after:
 * sizes of our own rows.  same: the candidate was given one normal for both, and no less.  scratch:
 * 2 rows of pairs and 2 matrices of them.  Errors: MEMORY. */
assay_status turn_bound_turn(const turn_bound *bound, const rounding *r, const tracked_frame *from,
                             const tracked_frame *to, bool same, const double *before,
                             const double *after, double *errors, double *scratch);

/* Likewise between frames of one z. */
void turn_bound_spin(const turn_bound *bound, const rounding *r, const tracked_frame *from,
                     const tracked_frame *to, const double *sizes, double *errors);

/* ---- primitives ---- */

/* One row about z by an angle that is off by `off` rad; trigonometric functions cost more. */
void turn_bound_spin_row(const turn_bound *bound, const rounding *r, double off,
                         const double *sizes, double *errors);

/* Spectral norms of the blocks of pairs of a matrix: pairs * pairs. */
void turn_bound_norms(const turn_bound *bound, const double *matrix, double *norms_out);

/* One row through a matrix with these norms, whose tilt is off by `off` rad; slopes: what the norm
 * of a block's change for one radian is, pairs * pairs. */
void turn_bound_product(const turn_bound *bound, const rounding *r, const double *norms,
                        const double *slopes, double off, const double *sizes, const double *errors,
                        double *errors_out);

/* Such slopes of M_R, eq. 3.31, at any tilt. */
void turn_bound_slopes(const turn_bound *bound, double *slopes_out);

#endif
