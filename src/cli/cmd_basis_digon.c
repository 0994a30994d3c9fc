/* cmd_basis_digon.c - `assay basis digon`. */
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

int cli_basis_digon(int count, char **argv)
{
    basis_request request = {0};
    cli_console   console;
    if (!cli_basis_parse(COMMAND, count, argv, OPTIONS, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        printf("usage: assay basis digon --order N --beta-deg B\n"
               "The matrix, in HSH, that sets to zero what a turn by B moves below the horizon.\n");
        cli_print_options(OPTIONS);
        return 0;
    }
    if (!cli_basis_need(COMMAND, request.order > 0, "--order") ||
        !cli_basis_need(COMMAND, request.has_beta, "--beta-deg")) {
        return CLI_EXIT_USAGE;
    }
    assay_context *context = cli_console_open(&console, COMMAND, false, 1, 0);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    const int code = cli_console_finish(&console, context, make(context, &request));
    assay_context_destroy(context);
    return code;
}
