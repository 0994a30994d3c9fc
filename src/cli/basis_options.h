/* basis_options.h - the options of `assay basis ...`: one meaning for each name, whatever the
 * command.  A command's table says which it takes. */
#ifndef ASSAY_CLI_BASIS_OPTIONS_H
#define ASSAY_CLI_BASIS_OPTIONS_H

#include "assay/assay.h"
#include "console.h"
#include "options.h"

/* What was asked for; `given` tells which options there were. */
typedef struct {
    bool               help, json, hex, all_bases, accuracy, irradiance;
    bool               has_basis, has_from, has_to, has_direction, has_theta, has_phi, has_euler;
    bool               has_beta, has_via, has_lobe, has_l, has_m, has_normal, has_to_convention;
    assay_basis_kind   basis, from, to;
    assay_convention   convention, to_convention;
    long               order, to_order, sh_order, table_steps; /* 0: not given */
    long               theta_nodes, phi_nodes, samples, theta_steps, phi_steps;
    long               l, m, size;
    unsigned long long seed;
    assay_vec3         direction, normal;
    double             theta_deg, phi_deg, beta_deg, rotation_deg, euler_deg[3];
    assay_hsh_rotation_way via;
    assay_lobe             lobe;
    const char            *lobe_text, *env, *output;
    cli_console           *console; /* what the command runs on */
} basis_request;

#define BASIS_OPTION_BASIS                                                                         \
    {                                                                                              \
        "basis", 0, "NAME", "sh, hsh, zernike, makhotkin, makhotkin-sqrt, esh, lsosh"              \
    }
#define BASIS_OPTION_ORDER                                                                         \
    {                                                                                              \
        "order", 0, "N", "bands l < N; from 1 to 33"                                               \
    }
#define BASIS_OPTION_CONVENTION                                                                    \
    {                                                                                              \
        "convention", 0, "NAME", "thesis (default), plain: without (-1)^m, kontkanen"              \
    }
#define BASIS_OPTION_LOBE                                                                          \
    {                                                                                              \
        "lobe", 0, "L",                                                                            \
            "phong:EXPONENT@THETA[,PHI] or ward:AX,AY@THETA[,PHI]: direction of the eye, "         \
            "degrees; the "                                                                        \
            "lobe points to the mirror direction, THETA and PHI + 180"                             \
    }
#define BASIS_OPTIONS_PRINT                                                                        \
    {"json", 0, NULL, "print JSON, 17 significant digits"},                                        \
        {"hex", 0, NULL, "hexadecimal floats: every bit"}, {"help", 'h', NULL, "this text"},       \
    {                                                                                              \
        0                                                                                          \
    }

/* What is particular to one command. */
typedef struct {
    const char       *name;  /* "basis eval" */
    const char       *usage; /* what --help says before the options */
    const cli_option *options;
    const char       *extension; /* of --output; NULL: there is no such option */
    /* Whether the request makes sense; false after a message. */
    bool (*check)(const basis_request *request);
    assay_status (*run)(assay_context *context, const basis_request *request);
} basis_command;

/* Reads a command line, runs the command, and gives the exit code; request: the defaults. */
int cli_basis_run(const basis_command *command, int count, char **argv, basis_request request);

/* Complains, and answers false, where what a command needs was not given. */
bool cli_basis_need(const char *command, bool given, const char *option);

/* The basis of --basis (or another kind) at an order; complains where the library refuses. */
assay_status cli_basis_create(assay_context *context, const basis_request *request,
                              assay_basis_kind kind, long order, assay_basis **basis_out);

/* Degrees to radians. */
double cli_radians(double degrees);

/* The unit vector at a polar angle and azimuth. */
assay_vec3 cli_direction(double theta_deg, double phi_deg);

const char *cli_way_name(assay_hsh_rotation_way way);

/* The commands behind `assay basis`: arguments behind the name; they return the exit code. */
int cli_basis_eval(int count, char **argv);
int cli_basis_project(int count, char **argv);
int cli_basis_convert(int count, char **argv);
int cli_basis_rotate(int count, char **argv);
int cli_basis_digon(int count, char **argv);
int cli_basis_accuracy(int count, char **argv);
int cli_basis_plot(int count, char **argv);
int cli_basis_table(int count, char **argv);

#endif
