/* irradiance_bound.c - the sums of docs/methods/gathering.md in tracked arithmetic.
 *
 * Invariant: sums over cells are bounded for every order of their terms, and for sums by parts as
 * well: a difference of two radiances is bounded by what either of them may be off.
 *
 * The borders' sines and cosines are functions of whole numbers that a candidate computes itself:
 * phi = 2 pi k / N is off by 3 u phi (the constant, the product, the quotient), a sine by that and
 * by 2 u (one unit of the last place of the function); sin theta = sqrt(j / M) by 2 u of itself, or
 * by what a root of 1 - cos^2 makes of that, and theta = asin or acos by what these make of it.
 * Differences of cosines and sines lose what they cancel. */
#include "oracle/stage/irradiance_bound.h"

typedef struct {
    tracked sin, cos, theta;
} border;

static border border_of(const rounding *r, const assay_theta_border *at)
{
    const double few = 2.0 * r->u, s = at->sin, c = at->cos;
    if (s == 0.0 || c == 0.0) {
        return (border){{s, 0.0}, {c, few}, {at->theta, few * at->theta}};
    }
    /* Either of them as the root of 1 less the other's square, theta as asin or acos. */
    return (border){{s, few * (s + 0.5 * c * c / s)},
                    {c, few * (c + 0.5 * s * s / c)},
                    {at->theta, few * (at->theta + fmax(s / c, c / s))}};
}

/* Of an angle of up to 2 pi; other: the other one of sine and cosine. */
static tracked circular(const rounding *r, double turns, double value, double other)
{
    return (tracked){value, 3.0 * r->u * ASSAY_TWO_PI * turns * fabs(other) + 2.0 * r->u};
}

static const assay_cell *row_of(const assay_hemisphere *h, int j)
{
    return h->cells + (size_t)j * (size_t)h->layout.phi;
}

static double channel_of(const assay_cell *cell, int c)
{
    return c == 0 ? cell->radiance.r : c == 1 ? cell->radiance.g : cell->radiance.b;
}

static tracked step_between(const rounding *r, const assay_cell *a, const assay_cell *b, int c)
{
    return tracked_sub(r, tracked_given(r, channel_of(b, c)), tracked_given(r, channel_of(a, c)));
}

static tracked inverse(const rounding *r, double distance)
{
    return isinf(distance) ? tracked_exact(0.0)
                           : tracked_div(r, tracked_exact(1.0), tracked_given(r, distance));
}

static tracked speed_of(const rounding *r, const assay_cell *a, const assay_cell *b)
{
    return inverse(r, a->distance < b->distance ? a->distance : b->distance);
}

/* ---- irradiance and distances ---- */

static double bound_irradiance(const rounding *r, const assay_hemisphere *h, int c)
{
    const bool   uniform = h->layout.strata == ASSAY_STRATA_UNIFORM;
    const size_t count   = (size_t)h->layout.theta * (size_t)h->layout.phi;
    tracked_sum  sum     = {0};
    for (size_t i = 0; i < count; i++) {
        const tracked l = tracked_given(r, channel_of(&h->cells[i], c));
        tracked_sum_add(&sum,
                        uniform ? tracked_mul(r, l, tracked_given(r, h->cells[i].direction.z)) : l);
    }
    const tracked scale = tracked_div(r, tracked_constant(r, uniform ? ASSAY_TWO_PI : ASSAY_PI),
                                      tracked_exact((double)count));
    /* The scale may be taken into each term. */
    return tracked_mul(r, tracked_sum_of(r, &sum), scale).e + 2.0 * r->u * sum.size * fabs(scale.v);
}

/* cos theta_j - cos theta_(j + 1), by whatever form: the difference itself loses most. */
static tracked height_of(const rounding *r, const border *a, const border *b)
{
    return tracked_sub(r, a->cos, b->cos);
}

static double bound_mean(const rounding *r, const assay_hemisphere *h, assay_mean_weight weight)
{
    tracked_sum all = {0}, near = {0};
    for (int j = 0; j < h->layout.theta; j++) {
        const border a = border_of(r, &h->theta[j]), b = border_of(r, &h->theta[j + 1]);
        tracked      share = height_of(r, &a, &b);
        if (weight == ASSAY_MEAN_COSINE) {
            share = tracked_mul(r, share, tracked_add(r, a.cos, b.cos));
        }
        for (int k = 0; k < h->layout.phi; k++) {
            tracked_sum_add(&all, share);
            tracked_sum_add(&near, tracked_mul(r, share, inverse(r, row_of(h, j)[k].distance)));
        }
    }
    if (!(near.v > 0.0)) {
        return 0.0; /* nothing is seen: infinitely far, whoever computes it */
    }
    return tracked_div(r, tracked_sum_of(r, &all), tracked_sum_of(r, &near)).e;
}

/* ---- gradients ---- */

typedef struct {
    tracked_sum x, y, z;
} vector_sum;

static void add(const rounding *r, vector_sum *sum, tracked step, tracked x, tracked y)
{
    tracked_sum_add(&sum->x, tracked_mul(r, step, x));
    tracked_sum_add(&sum->y, tracked_mul(r, step, y));
}

static tracked3 vector_of(const rounding *r, const vector_sum *sum)
{
    return (tracked3){tracked_sum_of(r, &sum->x), tracked_sum_of(r, &sum->y),
                      tracked_sum_of(r, &sum->z)};
}

static void to_world(const rounding *r, const assay_frame3 *frame, const tracked3 *local,
                     double *bounds)
{
    const tracked3 x = tracked3_given(r, frame->x), y = tracked3_given(r, frame->y);
    const tracked3 z      = tracked3_given(r, frame->z);
    const tracked3 rows[] = {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
    for (int i = 0; i < 3; i++) {
        bounds[i] = tracked3_dot(r, &rows[i], local).e;
    }
}

/* Azimuths of column k: of its lower border, and of its middle. */
typedef struct {
    tracked border_sin, border_cos, middle_sin, middle_cos;
} column;

static column column_of(const rounding *r, const assay_hemisphere *h, int k)
{
    const assay_phi_column *p     = &h->phi[k];
    const double            turns = (double)k / h->layout.phi;
    const double            half  = (k + 0.5) / h->layout.phi;
    return (column){circular(r, turns, p->border_sin, p->border_cos),
                    circular(r, turns, p->border_cos, p->border_sin),
                    circular(r, half, p->middle_sin, p->middle_cos),
                    circular(r, half, p->middle_cos, p->middle_sin)};
}

static const assay_cell *before(const assay_hemisphere *h, int j, int k)
{
    return &row_of(h, j)[k == 0 ? h->layout.phi - 1 : k - 1];
}

/* (theta - sin theta cos theta) / 2 between the borders of a stratum. */
static tracked rotation_weight(const rounding *r, const border *inner, const border *outer)
{
    const tracked a = tracked_sub(r, inner->theta, tracked_mul(r, inner->sin, inner->cos));
    const tracked b = tracked_sub(r, outer->theta, tracked_mul(r, outer->sin, outer->cos));
    return tracked_mul(r, tracked_exact(0.5), tracked_sub(r, b, a));
}

static void bound_rotation(const rounding *r, const assay_hemisphere *h, const assay_frame3 *frame,
                           int c, double *bounds)
{
    vector_sum sum = {.x = {.v = 0.0}};
    for (int j = 0; j < h->layout.theta; j++) {
        const border  a = border_of(r, &h->theta[j]), b = border_of(r, &h->theta[j + 1]);
        const tracked weight = rotation_weight(r, &a, &b);
        for (int k = 0; k < h->layout.phi; k++) {
            const column  at = column_of(r, h, k);
            const tracked step =
                tracked_mul(r, step_between(r, before(h, j, k), &row_of(h, j)[k], c), weight);
            add(r, &sum, step, at.border_cos, at.border_sin);
        }
    }
    const tracked3 local = vector_of(r, &sum);
    to_world(r, frame, &local, bounds);
}

/* Between strata j - 1 and j. */
static void add_theta_walls(const rounding *r, const assay_hemisphere *h, int j, bool normal, int c,
                            vector_sum *sum)
{
    const double  n     = h->layout.phi;
    const border  at    = border_of(r, &h->theta[j]);
    const tracked flux  = tracked_mul(r, at.sin, at.cos);
    const double  chord = 2.0 * assay_sincos_turns(0.5 / n).sin;
    const tracked wide  = {chord, 6.0 * r->u * chord};
    const tracked along = tracked_mul(r, tracked_mul(r, flux, at.cos), wide);
    const tracked arc   = tracked_div(r, tracked_constant(r, ASSAY_TWO_PI), tracked_exact(n));
    const tracked rise  = tracked_mul(r, tracked_mul(r, flux, at.sin), arc);
    for (int k = 0; k < h->layout.phi; k++) {
        const assay_cell *inner = &row_of(h, j - 1)[k], *outer = &row_of(h, j)[k];
        const column      where = column_of(r, h, k);
        const tracked     step =
            tracked_mul(r, step_between(r, inner, outer, c), speed_of(r, inner, outer));
        add(r, sum, tracked_mul(r, step, along), where.middle_cos, where.middle_sin);
        if (normal) {
            tracked_sum_add(&sum->z, tracked_negate(tracked_mul(r, step, rise)));
        }
    }
}

/* Between columns of stratum j. */
static void add_phi_walls(const rounding *r, const assay_hemisphere *h, int j, int c,
                          vector_sum *sum)
{
    const border  a = border_of(r, &h->theta[j]), b = border_of(r, &h->theta[j + 1]);
    const tracked flux = tracked_sub(r, b.sin, a.sin);
    for (int k = 0; k < h->layout.phi; k++) {
        const assay_cell *left = before(h, j, k), *right = &row_of(h, j)[k];
        const column      where = column_of(r, h, k);
        const tracked     step =
            tracked_mul(r, step_between(r, left, right, c), speed_of(r, left, right));
        add(r, sum, tracked_mul(r, step, flux), tracked_negate(where.border_sin), where.border_cos);
    }
}

static void bound_translation(const rounding *r, const assay_hemisphere *h,
                              const assay_frame3 *frame, bool normal, int c, double *bounds)
{
    vector_sum sum = {.x = {.v = 0.0}};
    for (int j = 0; j < h->layout.theta; j++) {
        if (j > 0) {
            add_theta_walls(r, h, j, normal, c, &sum);
        }
        add_phi_walls(r, h, j, c, &sum);
    }
    const tracked3 local = vector_of(r, &sum);
    to_world(r, frame, &local, bounds);
}

irradiance_bounds irradiance_bounds_of(const rounding *r, const assay_hemisphere *hemisphere,
                                       const assay_frame3 *frame, assay_mean_weight mean,
                                       bool normal_gradient)
{
    irradiance_bounds b;
    for (int c = 0; c < 3; c++) {
        b.irradiance[c] = bound_irradiance(r, hemisphere, c);
        bound_rotation(r, hemisphere, frame, c, b.rotation + 3 * c);
        bound_translation(r, hemisphere, frame, normal_gradient, c, b.translation + 3 * c);
    }
    const double nearest = assay_hemisphere_nearest(hemisphere);
    b.mean               = bound_mean(r, hemisphere, mean);
    b.nearest            = isinf(nearest) ? 0.0 : given_error(r, nearest);
    return b;
}
