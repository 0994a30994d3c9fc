/* cmd_render.c - `assay render`: a scene in, images or probes out. */
#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "console.h"
#include "output_check.h"
#include "render_request.h"

typedef struct {
    const cli_render_request *request;
    cli_console              *console;
    assay_context            *context;
    assay_scene              *scene;
    assay_params             *params;
    assay_sequence           *sequence; /* of images, not of probes */
    assay_render_stats        stats;
    double                    seconds_load, seconds_write;
} render_job;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static assay_status make_params(render_job *job)
{
    const cli_render_request *r      = job->request;
    assay_status              status = assay_method_params(job->context, r->method, &job->params);
    for (int i = 0; i < r->param_count && status == ASSAY_OK; i++) {
        status = assay_params_set(job->params, r->params[i].name, r->params[i].value);
    }
    return status;
}

/* ---- statistics ---- */

static bool add_rays(cJSON *root, const assay_render_stats *s)
{
    cJSON *rays = cJSON_AddObjectToObject(root, "rays");
    return rays && cJSON_AddNumberToObject(rays, "camera", (double)s->camera_rays) &&
           cJSON_AddNumberToObject(rays, "scatter", (double)s->scatter_rays) &&
           cJSON_AddNumberToObject(rays, "shadow", (double)s->shadow_rays) &&
           cJSON_AddNumberToObject(rays, "total",
                                   (double)(s->camera_rays + s->scatter_rays + s->shadow_rays));
}

static bool add_seconds(cJSON *root, const render_job *job)
{
    cJSON *seconds = cJSON_AddObjectToObject(root, "seconds");
    return seconds && cJSON_AddNumberToObject(seconds, "load", job->seconds_load) &&
           cJSON_AddNumberToObject(seconds, "build", job->stats.seconds_build) &&
           cJSON_AddNumberToObject(seconds, "render", job->stats.seconds_render) &&
           cJSON_AddNumberToObject(seconds, "write", job->seconds_write);
}

static bool add_memory(cJSON *root, const assay_render_stats *s)
{
    cJSON *memory = cJSON_AddObjectToObject(root, "memory_bytes");
    return memory && cJSON_AddNumberToObject(memory, "peak", (double)s->peak_memory) &&
           cJSON_AddNumberToObject(memory, "bvh", (double)s->bvh_bytes) &&
           cJSON_AddNumberToObject(memory, "geometry", (double)s->geometry_bytes) &&
           cJSON_AddNumberToObject(memory, "textures", (double)s->texture_bytes);
}

static bool add_params(cJSON *root, const render_job *job)
{
    cJSON *params = cJSON_AddObjectToObject(root, "params");
    bool   ok     = params != NULL;
    for (const assay_param_desc *p = assay_params_table(job->params); ok && p->name; p++) {
        ok = cJSON_AddStringToObject(params, p->name, assay_params_text(job->params, p->name));
    }
    return ok;
}

/* null stands for what is not known, or was not asked for. */
static bool add_error(cJSON *root, const assay_render_stats *s)
{
    const bool known  = s->relative_error == s->relative_error;
    const bool target = s->target != ASSAY_TARGET_NONE;
    return (known ? cJSON_AddNumberToObject(root, "relative_error", s->relative_error)
                  : cJSON_AddNullToObject(root, "relative_error")) &&
           (target
                ? cJSON_AddBoolToObject(root, "target_reached", s->target == ASSAY_TARGET_REACHED)
                : cJSON_AddNullToObject(root, "target_reached"));
}

static assay_status write_stats(render_job *job, const char *path)
{
    const assay_render_stats *s    = &job->stats;
    cJSON                    *root = cJSON_CreateObject();
    const bool                ok =
        root && cJSON_AddStringToObject(root, "version", assay_version()) &&
        cJSON_AddStringToObject(root, "method", job->request->method) && add_params(root, job) &&
        cJSON_AddStringToObject(root, "scene_digest", assay_scene_digest(job->scene)) &&
        add_rays(root, s) && cJSON_AddNumberToObject(root, "samples", (double)s->samples) &&
        cJSON_AddNumberToObject(root, "records", (double)s->records) &&
        cJSON_AddNumberToObject(root, "lost_contributions", (double)s->lost) &&
        cJSON_AddNumberToObject(root, "spp_min", (double)s->spp_min) &&
        cJSON_AddNumberToObject(root, "spp_max", (double)s->spp_max) && add_error(root, s) &&
        add_seconds(root, job) && add_memory(root, s) &&
        cJSON_AddNumberToObject(root, "threads", s->threads);
    char        *text = ok ? cJSON_Print(root) : NULL;
    assay_status status =
        text ? cli_write_text(job->console, job->context, path, text) : ASSAY_ERR_MEMORY;
    cJSON_free(text);
    cJSON_Delete(root);
    return status;
}

/* ---- images and probes ---- */

/* Files of one frame; empty where not asked for. */
enum { PATH_SIZE = 4096 };
typedef struct {
    char output[PATH_SIZE], png[PATH_SIZE], stats[PATH_SIZE], dump[PATH_SIZE];
} frame_files;

static assay_status render_image(render_job *job, bool last, const frame_files *files)
{
    const cli_render_request *r       = job->request;
    assay_render_options      options = r->render;
    assay_image              *image   = NULL;
    options.dump                      = files->dump[0] ? files->dump : NULL;
    assay_status status = assay_sequence_render(job->sequence, &options, last, &image, &job->stats);
    const double start  = now();
    if (status == ASSAY_OK) {
        status = assay_image_write_exr(image, files->output);
    }
    if (status == ASSAY_OK && files->png[0]) {
        status = assay_image_write_png(image, "", r->exposure, files->png);
    }
    job->seconds_write = now() - start;
    assay_image_destroy(image);
    return status;
}

static assay_status render_points(render_job *job, const char *output)
{
    const cli_render_request *r      = job->request;
    assay_array              *points = NULL, *result = NULL;
    assay_status              status = assay_array_read_npy(job->context, r->points, &points);
    if (status == ASSAY_OK) {
        status = assay_render_probes(job->scene, r->method, job->params, r->render.seed, points,
                                     &result, &job->stats);
    }
    const double start = now();
    if (status == ASSAY_OK) {
        status = assay_array_write_npy(result, output);
    }
    job->seconds_write = now() - start;
    assay_array_destroy(points);
    assay_array_destroy(result);
    return status;
}

static void say_done(const render_job *job, const char *output)
{
    const assay_render_stats *s    = &job->stats;
    const double              rays = (double)(s->camera_rays + s->scatter_rays + s->shadow_rays);
    if (job->request->quiet || !job->console->terminal) {
        return;
    }
    cli_console_clear(job->console);
    fprintf(stderr, "%s: %.3g million rays in %.2f s on %d threads", output, rays * 1e-6,
            s->seconds_render, s->threads);
    if (s->records) {
        fprintf(stderr, ", %llu records", (unsigned long long)s->records);
    }
    if (s->samples && s->relative_error == s->relative_error) {
        fprintf(stderr, ", mean relative error %.2g", s->relative_error);
    }
    fputc('\n', stderr);
}

static bool name_file(const cli_render_request *request, const char *pattern, long frame,
                      char out[PATH_SIZE])
{
    out[0] = '\0';
    return !pattern || cli_frame_name(request, pattern, frame, out, PATH_SIZE);
}

static bool name_files(const cli_render_request *r, long frame, frame_files *files)
{
    return name_file(r, r->output, frame, files->output) &&
           name_file(r, r->png, frame, files->png) && name_file(r, r->stats, frame, files->stats) &&
           name_file(r, r->dump, frame, files->dump);
}

static assay_status render_frame(render_job *job, long frame)
{
    const cli_render_request *r = job->request;
    frame_files               files;
    if (!name_files(r, frame, &files)) {
        job->console->said = true;
        cli_complain("render", "frame %ld: the name of an output is too long", frame);
        return ASSAY_ERR_ARGUMENT;
    }
    const double time   = r->has_frames ? (double)frame / r->fps : r->time;
    assay_status status = assay_scene_set_time(job->scene, time);
    if (status == ASSAY_OK) {
        status = r->points ? render_points(job, files.output)
                           : render_image(job, frame == r->last_frame, &files);
    }
    if (status == ASSAY_OK && r->stats) {
        status = write_stats(job, files.stats);
    }
    if (status == ASSAY_OK) {
        say_done(job, files.output);
    }
    return status;
}

static assay_status render_all(render_job *job)
{
    const cli_render_request *r      = job->request;
    const double              start  = now();
    assay_status              status = make_params(job);
    if (status == ASSAY_OK) {
        status = assay_scene_load(job->context, r->scene, &r->scene_options.options, &job->scene);
    }
    job->seconds_load = now() - start;
    if (status == ASSAY_OK && !r->points) {
        status = assay_sequence_create(job->scene, r->method, job->params, &job->sequence);
    }
    for (long f = r->first_frame; f <= r->last_frame && status == ASSAY_OK; f++) {
        status = render_frame(job, f);
    }
    return status;
}

/* Asked of the first frame: what holds for it mostly holds for all. */
static int check_outputs(const cli_render_request *r)
{
    frame_files files;
    int         code = 0;
    if (!name_files(r, r->first_frame, &files)) {
        cli_complain("render", "the name of an output is too long");
        return CLI_EXIT_USAGE;
    }
    const struct {
        const char *option, *asked, *path, *extension;
    } outputs[] = {{"--output", r->output, files.output, r->points ? ".npy" : ".exr"},
                   {"--png", r->png, files.png, ".png"},
                   {"--stats", r->stats, files.stats, ".json"}};
    for (int i = 0; i < 3 && code == 0; i++) {
        const char *path = outputs[i].path;
        if (!outputs[i].asked || strcmp(path, "-") == 0) {
            continue;
        }
        code = cli_check_not_input("render", path, r->scene);
        code = code || !r->points ? code : cli_check_not_input("render", path, r->points);
        code = code ? code
                    : cli_check_extension("render", outputs[i].option, path, outputs[i].extension);
        code = code ? code : cli_check_file("render", path);
    }
    return code || !r->dump ? code : cli_check_new_folder("render", files.dump);
}

int cli_render(int count, char **argv)
{
    cli_render_request request;
    cli_console        console;
    if (!cli_render_request_parse(count, argv, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        cli_render_request_help(&request);
        return 0;
    }
    int code = check_outputs(&request);
    if (code != 0) {
        return code;
    }
    assay_context *context = cli_console_open(&console, "render", request.quiet,
                                              (int)request.threads, request.memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    render_job job = {.request = &request, .console = &console, .context = context};
    code           = cli_console_finish(&console, context, render_all(&job));
    assay_sequence_destroy(job.sequence);
    assay_params_destroy(job.params);
    assay_scene_destroy(job.scene);
    assay_context_destroy(context);
    return code;
}
