/* basis_print.c - numbers that can be read back: 17 significant digits always suffice. */
#include "basis_print.h"

#include <math.h>
#include <stdio.h>

/* Matrices are right to this (docs/methods/basis-rotation.md): smaller entries may be zeros. */
static const double ROUNDING = 1e-13;

cJSON *cli_json_number(double value, bool hex)
{
    char text[40];
    snprintf(text, sizeof text, hex ? "%a" : "%.17g", value);
    return hex ? cJSON_CreateString(text) : cJSON_CreateRaw(text);
}

static bool append(cJSON *list, cJSON *item)
{
    if (!item || !cJSON_AddItemToArray(list, item)) {
        cJSON_Delete(item);
        return false;
    }
    return true;
}

static bool fill_list(cJSON *list, const double *values, size_t count, bool hex)
{
    bool ok = list != NULL;
    for (size_t i = 0; i < count && ok; i++) {
        ok = append(list, cli_json_number(values[i], hex));
    }
    return ok;
}

bool cli_json_add_list(cJSON *object, const char *name, const double *values, size_t count,
                       bool hex)
{
    return fill_list(cJSON_AddArrayToObject(object, name), values, count, hex);
}

bool cli_json_add_rows(cJSON *object, const char *name, const double *values, size_t rows,
                       size_t columns, bool hex)
{
    cJSON *list = cJSON_AddArrayToObject(object, name);
    bool   ok   = list != NULL;
    for (size_t r = 0; r < rows && ok; r++) {
        cJSON *row = cJSON_CreateArray();
        ok         = append(list, row) && fill_list(row, values + r * columns, columns, hex);
    }
    return ok;
}

/* How the index of a function comes from l and m. */
static const char *index_rule(const assay_basis *basis)
{
    const assay_basis_kind kind = assay_basis_kind_of(basis);
    if (kind == ASSAY_BASIS_ZERNIKE || kind == ASSAY_BASIS_ESH) {
        return "l*(l+1)/2+(l+m)/2";
    }
    return assay_basis_convention_of(basis) == ASSAY_CONVENTION_KONTKANEN ? "see functions"
                                                                          : "l*l+l+m";
}

static bool add_functions(cJSON *object, const assay_basis *basis)
{
    cJSON *list = cJSON_AddArrayToObject(object, "functions");
    bool   ok   = list != NULL;
    for (size_t i = 0; i < assay_basis_count(basis) && ok; i++) {
        int pair[2];
        assay_basis_function(basis, i, &pair[0], &pair[1]);
        ok = append(list, cJSON_CreateIntArray(pair, 2));
    }
    return ok;
}

cJSON *cli_json_basis(const assay_basis *basis)
{
    cJSON *root = cJSON_CreateObject();
    if (root &&
        cJSON_AddStringToObject(root, "basis", assay_basis_kind_name(assay_basis_kind_of(basis))) &&
        cJSON_AddNumberToObject(root, "order", assay_basis_order(basis)) &&
        cJSON_AddStringToObject(root, "convention",
                                assay_convention_name(assay_basis_convention_of(basis))) &&
        cJSON_AddStringToObject(root, "index", index_rule(basis)) && add_functions(root, basis)) {
        return root;
    }
    cJSON_Delete(root);
    return NULL;
}

assay_status cli_json_print(cJSON *root, bool complete)
{
    char *text = complete ? cJSON_PrintUnformatted(root) : NULL;
    if (text) {
        puts(text);
    }
    cJSON_free(text);
    cJSON_Delete(root);
    return text ? ASSAY_OK : ASSAY_ERR_MEMORY;
}

void cli_print_number(double value, bool hex, int width)
{
    if (value == 0.0) {
        printf(" %*s", width, "0");
    } else {
        printf(hex ? " %*a" : " %*.17g", width, value);
    }
}

void cli_print_functions(const assay_basis *basis, const char *const *names, int columns,
                         const double *values, bool hex)
{
    const size_t count = assay_basis_count(basis);
    const int    width = 24;
    printf("%6s %4s %4s", "index", "l", "m");
    for (int c = 0; c < columns; c++) {
        printf(" %*s", width, names[c]);
    }
    printf("\n");
    for (size_t i = 0; i < count; i++) {
        int l, m;
        assay_basis_function(basis, i, &l, &m);
        printf("%6zu %4d %4d", i, l, m);
        for (int c = 0; c < columns; c++) {
            cli_print_number(values[(size_t)c * count + i], hex, width);
        }
        printf("\n");
    }
}

static void print_name(const assay_basis *basis, size_t i, int width)
{
    int  l, m;
    char name[16];
    assay_basis_function(basis, i, &l, &m);
    snprintf(name, sizeof name, "%d,%d", l, m);
    printf(" %*s", width, name);
}

void cli_print_matrix(const assay_basis *rows, const assay_basis *columns, const double *matrix,
                      bool hex)
{
    const size_t row_count = assay_basis_count(rows), column_count = assay_basis_count(columns);
    const int    width = hex ? 22 : 10;
    printf(" %6s", "l,m");
    for (size_t c = 0; c < column_count; c++) {
        print_name(columns, c, width);
    }
    printf("\n");
    for (size_t r = 0; r < row_count; r++) {
        print_name(rows, r, 6);
        for (size_t c = 0; c < column_count; c++) {
            const double value = matrix[r * column_count + c];
            if (hex || value == 0.0) {
                cli_print_number(value, hex, width);
            } else if (fabs(value) < ROUNDING) {
                printf(" %*s", width, "0");
            } else {
                printf(fabs(value) < 5e-7 ? " %*.3g" : " %*.6f", width, value);
            }
        }
        printf("\n");
    }
}

static bool add_side(cJSON *root, const char *name, const assay_basis *basis)
{
    cJSON *side = cli_json_basis(basis);
    if (!side || !cJSON_AddItemToObject(root, name, side)) {
        cJSON_Delete(side);
        return false;
    }
    return true;
}

assay_status cli_json_matrix(const assay_basis *rows, const assay_basis *columns,
                             const double *matrix, bool hex)
{
    cJSON *root = cli_json_basis(columns);
    if (root) {
        cJSON_DeleteItemFromObject(root, "functions");
    }
    const bool ok = root && add_side(root, "rows", rows) && add_side(root, "columns", columns) &&
                    cli_json_add_rows(root, "matrix", matrix, assay_basis_count(rows),
                                      assay_basis_count(columns), hex);
    return cli_json_print(root, ok);
}
