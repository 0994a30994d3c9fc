/* reference_table.c - reads what refdata/gen writes.
 *
 * Invariant: a table is given out only if its header names it, and every row has exactly the
 * numbers that the header promises, all finite. */
#include "support/reference_table.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *reference_file_bytes(const char *path, size_t *size_out)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        fail_msg("%s is missing: run from the top folder; make ref-update makes it", path);
        return NULL;
    }
    size_t size = 0, room = 1 << 16;
    char  *bytes = malloc(room + 1);
    assert_non_null(bytes);
    for (size_t got; (got = fread(bytes + size, 1, room - size, file)) > 0;) {
        size += got;
        if (size == room) {
            room *= 2;
            char *grown = realloc(bytes, room + 1);
            assert_non_null(grown);
            bytes = grown;
        }
    }
    assert_int_equal(ferror(file), 0);
    fclose(file);
    bytes[size] = '\0';
    *size_out   = size;
    return bytes;
}

/* Value of "# key: value", or NULL. */
static const char *header_value(const char *line, const char *key)
{
    const size_t length = strlen(key);
    return strncmp(line, "# ", 2) == 0 && strncmp(line + 2, key, length) == 0 &&
                   strncmp(line + 2 + length, ": ", 2) == 0
               ? line + length + 4
               : NULL;
}

static size_t count_words(const char *text)
{
    size_t words = 0;
    for (const char *c = text; *c; c++) {
        words += *c != ' ' && (c == text || c[-1] == ' ');
    }
    return words;
}

static void take_header(reference_table *table, const char *line)
{
    const char *value;
    if ((value = header_value(line, "table"))) {
        snprintf(table->name, sizeof table->name, "%s", value);
    } else if ((value = header_value(line, "keys"))) {
        table->keys = count_words(value);
    } else if ((value = header_value(line, "rows"))) {
        table->rows = (size_t)strtoul(value, NULL, 10);
    } else if ((value = header_value(line, "columns"))) {
        table->columns = (size_t)strtoul(value, NULL, 10);
    }
}

/* Exactly `columns` finite numbers with one blank between. */
static bool take_row(double *numbers, size_t columns, const char *line)
{
    for (size_t i = 0; i < columns; i++) {
        char *end;
        if (*line == ' ') {
            return false;
        }
        numbers[i] = strtod(line, &end);
        if (end == line || !isfinite(numbers[i]) || *end != (i + 1 < columns ? ' ' : '\0')) {
            return false;
        }
        line = end + 1;
    }
    return true;
}

static const char *take_lines(reference_table *table, char *text)
{
    size_t row = 0;
    for (char *line = text, *next; *line; line = next) {
        char *end = strchr(line, '\n');
        if (!end) {
            return "the last line does not end";
        }
        *end = '\0';
        next = end + 1;
        if (*line == '#') {
            if (table->numbers) {
                return "a header line among the rows";
            }
            take_header(table, line);
            continue;
        }
        if (!table->numbers) {
            if (!table->name[0] || !table->keys || !table->rows || table->rows > 1000000 ||
                table->columns <= table->keys || table->columns > 100000) {
                return "the header does not say table, keys, rows and columns";
            }
            table->numbers = calloc(table->rows * table->columns, sizeof *table->numbers);
            if (!table->numbers) {
                return "out of memory";
            }
        }
        if (row == table->rows) {
            return "more rows than the header says";
        }
        if (!take_row(table->numbers + row * table->columns, table->columns, line)) {
            return "a row does not hold the numbers that the header says";
        }
        row++;
    }
    return row && row == table->rows ? NULL : "fewer rows than the header says";
}

reference_table *reference_table_parse(char *text, const char **why_out)
{
    reference_table *table = calloc(1, sizeof *table);
    *why_out               = table ? take_lines(table, text) : "out of memory";
    if (*why_out) {
        reference_table_free(table);
        return NULL;
    }
    return table;
}

reference_table *reference_table_read(const char *name)
{
    char        path[256];
    size_t      size;
    const char *why;
    snprintf(path, sizeof path, "refdata/basis/%s.txt", name);
    char *text = reference_file_bytes(path, &size);
    if (strlen(text) != size) {
        fail_msg("%s: a NUL inside", path);
    }
    reference_table *table = reference_table_parse(text, &why);
    free(text);
    if (!table) {
        fail_msg("%s: %s", path, why);
    } else if (strcmp(table->name, name) != 0) {
        fail_msg("%s: holds the table %s", path, table->name);
    }
    return table;
}

void reference_table_free(reference_table *table)
{
    if (table) {
        free(table->numbers);
        free(table);
    }
}

const double *reference_table_keys(const reference_table *table, size_t row)
{
    assert_true(row < table->rows);
    return table->numbers + row * table->columns;
}

const double *reference_table_values(const reference_table *table, size_t row)
{
    return reference_table_keys(table, row) + table->keys;
}

size_t reference_table_find(const reference_table *table, const double *keys, size_t key_count)
{
    for (size_t row = 0; row < table->rows; row++) {
        if (memcmp(reference_table_keys(table, row), keys, key_count * sizeof *keys) == 0) {
            return row;
        }
    }
    fail_msg("%s: no row with the key %.17g", table->name, keys[0]);
    return 0;
}
