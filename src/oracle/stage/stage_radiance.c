/* stage_radiance.c - Invariant: turns are those that the manifest's method makes, up to the largest
 * tilt at which a record counts at either accuracy. */
#include "oracle/stage/stage_radiance.h"

#include "core/alloc.h"
#include "core/context.h"

enum { CHANNELS = 3, AXES = 3 };

static assay_radiance_turn_settings turning_of(const stage_run *run, const stage_radiance *radiance)
{
    assay_record_rules widest = radiance->records.rules;
    widest.a                  = fmax(widest.a, assay_params_real(run->params, "splat_a"));
    return (assay_radiance_turn_settings){
        .way      = (assay_hsh_rotation_way)assay_params_choice(run->params, "rotation"),
        .steps    = assay_params_int(run->params, "rotation_steps"),
        .sh_order = assay_params_int(run->params, "sh_order"),
        .tilt_max = assay_record_tilt_max(&widest)};
}

static assay_status check_rows(const stage_run *run, size_t count)
{
    const size_t       rows     = run->in[RECORDS_POSITION].rows;
    const stage_table *gradient = &run->in[RADIANCE_GRADIENT];
    const bool         moves    = assay_params_choice(run->params, "coefficient_gradient") != 0;
    if (run->in[RADIANCE_COEFFICIENTS].columns != count) {
        return stage_fail_columns(run, RADIANCE_COEFFICIENTS, count);
    }
    if (moves && !gradient->values) {
        return assay_fail(run->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: 'coefficient_gradient' is %s, but "
                          "radiance_records/coefficient_gradient is not listed",
                          assay_bundle_path(run->bundle),
                          assay_params_text(run->params, "coefficient_gradient"));
    }
    if (moves && gradient->columns != AXES * count) {
        return stage_fail_columns(run, RADIANCE_GRADIENT, AXES * count);
    }
    for (int i = RADIANCE_COEFFICIENTS; i <= RADIANCE_GRADIENT; i++) {
        if (run->in[i].values && run->in[i].rows != rows) {
            return stage_fail_rows(run, i, rows, "one a record, as of radiance_records/position");
        }
    }
    return ASSAY_OK;
}

static assay_status open_rows(stage_run *run, stage_radiance *radiance,
                              const assay_radiance_turn_settings *turning)
{
    const bool   moves = assay_params_choice(run->params, "coefficient_gradient") != 0;
    assay_status status =
        assay_basis_create(run->context, ASSAY_BASIS_HSH, assay_params_int(run->params, "order"),
                           ASSAY_CONVENTION_THESIS, &radiance->hsh);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t count = CHANNELS * assay_basis_count(radiance->hsh);
    status             = check_rows(run, count);
    if (status == ASSAY_OK) {
        status = assay_radiance_turn_create(run->context, radiance->hsh, turning,
                                            (int)radiance->workers, &radiance->turn);
    }
    /* x y z in a row are a vector. */
    const double *gradient = moves ? run->in[RADIANCE_GRADIENT].values : NULL;
    radiance->rows         = (assay_radiance_rows){.count        = count,
                                                   .coefficients = run->in[RADIANCE_COEFFICIENTS].values,
                                                   .gradients    = (const assay_vec3 *)gradient,
                                                   .turn         = radiance->turn};
    return status;
}

static assay_status take_turned(const stage_run *run, stage_radiance *radiance)
{
    const size_t count = radiance->records.count;
    radiance->turned   = assay_allocate(run->context, count, sizeof *radiance->turned);
    if (!radiance->turned) {
        return assay_fail_memory(run->context, "records");
    }
    for (size_t i = 0; i < count; i++) {
        radiance->turned[i]        = radiance->records.records[i];
        radiance->turned[i].normal = stage_unit_normal(radiance->turned[i].normal);
    }
    return ASSAY_OK;
}

static assay_status open_turns(const stage_run *run, stage_radiance *radiance,
                               const assay_radiance_turn_settings *turning)
{
    assay_status status =
        turn_bound_create(run->context, radiance->hsh, radiance->turn, turning, &radiance->bound);
    if (status != ASSAY_OK) {
        return status;
    }
    radiance->desks = assay_allocate(run->context, radiance->workers, sizeof *radiance->desks);
    status          = radiance->desks ? ASSAY_OK : ASSAY_ERR_MEMORY;
    for (size_t i = 0; i < radiance->workers && status == ASSAY_OK; i++) {
        status = radiance_desk_create(run->context, radiance->bound,
                                      radiance->rows.count / CHANNELS, &radiance->desks[i]);
    }
    return status ? assay_fail_memory(run->context, "bounds of radiance") : ASSAY_OK;
}

static assay_status open_bounds(const stage_run *run, stage_radiance *radiance,
                                const assay_radiance_turn_settings *turning)
{
    radiance->walks = assay_allocate(run->context, radiance->workers, sizeof *radiance->walks);
    radiance->parts = assay_allocate(run->context, radiance->workers, sizeof *radiance->parts);
    if (!radiance->walks || !radiance->parts) {
        return assay_fail_memory(run->context, "bounds of radiance");
    }
    return turn_bound_covers(turning->way) ? open_turns(run, radiance, turning) : ASSAY_OK;
}

assay_status stage_radiance_open(stage_run *run, bool splatted, size_t count, const double *points,
                                 stage_radiance *radiance)
{
    *radiance           = (stage_radiance){.workers = (size_t)assay_context_threads(run->context)};
    assay_status status = stage_records_open(run, false, &radiance->records);
    if (status != ASSAY_OK) {
        return status;
    }
    const assay_radiance_turn_settings turning = turning_of(run, radiance);
    const double                       last    = assay_params_real(run->params, "splat_a");
    if (splatted && last > 0.0) {
        radiance->records.rules.a = last;
    }
    status = stage_records_store(&radiance->records, &radiance->store);
    status = status ? status : take_turned(run, radiance);
    status = status ? status : open_rows(run, radiance, &turning);
    if (status || !run->bounded) {
        return status;
    }
    status = open_bounds(run, radiance, &turning);
    return status ? status
                  : stage_records_index(&radiance->records, &run->rounding, count, points, 0.0);
}

void stage_radiance_close(stage_radiance *radiance)
{
    assay_context *context = radiance->records.context;
    for (size_t i = 0; radiance->desks && i < radiance->workers; i++) {
        radiance_desk_release(context, &radiance->desks[i]);
    }
    for (size_t i = 0; radiance->parts && i < radiance->workers; i++) {
        record_parts_release(context, &radiance->parts[i]);
    }
    if (context) {
        assay_release(context, radiance->turned);
        assay_release(context, radiance->desks);
        assay_release(context, radiance->walks);
        assay_release(context, radiance->parts);
    }
    turn_bound_destroy(radiance->bound);
    assay_radiance_turn_destroy(radiance->turn);
    assay_record_store_destroy(radiance->store);
    assay_basis_destroy(radiance->hsh);
    stage_records_close(&radiance->records);
}
