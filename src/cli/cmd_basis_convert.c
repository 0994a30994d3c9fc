/* cmd_basis_convert.c - `assay basis convert`: the matrix between SH and HSH. */
#include <stdio.h>
#include <stdlib.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis convert";
static const cli_option OPTIONS[] = {
    {"from", 0, "NAME", "sh or hsh"},
    {"to", 0, "NAME", "the other one"},
    {"order", 0, "N", "of what comes in: bands l < N, 1 to 33"},
    {"to-order", 0, "N", "of what comes out (default: the same)"},
    BASIS_OPTION_CONVENTION,
    {"to-convention", 0, "NAME", "of what comes out (default: the same)"},
    BASIS_OPTIONS_PRINT};

static void expand(const assay_sparse *sparse, double *matrix)
{
    const assay_sparse_view view = assay_sparse_entries(sparse);
    for (size_t r = 0; r < view.rows; r++) {
        for (size_t e = view.row_start[r]; e < view.row_start[r + 1]; e++) {
            matrix[r * view.columns + view.column[e]] = view.value[e];
        }
    }
}

static assay_status print(const assay_basis *from, const assay_basis *to,
                          const assay_sparse *sparse, const basis_request *r)
{
    double *matrix = calloc(assay_basis_count(from) * assay_basis_count(to), sizeof *matrix);
    if (!matrix) {
        return ASSAY_ERR_MEMORY;
    }
    assay_status status = ASSAY_OK;
    expand(sparse, matrix);
    if (r->json) {
        status = cli_json_matrix(to, from, matrix, r->hex);
    } else {
        cli_print_matrix(to, from, matrix, r->hex);
    }
    free(matrix);
    return status;
}

static assay_status convert(assay_context *context, const basis_request *r)
{
    assay_basis  *from = NULL, *to = NULL;
    assay_sparse *sparse = NULL;
    const long    order  = r->to_order ? r->to_order : r->order;
    assay_status  status = cli_basis_create(context, r, r->from, r->order, &from);
    if (status == ASSAY_OK) {
        status = assay_basis_create(context, r->to, (int)order,
                                    r->has_to_convention ? r->to_convention : r->convention, &to);
    }
    if (status == ASSAY_OK) {
        status = assay_basis_conversion(context, from, to, &sparse);
    }
    if (status == ASSAY_OK) {
        status = print(from, to, sparse, r);
    }
    assay_sparse_destroy(sparse);
    assay_basis_destroy(from);
    assay_basis_destroy(to);
    return status;
}

static bool makes_sense(const basis_request *r)
{
    return cli_basis_need(COMMAND, r->has_from, "--from") &&
           cli_basis_need(COMMAND, r->has_to, "--to") &&
           cli_basis_need(COMMAND, r->order > 0, "--order");
}

static const basis_command SELF = {.name  = COMMAND,
                                   .usage = "usage: assay basis convert --from hsh --to sh --order "
                                            "N [--to-order N] [--to-convention C]\n",
                                   .options = OPTIONS,
                                   .check   = makes_sense,
                                   .run     = convert};

int cli_basis_convert(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){0});
}
