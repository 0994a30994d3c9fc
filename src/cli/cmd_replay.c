/* cmd_replay.c - `assay replay STAGE --in BUNDLE -o BUNDLE`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/replay.h"
#include "console.h"
#include "options.h"
#include "output_check.h"
#include "scene_options.h"

enum { MOST_PARAMS = 64 };

typedef struct {
    assay_replay_options options;
    const char          *params[MOST_PARAMS];
    const char          *scene;
    assay_precision      bounds;
    cli_scene_request    request;
    double               time;
    uint64_t             memory_limit;
    long                 threads;
    bool                 help;
} replay_request;

enum {
    OPT_IN,
    OPT_OUT,
    OPT_SCENE,
    OPT_TIME,
    OPT_PARAM,
    OPT_BOUNDS,
    OPT_INPUTS,
    OPT_THREADS,
    OPT_MEMORY,
    OPT_HELP
};
static const cli_option OPTIONS[] = {
    {"in", 'i', "BUNDLE", "the folder with the inputs"},
    {"output", 'o', "BUNDLE", "the folder that is made, with the outputs"},
    {"scene", 's', "F.gltf", "of stages that look at one"},
    {"time", 0, "T", "seconds into the scene's animations (default 0)"},
    {"param", 'p', "K=V", "a parameter of the stage, instead of what the manifest says"},
    {"bounds", 0, "PRECISION", "half, float or double: adds NAME_bound for each output NAME"},
    {"with-inputs", 0, NULL, "writes the inputs, too: a reference for assay verify"},
    {"threads", 0, "N", "worker threads (default: all processors)"},
    CLI_MEMORY_OPTION,
    {"help", 'h', NULL, "this text"},
    CLI_SCENE_OPTIONS,
    {0}};

static const char *take_param(replay_request *r, const char *value)
{
    if (r->options.param_count == MOST_PARAMS) {
        return "too many of them";
    }
    r->params[r->options.param_count++] = value;
    return NULL;
}

static const char *take_bounds(replay_request *r, const char *value)
{
    r->options.bounds = &r->bounds;
    return assay_precision_find(value, &r->bounds) ? "takes half, float or double" : NULL;
}

static const char *take(void *user, int index, const char *value)
{
    replay_request *r       = user;
    const char     *problem = NULL;
    switch (index) {
    case OPT_IN: r->options.in = value; return NULL;
    case OPT_OUT: r->options.out = value; return NULL;
    case OPT_SCENE: r->scene = value; return NULL;
    case OPT_TIME: return cli_read_real(value, &r->time);
    case OPT_PARAM: return take_param(r, value);
    case OPT_BOUNDS: return take_bounds(r, value);
    case OPT_INPUTS: r->options.inputs = true; return NULL;
    case OPT_THREADS:
        return cli_read_count(value, 1, 1024, &r->threads) ? "takes a number from 1 to 1024" : NULL;
    case OPT_MEMORY: return cli_read_bytes(value, &r->memory_limit);
    case OPT_HELP: r->help = true; return NULL;
    default: break;
    }
    if (index >= 0) {
        cli_scene_option(&r->request, OPTIONS[index].name, value, &problem);
        return problem;
    }
    if (r->options.stage) {
        return "one stage at a time";
    }
    r->options.stage = value;
    return NULL;
}

static void print_arrays(const char *title, const assay_stage_array *arrays)
{
    for (const assay_stage_array *a = arrays; a->name; a++) {
        printf("    %-5s%-30s %s%s%s%s%s\n", a == arrays ? title : "", a->name,
               a->channels ? a->channels : "...", a->unit && *a->unit ? " [" : "",
               a->unit ? a->unit : "", a->unit && *a->unit ? "]" : "",
               a->optional ? " (optional)" : "");
        printf("         a row a %s%s%s\n", a->rows, *a->what ? ": " : "", a->what);
    }
}

static void print_help(void)
{
    printf("usage: assay replay STAGE --in BUNDLE [--scene F.gltf] -o BUNDLE\n"
           "What a stage makes of given arrays (docs/bundle.md tells what they are).\n");
    cli_print_options(OPTIONS);
    printf("\nstages:\n");
    for (int i = 0; i < assay_stage_count(); i++) {
        const assay_stage_info stage = assay_stage_at(i);
        printf("  %s - %s%s\n", stage.name, stage.summary,
               stage.needs_scene ? " (needs --scene)" : "");
        print_arrays("in", stage.inputs);
        print_arrays("out", stage.outputs);
        for (const assay_param_desc *p = stage.params; p->name; p++) {
            printf("    -p %s=%s%s%s%s\n         %s\n", p->name, p->default_value,
                   p->choices ? " (" : "", p->choices ? p->choices : "", p->choices ? ")" : "",
                   p->summary);
        }
    }
}

/* What the options say together; NULL, or what is wrong. */
static const char *check_together(const replay_request *r)
{
    if (!r->options.stage) {
        return "which stage? assay replay --help lists them";
    }
    if (!r->options.in || !*r->options.in) {
        return "--in BUNDLE is missing";
    }
    if (!r->options.out || !*r->options.out) {
        return "-o BUNDLE is missing";
    }
    return cli_scene_check(&r->request);
}

static assay_status replay(assay_context *context, replay_request *r)
{
    assay_scene *scene  = NULL;
    assay_status status = ASSAY_OK;
    if (r->scene) {
        status = assay_scene_load(context, r->scene, &r->request.options, &scene);
        status = status ? status : assay_scene_set_time(scene, r->time);
    }
    r->options.scene  = scene;
    r->options.params = r->params;
    status            = status ? status : assay_replay(context, &r->options);
    assay_scene_destroy(scene);
    return status;
}

int cli_replay(int count, char **argv)
{
    replay_request r = {.request = cli_scene_request_default()};
    cli_console    console;
    if (!cli_parse("replay", count, argv, OPTIONS, take, NULL, &r)) {
        return CLI_EXIT_USAGE;
    }
    if (r.help) {
        print_help();
        return 0;
    }
    const char *problem = check_together(&r);
    if (problem) {
        cli_complain("replay", "%s", problem);
        return CLI_EXIT_USAGE;
    }
    const int check = cli_check_new_folder("replay", r.options.out);
    if (check != 0) {
        return check;
    }
    assay_context *context =
        cli_console_open(&console, "replay", false, (int)r.threads, r.memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    const int code = cli_console_finish(&console, context, replay(context, &r));
    assay_context_destroy(context);
    return code;
}
