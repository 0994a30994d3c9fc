/* cmd_basis_table.c - `assay basis table`: what others can test all their values against. */
#include <stdio.h>
#include <stdlib.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis table";
static const cli_option OPTIONS[] = {
    BASIS_OPTION_BASIS,
    BASIS_OPTION_ORDER,
    {"theta-steps", 0, "N", "from the pole to the horizon or the other pole (default 6)"},
    {"phi-steps", 0, "N", "around (default 8)"},
    {"output", 'o', "F.npy", "rows of x, y, z and all values, as NumPy reads them"},
    BASIS_OPTION_CONVENTION,
    BASIS_OPTIONS_PRINT};

enum { DIRECTION = 3 };

/* Fills rows of x, y, z, values. */
static assay_status fill(const assay_basis *basis, const basis_request *r, double *table)
{
    const size_t columns = DIRECTION + assay_basis_count(basis);
    const double range   = assay_basis_kind_is_hemispherical(r->basis) ? 90.0 : 180.0;
    for (long i = 0; i <= r->theta_steps; i++) {
        for (long j = 0; j < r->phi_steps; j++, table += columns) {
            const double       theta  = range * (double)i / (double)r->theta_steps;
            const double       phi    = 360.0 * (double)j / (double)r->phi_steps;
            const assay_vec3   d      = cli_direction(theta, phi);
            const assay_status status = assay_basis_evaluate(basis, d, table + DIRECTION);
            if (status != ASSAY_OK) {
                return status;
            }
            table[0] = d.x;
            table[1] = d.y;
            table[2] = d.z;
        }
    }
    return ASSAY_OK;
}

static void print_rows(const assay_basis *basis, const double *table, size_t rows, bool hex)
{
    const size_t columns = DIRECTION + assay_basis_count(basis);
    const int    width   = hex ? 22 : 24;
    printf(" %*s %*s %*s", width, "x", width, "y", width, "z");
    for (size_t c = DIRECTION; c < columns; c++) {
        int  l, m;
        char name[16];
        assay_basis_function(basis, c - DIRECTION, &l, &m);
        snprintf(name, sizeof name, "%d,%d", l, m);
        printf(" %*s", width, name);
    }
    printf("\n");
    for (size_t i = 0; i < rows * columns; i++) {
        cli_print_number(table[i], hex, width);
        if ((i + 1) % columns == 0) {
            printf("\n");
        }
    }
}

static assay_status print_json(const assay_basis *basis, const double *table, size_t rows, bool hex)
{
    cJSON     *root = cli_json_basis(basis);
    const bool ok =
        root && cJSON_AddStringToObject(root, "columns", "x, y, z, then the functions") &&
        cli_json_add_rows(root, "values", table, rows, DIRECTION + assay_basis_count(basis), hex);
    return cli_json_print(root, ok);
}

static assay_status make(assay_context *context, const basis_request *r)
{
    assay_basis *basis  = NULL;
    assay_array *array  = NULL;
    const size_t rows   = (size_t)(r->theta_steps + 1) * (size_t)r->phi_steps;
    assay_status status = cli_basis_create(context, r, r->basis, r->order, &basis);
    if (status == ASSAY_OK) {
        status = assay_array_create(context, rows, DIRECTION + assay_basis_count(basis), &array);
    }
    if (status == ASSAY_OK) {
        status = fill(basis, r, assay_array_data(array));
    }
    if (status == ASSAY_OK && r->output) {
        status = assay_array_write_npy(array, r->output);
    } else if (status == ASSAY_OK && r->json) {
        status = print_json(basis, assay_array_values(array), rows, r->hex);
    } else if (status == ASSAY_OK) {
        print_rows(basis, assay_array_values(array), rows, r->hex);
    }
    assay_array_destroy(array);
    assay_basis_destroy(basis);
    return status;
}

static bool makes_sense(const basis_request *r)
{
    if (r->output && (r->json || r->hex)) {
        return cli_complain(COMMAND, "--json and --hex are of what is printed, not of --output");
    }
    return cli_basis_need(COMMAND, r->has_basis, "--basis") &&
           cli_basis_need(COMMAND, r->order > 0, "--order");
}

static const basis_command SELF = {
    .name      = COMMAND,
    .usage     = "usage: assay basis table --basis NAME --order N [--json|--hex|-o F.npy]\n",
    .options   = OPTIONS,
    .extension = ".npy",
    .check     = makes_sense,
    .run       = make};

int cli_basis_table(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){.theta_steps = 6, .phi_steps = 8});
}
