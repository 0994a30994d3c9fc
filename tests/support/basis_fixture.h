/* basis_fixture.h - what tests of bases begin and end with. */
#ifndef ASSAY_TESTS_BASIS_FIXTURE_H
#define ASSAY_TESTS_BASIS_FIXTURE_H

#include "assay/basis.h"

/* The state is a context of one thread on counted memory; tear_down fails the test where something
 * else is still held. */
int basis_set_up(void **state);
int basis_tear_down(void **state);

/* A basis; fails the test on any error.  basis_make: with the thesis's signs. */
assay_basis *basis_make(assay_context *context, assay_basis_kind kind, int order);
assay_basis *basis_make_in(assay_context *context, assay_basis_kind kind, int order,
                           assay_convention convention);

#endif
