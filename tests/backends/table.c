/* table.c - .npy in and out.
 *
 * The header of .npy is a Python dictionary; what it must hold is looked for word by word, and the
 * file's length has to be what the shape says. */
#include "table.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Noreturn void fail(const char *format, ...)
{
    va_list words;
    va_start(words, format);
    fputs("backend: ", stderr);
    vfprintf(stderr, format, words);
    fputc('\n', stderr);
    va_end(words);
    exit(2);
}

void *allocate(size_t count, size_t size)
{
    void *block = calloc(count ? count : 1, size);
    return block ? block : (fail("no memory"), NULL);
}

table table_make(size_t rows, size_t columns)
{
    return (table){rows, columns, allocate(rows * columns, sizeof(float))};
}

table table_copy(const table *t)
{
    table copy = table_make(t->rows, t->columns);
    memcpy(copy.values, t->values, t->rows * t->columns * sizeof *copy.values);
    return copy;
}

void table_release(table *t)
{
    free(t->values);
    *t = (table){0, 0, NULL};
}

static float float_of_half(uint16_t half)
{
    const int exponent = half >> 10 & 31, fraction = half & 1023;
    float     size = exponent == 0 ? (float)fraction * 0x1p-24f : (float)(fraction + 1024);
    for (int i = 25; i < exponent; i++) {
        size *= 2.0f;
    }
    for (int i = exponent; exponent > 0 && i < 25; i++) {
        size *= 0.5f;
    }
    if (exponent == 31) {
        const uint32_t bits = 0x7f800000u | (uint32_t)fraction << 13;
        memcpy(&size, &bits, sizeof size);
    }
    return half & 0x8000 ? -size : size;
}

static void take_numbers(const unsigned char *bytes, char kind, table *t)
{
    for (size_t i = 0; i < t->rows * t->columns; i++) {
        double   wide;
        uint16_t half;
        switch (kind) {
        case '8':
            memcpy(&wide, bytes + 8 * i, 8);
            t->values[i] = (float)wide;
            break;
        case '4': memcpy(&t->values[i], bytes + 4 * i, 4); break;
        default: memcpy(&half, bytes + 2 * i, 2); t->values[i] = float_of_half(half);
        }
    }
}

/* "(12, 3)", "(12,)" */
static void take_shape(const char *path, const char *header, table *t)
{
    const char *at   = strstr(header, "'shape':");
    size_t      rows = 1, last = 1, count = 0;
    at = at ? strchr(at, '(') : NULL;
    if (!at) {
        fail("%s: no shape", path);
    }
    for (at++; *at && *at != ')';) {
        char *end;
        if (*at == ' ' || *at == ',') {
            at++;
            continue;
        }
        rows *= last;
        last = strtoul(at, &end, 10);
        if (end == at) {
            fail("%s: a shape that is not numbers", path);
        }
        at = end;
        count++;
    }
    *t = count == 1 ? (table){last, 1, NULL} : (table){rows, last, NULL};
}

static unsigned char *read_all(const char *path, size_t *size_out)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0) {
        fail("%s: cannot be read", path);
    }
    const long size = ftell(file);
    rewind(file);
    unsigned char *bytes = allocate((size_t)size + 1, 1);
    if (size < 0 || fread(bytes, 1, (size_t)size, file) != (size_t)size) {
        fail("%s: cannot be read", path);
    }
    fclose(file);
    *size_out = (size_t)size;
    return bytes;
}

table table_read_npy(const char *path)
{
    size_t         size;
    unsigned char *bytes = read_all(path, &size);
    table          t;
    if (size < 12 || memcmp(bytes, "\x93NUMPY", 6) != 0) {
        fail("%s: not .npy", path);
    }
    const size_t start  = bytes[6] == 1 ? 10 : 12;
    const size_t length = bytes[6] == 1 ? bytes[8] + 256u * bytes[9]
                                        : bytes[8] + 256u * bytes[9] + 65536u * bytes[10];
    if (start + length > size) {
        fail("%s: the header is cut short", path);
    }
    char *header = allocate(length + 1, 1);
    memcpy(header, bytes + start, length);
    const char *kind = strstr(header, "'<f");
    if (!kind || !strchr("248", kind[3]) || strstr(header, "'fortran_order': True")) {
        fail("%s: not little-endian floats in C order", path);
    }
    take_shape(path, header, &t);
    t.values = allocate(t.rows * t.columns, sizeof *t.values);
    if (size != start + length + t.rows * t.columns * (size_t)(kind[3] - '0')) {
        fail("%s: not as long as its shape says", path);
    }
    take_numbers(bytes + start + length, kind[3], &t);
    free(header);
    free(bytes);
    return t;
}

void table_write_npy(const char *path, const table *t)
{
    enum { HEADER = 128 };
    char  words[HEADER] = {0}, padded[HEADER];
    FILE *file          = fopen(path, "wb");
    snprintf(words, sizeof words, "{'descr': '<f4', 'fortran_order': False, 'shape': (%zu, %zu), }",
             t->rows, t->columns);
    memcpy(padded, "\x93NUMPY\x01\x00", 8);
    padded[8] = HEADER - 10;
    padded[9] = 0;
    memset(padded + 10, ' ', HEADER - 11);
    memcpy(padded + 10, words, strlen(words));
    padded[HEADER - 1] = '\n';
    const size_t count = t->rows * t->columns;
    if (!file || fwrite(padded, 1, HEADER, file) != HEADER ||
        fwrite(t->values, sizeof(float), count, file) != count || fclose(file) != 0) {
        fail("%s: cannot be written", path);
    }
}
