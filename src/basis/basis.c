/* basis.c - kinds, names, and the order of the functions.
 *
 * Invariant: function i is (l[i], m[i]), and basis_index is the inverse of that. */
#include <assert.h>
#include <string.h>

#include "basis/basis_data.h"
#include "core/alloc.h"
#include "core/context.h"

const char *assay_basis_kind_name(assay_basis_kind kind)
{
    static const char *const names[ASSAY_BASIS_KIND_COUNT] = {
        "sh", "hsh", "zernike", "makhotkin", "makhotkin-sqrt", "esh", "lsosh"};
    return (unsigned)kind < ASSAY_BASIS_KIND_COUNT ? names[kind] : NULL;
}

const char *assay_convention_name(assay_convention convention)
{
    static const char *const names[ASSAY_CONVENTION_COUNT] = {"thesis", "plain", "kontkanen"};
    return (unsigned)convention < ASSAY_CONVENTION_COUNT ? names[convention] : NULL;
}

assay_status assay_basis_kind_find(const char *name, assay_basis_kind *kind_out)
{
    for (int i = 0; name && i < ASSAY_BASIS_KIND_COUNT; i++) {
        if (strcmp(name, assay_basis_kind_name((assay_basis_kind)i)) == 0) {
            *kind_out = (assay_basis_kind)i;
            return ASSAY_OK;
        }
    }
    return ASSAY_ERR_ARGUMENT;
}

assay_status assay_convention_find(const char *name, assay_convention *convention_out)
{
    for (int i = 0; name && i < ASSAY_CONVENTION_COUNT; i++) {
        if (strcmp(name, assay_convention_name((assay_convention)i)) == 0) {
            *convention_out = (assay_convention)i;
            return ASSAY_OK;
        }
    }
    return ASSAY_ERR_ARGUMENT;
}

bool assay_basis_kind_is_hemispherical(assay_basis_kind kind) { return kind != ASSAY_BASIS_SH; }

/* [kontkanen] table 1: where function l*l + l + m of the common order stands. */
static size_t kontkanen_index(size_t common)
{
    static const unsigned char place[9] = {0, 2, 3, 1, 6, 5, 7, 4, 8};
    assert(common < sizeof place);
    return place[common];
}

size_t basis_index(const assay_basis *basis, int l, int m)
{
    if (basis_is_even(basis->kind)) {
        const int even = l * (l + 1) / 2 + (l + m) / 2;
        return (size_t)even;
    }
    const int    place  = l * l + l + m;
    const size_t common = (size_t)place;
    return basis->convention == ASSAY_CONVENTION_KONTKANEN ? kontkanen_index(common) : common;
}

static assay_status check_request(assay_context *context, assay_basis_kind kind, int order,
                                  assay_convention convention)
{
    const char *kind_name = assay_basis_kind_name(kind);
    const char *name      = assay_convention_name(convention);
    if (!kind_name || !name) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "unknown kind of basis or convention");
    }
    if (order < 1 || order > ASSAY_BASIS_MAX_ORDER) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a basis cannot have the order %d: it must be in 1 ... %d", order,
                          ASSAY_BASIS_MAX_ORDER);
    }
    const bool signs_vary = kind == ASSAY_BASIS_SH || kind == ASSAY_BASIS_HSH;
    if (convention == ASSAY_CONVENTION_KONTKANEN && (kind != ASSAY_BASIS_SH || order > 3)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "the convention kontkanen is of sh up to order 3 alone");
    }
    if (convention != ASSAY_CONVENTION_THESIS && !signs_vary) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "the basis %s has no convention %s: only sh and hsh have others than "
                          "thesis",
                          kind_name, name);
    }
    return ASSAY_OK;
}

/* Orders and indices; returns the number of steps. */
static size_t arrange(assay_basis *basis)
{
    const int stride = basis->kind == ASSAY_BASIS_ZERNIKE ? 2 : 1;
    const int n      = basis->order;
    size_t    steps  = 0;
    for (int m = 0; m < n; m++) {
        basis->steps[m] = (n - 1 - m) / stride + 1;
        steps += (size_t)basis->steps[m];
    }
    for (int l = 0; l < n; l++) {
        for (int m = -l; m <= l; m += basis_is_even(basis->kind) ? 2 : 1) {
            const size_t i = basis_index(basis, l, m);
            basis->l[i]    = (short)l;
            basis->m[i]    = (short)m;
            basis->count++;
        }
    }
    return steps;
}

static void place_steps(assay_basis *basis)
{
    basis_step *step   = basis->step;
    const int   stride = basis->kind == ASSAY_BASIS_ZERNIKE ? 2 : 1;
    for (int m = 0; m < basis->order; m++) {
        for (int k = 0; k < basis->steps[m]; k++, step++) {
            const int  l    = m + stride * k;
            const bool here = !basis_is_even(basis->kind) || (l + m) % 2 == 0;
            step->plus      = here ? (short)basis_index(basis, l, m) : -1;
            step->minus     = here && m > 0 ? (short)basis_index(basis, l, -m) : -1;
        }
    }
}

/* ASSAY_ISA=sse2 forbids wide vectors, for tests. */
static bool may_be_wide(const assay_context *context)
{
    const char *isa = assay_context_isa(context);
    return basis_has_wide() && (!isa || strcmp(isa, "sse2") != 0);
}

assay_status assay_basis_create(assay_context *context, assay_basis_kind kind, int order,
                                assay_convention convention, assay_basis **basis_out)
{
    const assay_status status = check_request(context, kind, order, convention);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_basis *basis = assay_allocate(context, 1, sizeof *basis);
    if (!basis) {
        return assay_fail_memory(context, "a basis");
    }
    basis->context     = context;
    basis->kind        = kind;
    basis->order       = order;
    basis->convention  = convention;
    basis->wide        = may_be_wide(context);
    const size_t steps = arrange(basis);
    basis->step        = assay_allocate(context, steps, sizeof(basis_step));
    if (!basis->step) {
        assay_basis_destroy(basis);
        return assay_fail_memory(context, "a basis");
    }
    place_steps(basis);
    basis_constants(basis);
    *basis_out = basis;
    return ASSAY_OK;
}

void assay_basis_destroy(assay_basis *basis)
{
    if (!basis) {
        return;
    }
    assay_release(basis->context, basis->step);
    assay_release(basis->context, basis);
}

assay_basis_kind assay_basis_kind_of(const assay_basis *basis) { return basis->kind; }

assay_convention assay_basis_convention_of(const assay_basis *basis) { return basis->convention; }

int assay_basis_order(const assay_basis *basis) { return basis->order; }

size_t assay_basis_count(const assay_basis *basis) { return basis->count; }

void assay_basis_function(const assay_basis *basis, size_t i, int *l_out, int *m_out)
{
    assert(i < basis->count);
    *l_out = basis->l[i];
    *m_out = basis->m[i];
}
