/* stage_splat_light.c - stage `splat-light`: the weighted radiance of the last batch, given its
 * sums of weights: weight times the mean of what the records say.
 *
 * Why: where a record stands in a pixel its weight is anything between 1 / sqrt(u) and 1e12, and so
 * are both sums of stage `splat`; but not their quotient.  Given the candidate's own weight, its
 * radiance is known as well as that. */
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "methods/cached_image.h"
#include "oracle/stage/record_parts.h"
#include "oracle/stage/splat_batches.h"
#include "oracle/stage/stage_list.h"

enum {
    SPLAT_POSITION = RECORDS_INPUTS,
    SPLAT_FRAME,
    SPLAT_ALBEDO,
    SPLAT_WEIGHT,
    SPLAT_ENDS,
    CHUNK = 64
};

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    STAGE_RULE_PARAMS, STAGE_SAID_PARAMS,
    {"splat_a", ASSAY_PARAM_REAL, "", "0", 0, 1e3, NULL,
     "Accuracy of the last batch; 0: a.", "[gautron06] fig. 4.12"},
    STAGE_LAST_BATCH_PARAMS,
    {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RECORD_ARRAYS,
    STAGE_PIXEL_ARRAYS,
    {"splat/batch.#/weight", "", "W", "pixel", "sum of weights, of the last batch",
     false, false, false},
    {"splat/batch_end", "records", "K", "batch",
     "how many records it has; without it one batch has all", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"splat/batch.#/radiance", "W/(m2 sr)", "R G B", "pixel",
     "of the last batch: weight times the mean outgoing radiance", false, false, false},
    {0}};
/* clang-format on */

/* A worker's own. */
typedef struct {
    assay_contributions found;
    record_parts        parts;
} desk;

typedef struct {
    stage_run          *run;
    stage_records      *records;
    assay_record_store *store;
    uint32_t            end;
    stage_output       *out;
    desk               *desks;
    assay_octree_walk  *walks;
} light_job;

/* weight, mean, albedo and 1 / pi multiplied in any order. */
static assay_status bound_pixel(const light_job *job, int worker, size_t pixel, assay_vec3 p,
                                assay_vec3 n, const double mean[3])
{
    const rounding    *r     = &job->run->rounding;
    record_parts      *parts = &job->desks[worker].parts;
    const assay_status status =
        record_parts_collect(job->records, r, &job->walks[worker], job->end, p, n, NULL, parts);
    for (size_t c = 0; c < 3 && status == ASSAY_OK; c++) {
        const double bound =
            parts->count ? mean_bound(r, parts->items, parts->count, (int)c, mean[c]) : 0.0;
        const tracked weight = tracked_given(r, job->run->in[SPLAT_WEIGHT].values[pixel]);
        const tracked albedo = tracked_given(r, job->run->in[SPLAT_ALBEDO].values[3 * pixel + c]);
        const tracked share  = tracked_mul(r, albedo, tracked_constant(r, ASSAY_INV_PI));
        job->out->bounds[3 * pixel + c] =
            tracked_mul(r, tracked_mul(r, weight, (tracked){mean[c], bound}), share).e;
    }
    return status;
}

static assay_status light_pixel(const light_job *job, int worker, size_t pixel)
{
    const stage_run *run     = job->run;
    const double    *at      = run->in[SPLAT_POSITION].values + 3 * pixel;
    const double    *albedo  = run->in[SPLAT_ALBEDO].values + 3 * pixel;
    const assay_vec3 n       = stage_vec3(run->in[SPLAT_FRAME].values + 9 * pixel + 6);
    desk            *own     = &job->desks[worker];
    double           mean[3] = {0.0, 0.0, 0.0};
    if (isnan(at[0])) {
        return ASSAY_OK;
    }
    const assay_vec3   p      = stage_vec3(at);
    const assay_status status = assay_record_store_find(job->store, p, n, job->end, &own->found);
    if (status != ASSAY_OK) {
        return status;
    }
    if (own->found.count > 0) {
        const assay_rgb e = assay_record_store_interpolate(job->store, &own->found, p, n);
        const assay_rgb sum =
            assay_cached_point_sum(rgb(albedo[0], albedo[1], albedo[2]),
                                   rgb_scale(e, run->in[SPLAT_WEIGHT].values[pixel]), NULL, false);
        memcpy(mean, &e, sizeof mean);
        memcpy(job->out->values + 3 * pixel, &sum, sizeof sum);
    }
    return run->bounded ? bound_pixel(job, worker, pixel, p, n, mean) : ASSAY_OK;
}

static assay_status light_pixels(void *user, uint64_t chunk, int worker)
{
    const light_job *job    = user;
    assay_status     status = ASSAY_OK;
    for (size_t i = chunk * CHUNK;
         i < (chunk + 1) * CHUNK && i < job->run->in[SPLAT_POSITION].rows && !status; i++) {
        status = light_pixel(job, worker, i);
    }
    return status;
}

/* ---- all of it ---- */

static assay_status check(light_job *job)
{
    stage_run   *run    = job->run;
    const size_t pixels = run->in[SPLAT_POSITION].rows;
    for (int i = SPLAT_FRAME; i <= SPLAT_WEIGHT; i++) {
        if (run->in[i].rows != pixels) {
            return stage_fail_rows(run, i, pixels, "one a pixel, as of splat/position");
        }
    }
    if (assay_params_real(run->params, "splat_a") > 0.0) {
        job->records->rules.a = assay_params_real(run->params, "splat_a");
    }
    return splat_batches_last_end(run, SPLAT_ENDS, job->records->count, &job->end);
}

static assay_status open_job(light_job *job)
{
    stage_run   *run     = job->run;
    const size_t threads = (size_t)assay_context_threads(run->context);
    const char  *number  = strstr(run->in[SPLAT_WEIGHT].name, "batch.");
    job->desks           = assay_allocate(run->context, threads, sizeof *job->desks);
    job->walks           = assay_allocate(run->context, threads, sizeof *job->walks);
    if (!job->desks || !job->walks) {
        return assay_fail_memory(run->context, "pixels");
    }
    assay_status status = stage_records_store(job->records, &job->store);
    status              = status ? status
                                 : stage_output_make(run, 0, number ? atoi(number + 6) : 0,
                                                     run->in[SPLAT_POSITION].rows, 3, &job->out);
    return status || !run->bounded
               ? status
               : stage_records_index(job->records, &run->rounding, run->in[SPLAT_POSITION].rows,
                                     run->in[SPLAT_POSITION].values, 0.0);
}

static void close_job(light_job *job)
{
    assay_context *context = job->run->context;
    for (int i = 0; job->desks && i < assay_context_threads(context); i++) {
        assay_contributions_release(&job->desks[i].found);
        record_parts_release(context, &job->desks[i].parts);
    }
    assay_release(context, job->desks);
    assay_release(context, job->walks);
    assay_record_store_destroy(job->store);
}

static assay_status run_splat_light(stage_run *run)
{
    const size_t  pixels  = run->in[SPLAT_POSITION].rows;
    stage_records records = {0};
    light_job     job     = {.run = run, .records = &records};
    if (assay_params_choice(run->params, "variant") == 1) {
        return ASSAY_OK;
    }
    assay_status status = stage_records_open(run, true, &records);
    status              = status ? status : check(&job);
    if (status == ASSAY_OK && !splat_batches_are_stale(run, SPLAT_ENDS, records.count)) {
        status = open_job(&job);
        status = status ? status
                        : assay_parallel_for(run->context, NULL, (pixels + CHUNK - 1) / CHUNK,
                                             light_pixels, &job);
    }
    close_job(&job);
    stage_records_close(&records);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(run->context, "splatting") : status;
}

const oracle_stage stage_splat_light = {
    .info = {.name    = "splat-light",
             .summary = "weighted radiance of the last batch, given its weights",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_splat_light};
