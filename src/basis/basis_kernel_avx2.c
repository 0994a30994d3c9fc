/* basis_kernel_avx2.c - four directions, where the machine has vectors for that. */
#include <math.h>

#include "basis/basis_data.h"

#if defined(__x86_64__)
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

enum { LANES = BASIS_WIDE };
#include "basis/basis_kernel.h"

void basis_evaluate_wide(const assay_basis *basis, size_t count, const assay_vec3 *directions,
                         double *values)
{
    evaluate_some(basis, count, directions, values);
}

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

bool basis_has_wide(void) { return __builtin_cpu_supports("avx2"); }

#else

bool basis_has_wide(void) { return false; }

void basis_evaluate_wide(const assay_basis *basis, size_t count, const assay_vec3 *directions,
                         double *values)
{
    basis_evaluate_pair(basis, count, directions, values);
}

#endif
