/* sparse.c - matrices in compressed rows.
 *
 * Invariant: row_start ascends from 0 to `entries`, columns ascend within a row; products add up in
 * the order of the columns. */
#include "basis/sparse.h"

#include "core/alloc.h"

assay_sparse *assay_sparse_create(assay_context *context, size_t rows, size_t columns,
                                  size_t entries)
{
    assay_sparse *matrix = assay_allocate(context, 1, sizeof *matrix);
    if (!matrix) {
        return NULL;
    }
    *matrix           = (assay_sparse){.context = context, .rows = rows, .columns = columns};
    matrix->entries   = entries;
    matrix->row_start = assay_allocate(context, rows + 1, sizeof *matrix->row_start);
    matrix->column    = assay_allocate(context, entries, sizeof *matrix->column);
    matrix->value     = assay_allocate(context, entries, sizeof *matrix->value);
    if (!matrix->row_start || !matrix->column || !matrix->value) {
        assay_sparse_destroy(matrix);
        return NULL;
    }
    return matrix;
}

void assay_sparse_destroy(assay_sparse *matrix)
{
    if (!matrix) {
        return;
    }
    assay_context *context = matrix->context;
    assay_release(context, matrix->row_start);
    assay_release(context, matrix->column);
    assay_release(context, matrix->value);
    assay_release(context, matrix);
}

assay_sparse_view assay_sparse_entries(const assay_sparse *matrix)
{
    return (assay_sparse_view){matrix->rows,      matrix->columns, matrix->entries,
                               matrix->row_start, matrix->column,  matrix->value};
}

void assay_sparse_multiply(const assay_sparse *matrix, const double *in, double *out)
{
    for (size_t r = 0; r < matrix->rows; r++) {
        double sum = 0.0;
        for (size_t k = matrix->row_start[r]; k < matrix->row_start[r + 1]; k++) {
            sum += matrix->value[k] * in[matrix->column[k]];
        }
        out[r] = sum;
    }
}
