/* lanes.h - two directions at a time, in plain IEEE operations.
 *
 * A vector of the compiler does to each lane what the scalar would: the same bits. */
#ifndef ASSAY_BASIS_LANES_H
#define ASSAY_BASIS_LANES_H

#include <math.h>
#include <stdint.h>

enum { LANES = 2 };

typedef double  lanes __attribute__((vector_size(LANES * sizeof(double))));
typedef int64_t lanes_mask __attribute__((vector_size(LANES * sizeof(double))));

static inline lanes lanes_of(double x) { return (lanes){x, x}; }

static inline lanes lanes_choose(lanes_mask mask, lanes yes, lanes no)
{
    return (lanes)(((lanes_mask)yes & mask) | ((lanes_mask)no & ~mask));
}

static inline lanes lanes_sqrt(lanes x) { return (lanes){sqrt(x[0]), sqrt(x[1])}; }

static inline lanes lanes_absolute(lanes x)
{
    return (lanes)((lanes_mask)x & (lanes_mask){INT64_MAX, INT64_MAX});
}

/* x to the nearest multiple of 2^-26, for |x| < 2^25. */
static inline lanes lanes_coarse(lanes x)
{
    const lanes shift = lanes_of(0x1.8p26);
    return (x + shift) - shift;
}

#endif
