/* npy_read.c - NumPy's .npy format, versions 1 to 3.
 *
 * The header is a Python dictionary with the keys descr, fortran_order and shape; what is read here
 * is what numpy.lib.format accepts of it for plain tables, keys in any order.  The number of values
 * must be that of the shape exactly: a file with more holds something else.
 *
 * Invariant: header_text.at never passes header_text.end, and no size is trusted before it was
 * compared with the bytes that are there. */
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/array_data.h"
#include "io/half.h"
#include "io/npy.h"
#include "io/read_file.h"

typedef struct {
    const char *at, *end;
} header_text;

typedef struct {
    char     descr[16];
    bool     has_descr, has_order, has_shape, fortran;
    uint64_t shape[2];
    int      dimensions; /* 3 stands for more than two */
} npy_header;

static void skip_space(header_text *text)
{
    while (text->at < text->end && (*text->at == ' ' || *text->at == '\t' || *text->at == '\n')) {
        text->at++;
    }
}

/* Skips space, then takes the character if it is there. */
static bool take(header_text *text, char c)
{
    skip_space(text);
    if (text->at < text->end && *text->at == c) {
        text->at++;
        return true;
    }
    return false;
}

static bool take_word(header_text *text, const char *word)
{
    const size_t length = strlen(word);
    skip_space(text);
    if ((size_t)(text->end - text->at) < length || memcmp(text->at, word, length) != 0) {
        return false;
    }
    text->at += length;
    return true;
}

/* 'text' or "text" without escapes, shortened to room - 1. */
static bool take_string(header_text *text, char *string_out, size_t room)
{
    const char quote  = take(text, '\'') ? '\'' : take(text, '"') ? '"' : 0;
    size_t     length = 0;
    if (!quote) {
        return false;
    }
    while (text->at < text->end && *text->at != quote) {
        if (*text->at == '\\' || *text->at == 0) {
            return false;
        }
        if (length + 1 < room) {
            string_out[length++] = *text->at;
        }
        text->at++;
    }
    string_out[length] = 0;
    return take(text, quote);
}

static bool take_size(header_text *text, uint64_t *size_out)
{
    uint64_t size  = 0;
    bool     digit = false;
    skip_space(text);
    for (; text->at < text->end && *text->at >= '0' && *text->at <= '9'; text->at++) {
        const uint64_t d = (uint64_t)(*text->at - '0');
        size             = size > (UINT64_MAX - d) / 10 ? UINT64_MAX : size * 10 + d;
        digit            = true;
    }
    *size_out = size;
    return digit;
}

static bool take_shape(header_text *text, npy_header *header)
{
    header->dimensions = 0;
    if (!take(text, '(')) {
        return false;
    }
    while (!take(text, ')')) {
        uint64_t size = 0;
        if (!take_size(text, &size)) {
            return false;
        }
        if (header->dimensions < 2) {
            header->shape[header->dimensions] = size;
        }
        header->dimensions += header->dimensions < 3;
        if (!take(text, ',')) {
            return take(text, ')');
        }
    }
    return true;
}

static bool take_entry(header_text *text, npy_header *header)
{
    char key[16];
    if (!take_string(text, key, sizeof key) || !take(text, ':')) {
        return false;
    }
    if (strcmp(key, "descr") == 0) {
        header->has_descr = true;
        skip_space(text);
        if (text->at < text->end && *text->at == '[') {
            snprintf(header->descr, sizeof header->descr, "a structure");
            text->at = text->end;
            return true;
        }
        return take_string(text, header->descr, sizeof header->descr);
    }
    if (strcmp(key, "fortran_order") == 0) {
        header->has_order = true;
        header->fortran   = take_word(text, "True");
        return header->fortran || take_word(text, "False");
    }
    if (strcmp(key, "shape") == 0) {
        header->has_shape = true;
        return take_shape(text, header);
    }
    return false;
}

static bool parse_header(header_text text, npy_header *header)
{
    if (!take(&text, '{')) {
        return false;
    }
    while (!take(&text, '}')) {
        if (!take_entry(&text, header)) {
            return false;
        }
        if (strcmp(header->descr, "a structure") == 0) {
            return true;
        }
        if (!take(&text, ',')) {
            if (!take(&text, '}')) {
                return false;
            }
            break;
        }
    }
    skip_space(&text);
    return text.at == text.end && header->has_descr && header->has_order && header->has_shape;
}

/* 0 for what is no float of the little end. */
static size_t item_bytes_of(const char *descr)
{
    return strcmp(descr, "<f8") == 0   ? 8
           : strcmp(descr, "<f4") == 0 ? 4
           : strcmp(descr, "<f2") == 0 ? 2
                                       : 0;
}

/* Refuses what is well-formed but not a table of floats. */
static assay_status check_header(assay_context *context, const char *name, npy_header *header,
                                 size_t bytes_left, size_t *item_bytes_out)
{
    const size_t item_bytes = item_bytes_of(header->descr);
    if (item_bytes == 0) {
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: the values are of type '%s'; save them as '<f8', '<f4' or '<f2'",
                          name, header->descr);
    }
    if (header->fortran) {
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: the table is in Fortran order; save numpy.ascontiguousarray of it",
                          name);
    }
    if (header->dimensions == 1) {
        header->shape[1] = 1;
    } else if (header->dimensions != 2) {
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: the table has %s dimensions; one or two are read", name,
                          header->dimensions ? "more than two" : "no");
    }
    const uint64_t rows = header->shape[0], columns = header->shape[1];
    if (columns == 0 || rows > ASSAY_ARRAY_MAX_VALUES / columns) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "%s: a table of %llu x %llu values; it needs a column, and at most %llu "
                          "values are read",
                          name, (unsigned long long)rows, (unsigned long long)columns,
                          (unsigned long long)ASSAY_ARRAY_MAX_VALUES);
    }
    *item_bytes_out       = item_bytes;
    const uint64_t needed = rows * columns * item_bytes;
    if (needed != bytes_left) {
        return assay_fail(context, ASSAY_ERR_FORMAT,
                          "%s: %llu x %llu values need %llu bytes, and %zu are there", name,
                          (unsigned long long)rows, (unsigned long long)columns,
                          (unsigned long long)needed, bytes_left);
    }
    return ASSAY_OK;
}

static double read_value(const uint8_t *bytes, size_t item_bytes)
{
    uint64_t bits = 0;
    for (size_t i = 0; i < item_bytes; i++) {
        bits |= (uint64_t)bytes[i] << (8 * i);
    }
    if (item_bytes < 8) {
        const uint32_t low =
            item_bytes == 4 ? (uint32_t)bits : assay_half_to_float_bits((uint16_t)bits);
        float f;
        memcpy(&f, &low, sizeof f);
        return f;
    }
    double d;
    memcpy(&d, &bits, sizeof d);
    return d;
}

/* Where the header's text lies; false where the file is too short for what it says. */
static bool find_header(const uint8_t *bytes, size_t count, size_t *start_out, size_t *length_out)
{
    const bool wide = count > 6 && bytes[6] > 1;
    *start_out      = wide ? 12 : 10;
    if (count < *start_out) {
        return false;
    }
    *length_out = (size_t)bytes[8] | (size_t)bytes[9] << 8;
    if (wide) {
        *length_out |= (size_t)bytes[10] << 16 | (size_t)bytes[11] << 24;
    }
    return *length_out <= count - *start_out;
}

assay_status assay_array_decode_npy(assay_context *context, const uint8_t *bytes, size_t count,
                                    const char *name, assay_array **array_out)
{
    if (count < 8 || memcmp(bytes, "\223NUMPY", 6) != 0) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: not a NumPy .npy file", name);
    }
    if (bytes[6] < 1 || bytes[6] > 3) {
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: .npy version %d; 1, 2 and 3 are read", name, bytes[6]);
    }
    size_t start = 0, length = 0, item_bytes = 0;
    if (!find_header(bytes, count, &start, &length)) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: the .npy header is cut short", name);
    }
    const char *text   = (const char *)bytes + start;
    npy_header  header = {0};
    if (!parse_header((header_text){text, text + length}, &header)) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: the .npy header is malformed", name);
    }
    const uint8_t *values = bytes + start + length;
    assay_status status = check_header(context, name, &header, count - start - length, &item_bytes);
    assay_array *array  = NULL;
    if (status == ASSAY_OK) {
        status = assay_array_create(context, header.shape[0], header.shape[1], &array);
    }
    if (status == ASSAY_OK && !(array->name = assay_copy_text(context, name))) {
        status = assay_fail_memory(context, name);
    }
    if (status != ASSAY_OK) {
        assay_array_destroy(array);
        return status;
    }
    array->file_bytes = item_bytes;
    for (size_t i = 0; i < array->rows * array->columns; i++) {
        array->values[i] = read_value(values + i * item_bytes, item_bytes);
    }
    *array_out = array;
    return ASSAY_OK;
}

assay_status assay_array_read_npy(assay_context *context, const char *path, assay_array **array_out)
{
    uint8_t     *bytes  = NULL;
    size_t       count  = 0;
    assay_status status = assay_read_file(context, path, ASSAY_NPY_MAX_FILE, &bytes, &count);
    if (status == ASSAY_OK) {
        status = assay_array_decode_npy(context, bytes, count, path, array_out);
        assay_release(context, bytes);
    }
    return status;
}
