/* noise.c - the largest p over the views.
 *
 * Invariant: every view has a variance above 0; the bound is the place where the largest p crosses
 * the level, since a view's p falls with the difference. */
#include "oracle/image/noise.h"

#include <assert.h>
#include <stdint.h>

#include "core/numerics.h"
#include "oracle/image/student.h"

void assay_noise_add(assay_noise *noise, double variance, double degrees)
{
    assert(noise->count < ASSAY_NOISE_VIEWS);
    if (variance > 0.0) {
        noise->views[noise->count++] = (assay_noise_view){variance, degrees};
    }
}

double assay_noise_variance(const assay_noise *noise)
{
    double largest = 0.0;
    for (int i = 0; i < noise->count; i++) {
        largest = fmax(largest, noise->views[i].variance);
    }
    return largest;
}

/* The least log p that so few samples can have: of all ways to share them out between the images at
 * most two are as far apart as those that are alike in each image, whatever the distribution.
 * Stops where it is below what was asked for.  (A path tracer's edge of a light is of that kind:
 * all samples of one image hit it, all of the other miss it, and neither has a variance.) */
static double least_log_p(const assay_noise *noise, double asked)
{
    const double few   = fmin(noise->candidate_samples, noise->reference_samples);
    const double many  = fmax(noise->candidate_samples, noise->reference_samples);
    double       least = assay_log(2.0);
    for (uint32_t k = 1; k <= few && least >= asked; k++) {
        least -= assay_log((many + k) / k);
    }
    return few > 0.0 ? fmin(least, 0.0) : -INFINITY;
}

double assay_noise_log_p(const assay_noise *noise, double size)
{
    if (!(size > 0.0)) {
        return 0.0;
    }
    double log_p = -INFINITY;
    for (int i = 0; i < noise->count; i++) {
        const assay_noise_view *v = &noise->views[i];
        log_p = fmax(log_p, assay_student_log_p(size / sqrt(v->variance), v->degrees));
    }
    return fmax(log_p, least_log_p(noise, log_p));
}

/* Half of a two-sided p, or all but half. */
static double one_sided(double t, double degrees)
{
    const double both = assay_student_log_p(t, degrees);
    return t > 0.0 ? both - assay_log(2.0) : assay_log1p(-0.5 * assay_exp(both));
}

double assay_noise_log_p_one_sided(const assay_noise *noise, double size)
{
    double log_p = noise->count == 0 && size < 0.0 ? 0.0 : -INFINITY;
    for (int i = 0; i < noise->count; i++) {
        const assay_noise_view *v = &noise->views[i];
        log_p                     = fmax(log_p, one_sided(size / sqrt(v->variance), v->degrees));
    }
    return log_p;
}

double assay_noise_bound(const assay_noise *noise, assay_critical_values *critical,
                         assay_critical_values *power)
{
    double bound = least_log_p(noise, critical->log_p) > critical->log_p ? INFINITY : 0.0;
    for (int i = 0; i < noise->count; i++) {
        const assay_noise_view *v = &noise->views[i];
        double                  t = assay_critical_value(critical, v->degrees);
        t += power ? assay_critical_value(power, v->degrees) : 0.0;
        bound = fmax(bound, t * sqrt(v->variance));
    }
    return bound;
}
