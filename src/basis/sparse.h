/* sparse.h - the inside of a sparse matrix, for those who fill one. */
#ifndef ASSAY_BASIS_SPARSE_H
#define ASSAY_BASIS_SPARSE_H

#include "assay/basis.h"

struct assay_sparse {
    assay_context *context;
    size_t         rows, columns, entries;
    size_t        *row_start, *column; /* rows + 1; entries */
    double        *value;              /* entries           */
};

/* Room for the entries, all zero.  NULL: refused. */
assay_sparse *assay_sparse_create(assay_context *context, size_t rows, size_t columns,
                                  size_t entries);

#endif
