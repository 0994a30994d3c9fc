/* lanes.h - several directions at a time, in plain IEEE operations.
 *
 * The including file defines LANES.  A vector of the compiler does to each lane what a scalar would
 * do: the same bits for any number of lanes. */
#include <math.h>

typedef double lanes __attribute__((vector_size(LANES * sizeof(double))));

static inline lanes lanes_of(double x) { return x - (lanes){0.0}; }

static inline lanes lanes_sqrt(lanes x)
{
    for (int i = 0; i < LANES; i++) {
        x[i] = sqrt(x[i]);
    }
    return x;
}

/* x to a multiple of 2^-26 beside it, for |x| < 2^25. */
static inline lanes lanes_coarse(lanes x) { return (x + 0x1.8p26) - 0x1.8p26; }
