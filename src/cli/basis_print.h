/* basis_print.h - coefficients and matrices of bases, as tables to read or as JSON. */
#ifndef ASSAY_CLI_BASIS_PRINT_H
#define ASSAY_CLI_BASIS_PRINT_H

#include <cjson/cJSON.h>

#include "assay/assay.h"

/* A number for JSON: 17 significant digits, or a string of hexadecimal digits. */
cJSON *cli_json_number(double value, bool hex);

/* { "basis", "order", "convention", "index", "functions": [[l, m], ...] }; NULL without memory. */
cJSON *cli_json_basis(const assay_basis *basis);

/* Adds `name` as one list, or as a list of rows. */
bool cli_json_add_list(cJSON *object, const char *name, const double *values, size_t count,
                       bool hex);
bool cli_json_add_rows(cJSON *object, const char *name, const double *values, size_t rows,
                       size_t columns, bool hex);

/* Prints and deletes; complete: whether all additions worked.  Errors: MEMORY. */
assay_status cli_json_print(cJSON *root, bool complete);

/* "0.70710678118654757" or "0x1.6a09e667f3bcdp-1", at least `width` wide; exact zeros are "0". */
void cli_print_number(double value, bool hex, int width);

/* A line a function: index, l, m, then `columns` values each with a name (values: columns rows). */
void cli_print_functions(const assay_basis *basis, const char *const *names, int columns,
                         const double *values, bool hex);

/* A matrix with the names of its rows and columns: "2,-1".  Six decimals; three digits where those
 * would all be zeros; 0 where it is nothing but rounding. */
void cli_print_matrix(const assay_basis *rows, const assay_basis *columns, const double *matrix,
                      bool hex);

/* The same as JSON: what, then "rows" and "columns" as in cli_json_basis, then "matrix".  The basis
 * of the columns gives "basis", "order", "convention", "index". */
assay_status cli_json_matrix(const assay_basis *rows, const assay_basis *columns,
                             const double *matrix, bool hex);

#endif
