/* cmd_diff.c - `assay diff A.exr B.exr`. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "console.h"
#include "options.h"
#include "output_check.h"

typedef struct {
    const char *paths[2];
    const char *heat_map;
    double      scale;
    uint64_t    memory_limit;
    int         path_count;
    bool        has_scale, json, help;
} diff_request;

enum { OPT_HEAT, OPT_SCALE, OPT_JSON, OPT_MEMORY, OPT_HELP };
static const cli_option OPTIONS[] = {
    {"heat-map", 0, "F.png", "draw the relative difference"},
    {"scale", 0, "X", "relative difference at the hot end of the map (default 0.1)"},
    {"json", 0, NULL, "print JSON"},
    CLI_MEMORY_OPTION,
    {"help", 'h', NULL, "this text"},
    {0}};

static const char *take(void *user, int index, const char *value)
{
    diff_request *request = user;
    switch (index) {
    case OPT_HEAT: request->heat_map = value; return NULL;
    case OPT_SCALE:
        request->has_scale = true;
        return cli_read_real(value, &request->scale) || !(request->scale > 0.0)
                   ? "takes a number > 0"
                   : NULL;
    case OPT_JSON: request->json = true; return NULL;
    case OPT_MEMORY: return cli_read_bytes(value, &request->memory_limit);
    case OPT_HELP: request->help = true; return NULL;
    default: break;
    }
    if (request->path_count == 2) {
        return "two images at a time";
    }
    request->paths[request->path_count++] = value;
    return NULL;
}

static void print_table(const assay_comparison *comparison)
{
    printf("%-24s %10s %13s %13s %13s %12s %8s\n", "channel", "differing", "mean A", "mean error",
           "rmse", "rel. rmse", "z rms");
    for (int i = 0; i < assay_comparison_count(comparison); i++) {
        const assay_channel_difference d = assay_comparison_at(comparison, i);
        printf("%-24s %10llu %13.6g %13.6g %13.6g %12.6g ", d.channel,
               (unsigned long long)d.differing, d.mean_a, d.mean_error, d.rmse, d.relative_rmse);
        if (isnan(d.z_rms)) {
            printf("%8s\n", "-");
        } else {
            printf("%8.3f\n", d.z_rms);
        }
    }
    printf("%s\n", assay_comparison_identical(comparison) ? "identical" : "different");
}

static bool add_channel(cJSON *list, const assay_channel_difference *d)
{
    cJSON *json = cJSON_CreateObject();
    if (!json || !cJSON_AddItemToArray(list, json)) {
        cJSON_Delete(json);
        return false;
    }
    return cJSON_AddStringToObject(json, "channel", d->channel) &&
           cJSON_AddNumberToObject(json, "pixels", (double)d->pixels) &&
           cJSON_AddNumberToObject(json, "differing", (double)d->differing) &&
           cJSON_AddNumberToObject(json, "not_finite", (double)d->not_finite) &&
           cJSON_AddNumberToObject(json, "mean_a", d->mean_a) &&
           cJSON_AddNumberToObject(json, "mean_b", d->mean_b) &&
           cJSON_AddNumberToObject(json, "max_abs", d->max_abs) &&
           cJSON_AddNumberToObject(json, "max_x", d->max_x) &&
           cJSON_AddNumberToObject(json, "max_y", d->max_y) &&
           cJSON_AddNumberToObject(json, "rmse", d->rmse) &&
           cJSON_AddNumberToObject(json, "relative_rmse", d->relative_rmse) &&
           cJSON_AddNumberToObject(json, "mean_error", d->mean_error) &&
           cJSON_AddNumberToObject(json, "z_rms", d->z_rms);
}

static bool print_json(const assay_comparison *comparison)
{
    cJSON *root = cJSON_CreateObject();
    cJSON *list = root ? cJSON_AddArrayToObject(root, "channels") : NULL;
    bool   ok =
        list && cJSON_AddBoolToObject(root, "identical", assay_comparison_identical(comparison));
    for (int i = 0; ok && i < assay_comparison_count(comparison); i++) {
        const assay_channel_difference d = assay_comparison_at(comparison, i);
        ok                               = add_channel(list, &d);
    }
    char *text = ok ? cJSON_Print(root) : NULL;
    if (text) {
        puts(text);
    }
    cJSON_free(text);
    cJSON_Delete(root);
    return text != NULL;
}

static assay_status draw(const assay_image *a, const assay_image *b, const diff_request *request)
{
    assay_image *map    = NULL;
    assay_status status = assay_image_heat_map(a, b, request->scale, &map);
    if (status == ASSAY_OK) {
        status = assay_image_write_png(map, "", 0.0, request->heat_map);
    }
    assay_image_destroy(map);
    return status;
}

/* The library knows images, not their names. */
static assay_status compare_images(cli_console *console, const assay_context *context,
                                   const diff_request *request, assay_image *const images[2],
                                   assay_comparison **comparison_out)
{
    const assay_status status = assay_image_compare(images[0], images[1], comparison_out);
    if (status != ASSAY_OK) {
        cli_complain("diff", "%s, %s: %s", request->paths[0], request->paths[1],
                     assay_context_error(context));
        console->said = true;
    }
    return status;
}

static assay_status compare(cli_console *console, assay_context *context,
                            const diff_request *request, bool *identical_out)
{
    assay_image      *images[2]  = {NULL, NULL};
    assay_comparison *comparison = NULL;
    assay_status      status     = assay_image_read(context, request->paths[0], &images[0]);
    if (status == ASSAY_OK) {
        status = assay_image_read(context, request->paths[1], &images[1]);
    }
    if (status == ASSAY_OK && cli_console_stopped()) {
        status = ASSAY_ERR_CANCELLED;
    }
    if (status == ASSAY_OK) {
        status = compare_images(console, context, request, images, &comparison);
    }
    if (status == ASSAY_OK && request->heat_map) {
        status = draw(images[0], images[1], request);
    }
    if (status == ASSAY_OK) {
        *identical_out = assay_comparison_identical(comparison);
        if (!request->json) {
            print_table(comparison);
        } else if (!print_json(comparison)) {
            status = ASSAY_ERR_MEMORY;
        }
    }
    assay_comparison_destroy(comparison);
    assay_image_destroy(images[0]);
    assay_image_destroy(images[1]);
    return status;
}

static int check_heat_map(const diff_request *r)
{
    int code = cli_check_not_input("diff", r->heat_map, r->paths[0]);
    code     = code ? code : cli_check_not_input("diff", r->heat_map, r->paths[1]);
    code     = code ? code : cli_check_extension("diff", "--heat-map", r->heat_map, ".png");
    return code ? code : cli_check_file("diff", r->heat_map);
}

/* What the options say together; NULL, or what is wrong. */
static const char *check_together(const diff_request *r)
{
    if (r->path_count != 2) {
        return "two images are compared";
    }
    if (!*r->paths[0] || !*r->paths[1]) {
        return "the name of an image is empty";
    }
    return r->has_scale && !r->heat_map ? "--scale without --heat-map does nothing" : NULL;
}

int cli_diff(int count, char **argv)
{
    diff_request request = {.scale = 0.1};
    cli_console  console;
    if (!cli_parse("diff", count, argv, OPTIONS, take, NULL, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        printf("usage: assay diff A.exr B.exr [--heat-map F.png] [--json]\n"
               "A is the reference. Exit code 0: every bit the same; 1: they differ.\n");
        cli_print_options(OPTIONS);
        return 0;
    }
    const char *problem = check_together(&request);
    if (problem) {
        cli_complain("diff", "%s (assay diff --help lists the options)", problem);
        return CLI_EXIT_USAGE;
    }
    const int check = request.heat_map ? check_heat_map(&request) : 0;
    if (check != 0) {
        return check;
    }
    assay_context *context = cli_console_open(&console, "diff", false, 0, request.memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    bool      identical = false;
    const int code =
        cli_console_finish(&console, context, compare(&console, context, &request, &identical));
    assay_context_destroy(context);
    return code != 0 ? code : identical ? 0 : CLI_EXIT_DIFFERENT;
}
