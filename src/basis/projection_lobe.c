/* projection_lobe.c - coefficients of a BRDF lobe, wide or narrow.
 *
 * Invariant: all coefficients come from the same nodes (lobe_rule.c), doubled until none moves by
 * more than TOLERANCE of the largest, or, at the last doubling, LAST_TOLERANCE. */
#include "basis/analysis.h"
#include "basis/lobe.h"
#include "basis/lobe_rule.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

enum { FIRST_NODES = 32, MOST_NODES = 1024 };
static const double TOLERANCE      = 1e-14;
static const double LAST_TOLERANCE = 1e-11;

typedef struct {
    assay_context   *context;
    assay_analysis  *analysis;
    assay_lobe_rule *rule;
    assay_lobe_node *nodes;
    size_t           count;
    double          *functions, *row, *sum, *before; /* count */
} lobe_sum;

static assay_status integrate(lobe_sum *s, int nodes)
{
    const int rows = assay_lobe_rule_begin(s->rule, nodes);
    for (size_t k = 0; k < s->count; k++) {
        s->sum[k] = 0.0;
    }
    for (int i = 0; i < rows; i++) {
        const int here = assay_lobe_rule_row(s->rule, i, s->nodes);
        for (size_t k = 0; k < s->count; k++) {
            s->row[k] = 0.0;
        }
        for (int j = 0; j < here; j++) {
            const assay_status status =
                assay_analysis_evaluate(s->analysis, s->nodes[j].direction, s->functions);
            if (status != ASSAY_OK) {
                return status;
            }
            for (size_t k = 0; k < s->count; k++) {
                s->row[k] += s->nodes[j].share * s->functions[k];
            }
        }
        for (size_t k = 0; k < s->count; k++) {
            s->sum[k] += s->row[k];
        }
    }
    return ASSAY_OK;
}

/* How far the sums are from those before, in units of the largest. */
static double movement(const lobe_sum *s, double *largest_out)
{
    double moved = 0.0, largest = 0.0;
    for (size_t k = 0; k < s->count; k++) {
        const double step = fabs(s->sum[k] - s->before[k]);
        moved             = step <= moved ? moved : step;
        largest           = fmax(largest, fabs(s->sum[k]));
    }
    *largest_out = largest;
    return moved / largest;
}

static assay_status refine(lobe_sum *s)
{
    double       moved = INFINITY, largest = 0.0;
    assay_status status = integrate(s, FIRST_NODES);
    for (int n = 2 * FIRST_NODES; n <= MOST_NODES && status == ASSAY_OK && !(moved <= TOLERANCE);
         n *= 2) {
        for (size_t k = 0; k < s->count; k++) {
            s->before[k] = s->sum[k];
        }
        status = assay_progress(s->context, "project", (uint64_t)n, 2 * MOST_NODES);
        status = status == ASSAY_OK ? integrate(s, n) : status;
        moved  = movement(s, &largest);
        if (status == ASSAY_OK && !(largest > 0.0)) {
            return assay_fail(s->context, ASSAY_ERR_DOMAIN,
                              "the lobe's coefficients are 0 in double precision: it is too narrow "
                              "or too weak");
        }
    }
    if (status == ASSAY_OK && !(moved <= LAST_TOLERANCE)) {
        status = assay_fail(s->context, ASSAY_ERR_DOMAIN,
                            "the lobe is too narrow, or too close to the horizon, to be integrated "
                            "with %d nodes a row: coefficients still move by %.2g of the largest",
                            MOST_NODES, moved);
    }
    return status;
}

assay_status assay_basis_project_lobe(const assay_basis *basis, assay_context *context,
                                      const assay_lobe *lobe, double *coefficients_out)
{
    const char *problem = assay_lobe_problem(lobe);
    if (problem) {
        return assay_fail(context, ASSAY_ERR_DOMAIN, "%s", problem);
    }
    lobe_sum     s      = {.context = context, .count = assay_basis_count(basis)};
    assay_status status = assay_analysis_create(context, basis, true, &s.analysis);
    if (status == ASSAY_OK) {
        status = assay_lobe_rule_create(context, lobe, MOST_NODES, &s.rule);
    }
    s.nodes     = assay_allocate(context, MOST_NODES, sizeof *s.nodes);
    s.functions = assay_allocate(context, 4 * s.count, sizeof(double));
    if (status == ASSAY_OK && (!s.nodes || !s.functions)) {
        status = assay_fail_memory(context, "a projection");
    }
    if (status == ASSAY_OK) {
        s.row    = s.functions + s.count;
        s.sum    = s.row + s.count;
        s.before = s.sum + s.count;
        status   = refine(&s);
    }
    if (status == ASSAY_OK && s.sum) {
        assay_analysis_finish(s.analysis, s.sum);
        for (size_t k = 0; k < s.count; k++) {
            coefficients_out[k] = s.sum[k] * assay_lobe_rule_scale(s.rule);
        }
    }
    assay_lobe_rule_destroy(s.rule);
    assay_analysis_destroy(s.analysis);
    assay_release(context, s.nodes);
    assay_release(context, s.functions);
    return status;
}
