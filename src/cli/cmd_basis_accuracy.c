/* cmd_basis_accuracy.c - `assay basis accuracy`: eq. 3.32 of the thesis, for one basis or all. */
#include <stdio.h>

#include "basis_options.h"
#include "basis_print.h"
#include "console.h"

static const char       COMMAND[] = "basis accuracy";
static const cli_option OPTIONS[] = {
    BASIS_OPTION_LOBE,
    {"basis", 0, "NAME", "as in basis eval, or all (default)"},
    {"max-order", 0, "N", "orders 1 to N (default 10; at most 33)"},
    BASIS_OPTIONS_PRINT};

typedef struct {
    double values[ASSAY_BASIS_KIND_COUNT][ASSAY_BASIS_MAX_ORDER];
    size_t counts[ASSAY_BASIS_KIND_COUNT][ASSAY_BASIS_MAX_ORDER];
} accuracy_table;

static bool is_wanted(const basis_request *r, int kind)
{
    return !r->has_basis || (int)r->basis == kind;
}

static void print_table(const basis_request *r, const accuracy_table *table)
{
    printf("%s: share of the energy, by order (functions)\n%5s", r->lobe_text, "order");
    for (int k = 0; k < ASSAY_BASIS_KIND_COUNT; k++) {
        if (is_wanted(r, k)) {
            printf(" %*s", r->hex ? 30 : 20, assay_basis_kind_name((assay_basis_kind)k));
        }
    }
    printf("\n");
    for (long n = 0; n < r->order; n++) {
        printf("%5ld", n + 1);
        for (int k = 0; k < ASSAY_BASIS_KIND_COUNT; k++) {
            if (is_wanted(r, k)) {
                const double value = table->values[k][n];
                printf(r->hex ? " %23a" : value < 5e-10 ? " %13.3g" : " %13.9f", value);
                printf(" (%4zu)", table->counts[k][n]);
            }
        }
        printf("\n");
    }
}

static bool add_counts(cJSON *object, const size_t *counts, long order)
{
    int list[ASSAY_BASIS_MAX_ORDER];
    for (long n = 0; n < order; n++) {
        list[n] = (int)counts[n];
    }
    cJSON *array = cJSON_CreateIntArray(list, (int)order);
    if (!array || !cJSON_AddItemToObject(object, "counts", array)) {
        cJSON_Delete(array);
        return false;
    }
    return true;
}

static cJSON *one_basis(const basis_request *r, const accuracy_table *table, int k)
{
    cJSON *root = cJSON_CreateObject();
    if (root &&
        cJSON_AddStringToObject(root, "basis", assay_basis_kind_name((assay_basis_kind)k)) &&
        cJSON_AddNumberToObject(root, "order", (double)r->order) &&
        cJSON_AddStringToObject(root, "convention", "thesis") &&
        cJSON_AddStringToObject(root, "index", "order-1") &&
        cJSON_AddStringToObject(root, "lobe", r->lobe_text) &&
        cli_json_add_list(root, "values", table->values[k], (size_t)r->order, r->hex) &&
        add_counts(root, table->counts[k], r->order)) {
        return root;
    }
    cJSON_Delete(root);
    return NULL;
}

static assay_status print_json(const basis_request *r, const accuracy_table *table)
{
    if (r->has_basis) {
        cJSON *root = one_basis(r, table, (int)r->basis);
        return cli_json_print(root, root != NULL);
    }
    cJSON *list = cJSON_CreateArray();
    bool   ok   = list != NULL;
    for (int k = 0; k < ASSAY_BASIS_KIND_COUNT && ok; k++) {
        cJSON *item = one_basis(r, table, k);
        ok          = item && cJSON_AddItemToArray(list, item);
    }
    return cli_json_print(list, ok);
}

static assay_status measure(assay_context *context, const basis_request *r)
{
    accuracy_table table  = {0};
    assay_status   status = ASSAY_OK;
    for (int k = 0; k < ASSAY_BASIS_KIND_COUNT && status == ASSAY_OK; k++) {
        assay_basis *basis = NULL;
        if (is_wanted(r, k)) {
            status = cli_basis_create(context, r, (assay_basis_kind)k, r->order, &basis);
        }
        if (status == ASSAY_OK && basis) {
            status =
                assay_basis_accuracy(basis, context, &r->lobe, table.values[k], table.counts[k]);
        }
        assay_basis_destroy(basis);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    if (r->json) {
        return print_json(r, &table);
    }
    print_table(r, &table);
    return ASSAY_OK;
}

static bool makes_sense(const basis_request *r)
{
    return cli_basis_need(COMMAND, r->has_lobe, "--lobe");
}

static const basis_command SELF = {
    .name    = COMMAND,
    .usage   = "usage: assay basis accuracy --lobe phong:5@60|ward:0.2,0.5@30 [--basis NAME]\n",
    .options = OPTIONS,
    .check   = makes_sense,
    .run     = measure};

int cli_basis_accuracy(int count, char **argv)
{
    return cli_basis_run(&SELF, count, argv, (basis_request){.order = 10});
}
