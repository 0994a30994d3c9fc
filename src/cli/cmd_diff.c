/* cmd_diff.c - `assay diff A.exr B.exr`. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "console.h"
#include "diff_report.h"
#include "options.h"
#include "output_check.h"

typedef struct {
    const char           *paths[2];
    const char           *heat_map, *flip_map;
    double                scale;
    bool                  flip[2]; /* by assay_flip_kind */
    assay_metrics_options metrics;
    uint64_t              memory_limit;
    int                   path_count;
    bool                  has_scale, has_layer, has_hdr_option, json, help;
} diff_request;

enum {
    OPT_LAYER,
    OPT_FLIP,
    OPT_EXPOSURE,
    OPT_PPD,
    OPT_TONE,
    OPT_START,
    OPT_STOP,
    OPT_COUNT,
    OPT_FLIP_MAP,
    OPT_HEAT,
    OPT_SCALE,
    OPT_JSON,
    OPT_MEMORY,
    OPT_HELP
};
static const cli_option OPTIONS[] = {
    {"layer", 0, "NAME", "the picture of SSIM and FLIP: Indirect, Albedo, ... (default: R, G, B)"},
    {"flip", 0, "KIND", "FLIP to compute: ldr, hdr, both or none (default: both)"},
    {"exposure", 0, "STOPS", "of the display picture of SSIM and LDR-FLIP (default 0)"},
    {"ppd", 0, "X", "pixels per degree of visual angle, for FLIP (default 67.02)"},
    {"tone-mapper", 0, "NAME", "of HDR-FLIP: aces, hable or reinhard (default: aces)"},
    {"start-exposure", 0, "STOPS", "of HDR-FLIP (default: from A)"},
    {"stop-exposure", 0, "STOPS", "of HDR-FLIP (default: from A)"},
    {"exposures", 0, "N", "of HDR-FLIP, ends included (default: one a stop, at least 2)"},
    {"flip-map", 0, "F", "write the FLIP map, HDR unless --flip ldr: F.png in colours, F.exr"},
    {"heat-map", 0, "F", "write the relative difference: F.png in colours, F.exr"},
    {"scale", 0, "X", "relative difference at the hot end of the map (default 0.1)"},
    {"json", 0, NULL, "print JSON"},
    CLI_MEMORY_OPTION,
    {"help", 'h', NULL, "this text"},
    {0}};

static const char *read_exposure(const char *value, double *out)
{
    return cli_read_real(value, out) || fabs(*out) > 100.0 ? "takes stops, -100 to 100" : NULL;
}

static const char *read_kind(const char *value, bool flip[2])
{
    const bool both = strcmp(value, "both") == 0, none = strcmp(value, "none") == 0;
    flip[ASSAY_FLIP_LDR] = both || strcmp(value, "ldr") == 0;
    flip[ASSAY_FLIP_HDR] = both || strcmp(value, "hdr") == 0;
    return flip[0] || flip[1] || none ? NULL : "takes ldr, hdr, both or none";
}

static const char *read_tone_mapper(const char *value, assay_tone_mapper *out)
{
    const char *name;
    for (int i = 0; (name = assay_tone_mapper_name((assay_tone_mapper)i)) != NULL; i++) {
        if (strcmp(name, value) == 0) {
            *out = (assay_tone_mapper)i;
            return NULL;
        }
    }
    return "takes aces, hable or reinhard";
}

static const char *read_ppd(const char *value, double *out)
{
    return cli_read_real(value, out) || !(*out >= ASSAY_PIXELS_PER_DEGREE_MIN) ||
                   !(*out <= ASSAY_PIXELS_PER_DEGREE_MAX)
               ? "takes a number of 1 to 1000"
               : NULL;
}

static const char *read_exposures(const char *value, int *out)
{
    long count = 0;
    if (cli_read_count(value, 1, ASSAY_FLIP_MAX_EXPOSURES, &count)) {
        return "takes a whole number of 1 to 1000";
    }
    *out = (int)count;
    return NULL;
}

/* Options of the measures of pictures. */
static const char *take_metric(diff_request *request, int index, const char *value)
{
    assay_metrics_options *m = &request->metrics;
    request->has_hdr_option |= index >= OPT_TONE && index <= OPT_COUNT;
    switch (index) {
    case OPT_LAYER:
        request->has_layer = true;
        m->layer           = value;
        return NULL;
    case OPT_FLIP: return read_kind(value, request->flip);
    case OPT_EXPOSURE: return read_exposure(value, &m->exposure);
    case OPT_PPD: return read_ppd(value, &m->pixels_per_degree);
    case OPT_TONE: return read_tone_mapper(value, &m->tone_mapper);
    case OPT_START: return read_exposure(value, &m->start_exposure);
    case OPT_STOP: return read_exposure(value, &m->stop_exposure);
    default: return read_exposures(value, &m->exposures);
    }
}

static const char *take(void *user, int index, const char *value)
{
    diff_request *request = user;
    if (index >= OPT_LAYER && index <= OPT_COUNT) {
        return take_metric(request, index, value);
    }
    switch (index) {
    case OPT_FLIP_MAP: request->flip_map = value; return NULL;
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

/* ---- the work ---- */

typedef struct {
    cli_console        *console;
    assay_context      *context;
    const diff_request *request;
    assay_image        *images[2], *flip_map;
    assay_comparison   *comparison;
    diff_report         report;
} diff_work;

/* The library knows images, not their names. */
static assay_status explained(diff_work *work, assay_status status)
{
    if (status != ASSAY_OK && status != ASSAY_ERR_CANCELLED) {
        cli_complain("diff", "%s, %s: %s", work->request->paths[0], work->request->paths[1],
                     assay_context_error(work->context));
        work->console->said = true;
    }
    return status;
}

static assay_status read_images(diff_work *work)
{
    assay_status status = ASSAY_OK;
    for (int i = 0; i < 2 && status == ASSAY_OK; i++) {
        const char *path = work->request->paths[i];
        status           = assay_image_read(work->context, path, &work->images[i]);
        if (status == ASSAY_OK && cli_console_stopped()) {
            status = ASSAY_ERR_CANCELLED;
        }
    }
    for (int i = 0; i < 2 && status == ASSAY_OK; i++) {
        status = assay_image_check_finite(work->images[i]);
        if (status != ASSAY_OK) {
            cli_complain("diff", "%s: %s", work->request->paths[i],
                         assay_context_error(work->context));
            work->console->said = true;
        }
    }
    return status;
}

/* Whether an image has any channel of the layer: then it must have all of them. */
static bool has_some(const assay_image *image, const char *layer)
{
    bool found = false;
    for (const char *c = "RGB"; *c; c++) {
        char name[300];
        snprintf(name, sizeof name, "%.255s%s%c", layer, layer[0] ? "." : "", *c);
        found |= assay_image_find_channel(image, name, NULL);
    }
    return found;
}

static assay_status measure_picture(diff_work *work)
{
    diff_report       *report = &work->report;
    const char        *layer  = report->options.layer;
    const assay_image *a = work->images[0], *b = work->images[1];
    const bool         hdr = work->request->flip[ASSAY_FLIP_HDR];
    if (!work->request->has_layer && !work->request->flip_map && !has_some(a, layer) &&
        !has_some(b, layer)) {
        return ASSAY_OK;
    }
    assay_status status = assay_image_ssim(a, b, &report->options, &report->ssim);
    for (int kind = 0; kind < 2 && status == ASSAY_OK; kind++) {
        if (work->request->flip[kind]) {
            const bool mapped      = work->request->flip_map && (kind == ASSAY_FLIP_HDR) == hdr;
            status                 = assay_image_flip(a, b, (assay_flip_kind)kind, &report->options,
                                                      &report->flip[kind], mapped ? &work->flip_map : NULL);
            report->has_flip[kind] = true;
        }
    }
    report->has_picture = assay_comparison_color(work->comparison, layer, &report->color);
    return status;
}

static bool ends_with(const char *path, const char *extension)
{
    const size_t length = strlen(path), end = strlen(extension);
    return length >= end && strcasecmp(path + length - end, extension) == 0;
}

static bool is_exr(const char *path) { return ends_with(path, ".exr"); }

static assay_status write_heat_map(diff_work *work)
{
    const char  *path = work->request->heat_map;
    const bool   exr  = is_exr(path);
    assay_image *map  = NULL;
    assay_status status =
        exr ? assay_image_relative_error(work->images[0], work->images[1], &map)
            : assay_image_heat_map(work->images[0], work->images[1], work->request->scale, &map);
    if (status == ASSAY_OK) {
        status = exr ? assay_image_write_exr(map, path) : assay_image_write_png(map, "", 0.0, path);
    }
    assay_image_destroy(map);
    return status;
}

static assay_status write_flip_map(diff_work *work)
{
    const char *path = work->request->flip_map;
    if (is_exr(path)) {
        return assay_image_write_exr(work->flip_map, path);
    }
    assay_image *picture = NULL;
    assay_status status  = assay_image_magma(work->flip_map, "FLIP", 0.0, 1.0, &picture);
    if (status == ASSAY_OK) {
        status = assay_image_write_png(picture, "", 0.0, path);
    }
    assay_image_destroy(picture);
    return status;
}

static assay_status compare(diff_work *work)
{
    assay_status status = read_images(work);
    if (status == ASSAY_OK) {
        status = explained(
            work, assay_image_compare(work->images[0], work->images[1], &work->comparison));
    }
    if (status == ASSAY_OK) {
        work->report.a          = work->images[0];
        work->report.b          = work->images[1];
        work->report.comparison = work->comparison;
        status                  = explained(work, measure_picture(work));
    }
    if (status == ASSAY_OK && work->request->heat_map) {
        status = write_heat_map(work);
    }
    if (status == ASSAY_OK && work->request->flip_map) {
        status = write_flip_map(work);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    cli_console_clear(work->console);
    if (!work->request->json) {
        diff_print_table(&work->report);
        return ASSAY_OK;
    }
    return diff_print_json(&work->report) ? ASSAY_OK : ASSAY_ERR_MEMORY;
}

/* ---- the request ---- */

static int check_map(const diff_request *r, const char *option, const char *path)
{
    int code = cli_check_not_input("diff", path, r->paths[0]);
    code     = code ? code : cli_check_not_input("diff", path, r->paths[1]);
    code     = code ? code : cli_check_file("diff", path);
    if (!code && !is_exr(path) && !ends_with(path, ".png") && !cli_is_device(path)) {
        cli_complain("diff", "%s %s: a map is .png or .exr; name it so", option, path);
        return CLI_EXIT_USAGE;
    }
    return code;
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
    if (r->has_hdr_option && !r->flip[ASSAY_FLIP_HDR]) {
        return "--tone-mapper and exposures of HDR-FLIP without HDR-FLIP do nothing";
    }
    if (r->flip_map && !r->flip[ASSAY_FLIP_LDR] && !r->flip[ASSAY_FLIP_HDR]) {
        return "--flip-map without FLIP has nothing to draw";
    }
    if (r->flip_map && r->heat_map && strcmp(r->flip_map, r->heat_map) == 0) {
        return "--flip-map and --heat-map are the same file";
    }
    if (r->has_scale && !r->heat_map) {
        return "--scale without --heat-map does nothing";
    }
    return r->has_scale && is_exr(r->heat_map) ? "--scale does nothing to numbers" : NULL;
}

static int run(const diff_request *request)
{
    cli_console    console;
    assay_context *context = cli_console_open(&console, "diff", false, 0, request->memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    diff_work work       = {.console = &console, .context = context, .request = request};
    work.report.options  = request->metrics;
    const int  code      = cli_console_finish(&console, context, compare(&work));
    const bool identical = code == 0 && assay_comparison_identical(work.comparison);
    assay_comparison_destroy(work.comparison);
    assay_image_destroy(work.flip_map);
    assay_image_destroy(work.images[0]);
    assay_image_destroy(work.images[1]);
    assay_context_destroy(context);
    return code != 0 ? code : identical ? 0 : CLI_EXIT_DIFFERENT;
}

int cli_diff(int count, char **argv)
{
    diff_request request = {
        .scale = 0.1, .flip = {true, true}, .metrics = assay_metrics_defaults()};
    if (!cli_parse("diff", count, argv, OPTIONS, take, NULL, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        printf("usage: assay diff A.exr B.exr [--flip-map F] [--heat-map F] [--json] ...\n"
               "A is the reference. Exit code 0: every bit the same; 1: they differ.\n");
        cli_print_options(OPTIONS);
        return 0;
    }
    const char *problem = check_together(&request);
    if (problem) {
        cli_complain("diff", "%s (assay diff --help lists the options)", problem);
        return CLI_EXIT_USAGE;
    }
    int check = request.heat_map ? check_map(&request, "--heat-map", request.heat_map) : 0;
    if (!check && request.flip_map) {
        check = check_map(&request, "--flip-map", request.flip_map);
    }
    return check ? check : run(&request);
}
