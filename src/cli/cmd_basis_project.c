/* cmd_basis_project.c - `assay basis project`: an environment map or a lobe in a basis. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis project";
static const cli_option OPTIONS[] = {
    {"env", 0, "F", "environment map, latitude-longitude, .exr or .hdr, integrated exactly"},
    {"normal", 0, "X,Y,Z",
     "pole of the hemisphere for a map in a hemispherical basis (default +z)"},
    {"rotation-deg", 0, "D", "turn the map about world +y"},
    {"irradiance", 0, NULL, "times A_l of the clamped cosine: irradiance, not radiance"},
    BASIS_OPTION_LOBE,
    BASIS_OPTION_BASIS,
    BASIS_OPTION_ORDER,
    {"theta-nodes", 0, "N",
     "nodes of a product rule for a lobe; without it nodes follow the lobe until nothing moves"},
    {"phi-nodes", 0, "N", "around (default: twice as many)"},
    {"samples", 0, "N", "Monte Carlo instead, with variances"},
    {"seed", 0, "S", "of its random numbers (default 0)"},
    BASIS_OPTION_CONVENTION,
    BASIS_OPTIONS_PRINT};

enum { CHANNELS = 3 };

static assay_status project_hemisphere(assay_context *context, const assay_basis *basis,
                                       const basis_request *r, const assay_image *map, double turn,
                                       double *coefficients)
{
    double       frame[9];
    assay_status status = assay_rotation_to_pole(r->normal, frame);
    if (status != ASSAY_OK) {
        r->console->said = true;
        cli_complain(COMMAND, "--normal %g,%g,%g: it must be a unit vector", r->normal.x,
                     r->normal.y, r->normal.z);
        return status;
    }
    return assay_basis_project_environment_hemisphere(basis, context, map, turn, frame,
                                                      coefficients);
}

static assay_status project_map(assay_context *context, const assay_basis *basis,
                                const basis_request *r, double *coefficients)
{
    assay_image *map    = NULL;
    assay_status status = assay_image_read(context, r->env, &map);
    if (status == ASSAY_OK) {
        const double turn = cli_radians(r->rotation_deg);
        status            = assay_basis_kind_is_hemispherical(r->basis)
                                ? project_hemisphere(context, basis, r, map, turn, coefficients)
                                : assay_basis_project_environment(basis, map, turn, coefficients);
    }
    assay_image_destroy(map);
    if (status == ASSAY_OK && r->irradiance) {
        status = assay_basis_convolve_cosine(basis, CHANNELS, coefficients);
    }
    return status;
}

static assay_status report_map(assay_context *context, const assay_basis *basis,
                               const basis_request *r, double *coefficients)
{
    static const char *const names[CHANNELS] = {"R", "G", "B"};
    assay_status             status          = project_map(context, basis, r, coefficients);
    if (status != ASSAY_OK) {
        return status;
    }
    if (!r->json) {
        cli_print_functions(basis, names, CHANNELS, coefficients, r->hex);
        return ASSAY_OK;
    }
    const double normal[3] = {r->normal.x, r->normal.y, r->normal.z};
    cJSON       *root      = cli_json_basis(basis);
    cJSON       *channels  = cJSON_CreateStringArray(names, CHANNELS);
    const bool   added     = root && channels && cJSON_AddItemToObject(root, "channels", channels);
    const bool   dome      = assay_basis_kind_is_hemispherical(r->basis);
    const bool   ok =
        added && (!dome || cli_json_add_list(root, "normal", normal, 3, r->hex)) &&
        cli_json_add_rows(root, "values", coefficients, CHANNELS, assay_basis_count(basis), r->hex);
    if (!added) {
        cJSON_Delete(channels);
    }
    return cli_json_print(root, ok);
}

static void lobe_value(void *user, assay_vec3 direction, double *values_out)
{
    if (assay_lobe_value(user, direction, values_out) != ASSAY_OK) {
        *values_out = 0.0;
    }
}

static assay_status project_lobe(assay_context *context, const assay_basis *basis,
                                 const basis_request *r, double *coefficients)
{
    const size_t count = assay_basis_count(basis);
    assay_lobe   lobe  = r->lobe;
    if (r->samples > 0) {
        return assay_basis_project_random(basis, context, lobe_value, &lobe, 1,
                                          (uint64_t)r->samples, r->seed, coefficients,
                                          coefficients + count);
    }
    if (r->theta_nodes || r->phi_nodes) {
        const long theta = r->theta_nodes ? r->theta_nodes : r->phi_nodes / 2 + 1;
        const long phi   = r->phi_nodes ? r->phi_nodes : 2 * theta;
        return assay_basis_project(basis, context, lobe_value, &lobe, 1, (int)theta, (int)phi,
                                   coefficients);
    }
    const assay_status status = assay_basis_project_lobe(basis, context, &lobe, coefficients);
    if (status == ASSAY_ERR_DOMAIN) {
        r->console->said = true;
        cli_complain(COMMAND,
                     "--lobe %s: %s (--theta-nodes takes a product rule without that check, "
                     "--samples takes random directions)",
                     r->lobe_text, assay_context_error(context));
    }
    return status;
}

/* coefficients: one row; behind it, where there are samples, one of variances. */
static assay_status report_lobe(assay_context *context, const assay_basis *basis,
                                const basis_request *r, double *coefficients)
{
    static const char *const names[2] = {"value", "variance"};
    const size_t             count    = assay_basis_count(basis);
    const bool               random   = r->samples > 0;
    const assay_status       status   = project_lobe(context, basis, r, coefficients);
    if (status != ASSAY_OK) {
        return status;
    }
    if (!r->json) {
        cli_print_functions(basis, names, random ? 2 : 1, coefficients, r->hex);
        return ASSAY_OK;
    }
    cJSON     *root = cli_json_basis(basis);
    const bool ok =
        root && cJSON_AddStringToObject(root, "lobe", r->lobe_text) &&
        cli_json_add_list(root, "values", coefficients, count, r->hex) &&
        (!random || cli_json_add_list(root, "variances", coefficients + count, count, r->hex));
    return cli_json_print(root, ok);
}

static assay_status report(assay_context *context, const basis_request *r)
{
    assay_basis *basis  = NULL;
    assay_status status = cli_basis_create(context, r, r->basis, r->order, &basis);
    if (status != ASSAY_OK) {
        return status;
    }
    double *coefficients = calloc(CHANNELS * assay_basis_count(basis), sizeof *coefficients);
    if (!coefficients) {
        status = ASSAY_ERR_MEMORY;
    } else if (r->env) {
        status = report_map(context, basis, r, coefficients);
    } else {
        status = report_lobe(context, basis, r, coefficients);
    }
    free(coefficients);
    assay_basis_destroy(basis);
    return status;
}

static bool makes_sense(const basis_request *r)
{
    if (!r->env && !r->has_lobe) {
        return cli_basis_need(COMMAND, false, "--env or --lobe");
    }
    if (r->env && r->has_lobe) {
        return cli_complain(COMMAND, "--env and --lobe: one thing at a time");
    }
    const bool dome = r->env && assay_basis_kind_is_hemispherical(r->basis);
    if (r->has_normal && !dome) {
        return cli_complain(COMMAND, "--normal is of --env in a hemispherical basis");
    }
    if (r->irradiance && dome) {
        return cli_complain(COMMAND, "--irradiance is of --basis sh: A_l are factors of SH");
    }
    if (r->env && (r->samples || r->theta_nodes || r->phi_nodes)) {
        return cli_complain(COMMAND,
                            "--samples, --theta-nodes and --phi-nodes are of --lobe: a map "
                            "is integrated exactly");
    }
    if (r->samples && (r->theta_nodes || r->phi_nodes)) {
        return cli_complain(COMMAND, "--samples and nodes: one way at a time");
    }
    if (r->irradiance && !r->env) {
        return cli_complain(COMMAND, "--irradiance is of --env");
    }
    return cli_basis_need(COMMAND, r->env || r->has_basis, "--basis") &&
           cli_basis_need(COMMAND, r->order > 0, "--order");
}

static const basis_command SELF = {
    .name    = COMMAND,
    .usage   = "usage: assay basis project --env F --order N [--basis NAME [--normal X,Y,Z]]\n"
               "       assay basis project --lobe L --basis NAME --order N\n",
    .options = OPTIONS,
    .check   = makes_sense,
    .run     = report};

int cli_basis_project(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv,
                         (basis_request){.basis = ASSAY_BASIS_SH, .normal = {0.0, 0.0, 1.0}});
}
