/* stage_rotate.c - stage `rotate`: given coefficients turned, by Euler's angles or by a given
 * matrix.
 *
 * Bounds.  With a matrix that is given: its sums.  Of SH by angles: what is applied is a product of
 * at most five orthogonal matrices of size 2 l + 1 a band (the matrix itself; or turns about z and
 * constant quarter turns), each with entries that are rounded, times a vector: in the Euclidean
 * norm (2 l + 5) u sqrt(2 l + 1) |c| each, as the matrix of absolute values has at most that norm;
 * and angles that are off turn band l by at most l times as much.  Of HSH by angles: what
 * turn_bound.h says of Rz(alpha), M_R(beta), eq. 3.31, and Rz(gamma), one after the other or as one
 * matrix. */
#include <string.h>

#include "assay/basis.h"
#include "core/alloc.h"
#include "core/context.h"
#include "oracle/stage/basis_bound.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/turn_bound.h"

enum { IN, MATRIX };

/* clang-format off */
#define ANGLE(NAME, WORDS)                                                                         \
    {NAME, ASSAY_PARAM_REAL, "rad", "0", -1e3, 1e3, NULL, WORDS, "[gautron06] 3.2.4"}

static const assay_param_desc PARAMS[] = {
    {"basis", ASSAY_PARAM_CHOICE, "", "sh", 0, 0, "sh|hsh", "Which functions.", ""},
    {"order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL, "Bands l < order.", ""},
    {"convention", ASSAY_PARAM_CHOICE, "", "thesis", 0, 0, STAGE_CONVENTIONS,
     "Signs and order of the functions.", "docs/conventions.md"},
    ANGLE("alpha", "R = Rz(alpha) Ry(beta) Rz(gamma), active; without rotate/matrix."),
    ANGLE("beta", "Likewise; > 0 moves the pole towards +x."),
    ANGLE("gamma", "Likewise."),
    {0}};

static const assay_stage_array INPUTS[] = {
    {"rotate/in", NULL, NULL, "function to turn", "a column a function of the basis",
     false, false, false},
    {"rotate/matrix", "", NULL, "function", "c' = M c: instead of the angles", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"rotate/out", NULL, NULL, "function to turn", "coefficients of the turned function",
     false, false, false},
    {0}};
/* clang-format on */

static assay_status make_matrix(const stage_run *run, const assay_basis *basis, double *matrix)
{
    double rotation[9];
    assay_rotation_from_euler_zyz(assay_params_real(run->params, "alpha"),
                                  assay_params_real(run->params, "beta"),
                                  assay_params_real(run->params, "gamma"), rotation);
    return assay_basis_kind_of(basis) == ASSAY_BASIS_SH
               ? assay_sh_rotation(basis, rotation, matrix)
               : assay_hsh_rotation(basis, run->context, NULL, rotation, matrix);
}

static double angle_error(const stage_run *run, const char *name)
{
    return fabs(assay_params_real(run->params, name)) *
           (run->rounding.given + 4.0 * run->rounding.u);
}

static double angles_error(const stage_run *run)
{
    return angle_error(run, "alpha") + angle_error(run, "beta") + angle_error(run, "gamma");
}

static void bound_sh(const stage_run *run, const assay_basis *basis, const double *matrix,
                     const double *in, double *bounds)
{
    const rounding *r     = &run->rounding;
    const size_t    count = assay_basis_count(basis);
    for (size_t i = 0; i < count; i++) {
        int    l = 0, m = 0;
        double squared = 0.0, carried = 0.0;
        assay_basis_function(basis, i, &l, &m);
        for (size_t j = 0; j < count; j++) {
            int band = 0;
            assay_basis_function(basis, j, &band, &m);
            if (band == l) {
                squared += in[j] * in[j];
                carried += fabs(matrix[i * count + j]) * given_error(r, in[j]);
            }
        }
        const double size = 2.0 * l + 1.0;
        const double turn = l * angles_error(run) + 5.0 * (size + 4.0) * sqrt(size) * r->u;
        bounds[i]         = carried + turn * sqrt(squared) * (1.0 + r->given) + r->tiny * size;
    }
}

/* What turns of HSH are bounded by. */
typedef struct {
    turn_bound *bound;
    double     *norms, *slopes; /* pairs * pairs        */
    double     *rows;           /* 3 of pairs, 1 of all */
} hsh_turn;

static assay_status open_hsh(const stage_run *run, const assay_basis *basis, const double *matrix,
                             hsh_turn *turn)
{
    const assay_radiance_turn_settings settings = {.way = ASSAY_HSH_EXACT};
    const size_t                       count    = assay_basis_count(basis);
    assay_status status = turn_bound_create(run->context, basis, NULL, &settings, &turn->bound);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t pairs = turn_bound_pairs(turn->bound);
    turn->norms        = assay_allocate(run->context, pairs * pairs, sizeof *turn->norms);
    turn->slopes       = assay_allocate(run->context, pairs * pairs, sizeof *turn->slopes);
    turn->rows         = assay_allocate(run->context, 3 * pairs + count, sizeof *turn->rows);
    if (!turn->norms || !turn->slopes || !turn->rows) {
        return assay_fail_memory(run->context, "bounds of a rotation");
    }
    turn_bound_norms(turn->bound, matrix, turn->norms);
    turn_bound_slopes(turn->bound, turn->slopes);
    return ASSAY_OK;
}

static void close_hsh(const stage_run *run, hsh_turn *turn)
{
    turn_bound_destroy(turn->bound);
    assay_release(run->context, turn->norms);
    assay_release(run->context, turn->slopes);
    assay_release(run->context, turn->rows);
}

/* out: our own result. */
static void bound_hsh(const stage_run *run, const hsh_turn *turn, size_t count, const double *in,
                      const double *out, double *bounds)
{
    const rounding *r     = &run->rounding;
    const size_t    pairs = turn_bound_pairs(turn->bound);
    double         *sizes = turn->rows, *errors = sizes + pairs, *through = errors + pairs;
    double         *given = through + pairs;
    for (size_t i = 0; i < count; i++) {
        given[i] = given_error(r, in[i]);
    }
    turn_bound_sizes(turn->bound, in, sizes);
    turn_bound_sizes(turn->bound, given, errors);
    turn_bound_spin_row(turn->bound, r, angle_error(run, "gamma"), sizes, errors);
    turn_bound_product(turn->bound, r, turn->norms, turn->slopes, angle_error(run, "beta"), sizes,
                       errors, through);
    turn_bound_sizes(turn->bound, out, sizes);
    turn_bound_spin_row(turn->bound, r, angle_error(run, "alpha"), sizes, through);
    for (size_t i = 0; i < count; i++) {
        bounds[i] = through[turn_bound_pair_of(turn->bound, i)];
    }
}

static void bound_product(const rounding *r, size_t count, const double *matrix, const double *in,
                          double *bounds)
{
    for (size_t i = 0; i < count; i++) {
        tracked_sum sum = {0};
        for (size_t j = 0; j < count; j++) {
            tracked_sum_add(&sum, tracked_mul(r, tracked_given(r, matrix[i * count + j]),
                                              tracked_given(r, in[j])));
        }
        bounds[i] = tracked_sum_of(r, &sum).e;
    }
}

static void multiply(size_t count, const double *matrix, const double *in, double *out)
{
    for (size_t i = 0; i < count; i++) {
        double sum = 0.0;
        for (size_t j = 0; j < count; j++) {
            sum += matrix[i * count + j] * in[j];
        }
        out[i] = sum;
    }
}

static assay_status turn_rows(stage_run *run, const assay_basis *basis, const double *matrix)
{
    const size_t  rows = run->in[IN].rows, count = assay_basis_count(basis);
    const bool    given  = run->in[MATRIX].values != NULL;
    const bool    sh     = assay_basis_kind_of(basis) == ASSAY_BASIS_SH;
    const bool    hsh    = run->bounded && !given && !sh;
    hsh_turn      turned = {0};
    stage_output *out    = NULL;
    assay_status  status = stage_output_make(run, 0, 0, rows, count, &out);
    if (status == ASSAY_OK && hsh) {
        status = open_hsh(run, basis, matrix, &turned);
    }
    for (size_t i = 0; i < rows && status == ASSAY_OK; i++) {
        const double *in = run->in[IN].values + i * count;
        if (sh && !given) {
            status = assay_sh_rotate(basis, matrix, 1, in, out->values + i * count);
        } else {
            multiply(count, matrix, in, out->values + i * count);
        }
        if (run->bounded && given) {
            bound_product(&run->rounding, count, matrix, in, out->bounds + i * count);
        } else if (run->bounded && sh) {
            bound_sh(run, basis, matrix, in, out->bounds + i * count);
        } else if (hsh && status == ASSAY_OK) {
            bound_hsh(run, &turned, count, in, out->values + i * count, out->bounds + i * count);
        }
    }
    close_hsh(run, &turned);
    return status;
}

static assay_status turn(stage_run *run, const assay_basis *basis)
{
    const size_t count = assay_basis_count(basis);
    if (run->in[IN].columns != count) {
        return stage_fail_columns(run, IN, count);
    }
    if (run->in[MATRIX].values) {
        return run->in[MATRIX].columns != count || run->in[MATRIX].rows != count
                   ? stage_fail_columns(run, MATRIX, count)
                   : turn_rows(run, basis, run->in[MATRIX].values);
    }
    double *matrix = assay_allocate(run->context, count * count, sizeof *matrix);
    if (!matrix) {
        return assay_fail_memory(run->context, "a rotation");
    }
    assay_status status = make_matrix(run, basis, matrix);
    status              = status ? status : turn_rows(run, basis, matrix);
    assay_release(run->context, matrix);
    return status;
}

static assay_status run_rotate(stage_run *run)
{
    assay_basis *basis  = NULL;
    const bool   sh     = assay_params_choice(run->params, "basis") == 0;
    assay_status status = assay_basis_create(
        run->context, sh ? ASSAY_BASIS_SH : ASSAY_BASIS_HSH, assay_params_int(run->params, "order"),
        (assay_convention)assay_params_choice(run->params, "convention"), &basis);
    status = status ? status : turn(run, basis);
    assay_basis_destroy(basis);
    return status;
}

const oracle_stage stage_rotate = {.info = {.name    = "rotate",
                                            .summary = "given coefficients turned",
                                            .params  = PARAMS,
                                            .inputs  = INPUTS,
                                            .outputs = OUTPUTS},
                                   .run  = run_rotate};
