/* splat_batches.c - Invariant: ends never fall, and none is beyond the records. */
#include "oracle/stage/splat_batches.h"

#include "core/alloc.h"
#include "core/context.h"

bool splat_batches_are_stale(const stage_run *run, int ends, size_t records)
{
    const stage_table *t = &run->in[ends];
    return assay_params_bool(run->params, "neighbour_clamp") && t->values && t->rows > 0 &&
           t->values[t->rows - 1] < (double)records;
}

assay_status splat_batches_last_end(const stage_run *run, int ends, size_t records,
                                    uint32_t *end_out)
{
    const stage_table *t   = &run->in[ends];
    const double       end = t->values && t->rows > 0 ? t->values[t->rows - 1] : (double)records;
    if (!(end >= 0.0 && end <= (double)records)) {
        return stage_fail_value(run, ends, t->rows - 1, 0, "not a number of records");
    }
    *end_out = (uint32_t)end;
    return ASSAY_OK;
}

static assay_status read(stage_run *run, int input, size_t records, splat_batch *batches,
                         size_t *count)
{
    const stage_table *ends    = &run->in[input];
    const size_t       rows    = ends->values ? ends->rows : 1;
    const double       splat_a = assay_params_real(run->params, "splat_a");
    const bool         twice   = assay_params_choice(run->params, "variant") == 1;
    const bool         shrinks = assay_params_bool(run->params, "neighbour_clamp");
    const bool         stale   = splat_batches_are_stale(run, input, records);
    double             before  = 0.0;
    for (size_t k = 0; k < rows; k++) {
        const double end  = ends->values ? ends->values[k] : (double)records;
        const bool   last = k + 1 == rows;
        if (!(end >= before && end <= (double)records && end == assay_floor(end))) {
            return stage_fail_value(run, input, k, 0,
                                    "not a number of records, no less than the one before");
        }
        before = end;
        if (!stale && (last || !shrinks)) {
            batches[(*count)++] = (splat_batch){
                .number = (int)k,
                .old    = last && twice && ends->values ? (uint32_t)ends->values[0] : 0,
                .end    = (uint32_t)end,
                .a      = last && splat_a > 0.0 ? splat_a : assay_params_real(run->params, "a")};
        }
    }
    return ASSAY_OK;
}

assay_status splat_batches_read(stage_run *run, int ends, size_t records, splat_batch **batches_out,
                                size_t *count_out)
{
    const size_t most    = run->in[ends].values ? run->in[ends].rows : 1;
    size_t       count   = 0;
    splat_batch *batches = assay_allocate(run->context, most, sizeof *batches);
    if (!batches) {
        return assay_fail_memory(run->context, "batches");
    }
    const assay_status status = read(run, ends, records, batches, &count);
    if (status != ASSAY_OK) {
        assay_release(run->context, batches);
        return status;
    }
    *batches_out = batches;
    *count_out   = count;
    return ASSAY_OK;
}
