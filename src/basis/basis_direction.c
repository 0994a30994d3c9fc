/* basis_direction.c - from three doubles to t and b of d / |d|, to a few 2^-60.
 *
 * The functions of degree l turn an angle's error into l times as much, so nothing may be lost
 * here. Numbers are cut into multiples of 2^-26 and a rest: products of the former are multiples of
 * 2^-52, and with sums up to 2 they are exact.  1 - |t| is had without cancellation: from x^2 + y^2
 * near the pole, from 1 - |z|, which is exact, elsewhere. */
#include "basis/basis_direction.h"

assay_status basis_check_direction(const assay_basis *basis, assay_vec3 d)
{
    const double excess = d.x * d.x + d.y * d.y + (d.z * d.z - 1.0);
    if (!(fabs(excess) <= ASSAY_BASIS_UNIT_TOLERANCE)) {
        return ASSAY_ERR_DOMAIN;
    }
    if (assay_basis_kind_is_hemispherical(basis->kind) && d.z < 0.0) {
        return ASSAY_ERR_DOMAIN;
    }
    return ASSAY_OK;
}

int basis_zone(const assay_basis *basis, double z)
{
    if (!basis->symmetric) {
        return z >= 0.5 ? 0 : 1;
    }
    const double t = basis_is_spherical(basis->kind) ? z : 2.0 * z - 1.0;
    return fabs(t) >= 0.5 ? 0 : 1;
}

/* |d| - 1 and 1 - 1 / |d|: series in |d|^2 - 1, whose next terms are below 2^-80. */
typedef struct {
    lanes excess, length, shrink;
} lanes_length;

static lanes_length measure(lanes_direction d)
{
    const lanes x = lanes_coarse(d.x), y = lanes_coarse(d.y), z = lanes_coarse(d.z);
    const lanes u = d.x - x, v = d.y - y, w = d.z - z;
    const lanes head = ((z * z - 1.0) + y * y) + x * x;
    const lanes tail = ((2.0 * x + u) * u + (2.0 * y + v) * v) + (2.0 * z + w) * w;
    const lanes e    = head + tail;
    return (lanes_length){
        .excess = e,
        .length = e * (0.5 - e * (0.125 - e * 0.0625)),
        .shrink = e * (0.5 - e * (0.375 - e * 0.3125)),
    };
}

/* 1 - |z| / |d|.  The first form is as good as z is, the second near the pole. */
static lanes beside_pole(lanes_direction d, lanes_length n)
{
    const lanes z       = lanes_absolute(d.z);
    const lanes far     = (1.0 - z) + z * n.shrink;
    const lanes squared = d.x * d.x + d.y * d.y;
    const lanes close   = squared / ((1.0 + z) + (n.excess + z * n.length));
    return lanes_choose(far >= 0x1p-6, far, close);
}

/* sqrt((head + rest) / (|d| + z)): a root and its correction. */
static lanes_pair root(lanes head, lanes rest, lanes z, lanes length)
{
    const lanes sum    = (1.0 + z) + length;
    const lanes value  = lanes_sqrt((head + rest) / sum);
    const lanes r      = lanes_coarse(value);
    const lanes q      = value - r;
    const lanes square = r * r;
    const lanes a      = lanes_coarse(square);
    const lanes b      = (square - a) + (2.0 * r + q) * q;
    const lanes s      = lanes_coarse(sum);
    const lanes t      = (z - (s - 1.0)) + length;
    const lanes defect = (head - a * s) + (rest - (a * t + b * (s + t)));
    return (lanes_pair){r, q + defect / (2.0 * value * sum + 0x1p-900)};
}

/* scale (1 - shrink) x root, as a pair. */
static lanes_pair multiply_root(lanes x, lanes_pair root, lanes shrink, double scale)
{
    const lanes hi    = lanes_coarse(x);
    const lanes lo    = x - hi;
    const lanes exact = hi * root.hi;
    const lanes whole = root.hi + root.lo;
    const lanes rest  = (hi * root.lo + lo * whole) - x * whole * shrink;
    const lanes head  = lanes_coarse(scale * (exact + rest));
    return (lanes_pair){head, (scale * exact - head) + scale * rest};
}

static lanes_pair multiply_shrink(lanes x, lanes shrink)
{
    const lanes hi = lanes_coarse(x);
    return (lanes_pair){hi, (x - hi) - x * shrink};
}

static void locate_spherical(int zone, lanes_direction d, lanes_length n, basis_place *place)
{
    place->re = multiply_shrink(d.x, n.shrink);
    place->im = multiply_shrink(d.y, n.shrink);
    if (zone == 0) {
        place->argument = beside_pole(d, n);
        place->parity   = lanes_choose(d.z < 0.0, lanes_of(-1.0), lanes_of(1.0));
    } else {
        place->argument = d.z - d.z * n.shrink;
    }
}

static void locate_hemispherical(const assay_basis *basis, int zone, lanes_direction d,
                                 lanes_length n, basis_place *place)
{
    const bool       zernike = basis->kind == ASSAY_BASIS_ZERNIKE;
    const lanes_pair r       = zernike ? root(lanes_of(1.0), n.length, d.z, n.length)
                                       : root(d.z, lanes_of(0.0), d.z, n.length);
    place->re                = multiply_root(d.x, r, n.shrink, zernike ? 1.0 : 2.0);
    place->im                = multiply_root(d.y, r, n.shrink, zernike ? 1.0 : 2.0);
    const lanes above        = 2.0 * beside_pole(d, n);
    const lanes below        = 2.0 * (d.z - d.z * n.shrink);
    if (basis->symmetric && zone == 0) {
        const lanes_mask upper = d.z >= 0.5;
        place->argument        = lanes_choose(upper, above, below);
        place->parity          = lanes_choose(upper, lanes_of(1.0), lanes_of(-1.0));
    } else if (basis->symmetric) {
        place->argument = (2.0 * d.z - 1.0) - 2.0 * (d.z * n.shrink);
    } else {
        place->argument = zone == 0 ? above : below;
    }
    if (basis->kind == ASSAY_BASIS_MAKHOTKIN_SQRT) {
        place->weight = lanes_sqrt(d.z - d.z * n.shrink);
    }
}

basis_place basis_locate(const assay_basis *basis, int zone, lanes_direction d)
{
    const lanes_length n     = measure(d);
    basis_place        place = {.parity = lanes_of(1.0), .weight = lanes_of(1.0)};
    if (basis_is_spherical(basis->kind)) {
        locate_spherical(zone, d, n, &place);
    } else {
        locate_hemispherical(basis, zone, d, n, &place);
    }
    return place;
}
