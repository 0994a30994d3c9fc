/* lanes.h - several directions at a time, in plain IEEE operations.
 *
 * A vector of the compiler does to each lane what a scalar would do: the same bits. */
#ifndef ASSAY_BASIS_LANES_H
#define ASSAY_BASIS_LANES_H

#include <math.h>

#ifndef NLANES
#define NLANES 2
#endif
enum { LANES = NLANES };

typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

static inline lanes lanes_of(double x)
{
    lanes all;
    for (int i = 0; i < LANES; i++) {
        all[i] = x;
    }
    return all;
}

static inline lanes lanes_sqrt(lanes x)
{
    for (int i = 0; i < LANES; i++) {
        x[i] = sqrt(x[i]);
    }
    return x;
}

/* x to a multiple of 2^-26 beside it, for |x| < 2^25. */
static inline lanes lanes_coarse(lanes x) { return (x + 0x1.8p26) - 0x1.8p26; }

#endif
