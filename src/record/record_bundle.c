/* record_bundle.c - the fields of a record, one array each. */
#include "record/record_bundle.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* A field is a run of doubles inside the record. */
static const struct {
    const char *name, *unit;
    size_t      offset, columns;
} FIELDS[] = {
    {"position", "m", offsetof(assay_record, position), 3},
    {"normal", "", offsetof(assay_record, normal), 3},
    {"radius", "m", offsetof(assay_record, radius), 1},
    {"harmonic_mean", "m", offsetof(assay_record, mean), 1},
    {"nearest", "m", offsetof(assay_record, nearest), 1},
    {"irradiance", "W/m2", offsetof(assay_record, irradiance), 3},
    {"rotation_gradient", "W/(m2 rad)", offsetof(assay_record, rotation), 9},
    {"translation_gradient", "W/m3", offsetof(assay_record, translation), 9},
};

enum { FIELD_COUNT = sizeof FIELDS / sizeof FIELDS[0], NAME_SIZE = 96 };

_Static_assert(sizeof(assay_vec3) == 3 * sizeof(double), "vectors are runs of doubles");
_Static_assert(sizeof(assay_rgb) == 3 * sizeof(double), "and so are colours");

static void name_of(const char *prefix, int field, char name[NAME_SIZE])
{
    snprintf(name, NAME_SIZE, "%s/%s", prefix, FIELDS[field].name);
}

assay_status assay_record_bundle_add(assay_context *context, assay_bundle *bundle,
                                     const char *prefix, const assay_record_store *store)
{
    const uint32_t count  = assay_record_store_count(store);
    assay_status   status = ASSAY_OK;
    for (int f = 0; f < FIELD_COUNT && status == ASSAY_OK; f++) {
        const size_t columns = FIELDS[f].columns;
        assay_array *table   = NULL;
        char         name[NAME_SIZE];
        name_of(prefix, f, name);
        status = assay_array_create(context, count, columns, &table);
        for (uint32_t i = 0; i < count && status == ASSAY_OK; i++) {
            memcpy(assay_array_data(table) + i * columns,
                   (const char *)assay_record_store_at(store, i) + FIELDS[f].offset,
                   columns * sizeof(double));
        }
        status = status ? status : assay_bundle_add_table(bundle, name, FIELDS[f].unit, table);
        assay_array_destroy(table);
    }
    return status;
}

bool assay_record_bundle_is_there(const assay_bundle_reader *reader, const char *prefix)
{
    char name[NAME_SIZE];
    name_of(prefix, 0, name);
    return assay_bundle_lists(reader, name);
}

static assay_status read_fields(assay_bundle_reader *reader, const char *prefix, size_t rows,
                                assay_array *tables[FIELD_COUNT])
{
    assay_status status = ASSAY_OK;
    for (int f = 0; f < FIELD_COUNT && status == ASSAY_OK; f++) {
        char name[NAME_SIZE];
        name_of(prefix, f, name);
        status = assay_bundle_read_table(reader, name, rows, FIELDS[f].columns, &tables[f]);
        rows   = status ? rows : assay_array_rows(tables[f]);
    }
    return status;
}

assay_status assay_record_bundle_read(assay_context *context, assay_bundle_reader *reader,
                                      const char *prefix, size_t rows, assay_record_store *store)
{
    assay_array *tables[FIELD_COUNT] = {NULL};
    assay_status status              = read_fields(reader, prefix, rows, tables);
    const size_t count               = status ? 0 : assay_array_rows(tables[0]);
    for (size_t i = 0; i < count && status == ASSAY_OK; i++) {
        assay_record record;
        for (int f = 0; f < FIELD_COUNT; f++) {
            memcpy((char *)&record + FIELDS[f].offset,
                   assay_array_values(tables[f]) + i * FIELDS[f].columns,
                   FIELDS[f].columns * sizeof(double));
        }
        status = assay_record_store_add(store, &record);
        if (status == ASSAY_ERR_DOMAIN) {
            status = assay_fail(context, ASSAY_ERR_FORMAT,
                                "%s: record %zu has numbers that no record has",
                                assay_bundle_path(reader), i);
        }
    }
    for (int f = 0; f < FIELD_COUNT; f++) {
        assay_array_destroy(tables[f]);
    }
    return status;
}
