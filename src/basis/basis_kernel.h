/* basis_kernel.h - all functions at LANES directions.  The including file defines LANES.
 *
 * Recurrences run in two parts.  The heads are multiples of 2^-26, so their products and the sum of
 * those are exact; the sum is cut to 2^-26 again, and what is cut off drives the rest, which obeys
 * the same recurrence in plain double.  A rest stays below 2^-11 (measured: order 33, directions
 * 2^-22 too long), so its rounding is below 2^-64: nothing that a double could show, even where a
 * plain recurrence loses l^2 units. */
#include "basis/lanes.h"

#include "basis/basis_direction.h"

/* p b; re + i im is b in one number each. */
static inline void multiply_base(lanes_pair *p_re, lanes_pair *p_im, const basis_place *b, lanes re,
                                 lanes im)
{
    const lanes_pair u        = *p_re;
    const lanes_pair v        = *p_im;
    const lanes      exact_re = u.hi * b->re.hi - v.hi * b->im.hi;
    const lanes      exact_im = u.hi * b->im.hi + v.hi * b->re.hi;
    const lanes      rest_re  = (u.hi * b->re.lo + u.lo * re) - (v.hi * b->im.lo + v.lo * im);
    const lanes      rest_im  = (u.hi * b->im.lo + u.lo * im) + (v.hi * b->re.lo + v.lo * re);
    p_re->hi                  = lanes_coarse(exact_re);
    p_im->hi                  = lanes_coarse(exact_im);
    p_re->lo                  = (exact_re - p_re->hi) + rest_re;
    p_im->lo                  = (exact_im - p_im->hi) + rest_im;
}

static inline void store(double *const row[LANES], int index, lanes value)
{
    for (int lane = 0; lane < LANES; lane++) {
        row[lane][index] = value[lane];
    }
}

/* All degrees of one m.  t: half, once and twice t, as step->exponent asks. */
static inline void walk(const basis_step *step, int steps, bool symmetric, const lanes_pair t[3],
                        lanes re, lanes im, double *const row[LANES])
{
    lanes_pair p = {lanes_of(1.0), lanes_of(0.0)}, before = {lanes_of(0.0), lanes_of(0.0)};
    for (int k = 0; k < steps; k++, step++) {
        const lanes value = step->scale * (p.hi + p.lo);
        if (step->plus >= 0) {
            store(row, step->plus, value * re);
        }
        if (step->minus >= 0) {
            store(row, step->minus, value * im);
        }
        lanes_pair x = t[step->exponent + 1];
        if (!symmetric) {
            const double power = step->exponent < 0 ? 0.5 : step->exponent + 1.0;
            x.hi -= power * step->b_hi;
            x.lo -= power * step->b_lo;
        }
        const lanes exact = x.hi * p.hi - step->g_hi * before.hi;
        const lanes rest  = ((x.hi + x.lo) * p.lo + x.lo * p.hi) -
                           ((step->g_hi + step->g_lo) * before.lo + step->g_lo * before.hi);
        before = p;
        p.hi   = lanes_coarse(exact);
        p.lo   = (exact - p.hi) + rest;
    }
}

static inline lanes_pair scaled(lanes_pair a, double factor)
{
    return (lanes_pair){factor * a.hi, factor * a.lo};
}

static inline void evaluate_lanes(const assay_basis *basis, const lanes_direction *direction,
                                  double *const row[LANES])
{
    const basis_place place     = basis_locate(basis->kind, *direction);
    const bool        symmetric = basis_is_symmetric(basis->kind);
    const lanes_pair  t[3]      = {scaled(place.t, 0.5), place.t, scaled(place.t, 2.0)};
    const lanes       re        = place.re.hi + place.re.lo;
    const lanes       im        = place.im.hi + place.im.lo;
    const basis_step *step      = basis->step;
    lanes_pair        p_re      = {lanes_of(1.0), lanes_of(0.0)};
    lanes_pair        p_im      = {lanes_of(0.0), lanes_of(0.0)};
    for (int m = 0; m < basis->order; m++) {
        const lanes c = (p_re.hi + p_re.lo) * place.weight;
        const lanes s = (p_im.hi + p_im.lo) * place.weight;
        if (symmetric) {
            walk(step, basis->steps[m], true, t, c, s, row);
        } else {
            walk(step, basis->steps[m], false, t, c, s, row);
        }
        step += basis->steps[m];
        multiply_base(&p_re, &p_im, &place, re, im);
    }
}

/* count <= LANES directions, the first of them again in the lanes that are left. */
static inline void evaluate_some(const assay_basis *basis, size_t count,
                                 const assay_vec3 *directions, double *values)
{
    lanes_direction d;
    double         *row[LANES];
    for (size_t lane = 0; lane < LANES; lane++) {
        const size_t i = lane < count ? lane : 0;
        d.x[lane]      = directions[i].x;
        d.y[lane]      = directions[i].y;
        d.z[lane]      = directions[i].z;
        row[lane]      = values + i * basis->count;
    }
    evaluate_lanes(basis, &d, row);
}
