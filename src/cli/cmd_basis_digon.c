/* cmd_basis_digon.c - `assay basis digon`. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis digon";
static const cli_option OPTIONS[] = {BASIS_OPTION_ORDER,
                                     {"beta-deg", 0, "B", "the turn about y; B > 0: towards +x"},
                                     BASIS_OPTION_CONVENTION,
                                     BASIS_OPTIONS_PRINT};

static assay_status make(assay_context *context, const basis_request *r)
{
    assay_basis *basis  = NULL;
    assay_status status = cli_basis_create(context, r, ASSAY_BASIS_HSH, r->order, &basis);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t count  = assay_basis_count(basis);
    double      *matrix = calloc(count * count, sizeof *matrix);
    status              = matrix ? assay_hsh_digon(basis, context, cli_radians(r->beta_deg), matrix)
                                 : ASSAY_ERR_MEMORY;
    if (status == ASSAY_OK && r->json) {
        status = cli_json_matrix(basis, basis, matrix, r->hex);
    } else if (status == ASSAY_OK) {
        cli_print_matrix(basis, basis, matrix, r->hex);
    }
    free(matrix);
    assay_basis_destroy(basis);
    return status;
}

static bool makes_sense(const basis_request *r)
{
    if (r->has_beta && !(fabs(r->beta_deg) <= 180.0)) {
        return cli_complain(COMMAND, "--beta-deg %.10g: -180 to 180 degrees are possible",
                            r->beta_deg);
    }
    return cli_basis_need(COMMAND, r->order > 0, "--order") &&
           cli_basis_need(COMMAND, r->has_beta, "--beta-deg");
}

static const basis_command SELF = {
    .name    = COMMAND,
    .usage   = "usage: assay basis digon --order N --beta-deg B\n"
               "The matrix, in HSH, that sets to zero what a turn by B moves below the horizon.\n",
    .options = OPTIONS,
    .check   = makes_sense,
    .run     = make};

int cli_basis_digon(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){0});
}
