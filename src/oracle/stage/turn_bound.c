/* turn_bound.c - Rz(alpha) Ry(beta) Rz(gamma) with every angle, entry and sum rounded.
 *
 * Invariant: whatever a candidate makes of given normals by these formulas, with angles by their
 * sines, by arc tangents or the tilt by its cosine, one matrix for all three or each by itself, its
 * pairs are within the errors.
 *
 * About z.  An angle that is off by d turns the pair (l, m) by m d; recurrences and rounded angles
 * cost m times ANGLE u, four rounded products and two sums at most 4 u of the norm.
 *
 * About y.  With N the norms of the matrix's blocks: a sum of n^2 products in any order, entries
 * that are off by ENTRY u and what quadratures in double are off.  A tilt that is off by d changes
 * blocks by d times their slope: of a table the difference of two matrices; of M_R
 *
 *     (M_R(b + d) - M_R(b))_ij <= max |H_i| d 2 (4 l_j + 12) max |H_j|,  max |H_l^m|^2 <= (2 l + 1)
 * / 2 pi
 *
 * by the total variation of H_j along circles about y (docs/methods/basis-rotation.md, where it
 * bounds the change from b = 0; the change from any b is the same integral).
 *
 * Angles.  alpha and gamma are directions of vectors as long as the sine s of the tilt: off by
 * e / (s - e).  Where s is small, they are ill-conditioned, but not so their sum: a tilt below
 * LEAST u may be taken for none by whoever computes with u, and then only the sum is used, which
 * (r0, r3) give to (1 - cos beta).  Both ways are bounds; the one whose angles are off by less is
 * taken. Up to SKIP the turn about y may be left out: the cosine is 1 there within rounding. */
#include "oracle/stage/turn_bound.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"

enum { CHANNELS = 3 };

static const double ANGLE = 8.0, FRAME = 16.0, ENTRY = 4.0, LEAST = 64.0, SKIP = 32.0;
/* What two quadratures in double differ by, and sines below which our own turn has no tilt. */
static const double QUADRATURE = 0x1p-46, OWN_SKIP = 1e-9;

struct turn_bound {
    assay_context               *context;
    const assay_basis           *hsh;
    assay_radiance_turn_settings settings;
    size_t                       count, pairs;
    size_t                      *plus, *minus; /* a pair: its functions, the same where m = 0   */
    int                         *l, *m;
    double *tilts, *norms, *slopes; /* TABLE: of steps + 1 matrices, and of the steps between    */
};

/* ---- frames ---- */

/* Ours are brought to unit length, by no more than what they lost when they were stored. */
static rounding twice_given(const rounding *r)
{
    rounding twice = *r;
    twice.given *= 2.0;
    return twice;
}

tracked_frame tracked_frame_given(const rounding *once, const assay_frame3 *frame)
{
    const rounding twice = twice_given(once), *r = &twice;
    return (tracked_frame){tracked3_given(r, frame->x), tracked3_given(r, frame->y),
                           tracked3_given(r, frame->z)};
}

tracked_frame tracked_frame_from_z(const rounding *once, assay_vec3 n)
{
    const rounding twice = twice_given(once), *r = &twice;
    const tracked3 z    = tracked3_given(r, n);
    const tracked  sign = tracked_exact(copysign(1.0, n.z));
    const tracked  a    = tracked_div(r, tracked_exact(-1.0), tracked_add(r, sign, z.z));
    const tracked  b    = tracked_mul(r, tracked_mul(r, z.x, z.y), a);
    const tracked  xx   = tracked_mul(r, tracked_mul(r, z.x, z.x), a);
    const tracked  yy   = tracked_mul(r, tracked_mul(r, z.y, z.y), a);
    const double   s    = sign.v;
    return (tracked_frame){{tracked_add(r, tracked_exact(1.0), (tracked){s * xx.v, xx.e}),
                            {s * b.v, b.e},
                            {-s * z.x.v, z.x.e}},
                           {b, tracked_add(r, sign, yy), tracked_negate(z.y)},
                           z};
}

/* ---- making ---- */

bool turn_bound_covers(assay_hsh_rotation_way way)
{
    return way == ASSAY_HSH_EXACT || way == ASSAY_HSH_TABLE;
}

void turn_bound_destroy(turn_bound *bound)
{
    if (bound) {
        assay_release(bound->context, bound->plus);
        assay_release(bound->context, bound->minus);
        assay_release(bound->context, bound->l);
        assay_release(bound->context, bound->m);
        assay_release(bound->context, bound->tilts);
        assay_release(bound->context, bound->norms);
        assay_release(bound->context, bound->slopes);
        assay_release(bound->context, bound);
    }
}

static size_t pair_at(int l, int m)
{
    const size_t band = (size_t)l, away = (size_t)(m < 0 ? -m : m);
    return band * (band + 1) / 2 + away;
}

static void find_pairs(turn_bound *b)
{
    for (size_t i = 0; i < b->count; i++) {
        int l = 0, m = 0;
        assay_basis_function(b->hsh, i, &l, &m);
        const size_t pair = pair_at(l, m);
        b->l[pair]        = l;
        b->m[pair]        = m < 0 ? -m : m;
        if (m >= 0) {
            b->plus[pair] = i;
        }
        if (m <= 0) {
            b->minus[pair] = i;
        }
    }
}

static bool allocate(turn_bound *b, bool table)
{
    const size_t steps = (size_t)b->settings.steps, square = b->pairs * b->pairs;
    b->plus   = assay_allocate(b->context, b->pairs, sizeof *b->plus);
    b->minus  = assay_allocate(b->context, b->pairs, sizeof *b->minus);
    b->l      = assay_allocate(b->context, b->pairs, sizeof *b->l);
    b->m      = assay_allocate(b->context, b->pairs, sizeof *b->m);
    b->slopes = assay_allocate(b->context, table ? steps : 1, square * sizeof *b->slopes);
    if (table) {
        b->tilts = assay_allocate(b->context, steps + 1, sizeof *b->tilts);
        b->norms = assay_allocate(b->context, steps + 1, square * sizeof *b->norms);
    }
    return b->plus && b->minus && b->l && b->m && b->slopes && (!table || (b->tilts && b->norms));
}

/* matrices: 2 of count * count. */
static void fill_table(turn_bound *b, const assay_radiance_turn *turn, double *matrices)
{
    const size_t entries = b->count * b->count, square = b->pairs * b->pairs;
    for (int k = 0; k <= b->settings.steps; k++) {
        double *now  = matrices + (size_t)(k & 1) * entries,
               *last = matrices + (size_t)(~k & 1) * entries;
        b->tilts[k]  = assay_radiance_turn_step(turn, k, now);
        turn_bound_norms(b, now, b->norms + (size_t)k * square);
        if (k > 0) {
            for (size_t i = 0; i < entries; i++) {
                last[i] = (now[i] - last[i]) / (b->tilts[k] - b->tilts[k - 1]);
            }
            turn_bound_norms(b, last, b->slopes + ((size_t)k - 1) * square);
        }
    }
}

assay_status turn_bound_create(assay_context *context, const assay_basis *hsh,
                               const assay_radiance_turn          *turn,
                               const assay_radiance_turn_settings *settings, turn_bound **bound_out)
{
    const size_t n     = (size_t)assay_basis_order(hsh);
    const bool   table = turn && settings->way == ASSAY_HSH_TABLE;
    turn_bound  *made  = assay_allocate(context, 1, sizeof *made);
    if (!made) {
        return assay_fail_memory(context, "bounds of rotations");
    }
    *made = (turn_bound){.context  = context,
                         .hsh      = hsh,
                         .settings = *settings,
                         .count    = n * n,
                         .pairs    = n * (n + 1) / 2};
    double *matrices =
        table ? assay_allocate(context, 2 * made->count, made->count * sizeof *matrices) : NULL;
    if (!allocate(made, table) || (table && !matrices)) {
        assay_release(context, matrices);
        turn_bound_destroy(made);
        return assay_fail_memory(context, "bounds of rotations");
    }
    find_pairs(made);
    if (table) {
        fill_table(made, turn, matrices);
    } else {
        turn_bound_slopes(made, made->slopes);
    }
    assay_release(context, matrices);
    *bound_out = made;
    return ASSAY_OK;
}

/* ---- pairs ---- */

size_t turn_bound_pairs(const turn_bound *bound) { return bound->pairs; }

size_t turn_bound_pair_of(const turn_bound *bound, size_t function)
{
    int l = 0, m = 0;
    assay_basis_function(bound->hsh, function, &l, &m);
    return pair_at(l, m);
}

static double hypotenuse(double a, double b) { return sqrt(a * a + b * b); }

void turn_bound_sizes(const turn_bound *bound, const double *row, double *sizes_out)
{
    for (size_t i = 0; i < bound->pairs; i++) {
        const double a = row[bound->plus[i]], b = row[bound->minus[i]];
        sizes_out[i] = bound->m[i] == 0 ? fabs(a) : hypotenuse(a, b);
    }
}

void turn_bound_norms(const turn_bound *bound, const double *matrix, double *norms_out)
{
    for (size_t i = 0; i < bound->pairs; i++) {
        for (size_t j = 0; j < bound->pairs; j++) {
            const double *upper = matrix + bound->plus[i] * bound->count;
            const double *lower = matrix + bound->minus[i] * bound->count;
            const bool    tall = bound->m[i] > 0, wide = bound->m[j] > 0;
            const double  a = upper[bound->plus[j]], b = wide ? upper[bound->minus[j]] : 0.0;
            const double  c = tall ? lower[bound->plus[j]] : 0.0;
            const double  d = tall && wide ? lower[bound->minus[j]] : 0.0;
            *norms_out++    = 0.5 * (hypotenuse(a + d, b - c) + hypotenuse(a - d, b + c));
        }
    }
}

void turn_bound_slopes(const turn_bound *bound, double *slopes_out)
{
    for (size_t i = 0; i < bound->pairs; i++) {
        for (size_t j = 0; j < bound->pairs; j++) {
            const double k = 2.0 * bound->l[i] + 1.0, n = 2.0 * bound->l[j] + 1.0;
            *slopes_out++ = sqrt(k * n) / ASSAY_TWO_PI * 2.0 * (4.0 * bound->l[j] + 12.0);
        }
    }
}

/* ---- primitives ---- */

void turn_bound_spin_row(const turn_bound *bound, const rounding *r, double off,
                         const double *sizes, double *errors)
{
    for (size_t i = 0; i < bound->pairs; i++) {
        const double m = bound->m[i];
        if (m > 0.0) {
            const double turned = fmin(2.0, m * (off + ANGLE * r->u)) + 4.0 * r->u;
            errors[i] += turned * (sizes[i] + errors[i]) + 4.0 * r->tiny;
        }
    }
}

void turn_bound_product(const turn_bound *bound, const rounding *r, const double *norms,
                        const double *slopes, double off, const double *sizes, const double *errors,
                        double *errors_out)
{
    const double grown = rounding_growth(r, (double)bound->count + 8.0);
    double       whole = 0.0;
    for (size_t j = 0; j < bound->pairs; j++) {
        whole += sizes[j] + errors[j];
    }
    whole *= ENTRY * r->u + QUADRATURE;
    for (size_t i = 0; i < bound->pairs; i++, norms += bound->pairs, slopes += bound->pairs) {
        double sum = 0.0;
        for (size_t j = 0; j < bound->pairs; j++) {
            const double most = sizes[j] + errors[j];
            sum += norms[j] * (errors[j] + grown * most) + off * slopes[j] * most;
        }
        errors_out[i] = sum + whole + r->tiny * (double)bound->count;
    }
}

/* ---- a turn ---- */

/* What is off, rad; the tilt between which it may be. */
typedef struct {
    double alpha, gamma, tilt, low, high, off;
} turn_angles;

static double off_by(double error, double length)
{
    return length > error ? fmin(ASSAY_PI, error / (length - error)) : ASSAY_PI;
}

static tracked length_of(const rounding *r, tracked a, tracked b)
{
    return tracked_sqrt(r, tracked_add(r, tracked_mul(r, a, a), tracked_mul(r, b, b)));
}

/* By its sine and cosine, or by its cosine alone. */
static void find_tilt(const rounding *r, tracked sine, tracked cosine, double most, turn_angles *a)
{
    const double both = hypotenuse(sine.e, cosine.e), alone = cosine.e + 4.0 * r->u;
    const double own   = off_by(both, hypotenuse(sine.v, cosine.v));
    a->tilt            = fmin(assay_atan2(sine.v, cosine.v), most);
    const double spare = 8.0 * r->u * fmax(a->tilt, most);
    a->low  = fmin(a->tilt - own, assay_acos(fmax(-1.0, fmin(1.0, cosine.v + alone)))) - spare;
    a->high = fmax(a->tilt + own, assay_acos(fmin(1.0, fmax(-1.0, cosine.v - alone)))) + spare;
    a->low  = fmax(0.0, fmin(a->low, a->tilt));
    a->high = fmin(a->high, most);
}

/* We compute, too, and take a tilt above 1e-9 for one. */
static double our_own(double sine)
{
    return sine > 0.9 * OWN_SKIP ? off_by(FRAME * 0x1p-53, sine) : 0.0;
}

static turn_angles find_angles(const rounding *r, const tracked_frame *from,
                               const tracked_frame *to, double most)
{
    const tracked r0 = tracked3_dot(r, &to->x, &from->x), r3 = tracked3_dot(r, &to->y, &from->x);
    const tracked r2 = tracked3_dot(r, &to->x, &from->z), r5 = tracked3_dot(r, &to->y, &from->z);
    const tracked r6 = tracked3_dot(r, &to->z, &from->x), r7 = tracked3_dot(r, &to->z, &from->y);
    const tracked r8   = tracked3_dot(r, &to->z, &from->z);
    const tracked sine = length_of(r, r2, r5);
    turn_angles   a    = {0};
    find_tilt(r, sine, r8, most, &a);
    const bool   tilted = sine.v > LEAST * r->u;
    const bool   may    = tracked_high(sine) > LEAST * r->u;
    const double own =
        our_own(sine.v) + (may ? off_by(FRAME * r->u, fmax(tracked_low(sine), LEAST * r->u)) : 0.0);
    a.alpha           = tilted ? off_by(hypotenuse(r2.e, r5.e), sine.v) : INFINITY;
    a.gamma           = tilted ? off_by(hypotenuse(r6.e, r7.e), sine.v) : INFINITY;
    const double skip = fmax(sqrt(SKIP * r->u), 1.1 * OWN_SKIP) + sine.e;
    const double bent = 1.0 - assay_cos(a.high);
    const double sum  = off_by(hypotenuse(r0.e, r3.e), hypotenuse(r0.v, r3.v)) + 2.0 * own +
                       (a.high < 1.0 ? 2.0 * bent : ASSAY_PI);
    if (sine.v <= skip && r8.v > 0.0) {
        a.low = 0.0; /* it may be left out */
        a.alpha += bent;
    }
    a.off = fmax(a.tilt - a.low, a.high - a.tilt);
    if (r8.v > 0.0 && sum + a.tilt + a.high < a.alpha + a.gamma + a.off) {
        /* Compared by way of no tilt at all. */
        a.alpha = sum;
        a.gamma = 0.0;
        a.low   = 0.0;
        a.off   = a.tilt + a.high;
    }
    return a;
}

/* Norms at the tilt and the largest slopes of what is touched, into pairs * pairs each. */
static assay_status matrices_at(const turn_bound *bound, const turn_angles *a, double *norms,
                                const double **slopes_out, double *slopes)
{
    const size_t square = bound->pairs * bound->pairs;
    if (bound->settings.way != ASSAY_HSH_TABLE) {
        double *matrix =
            assay_allocate(bound->context, bound->count, bound->count * sizeof *matrix);
        if (!matrix) {
            return ASSAY_ERR_MEMORY;
        }
        const assay_status status =
            assay_hsh_rotation_y(bound->hsh, bound->context, NULL, a->tilt, matrix);
        turn_bound_norms(bound, matrix, norms);
        assay_release(bound->context, matrix);
        *slopes_out = bound->slopes;
        return status;
    }
    bool any = false;
    for (int k = 0; k < bound->settings.steps; k++) {
        const double  from = bound->tilts[k], to = bound->tilts[k + 1];
        const double *below = bound->norms + (size_t)k * square, *above = below + square;
        const double *here = bound->slopes + (size_t)k * square;
        if (a->tilt >= from && (a->tilt <= to || k + 1 == bound->settings.steps)) {
            const double share = fmin(1.0, (a->tilt - from) / (to - from));
            for (size_t i = 0; i < square; i++) {
                norms[i] = (1.0 - share) * below[i] + share * above[i];
            }
        }
        if (a->high >= from && a->low <= to) {
            for (size_t i = 0; i < square; i++) {
                slopes[i] = any ? fmax(slopes[i], here[i]) : here[i];
            }
            any = true;
        }
    }
    *slopes_out = slopes;
    return ASSAY_OK;
}

assay_status turn_bound_turn(const turn_bound *bound, const rounding *r, const tracked_frame *from,
                             const tracked_frame *to, bool same, const double *before,
                             const double *after, double *errors, double *scratch)
{
    double *moved = scratch, *norms = scratch + bound->pairs;
    double *own = norms + bound->pairs * bound->pairs;
    if (same) {
        for (size_t c = 0; c < CHANNELS; c++) {
            turn_bound_spin_row(bound, r, 0.0, before + c * bound->pairs,
                                errors + c * bound->pairs);
        }
        return ASSAY_OK;
    }
    const turn_angles  a      = find_angles(r, from, to, bound->settings.tilt_max);
    const double      *slopes = NULL;
    const assay_status status = matrices_at(bound, &a, norms, &slopes, own);
    for (size_t c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        double *row = errors + c * bound->pairs;
        turn_bound_spin_row(bound, r, a.gamma, before + c * bound->pairs, row);
        turn_bound_product(bound, r, norms, slopes, a.off, before + c * bound->pairs, row, moved);
        memcpy(row, moved, bound->pairs * sizeof *row);
        turn_bound_spin_row(bound, r, a.alpha, after + c * bound->pairs, row);
    }
    return status;
}

void turn_bound_spin(const turn_bound *bound, const rounding *r, const tracked_frame *from,
                     const tracked_frame *to, const double *sizes, double *errors)
{
    const tracked r0 = tracked3_dot(r, &to->x, &from->x), r3 = tracked3_dot(r, &to->y, &from->x);
    const double  off = off_by(hypotenuse(r0.e, r3.e), hypotenuse(r0.v, r3.v));
    for (size_t c = 0; c < CHANNELS; c++) {
        turn_bound_spin_row(bound, r, off, sizes + c * bound->pairs, errors + c * bound->pairs);
    }
}
