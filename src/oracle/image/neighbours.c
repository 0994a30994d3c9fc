/* neighbours.c - Invariant: independent noise, of either image and of whatever distribution, adds
 * nothing but chance to either correlation.
 *
 * A bias makes signs agree, too, but over wide regions: at four pixels nearly as often as at one.
 * Noise that is shared reaches no farther than the filter, or a record.  Signs, since a firefly
 * counts no more than any other pixel in them. */
#include "oracle/image/neighbours.h"

enum { FAR = 4 };

/* Least excess that is worth a word, and in standard deviations of 2 / pairs. */
static const double LEAST = 0.03, DEVIATIONS = 3.0;

static double sign_at(const assay_noisy_pair *pair, size_t i)
{
    const double d = (double)pair->candidate.mean[i] - (double)pair->reference.mean[i];
    return d > 0.0 ? 1.0 : d < 0.0 ? -1.0 : 0.0;
}

static double correlation(const assay_noisy_pair *pair, size_t distance, double *pairs_out)
{
    const size_t width = (size_t)pair->width, height = (size_t)pair->height;
    double       products = 0.0, pairs = 0.0;
    for (size_t y = 0; y < height; y++) {
        for (size_t x = 0; x < width; x++) {
            const size_t i    = y * width + x;
            const double here = sign_at(pair, i);
            if (x + distance < width) {
                products += here * sign_at(pair, i + distance);
                pairs += 1.0;
            }
            if (y + distance < height) {
                products += here * sign_at(pair, i + distance * width);
                pairs += 1.0;
            }
        }
    }
    *pairs_out = pairs;
    return pairs > 0.0 ? products / pairs : 0.0;
}

assay_neighbours assay_neighbours_of(const assay_noisy_pair *pair)
{
    assay_neighbours n = {.near = correlation(pair, 1, &n.pairs)};
    n.far              = correlation(pair, FAR, &n.pairs);
    return n;
}

bool assay_neighbours_share_noise(const assay_neighbours *n)
{
    const double chance = DEVIATIONS * sqrt(2.0 / n->pairs);
    return n->pairs > 0.0 && n->near - n->far > fmax(LEAST, chance);
}
