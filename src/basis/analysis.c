/* analysis.c - which functions analyse which basis.
 *
 * Invariant: fit is there for LSOSH and for nothing else. */
#include "basis/analysis.h"

#include "basis/least_squares.h"
#include "core/alloc.h"
#include "core/context.h"

struct assay_analysis {
    assay_context       *context;
    const assay_basis   *basis;
    assay_least_squares *fit;
    size_t               count;
    bool                 cosine_weight;
};

assay_status assay_analysis_create(assay_context *context, const assay_basis *basis, bool solve,
                                   assay_analysis **analysis_out)
{
    assay_analysis *a = assay_allocate(context, 1, sizeof *a);
    if (!a) {
        return assay_fail_memory(context, "a projection");
    }
    const assay_basis_kind kind = assay_basis_kind_of(basis);

    a->context       = context;
    a->basis         = basis;
    a->count         = assay_basis_count(basis);
    a->cosine_weight = kind == ASSAY_BASIS_MAKHOTKIN;
    if (kind == ASSAY_BASIS_LSOSH) {
        const assay_status status = assay_least_squares_create(context, basis, solve, &a->fit);
        if (status != ASSAY_OK) {
            assay_analysis_destroy(a);
            return status;
        }
    }
    *analysis_out = a;
    return ASSAY_OK;
}

void assay_analysis_destroy(assay_analysis *analysis)
{
    if (analysis) {
        assay_least_squares_destroy(analysis->fit);
        assay_release(analysis->context, analysis);
    }
}

assay_status assay_analysis_evaluate(const assay_analysis *a, assay_vec3 direction,
                                     double *values_out)
{
    if (a->fit) {
        assay_least_squares_evaluate(a->fit, direction, values_out);
        return ASSAY_OK;
    }
    const assay_status status = assay_basis_evaluate(a->basis, direction, values_out);
    if (status == ASSAY_OK && a->cosine_weight) {
        for (size_t i = 0; i < a->count; i++) {
            values_out[i] *= direction.z;
        }
    }
    return status;
}

assay_status assay_analysis_evaluate_many(const assay_analysis *a, size_t direction_count,
                                          const assay_vec3 *directions, double *values_out)
{
    if (a->fit) {
        for (size_t i = 0; i < direction_count; i++) {
            assay_least_squares_evaluate(a->fit, directions[i], values_out + i * a->count);
        }
        return ASSAY_OK;
    }
    const assay_status status =
        assay_basis_evaluate_many(a->basis, direction_count, directions, values_out);
    for (size_t i = 0; status == ASSAY_OK && a->cosine_weight && i < direction_count; i++) {
        for (size_t k = 0; k < a->count; k++) {
            values_out[i * a->count + k] *= directions[i].z;
        }
    }
    return status;
}

bool assay_analysis_needs_finish(const assay_analysis *a) { return a->fit != NULL; }

void assay_analysis_finish(const assay_analysis *a, double *coefficients)
{
    if (a->fit) {
        assay_least_squares_solve(a->fit, coefficients);
    }
}
