/* projection.c - coefficients by quadrature.
 *
 * Invariant: sums run over the sectors of a ring, then over the rings, in index order; f is called
 * once a node, from one thread, in that order. */
#include "basis/projection.h"
#include "basis/analysis.h"
#include "basis/sphere_rule.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

typedef struct {
    assay_context           *context;
    assay_direction_function f;
    void                    *user;
    size_t                   channels, count;
    assay_analysis          *analysis;
    assay_sphere_rule        rule;
    double                  *values;     /* channels                   */
    double                  *functions;  /* count                      */
    double                  *ring, *sum; /* channels rows of count    */
} projection;

assay_status assay_projection_check(assay_context *context, const double *values, size_t channels,
                                    assay_vec3 d)
{
    for (size_t c = 0; c < channels; c++) {
        if (!isfinite(values[c])) {
            return assay_fail(context, ASSAY_ERR_DOMAIN,
                              "the function to be projected is %g at the direction (%.6g, %.6g, "
                              "%.6g); it must be finite",
                              values[c], d.x, d.y, d.z);
        }
    }
    return ASSAY_OK;
}

static assay_status add_node(projection *p, int i, int j)
{
    const assay_vec3 d = assay_sphere_rule_direction(&p->rule, i, j);
    p->f(p->user, d, p->values);
    assay_status status = assay_projection_check(p->context, p->values, p->channels, d);
    if (status == ASSAY_OK) {
        status = assay_analysis_evaluate(p->analysis, d, p->functions);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    for (size_t c = 0; c < p->channels; c++) {
        const double value = p->values[c];
        double      *ring  = p->ring + c * p->count;
        for (size_t k = 0; k < p->count; k++) {
            ring[k] += value * p->functions[k];
        }
    }
    return ASSAY_OK;
}

static assay_status integrate(projection *p)
{
    const size_t total = p->channels * p->count;
    for (int i = 0; i < p->rule.rings; i++) {
        const assay_status going =
            assay_progress(p->context, "project", (uint64_t)i, (uint64_t)p->rule.rings);
        if (going != ASSAY_OK) {
            return going;
        }
        for (size_t k = 0; k < total; k++) {
            p->ring[k] = 0.0;
        }
        for (int j = 0; j < p->rule.sectors; j++) {
            const assay_status status = add_node(p, i, j);
            if (status != ASSAY_OK) {
                return status;
            }
        }
        for (size_t k = 0; k < total; k++) {
            p->sum[k] += p->rule.weight[i] * p->ring[k];
        }
    }
    return ASSAY_OK;
}

static assay_status prepare(projection *p, const assay_basis *basis, int theta_nodes, int phi_nodes)
{
    const bool   hemisphere = assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis));
    assay_status status =
        assay_sphere_rule_create(p->context, hemisphere, theta_nodes, phi_nodes, &p->rule);
    if (status == ASSAY_OK) {
        status = assay_analysis_create(p->context, basis, true, &p->analysis);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    p->values    = assay_allocate(p->context, p->channels, sizeof(double));
    p->functions = assay_allocate(p->context, p->count, sizeof(double));
    p->ring      = assay_allocate(p->context, p->channels * p->count, sizeof(double));
    p->sum       = assay_allocate(p->context, p->channels * p->count, sizeof(double));
    return p->values && p->functions && p->ring && p->sum
               ? ASSAY_OK
               : assay_fail_memory(p->context, "a projection");
}

assay_status assay_projection_check_channels(assay_context *context, int channels)
{
    return channels >= 1 && channels <= ASSAY_PROJECTION_MAX_CHANNELS
               ? ASSAY_OK
               : assay_fail(context, ASSAY_ERR_ARGUMENT,
                            "%d channels to be projected: from 1 to %d are possible", channels,
                            ASSAY_PROJECTION_MAX_CHANNELS);
}

assay_status assay_basis_project(const assay_basis *basis, assay_context *context,
                                 assay_direction_function f, void *user, int channels,
                                 int theta_nodes, int phi_nodes, double *coefficients_out)
{
    assay_status status = assay_projection_check_channels(context, channels);
    if (status != ASSAY_OK) {
        return status;
    }
    projection p   = {.context  = context,
                      .f        = f,
                      .user     = user,
                      .channels = (size_t)channels,
                      .count    = assay_basis_count(basis)};
    p.rule.context = context;
    status         = prepare(&p, basis, theta_nodes, phi_nodes);
    if (status == ASSAY_OK) {
        status = integrate(&p);
    }
    for (size_t c = 0; c < p.channels && status == ASSAY_OK; c++) {
        assay_analysis_finish(p.analysis, p.sum + c * p.count);
    }
    for (size_t k = 0; k < p.channels * p.count && status == ASSAY_OK; k++) {
        coefficients_out[k] = p.sum[k];
    }
    assay_sphere_rule_destroy(&p.rule);
    assay_analysis_destroy(p.analysis);
    assay_release(context, p.values);
    assay_release(context, p.functions);
    assay_release(context, p.ring);
    assay_release(context, p.sum);
    return status;
}
