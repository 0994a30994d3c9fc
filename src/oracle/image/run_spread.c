/* run_spread.c - sums of runs over tiles, compared with the sums of their pixels' variances.
 *
 * Invariant: a design effect is a ratio of two unbiased estimates of the same variance where pixels
 * are independent; it is taken over all tiles of a level, so it has count - 1 degrees of freedom a
 * tile, and is never taken below 1. */
#include "oracle/image/run_spread.h"

#include "core/alloc.h"
#include "core/context.h"

void assay_run_spread_pixels(const float *const *runs, int count, size_t pixels, float *mean_out,
                             float *variance_out)
{
    for (size_t i = 0; i < pixels; i++) {
        double mean = 0.0, squares = 0.0;
        for (int k = 0; k < count; k++) {
            const double delta = runs[k][i] - mean;
            mean += delta / (k + 1);
            squares += delta * (runs[k][i] - mean);
        }
        mean_out[i]     = (float)mean;
        variance_out[i] = (float)(squares / ((double)count * (count - 1)));
    }
}

/* Sums of one run over the tiles of a level: a run is taken for a candidate without variance. */
static assay_status sum_run(assay_context *context, const float *run, const assay_noisy_pair *pair,
                            int side, assay_tile_sums *sums_out)
{
    assay_noisy_pair one   = *pair;
    one.candidate.mean     = run;
    one.candidate.variance = NULL;
    assay_tile_sums sums;
    assay_status    status = assay_tile_sums_make(context, &one, side, &sums);
    if (status != ASSAY_OK) {
        return status;
    }
    status = assay_tile_sums_gather(&sums);
    if (status != ASSAY_OK) {
        assay_tile_sums_release(&sums);
        return status;
    }
    *sums_out = sums;
    return ASSAY_OK;
}

/* Adds a run's sum to Welford's recurrence. */
static void add_run(double sum, int before, double *mean, double *squares)
{
    const double delta = sum - *mean;
    *mean += delta / (before + 1);
    *squares += delta * (sum - *mean);
}

typedef struct {
    double *mean, *squares; /* of each tile of each level, then of the whole */
    size_t  count;
} tile_spread;

static void add_sums(const assay_tile_sums *sums, int before, tile_spread *spread)
{
    size_t at = 0;
    for (int l = 0; l < sums->level_count; l++) {
        for (size_t i = 0; i < sums->levels[l].count; i++, at++) {
            add_run(sums->levels[l].sums[i].candidate, before, &spread->mean[at],
                    &spread->squares[at]);
        }
    }
    add_run(sums->whole.candidate, before, &spread->mean[at], &spread->squares[at]);
}

static void conclude(const tile_spread *spread, int count, const assay_tile_sums *sums,
                     assay_run_spread *result)
{
    const double scale  = 1.0 / ((double)count * (count - 1));
    const double pixels = sums->whole.candidate_variance;
    double       design = 1.0;
    size_t       at     = 0;
    for (int l = 0; l < sums->level_count; l++) {
        double seen = 0.0;
        for (size_t i = 0; i < sums->levels[l].count; i++, at++) {
            seen += spread->squares[at] * scale;
        }
        design            = pixels > 0.0 ? fmax(1.0, seen / pixels) : 1.0;
        result->design[l] = design;
    }
    for (int l = sums->level_count; l <= ASSAY_TILE_LEVELS; l++) {
        result->design[l] = design;
    }
    /* Noise that hangs together over tiles may do so over the image, and of that there are but
     * `count` independent sums. */
    const double whole = spread->squares[at] * scale;
    if (design > 1.5 || whole > 6.0 * pixels) {
        result->whole_variance = fmax(whole, design * pixels);
        result->whole_degrees  = count - 1;
    }
}

assay_status assay_run_spread_make(assay_context *context, const float *const *runs, int count,
                                   const assay_noisy_pair *pair, const assay_tile_sums *sums,
                                   assay_run_spread *spread_out)
{
    tile_spread spread = {.count = 1};
    for (int l = 0; l < sums->level_count; l++) {
        spread.count += sums->levels[l].count;
    }
    double *numbers = assay_allocate(context, 2 * spread.count, sizeof *numbers);
    if (!numbers) {
        return assay_fail_memory(context, "the spread of runs");
    }
    spread.mean         = numbers;
    spread.squares      = numbers + spread.count;
    assay_status status = ASSAY_OK;
    for (int k = 0; status == ASSAY_OK && k < count; k++) {
        assay_tile_sums one;
        status = sum_run(context, runs[k], pair, sums->levels[0].side, &one);
        if (status == ASSAY_OK) {
            add_sums(&one, k, &spread);
            assay_tile_sums_release(&one);
        }
    }
    if (status == ASSAY_OK) {
        assay_run_spread result = {0};
        conclude(&spread, count, sums, &result);
        *spread_out = result;
    }
    assay_release(context, numbers);
    return status;
}
