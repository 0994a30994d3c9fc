/* stage_weights.c - stage `weights`: of given records at given points, every pair or the pairs that
 * are listed. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_records.h"

enum { QUERY_POSITION = RECORDS_SITE_INPUTS, QUERY_NORMAL, QUERY_RECORD, CHUNK = 64 };

/* clang-format off */
static const assay_param_desc PARAMS[] = {STAGE_RULE_PARAMS, {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RECORD_SITE_ARRAYS,
    STAGE_QUERY_ARRAYS,
    {"query/record", "records", "K", "point",
     "number of the record that is asked, from 0; without it all of them are", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"query/weight", "", NULL, "point",
     "a column a record, or one: weights; 0 where it does not count", false, false, false},
    {0}};
/* clang-format on */

typedef struct {
    const stage_run     *run;
    const stage_records *records;
    const assay_vec3    *normals;
    stage_output        *out;
} weights_job;

static void weigh(const weights_job *job, size_t point, size_t record, size_t at)
{
    const stage_records *records  = job->records;
    const assay_record  *one      = &records->records[record];
    const assay_vec3     position = stage_vec3(job->run->in[QUERY_POSITION].values + 3 * point);
    const assay_vec3     normal   = job->normals[point];
    if (isnan(position.x)) {
        return;
    }
    const double weight  = assay_record_weight(one, &records->rules, position, normal);
    job->out->values[at] = weight;
    if (job->out->bounds) {
        const weight_bound w    = record_weight_bound(&job->run->rounding, records->exact, one,
                                                      &records->rules, position, normal);
        const double       high = w.member == BOUND_OUT ? 0.0 : w.high;
        const double       low  = w.member == BOUND_IN ? w.low : 0.0;
        job->out->bounds[at]    = fmax(high - weight, weight - low);
    }
}

static assay_status weigh_points(void *user, uint64_t chunk, int worker)
{
    const weights_job *job  = user;
    const stage_table *pair = &job->run->in[QUERY_RECORD];
    (void)worker;
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < job->out->rows; i++) {
        if (pair->values) {
            weigh(job, i, (size_t)pair->values[i], i);
            continue;
        }
        for (size_t k = 0; k < job->records->count; k++) {
            weigh(job, i, k, i * job->records->count + k);
        }
    }
    return ASSAY_OK;
}

static assay_status check_pairs(const stage_run *run, size_t count)
{
    const stage_table *pair = &run->in[QUERY_RECORD];
    for (size_t i = 0; pair->values && i < pair->rows; i++) {
        const double k = pair->values[i];
        if (!(k >= 0.0 && k < (double)count && k == assay_floor(k))) {
            return stage_fail_value(run, QUERY_RECORD, i, 0, "not the number of a record");
        }
    }
    return ASSAY_OK;
}

static assay_status weigh_all(stage_run *run, stage_records *records)
{
    const size_t points  = run->in[QUERY_POSITION].rows;
    assay_vec3  *normals = NULL;
    weights_job  job     = {.run = run, .records = records};
    if (run->in[QUERY_RECORD].values && run->in[QUERY_RECORD].rows != points) {
        return stage_fail_rows(run, QUERY_RECORD, points, "one a point, as of query/position");
    }
    assay_status status = check_pairs(run, records->count);
    status = status ? status : stage_query_points(run, QUERY_POSITION, QUERY_NORMAL, 0, &normals);
    records->exact       = run->rounding.given <= run->rounding.u;
    const size_t columns = run->in[QUERY_RECORD].values || records->count == 0 ? 1 : records->count;
    status      = status ? status : stage_output_make(run, 0, 0, points, columns, &job.out);
    job.normals = normals;
    status      = status ? status
                         : assay_parallel_for(run->context, NULL, (points + CHUNK - 1) / CHUNK,
                                              weigh_points, &job);
    assay_release(run->context, normals);
    return status;
}

static assay_status run_weights(stage_run *run)
{
    stage_records records = {0};
    assay_status  status  = stage_records_open(run, false, &records);
    status                = status ? status : weigh_all(run, &records);
    stage_records_close(&records);
    return status;
}

const oracle_stage stage_weights = {.info = {.name    = "weights",
                                             .summary = "weights of given records at given points",
                                             .params  = PARAMS,
                                             .inputs  = INPUTS,
                                             .outputs = OUTPUTS},
                                    .run  = run_weights};
