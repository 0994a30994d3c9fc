/* accuracy.c - the share of a lobe's energy that a basis captures, [gautron06] eq. 3.32.
 *
 * Made well defined: the sum runs over l < n; SH are integrated over the sphere with the lobe 0
 * below the horizon; ESH and LSOSH live on the hemisphere alone, LSOSH's numerator is the energy of
 * the best fit (which needs no solution of a linear system: it is the energy in an orthonormal
 * basis of the same space); Makhotkin's plain functions use their weight in numerator and
 * denominator.
 *
 * Nodes: lobe_rule.c.
 *
 * Invariant: numerator and denominator come from the same nodes, doubled until no accuracy moves by
 * more than TOLERANCE. */
#include "basis/analysis.h"
#include "basis/lobe.h"
#include "basis/lobe_rule.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

enum { FIRST_NODES = 32, MOST_NODES = 1024 };
static const double TOLERANCE = 1e-13;
/* What still counts as converged when the nodes are used up. */
static const double LAST_TOLERANCE = 1e-9;

typedef struct {
    const assay_basis    *basis;
    const assay_analysis *analysis;
    assay_lobe_rule      *rule;
    assay_lobe_node      *nodes; /* MOST_NODES */
    size_t                count;
    double               *functions, *row, *sum; /* count */
    double                energy;
} measure;

/* Sums of rows, then their sum: the rounding of a thousand terms, not of a million. */
static assay_status add_row(measure *m, int row)
{
    const bool weighted = assay_basis_kind_of(m->basis) == ASSAY_BASIS_MAKHOTKIN;
    const int  nodes    = assay_lobe_rule_row(m->rule, row, m->nodes);
    double     energy   = 0.0;
    for (size_t k = 0; k < m->count; k++) {
        m->row[k] = 0.0;
    }
    for (int j = 0; j < nodes; j++) {
        const assay_lobe_node *node = &m->nodes[j];
        const assay_status     status =
            assay_analysis_evaluate(m->analysis, node->direction, m->functions);
        if (status != ASSAY_OK) {
            return status;
        }
        for (size_t k = 0; k < m->count; k++) {
            m->row[k] += node->share * m->functions[k];
        }
        energy += node->share * node->value * (weighted ? node->direction.z : 1.0);
    }
    m->energy += energy;
    for (size_t k = 0; k < m->count; k++) {
        m->sum[k] += m->row[k];
    }
    return ASSAY_OK;
}

/* accuracy_out: order numbers. */
static assay_status integrate(measure *m, int nodes, double *accuracy_out)
{
    assay_status status = ASSAY_OK;
    const int    rows   = assay_lobe_rule_begin(m->rule, nodes);
    m->energy           = 0.0;
    for (size_t k = 0; k < m->count; k++) {
        m->sum[k] = 0.0;
    }
    for (int i = 0; i < rows && status == ASSAY_OK; i++) {
        status = add_row(m, i);
    }
    const int order = assay_basis_order(m->basis);
    for (int n = 0; n < order; n++) {
        accuracy_out[n] = 0.0;
    }
    for (size_t k = 0; k < m->count; k++) {
        int l, azimuthal;
        assay_basis_function(m->basis, k, &l, &azimuthal);
        accuracy_out[l] += m->sum[k] * m->sum[k];
    }
    double captured = 0.0;
    for (int n = 0; n < order; n++) {
        captured += accuracy_out[n];
        accuracy_out[n] = captured / m->energy * assay_lobe_rule_scale(m->rule);
    }
    return status;
}

static bool is_positive(double energy) { return energy > 0.0 && isfinite(energy); }

/* accuracy, previous: order numbers; the result is in the first. */
static assay_status refine(measure *m, assay_context *context, double *accuracy, double *previous)
{
    const int    order  = assay_basis_order(m->basis);
    double       change = INFINITY;
    assay_status status = integrate(m, FIRST_NODES, accuracy);
    for (int nodes = 2 * FIRST_NODES; status == ASSAY_OK && nodes <= MOST_NODES; nodes *= 2) {
        for (int n = 0; n < order; n++) {
            previous[n] = accuracy[n];
        }
        status = assay_progress(context, "accuracy", (uint64_t)nodes, 2 * MOST_NODES);
        if (status == ASSAY_OK) {
            status = integrate(m, nodes, accuracy);
        }
        change = 0.0;
        for (int n = 0; n < order; n++) {
            const double moved = fabs(accuracy[n] - previous[n]);
            change             = moved <= change ? change : moved;
        }
        if (change <= TOLERANCE || !is_positive(m->energy)) {
            break;
        }
    }
    if (status == ASSAY_OK && !is_positive(m->energy)) {
        return assay_fail(context, ASSAY_ERR_DOMAIN,
                          "the integral of the lobe's square is %g in double precision: its values "
                          "are too small or too large",
                          m->energy);
    }
    if (status == ASSAY_OK && !(change <= LAST_TOLERANCE)) {
        status =
            assay_fail(context, ASSAY_ERR_DOMAIN,
                       "the lobe is too narrow, or too close to the horizon, to be integrated with "
                       "%d nodes a row: the accuracy still moves by %.2g",
                       MOST_NODES, change);
    }
    return status;
}

static void count_functions(const assay_basis *basis, size_t *count_out)
{
    for (int n = 0; n < assay_basis_order(basis); n++) {
        count_out[n] = 0;
    }
    for (size_t k = 0; k < assay_basis_count(basis); k++) {
        int l, m;
        assay_basis_function(basis, k, &l, &m);
        count_out[l]++;
    }
    for (int n = 1; n < assay_basis_order(basis); n++) {
        count_out[n] += count_out[n - 1];
    }
}

assay_status assay_basis_accuracy(const assay_basis *basis, assay_context *context,
                                  const assay_lobe *lobe, double *accuracy_out, size_t *count_out)
{
    const char *problem = assay_lobe_problem(lobe);
    if (problem) {
        return assay_fail(context, ASSAY_ERR_DOMAIN, "%s", problem);
    }
    const size_t    count = assay_basis_count(basis), order = (size_t)assay_basis_order(basis);
    measure         m        = {.basis = basis, .count = count};
    assay_analysis *analysis = NULL;
    assay_status    status   = assay_analysis_create(context, basis, false, &analysis);
    double         *work     = assay_allocate(context, 3 * count + 2 * order, sizeof *work);
    m.nodes                  = assay_allocate(context, MOST_NODES, sizeof *m.nodes);
    if (status == ASSAY_OK) {
        status = assay_lobe_rule_create(context, lobe, MOST_NODES, &m.rule);
    }
    if (!work || !m.nodes) {
        status = status == ASSAY_OK ? assay_fail_memory(context, "an accuracy") : status;
    } else if (status == ASSAY_OK) {
        m.analysis       = analysis;
        m.functions      = work;
        m.row            = m.functions + count;
        m.sum            = m.row + count;
        double *accuracy = m.sum + count;
        status           = refine(&m, context, accuracy, accuracy + order);
        for (size_t n = 0; n < order && status == ASSAY_OK; n++) {
            accuracy_out[n] = accuracy[n];
        }
    }
    if (status == ASSAY_OK && count_out) {
        count_functions(basis, count_out);
    }
    assay_lobe_rule_destroy(m.rule);
    assay_analysis_destroy(analysis);
    assay_release(context, work);
    assay_release(context, m.nodes);
    return status;
}
