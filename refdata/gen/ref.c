/* ref.c - nearest doubles of enclosed numbers.
 *
 * Invariant: a number leaves this file only if every point of its enclosure has the same nearest
 * double (ties to even), and is zero only if it is proven to be.  A result too small for a double
 * is written as 0x0p-1074 with its sign, an exact zero as 0x0p+0. */
#include "ref.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct ref_table {
    FILE *file;
    char  path[512];
    slong keys, columns, rows;
    slong column, row;
};

void ref_fail(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vfprintf(stderr, format, arguments);
    va_end(arguments);
    fputc('\n', stderr);
    exit(1);
}

void *ref_allocate(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (!memory) {
        ref_fail("out of memory");
    }
    return memory;
}

void ref_check_same(const arb_t a, const arb_t b, const char *what)
{
    if (!arb_is_finite(a) || !arb_is_finite(b) || !arb_overlaps(a, b)) {
        fprintf(stderr, "two ways to %s differ: ", what);
        arb_fprintd(stderr, a, 25);
        fprintf(stderr, " and ");
        arb_fprintd(stderr, b, 25);
        ref_fail("%s", "");
    }
}

double ref_radians(slong degrees)
{
    arb_t t;
    arb_init(t);
    arb_const_pi(t, 256);
    arb_mul_si(t, t, degrees, 256);
    arb_div_si(t, t, 180, 256);
    const double nearest = arf_get_d(arb_midref(t), ARF_RND_NEAR);
    arb_clear(t);
    return nearest;
}

/* False where the enclosure is too wide to tell. */
static int round_one(const arb_t x, double *nearest, int *exact_zero)
{
    *exact_zero = arb_is_zero(x);
    if (*exact_zero) {
        *nearest = 0.0;
        return 1;
    }
    if (!arb_is_finite(x) || arb_contains_zero(x) ||
        (!arb_is_exact(x) && arb_rel_accuracy_bits(x) < REF_ACCURACY_BITS)) {
        return 0;
    }
    arf_t low, high;
    arf_init(low);
    arf_init(high);
    arb_get_interval_arf(low, high, x, arb_bits(x) + 128);
    const double a = arf_get_d(low, ARF_RND_NEAR), b = arf_get_d(high, ARF_RND_NEAR);
    arf_clear(low);
    arf_clear(high);
    *nearest = a;
    return a == b && isfinite(a);
}

static int round_both(const arb_t x, int with_low, ref_number *number, slong precision)
{
    if (!round_one(x, &number->high, &number->exact_zero)) {
        return 0;
    }
    number->low = 0.0;
    if (!with_low || number->exact_zero) {
        return 1;
    }
    arb_t rest;
    arb_init(rest);
    arb_set_d(rest, number->high);
    arb_sub(rest, x, rest, precision);
    int       zero;
    const int ok = round_one(rest, &number->low, &zero);
    arb_clear(rest);
    return ok;
}

void ref_round_all(ref_enclosure enclose, void *user, slong count, int with_low,
                   ref_number *numbers)
{
    arb_ptr balls = _arb_vec_init(count);
    slong   bad   = 0;
    for (slong precision = REF_FIRST_PRECISION; precision <= REF_LAST_PRECISION; precision *= 2) {
        enclose(user, balls, count, precision);
        for (bad = 0; bad < count && round_both(balls + bad, with_low, numbers + bad, precision);) {
            bad++;
        }
        if (bad == count) {
            _arb_vec_clear(balls, count);
            return;
        }
    }
    arb_fprintd(stderr, balls + bad, 30);
    ref_fail(": number %ld cannot be rounded", (long)bad);
}

static slong count_words(const char *text)
{
    slong words = 0;
    for (const char *c = text; *c; c++) {
        words += *c != ' ' && (c == text || c[-1] == ' ');
    }
    return words;
}

ref_table *ref_create(const char *directory, const ref_header *header)
{
    ref_table *table = ref_allocate(1, sizeof *table);
    snprintf(table->path, sizeof table->path, "%s/%s.txt", directory, header->name);
    table->file = fopen(table->path, "w");
    if (!table->file) {
        ref_fail("%s: cannot be written", table->path);
    }
    table->keys    = count_words(header->keys);
    table->columns = header->columns;
    table->rows    = header->rows;
    fprintf(table->file, "# table: %s\n# content: %s\n", header->name, header->content);
    fprintf(table->file, "# generator: refdata/gen/%s.c (Arb ball arithmetic)\n",
            header->generator);
    fprintf(table->file, "# command: make ref (runs: %s DIRECTORY)\n", header->generator);
    fprintf(table->file, "# method: %s\n", header->method);
    fprintf(table->file,
            "# precision: balls of %d bits and more, doubled until the nearest double is unique\n",
            REF_FIRST_PRECISION);
    fprintf(table->file, "# radius: of every enclosure at most 2^-%d of its number, proven\n",
            REF_ACCURACY_BITS);
    fprintf(table->file, "# convention: %s\n", header->notes);
    fprintf(table->file, "# keys: %s\n# values: %s\n", header->keys, header->values);
    fprintf(table->file, "# rows: %ld\n# columns: %ld\n", (long)header->rows,
            (long)(table->keys + header->columns));
    return table;
}

static void write_separator(ref_table *table)
{
    if (table->column++) {
        fputc(' ', table->file);
    }
}

/* Integers as such, all else as hexfloats. */
void ref_key(ref_table *table, double key)
{
    write_separator(table);
    if (key == floor(key) && fabs(key) < 1e6) {
        fprintf(table->file, "%d", (int)key);
    } else {
        fprintf(table->file, "%a", key);
    }
}

static void write_double(ref_table *table, double value, int exact_zero)
{
    write_separator(table);
    if (value != 0.0) {
        fprintf(table->file, "%a", value);
    } else {
        fprintf(table->file, "%s",
                exact_zero ? "0x0p+0" : (signbit(value) ? "-0x0p-1074" : "0x0p-1074"));
    }
}

void ref_value(ref_table *table, const ref_number *number)
{
    write_double(table, number->high, number->exact_zero);
}

void ref_low(ref_table *table, const ref_number *number)
{
    write_double(table, number->low, number->low == 0.0);
}

void ref_end_row(ref_table *table)
{
    if (table->column != table->keys + table->columns) {
        ref_fail("%s: row %ld has %ld columns", table->path, (long)table->row, (long)table->column);
    }
    fputc('\n', table->file);
    table->column = 0;
    table->row++;
}

void ref_finish(ref_table *table)
{
    if (table->row != table->rows) {
        ref_fail("%s: %ld rows", table->path, (long)table->row);
    }
    const int bad = ferror(table->file);
    if (fclose(table->file) || bad) {
        ref_fail("%s: cannot be written", table->path);
    }
    free(table);
}
