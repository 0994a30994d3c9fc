/* cmd_methods.c - `assay methods [NAME] [--json]`. */
#include <stdio.h>
#include <string.h>

#include "console.h"
#include "options.h"

typedef struct {
    const char *name;
    bool        json, help;
} methods_request;

enum { OPT_JSON, OPT_HELP };
static const cli_option OPTIONS[] = {
    {"json", 0, NULL, "print JSON"}, {"help", 'h', NULL, "this text"}, {0}};

static const char *take(void *user, int index, const char *value)
{
    methods_request *request = user;
    switch (index) {
    case OPT_JSON: request->json = true; return NULL;
    case OPT_HELP: request->help = true; return NULL;
    default: break;
    }
    if (request->name) {
        return "one method at a time";
    }
    request->name = value;
    return NULL;
}

static void print_param(const assay_param_desc *p)
{
    char range[128] = "on or off";
    switch (p->type) {
    case ASSAY_PARAM_BOOL: break;
    case ASSAY_PARAM_CHOICE: snprintf(range, sizeof range, "%s", p->choices); break;
    case ASSAY_PARAM_PATH: snprintf(range, sizeof range, "a path"); break;
    case ASSAY_PARAM_INT:
    case ASSAY_PARAM_REAL:
        if (p->maximum == ASSAY_PARAM_INF) {
            snprintf(range, sizeof range, "%g ... inf", p->minimum);
        } else {
            snprintf(range, sizeof range, "%g ... %g", p->minimum, p->maximum);
        }
        break;
    }
    printf("  %-16s %s%s%s (default %s)\n  %-16s %s%s%s\n", p->name, range, *p->unit ? " " : "",
           p->unit, *p->default_value ? p->default_value : "none", "", p->summary,
           *p->source ? " " : "", p->source);
}

static void print_methods(const char *only)
{
    for (int i = 0; i < assay_method_count(); i++) {
        const assay_method_info method = assay_method_at(i);
        if (!only || strcmp(only, method.name) == 0) {
            printf("%s - %s\n", method.name, method.summary);
            for (const assay_param_desc *p = method.params; p->name; p++) {
                print_param(p);
            }
        }
    }
}

int cli_methods(int count, char **argv)
{
    methods_request request = {0};
    cli_console     console;
    if (!cli_parse("methods", count, argv, OPTIONS, take, NULL, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        printf("usage: assay methods [NAME] [--json]\n");
        cli_print_options(OPTIONS);
        return 0;
    }
    assay_context *context = cli_console_open(&console, "methods", false, 1, 0);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    char        *text   = NULL;
    assay_status status = assay_methods_json(context, request.name, &text);
    if (status == ASSAY_OK && request.json) {
        puts(text);
    } else if (status == ASSAY_OK) {
        print_methods(request.name);
    }
    assay_text_destroy(context, text);
    const int code = cli_console_finish(&console, context, status);
    assay_context_destroy(context);
    return code;
}
