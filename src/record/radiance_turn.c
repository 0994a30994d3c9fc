/* radiance_turn.c - matrices of the tilt beta alone, and how they are come by.
 *
 * EXACT integrates one for every turn: the judge, and slow.  TABLE interpolates linearly between
 * exact ones at beta_j = (j / steps)^2 tilt_max: the matrix leaves 1 as beta does, with powers of
 * beta that are not whole close behind, so steps must be short at the beginning; and records that
 * are tilted more than tilt_max never contribute, so nothing is spent on them.  DIGON has such a
 * table of M(beta), eq. 3.27, as the thesis proposes, and then turns as ANALYTICAL does.
 * CONVERSION turns the SH of the function continued by 0, 3.4.1.
 *
 * Invariant: functions even in y (m >= 0) and odd ones (m < 0) do not mix under a turn about y, so
 * matrices are two blocks.  They are kept by columns: a product then runs along memory, and each
 * sum is in the order of the columns. */
#include "record/radiance_turn.h"

#include <string.h>

#include "basis/hsh_overlap.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

enum { CHANNELS = 3 };

/* sin(tilt) below which a turn is one about z: its matrix is 1 within some 1e-6. */
static const double NO_TILT = 1e-9;

/* Sines and cosines of the three angles; tilt is beta, rad. */
typedef struct {
    double cos_alpha, sin_alpha, cos_gamma, sin_gamma, tilt;
} split;

/* A worker's own. */
typedef struct {
    double                 *matrix;   /* count * count, and for CONVERSION that of the SH */
    double                 *blocks;   /* two blocks, EXACT                                */
    double                 *in, *out; /* CHANNELS rows                                  */
    assay_hsh_turn_scratch *exact;
} desk;

struct assay_radiance_turn {
    assay_context               *context;
    const assay_basis           *hsh;
    assay_radiance_turn_settings settings;
    int                          workers, order;
    size_t                       count, even, odd; /* functions */
    size_t                       block_size;       /* of two blocks */
    size_t                      *index;            /* of the basis, even ones first       */
    int                         *l, *m;            /* of the basis                        */
    double                      *table;            /* steps + 1 times two blocks          */
    assay_basis                 *sh;               /* CONVERSION */
    assay_sparse                *to_sh, *to_hsh;
    desk                        *desks;
};

/* ---- making ---- */

static void release_desk(assay_context *context, desk *d)
{
    assay_release(context, d->matrix);
    assay_release(context, d->blocks);
    assay_release(context, d->in);
    assay_release(context, d->out);
    assay_hsh_turn_scratch_destroy(d->exact);
}

void assay_radiance_turn_destroy(assay_radiance_turn *turn)
{
    if (!turn) {
        return;
    }
    for (int i = 0; turn->desks && i < turn->workers; i++) {
        release_desk(turn->context, &turn->desks[i]);
    }
    assay_sparse_destroy(turn->to_sh);
    assay_sparse_destroy(turn->to_hsh);
    assay_basis_destroy(turn->sh);
    assay_release(turn->context, turn->desks);
    assay_release(turn->context, turn->index);
    assay_release(turn->context, turn->l);
    assay_release(turn->context, turn->m);
    assay_release(turn->context, turn->table);
    assay_release(turn->context, turn);
}

static bool has_table(const assay_radiance_turn *t)
{
    return t->settings.way == ASSAY_HSH_TABLE || t->settings.way == ASSAY_HSH_DIGON;
}

static assay_status check(assay_context *context, const assay_radiance_turn_settings *s)
{
    const bool half = s->way == ASSAY_HSH_DIGON || s->way == ASSAY_HSH_ANALYTICAL;
    if (!(s->tilt_max > 0.0 && s->tilt_max <= ASSAY_PI)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "records tilted by up to %g rad",
                          s->tilt_max);
    }
    if (half && s->tilt_max > 0.5 * ASSAY_PI) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "the rotations digon and analytical are undefined beyond 90 degrees, and "
                          "records tilted by up to %.3g would contribute; a must be smaller",
                          s->tilt_max * (180.0 / ASSAY_PI));
    }
    if (s->steps < 1) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "a table of rotations with %d steps",
                          s->steps);
    }
    return ASSAY_OK;
}

static bool allocate(assay_radiance_turn *t)
{
    const size_t wide = t->sh ? assay_basis_count(t->sh) : 0;
    const size_t side = t->count > wide ? t->count : wide;
    t->index          = assay_allocate(t->context, t->count, sizeof *t->index);
    t->l              = assay_allocate(t->context, t->count, sizeof *t->l);
    t->m              = assay_allocate(t->context, t->count, sizeof *t->m);
    t->desks          = assay_allocate(t->context, (size_t)t->workers, sizeof *t->desks);
    bool have         = t->index && t->l && t->m && t->desks;
    for (int i = 0; have && i < t->workers; i++) {
        desk *d   = &t->desks[i];
        d->matrix = assay_allocate(t->context, side, side * sizeof(double));
        d->blocks = assay_allocate(t->context, t->block_size, sizeof(double));
        d->in     = assay_allocate(t->context, CHANNELS * side, sizeof(double));
        d->out    = assay_allocate(t->context, CHANNELS * side, sizeof(double));
        have      = d->matrix && d->blocks && d->in && d->out;
    }
    return have;
}

static void sort_functions(assay_radiance_turn *t)
{
    size_t even = 0, odd = t->even;
    for (size_t i = 0; i < t->count; i++) {
        assay_basis_function(t->hsh, i, &t->l[i], &t->m[i]);
        t->index[t->m[i] >= 0 ? even++ : odd++] = i;
    }
}

/* The two blocks of a matrix, by columns. */
static void pack(const assay_radiance_turn *t, const double *matrix, double *blocks)
{
    for (int parity = 0; parity < 2; parity++) {
        const size_t  n     = parity ? t->odd : t->even;
        const size_t *index = parity ? t->index + t->even : t->index;
        for (size_t j = 0; j < n; j++) {
            for (size_t i = 0; i < n; i++) {
                *blocks++ = matrix[index[i] * t->count + index[j]];
            }
        }
    }
}

static double tilt_at(const assay_radiance_turn *t, int step)
{
    const double share = (double)step / t->settings.steps;
    return share * share * t->settings.tilt_max;
}

static assay_status fill_table(assay_radiance_turn *t)
{
    const size_t entries = (size_t)t->settings.steps + 1;
    t->table             = assay_allocate(t->context, entries, t->block_size * sizeof(double));
    if (!t->table) {
        return assay_fail_memory(t->context, "a table of rotations");
    }
    assay_status status = ASSAY_OK;
    for (int k = 0; k <= t->settings.steps && status == ASSAY_OK; k++) {
        const double beta   = tilt_at(t, k);
        double      *matrix = t->desks[0].matrix;
        status              = t->settings.way == ASSAY_HSH_TABLE
                                  ? assay_hsh_rotation_y(t->hsh, t->context, NULL, beta, matrix)
                                  : assay_hsh_digon(t->hsh, t->context, beta, matrix);
        if (status == ASSAY_OK) {
            pack(t, matrix, t->table + (size_t)k * t->block_size);
            status = assay_progress(t->context, "rotations", (uint64_t)k, entries);
        }
    }
    return status;
}

double assay_radiance_turn_step(const assay_radiance_turn *turn, int step, double *matrix_out)
{
    const double *block = turn->table + (size_t)step * turn->block_size;
    memset(matrix_out, 0, turn->count * turn->count * sizeof *matrix_out);
    for (int parity = 0; parity < 2; parity++) {
        const size_t  n     = parity ? turn->odd : turn->even;
        const size_t *index = parity ? turn->index + turn->even : turn->index;
        for (size_t j = 0; j < n; j++) {
            for (size_t i = 0; i < n; i++) {
                matrix_out[index[i] * turn->count + index[j]] = *block++;
            }
        }
    }
    return tilt_at(turn, step);
}

static assay_status prepare_way(assay_radiance_turn *t)
{
    assay_status status = ASSAY_OK;
    if (has_table(t)) {
        return fill_table(t);
    }
    for (int i = 0; i < t->workers && status == ASSAY_OK && t->settings.way == ASSAY_HSH_EXACT;
         i++) {
        status = assay_hsh_turn_scratch_create(t->context, t->hsh, &t->desks[i].exact);
    }
    if (t->settings.way == ASSAY_HSH_CONVERSION) {
        status = assay_basis_conversion(t->context, t->hsh, t->sh, &t->to_sh);
        status = status ? status : assay_basis_conversion(t->context, t->sh, t->hsh, &t->to_hsh);
    }
    return status;
}

assay_status assay_radiance_turn_create(assay_context *context, const assay_basis *hsh,
                                        const assay_radiance_turn_settings *settings, int workers,
                                        assay_radiance_turn **turn_out)
{
    assay_status status = check(context, settings);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_radiance_turn *turn = assay_allocate(context, 1, sizeof *turn);
    if (!turn) {
        return assay_fail_memory(context, "rotations of radiance");
    }
    const size_t n   = (size_t)assay_basis_order(hsh);
    *turn            = (assay_radiance_turn){.context  = context,
                                             .hsh      = hsh,
                                             .settings = *settings,
                                             .workers  = workers,
                                             .order    = (int)n,
                                             .count    = n * n,
                                             .even     = n * (n + 1) / 2,
                                             .odd      = n * (n - 1) / 2};
    turn->block_size = turn->even * turn->even + turn->odd * turn->odd;
    if (settings->way == ASSAY_HSH_CONVERSION) {
        status = assay_basis_create(context, ASSAY_BASIS_SH, settings->sh_order,
                                    assay_basis_convention_of(hsh), &turn->sh);
    }
    if (status == ASSAY_OK && !allocate(turn)) {
        status = assay_fail_memory(context, "rotations of radiance");
    }
    if (status == ASSAY_OK) {
        sort_functions(turn);
        status = prepare_way(turn);
    }
    if (status != ASSAY_OK) {
        assay_radiance_turn_destroy(turn);
        return status;
    }
    *turn_out = turn;
    return ASSAY_OK;
}

/* ---- about z ---- */

static void turn_about_z(const assay_radiance_turn *t, double cosine, double sine, double *rows)
{
    double c[ASSAY_BASIS_MAX_ORDER], s[ASSAY_BASIS_MAX_ORDER];
    c[0] = 1.0;
    s[0] = 0.0;
    for (int m = 1; m < t->order; m++) {
        c[m] = c[m - 1] * cosine - s[m - 1] * sine;
        s[m] = c[m - 1] * sine + s[m - 1] * cosine;
    }
    for (int channel = 0; channel < CHANNELS; channel++, rows += t->count) {
        for (size_t i = 0; i < t->count; i++) {
            const int m = t->m[i];
            if (m > 0) {
                const size_t k = i - 2 * (size_t)m;
                const double a = rows[i], b = rows[k];
                rows[i] = c[m] * a - s[m] * b;
                rows[k] = s[m] * a + c[m] * b;
            }
        }
    }
}

/* ---- about y ---- */

/* out += matrix in; by columns, n * n. */
static void add_product(size_t n, const double *matrix, const double *in, double *restrict out)
{
    for (size_t j = 0; j < n; j++, matrix += n) {
        const double x = in[j];
        for (size_t i = 0; i < n; i++) {
            out[i] += matrix[i] * x;
        }
    }
}

/* (1 - share) below + share above */
static void add_between(size_t n, const double *below, const double *above, double share,
                        const double *in, double *restrict out)
{
    const double rest = 1.0 - share;
    for (size_t j = 0; j < n; j++, below += n, above += n) {
        const double x = rest * in[j], y = share * in[j];
        for (size_t i = 0; i < n; i++) {
            out[i] += below[i] * x + above[i] * y;
        }
    }
}

/* above NULL: one matrix alone. */
static void multiply(const assay_radiance_turn *t, desk *d, const double *below,
                     const double *above, double share, double *rows)
{
    const size_t odd_at = t->even * t->even;
    for (int channel = 0; channel < CHANNELS; channel++, rows += t->count) {
        for (size_t i = 0; i < t->count; i++) {
            d->in[i]  = rows[t->index[i]];
            d->out[i] = 0.0;
        }
        if (above) {
            add_between(t->even, below, above, share, d->in, d->out);
            add_between(t->odd, below + odd_at, above + odd_at, share, d->in + t->even,
                        d->out + t->even);
        } else {
            add_product(t->even, below, d->in, d->out);
            add_product(t->odd, below + odd_at, d->in + t->even, d->out + t->even);
        }
        for (size_t i = 0; i < t->count; i++) {
            rows[t->index[i]] = d->out[i];
        }
    }
}

static void by_table(const assay_radiance_turn *t, desk *d, double beta, double *rows)
{
    const int steps   = t->settings.steps;
    int       below   = (int)(sqrt(beta / t->settings.tilt_max) * steps);
    below             = below < steps - 1 ? below : steps - 1;
    const double from = tilt_at(t, below), to = tilt_at(t, below + 1);
    const double share = fmin(fmax((beta - from) / (to - from), 0.0), 1.0);
    multiply(t, d, t->table + (size_t)below * t->block_size,
             t->table + ((size_t)below + 1) * t->block_size, share, rows);
}

/* Eq. 3.30: block-diagonal in l. */
static assay_status analytically(const assay_radiance_turn *t, desk *d, double beta, double *rows)
{
    static const assay_hsh_rotation_options way = {.way = ASSAY_HSH_ANALYTICAL};
    const assay_status status = assay_hsh_rotation_y(t->hsh, t->context, &way, beta, d->matrix);
    for (int channel = 0; channel < CHANNELS && !status; channel++, rows += t->count) {
        memcpy(d->in, rows, t->count * sizeof *rows);
        for (size_t i = 0; i < t->count; i++) {
            const size_t  l = (size_t)t->l[i], first = l * l;
            const double *row = d->matrix + i * t->count;
            double        sum = 0.0;
            for (size_t j = first; j < first + 2 * l + 1; j++) {
                sum += row[j] * d->in[j];
            }
            rows[i] = sum;
        }
    }
    return status;
}

static assay_status about_y(const assay_radiance_turn *t, desk *d, double beta, double *rows)
{
    assay_status status = ASSAY_OK;
    switch (t->settings.way) {
    case ASSAY_HSH_TABLE: by_table(t, d, beta, rows); return ASSAY_OK;
    case ASSAY_HSH_DIGON: by_table(t, d, beta, rows); return analytically(t, d, beta, rows);
    case ASSAY_HSH_ANALYTICAL: return analytically(t, d, beta, rows);
    case ASSAY_HSH_EXACT:
        status = assay_hsh_turn_exactly(d->exact, beta, d->matrix);
        if (status == ASSAY_OK) {
            pack(t, d->matrix, d->blocks);
            multiply(t, d, d->blocks, NULL, 0.0, rows);
        }
        return status;
    case ASSAY_HSH_CONVERSION: break;
    }
    return ASSAY_ERR_INTERNAL;
}

/* ---- any turn ---- */

static assay_status by_conversion(const assay_radiance_turn *t, desk *d, const double rotation[9],
                                  double *rows)
{
    const size_t wide   = assay_basis_count(t->sh);
    assay_status status = assay_sh_rotation(t->sh, rotation, d->matrix);
    for (size_t c = 0; c < CHANNELS && !status; c++) {
        assay_sparse_multiply(t->to_sh, rows + c * t->count, d->in + c * wide);
    }
    status = status ? status : assay_sh_rotate(t->sh, d->matrix, CHANNELS, d->in, d->out);
    for (size_t c = 0; c < CHANNELS && !status; c++) {
        assay_sparse_multiply(t->to_hsh, d->out + c * wide, rows + c * t->count);
    }
    return status;
}

/* R takes what is said in `from` to what is said in `to`.  Its last column is where from's pole
 * goes, (cos alpha sin beta, sin alpha sin beta, cos beta); its last row is (-sin beta cos gamma,
 * sin beta sin gamma, cos beta). */
static split take_apart(const double r[9], double tilt_max)
{
    const double sine = sqrt(r[2] * r[2] + r[5] * r[5]);
    const double side = sqrt(r[6] * r[6] + r[7] * r[7]);
    if (!(sine > NO_TILT) || !(side > 0.0)) {
        const double length = sqrt(r[0] * r[0] + r[3] * r[3]);
        return (split){r[0] / length, r[3] / length, 1.0, 0.0, r[8] < 0.0 ? tilt_max : 0.0};
    }
    return (split){r[2] / sine, r[5] / sine, -r[6] / side, r[7] / side,
                   fmin(assay_atan2(sine, r[8]), tilt_max)};
}

static bool is_finite(const split *s)
{
    return isfinite(s->cos_alpha) && isfinite(s->sin_alpha) && isfinite(s->cos_gamma) &&
           isfinite(s->sin_gamma) && isfinite(s->tilt);
}

assay_status assay_radiance_turn_apply(assay_radiance_turn *turn, int worker,
                                       const assay_frame3 *from, const assay_frame3 *to,
                                       double *coefficients)
{
    const double r[9] = {
        vec3_dot(to->x, from->x), vec3_dot(to->x, from->y), vec3_dot(to->x, from->z),
        vec3_dot(to->y, from->x), vec3_dot(to->y, from->y), vec3_dot(to->y, from->z),
        vec3_dot(to->z, from->x), vec3_dot(to->z, from->y), vec3_dot(to->z, from->z)};
    const split s = take_apart(r, turn->settings.tilt_max);
    if (!is_finite(&s)) {
        return ASSAY_ERR_DOMAIN;
    }
    desk *d = &turn->desks[worker];
    if (turn->settings.way == ASSAY_HSH_CONVERSION && s.tilt > 0.0) {
        return by_conversion(turn, d, r, coefficients);
    }
    assay_status status = ASSAY_OK;
    if (s.tilt > 0.0) {
        turn_about_z(turn, s.cos_gamma, s.sin_gamma, coefficients);
        status = about_y(turn, d, s.tilt, coefficients);
    }
    turn_about_z(turn, s.cos_alpha, s.sin_alpha, coefficients);
    return status;
}
