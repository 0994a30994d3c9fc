/* stage_splat_glossy.c - stage `splat-glossy`: sums of the weights of given radiance records on a
 * given G-buffer, batch after batch.
 *
 * What they weigh is stage `splat-glossy-light`'s affair: it takes these sums as the candidate has
 * them. */
#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "oracle/stage/splat_batches.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_radiance.h"

enum { SPLAT_POSITION = RECORDS_SITE_INPUTS, SPLAT_FRAME, SPLAT_ENDS };

/* clang-format off */
static const assay_param_desc PARAMS[] = {STAGE_RULE_PARAMS, STAGE_BATCH_PARAMS, {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RADIANCE_SITE_ARRAYS,
    {"splat_glossy/position", "m", "X Y Z", "pixel", "its point; NaN where it is not glossy",
     false, true, false},
    {"splat_glossy/frame", "", "Xx Xy Xz Yx Yy Yz Zx Zy Zz", "pixel",
     "frame whose z is the normal on the viewer's side", false, true, false},
    {"splat_glossy/batch_end", "records", "K", "batch",
     "how many records it has; without it one batch has all", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"splat_glossy/batch.#/weight", "", "W", "pixel", "sum of weights", false, false, false}, {0}};
/* clang-format on */

typedef struct {
    stage_output *weight;
} batch_sums;

typedef struct {
    stage_run         *run;
    stage_records      records;
    splat_batch       *batches;
    size_t             batch_count;
    batch_sums        *out;   /* a batch  */
    record_parts      *parts; /* a worker */
    assay_octree_walk *walks; /* a worker */
} weights_job;

/* Records [0, end) once. */
static double sum_below(const stage_records *records, const stage_candidates *near, uint32_t end,
                        assay_vec3 p, assay_vec3 n)
{
    double sum = 0.0;
    for (size_t i = 0; i < near->count && near->items[i] < end; i++) {
        sum += assay_record_weight(&records->records[near->items[i]], &records->rules, p, n);
    }
    return sum;
}

static assay_status weigh_batch(const weights_job *job, size_t k, size_t pixel, int worker,
                                assay_vec3 p, assay_vec3 n)
{
    const splat_batch *b       = &job->batches[k];
    const rounding    *r       = &job->run->rounding;
    record_parts      *parts   = &job->parts[worker];
    stage_records      records = job->records;
    tracked_sum        sum     = {0};
    records.rules.a            = b->a;
    assay_status status =
        record_parts_collect(&records, r, &job->walks[worker], b->old, p, n, &sum, parts);
    status =
        status ? status
               : record_parts_collect(&records, r, &job->walks[worker], b->end, p, n, &sum, parts);
    if (status == ASSAY_OK) {
        job->out[k].weight->values[pixel] = sum_below(&records, &parts->near, b->old, p, n) +
                                            sum_below(&records, &parts->near, b->end, p, n);
        if (job->run->bounded) {
            job->out[k].weight->bounds[pixel] = tracked_sum_of(r, &sum).e;
        }
    }
    return status;
}

static assay_status weigh_pixel(void *user, uint64_t pixel, int worker)
{
    const weights_job *job    = user;
    const double      *at     = job->run->in[SPLAT_POSITION].values + 3 * pixel;
    const assay_vec3   n      = stage_vec3(job->run->in[SPLAT_FRAME].values + 9 * pixel + 6);
    assay_status       status = ASSAY_OK;
    for (size_t k = 0; k < job->batch_count && !isnan(at[0]) && status == ASSAY_OK; k++) {
        status = weigh_batch(job, k, (size_t)pixel, worker, stage_vec3(at), n);
    }
    return status;
}

static assay_status open_job(stage_run *run, weights_job *job)
{
    const size_t threads = (size_t)assay_context_threads(run->context);
    const size_t pixels  = run->in[SPLAT_POSITION].rows;
    assay_status status =
        splat_batches_read(run, SPLAT_ENDS, job->records.count, &job->batches, &job->batch_count);
    if (status != ASSAY_OK) {
        return status;
    }
    job->out   = assay_allocate(run->context, job->batch_count, sizeof *job->out);
    job->parts = assay_allocate(run->context, threads, sizeof *job->parts);
    job->walks = assay_allocate(run->context, threads, sizeof *job->walks);
    if (!job->out || !job->parts || !job->walks) {
        return assay_fail_memory(run->context, "pixels");
    }
    double widest = 0.0;
    for (size_t k = 0; k < job->batch_count && status == ASSAY_OK; k++) {
        widest = fmax(widest, job->batches[k].a);
        status = stage_output_make(run, 0, job->batches[k].number, pixels, 1, &job->out[k].weight);
    }
    return status ? status
                  : stage_records_index(&job->records, &run->rounding, pixels,
                                        run->in[SPLAT_POSITION].values, widest);
}

static void close_job(const stage_run *run, weights_job *job)
{
    for (int i = 0; job->parts && i < assay_context_threads(run->context); i++) {
        record_parts_release(run->context, &job->parts[i]);
    }
    assay_release(run->context, job->parts);
    assay_release(run->context, job->walks);
    assay_release(run->context, job->out);
    assay_release(run->context, job->batches);
    stage_records_close(&job->records);
}

static assay_status run_splat_glossy(stage_run *run)
{
    weights_job  job     = {.run = run};
    assay_vec3  *normals = NULL;
    assay_status status  = stage_pixel_normals(run, SPLAT_POSITION, SPLAT_FRAME, &normals);
    assay_release(run->context, normals);
    status = status ? status : stage_records_open(run, false, &job.records);
    status = status ? status : open_job(run, &job);
    status = status ? status
                    : assay_parallel_for(run->context, NULL, run->in[SPLAT_POSITION].rows,
                                         weigh_pixel, &job);
    close_job(run, &job);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(run->context, "splatting") : status;
}

const oracle_stage stage_splat_glossy = {
    .info = {.name    = "splat-glossy",
             .summary = "weights of given radiance records splatted on a given G-buffer",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_splat_glossy};
