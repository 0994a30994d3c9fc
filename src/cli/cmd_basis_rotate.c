/* cmd_basis_rotate.c - `assay basis rotate`: rotation matrices of SH and HSH. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis rotate";
static const cli_option OPTIONS[] = {
    {"basis", 0, "NAME", "sh, lsosh or hsh"},
    BASIS_OPTION_ORDER,
    {"euler-zyz-deg", 0, "A,B,G", "R = Rz(A) Ry(B) Rz(G), active, right-handed"},
    {"beta-deg", 0, "B", "or about y alone: B > 0 moves the pole towards +x"},
    {"via", 0, "WAY", "hsh: exact (default); approximate: table, conversion, digon, analytical"},
    {"sh-order", 0, "N", "conversion: order of the SH between (default: the same)"},
    {"table-steps", 0, "N", "table: intervals over 90 degrees (default 16)"},
    BASIS_OPTION_CONVENTION,
    BASIS_OPTIONS_PRINT};

static assay_status rotate_hsh(assay_context *context, const assay_basis *basis,
                               const basis_request *r, double *matrix)
{
    const assay_hsh_rotation_options options = {
        .way = r->via, .sh_order = (int)r->sh_order, .table_steps = (int)r->table_steps};
    if (r->has_beta) {
        return assay_hsh_rotation_y(basis, context, &options, cli_radians(r->beta_deg), matrix);
    }
    double rotation[9];
    assay_rotation_from_euler_zyz(cli_radians(r->euler_deg[0]), cli_radians(r->euler_deg[1]),
                                  cli_radians(r->euler_deg[2]), rotation);
    return assay_hsh_rotation(basis, context, &options, rotation, matrix);
}

static assay_status rotate_sh(const assay_basis *basis, const basis_request *r, double *matrix)
{
    double rotation[9];
    assay_rotation_from_euler_zyz(cli_radians(r->euler_deg[0]),
                                  cli_radians(r->has_beta ? r->beta_deg : r->euler_deg[1]),
                                  cli_radians(r->euler_deg[2]), rotation);
    return assay_sh_rotation(basis, rotation, matrix);
}

static assay_status rotate(assay_context *context, const basis_request *r)
{
    assay_basis *basis  = NULL;
    assay_status status = cli_basis_create(context, r, r->basis, r->order, &basis);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t count  = assay_basis_count(basis);
    double      *matrix = calloc(count * count, sizeof *matrix);
    if (!matrix) {
        status = ASSAY_ERR_MEMORY;
    } else if (r->basis == ASSAY_BASIS_HSH) {
        status = rotate_hsh(context, basis, r, matrix);
    } else {
        status = rotate_sh(basis, r, matrix);
    }
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
    if (!cli_basis_need(COMMAND, r->has_basis, "--basis") ||
        !cli_basis_need(COMMAND, r->order > 0, "--order") ||
        !cli_basis_need(COMMAND, r->has_euler || r->has_beta, "--euler-zyz-deg or --beta-deg")) {
        return false;
    }
    if (r->has_euler && r->has_beta) {
        return cli_complain(COMMAND, "--euler-zyz-deg and --beta-deg: one of them says it all");
    }
    const bool   whole = r->via == ASSAY_HSH_EXACT || r->via == ASSAY_HSH_CONVERSION;
    const double limit = whole ? 180.0 : 90.0;
    if (r->basis == ASSAY_BASIS_HSH && r->has_beta && !(fabs(r->beta_deg) <= limit)) {
        return cli_complain(COMMAND, "--beta-deg %.10g: --via %s takes -%g to %g degrees",
                            r->beta_deg, cli_way_name(r->via), limit, limit);
    }
    if (r->basis == ASSAY_BASIS_HSH && ((r->sh_order && r->via != ASSAY_HSH_CONVERSION) ||
                                        (r->table_steps && r->via != ASSAY_HSH_TABLE))) {
        return cli_complain(COMMAND, "--sh-order is of --via conversion, --table-steps of --via "
                                     "table");
    }
    if (r->basis != ASSAY_BASIS_HSH && (r->has_via || r->sh_order || r->table_steps)) {
        return cli_complain(COMMAND, "--via, --sh-order and --table-steps are of --basis hsh: SH "
                                     "turn exactly");
    }
    if (r->basis != ASSAY_BASIS_HSH && r->basis != ASSAY_BASIS_SH &&
        r->basis != ASSAY_BASIS_LSOSH) {
        return cli_complain(COMMAND, "%s: rotations are known of sh, lsosh and hsh",
                            assay_basis_kind_name(r->basis));
    }
    return true;
}

static const basis_command SELF = {
    .name    = COMMAND,
    .usage   = "usage: assay basis rotate --basis sh --order N --euler-zyz-deg A,B,G\n"
               "       assay basis rotate --basis hsh --via WAY --order N --beta-deg B\n",
    .options = OPTIONS,
    .check   = makes_sense,
    .run     = rotate};

int cli_basis_rotate(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){.via = ASSAY_HSH_EXACT});
}
