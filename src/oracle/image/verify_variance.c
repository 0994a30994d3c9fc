/* verify_variance.c - a stated variance is believed by every test, and one that is too large makes
 * every test pass; so it is held against the differences.
 *
 * Invariant: nothing here changes a verdict.
 *
 * Of equal light E[d^2] is the sum of both variances, and a bias makes it larger; so the sum of d^2
 * over many pixels is far below only where the variances are too large, or the errors of both
 * images are not what independent samples have.  Sums over the whole image would be those of its
 * few fireflies, with a right variance (which hides a wrong one elsewhere) or by luck without a
 * difference (which sounds an alarm).  In a tile a firefly spoils that tile alone, and the median
 * of tiles is what most of them say.  A single pixel that outweighs its tile makes no false alarm
 * either: as a normal deviate its d^2 is below a quarter of its variance with a probability of
 * 0.38, as a number of rare events with at most 0.37 where it is a Poisson count of mean 1, so in
 * less than half of the tiles. */
#include "oracle/image/verify_variance.h"

#include <math.h>

#include "core/alloc.h"
#include "core/context.h"
#include "math/select.h"
#include "oracle/verdict/text_builder.h"
#include "oracle/verdict/verdict_data.h"

/* Right variances gave at most 1.3 (tests/oracle/test_verify_variance.c): far beyond chance, and
 * beyond what few tiles or mild stratification do. */
#define EXCESS_TOLD 4.0

enum { FEWEST_TILES = 4 };

assay_status assay_variance_excess(assay_context *context, const assay_tile_level *tiles,
                                   double *excess_out)
{
    size_t  noisy = 0;
    double *share = assay_allocate(context, tiles->count, sizeof *share);
    if (!share) {
        return assay_fail_memory(context, "the noise of tiles");
    }
    for (size_t i = 0; i < tiles->count; i++) {
        const assay_noisy_sums *s        = &tiles->sums[i];
        const double            variance = s->candidate_variance + s->reference_variance;
        if (variance > 0.0) {
            share[noisy++] = s->squares / variance;
        }
    }
    double excess = NAN;
    if (noisy >= FEWEST_TILES) {
        const double median = assay_select(share, noisy, noisy / 2);
        excess              = median > 0.0 ? 1.0 / median : (double)INFINITY;
    }
    assay_release(context, share);
    *excess_out = excess;
    return ASSAY_OK;
}

static void add_sentence(assay_text_builder *text, const char *names, double least)
{
    if (isinf(least)) {
        assay_text_add(text, "There are no differences in %s, but the variances expect some",
                       names);
    } else {
        assay_text_add(text,
                       "Squared differences in %s are %.*f times smaller than the variances say",
                       names, least < 10.0 ? 1 : 0, least);
    }
    assay_text_add(text, ": the variances are too large, or samples are of low discrepancy, or the "
                         "same in both images; a bias may hide in it.");
}

static assay_status set_sentence(assay_verdict *verdict, const char *names, double least)
{
    char              *sentence = NULL;
    assay_text_builder text     = assay_text_start(verdict->context);
    add_sentence(&text, names, least);
    assay_status status = assay_text_finish(&text, "what variances say", &sentence);
    status              = status ? status : assay_verdict_set(verdict, "variances", sentence);
    assay_text_destroy(verdict->context, sentence);
    return status;
}

assay_status assay_verify_variances(assay_verdict *verdict, const assay_verify_channel *channels,
                                    int count)
{
    char              *names  = NULL;
    double             least  = INFINITY;
    int                told   = 0;
    assay_status       status = ASSAY_OK;
    assay_text_builder text   = assay_text_start(verdict->context);
    for (int i = 0; status == ASSAY_OK && i < count; i++) {
        double excess = NAN;
        if (!channels[i].problem) {
            status = assay_variance_excess(verdict->context, &channels[i].sums.levels[0], &excess);
        }
        if (excess > EXCESS_TOLD) {
            assay_text_add(&text, "%s%s", told++ > 0 ? ", " : "", channels[i].name);
            least = fmin(least, excess);
        }
    }
    const assay_status made = assay_text_finish(&text, "names of channels", &names);
    status                  = status ? status : made;
    if (status == ASSAY_OK && told > 0) {
        status = set_sentence(verdict, names, least);
    }
    assay_text_destroy(verdict->context, names);
    return status;
}
