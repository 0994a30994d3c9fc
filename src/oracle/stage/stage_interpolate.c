/* stage_interpolate.c - stage `interpolate`: what a given cache says at given points.
 *
 * Where no record contributes, the sum of weights and the irradiance are 0: what a method does
 * there (the nearest record, black) is its own affair. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "oracle/stage/record_parts.h"
#include "oracle/stage/stage_list.h"

enum { QUERY_POSITION = RECORDS_INPUTS, QUERY_NORMAL, CHUNK = 64 };
enum { OUT_IRRADIANCE, OUT_WEIGHT, OUT_COUNT };

/* clang-format off */
static const assay_param_desc PARAMS[] = {STAGE_RULE_PARAMS, STAGE_SAID_PARAMS, {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RECORD_ARRAYS,
    STAGE_QUERY_ARRAYS,
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"query/irradiance", "W/m2", "R G B", "point",
     "mean by weight of what the records say; 0 where none counts", false, false, false},
    {"query/weight_sum", "", "W", "point", "sum of their weights", false, false, false},
    {0}};
/* clang-format on */

/* A worker's own. */
typedef struct {
    assay_contributions found;
    assay_octree_walk  *walk;
    record_parts        parts;
} desk;

typedef struct {
    const stage_run     *run;
    const stage_records *records;
    assay_record_store  *store;
    const assay_vec3    *normals;
    stage_output        *out[OUT_COUNT];
    desk                *desks;
} job_data;

/* ---- bounds ---- */

static assay_status bound_point(const job_data *job, desk *own, size_t i, assay_vec3 p,
                                assay_vec3 n)
{
    const rounding *r       = &job->run->rounding;
    tracked_sum     weights = {0};
    if (record_parts_collect(job->records, r, own->walk, UINT32_MAX, p, n, &weights, &own->parts) !=
        ASSAY_OK) {
        return ASSAY_ERR_MEMORY;
    }
    const size_t count              = own->parts.count;
    job->out[OUT_WEIGHT]->bounds[i] = tracked_sum_of(r, &weights).e;
    double surest                   = 0.0;
    for (size_t k = 0; k < count; k++) {
        surest += own->parts.items[k].low;
    }
    for (int c = 0; c < 3; c++) {
        const double value = job->out[OUT_IRRADIANCE]->values[3 * i + (size_t)c];
        double       bound = count ? mean_bound(r, own->parts.items, count, c, value) : 0.0;
        if (count && !(surest > 0.0)) {
            bound = fmax(bound, fabs(value)); /* there may be none that counts */
        }
        job->out[OUT_IRRADIANCE]->bounds[3 * i + (size_t)c] = bound;
    }
    return ASSAY_OK;
}

/* ---- values ---- */

static assay_status ask_point(const job_data *job, desk *own, size_t i)
{
    const assay_vec3 p = stage_vec3(job->run->in[QUERY_POSITION].values + 3 * i);
    const assay_vec3 n = job->normals[i];
    if (isnan(p.x)) {
        return ASSAY_OK;
    }
    const assay_status status = assay_record_store_find(job->store, p, n, UINT32_MAX, &own->found);
    if (status != ASSAY_OK) {
        return status;
    }
    if (own->found.count > 0) {
        const assay_rgb e = assay_record_store_interpolate(job->store, &own->found, p, n);
        memcpy(job->out[OUT_IRRADIANCE]->values + 3 * i, &e, sizeof e);
        job->out[OUT_WEIGHT]->values[i] = own->found.weight;
    }
    return job->run->bounded ? bound_point(job, own, i, p, n) : ASSAY_OK;
}

static assay_status ask_points(void *user, uint64_t chunk, int worker)
{
    const job_data *job    = user;
    assay_status    status = ASSAY_OK;
    for (size_t i = chunk * CHUNK;
         i < (chunk + 1) * CHUNK && i < job->out[OUT_WEIGHT]->rows && !status; i++) {
        status = ask_point(job, &job->desks[worker], i);
    }
    return status;
}

static assay_status make_room(stage_run *run, job_data *job)
{
    const size_t points  = run->in[QUERY_POSITION].rows;
    const size_t threads = (size_t)assay_context_threads(run->context);
    job->desks           = assay_allocate(run->context, threads, sizeof *job->desks);
    if (!job->desks) {
        return assay_fail_memory(run->context, "a cache's users");
    }
    for (size_t i = 0; i < threads; i++) {
        job->desks[i].walk = assay_allocate(run->context, 1, sizeof *job->desks[i].walk);
        if (!job->desks[i].walk) {
            return assay_fail_memory(run->context, "a cache's users");
        }
    }
    const assay_status status =
        stage_output_make(run, OUT_IRRADIANCE, 0, points, 3, &job->out[OUT_IRRADIANCE]);
    return status ? status
                  : stage_output_make(run, OUT_WEIGHT, 0, points, 1, &job->out[OUT_WEIGHT]);
}

static void close_job(const stage_run *run, job_data *job, assay_vec3 *normals)
{
    const int threads = job->desks ? assay_context_threads(run->context) : 0;
    for (int i = 0; i < threads; i++) {
        assay_contributions_release(&job->desks[i].found);
        assay_release(run->context, job->desks[i].walk);
        record_parts_release(run->context, &job->desks[i].parts);
    }
    assay_release(run->context, job->desks);
    assay_record_store_destroy(job->store);
    assay_release(run->context, normals);
}

static assay_status ask_all(stage_run *run, stage_records *records)
{
    const size_t points  = run->in[QUERY_POSITION].rows;
    assay_vec3  *normals = NULL;
    job_data     job     = {.run = run, .records = records};
    assay_status status  = stage_query_points(run, QUERY_POSITION, QUERY_NORMAL, 0, &normals);
    status               = status ? status : stage_records_store(records, &job.store);
    status               = status ? status : make_room(run, &job);
    if (status == ASSAY_OK && run->bounded) {
        status = stage_records_index(records, &run->rounding, points,
                                     run->in[QUERY_POSITION].values, 0.0);
    }
    job.normals = normals;
    status      = status ? status
                         : assay_parallel_for(run->context, NULL, (points + CHUNK - 1) / CHUNK,
                                              ask_points, &job);
    close_job(run, &job, normals);
    return status;
}

static assay_status run_interpolate(stage_run *run)
{
    stage_records records = {0};
    assay_status  status  = stage_records_open(run, true, &records);
    status                = status ? status : ask_all(run, &records);
    stage_records_close(&records);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(run->context, "a look into a cache")
                                      : status;
}

const oracle_stage stage_interpolate = {
    .info = {.name    = "interpolate",
             .summary = "what a given cache of irradiance says at given points",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_interpolate};
