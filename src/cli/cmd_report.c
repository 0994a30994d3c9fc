/* cmd_report.c - `assay report CANDIDATE... --reference REF -o report.html`. */
#include <stdio.h>

#include "console.h"
#include "options.h"
#include "output_check.h"

typedef struct {
    const char *candidates[ASSAY_REPORT_MAX_CANDIDATES];
    const char *verdicts[ASSAY_REPORT_MAX_CANDIDATES];
    const char *reference, *output, *title;
    size_t      candidate_count, verdict_count;
    uint64_t    memory_limit;
    bool        quiet, help;
} report_request;

enum { OPT_REFERENCE, OPT_OUTPUT, OPT_VERDICT, OPT_TITLE, OPT_QUIET, OPT_MEMORY, OPT_HELP };
static const cli_option OPTIONS[] = {
    {"reference", 0, "REF", "what is taken for true: an image or a bundle"},
    {"output", 'o', "F.html", "the page (required)"},
    {"verdict", 0, "F.json", "what `assay verify --json` wrote; once a candidate"},
    {"title", 0, "TEXT", "headline (default: the scene's name)"},
    {"quiet", 'q', NULL, "no warnings, no progress"},
    CLI_MEMORY_OPTION,
    {"help", 'h', NULL, "this text"},
    {0}};

static const char *take(void *user, int index, const char *value)
{
    report_request *request = user;
    switch (index) {
    case OPT_REFERENCE: request->reference = value; return *value ? NULL : "takes a name";
    case OPT_OUTPUT: request->output = value; return *value ? NULL : "takes a name";
    case OPT_VERDICT:
        if (request->verdict_count == ASSAY_REPORT_MAX_CANDIDATES) {
            return "too many of them";
        }
        request->verdicts[request->verdict_count++] = value;
        return *value ? NULL : "takes a name";
    case OPT_TITLE: request->title = value; return *value ? NULL : "takes a text";
    case OPT_QUIET: request->quiet = true; return NULL;
    case OPT_MEMORY: return cli_read_bytes(value, &request->memory_limit);
    case OPT_HELP: request->help = true; return NULL;
    default: break;
    }
    if (request->candidate_count == ASSAY_REPORT_MAX_CANDIDATES) {
        return "too many images; a report shows 64";
    }
    request->candidates[request->candidate_count++] = value;
    return *value ? NULL : "the name of an image is empty";
}

static void print_help(void)
{
    printf(
        "usage: assay report CANDIDATE... --reference REF -o F.html\n"
        "       assay report DIR -o F.html\n"
        "One HTML file, to look at in a browser, without a network: pictures, maps of the\n"
        "difference, histograms, stages, records, parameters. A candidate is an image, a bundle\n"
        "(--dump), or a folder of both. Without --reference it is the image by path with the\n"
        "most samples. NAME.json (--stats) and NAME.verdict.json (assay verify --json) beside\n"
        "NAME.exr are taken, too. Exit code 0 whatever the images say: assay verify judges.\n");
    cli_print_options(OPTIONS);
}

static int check_output(const report_request *r)
{
    int code = cli_check_extension("report", "-o", r->output, ".html");
    for (size_t i = 0; code == 0 && i < r->candidate_count; i++) {
        code = cli_check_not_input("report", r->output, r->candidates[i]);
    }
    if (code == 0 && r->reference) {
        code = cli_check_not_input("report", r->output, r->reference);
    }
    return code ? code : cli_check_file("report", r->output);
}

int cli_report(int count, char **argv)
{
    report_request request = {.reference = NULL};
    cli_console    console;
    if (!cli_parse("report", count, argv, OPTIONS, take, NULL, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        print_help();
        return 0;
    }
    const char *problem = request.candidate_count == 0 ? "no image, bundle or folder is named"
                          : !request.output            ? "-o F.html says where the page goes"
                                                       : NULL;
    if (problem) {
        cli_complain("report", "%s (assay report --help lists the options)", problem);
        return CLI_EXIT_USAGE;
    }
    const int check = check_output(&request);
    if (check != 0) {
        return check;
    }
    assay_context *context =
        cli_console_open(&console, "report", request.quiet, 0, request.memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    const assay_report_options options = {
        .reference       = request.reference,
        .candidates      = request.candidates,
        .candidate_count = request.candidate_count,
        .verdicts        = request.verdicts,
        .verdict_count   = request.verdict_count,
        .title           = request.title,
    };
    const int code = cli_console_finish(&console, context,
                                        assay_report_write(context, &options, request.output));
    assay_context_destroy(context);
    return code;
}
