/* stage_project.c - stage `project`: coefficients from samples of a function. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "oracle/stage/basis_bound.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_records.h"

enum { DIRECTION, PDF, VALUE };

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    {"basis", ASSAY_PARAM_CHOICE, "", "hsh", 0, 0, STAGE_BASIS_KINDS, "Which functions.", ""},
    {"order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL, "Bands l < order.", ""},
    {"convention", ASSAY_PARAM_CHOICE, "", "thesis", 0, 0, STAGE_CONVENTIONS,
     "Signs and order of the functions.", "docs/conventions.md"},
    {0}};

static const assay_stage_array INPUTS[] = {
    {"project/direction", "", "X Y Z", "sample", "unit, in the basis's frame", false, false, false},
    {"project/pdf", "1/sr", "P", "sample", "density of the direction, > 0", false, false, false},
    {"project/value", NULL, NULL, "sample", "a column a channel", false, false, false},
    {0}};

static const assay_stage_array OUTPUTS[] = {
    {"project/coefficients", NULL, NULL, "channel", "a column a function: mean of value / pdf times it",
     false, false, false},
    {0}};
/* clang-format on */

/* Scratch of the bounds: functions of a direction, sums of all channels. */
typedef struct {
    tracked     *functions;
    double      *values;
    tracked_sum *sums;
} bound_room;

static assay_status add_sample(const stage_run *run, const assay_basis *basis, assay_vec3 direction,
                               size_t sample, size_t channels, const bound_room *room)
{
    const rounding    *r      = &run->rounding;
    const size_t       count  = assay_basis_count(basis);
    const assay_status status = assay_basis_evaluate(basis, direction, room->values);
    if (status != ASSAY_OK) {
        return status;
    }
    basis_bound(r, basis, direction, room->values, room->functions);
    for (size_t c = 0; c < channels; c++) {
        const tracked value =
            tracked_div(r, tracked_given(r, run->in[VALUE].values[sample * channels + c]),
                        tracked_given(r, run->in[PDF].values[sample]));
        for (size_t k = 0; k < count; k++) {
            tracked_sum_add(&room->sums[c * count + k], tracked_mul(r, value, room->functions[k]));
        }
    }
    return ASSAY_OK;
}

static assay_status add_samples(const stage_run *run, const assay_basis *basis,
                                const assay_vec3 *directions, size_t channels,
                                const bound_room *room, double *bounds)
{
    const rounding *r          = &run->rounding;
    const size_t    samples    = run->in[DIRECTION].rows;
    const bool      hemisphere = assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis));
    assay_status    status     = ASSAY_OK;
    for (size_t s = 0; s < samples && status == ASSAY_OK; s++) {
        if (!hemisphere || directions[s].z >= 0.0) {
            status = add_sample(run, basis, directions[s], s, channels, room);
        }
    }
    for (size_t k = 0; k < channels * assay_basis_count(basis) && status == ASSAY_OK; k++) {
        const tracked sum = tracked_sum_of(r, &room->sums[k]);
        bounds[k]         = tracked_div(r, sum, tracked_exact((double)samples)).e +
                    r->u * room->sums[k].size / (double)samples; /* or each term is divided */
    }
    return status;
}

static assay_status fill_bounds(const stage_run *run, const assay_basis *basis,
                                const assay_vec3 *directions, size_t channels, double *bounds)
{
    const size_t     count = assay_basis_count(basis);
    const bound_room room  = {
         .functions = assay_allocate(run->context, count, sizeof *room.functions),
         .values    = assay_allocate(run->context, count, sizeof *room.values),
         .sums      = assay_allocate(run->context, channels * count, sizeof *room.sums)};
    const assay_status status = room.functions && room.values && room.sums
                                    ? add_samples(run, basis, directions, channels, &room, bounds)
                                    : assay_fail_memory(run->context, "a projection");
    assay_release(run->context, room.functions);
    assay_release(run->context, room.values);
    assay_release(run->context, room.sums);
    return status;
}

static assay_status project(stage_run *run, const assay_basis *basis)
{
    const size_t  samples = run->in[DIRECTION].rows, channels = run->in[VALUE].columns;
    const size_t  count    = assay_basis_count(basis);
    assay_vec3   *d        = NULL;
    stage_output *out      = NULL;
    double       *variance = NULL;
    for (int i = PDF; i <= VALUE; i++) {
        if (run->in[i].rows != samples) {
            return stage_fail_rows(run, i, samples, "one a sample, as of project/direction");
        }
    }
    assay_status status = stage_unit_vectors(run, DIRECTION, 0, &d);
    status              = status ? status : stage_output_make(run, 0, 0, channels, count, &out);
    if (status == ASSAY_OK) {
        out->unit = run->in[VALUE].unit;
        variance  = assay_allocate(run->context, channels * count, sizeof *variance);
        status    = variance ? assay_basis_project_samples(basis, run->context, samples, d,
                                                           run->in[PDF].values, run->in[VALUE].values,
                                                           (int)channels, out->values, variance)
                             : assay_fail_memory(run->context, "a projection");
    }
    if (status == ASSAY_OK && run->bounded) {
        if (basis_bound_known(assay_basis_kind_of(basis))) {
            status = fill_bounds(run, basis, d, channels, out->bounds);
        } else {
            stage_output_unknown(out);
        }
    }
    assay_release(run->context, variance);
    assay_release(run->context, d);
    return status;
}

static assay_status run_project(stage_run *run)
{
    assay_basis *basis  = NULL;
    assay_status status = assay_basis_create(
        run->context, (assay_basis_kind)assay_params_choice(run->params, "basis"),
        assay_params_int(run->params, "order"),
        (assay_convention)assay_params_choice(run->params, "convention"), &basis);
    status = status ? status : project(run, basis);
    assay_basis_destroy(basis);
    return status;
}

const oracle_stage stage_project = {.info = {.name    = "project",
                                             .summary = "coefficients from samples of a function",
                                             .params  = PARAMS,
                                             .inputs  = INPUTS,
                                             .outputs = OUTPUTS},
                                    .run  = run_project};
