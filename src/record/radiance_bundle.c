/* radiance_bundle.c - rows of coefficients beside the fields of records.
 *
 * Invariant: rows are read and judged before the first record is added, so that no record is ever
 * without its row. */
#include "record/radiance_bundle.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "record/record_bundle.h"

enum { CHANNELS = 3, AXES = 3, NAME_SIZE = 96 };

static const char COEFFICIENTS[] = "coefficients", GRADIENT[] = "coefficient_gradient";

static void name_of(const char *prefix, const char *field, char name[NAME_SIZE])
{
    snprintf(name, NAME_SIZE, "%s/%s", prefix, field);
}

static size_t columns_of(const assay_radiance_cache *cache)
{
    return CHANNELS * assay_basis_count(assay_radiance_cache_basis(cache));
}

/* ---- out ---- */

static const double *row_of(const assay_radiance_cache *cache, uint32_t number, bool gradient)
{
    return gradient ? &assay_radiance_cache_gradients(cache, number)->x
                    : assay_radiance_cache_coefficients(cache, number);
}

static assay_status add_rows(assay_context *context, assay_bundle *bundle, const char *prefix,
                             assay_radiance_cache *cache, bool gradient)
{
    const assay_record_store *store =
        assay_irradiance_cache_store(assay_radiance_cache_records(cache));
    const uint32_t rows    = assay_record_store_count(store);
    const size_t   columns = columns_of(cache) * (gradient ? AXES : 1);
    assay_array   *table   = NULL;
    char           name[NAME_SIZE];
    name_of(prefix, gradient ? GRADIENT : COEFFICIENTS, name);
    assay_status status = assay_array_create(context, rows, columns, &table);
    for (uint32_t i = 0; i < rows && status == ASSAY_OK; i++) {
        memcpy(assay_array_data(table) + i * columns, row_of(cache, i, gradient),
               columns * sizeof(double));
    }
    status =
        status ? status
               : assay_bundle_add_table(bundle, name, gradient ? "W/(m3 sr)" : "W/(m2 sr)", table);
    assay_array_destroy(table);
    return status;
}

assay_status assay_radiance_bundle_add(assay_context *context, assay_bundle *bundle,
                                       const char *prefix, assay_radiance_cache *cache)
{
    assay_status status = assay_record_bundle_add(
        context, bundle, prefix, assay_irradiance_cache_store(assay_radiance_cache_records(cache)));
    status = status ? status : add_rows(context, bundle, prefix, cache, false);
    return status || !assay_radiance_cache_has_gradients(cache)
               ? status
               : add_rows(context, bundle, prefix, cache, true);
}

/* ---- in ---- */

static assay_status read_rows(assay_context *context, assay_bundle_reader *reader, const char *name,
                              size_t rows, size_t columns, assay_array **table_out)
{
    assay_array *table  = NULL;
    assay_status status = assay_bundle_read_table(reader, name, rows, columns, &table);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t values = assay_array_rows(table) * columns;
    for (size_t i = 0; i < values; i++) {
        if (!isfinite(assay_array_values(table)[i])) {
            assay_array_destroy(table);
            return assay_fail(context, ASSAY_ERR_FORMAT, "%s: %s: row %zu is not finite",
                              assay_bundle_path(reader), name, i / columns);
        }
    }
    *table_out = table;
    return ASSAY_OK;
}

assay_status assay_radiance_bundle_read(assay_context *context, assay_bundle_reader *reader,
                                        const char *prefix, assay_radiance_cache *cache)
{
    const size_t columns      = columns_of(cache);
    assay_array *coefficients = NULL, *gradients = NULL;
    char         name[NAME_SIZE];
    name_of(prefix, COEFFICIENTS, name);
    assay_status status = read_rows(context, reader, name, SIZE_MAX, columns, &coefficients);
    const size_t rows   = status ? 0 : assay_array_rows(coefficients);
    if (status == ASSAY_OK && assay_radiance_cache_has_gradients(cache)) {
        name_of(prefix, GRADIENT, name);
        status = read_rows(context, reader, name, rows, AXES * columns, &gradients);
    }
    status = status
                 ? status
                 : assay_radiance_cache_take_rows(cache, rows, assay_array_values(coefficients),
                                                  gradients ? assay_array_values(gradients) : NULL);
    status = status ? status
                    : assay_record_bundle_read(
                          context, reader, prefix, rows,
                          assay_irradiance_cache_store(assay_radiance_cache_records(cache)));
    assay_array_destroy(coefficients);
    assay_array_destroy(gradients);
    return status;
}
