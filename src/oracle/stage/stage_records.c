/* stage_records.c - Invariant: what the octree leaves out is out for every candidate of the
 * precision. */
#include "oracle/stage/stage_records.h"

#include <stdlib.h>

#include "core/alloc.h"
#include "core/context.h"

static assay_record_rules rules_of(const assay_params *params, bool said)
{
    assay_record_rules rules = {
        .a        = assay_params_real(params, "a"),
        .weight   = (assay_weight_kind)assay_params_choice(params, "weight"),
        .in_front = assay_params_bool(params, "in_front"),
    };
    if (said) {
        rules.gradients      = (assay_gradients)assay_params_choice(params, "gradients");
        rules.clamp_negative = assay_params_bool(params, "clamp_negative");
    }
    return rules;
}

static assay_status check_rows(const stage_run *run, bool said)
{
    const size_t rows = run->in[RECORDS_POSITION].rows;
    for (int i = 0; i < (said ? RECORDS_INPUTS : RECORDS_SITE_INPUTS); i++) {
        if (run->in[i].values && run->in[i].rows != rows) {
            return stage_fail_rows(run, i, rows, "one a record, as of records/position");
        }
    }
    return rows < UINT32_MAX ? ASSAY_OK
                             : assay_fail(run->context, ASSAY_ERR_LIMIT, "too many records");
}

/* Gradients that are used must be there. */
static assay_status check_gradients(const stage_run *run, assay_gradients used)
{
    const bool rotation    = used == ASSAY_GRADIENTS_ROTATION || used == ASSAY_GRADIENTS_BOTH;
    const bool translation = used == ASSAY_GRADIENTS_TRANSLATION || used == ASSAY_GRADIENTS_BOTH;
    if ((rotation && !run->in[RECORDS_ROTATION].values) ||
        (translation && !run->in[RECORDS_TRANSLATION].values)) {
        return assay_fail(
            run->context, ASSAY_ERR_FORMAT,
            "%s: bundle: 'gradients' is %s, but records/%s_gradient is not listed",
            assay_bundle_path(run->bundle), assay_params_text(run->params, "gradients"),
            rotation && !run->in[RECORDS_ROTATION].values ? "rotation" : "translation");
    }
    return ASSAY_OK;
}

static void take_vectors(const stage_table *t, size_t row, assay_vec3 out[3])
{
    for (int c = 0; c < 3 && t->values; c++) {
        out[c] = stage_vec3(t->values + 9 * row + 3 * c);
    }
}

static assay_status take(stage_run *run, bool said, const assay_vec3 *normals, stage_records *made)
{
    const stage_table *in = run->in;
    for (size_t i = 0; i < made->count; i++) {
        assay_record *record = &made->records[i];
        *record = (assay_record){.position = stage_vec3(in[RECORDS_POSITION].values + 3 * i),
                                 .normal   = normals[i],
                                 .radius   = in[RECORDS_RADIUS].values[i],
                                 .mean     = INFINITY,
                                 .nearest  = INFINITY};
        if (!(record->radius > 0.0)) {
            return stage_fail_value(run, RECORDS_RADIUS, i, 0, "a radius that is not > 0");
        }
        if (said) {
            const double *e    = in[RECORDS_IRRADIANCE].values + 3 * i;
            record->irradiance = rgb(e[0], e[1], e[2]);
            take_vectors(&in[RECORDS_ROTATION], i, record->rotation);
            take_vectors(&in[RECORDS_TRANSLATION], i, record->translation);
        }
    }
    return ASSAY_OK;
}

assay_status stage_records_open(stage_run *run, bool said, stage_records *records_out)
{
    stage_records made    = {.context = run->context,
                             .rules   = rules_of(run->params, said),
                             .said    = said,
                             .count   = run->in[RECORDS_POSITION].rows};
    assay_vec3   *normals = NULL;
    assay_status  status  = check_rows(run, said);
    if (status == ASSAY_OK && said) {
        status = check_gradients(run, made.rules.gradients);
    }
    status = status ? status : stage_unit_vectors(run, RECORDS_NORMAL, 0, &normals);
    if (status == ASSAY_OK) {
        made.records = assay_allocate(run->context, made.count, sizeof *made.records);
        status       = made.records ? take(run, said, normals, &made)
                                    : assay_fail_memory(run->context, "records");
    }
    assay_release(run->context, normals);
    if (status != ASSAY_OK) {
        stage_records_close(&made);
        return status;
    }
    *records_out = made;
    return ASSAY_OK;
}

void stage_records_close(stage_records *records)
{
    if (records->context) {
        assay_octree_destroy(records->octree);
        assay_release(records->context, records->records);
    }
}

assay_status stage_records_store(const stage_records *records, assay_record_store **store_out)
{
    assay_vec3 low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_negate(low);
    for (size_t i = 0; i < records->count; i++) {
        low  = vec3_min(low, records->records[i].position);
        high = vec3_max(high, records->records[i].position);
    }
    assay_status status = assay_record_store_create(records->context, &records->rules, low, high,
                                                    ASSAY_INDEX_OCTREE, store_out);
    for (size_t i = 0; i < records->count && status == ASSAY_OK; i++) {
        status = assay_record_store_add(*store_out, &records->records[i]);
    }
    return status;
}

/* ---- what may contribute ---- */

static void enclose(assay_vec3 *low, assay_vec3 *high, assay_vec3 p)
{
    if (vec3_finite(p)) {
        *low  = vec3_min(*low, p);
        *high = vec3_max(*high, p);
    }
}

static double largest(assay_vec3 v) { return fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z)); }

assay_status stage_records_index(stage_records *records, const rounding *r, size_t count,
                                 const double *positions, double a)
{
    assay_vec3         low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_negate(low);
    assay_record_rules rules = records->rules;
    rules.a                  = fmax(rules.a, a);
    for (size_t i = 0; i < count; i++) {
        enclose(&low, &high, stage_vec3(positions + 3 * i));
    }
    records->coordinate = count > 0 && low.x <= high.x ? fmax(largest(low), largest(high)) : 0.0;
    /* Equal numbers are equal however they are rounded, unless they were so when they were stored
     * with fewer digits than the candidate computes with. */
    records->exact = r->given <= r->u;
    for (size_t i = 0; i < records->count; i++) {
        enclose(&low, &high, records->records[i].position);
    }
    assay_status status = assay_octree_create(records->context, low, high, &records->octree);
    for (size_t i = 0; i < records->count && status == ASSAY_OK; i++) {
        const double reach =
            record_reach_bound(r, &records->records[i], &rules, records->coordinate);
        status = assay_octree_add(records->octree, records->records[i].position, reach);
    }
    return status;
}

static int ascending(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Called by workers: without a message. */
assay_status stage_records_near(const stage_records *records, assay_octree_walk *walk,
                                assay_vec3 position, stage_candidates *found)
{
    found->count = 0;
    assay_octree_walk_about(walk, records->octree, position);
    uint32_t number = assay_octree_walk_next(walk);
    for (; number != ASSAY_OCTREE_END; number = assay_octree_walk_next(walk)) {
        void *grown = found->items;
        if (assay_grow(records->context, &grown, &found->capacity, found->count + 1,
                       sizeof *found->items) != ASSAY_OK) {
            return ASSAY_ERR_MEMORY;
        }
        found->items                 = grown;
        found->items[found->count++] = number;
    }
    if (found->count > 1) {
        qsort(found->items, found->count, sizeof *found->items, ascending);
    }
    return ASSAY_OK;
}
