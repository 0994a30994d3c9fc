/* noise_model.c - views of the variance, one of which is not too small where it matters.
 *
 * Invariant: each is an unbiased estimate, or one that is too large, where its assumption holds; a
 * test asks all of them, so that neither the image that saw a rare event nor the one that missed it
 * makes a difference look surer than it is.
 *
 * Why that holds on both sides.  Of a sum of non-negative samples, the lower tail is no heavier
 * than that of a normal distribution with their second moment [maurer03]; so a mean that misses
 * rare events is judged rightly once the variance is right, and that is known from the image that
 * has more samples, or from pixels near there.  The upper tail is the heavy one, but what makes the
 * mean large makes its own variance large as well: one sample that outweighs all others gives
 * t = 1. */
#include "oracle/image/noise_model.h"

#include "core/alloc.h"
#include "core/context.h"
#include "math/select.h"
#include "oracle/image/student.h"

/* Of the whole image's tiles, one in so many is left out, the noisiest: few fireflies shall not
 * decide what all are judged by. */
enum { TRIM = 100, NEIGHBOURS = 9 };

typedef enum { CANDIDATE, REFERENCE, SQUARES } quantity;

static double value_of(const assay_noisy_sums *sums, quantity q)
{
    return q == CANDIDATE   ? sums->candidate_variance
           : q == REFERENCE ? sums->reference_variance
                            : fmax(0.0, sums->squares - sums->reference_variance);
}

/* Sum of tops over sum of bottoms of all tiles, but for those where the top is largest. */
static double whole_ratio(const assay_tile_level *tiles, quantity top, quantity bottom,
                          double *scratch)
{
    for (size_t i = 0; i < tiles->count; i++) {
        scratch[i] = value_of(&tiles->sums[i], top);
    }
    const double limit =
        assay_select(scratch, tiles->count, tiles->count - 1 - tiles->count / TRIM);
    double tops = 0.0, bottoms = 0.0;
    for (size_t i = 0; i < tiles->count; i++) {
        if (value_of(&tiles->sums[i], top) <= limit) {
            tops += top == SQUARES ? tiles->sums[i].squares - tiles->sums[i].reference_variance
                                   : value_of(&tiles->sums[i], top);
            bottoms += value_of(&tiles->sums[i], bottom);
        }
    }
    return tops > 0.0 && bottoms > 0.0 ? tops / bottoms : 0.0;
}

/* ---- near a tile ---- */

/* Mean without the largest, where there are enough: a single firefly shall not blind the tiles
 * around it. */
static double mean_without_largest(const double *values, int count)
{
    double sum = 0.0, largest = 0.0;
    for (int i = 0; i < count; i++) {
        sum += values[i];
        largest = fmax(largest, values[i]);
    }
    return count > 3 ? (sum - largest) / (count - 1) : count > 0 ? sum / count : 0.0;
}

static double mean_of(const double *values, int count)
{
    double sum = 0.0;
    for (int i = 0; i < count; i++) {
        sum += values[i];
    }
    return sum / count;
}

static double ratio(double top, double bottom) { return bottom > 0.0 ? top / bottom : 0.0; }

/* What is listed of each tile around. */
enum { UP, DOWN, CANDIDATE_USUAL, REFERENCE_USUAL, CANDIDATE_EVENT, REFERENCE_EVENT, LOCALS };

static void list_tile(const assay_noisy_sums *s, int at, double lists[LOCALS][NEIGHBOURS])
{
    lists[UP][at]              = ratio(s->candidate_variance, s->reference_variance);
    lists[DOWN][at]            = ratio(s->reference_variance, s->candidate_variance);
    lists[CANDIDATE_USUAL][at] = s->candidate_variance / s->pixels;
    lists[REFERENCE_USUAL][at] = s->reference_variance / s->pixels;
    lists[CANDIDATE_EVENT][at] = ratio(s->candidate_variance, s->candidate);
    lists[REFERENCE_EVENT][at] = ratio(s->reference_variance, s->reference);
}

/* Of the smallest tiles, which have the fewest samples, the noisiest counts for events, too. */
static assay_local_noise look_around(const assay_tile_level *tiles, int x, int y, bool smallest)
{
    double (*const event)(const double *values, int count) =
        smallest ? mean_of : mean_without_largest;
    double lists[LOCALS][NEIGHBOURS];
    int    count = 0;
    for (int v = y - 1; v <= y + 1; v++) {
        for (int u = x - 1; u <= x + 1; u++) {
            if (u >= 0 && v >= 0 && u < tiles->columns && v < tiles->rows) {
                list_tile(&tiles->sums[(size_t)v * (size_t)tiles->columns + (size_t)u], count++,
                          lists);
            }
        }
    }
    return (assay_local_noise){mean_without_largest(lists[UP], count),
                               mean_without_largest(lists[DOWN], count),
                               mean_without_largest(lists[CANDIDATE_USUAL], count),
                               mean_without_largest(lists[REFERENCE_USUAL], count),
                               event(lists[CANDIDATE_EVENT], count),
                               event(lists[REFERENCE_EVENT], count)};
}

/* Rare samples carry about the same light wherever they are found: variance goes with light. */
static void fill_in_light(assay_noisy_sums *s, double candidate_event, double reference_event)
{
    s->by_reference_light = s->reference_variance + candidate_event * fmax(0.0, s->reference);
    s->by_candidate_light = s->candidate_variance + reference_event * fmax(0.0, s->candidate);
}

static void fill_in(assay_noisy_sums *s, const assay_local_noise *local)
{
    const double up = 1.0 + local->up, down = 1.0 + local->down;
    s->by_reference        = up * s->reference_variance;
    s->by_reference_spread = up * up * s->reference_spread;
    s->by_candidate        = down * s->candidate_variance;
    s->by_candidate_spread = down * down * s->candidate_spread;
    fill_in_light(s, local->candidate_event, local->reference_event);
}

/* Of one estimator variances are as numbers of samples are, whatever either image has seen. */
static void take_counts(const assay_noisy_sums *s, assay_local_noise *local)
{
    local->up   = fmax(local->up, ratio(s->reference_samples, s->candidate_samples));
    local->down = fmax(local->down, ratio(s->candidate_samples, s->reference_samples));
}

static void fit(assay_tile_level *tiles, assay_noise_model_kind kind, double *scratch,
                assay_noise_model *model)
{
    double up = 0.0, down = 0.0;
    if (kind == ASSAY_NOISE_MODEL_ALONE) {
        up = whole_ratio(tiles, SQUARES, REFERENCE, scratch);
    } else if (kind == ASSAY_NOISE_MODEL_BOTH || kind == ASSAY_NOISE_MODEL_COUNTED) {
        up   = whole_ratio(tiles, CANDIDATE, REFERENCE, scratch);
        down = whole_ratio(tiles, REFERENCE, CANDIDATE, scratch);
    }
    for (size_t i = 0; i < tiles->count; i++) {
        assay_local_noise local = look_around(tiles, (int)(i % (size_t)tiles->columns),
                                              (int)(i / (size_t)tiles->columns), true);
        local.up                = fmax(local.up, up);
        local.down              = fmax(local.down, down);
        if (kind == ASSAY_NOISE_MODEL_COUNTED) {
            take_counts(&tiles->sums[i], &local);
        }
        model->tiles[i] = local;
    }
    for (size_t i = 0; i < tiles->count; i++) {
        fill_in(&tiles->sums[i], &model->tiles[i]);
    }
}

assay_status assay_noise_model_fit(assay_context *context, assay_tile_level *tiles,
                                   assay_noise_model_kind kind, assay_noise_model *model_out)
{
    assay_noise_model model   = {.context = context,
                                 .tiles = assay_allocate(context, tiles->count, sizeof *model.tiles),
                                 .side  = tiles->side,
                                 .columns = tiles->columns,
                                 .alone   = kind == ASSAY_NOISE_MODEL_ALONE};
    double           *scratch = assay_allocate(context, tiles->count, sizeof *scratch);
    const bool        ok      = model.tiles && scratch;
    if (ok) {
        fit(tiles, kind, scratch, &model);
        *model_out = model;
    } else {
        assay_release(context, model.tiles);
    }
    assay_release(context, scratch);
    return ok ? ASSAY_OK : assay_fail_memory(context, "the noise of tiles");
}

void assay_noise_model_light(assay_tile_sums *sums)
{
    for (int l = 1; l < sums->level_count; l++) {
        const assay_tile_level *level = &sums->levels[l];
        for (size_t i = 0; i < level->count; i++) {
            const assay_local_noise local = look_around(level, (int)(i % (size_t)level->columns),
                                                        (int)(i / (size_t)level->columns), false);
            fill_in_light(&level->sums[i], local.candidate_event, local.reference_event);
        }
    }
    assay_noisy_sums *whole = &sums->whole;
    fill_in_light(whole, ratio(whole->candidate_variance, whole->candidate),
                  ratio(whole->reference_variance, whole->reference));
}

void assay_noise_model_release(assay_noise_model *model)
{
    if (model->context) {
        assay_release(model->context, model->tiles);
        model->tiles = NULL;
    }
}

/* ---- asked ---- */

/* Satterthwaite's degrees of freedom of a sum of estimated variances [satterthwaite46]. */
static void add_view(assay_noise *noise, double variance, double spread)
{
    assay_noise_add(noise, variance, spread > 0.0 ? variance * variance / spread : ASSAY_NORMAL);
}

assay_noise assay_noise_of_region(const assay_noise_model *model, const assay_noisy_sums *sums,
                                  double design)
{
    assay_noise noise = {0};
    add_view(&noise, design * (sums->candidate_variance + sums->reference_variance),
             design * design * (sums->candidate_spread + sums->reference_spread));
    add_view(&noise, design * sums->by_reference, design * design * sums->by_reference_spread);
    add_view(&noise, design * sums->by_candidate, design * design * sums->by_candidate_spread);
    assay_noise_add(&noise, design * sums->by_reference_light, ASSAY_NORMAL);
    assay_noise_add(&noise, design * sums->by_candidate_light, ASSAY_NORMAL);
    if (model->alone) {
        /* Self-normalised: of symmetric noise the tail is below the normal one's bound [efron69].
         */
        assay_noise_add(&noise, design * sums->squares, ASSAY_NORMAL);
    }
    return noise;
}

const assay_local_noise *assay_noise_near(const assay_noise_model *model, int x, int y)
{
    return &model->tiles[(size_t)(y / model->side) * (size_t)model->columns +
                         (size_t)(x / model->side)];
}

/* Degrees of freedom of the sum of two variances that are at least those of the one with fewer
 * [mickey66]: a single pixel's own estimate would err to the wrong side far out in the tail. */
static double fewer_degrees(const assay_noisy_pair *pair, size_t pixel)
{
    const double c =
        pair->candidate.variance ? assay_noisy_degrees(&pair->candidate, pixel) : ASSAY_NORMAL;
    const double r =
        pair->reference.variance ? assay_noisy_degrees(&pair->reference, pixel) : ASSAY_NORMAL;
    return fmin(c, r);
}

assay_noise assay_noise_of_pixel(const assay_noise_model *model, const assay_noisy_pair *pair,
                                 size_t pixel)
{
    const size_t             width = (size_t)pair->width;
    const assay_local_noise *local =
        assay_noise_near(model, (int)(pixel % width), (int)(pixel / width));
    assay_noisy_sums s     = assay_noisy_pixel(pair, pixel);
    assay_noise      noise = {0};
    fill_in(&s, local);
    assay_noise_add(&noise, s.candidate_variance + s.reference_variance,
                    fewer_degrees(pair, pixel));
    add_view(&noise, s.by_reference, s.by_reference_spread);
    add_view(&noise, s.by_candidate, s.by_candidate_spread);
    assay_noise_add(&noise, s.reference_variance + local->candidate, ASSAY_NORMAL);
    assay_noise_add(&noise, s.candidate_variance + local->reference, ASSAY_NORMAL);
    assay_noise_add(&noise, s.by_reference_light, ASSAY_NORMAL);
    assay_noise_add(&noise, s.by_candidate_light, ASSAY_NORMAL);
    if (pair->candidate.variance && pair->reference.variance) {
        noise.candidate_samples = fmax(s.candidate_samples, 2.0);
        noise.reference_samples = fmax(s.reference_samples, 2.0);
    }
    return noise;
}
