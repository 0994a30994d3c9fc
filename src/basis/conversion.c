/* conversion.c - SH to HSH and back.
 *
 * Invariant: every entry is the integral of a product of two functions of the same m over the
 * hemisphere [gautron06] eq. 3.20, and the matrix of the one direction is that of the other
 * transposed, to the bit.
 *
 * At phi = 0 the functions of m >= 0 are sqrt(2) K P, so the integral over phi is pi (2 pi for m =
 * 0) times their product there; with m < 0 the same number comes out.  In z = t^2 the product is
 * t^m (1 - t^2)^m (1 + t^2)^(m/2) times a polynomial: for even m the Gauss rule below is exact, for
 * odd m the branch points t = +-i are so far away that with EXTRA nodes no rounding sees them.  (In
 * z itself there is a root z^(m/2) at the end, which leaves 3e-5 at order 33.) */
#include "assay/basis.h"
#include "basis/basis_data.h"
#include "basis/sparse.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

enum { EXTRA = 24, NODES_MAX = 2 * ASSAY_BASIS_MAX_ORDER + EXTRA };

/* Values of both bases at the nodes. */
typedef struct {
    int     nodes;
    double  weight[NODES_MAX]; /* of the integral over z */
    double *from, *to;         /* nodes rows of each count */
} node_values;

static void release_values(assay_context *context, node_values *values)
{
    assay_release(context, values->from);
    assay_release(context, values->to);
}

static assay_status evaluate_nodes(assay_context *context, const assay_basis *from,
                                   const assay_basis *to, node_values *values_out)
{
    const size_t n = assay_basis_count(from), m = assay_basis_count(to);
    node_values  v = {.nodes = assay_basis_order(from) + assay_basis_order(to) + EXTRA};
    v.from         = assay_allocate(context, (size_t)v.nodes * n, sizeof(double));
    v.to           = assay_allocate(context, (size_t)v.nodes * m, sizeof(double));
    assay_status status =
        v.from && v.to ? ASSAY_OK : assay_fail_memory(context, "a conversion matrix");
    double t[NODES_MAX];
    assay_gauss_legendre_on(0.0, 1.0, v.nodes, t, v.weight);
    for (int q = 0; q < v.nodes && !status; q++) {
        const double     z    = t[q] * t[q];
        const double     sine = sqrt((1.0 - t[q]) * (1.0 + t[q]) * (1.0 + z));
        const assay_vec3 d    = {sine, 0.0, z};
        status                = assay_basis_evaluate(from, d, v.from + (size_t)q * n);
        status                = status ? status : assay_basis_evaluate(to, d, v.to + (size_t)q * m);
        v.weight[q] *= 2.0 * t[q];
    }
    if (status) {
        release_values(context, &v);
        return status;
    }
    *values_out = v;
    return ASSAY_OK;
}

/* Whether the entry of two functions of the same kind of azimuth is zero for a reason: m = 0, and
 * the SH's polynomial is of lower degree than the HSH's, which is orthogonal to it; or the HSH is
 * constant and the SH even, so that its integral is half of that over the sphere. */
static bool is_orthogonal(int hsh_l, int sh_l, int m)
{
    return m == 0 && (sh_l < hsh_l || (hsh_l == 0 && sh_l > 0 && sh_l % 2 == 0));
}

static bool is_entry(const assay_basis *row_basis, size_t row, const assay_basis *column_basis,
                     size_t column)
{
    int l = 0, m = 0, k = 0, n = 0;
    assay_basis_function(row_basis, row, &l, &m);
    assay_basis_function(column_basis, column, &k, &n);
    const bool row_is_hsh = assay_basis_kind_of(row_basis) == ASSAY_BASIS_HSH;
    return m == n && !is_orthogonal(row_is_hsh ? l : k, row_is_hsh ? k : l, m);
}

/* The function (l, |m|) of function i = (l, m). */
static size_t mirror_index(const assay_basis *basis, size_t i)
{
    int l = 0, m = 0;
    assay_basis_function(basis, i, &l, &m);
    return m < 0 ? basis_index(basis, l, -m) : i;
}

static double integral(const node_values *v, size_t from_count, size_t i, size_t to_count, size_t j)
{
    double sum = 0.0, rest = 0.0;
    for (size_t q = 0; q < (size_t)v->nodes; q++) {
        const double term = v->weight[q] * (v->from[q * from_count + i] * v->to[q * to_count + j]);
        const double next = sum + term, part = next - sum;
        rest += (sum - (next - part)) + (term - part);
        sum = next;
    }
    return sum + rest;
}

static void fill(const node_values *v, const assay_basis *from, const assay_basis *to,
                 assay_sparse *c)
{
    size_t at = 0;
    for (size_t i = 0; i < c->rows; i++) {
        const size_t mirrored = mirror_index(to, i);
        int          l = 0, m = 0;
        assay_basis_function(to, i, &l, &m);
        for (size_t j = 0; j < c->columns; j++) {
            if (is_entry(to, i, from, j)) {
                c->column[at]  = j;
                c->value[at++] = (m ? ASSAY_PI : ASSAY_TWO_PI) *
                                 integral(v, c->columns, mirror_index(from, j), c->rows, mirrored);
            }
        }
        c->row_start[i + 1] = at;
    }
}

assay_status assay_basis_conversion(assay_context *context, const assay_basis *from,
                                    const assay_basis *to, assay_sparse **matrix_out)
{
    const assay_basis_kind a = assay_basis_kind_of(from), b = assay_basis_kind_of(to);
    if (!(a == ASSAY_BASIS_SH && b == ASSAY_BASIS_HSH) &&
        !(a == ASSAY_BASIS_HSH && b == ASSAY_BASIS_SH)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a conversion needs one basis sh and one hsh, not %s and %s",
                          assay_basis_kind_name(a), assay_basis_kind_name(b));
    }
    const size_t rows = assay_basis_count(to), columns = assay_basis_count(from);
    size_t       entries = 0;
    for (size_t i = 0; i < rows; i++) {
        for (size_t j = 0; j < columns; j++) {
            entries += is_entry(to, i, from, j);
        }
    }
    node_values  values = {0};
    assay_status status = evaluate_nodes(context, from, to, &values);
    if (status) {
        return status;
    }
    assay_sparse *c = assay_sparse_create(context, rows, columns, entries);
    if (c) {
        fill(&values, from, to, c);
        *matrix_out = c;
    }
    release_values(context, &values);
    return c ? ASSAY_OK : assay_fail_memory(context, "a conversion matrix");
}
