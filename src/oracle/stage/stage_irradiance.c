/* stage_irradiance.c - stage `irradiance`: what follows from the cells of hemispheres. */
#include <string.h>

#include "core/context.h"
#include "oracle/stage/irradiance_bound.h"
#include "oracle/stage/stage_cells.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_records.h"

enum { RADIANCE, DISTANCE, DIRECTION, FRAME };
enum { OUT_IRRADIANCE, OUT_ROTATION, OUT_TRANSLATION, OUT_MEAN, OUT_NEAREST, OUT_COUNT };

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    STAGE_CELL_PARAMS,
    {"mean", ASSAY_PARAM_CHOICE, "", "uniform", 0, 0, "uniform|cosine",
     "How directions count in the harmonic mean of distances.", "[ward88]"},
    {"normal_gradient", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,
     "Translational gradients have a component along the normal.", "ours"},
    {0}};

static const assay_stage_array INPUTS[] = {
    {"gather/radiance", "W/(m2 sr)", "R G B", "cell",
     "theta_strata times phi_strata rows a record, theta by theta", false, false, false},
    {"gather/distance", "m", "T", "cell", "infinite where nothing is hit", false, false, true},
    {"gather/direction", "", "X Y Z", "cell",
     "local, unit, in its cell; asked of uniform strata alone, without it the cells' centres",
     true, false, false},
    {"gather/frame", "", "Xx Xy Xz Yx Yy Yz Zx Zy Zz", "record",
     "axes of the local frame in the world; z is the normal", false, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"records/irradiance", "W/m2", "R G B", "record", "", false, false, false},
    {"records/rotation_gradient", "W/(m2 rad)", "Rx Ry Rz Gx Gy Gz Bx By Bz", "record",
     "world frame, before limits", false, false, false},
    {"records/translation_gradient", "W/m3", "Rx Ry Rz Gx Gy Gz Bx By Bz", "record",
     "world frame, before limits", false, false, false},
    {"records/harmonic_mean", "m", "R", "record", "infinite where nothing is hit",
     false, false, true},
    {"records/nearest", "m", "R", "record", "smallest distance", false, false, true},
    {0}};
/* clang-format on */

assay_hemisphere_layout stage_cells_layout(const assay_params *params)
{
    return (assay_hemisphere_layout){.theta  = assay_params_int(params, "theta_strata"),
                                     .phi    = assay_params_int(params, "phi_strata"),
                                     .strata = (assay_strata)assay_params_choice(params, "strata")};
}

assay_status stage_cells_check(const stage_run *run)
{
    const char *gather = stage_manifest_text(run->bundle, "gather");
    if (gather && strncmp(gather, "raster", 6) == 0) {
        return assay_fail(
            run->context, ASSAY_ERR_UNSUPPORTED,
            "%s: bundle: its hemispheres were rasterised (gather=%s), stage '%s' is of "
            "rays",
            assay_bundle_path(run->bundle), gather, run->stage->info.name);
    }
    return ASSAY_OK;
}

static assay_frame3 frame_of(const double *row)
{
    return (assay_frame3){stage_vec3(row), stage_vec3(row + 3), stage_vec3(row + 6)};
}

static assay_status take_cells(const stage_run *run, size_t record, assay_hemisphere *h)
{
    const size_t cells = (size_t)h->layout.theta * (size_t)h->layout.phi;
    for (size_t i = 0; i < cells; i++) {
        const size_t  row    = record * cells + i;
        const double *l      = run->in[RADIANCE].values + 3 * row;
        h->cells[i].radiance = rgb(l[0], l[1], l[2]);
        h->cells[i].distance = run->in[DISTANCE].values[row];
        if (!(h->cells[i].distance > 0.0)) {
            return stage_fail_value(run, DISTANCE, row, 0, "a distance that is not > 0");
        }
        if (run->in[DIRECTION].values) {
            h->cells[i].direction = stage_vec3(run->in[DIRECTION].values + 3 * row);
        }
    }
    return ASSAY_OK;
}

static void put_world(const assay_frame3 *frame, const assay_vec3 local[3], double *row)
{
    for (int c = 0; c < 3; c++) {
        const assay_vec3 world = frame3_to_world(frame, local[c]);
        memcpy(row + 3 * c, &world, sizeof world);
    }
}

typedef struct {
    stage_output *out[OUT_COUNT];
} outputs;

static void put_bounds(const irradiance_bounds *b, const outputs *o, size_t i)
{
    memcpy(o->out[OUT_IRRADIANCE]->bounds + 3 * i, b->irradiance, sizeof b->irradiance);
    memcpy(o->out[OUT_ROTATION]->bounds + 9 * i, b->rotation, sizeof b->rotation);
    memcpy(o->out[OUT_TRANSLATION]->bounds + 9 * i, b->translation, sizeof b->translation);
    o->out[OUT_MEAN]->bounds[i]    = b->mean;
    o->out[OUT_NEAREST]->bounds[i] = b->nearest;
}

static assay_status evaluate(const stage_run *run, const outputs *o, size_t i, assay_hemisphere *h)
{
    const assay_mean_weight mean   = (assay_mean_weight)assay_params_choice(run->params, "mean");
    const bool              normal = assay_params_bool(run->params, "normal_gradient");
    const assay_frame3      frame  = frame_of(run->in[FRAME].values + 9 * i);
    const assay_status      status = take_cells(run, i, h);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_vec3      gradient[3];
    const assay_rgb e = assay_hemisphere_irradiance(h);
    memcpy(o->out[OUT_IRRADIANCE]->values + 3 * i, &e, sizeof e);
    assay_hemisphere_rotation_gradient(h, gradient);
    put_world(&frame, gradient, o->out[OUT_ROTATION]->values + 9 * i);
    assay_hemisphere_translation_gradient(h, normal, gradient);
    put_world(&frame, gradient, o->out[OUT_TRANSLATION]->values + 9 * i);
    o->out[OUT_MEAN]->values[i]    = assay_hemisphere_harmonic_mean(h, mean);
    o->out[OUT_NEAREST]->values[i] = assay_hemisphere_nearest(h);
    if (run->bounded) {
        const irradiance_bounds b = irradiance_bounds_of(&run->rounding, h, &frame, mean, normal);
        put_bounds(&b, o, i);
    }
    return ASSAY_OK;
}

static assay_status check_rows(const stage_run *run, size_t cells)
{
    const size_t records = run->in[FRAME].rows;
    for (int i = RADIANCE; i <= DIRECTION; i++) {
        if (run->in[i].values &&
            (records > SIZE_MAX / cells || run->in[i].rows != records * cells)) {
            return stage_fail_rows(run, i, records * cells,
                                   "theta_strata * phi_strata a record, as many as gather/frame");
        }
    }
    return ASSAY_OK;
}

static assay_status run_irradiance(stage_run *run)
{
    static const size_t           columns[OUT_COUNT] = {3, 9, 9, 1, 1};
    const assay_hemisphere_layout layout             = stage_cells_layout(run->params);
    assay_hemisphere             *h                  = NULL;
    outputs                       o;
    assay_status                  status = stage_cells_check(run);
    status = status ? status : check_rows(run, (size_t)layout.theta * (size_t)layout.phi);
    status = status ? status : assay_hemisphere_create(run->context, &layout, &h);
    for (int i = 0; i < OUT_COUNT && status == ASSAY_OK; i++) {
        status = stage_output_make(run, i, 0, run->in[FRAME].rows, columns[i], &o.out[i]);
    }
    for (size_t i = 0; i < run->in[FRAME].rows && status == ASSAY_OK; i++) {
        status = evaluate(run, &o, i, h);
    }
    assay_hemisphere_destroy(run->context, h);
    return status;
}

const oracle_stage stage_irradiance = {
    .info = {.name    = "irradiance",
             .summary = "irradiance, its gradients and distances from the cells of hemispheres",
             .params  = PARAMS,
             .inputs  = INPUTS,
             .outputs = OUTPUTS},
    .run  = run_irradiance};
