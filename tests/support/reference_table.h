/* reference_table.h - the certified tables of refdata/basis (refdata/README.md), for tests.
 *
 * A table that is missing or malformed fails the test that asks for it; it is never skipped. */
#ifndef ASSAY_TESTS_REFERENCE_TABLE_H
#define ASSAY_TESTS_REFERENCE_TABLE_H

#include <stddef.h>

typedef struct {
    char    name[64];
    size_t  keys;    /* leading columns that say which row it is */
    size_t  columns; /* with the keys                            */
    size_t  rows;
    double *numbers; /* rows * columns                           */
} reference_table;

/* refdata/basis/NAME.txt.  Freed with reference_table_free. */
reference_table *reference_table_read(const char *name);
/* From a text that ends in NUL and is changed on the way.  NULL, and why in why_out (a constant),
 * if it is not a table. */
reference_table *reference_table_parse(char *text, const char **why_out);
void             reference_table_free(reference_table *table);

/* Keys, and the values after them, of a row. */
const double *reference_table_keys(const reference_table *table, size_t row);
const double *reference_table_values(const reference_table *table, size_t row);
/* First row whose leading keys are these; fails the test if there is none. */
size_t reference_table_find(const reference_table *table, const double *keys, size_t key_count);

/* All bytes of a file and a NUL; fails the test if it cannot be read.  Freed by the caller. */
char *reference_file_bytes(const char *path, size_t *size_out);

#endif
