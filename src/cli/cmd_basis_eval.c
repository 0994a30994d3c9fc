/* cmd_basis_eval.c - `assay basis eval`. */
#include <stdio.h>
#include <stdlib.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis eval";
static const cli_option OPTIONS[] = {BASIS_OPTION_BASIS,
                                     BASIS_OPTION_ORDER,
                                     {"dir", 0, "X,Y,Z", "unit direction"},
                                     {"theta-deg", 0, "T", "or its polar angle from +z"},
                                     {"phi-deg", 0, "P", "and azimuth from +x towards +y"},
                                     BASIS_OPTION_CONVENTION,
                                     BASIS_OPTIONS_PRINT};

static assay_status print_values(const assay_basis *basis, const double *values, bool json,
                                 bool hex)
{
    static const char *const name = "value";
    if (!json) {
        cli_print_functions(basis, &name, 1, values, hex);
        return ASSAY_OK;
    }
    cJSON     *root = cli_json_basis(basis);
    const bool ok =
        root && cli_json_add_list(root, "values", values, assay_basis_count(basis), hex);
    return cli_json_print(root, ok);
}

static assay_status evaluate(assay_context *context, const basis_request *request)
{
    assay_basis     *basis = NULL;
    const assay_vec3 d     = request->has_direction
                                 ? request->direction
                                 : cli_direction(request->theta_deg, request->phi_deg);
    assay_status     status =
        cli_basis_create(context, request, request->basis, request->order, &basis);
    if (status != ASSAY_OK) {
        return status;
    }
    double *values = calloc(assay_basis_count(basis), sizeof *values);
    status         = values ? assay_basis_evaluate(basis, d, values) : ASSAY_ERR_MEMORY;
    if (status == ASSAY_OK) {
        status = print_values(basis, values, request->json, request->hex);
    } else if (status == ASSAY_ERR_DOMAIN) {
        request->console->said = true;
        cli_complain(COMMAND, "direction (%g, %g, %g): it must be a unit vector%s", d.x, d.y, d.z,
                     assay_basis_kind_is_hemispherical(request->basis) ? " with z >= 0" : "");
    }
    free(values);
    assay_basis_destroy(basis);
    return status;
}

static bool makes_sense(const basis_request *r)
{
    if (r->has_direction && (r->has_theta || r->has_phi)) {
        return cli_complain(COMMAND, "a direction comes as --dir or as angles, not as both");
    }
    return cli_basis_need(COMMAND, r->has_basis, "--basis") &&
           cli_basis_need(COMMAND, r->order > 0, "--order") &&
           cli_basis_need(COMMAND, r->has_direction || r->has_theta, "--dir or --theta-deg");
}

static const basis_command SELF = {
    .name    = COMMAND,
    .usage   = "usage: assay basis eval --basis NAME --order N --dir X,Y,Z [--json|--hex]\n",
    .options = OPTIONS,
    .check   = makes_sense,
    .run     = evaluate};

int cli_basis_eval(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){0});
}
