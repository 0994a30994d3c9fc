/* noise_model.c - a variance that is not too small where it matters.
 *
 * Invariant: every one of the three variances is an upper bound or an unbiased estimate where both
 * images are the same estimator, and the first is where they are not; the largest is taken, so that
 * neither the image that saw a rare event nor the one that missed it makes a difference look surer
 * than it is.
 *
 * Why that holds on both sides.  Of a sum of non-negative samples, the lower tail is no heavier
 * than that of a normal distribution with their second moment [maurer03]; so a mean that misses
 * rare events is judged rightly once the variance is right, and that is known from the image that
 * has more samples, or from the whole of the image.  The upper tail is the heavy one, but what
 * makes the mean large makes its own variance large as well: one sample that outweighs all others
 * gives t = 1. */
#include "oracle/noise_model.h"

#include "math/select.h"
#include "oracle/student.h"

/* Blocks with the largest ratio are left out, one in so many: few fireflies shall not decide what
 * the whole image is judged by. */
enum { TRIM = 100 };

/* sum of tops over sum of bottoms, but for the tiles where the top stands out. */
static double trimmed_ratio(const assay_noisy_sums *tiles, size_t count, bool up, double *scratch)
{
    for (size_t i = 0; i < count; i++) {
        const double c = tiles[i].candidate_variance, r = tiles[i].reference_variance;
        scratch[i] = up ? c : r;
    }
    const size_t dropped = count / TRIM;
    const double limit   = assay_select(scratch, count, count - 1 - dropped);
    double       top = 0.0, bottom = 0.0;
    for (size_t i = 0; i < count; i++) {
        const double c = tiles[i].candidate_variance, r = tiles[i].reference_variance;
        if ((up ? c : r) <= limit) {
            top += up ? c : r;
            bottom += up ? r : c;
        }
    }
    return top > 0.0 && bottom > 0.0 ? top / bottom : 0.0;
}

/* What the differences have beyond the reference's noise, over that noise. */
static double ratio_of_squares(const assay_noisy_sums *tiles, size_t count, double *scratch)
{
    for (size_t i = 0; i < count; i++) {
        scratch[i] = tiles[i].squares;
    }
    const double limit = assay_select(scratch, count, count - 1 - count / TRIM);
    double       top = 0.0, bottom = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (tiles[i].squares <= limit) {
            top += tiles[i].squares - tiles[i].reference_variance;
            bottom += tiles[i].reference_variance;
        }
    }
    return top > 0.0 && bottom > 0.0 ? top / bottom : 0.0;
}

assay_noise_model assay_noise_model_fit(const assay_noisy_sums *tiles, size_t count, bool alone,
                                        double *scratch)
{
    assay_noise_model model = {.alone = alone, .design = 1.0};
    if (alone) {
        model.ratio_up = ratio_of_squares(tiles, count, scratch);
    } else {
        model.ratio_up   = trimmed_ratio(tiles, count, true, scratch);
        model.ratio_down = trimmed_ratio(tiles, count, false, scratch);
    }
    return model;
}

static double degrees(double variance, double spread)
{
    return spread > 0.0 ? variance * variance / spread : ASSAY_NORMAL;
}

static void take_larger(assay_noise *noise, double variance, double with_degrees)
{
    if (variance > noise->variance) {
        *noise = (assay_noise){variance, with_degrees};
    }
}

assay_noise assay_noise_of(const assay_noise_model *model, const assay_noisy_sums *sums)
{
    const double c = sums->candidate_variance, r = sums->reference_variance;
    assay_noise  noise = {c + r, degrees(c + r, sums->candidate_spread + sums->reference_spread)};
    take_larger(&noise, (1.0 + model->ratio_up) * r, degrees(r, sums->reference_spread));
    take_larger(&noise, (1.0 + model->ratio_down) * c, degrees(c, sums->candidate_spread));
    if (model->alone) {
        /* Self-normalised: sub-Gaussian whatever the symmetric noise is [efron69]. */
        take_larger(&noise, sums->squares, ASSAY_NORMAL);
    }
    noise.variance *= model->design;
    return noise;
}

double assay_noise_t(const assay_noisy_sums *sums, assay_noise noise)
{
    const double size = fabs(sums->difference) - sums->rounding;
    if (!(size > 0.0)) {
        return 0.0;
    }
    return copysign(noise.variance > 0.0 ? size / sqrt(noise.variance) : INFINITY,
                    sums->difference);
}
