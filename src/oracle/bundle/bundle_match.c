/* bundle_match.c - Invariant: what passes here was read whole once, so a stage that is not looked
 * at hides no broken file. */
#include "oracle/bundle/bundle_match.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"

/* ---- how it was made ---- */

/* What changes no number: the writer's name, paths, and what else is written. */
static bool is_free(const char *key)
{
    static const char *const free_keys[] = {"format", "tool", "assay:version", "content", "bounds"};
    static const char *const free_ends[] = {".cache_in", ".cache_out", ".reference", ".debug",
                                            ".dump_batch"};
    for (size_t i = 0; i < sizeof free_keys / sizeof free_keys[0]; i++) {
        if (strcmp(key, free_keys[i]) == 0) {
            return true;
        }
    }
    const size_t length = strlen(key);
    for (size_t i = 0; i < sizeof free_ends / sizeof free_ends[0]; i++) {
        const size_t end = strlen(free_ends[i]);
        if (length > end && strcmp(key + length - end, free_ends[i]) == 0) {
            return true;
        }
    }
    return false;
}

/* Numbers may be written in another way. */
static bool same_text(const char *a, const char *b)
{
    while (strcmp(a, b) != 0) {
        char        *end_a = NULL, *end_b = NULL;
        const double x = strtod(a, &end_a), y = strtod(b, &end_b);
        if (end_a == a || end_b == b || x != y) {
            return false;
        }
        a = end_a;
        b = end_b;
    }
    return true;
}

/* Why a text that is wanted is none. */
static const char *lack_of(const assay_bundle_reader *reader, const char *key)
{
    const char *value = NULL;
    for (int i = 0; i < assay_bundle_text_count(reader); i++) {
        if (strcmp(assay_bundle_text_at(reader, i, &value), key) == 0) {
            return "no text";
        }
    }
    return "missing";
}

assay_status bundle_match_making(assay_context *context, const assay_bundle_reader *candidate,
                                 const assay_bundle_reader *reference)
{
    for (int i = 0; i < assay_bundle_text_count(reference); i++) {
        const char *wanted = NULL;
        const char *key    = assay_bundle_text_at(reference, i, &wanted);
        if (!wanted || is_free(key)) {
            continue;
        }
        const char *found = assay_bundle_text(candidate, key);
        if (!found) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "%s: bundle: of another making than %s: '%s' is %s, there it is "
                              "'%.80s'",
                              assay_bundle_path(candidate), assay_bundle_path(reference), key,
                              lack_of(candidate, key), wanted);
        }
        if (!same_text(found, wanted)) {
            return assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "%s: bundle: of another making than %s: '%s' is '%.80s', not '%.80s'",
                              assay_bundle_path(candidate), assay_bundle_path(reference), key,
                              found, wanted);
        }
    }
    return ASSAY_OK;
}

/* ---- arrays ---- */

bool bundle_find_like(const assay_bundle_reader *reference, const char *name,
                      assay_bundle_entry *entry_out)
{
    static const char batch[] = "/batch.";
    char              other[ASSAY_BUNDLE_NAME];
    const char       *at = strstr(name, batch);
    if (assay_bundle_has(reference, name)) {
        return assay_bundle_entry_of(reference, name, entry_out) == ASSAY_OK;
    }
    if (!at) {
        return false;
    }
    const char *number = at + sizeof batch - 1;
    snprintf(other, sizeof other, "%.*s0%s", (int)(number - name), name,
             number + strspn(number, "0123456789"));
    return assay_bundle_has(reference, other) &&
           assay_bundle_entry_of(reference, other, entry_out) == ASSAY_OK;
}

static size_t rows_of(const assay_bundle_entry *entry)
{
    return entry->dimensions == 3 ? entry->shape[0] * entry->shape[1] : entry->shape[0];
}

static size_t columns_of(const assay_bundle_entry *entry)
{
    return entry->dimensions == 1 ? 1 : entry->shape[entry->dimensions - 1];
}

/* Candidates may need other numbers of records. */
static bool has_free_rows(const char *name)
{
    return strncmp(name, "records", 7) == 0 || strncmp(name, "radiance_records", 16) == 0 ||
           strncmp(name, "gather/", 7) == 0 || strstr(name, "batch_end");
}

static bool is_type(const assay_bundle_entry *entry)
{
    const char *t = entry->dtype;
    return entry->image ? strcmp(t, "float32") == 0 || strcmp(t, "uint32") == 0
                        : strcmp(t, "float64") == 0 || strcmp(t, "float32") == 0 ||
                              strcmp(t, "float16") == 0;
}

static assay_status fail_array(assay_context *context, const assay_bundle_reader *candidate,
                               const assay_bundle_entry *entry, const char *what)
{
    return assay_fail(context, ASSAY_ERR_FORMAT, "%s: bundle: '%s' %s",
                      assay_bundle_path(candidate), entry->name, what);
}

static assay_status match_entry(assay_context *context, const assay_bundle_reader *candidate,
                                const assay_bundle_reader *reference,
                                const assay_bundle_entry  *entry)
{
    assay_bundle_entry like = {.name = NULL};
    if (!is_type(entry)) {
        return fail_array(
            context, candidate, entry,
            "has a dtype that is not float64, float32, float16 (of an image: float32, "
            "uint32)");
    }
    if (!reference) {
        return ASSAY_OK;
    }
    if (!bundle_find_like(reference, entry->name, &like)) {
        return fail_array(context, candidate, entry, "is not an array of the reference");
    }
    if (strcmp(entry->unit, like.unit) != 0) {
        char words[128];
        snprintf(words, sizeof words, "is in '%.40s', not in '%.40s'", entry->unit, like.unit);
        return fail_array(context, candidate, entry, words);
    }
    if (columns_of(entry) != columns_of(&like) ||
        (rows_of(entry) != rows_of(&like) && !has_free_rows(entry->name))) {
        char words[160];
        snprintf(words, sizeof words, "is of %zu x %zu numbers, the reference's of %zu x %zu",
                 rows_of(entry), columns_of(entry), rows_of(&like), columns_of(&like));
        return fail_array(context, candidate, entry, words);
    }
    return ASSAY_OK;
}

typedef struct {
    size_t nan, infinite, first;
} oddities;

static oddities count_odd(const assay_array *table)
{
    const size_t  count = assay_array_rows(table) * assay_array_columns(table);
    const double *v     = assay_array_values(table);
    oddities      o     = {.first = SIZE_MAX};
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(v[i])) {
            o.nan += isnan(v[i]);
            o.infinite += !isnan(v[i]);
            o.first = o.first == SIZE_MAX ? i : o.first;
        }
    }
    return o;
}

static assay_status count_like(const assay_bundle_reader *reference, const char *name,
                               oddities *odd_out)
{
    assay_bundle_entry like   = {.name = NULL};
    assay_array       *table  = NULL;
    assay_status       status = bundle_find_like(reference, name, &like)
                                    ? assay_bundle_read_array(reference, like.name, NULL, &table)
                                    : ASSAY_OK;
    if (status == ASSAY_OK) {
        *odd_out = count_odd(table);
    }
    assay_array_destroy(table);
    return status;
}

static assay_status match_values(assay_context *context, const assay_bundle_reader *candidate,
                                 const assay_bundle_reader *reference,
                                 const assay_bundle_entry  *entry)
{
    assay_array *table  = NULL;
    assay_status status = assay_bundle_read_array(candidate, entry->name, NULL, &table);
    if (status != ASSAY_OK) {
        return status;
    }
    const oddities odd = count_odd(table);
    if (reference && odd.nan + odd.infinite > 0) {
        oddities theirs = {0};
        status          = count_like(reference, entry->name, &theirs);
        if (status == ASSAY_OK &&
            ((odd.nan > 0 && theirs.nan == 0) || (odd.infinite > 0 && theirs.infinite == 0))) {
            const size_t columns = assay_array_columns(table);
            status               = assay_fail(context, ASSAY_ERR_DOMAIN,
                                              "%s: bundle: '%s', row %zu, column %zu: a number that is not "
                                                            "finite, of which the reference has none",
                                              assay_bundle_path(candidate), entry->name, odd.first / columns,
                                              odd.first % columns);
        }
    }
    assay_array_destroy(table);
    return status;
}

static assay_status check_unique(assay_context *context, const assay_bundle_reader *candidate,
                                 int index, const assay_bundle_entry *entry)
{
    for (int i = 0; i < index; i++) {
        assay_bundle_entry other = {.name = NULL};
        if (assay_bundle_entry_at(candidate, i, &other) == ASSAY_OK &&
            strcmp(other.name, entry->name) == 0) {
            return fail_array(context, candidate, entry, "is listed twice");
        }
    }
    return ASSAY_OK;
}

assay_status bundle_match_arrays(assay_context *context, const assay_bundle_reader *candidate,
                                 const assay_bundle_reader *reference)
{
    for (int i = 0; i < assay_bundle_count(candidate); i++) {
        assay_bundle_entry entry  = {.name = NULL};
        assay_status       status = assay_bundle_entry_at(candidate, i, &entry);
        status                    = status ? status : check_unique(context, candidate, i, &entry);
        status = status ? status : match_entry(context, candidate, reference, &entry);
        status = status ? status : match_values(context, candidate, reference, &entry);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}
