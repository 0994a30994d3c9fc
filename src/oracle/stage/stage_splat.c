/* stage_splat.c - stage `splat`: given records splatted on a given G-buffer, batch after batch, as
 * the dump of method `splat` tells it (docs/bundle.md).
 *
 * The bounds of spheres in the image only leave out what weighs nothing, so a pixel's sums do not
 * depend on them: bounds are analysed pixel by pixel, over the records near its point. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "methods/cached_image.h"
#include "oracle/stage/splat_batches.h"
#include "oracle/stage/stage_camera.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_records.h"
#include "record/splat.h"

enum { SPLAT_POSITION = RECORDS_INPUTS, SPLAT_FRAME, SPLAT_ALBEDO, SPLAT_ENDS, CHUNK = 64 };
enum { OUT_WEIGHT, OUT_RADIANCE };

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    STAGE_RULE_PARAMS, STAGE_SAID_PARAMS,
    STAGE_BATCH_PARAMS,
    {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RECORD_ARRAYS,
    STAGE_PIXEL_ARRAYS,
    {"splat/batch_end", "records", "K", "batch",
     "how many records it has; without it one batch has all", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"splat/batch.#/weight", "", "W", "pixel", "sum of weights", false, false, false},
    {"splat/batch.#/radiance", "W/(m2 sr)", "R G B", "pixel",
     "sum of weight times outgoing radiance", false, false, false},
    {0}};
/* clang-format on */

/* A batch, and what comes of it. */
typedef struct {
    splat_batch   of;
    stage_output *weight, *radiance;
} batch;

typedef struct {
    stage_run          *run;
    stage_records      *records;
    assay_record_store *store;
    assay_splat_buffer *buffer;
    assay_vec3         *normals;
    size_t              pixels, batch_count;
    batch              *batches;
    stage_candidates   *near; /* a worker */
    assay_octree_walk  *walks;
} job_data;

static bool has_point(const job_data *job, size_t pixel)
{
    return !isnan(job->run->in[SPLAT_POSITION].values[3 * pixel]);
}

/* ---- what the bundle says ---- */

static assay_status take_points(job_data *job)
{
    stage_run *run = job->run;
    job->pixels    = run->in[SPLAT_POSITION].rows;
    return run->in[SPLAT_ALBEDO].rows != job->pixels
               ? stage_fail_rows(run, SPLAT_ALBEDO, job->pixels,
                                 "one a pixel, as of splat/position")
               : stage_pixel_normals(run, SPLAT_POSITION, SPLAT_FRAME, &job->normals);
}

static assay_status make_outputs(job_data *job, const splat_batch *batches)
{
    job->batches = assay_allocate(job->run->context, job->batch_count, sizeof *job->batches);
    if (!job->batches) {
        return assay_fail_memory(job->run->context, "batches");
    }
    assay_status status = ASSAY_OK;
    for (size_t k = 0; k < job->batch_count && status == ASSAY_OK; k++) {
        batch *b = &job->batches[k];
        b->of    = batches[k];
        status = stage_output_make(job->run, OUT_WEIGHT, b->of.number, job->pixels, 1, &b->weight);
        status = status ? status
                        : stage_output_make(job->run, OUT_RADIANCE, b->of.number, job->pixels, 3,
                                            &b->radiance);
    }
    return status;
}

static assay_status take_batches(job_data *job)
{
    splat_batch *batches = NULL;
    assay_status status =
        splat_batches_read(job->run, SPLAT_ENDS, job->records->count, &batches, &job->batch_count);
    status = status ? status : make_outputs(job, batches);
    assay_release(job->run->context, batches);
    return status;
}

/* ---- values ---- */

static assay_status open_buffer(job_data *job)
{
    stage_run         *run  = job->run;
    const stage_camera view = stage_camera_read(run, job->pixels);
    assay_status       status =
        assay_splat_buffer_create(run->context, view.width, view.height, &job->buffer);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_splat_buffer_look(job->buffer, &view.camera);
    for (size_t i = 0; i < job->pixels; i++) {
        if (has_point(job, i)) {
            assay_splat_buffer_set(job->buffer, i,
                                   stage_vec3(run->in[SPLAT_POSITION].values + 3 * i),
                                   job->normals[i]);
        }
    }
    return assay_splat_buffer_close(job->buffer);
}

static assay_status open_store(job_data *job)
{
    /* Nothing is looked up in it: splatting goes from records to pixels. */
    assay_status status =
        assay_record_store_create(job->run->context, &job->records->rules, vec3(0, 0, 0),
                                  vec3(0, 0, 0), ASSAY_INDEX_LIST, &job->store);
    for (size_t i = 0; i < job->records->count && status == ASSAY_OK; i++) {
        status = assay_record_store_add(job->store, &job->records->records[i]);
    }
    return status;
}

static void take_sums(const job_data *job, const batch *b)
{
    for (size_t i = 0; i < job->pixels; i++) {
        const double   *c      = job->run->in[SPLAT_ALBEDO].values + 3 * i;
        const assay_rgb albedo = rgb(c[0], c[1], c[2]);
        const assay_rgb sum =
            assay_cached_point_sum(albedo, assay_splat_sum(job->buffer, i), NULL, false);
        b->weight->values[i] = assay_splat_weight(job->buffer, i);
        memcpy(b->radiance->values + 3 * i, &sum, sizeof sum);
    }
}

static assay_status splat_batches(job_data *job)
{
    assay_splat_source source = {.store = job->store, .rules = job->records->rules};
    uint32_t           done   = 0;
    assay_status       status = ASSAY_OK;
    for (size_t k = 0; k < job->batch_count && status == ASSAY_OK; k++) {
        const batch *b = &job->batches[k];
        if (b->of.a != source.rules.a || b->of.old > 0) {
            source.rules.a = b->of.a;
            assay_splat_buffer_clear(job->buffer);
            status = assay_splat_records(job->buffer, &source, 0, b->of.old);
            done   = 0;
        }
        status = status ? status : assay_splat_records(job->buffer, &source, done, b->of.end);
        done   = b->of.end;
        take_sums(job, b);
    }
    return status;
}

/* ---- bounds ---- */

typedef struct {
    tracked_sum weight, light[3];
} pixel_sums;

/* A term of both sums.  weight times what is said: in [low, high] times [v - e, v + e]. */
static void add_term(const rounding *r, pixel_sums *sums, const weight_bound *w, double counts,
                     const tracked said[3])
{
    const double  low    = w->member == BOUND_IN ? w->low : 0.0;
    const tracked weight = {counts, fmax(w->high - counts, counts - low)};
    tracked_sum_add(&sums->weight, weight);
    for (int c = 0; c < 3; c++) {
        tracked_sum_add(&sums->light[c], tracked_mul(r, weight, said[c]));
    }
}

static assay_status bound_pixel(const job_data *job, const batch *b, size_t pixel,
                                const stage_candidates *near)
{
    const rounding    *r     = &job->run->rounding;
    assay_record_rules rules = job->records->rules;
    const assay_vec3   p     = stage_vec3(job->run->in[SPLAT_POSITION].values + 3 * pixel);
    const assay_vec3   n     = job->normals[pixel];
    pixel_sums         sums  = {0};
    rules.a                  = b->of.a;
    for (size_t i = 0; i < near->count && near->items[i] < b->of.end; i++) {
        const assay_record *record = &job->records->records[near->items[i]];
        const weight_bound  w = record_weight_bound(r, job->records->exact, record, &rules, p, n);
        if (w.member != BOUND_OUT) {
            tracked      said[3];
            const double counts = assay_record_weight(record, &rules, p, n);
            record_said_bound(r, job->records->exact, record, &rules, p, n, said);
            for (int times = near->items[i] < b->of.old ? 2 : 1; times > 0; times--) {
                add_term(r, &sums, &w, counts, said);
            }
        }
    }
    b->weight->bounds[pixel] = tracked_sum_of(r, &sums.weight).e;
    for (int c = 0; c < 3; c++) {
        const tracked albedo =
            tracked_given(r, job->run->in[SPLAT_ALBEDO].values[3 * pixel + (size_t)c]);
        const tracked share = tracked_mul(r, albedo, tracked_constant(r, ASSAY_INV_PI));
        /* Each term may be multiplied, or the sum. */
        b->radiance->bounds[3 * pixel + (size_t)c] =
            tracked_mul(r, share, tracked_sum_of(r, &sums.light[c])).e +
            r->u * sums.light[c].size * fabs(share.v);
    }
    return ASSAY_OK;
}

static assay_status bound_pixels(void *user, uint64_t chunk, int worker)
{
    const job_data   *job  = user;
    stage_candidates *near = &job->near[worker];
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < job->pixels; i++) {
        if (!has_point(job, i)) {
            continue;
        }
        const assay_vec3 p = stage_vec3(job->run->in[SPLAT_POSITION].values + 3 * i);
        if (stage_records_near(job->records, &job->walks[worker], p, near) != ASSAY_OK) {
            return ASSAY_ERR_MEMORY;
        }
        for (size_t k = 0; k < job->batch_count; k++) {
            bound_pixel(job, &job->batches[k], i, near);
        }
    }
    return ASSAY_OK;
}

static assay_status bound_all(job_data *job)
{
    stage_run   *run     = job->run;
    const size_t threads = (size_t)assay_context_threads(run->context);
    job->near            = assay_allocate(run->context, threads, sizeof *job->near);
    job->walks           = assay_allocate(run->context, threads, sizeof *job->walks);
    if (!job->near || !job->walks) {
        return assay_fail_memory(run->context, "pixels");
    }
    const assay_status status = stage_records_index(job->records, &run->rounding, job->pixels,
                                                    run->in[SPLAT_POSITION].values,
                                                    job->batches[job->batch_count - 1].of.a);
    return status ? status
                  : assay_parallel_for(run->context, NULL, (job->pixels + CHUNK - 1) / CHUNK,
                                       bound_pixels, job);
}

/* ---- all of it ---- */

static void close_job(job_data *job)
{
    assay_context *context = job->run->context;
    for (int i = 0; job->near && i < assay_context_threads(context); i++) {
        assay_release(context, job->near[i].items);
    }
    assay_release(context, job->near);
    assay_release(context, job->walks);
    assay_release(context, job->normals);
    assay_release(context, job->batches);
    assay_splat_buffer_destroy(job->buffer);
    assay_record_store_destroy(job->store);
}

static assay_status run_splat(stage_run *run)
{
    stage_records records = {0};
    job_data      job     = {.run = run, .records = &records};
    assay_status  status  = stage_records_open(run, true, &records);
    status                = status ? status : take_points(&job);
    status                = status ? status : take_batches(&job);
    status                = status ? status : open_buffer(&job);
    status                = status ? status : open_store(&job);
    status                = status ? status : splat_batches(&job);
    if (status == ASSAY_OK && run->bounded && job.batch_count > 0) {
        status = bound_all(&job);
    }
    close_job(&job);
    stage_records_close(&records);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(run->context, "splatting") : status;
}

const oracle_stage stage_splat = {.info = {.name    = "splat",
                                           .summary = "given records splatted on a given G-buffer",
                                           .params  = PARAMS,
                                           .inputs  = INPUTS,
                                           .outputs = OUTPUTS},
                                  .run  = run_splat};
