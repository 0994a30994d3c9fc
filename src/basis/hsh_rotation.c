/* hsh_rotation.c - functions in HSH turned about +y, by five ways, and about any axis.
 *
 * Invariant: every way gives c' = M c with rows outputs, for the same active, right-handed turn as
 * SH rotation.  The thesis writes eq. 3.31 with the source in the row and never fixes the sign of
 * beta; ours is M_ij = integral of H_i(w) H_j(R^-1 w).
 *
 * M_R: where w and R^-1 w are both above the horizon, d (hsh_overlap.h) of w runs over [0, pi -
 * beta].  The mirror image of the turn by beta is that by -beta, so the farther half of that range
 * is the nearer one's transposed with the signs of the mirror: M_R = G + S G' S. */
#include <string.h>

#include "basis/euler_zyz.h"
#include "basis/hsh_overlap.h"
#include "basis/sh_rotation.h"
#include "basis/sparse.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

enum { TABLE_STEPS = 16, TABLE_STEPS_MAX = 1 << 20 };

typedef struct {
    const assay_basis *hsh;
    assay_context     *context;
    size_t             count;
} turner;

/* Two matrices for the work of one call; false, nothing held: refused. */
static bool allocate_two(const turner *t, size_t first, size_t second, double *work[2])
{
    work[0] = assay_allocate(t->context, first, sizeof(double));
    work[1] = assay_allocate(t->context, second, sizeof(double));
    if (work[0] && work[1]) {
        return true;
    }
    assay_release(t->context, work[0]);
    assay_release(t->context, work[1]);
    return false;
}

static void release_two(const turner *t, double *work[2])
{
    assay_release(t->context, work[0]);
    assay_release(t->context, work[1]);
}

static assay_status no_memory(const turner *t)
{
    return assay_fail_memory(t->context, "a rotation of hemispherical harmonics");
}

static void transpose(size_t count, double *matrix)
{
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i; j++) {
            const double swap     = matrix[i * count + j];
            matrix[i * count + j] = matrix[j * count + i];
            matrix[j * count + i] = swap;
        }
    }
}

/* ---- exact, and a table of it ---- */

/* Whether a turn moves no entry of M_R by more than 2^-54, half the distance between 1 and the next
 * smaller double.  M_R less the identity is the scalar product of H_i with the change of H_j,
 * continued by 0 below the horizon: at most max |H_i| times the change's integral, and along a
 * circle about y that is at most beta times the total variation.  On the half circle z > 0, H_j =
 * (z / (1 + z))^(m / 2) T, T a trigonometric polynomial of degree l; its slope has the zeros of (m
 * / 2) z' T + z (1 + z) T', of degree l + 2, so at most 2 l + 4.  So H_j has 2 l + 5 monotonic
 * pieces of height 2 max |H_j| at most, and two steps at the ends: a variation of (4 l + 12)
 * max |H_j|; over all circles, the integral of cos(psi) being 2, twice that.  max |H_l^m|^2 is at
 * most the sum over m, (2 l + 1) / 2 pi. */
static bool is_no_turn(const turner *t, double angle)
{
    const int n = assay_basis_order(t->hsh);
    return (4.0 / ASSAY_PI) * (n + 2) * (2 * n - 1) * angle <= 0x1p-54;
}

static assay_status exact(const turner *t, double beta, double *matrix_out)
{
    const double angle = fabs(beta);
    const size_t n     = t->count;
    if (is_no_turn(t, angle)) {
        memset(matrix_out, 0, n * n * sizeof *matrix_out);
        for (size_t i = 0; i < n; i++) {
            matrix_out[i * n + i] = 1.0;
        }
        return ASSAY_OK;
    }
    const assay_status status =
        assay_hsh_overlap(t->hsh, t->context, angle, 0.5 * (ASSAY_PI - angle), matrix_out);
    if (status) {
        return status;
    }
    assay_hsh_add_mirrored(t->hsh, matrix_out);
    if (beta < 0.0) {
        transpose(n, matrix_out);
    }
    return ASSAY_OK;
}

static assay_status from_table(const turner *t, int steps, double beta, double *matrix_out)
{
    const double place = fmin(fabs(beta) * (steps / (0.5 * ASSAY_PI)), steps);
    double       below = floor(place);
    if (below > steps - 1) {
        below = steps - 1;
    }
    const double share = place - below, step = 0.5 * ASSAY_PI / steps;
    const size_t n = t->count;
    double      *work[2];
    if (!allocate_two(t, n * n, n * n, work)) {
        return no_memory(t);
    }
    assay_status status = exact(t, below * step, work[0]);
    status              = status ? status : exact(t, (below + 1.0) * step, work[1]);
    for (size_t i = 0; i < n * n && !status; i++) {
        matrix_out[i] = (1.0 - share) * work[0][i] + share * work[1][i];
    }
    if (!status && beta < 0.0) {
        transpose(n, matrix_out);
    }
    release_two(t, work);
    return status;
}

/* ---- by spherical harmonics ---- */

static assay_euler_zyz turn_about_y(double sin_half, double cos_half)
{
    const double_double norm =
        dd_sqrt(dd_add(dd_two_product(sin_half, sin_half), dd_two_product(cos_half, cos_half)));
    /* A negative turn is the positive one between two half turns about z. */
    const double side = sin_half < 0.0 ? -1.0 : 1.0;
    return (assay_euler_zyz){.cos_alpha     = dd_of(side),
                             .sin_alpha     = dd_of(0.0),
                             .cos_half_beta = dd_divide(dd_of(cos_half), norm),
                             .sin_half_beta = dd_divide(dd_of(fabs(sin_half)), norm),
                             .cos_gamma     = dd_of(side),
                             .sin_gamma     = dd_of(0.0)};
}

/* out = c d c' */
static void sandwich(const assay_sparse_view *c, const double *d, double *work, double *out)
{
    const size_t n = c->columns;
    for (size_t i = 0; i < c->rows; i++) {
        double *row = work + i * n;
        memset(row, 0, n * sizeof *row);
        for (size_t k = c->row_start[i]; k < c->row_start[i + 1]; k++) {
            for (size_t j = 0; j < n; j++) {
                row[j] += c->value[k] * d[c->column[k] * n + j];
            }
        }
        for (size_t j = 0; j < c->rows; j++) {
            double sum = 0.0;
            for (size_t k = c->row_start[j]; k < c->row_start[j + 1]; k++) {
                sum += row[c->column[k]] * c->value[k];
            }
            out[i * c->rows + j] = sum;
        }
    }
}

static assay_status by_conversion(const turner *t, int sh_order, double beta, double *matrix_out)
{
    assay_basis *sh     = NULL;
    assay_status status = assay_basis_create(t->context, ASSAY_BASIS_SH,
                                             sh_order ? sh_order : assay_basis_order(t->hsh),
                                             assay_basis_convention_of(t->hsh), &sh);
    if (status) {
        return status;
    }
    assay_sparse *c = NULL;
    status          = assay_basis_conversion(t->context, sh, t->hsh, &c);
    if (status) {
        assay_basis_destroy(sh);
        return status;
    }
    const size_t n = assay_basis_count(sh);
    double      *work[2];
    if (allocate_two(t, n * n, t->count * n, work)) {
        const assay_euler_zyz   turn = turn_about_y(assay_sin(0.5 * beta), assay_cos(0.5 * beta));
        const assay_sparse_view view = assay_sparse_entries(c);
        assay_sh_rotation_of_split(sh, &turn, work[0]);
        sandwich(&view, work[0], work[1], matrix_out);
        release_two(t, work);
    } else {
        status = no_memory(t);
    }
    assay_sparse_destroy(c);
    assay_basis_destroy(sh);
    return status;
}

/* Eq. 3.30 with the sign of beta: sin(beta_SH / 2) = sqrt(2) sin(beta / 2), and the cosine is
 * sqrt(cos beta). */
static void analytical(const turner *t, double beta, double *matrix_out)
{
    const double          cosine   = fmax(assay_cos(beta), 0.0);
    const double          sin_half = sqrt(2.0) * assay_sin(0.5 * beta);
    const assay_euler_zyz turn     = turn_about_y(sin_half, sqrt(cosine));
    assay_sh_rotation_of_split(t->hsh, &turn, matrix_out);
}

static assay_status by_digon(const turner *t, double beta, double *matrix_out)
{
    const size_t n = t->count;
    double      *work[2];
    if (!allocate_two(t, n * n, n * n, work)) {
        return no_memory(t);
    }
    const assay_status status = assay_hsh_digon(t->hsh, t->context, beta, work[1]);
    if (!status) {
        analytical(t, beta, work[0]);
        memset(matrix_out, 0, n * n * sizeof *matrix_out);
        for (size_t i = 0; i < n * n; i++) {
            const double d = work[0][i];
            for (size_t j = 0; d != 0.0 && j < n; j++) {
                matrix_out[i / n * n + j] += d * work[1][i % n * n + j];
            }
        }
    }
    release_two(t, work);
    return status;
}

/* ---- the choice ---- */

static double angle_limit(assay_hsh_rotation_way way)
{
    return way == ASSAY_HSH_EXACT || way == ASSAY_HSH_CONVERSION ? ASSAY_PI : 0.5 * ASSAY_PI;
}

static const assay_hsh_rotation_options EXACT = {.way = ASSAY_HSH_EXACT};

static assay_status check(const assay_basis *hsh, assay_context *context,
                          const assay_hsh_rotation_options *options)
{
    if (assay_basis_kind_of(hsh) != ASSAY_BASIS_HSH) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "this rotation needs the basis hsh, not %s",
                          assay_basis_kind_name(assay_basis_kind_of(hsh)));
    }
    if ((unsigned)options->way >= ASSAY_HSH_ROTATION_WAY_COUNT) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "no way %d of rotating", (int)options->way);
    }
    if (options->way == ASSAY_HSH_CONVERSION &&
        (options->sh_order < 0 || options->sh_order > ASSAY_BASIS_MAX_ORDER)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "SH order %d: it must be within 1 ... %d",
                          options->sh_order, ASSAY_BASIS_MAX_ORDER);
    }
    if (options->way == ASSAY_HSH_TABLE &&
        (options->table_steps < 0 || options->table_steps > TABLE_STEPS_MAX)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "%d table steps: they must be 1 ... %d",
                          options->table_steps, TABLE_STEPS_MAX);
    }
    return ASSAY_OK;
}

static assay_status turn_by(const turner *t, const assay_hsh_rotation_options *options, double beta,
                            double *matrix_out)
{
    switch (options->way) {
    case ASSAY_HSH_EXACT: return exact(t, beta, matrix_out);
    case ASSAY_HSH_TABLE:
        return from_table(t, options->table_steps ? options->table_steps : TABLE_STEPS, beta,
                          matrix_out);
    case ASSAY_HSH_CONVERSION: return by_conversion(t, options->sh_order, beta, matrix_out);
    case ASSAY_HSH_DIGON: return by_digon(t, beta, matrix_out);
    case ASSAY_HSH_ANALYTICAL: analytical(t, beta, matrix_out); return ASSAY_OK;
    }
    return ASSAY_ERR_INTERNAL;
}

assay_status assay_hsh_rotation_y(const assay_basis *hsh, assay_context *context,
                                  const assay_hsh_rotation_options *options, double beta,
                                  double *matrix_out)
{
    options                   = options ? options : &EXACT;
    const assay_status status = check(hsh, context, options);
    if (status) {
        return status;
    }
    const double limit = angle_limit(options->way);
    if (!(fabs(beta) <= limit)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN,
                          "a turn by %g rad: this way of rotating needs |beta| <= %g", beta, limit);
    }
    const turner t = {hsh, context, assay_basis_count(hsh)};
    return turn_by(&t, options, beta, matrix_out);
}

/* matrix = Z(alpha) matrix Z(gamma), by pairs of (l, m) and (l, -m). */
static void turn_about_z(const turner *t, const assay_euler_zyz *split, double *matrix)
{
    double ca[ASSAY_BASIS_MAX_ORDER], sa[ASSAY_BASIS_MAX_ORDER];
    double cg[ASSAY_BASIS_MAX_ORDER], sg[ASSAY_BASIS_MAX_ORDER];
    assay_angle_multiples(split->cos_alpha, split->sin_alpha, ASSAY_BASIS_MAX_ORDER, ca, sa);
    assay_angle_multiples(split->cos_gamma, split->sin_gamma, ASSAY_BASIS_MAX_ORDER, cg, sg);
    const size_t n = t->count;
    for (size_t i = 0; i < n; i++) {
        int l = 0, m = 0;
        assay_basis_function(t->hsh, i, &l, &m);
        if (m <= 0) {
            continue;
        }
        const size_t k = i - 2 * (size_t)m; /* (l, -m) */
        for (size_t j = 0; j < n; j++) {
            const double a = matrix[i * n + j], b = matrix[k * n + j];
            matrix[i * n + j] = ca[m] * a - sa[m] * b;
            matrix[k * n + j] = sa[m] * a + ca[m] * b;
        }
        for (size_t j = 0; j < n; j++) {
            const double a = matrix[j * n + i], b = matrix[j * n + k];
            matrix[j * n + i] = cg[m] * a + sg[m] * b;
            matrix[j * n + k] = cg[m] * b - sg[m] * a;
        }
    }
}

assay_status assay_hsh_rotation(const assay_basis *hsh, assay_context *context,
                                const assay_hsh_rotation_options *options, const double rotation[9],
                                double *matrix_out)
{
    options             = options ? options : &EXACT;
    assay_status status = check(hsh, context, options);
    if (status) {
        return status;
    }
    assay_euler_zyz split;
    if (!assay_euler_zyz_split(rotation, &split)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN, "the matrix is not a rotation");
    }
    const double limit = angle_limit(options->way);
    double       beta  = 2.0 * assay_atan2(split.sin_half_beta.hi, split.cos_half_beta.hi);
    if (beta > limit && beta <= limit + 0x1p-40) {
        beta = limit; /* the rounding of a matrix that was made for the limit itself */
    }
    const turner t = {hsh, context, assay_basis_count(hsh)};
    if (!(beta <= limit)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN,
                          "a tilt of %g rad: this way of rotating needs at most %g", beta, limit);
    }
    status = turn_by(&t, options, beta, matrix_out);
    if (!status) {
        turn_about_z(&t, &split, matrix_out);
    }
    return status;
}
