/* stage_convert.c - stage `convert`: coefficients in SH to HSH, or back.
 *
 * The matrix is a table of constants, each rounded once; so a row is a sum of products. */
#include "assay/basis.h"
#include "core/context.h"
#include "oracle/stage/basis_bound.h"
#include "oracle/stage/stage_list.h"

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    {"from", ASSAY_PARAM_CHOICE, "", "sh", 0, 0, "sh|hsh", "Basis that is given; the other is made.",
     "[gautron06] eq. 3.20"},
    {"from_order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL, "Its order.", ""},
    {"to_order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL, "Order that is made.",
     ""},
    {"convention", ASSAY_PARAM_CHOICE, "", "thesis", 0, 0, "thesis|plain",
     "Signs of the functions of both.", "docs/conventions.md"},
    {0}};

static const assay_stage_array INPUTS[] = {
    {"convert/in", NULL, NULL, "function", "a column a function of the given basis",
     false, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"convert/out", NULL, NULL, "function", "a column a function of the other one",
     false, false, false},
    {0}};
/* clang-format on */

static void bound_row(const rounding *r, const assay_sparse_view *c, const double *in,
                      double *bounds)
{
    for (size_t i = 0; i < c->rows; i++) {
        tracked_sum sum = {0};
        for (size_t k = c->row_start[i]; k < c->row_start[i + 1]; k++) {
            tracked_sum_add(&sum, tracked_mul(r, tracked_constant(r, c->value[k]),
                                              tracked_given(r, in[c->column[k]])));
        }
        bounds[i] = tracked_sum_of(r, &sum).e;
    }
}

static assay_status convert(stage_run *run, const assay_sparse *matrix)
{
    const assay_sparse_view c   = assay_sparse_entries(matrix);
    stage_output           *out = NULL;
    if (run->in[0].columns != c.columns) {
        return stage_fail_columns(run, 0, c.columns);
    }
    const assay_status status = stage_output_make(run, 0, 0, run->in[0].rows, c.rows, &out);
    for (size_t i = 0; i < run->in[0].rows && status == ASSAY_OK; i++) {
        const double *in = run->in[0].values + i * c.columns;
        assay_sparse_multiply(matrix, in, out->values + i * c.rows);
        if (run->bounded) {
            bound_row(&run->rounding, &c, in, out->bounds + i * c.rows);
        }
    }
    return status;
}

static assay_status run_convert(stage_run *run)
{
    const bool             sh = assay_params_choice(run->params, "from") == 0;
    const assay_convention convention =
        (assay_convention)assay_params_choice(run->params, "convention");
    assay_basis  *from = NULL, *to = NULL;
    assay_sparse *matrix = NULL;
    assay_status  status =
        assay_basis_create(run->context, sh ? ASSAY_BASIS_SH : ASSAY_BASIS_HSH,
                           assay_params_int(run->params, "from_order"), convention, &from);
    status = status
                 ? status
                 : assay_basis_create(run->context, sh ? ASSAY_BASIS_HSH : ASSAY_BASIS_SH,
                                      assay_params_int(run->params, "to_order"), convention, &to);
    status = status ? status : assay_basis_conversion(run->context, from, to, &matrix);
    status = status ? status : convert(run, matrix);
    assay_sparse_destroy(matrix);
    assay_basis_destroy(from);
    assay_basis_destroy(to);
    return status;
}

const oracle_stage stage_convert = {.info = {.name    = "convert",
                                             .summary = "given coefficients from SH to HSH or back",
                                             .params  = PARAMS,
                                             .inputs  = INPUTS,
                                             .outputs = OUTPUTS},
                                    .run  = run_convert};
