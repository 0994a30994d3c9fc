/* basis_options.c - from words to a basis_request.
 *
 * Invariant: every name that a table of `assay basis ...` holds is in READERS. */
#include "basis_options.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "console.h"
#include "output_check.h"

static const double PI = 3.14159265358979323846;

static const char NO_BASIS[] =
    "no such basis; there are sh, hsh, zernike, makhotkin, makhotkin-sqrt, esh, lsosh";

double cli_radians(double degrees) { return degrees / 180.0 * PI; }

/* Sine and cosine of degrees, exact where they are 0, 1 or 1/2: 90 degrees are the horizon, not
 * 6e-17 above it.  Within an eighth of a turn a rotation matrix holds both. */
static void sincos_degrees(double degrees, double *sin_out, double *cos_out)
{
    const double rest = remainder(degrees, 90.0);
    const int    turn = (int)fmod((degrees - rest) / 90.0, 4.0);
    double       r[9];
    assay_rotation_from_euler_zyz(cli_radians(rest), 0.0, 0.0, r);
    const double s = fabs(rest) == 30.0 ? copysign(0.5, rest) : r[3], c = r[0];
    switch (turn & 3) {
    case 0: *sin_out = s, *cos_out = c; break;
    case 1: *sin_out = c, *cos_out = -s; break;
    case 2: *sin_out = -s, *cos_out = -c; break;
    default: *sin_out = -c, *cos_out = s; break;
    }
}

assay_vec3 cli_direction(double theta_deg, double phi_deg)
{
    double sin_theta, cos_theta, sin_phi, cos_phi;
    sincos_degrees(theta_deg, &sin_theta, &cos_theta);
    sincos_degrees(phi_deg, &sin_phi, &cos_phi);
    return (assay_vec3){sin_theta * cos_phi + 0.0, sin_theta * sin_phi + 0.0, cos_theta + 0.0};
}

static const char *const WAYS[ASSAY_HSH_ROTATION_WAY_COUNT] = {
    [ASSAY_HSH_EXACT]      = "exact",
    [ASSAY_HSH_TABLE]      = "table",
    [ASSAY_HSH_CONVERSION] = "conversion",
    [ASSAY_HSH_DIGON]      = "digon",
    [ASSAY_HSH_ANALYTICAL] = "analytical"};

const char *cli_way_name(assay_hsh_rotation_way way) { return WAYS[way]; }

static const char *read_order(const char *value, long *order)
{
    return cli_read_count(value, 1, ASSAY_BASIS_MAX_ORDER, order)
               ? "takes a whole number from 1 to 33"
               : NULL;
}

static const char *read_kind(const char *value, assay_basis_kind *kind, bool *given)
{
    *given = true;
    return assay_basis_kind_find(value, kind) == ASSAY_OK ? NULL : NO_BASIS;
}

static const char *read_real(const char *value, double *number, bool *given)
{
    *given = true;
    return cli_read_real(value, number);
}

static const char *read_nodes(const char *value, long *count)
{
    return cli_read_count(value, 1, 65536, count) ? "takes a whole number from 1 to 65536" : NULL;
}

/* "A,B" behind a separator; the second may be missing where optional is not NULL. */
static bool read_numbers(const char *text, size_t length, double *first, double *second,
                         bool *has_second)
{
    char copy[128];
    if (length == 0 || length >= sizeof copy) {
        return false;
    }
    memcpy(copy, text, length);
    copy[length] = '\0';
    char *comma  = strchr(copy, ',');
    *has_second  = comma != NULL;
    if (comma) {
        *comma = '\0';
    }
    return !cli_read_real(copy, first) && (!comma || !cli_read_real(comma + 1, second));
}

static const char *read_lobe(const char *text, basis_request *r)
{
    static const char usage[] = "takes phong:EXPONENT@THETA[,PHI] or ward:AX,AY@THETA[,PHI], "
                                "as in phong:5@60";
    const char       *at      = strchr(text, '@');
    const bool        phong   = strncmp(text, "phong:", 6) == 0;
    const char       *shape   = phong ? text + 6 : text + 5;
    double            first = 0.0, second = 0.0, theta = 0.0, phi = 0.0;
    bool              two, has_phi;
    if (!at || (!phong && strncmp(text, "ward:", 5) != 0) ||
        !read_numbers(shape, (size_t)(at - shape), &first, &second, &two) || two == phong ||
        !read_numbers(at + 1, strlen(at + 1), &theta, &phi, &has_phi)) {
        return usage;
    }
    if (!(theta >= 0.0 && theta < 90.0)) {
        return "the polar angle of a lobe is in [0, 90) degrees";
    }
    if (phong ? first < 0.0 : !(first > 0.0 && second > 0.0)) {
        return "an exponent is >= 0, a width > 0";
    }
    r->lobe      = (assay_lobe){.kind      = phong ? ASSAY_LOBE_PHONG : ASSAY_LOBE_WARD,
                                .exponent  = phong ? first : 0.0,
                                .alpha_x   = phong ? 0.0 : first,
                                .alpha_y   = second,
                                .theta_out = cli_radians(theta),
                                .phi_out   = cli_radians(phi)};
    r->lobe_text = text;
    r->has_lobe  = true;
    return NULL;
}

static const char *read_via(const char *value, basis_request *r)
{
    for (int i = 0; i < ASSAY_HSH_ROTATION_WAY_COUNT; i++) {
        if (strcmp(value, WAYS[i]) == 0) {
            r->via     = (assay_hsh_rotation_way)i;
            r->has_via = true;
            return NULL;
        }
    }
    return "takes exact, table, conversion, digon or analytical";
}

static const char *read_basis(const char *value, basis_request *r)
{
    r->all_bases = strcmp(value, "all") == 0;
    return r->all_bases ? NULL : read_kind(value, &r->basis, &r->has_basis);
}

static const char *read_direction(const char *value, assay_vec3 *direction, bool *given)
{
    double      d[3];
    const char *problem = cli_read_triple(value, d);
    if (!problem) {
        *direction = (assay_vec3){d[0], d[1], d[2]};
        *given     = true;
    }
    return problem;
}

static const char *read_convention(const char *value, assay_convention *convention)
{
    return assay_convention_find(value, convention) == ASSAY_OK
               ? NULL
               : "takes thesis, plain or kontkanen";
}

static const char *read_azimuthal(const char *value, basis_request *r)
{
    r->has_m = true;
    return cli_read_count(value, -ASSAY_BASIS_MAX_ORDER, ASSAY_BASIS_MAX_ORDER, &r->m);
}

static const char *read_band(const char *value, basis_request *r)
{
    r->has_l = true;
    return cli_read_count(value, 0, ASSAY_BASIS_MAX_ORDER - 1, &r->l)
               ? "takes a whole number from 0 to 32"
               : NULL;
}

/* What takes a number or a word. */
static const char *take_more(basis_request *r, const char *name, const char *value)
{
    bool given;
    if (strcmp(name, "theta-deg") == 0) {
        return read_real(value, &r->theta_deg, &r->has_theta);
    }
    if (strcmp(name, "phi-deg") == 0) {
        return read_real(value, &r->phi_deg, &r->has_phi);
    }
    if (strcmp(name, "beta-deg") == 0) {
        return read_real(value, &r->beta_deg, &r->has_beta);
    }
    if (strcmp(name, "rotation-deg") == 0) {
        return read_real(value, &r->rotation_deg, &given);
    }
    if (strcmp(name, "euler-zyz-deg") == 0) {
        r->has_euler = true;
        return cli_read_triple(value, r->euler_deg);
    }
    if (strcmp(name, "via") == 0) {
        return read_via(value, r);
    }
    if (strcmp(name, "lobe") == 0) {
        return read_lobe(value, r);
    }
    if (strcmp(name, "l") == 0) {
        return read_band(value, r);
    }
    if (strcmp(name, "m") == 0) {
        return read_azimuthal(value, r);
    }
    if (strcmp(name, "seed") == 0) {
        return cli_read_seed(value, &r->seed);
    }
    if (strcmp(name, "size") == 0) {
        return cli_read_count(value, 64, 2048, &r->size) ? "takes a whole number from 64 to 2048"
                                                         : NULL;
    }
    if (strcmp(name, "samples") == 0) {
        return cli_read_count(value, 2, 1000000000000, &r->samples)
                   ? "takes a whole number from 2 to 10^12"
                   : NULL;
    }
    return "unknown option";
}

static const char *take_counts(basis_request *r, const char *name, const char *value)
{
    const struct {
        const char *name;
        long       *count;
    } nodes[] = {{"theta-nodes", &r->theta_nodes},
                 {"phi-nodes", &r->phi_nodes},
                 {"theta-steps", &r->theta_steps},
                 {"phi-steps", &r->phi_steps},
                 {"table-steps", &r->table_steps}};
    for (size_t i = 0; i < sizeof nodes / sizeof nodes[0]; i++) {
        if (strcmp(name, nodes[i].name) == 0) {
            return read_nodes(value, nodes[i].count);
        }
    }
    return take_more(r, name, value);
}

typedef struct {
    const cli_option *table;
    basis_request    *request;
} basis_parser;

static const char *take(void *user, int index, const char *value)
{
    const basis_parser *p = user;
    basis_request      *r = p->request;
    if (index < 0) {
        return "no such argument; all is said by options";
    }
    const char *name = p->table[index].name;
    if (!value) {
        r->json       = r->json || strcmp(name, "json") == 0;
        r->hex        = r->hex || strcmp(name, "hex") == 0;
        r->help       = r->help || strcmp(name, "help") == 0;
        r->accuracy   = r->accuracy || strcmp(name, "accuracy") == 0;
        r->irradiance = r->irradiance || strcmp(name, "irradiance") == 0;
        return NULL;
    }
    if (strcmp(name, "basis") == 0) {
        return read_basis(value, r);
    }
    if (strcmp(name, "from") == 0) {
        return read_kind(value, &r->from, &r->has_from);
    }
    if (strcmp(name, "to") == 0) {
        return read_kind(value, &r->to, &r->has_to);
    }
    if (strcmp(name, "order") == 0 || strcmp(name, "max-order") == 0) {
        return read_order(value, &r->order);
    }
    if (strcmp(name, "to-order") == 0) {
        return read_order(value, &r->to_order);
    }
    if (strcmp(name, "sh-order") == 0) {
        return read_order(value, &r->sh_order);
    }
    if (strcmp(name, "convention") == 0) {
        return read_convention(value, &r->convention);
    }
    if (strcmp(name, "to-convention") == 0) {
        r->has_to_convention = true;
        return read_convention(value, &r->to_convention);
    }
    if (strcmp(name, "dir") == 0) {
        return read_direction(value, &r->direction, &r->has_direction);
    }
    if (strcmp(name, "normal") == 0) {
        return read_direction(value, &r->normal, &r->has_normal);
    }
    if (strcmp(name, "env") == 0) {
        r->env = value;
        return NULL;
    }
    if (strcmp(name, "output") == 0) {
        r->output = value;
        return NULL;
    }
    return take_counts(r, name, value);
}

bool cli_basis_need(const char *command, bool given, const char *option)
{
    return given || cli_complain(command, "%s is missing (assay %s --help lists the options)",
                                 option, command);
}

assay_status cli_basis_create(assay_context *context, const basis_request *request,
                              assay_basis_kind kind, long order, assay_basis **basis_out)
{
    return assay_basis_create(context, kind, (int)order, request->convention, basis_out);
}

int cli_basis_run(const basis_command *command, int count, char **argv, basis_request request)
{
    basis_parser parser = {command->options, &request};
    cli_console  console;
    if (!cli_parse(command->name, count, argv, command->options, take, NULL, &parser)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        fputs(command->usage, stdout);
        cli_print_options(command->options);
        return 0;
    }
    if (!command->check(&request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.output) {
        int code =
            cli_check_extension(command->name, "--output", request.output, command->extension);
        code = code ? code : cli_check_file(command->name, request.output);
        if (code) {
            return code;
        }
    }
    assay_context *context = cli_console_open(&console, command->name, false, 1, 0);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    request.console = &console;
    const int code  = cli_console_finish(&console, context, command->run(context, &request));
    assay_context_destroy(context);
    return code;
}
