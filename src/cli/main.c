/* main.c - which command was asked for. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "console.h"

static const struct {
    const char *name;
    int (*run)(int count, char **argv);
    const char *summary;
} COMMANDS[] = {
    {"render", cli_render, "render a glTF scene to an OpenEXR image, or irradiance at points"},
    {"scene", cli_scene, "tell what a glTF scene holds, and what of it is not supported"},
    {"methods", cli_methods, "list the methods, their parameters, ranges and sources"},
    {"diff", cli_diff, "compare two OpenEXR images"},
    {"replay", cli_replay, "run one stage on given arrays: what should have come out of yours?"},
    {"verify", cli_verify, "say whether images are the same light as a reference, and how sure"},
    {"report", cli_report, "one HTML page: pictures, differences, stages, records, parameters"},
    {"basis", cli_basis, "SH, HSH and other bases: values, projections, rotations, pictures"},
};

enum { COMMAND_COUNT = sizeof COMMANDS / sizeof COMMANDS[0] };

static void print_usage(FILE *out)
{
    fprintf(out,
            "assay %s - reference renderer and test oracle for light caching\n\n"
            "usage: assay COMMAND ...    (assay COMMAND --help tells more)\n\n",
            assay_version());
    for (int i = 0; i < COMMAND_COUNT; i++) {
        fprintf(out, "  %-10s %s\n", COMMANDS[i].name, COMMANDS[i].summary);
    }
    fprintf(out,
            "\nexit codes: 0 success; 1 the images differ, or the candidate fails; 2 bad input\n"
            "or option, or cannot tell; 3 out of memory or cannot write; 4 internal error; 130 "
            "interrupted\n");
}

static int run_command(int argc, char **argv)
{
    if (argc < 2) {
        print_usage(stderr);
        return CLI_EXIT_USAGE;
    }
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0) {
        print_usage(stdout);
        return 0;
    }
    if (strcmp(name, "--version") == 0) {
        printf("assay %s\n", assay_version());
        return 0;
    }
    for (int i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(COMMANDS[i].name, name) == 0) {
            return COMMANDS[i].run(argc - 2, argv + 2);
        }
    }
    cli_complain(name, "unknown command or option; the commands are render, scene, methods, diff, "
                       "verify, replay, report, basis");
    return CLI_EXIT_USAGE;
}

/* A file that is opened must not become stdout or stderr because those were closed.  Writing to a
 * stand-in that is open for reading fails, as it should. */
static void fill_closed_streams(void)
{
    int fd = open("/dev/null", O_RDONLY);
    while (fd >= 0 && fd <= STDERR_FILENO) {
        fd = open("/dev/null", O_RDONLY);
    }
    if (fd >= 0) {
        close(fd);
    }
}

int main(int argc, char **argv)
{
    fill_closed_streams();
    const int code = run_command(argc, argv);
    /* A report that nobody got is no success; a full disk may show only now. */
    errno             = 0;
    const bool failed = ferror(stdout) != 0 || fflush(stdout) != 0;
    if (failed && (code == 0 || code == CLI_EXIT_DIFFERENT)) {
        cli_complain(argv[1], "standard output: %s", errno ? strerror(errno) : "cannot be written");
        return assay_status_exit_code(ASSAY_ERR_WRITE);
    }
    return code;
}
