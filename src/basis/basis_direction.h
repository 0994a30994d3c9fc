/* basis_direction.h - from three doubles to t and b of d / |d|, to 2^-75 or so.  After lanes.h.
 *
 * A function of degree l turns an angle's error into l times as much, so nothing may be lost here.
 * Numbers are cut into a multiple of 2^-26 and a rest: products of the former are multiples of
 * 2^-52, and so up to a size of 2 they and their sums are exact. */
#include "basis/basis_data.h"

typedef struct {
    lanes x, y, z;
} lanes_direction;

/* hi + lo: hi is a multiple of 2^-26, lo some 2^-27 with the relative error of a double. */
typedef struct {
    lanes hi, lo;
} lanes_pair;

/* What d / |d| amounts to. */
typedef struct {
    lanes_pair t;
    lanes_pair re, im; /* b                       */
    lanes      weight; /* factor of all functions */
} basis_place;

/* |d| - 1 and 1 - 1 / |d|: series in |d|^2 - 1, whose next terms are below 2^-80. */
typedef struct {
    lanes excess, shrink;
} lanes_length;

static inline lanes_length measure(lanes_direction d)
{
    const lanes x = lanes_coarse(d.x), y = lanes_coarse(d.y), z = lanes_coarse(d.z);
    const lanes u = d.x - x, v = d.y - y, w = d.z - z;
    const lanes head = ((z * z - 1.0) + y * y) + x * x;
    const lanes tail = ((2.0 * x + u) * u + (2.0 * y + v) * v) + (2.0 * z + w) * w;
    const lanes e    = head + tail; /* |d|^2 - 1 */
    return (lanes_length){
        .excess = e * (0.5 - e * (0.125 - e * 0.0625)),
        .shrink = e * (0.5 - e * (0.375 - e * 0.3125)),
    };
}

/* sqrt((head + rest) / (|d| + z)): a root, and its correction by Newton's rule. */
static inline lanes_pair root(lanes head, lanes rest, lanes z, lanes excess)
{
    const lanes sum    = (1.0 + z) + excess;
    const lanes value  = lanes_sqrt((head + rest) / sum);
    const lanes r      = lanes_coarse(value);
    const lanes q      = value - r;
    const lanes square = r * r;
    const lanes a      = lanes_coarse(square);
    const lanes b      = (square - a) + (2.0 * r + q) * q;
    const lanes s      = lanes_coarse(sum);
    const lanes t      = (z - (s - 1.0)) + excess;
    const lanes defect = (head - a * s) + (rest - (a * t + b * (s + t)));
    return (lanes_pair){r, q + defect / (2.0 * value * sum + 0x1p-900)}; /* 0 for 0 */
}

static inline lanes_pair multiply(lanes x, lanes shrink)
{
    const lanes hi = lanes_coarse(x);
    return (lanes_pair){hi, (x - hi) - x * shrink};
}

/* scale (1 - shrink) x root; scale is a power of two. */
static inline lanes_pair multiply_root(lanes x, lanes_pair root, lanes shrink, double scale)
{
    const lanes hi    = lanes_coarse(x);
    const lanes lo    = x - hi;
    const lanes exact = hi * root.hi;
    const lanes whole = root.hi + root.lo;
    const lanes rest  = (hi * root.lo + lo * whole) - x * whole * shrink;
    const lanes head  = lanes_coarse(scale * exact);
    return (lanes_pair){head, (scale * exact - head) + scale * rest};
}

static inline basis_place basis_locate(assay_basis_kind kind, lanes_direction d)
{
    const lanes_length n     = measure(d);
    const lanes_pair   z     = multiply(d.z, n.shrink);
    basis_place        place = {.t = z, .weight = lanes_of(1.0)};
    if (basis_is_spherical(kind)) {
        place.re = multiply(d.x, n.shrink);
        place.im = multiply(d.y, n.shrink);
        return place;
    }
    const bool       zernike = kind == ASSAY_BASIS_ZERNIKE;
    const lanes_pair r       = zernike ? root(lanes_of(1.0), n.excess, d.z, n.excess)
                                       : root(d.z, lanes_of(0.0), d.z, n.excess);
    place.re                 = multiply_root(d.x, r, n.shrink, zernike ? 1.0 : 2.0);
    place.im                 = multiply_root(d.y, r, n.shrink, zernike ? 1.0 : 2.0);
    place.t                  = (lanes_pair){2.0 * z.hi - 1.0, 2.0 * z.lo};
    if (kind == ASSAY_BASIS_MAKHOTKIN_SQRT) {
        place.weight = lanes_sqrt(z.hi + z.lo);
    }
    return place;
}
