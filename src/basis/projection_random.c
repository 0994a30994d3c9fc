/* projection_random.c - coefficients by Monte Carlo.
 *
 * A coefficient is the mean of f / pdf times what it is analysed with; its variance is the sample
 * variance of just these numbers over their count, by Welford's recurrence [welford62].  Where
 * coefficients come out of a linear system (LSOSH), the system is solved for each sample, so that
 * the variance is that of the coefficients and not of something before them.
 *
 * Invariant: sample k is drawn from stream k and samples are added in order. */
#include "basis/analysis.h"
#include "basis/projection.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/random.h"

enum { PROGRESS_STEP = 4096 };

typedef struct {
    assay_context  *context;
    assay_analysis *analysis;
    size_t          channels, count;
    uint64_t        taken;
    double         *functions; /* count                    */
    double         *term;      /* count: of one channel    */
    double         *values;    /* channels                 */
    double         *mean, *m2; /* channels rows of count   */
} estimate;

static assay_status estimate_open(estimate *e, const assay_basis *basis, assay_context *context,
                                  int channels)
{
    const assay_status checked = assay_projection_check_channels(context, channels);
    if (checked != ASSAY_OK) {
        return checked;
    }
    *e = (estimate){
        .context = context, .channels = (size_t)channels, .count = assay_basis_count(basis)};
    const assay_status status = assay_analysis_create(context, basis, true, &e->analysis);
    if (status != ASSAY_OK) {
        return status;
    }
    e->functions = assay_allocate(context, e->count, sizeof(double));
    e->term      = assay_allocate(context, e->count, sizeof(double));
    e->values    = assay_allocate(context, e->channels, sizeof(double));
    e->mean      = assay_allocate(context, e->channels * e->count, sizeof(double));
    e->m2        = assay_allocate(context, e->channels * e->count, sizeof(double));
    return e->functions && e->term && e->values && e->mean && e->m2
               ? ASSAY_OK
               : assay_fail_memory(context, "a projection");
}

static void estimate_close(estimate *e)
{
    assay_analysis_destroy(e->analysis);
    assay_release(e->context, e->functions);
    assay_release(e->context, e->term);
    assay_release(e->context, e->values);
    assay_release(e->context, e->mean);
    assay_release(e->context, e->m2);
}

/* functions: already evaluated; zeros for a sample outside the domain. */
static void add_sample(estimate *e, const double *values, double pdf)
{
    e->taken++;
    for (size_t c = 0; c < e->channels; c++) {
        const double value = values[c] / pdf;
        for (size_t k = 0; k < e->count; k++) {
            e->term[k] = value * e->functions[k];
        }
        assay_analysis_finish(e->analysis, e->term);
        double *mean = e->mean + c * e->count, *m2 = e->m2 + c * e->count;
        for (size_t k = 0; k < e->count; k++) {
            const double delta = e->term[k] - mean[k];
            mean[k] += delta / (double)e->taken;
            m2[k] += delta * (e->term[k] - mean[k]);
        }
    }
}

static void estimate_write(const estimate *e, double *coefficients_out, double *variances_out)
{
    const double n = (double)e->taken;
    for (size_t k = 0; k < e->channels * e->count; k++) {
        coefficients_out[k] = e->mean[k];
        variances_out[k]    = e->m2[k] / (n * (n - 1.0));
    }
}

static assay_vec3 draw(bool hemisphere, uint64_t seed, uint64_t sample)
{
    assay_random       random = assay_random_start(seed, ASSAY_STAGE_PROJECTION, sample, 0);
    const double       u      = assay_random_next(&random);
    const double       v      = assay_random_next(&random);
    const double       z      = hemisphere ? u : 2.0 * u - 1.0;
    const double       sine   = sqrt((1.0 - z) * (1.0 + z));
    const assay_sincos phi    = assay_sincos_turns(v);
    return (assay_vec3){sine * phi.cos, sine * phi.sin, z};
}

static assay_status take_random(estimate *e, const assay_basis *basis, assay_direction_function f,
                                void *user, uint64_t samples, uint64_t seed)
{
    const bool   hemisphere = assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis));
    const double pdf        = (hemisphere ? 0.5 : 0.25) * ASSAY_INV_PI;
    for (uint64_t s = 0; s < samples; s++) {
        assay_status status =
            s % PROGRESS_STEP == 0 ? assay_progress(e->context, "project", s, samples) : ASSAY_OK;
        if (status != ASSAY_OK) {
            return status;
        }
        const assay_vec3 d = draw(hemisphere, seed, s);
        f(user, d, e->values);
        status = assay_projection_check(e->context, e->values, e->channels, d);
        if (status == ASSAY_OK) {
            status = assay_analysis_evaluate(e->analysis, d, e->functions);
        }
        if (status != ASSAY_OK) {
            return status;
        }
        add_sample(e, e->values, pdf);
    }
    return ASSAY_OK;
}

static assay_status check_samples(assay_context *context, uint64_t samples)
{
    return samples >= 2 && samples < (uint64_t)1 << 56
               ? ASSAY_OK
               : assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "%llu samples: a variance needs two at least, and fewer than 2^56",
                            (unsigned long long)samples);
}

assay_status assay_basis_project_random(const assay_basis *basis, assay_context *context,
                                        assay_direction_function f, void *user, int channels,
                                        uint64_t samples, uint64_t seed, double *coefficients_out,
                                        double *variances_out)
{
    assay_status status = check_samples(context, samples);
    if (status != ASSAY_OK) {
        return status;
    }
    estimate e = {.context = context};
    status     = estimate_open(&e, basis, context, channels);
    if (status == ASSAY_OK) {
        status = take_random(&e, basis, f, user, samples, seed);
    }
    if (status == ASSAY_OK) {
        estimate_write(&e, coefficients_out, variances_out);
    }
    estimate_close(&e);
    return status;
}

/* A given direction is checked and brought to unit length, as assay_basis_evaluate does it. */
static assay_status check_sample(assay_context *context, size_t index, double pdf, assay_vec3 *d)
{
    const double square = d->x * d->x + d->y * d->y + d->z * d->z;
    if (!(fabs(square - 1.0) <= ASSAY_BASIS_UNIT_TOLERANCE)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN,
                          "sample %zu: the direction (%.6g, %.6g, %.6g) is not of unit length",
                          index, d->x, d->y, d->z);
    }
    if (!(pdf > 0.0) || isinf(pdf)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN,
                          "sample %zu: its density is %g; it must be finite and > 0", index, pdf);
    }
    const double length = sqrt(square);
    *d                  = (assay_vec3){d->x / length, d->y / length, d->z / length};
    return ASSAY_OK;
}

static assay_status take_samples(estimate *e, const assay_basis *basis, size_t count,
                                 const assay_vec3 *directions, const double *pdf,
                                 const double *values)
{
    const bool hemisphere = assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis));
    for (size_t s = 0; s < count; s++) {
        assay_vec3    d      = directions[s];
        const double *sample = values + s * e->channels;
        assay_status  status = check_sample(e->context, s, pdf[s], &d);
        if (status == ASSAY_OK) {
            status = assay_projection_check(e->context, sample, e->channels, d);
        }
        if (status == ASSAY_OK && hemisphere && d.z < 0.0) {
            for (size_t k = 0; k < e->count; k++) {
                e->functions[k] = 0.0;
            }
        } else if (status == ASSAY_OK) {
            status = assay_analysis_evaluate(e->analysis, d, e->functions);
        }
        if (status != ASSAY_OK) {
            return status;
        }
        add_sample(e, sample, pdf[s]);
    }
    return ASSAY_OK;
}

assay_status assay_basis_project_samples(const assay_basis *basis, assay_context *context,
                                         size_t sample_count, const assay_vec3 *directions,
                                         const double *pdf, const double *values, int channels,
                                         double *coefficients_out, double *variances_out)
{
    assay_status status = check_samples(context, sample_count);
    if (status != ASSAY_OK) {
        return status;
    }
    estimate e = {.context = context};
    status     = estimate_open(&e, basis, context, channels);
    if (status == ASSAY_OK) {
        status = take_samples(&e, basis, sample_count, directions, pdf, values);
    }
    if (status == ASSAY_OK) {
        estimate_write(&e, coefficients_out, variances_out);
    }
    estimate_close(&e);
    return status;
}
