/* directions.h - where the bases are tabulated.  A direction is three doubles d; what is tabulated
 * is the function at d / |d|, and |d| is 1 but for rounding (or 1e-12). */
#ifndef DIRECTIONS_H
#define DIRECTIONS_H

typedef struct {
    double d[3];
} ref_direction;

/* All of them; the first *upper_out have z >= 0.  Freed by the caller. */
ref_direction *ref_directions(int *count_out, int *upper_out);
/* A smaller set with z >= 0 for the other hemispherical bases.  Freed by the caller. */
ref_direction *ref_few_directions(int *count_out);
/* For gradients: no horizon among the first *hemisphere_out, which have z > 0. */
ref_direction *ref_gradient_directions(int *count_out, int *hemisphere_out);

#endif
