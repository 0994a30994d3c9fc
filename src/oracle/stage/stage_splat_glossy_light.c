/* stage_splat_glossy_light.c - stage `splat-glossy-light`: the weighted outgoing radiance of the
 * last batch of radiance records, given its sums of weights: weight times the mean of the dot
 * products of what the records say with what the pixel's BRDF is.
 *
 * Given the weights for the reason of stage `splat-light`.  The frame of the BRDF is the pixel's:
 * its z is the normal, so records are turned into frame3_from_z of that as everywhere. */
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "oracle/stage/lobe_bound.h"
#include "oracle/stage/splat_batches.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_radiance.h"

enum {
    SPLAT_POSITION = RADIANCE_INPUTS,
    SPLAT_BRDF,
    SPLAT_LOBE,
    SPLAT_GRIDS,
    SPLAT_WEIGHT,
    SPLAT_ENDS
};
enum { CHANNELS = ASSAY_MATERIAL_CHANNELS, BRDF_COLUMNS = 15, LOBES = 1 + CHANNELS };

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    STAGE_RULE_PARAMS, STAGE_RADIANCE_PARAMS,
    {"grid", ASSAY_PARAM_INT, "texels", "32", 2, 512, NULL, "Side of a lobe's grid.",
     "[gautron06] eq. 3.35, 3.36"},
    STAGE_LAST_BATCH_PARAMS,
    {0}};

static const assay_stage_array INPUTS[] = {
    STAGE_RADIANCE_ARRAYS,
    {"splat_glossy/position", "m", "X Y Z", "pixel", "its point; NaN where it is not glossy",
     false, true, false},
    {"splat_glossy/brdf", "", NULL, "pixel",
     "frame of the BRDF (its z is the normal), wo in it, base colour; NaN likewise",
     false, true, false},
    {"splat_glossy/lobe", "", "Slope R G B", "pixel",
     "numbers of its lobes: base colour 1 less 0, base colour 0; NaN likewise", false, true, false},
    {"splat_glossy/lobe_grid", "1/sr", NULL, "lobe and texel",
     "coefficients, lobe by lobe, row by row", false, false, false},
    {"splat_glossy/batch.#/weight", "", "W", "pixel", "sum of weights, of the last batch",
     false, false, false},
    {"splat_glossy/batch_end", "records", "K", "batch",
     "how many records it has; without it one batch has all", true, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"splat_glossy/batch.#/radiance", "W/(m2 sr)", "R G B", "pixel",
     "of the last batch: weight times the mean outgoing radiance", false, false, false},
    {0}};
/* clang-format on */

/* A worker's own. */
typedef struct {
    assay_contributions found;
    double             *brdf, *light, *scratch; /* 3 rows, 3 rows, one row                 */
    double             *sizes, *errors;         /* of the BRDF's pairs, turned to the light */
} desk;

typedef struct {
    stage_run     *run;
    stage_radiance radiance;
    lobe_grids     lobes;
    assay_vec3    *normals, *wo;
    assay_frame3  *frames;
    uint32_t       end;
    stage_output  *out;
    desk          *desks;
} light_job;

static void reflect(const double *light, const double *brdf, size_t count,
                    double said_out[CHANNELS])
{
    for (size_t c = 0; c < CHANNELS; c++) {
        said_out[c] = 0.0;
        for (size_t i = c * count; i < (c + 1) * count; i++) {
            said_out[c] += light[i] * brdf[i];
        }
    }
}

static lobe_pixel pixel_of(const light_job *job, size_t pixel)
{
    const double *row = job->run->in[SPLAT_LOBE].values + LOBES * pixel;
    const double *c   = job->run->in[SPLAT_BRDF].values + BRDF_COLUMNS * pixel + 12;
    return (lobe_pixel){.slope      = (size_t)row[0],
                        .black      = {(size_t)row[1], (size_t)row[2], (size_t)row[3]},
                        .wo         = job->wo[pixel],
                        .base_color = rgb(c[0], c[1], c[2])};
}

/* ---- bounds ---- */

/* own->brdf is in frame3_from_z of the normal. */
static assay_status hear_parts(const light_job *job, int worker, size_t pixel, assay_vec3 p)
{
    const stage_radiance *radiance = &job->radiance;
    const rounding       *r        = &job->run->rounding;
    record_parts         *parts    = &radiance->parts[worker];
    radiance_desk        *hearing  = &radiance->desks[worker];
    const desk           *own      = &job->desks[worker];
    const size_t count = radiance->rows.count / CHANNELS, pairs = turn_bound_pairs(radiance->bound);
    assay_status status = ASSAY_OK;
    for (size_t k = 0; k < parts->count && status == ASSAY_OK; k++) {
        const uint32_t number = parts->numbers[k];
        double         said[CHANNELS];
        status = radiance_said_bound(radiance->bound, r, radiance->records.exact, &radiance->rows,
                                     &radiance->turned[number], number, p, job->frames[pixel].z,
                                     worker, hearing);
        reflect(hearing->said, own->brdf, count, said);
        for (size_t c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
            parts->items[k].said[c] = (tracked){
                said[c], lobe_product_bound(radiance->bound, r, count, hearing->after + c * pairs,
                                            hearing->errors + c * pairs, own->sizes + c * pairs,
                                            own->errors + c * pairs)};
        }
    }
    return status;
}

static assay_status bound_pixel(const light_job *job, int worker, size_t pixel, assay_vec3 p,
                                const double mean[CHANNELS])
{
    const stage_radiance *radiance = &job->radiance;
    const rounding       *r        = &job->run->rounding;
    record_parts         *parts    = &radiance->parts[worker];
    const desk           *own      = &job->desks[worker];
    const lobe_pixel      shown    = pixel_of(job, pixel);
    const tracked_frame   here     = tracked_frame_from_z(r, job->frames[pixel].z);
    const tracked_frame   there    = tracked_frame_given(r, &job->frames[pixel]);
    const tracked         weight   = tracked_given(r, job->run->in[SPLAT_WEIGHT].values[pixel]);
    lobe_bound(&job->lobes, radiance->bound, r, &shown, own->sizes, own->errors);
    turn_bound_spin(radiance->bound, r, &there, &here, own->sizes, own->errors);
    assay_status status = record_parts_collect(&radiance->records, r, &radiance->walks[worker],
                                               job->end, p, job->normals[pixel], NULL, parts);
    status              = status ? status : hear_parts(job, worker, pixel, p);
    for (size_t c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        const double bound =
            parts->count ? mean_bound(r, parts->items, parts->count, (int)c, mean[c]) : 0.0;
        job->out->bounds[CHANNELS * pixel + c] =
            tracked_mul(r, weight, (tracked){mean[c], bound}).e;
    }
    return status;
}

/* ---- values ---- */

/* The BRDF about the normal, as what records say is. */
static assay_status take_brdf(const light_job *job, int worker, size_t pixel)
{
    const desk        *own    = &job->desks[worker];
    const lobe_pixel   shown  = pixel_of(job, pixel);
    const assay_frame3 here   = frame3_from_z(job->frames[pixel].z);
    const assay_status status = lobe_look_up(&job->lobes, &shown, own->scratch, own->brdf);
    return status ? status
                  : assay_radiance_rows_turn(&job->radiance.rows, &job->frames[pixel], &here,
                                             worker, own->brdf);
}

static assay_status light_pixel(void *user, uint64_t pixel, int worker)
{
    const light_job           *job  = user;
    const assay_radiance_rows *rows = &job->radiance.rows;
    const assay_vec3           p    = stage_vec3(job->run->in[SPLAT_POSITION].values + 3 * pixel);
    desk                      *own  = &job->desks[worker];
    double                     mean[CHANNELS] = {0.0, 0.0, 0.0}, total = 0.0;
    if (isnan(p.x)) {
        return ASSAY_OK;
    }
    const assay_frame3 here   = frame3_from_z(job->frames[pixel].z);
    assay_status       status = take_brdf(job, worker, (size_t)pixel);
    status                    = status ? status
                                       : assay_record_store_find(job->radiance.store, p, job->normals[pixel], job->end,
                                                                 &own->found);
    for (size_t k = 0; status == ASSAY_OK && k < own->found.count; k++) {
        const assay_contribution *item = &own->found.items[k];
        double                    said[CHANNELS];
        status = assay_radiance_rows_say(rows, &job->radiance.turned[item->number], item->number, p,
                                         &here, worker, own->light);
        reflect(own->light, own->brdf, rows->count / CHANNELS, said);
        total += item->weight;
        for (int c = 0; c < CHANNELS; c++) {
            mean[c] += item->weight / total * (said[c] - mean[c]);
        }
    }
    for (size_t c = 0; c < CHANNELS; c++) {
        job->out->values[CHANNELS * pixel + c] = mean[c] * job->run->in[SPLAT_WEIGHT].values[pixel];
    }
    return status || !job->radiance.bound ? status
                                          : bound_pixel(job, worker, (size_t)pixel, p, mean);
}

/* ---- all of it ---- */

static assay_status check_lobes(stage_run *run, size_t lobes)
{
    const stage_table *t = &run->in[SPLAT_LOBE];
    for (size_t i = 0; i < LOBES * t->rows; i++) {
        const bool   asked = !isnan(run->in[SPLAT_POSITION].values[i / LOBES * 3]);
        const double n     = t->values[i];
        if (asked && !(n >= 0.0 && n < (double)lobes && n == assay_floor(n))) {
            return stage_fail_value(run, SPLAT_LOBE, i / LOBES, i % LOBES,
                                    "not a number of a lobe");
        }
    }
    return ASSAY_OK;
}

static assay_status open_lobes(light_job *job)
{
    stage_run         *run   = job->run;
    const stage_table *grids = &run->in[SPLAT_GRIDS];
    const int          side  = assay_params_int(run->params, "grid");
    const size_t texels = (size_t)side * (size_t)side, count = job->radiance.rows.count / CHANNELS;
    if (grids->columns != count) {
        return stage_fail_columns(run, SPLAT_GRIDS, count);
    }
    if (grids->rows % texels != 0) {
        return stage_fail_rows(run, SPLAT_GRIDS, grids->rows - grids->rows % texels,
                               "grid * grid of each lobe");
    }
    const assay_status status = check_lobes(run, grids->rows / texels);
    return status ? status
                  : lobe_grids_open(run->context, side, count, grids->rows / texels, grids->values,
                                    &job->lobes);
}

static assay_status check(light_job *job)
{
    stage_run   *run    = job->run;
    const size_t pixels = run->in[SPLAT_POSITION].rows;
    for (int i = SPLAT_BRDF; i <= SPLAT_WEIGHT; i++) {
        if (i != SPLAT_GRIDS && run->in[i].rows != pixels) {
            return stage_fail_rows(run, i, pixels, "one a pixel, as of splat_glossy/position");
        }
    }
    const assay_status status =
        splat_batches_last_end(run, SPLAT_ENDS, job->radiance.records.count, &job->end);
    return status == ASSAY_OK ? open_lobes(job) : status;
}

static assay_status take_pixels(light_job *job)
{
    stage_run *run = job->run;
    if (run->in[SPLAT_BRDF].columns != BRDF_COLUMNS) {
        return stage_fail_columns(run, SPLAT_BRDF, BRDF_COLUMNS);
    }
    assay_status status = stage_query_points(run, SPLAT_POSITION, SPLAT_BRDF, 6, &job->normals);
    status              = status ? status : stage_query_frames(run, SPLAT_BRDF, &job->frames);
    return status ? status : stage_unit_vectors(run, SPLAT_BRDF, 9, &job->wo);
}

static assay_status make_desks(light_job *job)
{
    assay_context *context = job->run->context;
    const size_t   row     = job->radiance.rows.count;
    const size_t pairs = job->radiance.bound ? CHANNELS * turn_bound_pairs(job->radiance.bound) : 1;
    job->desks         = assay_allocate(context, job->radiance.workers, sizeof *job->desks);
    bool have          = job->desks != NULL;
    for (size_t i = 0; have && i < job->radiance.workers; i++) {
        desk *own    = &job->desks[i];
        own->brdf    = assay_allocate(context, row, sizeof(double));
        own->light   = assay_allocate(context, row, sizeof(double));
        own->scratch = assay_allocate(context, row, sizeof(double));
        own->sizes   = assay_allocate(context, pairs, sizeof(double));
        own->errors  = assay_allocate(context, pairs, sizeof(double));
        have         = own->brdf && own->light && own->scratch && own->sizes && own->errors;
    }
    return have ? ASSAY_OK : assay_fail_memory(context, "pixels");
}

static assay_status make_output(light_job *job)
{
    stage_run         *run    = job->run;
    const char        *number = strstr(run->in[SPLAT_WEIGHT].name, "batch.");
    const size_t       pixels = run->in[SPLAT_POSITION].rows;
    const assay_status status =
        stage_output_make(run, 0, number ? atoi(number + 6) : 0, pixels, CHANNELS, &job->out);
    if (status == ASSAY_OK && run->bounded && !job->radiance.bound) {
        stage_output_unknown(job->out);
    }
    return status;
}

static void close_job(light_job *job)
{
    assay_context *context = job->run->context;
    for (size_t i = 0; job->desks && i < job->radiance.workers; i++) {
        desk *own = &job->desks[i];
        assay_contributions_release(&own->found);
        assay_release(context, own->brdf);
        assay_release(context, own->light);
        assay_release(context, own->scratch);
        assay_release(context, own->sizes);
        assay_release(context, own->errors);
    }
    assay_release(context, job->desks);
    assay_release(context, job->normals);
    assay_release(context, job->wo);
    assay_release(context, job->frames);
    lobe_grids_close(&job->lobes);
    stage_radiance_close(&job->radiance);
}

static assay_status run_splat_glossy_light(stage_run *run)
{
    const size_t pixels = run->in[SPLAT_POSITION].rows;
    light_job    job    = {.run = run};
    if (assay_params_choice(run->params, "variant") == 1) {
        return ASSAY_OK;
    }
    assay_status status = take_pixels(&job);
    status              = status ? status
                                 : stage_radiance_open(run, true, pixels, run->in[SPLAT_POSITION].values,
                                                       &job.radiance);
    status              = status ? status : check(&job);
    if (status == ASSAY_OK &&
        !splat_batches_are_stale(run, SPLAT_ENDS, job.radiance.records.count)) {
        status = make_output(&job);
        status = status ? status : make_desks(&job);
        status =
            status ? status : assay_parallel_for(run->context, NULL, pixels, light_pixel, &job);
    }
    close_job(&job);
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(run->context, "splatting") : status;
}

const oracle_stage stage_splat_glossy_light = {
    .info = {.name    = "splat-glossy-light",
             .summary = "weighted radiance of radiance records, given the weights",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_splat_glossy_light};
