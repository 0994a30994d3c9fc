/* probes.c - irradiance at points: from a table of points to a table of results. */
#include <stdio.h>

#include "assay/render.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/process.h"
#include "io/array_data.h"
#include "methods/run.h"

bool assay_probe_column_name(int column, char name_out[32])
{
    static const char *const QUANTITY[] = {"E",     "EDirect", "EIndirect", "dE/dx", "dE/dy",
                                           "dE/dz", "dE/dax",  "dE/day",    "dE/daz"};
    if (column < 0 || column >= ASSAY_PROBE_COLUMNS) {
        return false;
    }
    snprintf(name_out, 32, "%s%s.%c", column % 6 >= 3 ? "Variance." : "", QUANTITY[column / 6],
             "RGB"[column % 3]);
    return true;
}

typedef struct {
    assay_probe_points points;
    assay_vec3        *positions, *normals; /* owned, what points borrows */
    assay_array       *result;
} probe_work_data;

/* Of any length: scaled first, so that its square neither overflows nor vanishes. */
static assay_vec3 unit(assay_vec3 v)
{
    const double largest = fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z));
    return vec3_normalize(vec3(v.x / largest, v.y / largest, v.z / largest));
}

static assay_status read_points(assay_context *context, const assay_array *table,
                                probe_work_data *data)
{
    const size_t rows = assay_array_rows(table);
    const char  *name = assay_array_name(table, "points");
    if (assay_array_columns(table) != 6) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "%s: the table must have 6 columns (x y z nx ny nz), not %zu", name,
                          assay_array_columns(table));
    }
    data->positions = assay_allocate(context, rows, sizeof *data->positions);
    data->normals   = assay_allocate(context, rows, sizeof *data->normals);
    if (!data->positions || !data->normals) {
        return assay_fail_memory(context, "points");
    }
    for (size_t i = 0; i < rows; i++) {
        const double *v    = assay_array_values(table) + 6 * i;
        data->positions[i] = vec3(v[0], v[1], v[2]);
        data->normals[i]   = unit(vec3(v[3], v[4], v[5]));
        if (!vec3_finite(data->positions[i]) || !vec3_finite(vec3(v[3], v[4], v[5]))) {
            return assay_fail(context, ASSAY_ERR_DOMAIN, "%s: row %zu (from 0) is not finite", name,
                              i);
        }
        if (!(fabs(vec3_length(data->normals[i]) - 1.0) < 1e-6)) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "%s: row %zu (from 0) has no normal: its length is 0", name, i);
        }
    }
    data->points = (assay_probe_points){rows, data->positions, data->normals};
    return ASSAY_OK;
}

static assay_status probe_work(const assay_method *method, void *state, const assay_frame *frame,
                               void *user, assay_ray_counts *counts)
{
    probe_work_data *data   = user;
    assay_array     *result = NULL;
    assay_status     status = assay_array_create(frame->context, data->points.count,
                                                 (size_t)method->probe_columns(state), &result);
    if (status == ASSAY_OK) {
        status = method->probe(state, frame, &data->points, assay_array_data(result), counts);
    }
    if (status != ASSAY_OK) {
        assay_array_destroy(result);
        return status;
    }
    data->result = result;
    return ASSAY_OK;
}

assay_status assay_render_probes(assay_scene *scene, const char *method_name,
                                 const assay_params *params, uint64_t seed,
                                 const assay_array *points, assay_array **result_out,
                                 assay_render_stats *stats_out)
{
    assay_context      *context = scene->context;
    const assay_method *method  = NULL;
    assay_world        *world   = NULL;
    assay_render_stats  stats   = {0};
    assay_ray_counts    counts  = {0};
    probe_work_data     data    = {0};
    assay_status        status  = assay_run_find(context, method_name, &method);
    if (status == ASSAY_OK && !method->probe) {
        status =
            assay_fail(context, ASSAY_ERR_UNSUPPORTED, "method '%s' has no probes", method->name);
    }
    if (status == ASSAY_OK) {
        status = read_points(context, points, &data);
    }
    if (status == ASSAY_OK) {
        status = assay_run_build(scene, &world, &stats);
    }
    if (status == ASSAY_OK) {
        const assay_frame frame = {.context = context, .world = world, .seed = seed, .last = true};
        const double      start = assay_process_seconds();
        status               = assay_run_method(method, params, &frame, probe_work, &data, &counts);
        stats.seconds_render = assay_process_seconds() - start;
        if (status == ASSAY_OK) {
            assay_run_fill_stats(NULL, &frame, &counts, &stats);
        }
    }
    assay_world_destroy(world);
    assay_release(context, data.positions);
    assay_release(context, data.normals);
    if (status == ASSAY_OK) {
        *result_out = data.result;
        if (stats_out) {
            *stats_out = stats;
        }
    }
    return status;
}
