/* lune.c - Gauss's product rule with a proven bound.
 *
 * Invariant: what is added up differs from the integral by less than the error that is returned.
 *
 * One variable.  Let f be analytic in the ellipse E_r with foci +-1 and sum of half-axes r > 1, and
 * |f| <= M on it.  Its Chebyshev coefficients are at most 2 M r^-k.  The rule of n >= 2 nodes
 * integrates degrees < 2n exactly, and odd ones by symmetry; for T_k with k >= 4 even the integral
 * is at most 2/15 and the rule at most 2.  Hence
 *
 *     |error| <= 2M (2 + 2/15) (r^-2n + r^-2n-2 + ...) = 64/15 M r^-2n / (1 - r^-2).
 *
 * Two variables.  I I' - Q Q' = I (I' - Q') + (I - Q) Q'; both I and Q' have positive weights with
 * the sum 2, so the error is at most 2 (error in v, w real) + 2 (error in w, v real).
 *
 * Analyticity.  f is entire but for square roots of g = l sinc A, l sinc B, 1 + cos^2 v and 1 + z,
 * each entire in either variable.  If g has no value on the cut (-inf, 0] on the boundary of the
 * ellipse, it has none inside: the number of zeros of g - t inside is the same for all t of the
 * cut, as no zero can pass the boundary, and none for large -t.  Arb's analytic square root is not
 * finite when its argument meets the cut, so that finite bounds on the boundary are enough; by the
 * maximum principle they hold inside. */
#include "lune.h"

#include <arb_hypgeom.h>
#include <math.h>

#include "bernstein.h"
#include "ref.h"

static void point_init(lune_point *p)
{
    acb_init(p->x);
    acb_init(p->y);
    acb_init(p->z);
    acb_init(p->root_z);
    acb_init(p->x2);
    acb_init(p->z2);
    acb_init(p->root_z2);
    acb_init(p->weight);
}

static void point_clear(lune_point *p)
{
    acb_clear(p->x);
    acb_clear(p->y);
    acb_clear(p->z);
    acb_clear(p->root_z);
    acb_clear(p->x2);
    acb_clear(p->z2);
    acb_clear(p->root_z2);
    acb_clear(p->weight);
}

/* sin A, cos A, and sqrt(sin A), A = l s^2. */
static void side(acb_t sine, acb_t cosine, acb_t root, const arb_t l, const acb_t s,
                 slong precision)
{
    acb_t angle;
    acb_init(angle);
    acb_sqr(angle, s, precision);
    acb_mul_arb(angle, angle, l, precision);
    acb_sinc(root, angle, precision);
    acb_mul_arb(root, root, l, precision);
    acb_sqrt_analytic(root, root, 1, precision);
    acb_mul(root, root, s, precision);
    acb_sin_cos(sine, cosine, angle, precision);
    acb_clear(angle);
}

/* w, v: where in the square; real or complex. */
static void point_at(lune_point *p, const arb_t beta, const acb_t w, const acb_t v, slong precision)
{
    arb_t l;
    acb_t sw, cw, sv, cv, t;
    arb_init(l);
    acb_init(sw);
    acb_init(cw);
    acb_init(sv);
    acb_init(cv);
    acb_init(t);
    arb_const_pi(l, precision);
    arb_abs(acb_realref(t), beta);
    arb_sub(l, l, acb_realref(t), precision);
    acb_zero(t);
    acb_sin_cos(sw, cw, w, precision);
    acb_sin_cos(sv, cv, v, precision);

    side(p->z, p->x, p->root_z, l, sw, precision);
    acb_neg(p->x, p->x);
    side(p->z2, p->x2, p->root_z2, l, cw, precision);
    if (arb_is_negative(beta)) {
        acb_swap(p->z, p->z2);
        acb_swap(p->x, p->x2);
        acb_swap(p->root_z, p->root_z2);
    }
    acb_mul(p->root_z, p->root_z, cv, precision);
    acb_mul(p->root_z2, p->root_z2, cv, precision);
    acb_mul(p->weight, sw, cw, precision);
    acb_mul_arb(p->weight, p->weight, l, precision);

    acb_sqr(t, cv, precision);
    acb_mul(p->z, p->z, t, precision);
    acb_mul(p->x, p->x, t, precision);
    acb_mul(p->z2, p->z2, t, precision);
    acb_mul(p->x2, p->x2, t, precision);
    acb_mul(p->weight, p->weight, t, precision);
    acb_mul(p->weight, p->weight, cv, precision);
    acb_add_si(t, t, 1, precision);
    acb_sqrt_analytic(t, t, 1, precision);
    acb_mul(p->y, sv, t, precision);
    acb_div(p->weight, p->weight, t, precision);
    /* 2 * 2, and 2 for both signs of y */
    acb_mul_2exp_si(p->weight, p->weight, 3);

    arb_clear(l);
    acb_clear(sw);
    acb_clear(cw);
    acb_clear(sv);
    acb_clear(cv);
    acb_clear(t);
}

/* pi / 4 (1 + s) */
static void to_square(acb_t out, const acb_t s, slong precision)
{
    arb_t quarter;
    arb_init(quarter);
    arb_const_pi(quarter, precision);
    arb_mul_2exp_si(quarter, quarter, -2);
    acb_add_si(out, s, 1, precision);
    acb_mul_arb(out, out, quarter, precision);
    arb_clear(quarter);
}

/* Bound with one variable on the ellipse, the other real; not finite where it is too large. */
static void bound_on_ellipse(arb_t out, const lune_integrand *f, const arb_t beta, double rho,
                             int w_is_complex, slong pieces)
{
    const slong precision = 64, segments = pieces / 4;
    lune_point  p;
    acb_t       s, w, v;
    arb_t       bound, size;
    point_init(&p);
    acb_init(s);
    acb_init(w);
    acb_init(v);
    arb_init(bound);
    arb_init(size);
    arb_zero(out);
    for (slong i = 0; i < pieces && arb_is_finite(out); i++) {
        bernstein_ellipse_piece(s, rho, i, pieces, precision);
        to_square(w_is_complex ? w : v, s, precision);
        for (slong j = 0; j < segments && arb_is_finite(out); j++) {
            bernstein_segment_piece(s, j, segments, precision);
            to_square(w_is_complex ? v : w, s, precision);
            point_at(&p, beta, w, v, precision);
            f->bound(f->user, bound, &p, precision);
            acb_get_mag(arb_radref(size), p.weight);
            mag_mul(arb_radref(size), arb_radref(size), arb_radref(bound));
            arb_set(bound, size);
            if (mag_cmp(arb_radref(bound), arb_radref(out)) > 0) {
                arb_set(out, bound);
            }
        }
    }
    point_clear(&p);
    acb_clear(s);
    acb_clear(w);
    acb_clear(v);
    arb_clear(bound);
    arb_clear(size);
}

/* Nodes that make 2 * 64/15 M rho^-2n / (1 - rho^-2) less than 2^-bits; error_out: that bound. */
static slong nodes_for(arb_t error_out, const arb_t bound, double rho, slong bits)
{
    const slong precision = 64;
    arb_t       r, t;
    arb_init(r);
    arb_init(t);
    arb_set_d(r, rho);
    slong n = 2;
    for (;; n += 2) {
        arb_pow_ui(t, r, (ulong)(2 * n), precision);
        arb_inv(t, t, precision);
        arb_set(error_out, t);
        arb_set_d(t, 1.0 - 1.0 / (rho * rho) - 1e-10); /* a lower bound */
        arb_div(error_out, error_out, t, precision);
        arb_mul_si(error_out, error_out, 9, precision); /* > 128 / 15 */
        arb_set(t, bound);
        arb_get_ubound_arf(arb_midref(t), bound, precision);
        mag_zero(arb_radref(t));
        arb_mul(error_out, error_out, t, precision);
        arb_set_si(t, 1);
        arb_mul_2exp_si(t, t, -bits);
        if (arb_lt(error_out, t)) {
            break;
        }
        if (n > 2000) {
            ref_fail("lune: the rule does not converge");
        }
    }
    arb_clear(r);
    arb_clear(t);
    return n;
}

/* Nodes and bound of one variable. */
static slong choose_nodes(arb_t error_out, const lune_integrand *f, const arb_t beta, double rho,
                          int w_is_complex, slong bits)
{
    arb_t bound;
    arb_init(bound);
    slong pieces = 64;
    do {
        bound_on_ellipse(bound, f, beta, rho, w_is_complex, pieces);
        pieces *= 2;
    } while (!arb_is_finite(bound) && pieces <= 1024);
    if (!arb_is_finite(bound)) {
        ref_fail("lune: no bound on the ellipse %g", rho);
    }
    const slong n = nodes_for(error_out, bound, rho, bits);
    arb_clear(bound);
    return n;
}

/* Sum of half-axes of the ellipse through 1 + i e. */
static double ellipse_through(double e)
{
    const double re = -e * e, im = 2.0 * e, r = hypot(re, im);
    return hypot(1.0 + sqrt((r + re) / 2.0), e + sqrt((r - re) / 2.0));
}

static void gauss_nodes(arb_ptr nodes, arb_ptr weights, slong n, slong precision)
{
    for (slong i = 0; i < n; i++) {
        arb_hypgeom_legendre_p_ui_root(nodes + i, weights + i, (ulong)n, (ulong)i, precision);
    }
}

static void add_all(const lune_integrand *f, const arb_t beta, slong nw, slong nv, slong precision)
{
    arb_ptr    xw = _arb_vec_init(nw), ww = _arb_vec_init(nw);
    arb_ptr    xv = _arb_vec_init(nv), wv = _arb_vec_init(nv);
    lune_point p;
    acb_t      s, w, v;
    arb_t      scale;
    point_init(&p);
    acb_init(s);
    acb_init(w);
    acb_init(v);
    arb_init(scale);
    arb_const_pi(scale, precision);
    arb_mul_2exp_si(scale, scale, -2);
    arb_sqr(scale, scale, precision);
    gauss_nodes(xw, ww, nw, precision);
    gauss_nodes(xv, wv, nv, precision);
    for (slong i = 0; i < nw; i++) {
        acb_set_arb(s, xw + i);
        to_square(w, s, precision);
        for (slong j = 0; j < nv; j++) {
            acb_set_arb(s, xv + j);
            to_square(v, s, precision);
            point_at(&p, beta, w, v, precision);
            acb_mul_arb(p.weight, p.weight, ww + i, precision);
            acb_mul_arb(p.weight, p.weight, wv + j, precision);
            acb_mul_arb(p.weight, p.weight, scale, precision);
            f->add(f->user, &p, precision);
        }
    }
    point_clear(&p);
    acb_clear(s);
    acb_clear(w);
    acb_clear(v);
    arb_clear(scale);
    _arb_vec_clear(xw, nw);
    _arb_vec_clear(ww, nw);
    _arb_vec_clear(xv, nv);
    _arb_vec_clear(wv, nv);
}

void lune_integrate(arb_t error_out, const lune_integrand *f, const arb_t beta, slong precision)
{
    /* The nearest branch point in w is where sin^2 w = pi / l, at pi / 2 + i asinh(..); in v where
     * cos^2 v = -1.  The ellipses stay inside these. */
    const double pi = 3.141592653589793, b = fabs(arf_get_d(arb_midref(beta), ARF_RND_NEAR));
    const double near_w = asinh(sqrt(pi / (pi - b) - 1.0)) * 4.0 / pi;
    const double near_v = asinh(1.0) * 4.0 / pi;
    const double rho_w  = 1.0 + 0.75 * (ellipse_through(near_w) - 1.0);
    const double rho_v  = 1.0 + 0.75 * (ellipse_through(near_v) - 1.0);

    arb_t other;
    arb_init(other);
    const slong nw = choose_nodes(error_out, f, beta, rho_w, 1, precision + 2);
    const slong nv = choose_nodes(other, f, beta, rho_v, 0, precision + 2);
    arb_add(error_out, error_out, other, 64);
    arb_clear(other);
    add_all(f, beta, nw, nv, precision + 64);
}
