/* table.h - what an array of a bundle is to this backend: rows of columns, in single precision. */
#ifndef BACKEND_TABLE_H
#define BACKEND_TABLE_H

#include <stddef.h>

typedef struct {
    size_t rows, columns;
    float *values;
} table;

/* Zeros.  Whatever goes wrong in this backend ends it, with a line on stderr and code 2. */
table table_make(size_t rows, size_t columns);
table table_copy(const table *t);
void  table_release(table *t);

static inline float *table_row(const table *t, size_t row) { return t->values + row * t->columns; }

/* NumPy's .npy: versions 1 to 3, little-endian half, single or double, C order, any shape of which
 * the last number is the columns.  Written: version 1.0, '<f4', two dimensions. */
table table_read_npy(const char *path);
void  table_write_npy(const char *path, const table *t);

/* The channels of a scan line OpenEXR image, a row a pixel from the top left; channels: their
 * names, with blanks between. */
table table_read_exr(const char *path, const char *channels);

_Noreturn void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));
void          *allocate(size_t count, size_t size);

#endif
