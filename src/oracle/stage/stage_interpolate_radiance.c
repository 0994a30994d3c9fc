/* stage_interpolate_radiance.c - stage `interpolate-radiance`: the radiance that a given cache says
 * arrives at given points, as coefficients in given frames.
 *
 * The mean is taken, and bounded coefficient by coefficient, in frame3_from_z of the normal; from
 * there to the frame that is asked it is turned about z, which pairs of errors go through. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_radiance.h"

enum { QUERY_POSITION = RADIANCE_INPUTS, QUERY_FRAME };
enum { OUT_COEFFICIENTS, OUT_WEIGHT, OUT_COUNT };
enum { CHANNELS = 3 };

/* clang-format off */
static const assay_param_desc PARAMS[] = {STAGE_RULE_PARAMS, STAGE_RADIANCE_PARAMS, {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RADIANCE_ARRAYS,
    {"radiance_query/position", "m", "X Y Z", "point", "where it is asked; NaN where nothing is",
     false, true, false},
    {"radiance_query/frame", "", "Xx Xy Xz Yx Yy Yz Zx Zy Zz", "point",
     "in which it is asked; z is the normal; NaN likewise", false, true, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"radiance_query/coefficients", "W/(m2 sr)", NULL, "point",
     "of R, of G, of B: mean by weight of what the records say; 0 where none counts",
     false, false, false},
    {"radiance_query/weight_sum", "", "W", "point", "sum of their weights", false, false, false},
    {0}};
/* clang-format on */

/* A worker's own. */
typedef struct {
    assay_contributions found;
    double             *scratch;       /* two rows, for means                       */
    double             *mean;          /* a row, in frame3_from_z of the normal     */
    double             *said, *errors; /* of each part: a row; a row of pairs      */
    size_t              said_room, error_room;
    double             *sizes, *off; /* rows of pairs */
} desk;

typedef struct {
    const stage_run *run;
    stage_radiance   radiance;
    assay_vec3      *normals;
    assay_frame3    *frames;
    stage_output    *out[OUT_COUNT];
    desk            *desks;
} job_data;

/* ---- bounds ---- */

/* What each part says, one after the other. */
static assay_status hear_parts(const job_data *job, int worker, size_t i)
{
    const stage_radiance *radiance = &job->radiance;
    const record_parts   *parts    = &radiance->parts[worker];
    radiance_desk        *hearing  = &radiance->desks[worker];
    desk                 *own      = &job->desks[worker];
    const size_t row = radiance->rows.count, pairs = CHANNELS * turn_bound_pairs(radiance->bound);
    void        *said = own->said, *errors = own->errors;
    assay_status status = assay_grow(job->run->context, &said, &own->said_room,
                                     (parts->count + 1) * row, sizeof(double));
    own->said           = said;
    status              = status ? status
                                 : assay_grow(job->run->context, &errors, &own->error_room,
                                              (parts->count + 1) * pairs, sizeof(double));
    own->errors         = errors;
    for (size_t k = 0; k < parts->count && status == ASSAY_OK; k++) {
        const uint32_t number = parts->numbers[k];
        status = radiance_said_bound(radiance->bound, &job->run->rounding, radiance->records.exact,
                                     &radiance->rows, &radiance->turned[number], number,
                                     stage_vec3(job->run->in[QUERY_POSITION].values + 3 * i),
                                     job->frames[i].z, worker, hearing);
        memcpy(own->said + k * row, hearing->said, row * sizeof(double));
        memcpy(own->errors + k * pairs, hearing->errors, pairs * sizeof(double));
    }
    return status;
}

/* Errors of the mean's pairs. */
static void bound_mean(const job_data *job, int worker, bool sure)
{
    const stage_radiance *radiance = &job->radiance;
    const rounding       *r        = &job->run->rounding;
    const size_t          row = radiance->rows.count, count = row / CHANNELS;
    const size_t          pairs = turn_bound_pairs(radiance->bound);
    record_parts         *parts = &radiance->parts[worker];
    desk                 *own   = &job->desks[worker];
    memset(own->off, 0, CHANNELS * pairs * sizeof *own->off);
    for (size_t i = 0; i < count && parts->count > 0; i++) {
        const size_t pair = turn_bound_pair_of(radiance->bound, i);
        for (size_t k = 0; k < parts->count; k++) {
            for (size_t c = 0; c < CHANNELS; c++) {
                parts->items[k].said[c] = (tracked){own->said[k * row + c * count + i],
                                                    own->errors[(k * CHANNELS + c) * pairs + pair]};
            }
        }
        for (size_t c = 0; c < CHANNELS; c++) {
            const double value = own->mean[c * count + i];
            double       bound = mean_bound(r, parts->items, parts->count, (int)c, value);
            bound = sure ? bound : fmax(bound, fabs(value)); /* there may be none that counts */
            double *off = own->off + c * pairs + pair;
            *off        = sqrt(*off * *off + bound * bound);
        }
    }
}

static assay_status bound_coefficients(const job_data *job, int worker, size_t i)
{
    const stage_radiance *radiance = &job->radiance;
    const rounding       *r        = &job->run->rounding;
    const record_parts   *parts    = &radiance->parts[worker];
    desk                 *own      = &job->desks[worker];
    const size_t          row = radiance->rows.count, count = row / CHANNELS;
    const size_t          pairs  = turn_bound_pairs(radiance->bound);
    const tracked_frame   here   = tracked_frame_from_z(r, job->frames[i].z);
    const tracked_frame   asked  = tracked_frame_given(r, &job->frames[i]);
    double                surest = 0.0;
    const assay_status    status = hear_parts(job, worker, i);
    if (status != ASSAY_OK) {
        return status;
    }
    for (size_t k = 0; k < parts->count; k++) {
        surest += parts->items[k].low;
    }
    bound_mean(job, worker, surest > 0.0);
    for (size_t c = 0; c < CHANNELS; c++) {
        turn_bound_sizes(radiance->bound, own->mean + c * count, own->sizes + c * pairs);
    }
    turn_bound_spin(radiance->bound, r, &here, &asked, own->sizes, own->off);
    for (size_t k = 0; k < row; k++) {
        job->out[OUT_COEFFICIENTS]->bounds[i * row + k] =
            own->off[k / count * pairs + turn_bound_pair_of(radiance->bound, k % count)];
    }
    return ASSAY_OK;
}

static assay_status bound_point(const job_data *job, int worker, size_t i)
{
    const stage_radiance *radiance = &job->radiance;
    const rounding       *r        = &job->run->rounding;
    const assay_vec3      p        = stage_vec3(job->run->in[QUERY_POSITION].values + 3 * i);
    tracked_sum           weights  = {0};
    const assay_status    status =
        record_parts_collect(&radiance->records, r, &radiance->walks[worker], UINT32_MAX, p,
                             job->normals[i], &weights, &radiance->parts[worker]);
    if (status != ASSAY_OK) {
        return status;
    }
    job->out[OUT_WEIGHT]->bounds[i] = tracked_sum_of(r, &weights).e;
    return radiance->bound ? bound_coefficients(job, worker, i) : ASSAY_OK;
}

/* ---- values ---- */

static assay_status ask_point(void *user, uint64_t i, int worker)
{
    const job_data            *job  = user;
    const assay_radiance_rows *rows = &job->radiance.rows;
    const assay_vec3           p    = stage_vec3(job->run->in[QUERY_POSITION].values + 3 * i);
    desk                      *own  = &job->desks[worker];
    double                    *row  = job->out[OUT_COEFFICIENTS]->values + i * rows->count;
    if (isnan(p.x)) {
        return ASSAY_OK;
    }
    const assay_frame3 here = frame3_from_z(job->frames[i].z);
    assay_status       status =
        assay_record_store_find(job->radiance.store, p, job->normals[i], UINT32_MAX, &own->found);
    memset(own->mean, 0, rows->count * sizeof *own->mean);
    if (status == ASSAY_OK && own->found.count > 0) {
        status = assay_radiance_rows_mean(rows, job->radiance.turned, &own->found, p, &here, worker,
                                          own->scratch, own->mean);
        memcpy(row, own->mean, rows->count * sizeof *row);
        status =
            status ? status : assay_radiance_rows_turn(rows, &here, &job->frames[i], worker, row);
        job->out[OUT_WEIGHT]->values[i] = own->found.weight;
    }
    return status || !job->run->bounded ? status : bound_point(job, worker, i);
}

/* ---- all of it ---- */

static assay_status make_desks(stage_run *run, job_data *job)
{
    const size_t row   = job->radiance.rows.count;
    const size_t pairs = job->radiance.bound ? CHANNELS * turn_bound_pairs(job->radiance.bound) : 1;
    job->desks         = assay_allocate(run->context, job->radiance.workers, sizeof *job->desks);
    bool have          = job->desks != NULL;
    for (size_t i = 0; have && i < job->radiance.workers; i++) {
        desk *own    = &job->desks[i];
        own->scratch = assay_allocate(run->context, 2 * row, sizeof(double));
        own->mean    = assay_allocate(run->context, row, sizeof(double));
        own->sizes   = assay_allocate(run->context, pairs, sizeof(double));
        own->off     = assay_allocate(run->context, pairs, sizeof(double));
        have         = own->scratch && own->mean && own->sizes && own->off;
    }
    return have ? ASSAY_OK : assay_fail_memory(run->context, "a cache's users");
}

static void close_job(const stage_run *run, job_data *job)
{
    for (size_t i = 0; job->desks && i < job->radiance.workers; i++) {
        desk *own = &job->desks[i];
        assay_contributions_release(&own->found);
        assay_release(run->context, own->scratch);
        assay_release(run->context, own->mean);
        assay_release(run->context, own->said);
        assay_release(run->context, own->errors);
        assay_release(run->context, own->sizes);
        assay_release(run->context, own->off);
    }
    assay_release(run->context, job->desks);
    assay_release(run->context, job->normals);
    assay_release(run->context, job->frames);
    stage_radiance_close(&job->radiance);
}

static assay_status make_outputs(stage_run *run, job_data *job)
{
    const size_t points = run->in[QUERY_POSITION].rows;
    assay_status status = stage_output_make(run, OUT_COEFFICIENTS, 0, points,
                                            job->radiance.rows.count, &job->out[OUT_COEFFICIENTS]);
    status =
        status ? status : stage_output_make(run, OUT_WEIGHT, 0, points, 1, &job->out[OUT_WEIGHT]);
    if (status == ASSAY_OK && run->bounded && !job->radiance.bound) {
        stage_output_unknown(job->out[OUT_COEFFICIENTS]);
    }
    return status;
}

static assay_status run_interpolate_radiance(stage_run *run)
{
    const size_t points = run->in[QUERY_POSITION].rows;
    job_data     job    = {.run = run};
    assay_status status = stage_query_points(run, QUERY_POSITION, QUERY_FRAME, 6, &job.normals);
    status              = status ? status : stage_query_frames(run, QUERY_FRAME, &job.frames);
    status              = status ? status
                                 : stage_radiance_open(run, false, points, run->in[QUERY_POSITION].values,
                                                       &job.radiance);
    status              = status ? status : make_outputs(run, &job);
    status              = status ? status : make_desks(run, &job);
    status = status ? status : assay_parallel_for(run->context, NULL, points, ask_point, &job);
    close_job(run, &job);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(run->context, "a look into a cache")
                                      : status;
}

const oracle_stage stage_interpolate_radiance = {
    .info = {.name    = "interpolate-radiance",
             .summary = "what a given cache of radiance says at given points",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_interpolate_radiance};
