/* turn.h - points on the unit circle, from sums and products alone.
 *
 * The library's own functions (core/numerics.h) may be exchanged for faster ones that round
 * otherwise; the bytes of the scenes must not follow them. */
#ifndef ASSAY_SCENES_TURN_H
#define ASSAY_SCENES_TURN_H

#include <math.h>

typedef struct {
    double cos, sin;
} turn;

/* After `turns` of a full turn from (1, 0) towards (0, 1); to about 2e-16, and exact at quarters.
 */
static inline turn turn_by(double turns)
{
    const double quarter = floor(4.0 * turns + 0.5);
    const double x = 6.28318530717958647693 * (turns - 0.25 * quarter), y = x * x;
    double       s = 0.0, c = 0.0; /* the series of sine and cosine, |x| <= pi / 4 */
    for (int k = 18; k >= 2; k -= 2) {
        c = 1.0 - c * y / (k * (k - 1));
        s = 1.0 - s * y / (k * (k + 1));
    }
    s *= x;
    switch ((int)(quarter - 4.0 * floor(0.25 * quarter))) {
    case 0: return (turn){c, s};
    case 1: return (turn){-s, c};
    case 2: return (turn){-c, -s};
    default: return (turn){s, -c};
    }
}

#endif
