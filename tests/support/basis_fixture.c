/* basis_fixture.c - one context a test. */
#include "support/basis_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/failing_context.h"

static failing_memory memory;

int basis_set_up(void **state)
{
    *state = failing_context(&memory);
    return 0;
}

int basis_tear_down(void **state)
{
    assert_int_equal(memory.live, 1);
    assay_context_destroy(*state);
    return 0;
}

assay_basis *basis_make(assay_context *context, assay_basis_kind kind, int order)
{
    return basis_make_in(context, kind, order, ASSAY_CONVENTION_THESIS);
}

assay_basis *basis_make_in(assay_context *context, assay_basis_kind kind, int order,
                           assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, kind, order, convention, &basis), ASSAY_OK);
    return basis;
}
