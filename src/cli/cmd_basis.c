/* cmd_basis.c - `assay basis COMMAND ...`: which one was asked for. */
#include <stdio.h>
#include <string.h>

#include "basis_options.h"
#include "console.h"

static const struct {
    const char *name;
    int (*run)(int count, char **argv);
    const char *summary;
} COMMANDS[] = {
    {"eval", cli_basis_eval, "values of all functions at a direction"},
    {"table", cli_basis_table, "values on a grid of directions"},
    {"project", cli_basis_project, "coefficients of an environment map or a BRDF lobe"},
    {"convert", cli_basis_convert, "matrix from SH to HSH or back"},
    {"rotate", cli_basis_rotate, "rotation matrix of SH or HSH"},
    {"digon", cli_basis_digon, "matrix that clears what a turn moves below the horizon"},
    {"accuracy", cli_basis_accuracy, "share of a BRDF lobe's energy that a basis captures"},
    {"plot", cli_basis_plot, "picture of a function, or of accuracies"},
};

enum { COMMAND_COUNT = sizeof COMMANDS / sizeof COMMANDS[0] };

static void print_usage(FILE *out)
{
    fprintf(out, "usage: assay basis COMMAND ...    (assay basis COMMAND --help tells more)\n\n");
    for (int i = 0; i < COMMAND_COUNT; i++) {
        fprintf(out, "  %-9s %s\n", COMMANDS[i].name, COMMANDS[i].summary);
    }
    fprintf(out, "\nThe pole is +z. Matrices act as out = M in. Rotations are active: R = Rz(A) "
                 "Ry(B) Rz(G).\n");
}

int cli_basis(int count, char **argv)
{
    if (count < 1) {
        print_usage(stderr);
        return CLI_EXIT_USAGE;
    }
    if (strcmp(argv[0], "--help") == 0 || strcmp(argv[0], "-h") == 0) {
        print_usage(stdout);
        return 0;
    }
    for (int i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(argv[0], COMMANDS[i].name) == 0) {
            return COMMANDS[i].run(count - 1, argv + 1);
        }
    }
    cli_complain("basis",
                 "%s: unknown command or option; there are eval, table, project, convert, rotate, "
                 "digon, accuracy, plot",
                 argv[0]);
    return CLI_EXIT_USAGE;
}
