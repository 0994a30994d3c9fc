/* test_npy.c - tables and NumPy files. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/npy.h"
#include "support/broken.h"
#include "support/failing_context.h"
#include "support/temporary.h"

static const uint64_t special_bits[] = {
    0x0000000000000000u, 0x8000000000000000u, 0x0000000000000001u, 0x800fffffffffffffu,
    0x0010000000000000u, 0x7fefffffffffffffu, 0x7ff0000000000000u, 0xfff0000000000000u,
    0x7ff8000000000000u, 0xfff8123456789abcu, 0x3ff0000000000000u, 0x3fefffffffffffffu};

/* A .npy file of a version with a header and values. */
static size_t make_file(uint8_t *out, int version, const char *header, const void *values,
                        size_t value_bytes)
{
    const size_t length = strlen(header) + 1, prefix = version == 1 ? 10 : 12;
    memcpy(out, "\223NUMPY", 6);
    out[6] = (uint8_t)version;
    out[7] = 0;
    for (size_t i = 8; i < prefix; i++) {
        out[i] = (uint8_t)(length >> (8 * (i - 8)));
    }
    memcpy(out + prefix, header, length - 1);
    out[prefix + length - 1] = '\n';
    memcpy(out + prefix + length, values, value_bytes);
    return prefix + length + value_bytes;
}

static void tables_are_zero_and_limited(void **state)
{
    assay_array *array = NULL;
    assert_int_equal(assay_array_create(*state, 3, 2, &array), ASSAY_OK);
    assert_int_equal(assay_array_rows(array), 3);
    assert_int_equal(assay_array_columns(array), 2);
    for (int i = 0; i < 6; i++) {
        assert_true(assay_array_values(array)[i] == 0.0);
    }
    assert_ptr_equal(assay_array_data(array), assay_array_values(array));
    assay_array_destroy(array);
    assay_array_destroy(NULL);
    array = NULL;
    assert_int_equal(assay_array_create(*state, 3, 0, &array), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_array_create(*state, (size_t)1 << 31, 2, &array), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_array_create(*state, SIZE_MAX, SIZE_MAX, &array), ASSAY_ERR_ARGUMENT);
    assert_null(array);
    assert_int_equal(assay_array_create(*state, 0, 6, &array), ASSAY_OK);
    assay_array_destroy(array);
}

static void round_trip_is_bit_exact(void **state)
{
    static const size_t shapes[][2] = {{1, 1}, {12, 1}, {3, 4}, {0, 6}, {2, 6}};
    temporary           t           = temporary_create();
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        const size_t rows = shapes[s][0], columns = shapes[s][1];
        const char  *path  = temporary_path(&t, "a.npy");
        assay_array *array = NULL, *back = NULL;
        size_t       count = 0;
        assert_int_equal(assay_array_create(*state, rows, columns, &array), ASSAY_OK);
        memcpy(assay_array_data(array), special_bits, rows * columns * 8);
        assert_int_equal(assay_array_write_npy(array, path), ASSAY_OK);
        assert_int_equal(assay_array_read_npy(*state, path, &back), ASSAY_OK);
        assert_int_equal(assay_array_rows(back), rows);
        assert_int_equal(assay_array_columns(back), columns);
        assert_memory_equal(assay_array_values(back), special_bits, rows * columns * 8);
        uint8_t *bytes = temporary_read(path, &count);
        assert_int_equal(count, 128 + rows * columns * 8);
        assert_memory_equal(bytes, "\223NUMPY\1\0\x76\0{'descr': '<f8', 'fortran_order': False, ",
                            51);
        assert_int_equal(bytes[127], '\n');
        free(bytes);
        assay_array_destroy(array);
        assay_array_destroy(back);
    }
    temporary_destroy(&t);
}

static void accepted_headers(void **state)
{
    static const double values[]  = {1.5, -2.0, 3.25, 4.0, 5.0, 6.0};
    static const float  singles[] = {1.5f, -2.0f, 3.25f, 4.0f, 5.0f, 6.0f};
    static const struct {
        int         version;
        const char *header;
        size_t      rows, columns;
        bool        single;
    } rows[] = {{1, "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", 2, 3, false},
                {1, "{'descr': '<f8', 'fortran_order': False, 'shape': (6,), }      ", 6, 1, false},
                {2, "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 2), }", 3, 2, true},
                {3, "{\"shape\":(2,3,),\"fortran_order\":False,\"descr\":\"<f4\"}", 2, 3, true},
                {1, "{ 'fortran_order' :False ,'shape': ( 6 , 1 ) , 'descr': '<f8'}", 6, 1, false},
                {1, "{'descr': '<f8', 'fortran_order': False, 'shape': (06), }", 6, 1, false}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t      bytes[300];
        assay_array *array = NULL;
        const size_t count =
            rows[i].single
                ? make_file(bytes, rows[i].version, rows[i].header, singles, sizeof singles)
                : make_file(bytes, rows[i].version, rows[i].header, values, sizeof values);
        assert_int_equal(assay_array_decode_npy(*state, bytes, count, "x", &array), ASSAY_OK);
        assert_int_equal(assay_array_rows(array), rows[i].rows);
        assert_int_equal(assay_array_columns(array), rows[i].columns);
        assert_memory_equal(assay_array_values(array), values, sizeof values);
        assay_array_destroy(array);
    }
}

/* Halves: 1.5, -2, the largest, the smallest subnormal, infinity. */
static void half_values(void **state)
{
    static const uint16_t halves[]   = {0x3e00, 0xc000, 0x7bff, 0x0001, 0x7c00};
    static const double   expected[] = {1.5, -2.0, 65504.0, 0x1p-24, INFINITY};
    uint8_t               bytes[300];
    assay_array          *array = NULL;
    const size_t          count =
        make_file(bytes, 1, "{'descr': '<f2', 'fortran_order': False, 'shape': (5,), }", halves,
                  sizeof halves);
    assert_int_equal(assay_array_decode_npy(*state, bytes, count, "x", &array), ASSAY_OK);
    assert_int_equal(assay_array_rows(array), 5);
    assert_memory_equal(assay_array_values(array), expected, sizeof expected);
    assay_array_destroy(array);
}

static void refused_headers(void **state)
{
    static const double values[] = {1.5, -2.0, 3.25, 4.0, 5.0, 6.0};
    static const struct {
        const char  *header;
        assay_status status;
    } rows[] = {
        {"{'descr': '<i8', 'fortran_order': False, 'shape': (2, 3), }", ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '>f8', 'fortran_order': False, 'shape': (2, 3), }", ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '<f8aaaaaaaaaaaaaaaaaaaaaaaa', 'fortran_order': False, 'shape': (6,), }",
         ASSAY_ERR_UNSUPPORTED},
        {"{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (6,), }",
         ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }", ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (), }", ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 3), }", ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (1, 2, 3, 1, 1), }",
         ASSAY_ERR_UNSUPPORTED},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (5, 1), }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (7, 1), }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (6, 0), }", ASSAY_ERR_LIMIT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999999, 3), }",
         ASSAY_ERR_LIMIT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (6, 4294967296), }", ASSAY_ERR_LIMIT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (-6, 1), }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (6,, ), }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': Maybe, 'shape': (6, ), }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False, }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'shape': (6,), }", ASSAY_ERR_FORMAT},
        {"{'fortran_order': False, 'shape': (6,), }", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (6,), } x", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False, 'shape': (6,)", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'fortran_order': False 'shape': (6,)}", ASSAY_ERR_FORMAT},
        {"{'descr': '<f8', 'colour': 3, 'fortran_order': False, 'shape': (6,)}", ASSAY_ERR_FORMAT},
        {"{'descr", ASSAY_ERR_FORMAT},
        {"{", ASSAY_ERR_FORMAT},
        {"", ASSAY_ERR_FORMAT}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint8_t            bytes[300];
        assay_array       *array  = NULL;
        const size_t       count  = make_file(bytes, 1, rows[i].header, values, sizeof values);
        const assay_status status = assay_array_decode_npy(*state, bytes, count, "x", &array);
        if (status != rows[i].status) {
            fail_msg("row %d: '%s'", (int)i, assay_status_text(status));
        }
        assert_null(array);
    }
    uint8_t      bytes[300];
    assay_array *array = NULL;
    const size_t count =
        make_file(bytes, 1, "{'descr': '<f8', 'fortran_order': False, 'shape': (6,)}", values, 48);
    bytes[6] = 4;
    assert_int_equal(assay_array_decode_npy(*state, bytes, count, "x", &array),
                     ASSAY_ERR_UNSUPPORTED);
    bytes[6] = 0;
    assert_int_equal(assay_array_decode_npy(*state, bytes, count, "x", &array),
                     ASSAY_ERR_UNSUPPORTED);
    bytes[0] = 0;
    assert_int_equal(assay_array_decode_npy(*state, bytes, count, "x", &array), ASSAY_ERR_FORMAT);
    assert_null(array);
}

static assay_status read_bytes(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_array       *array  = NULL;
    const assay_status status = assay_array_decode_npy(context, bytes, count, "broken.npy", &array);
    assay_array_destroy(array);
    return status;
}

static void broken_files_are_refused(void **state)
{
    uint8_t      bytes[300];
    const double values[6] = {0.0};
    (void)state;
    for (int version = 1; version <= 3; version++) {
        const size_t count =
            make_file(bytes, version, "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }",
                      values, 48);
        broken_truncate(read_bytes, bytes, count);
        assert_true(broken_flip(read_bytes, bytes, count, 5000, (uint64_t)version) > 1000);
    }
}

static void files_are_told(void **state)
{
    temporary    t     = temporary_create();
    assay_array *array = NULL;
    assert_int_equal(assay_array_read_npy(*state, temporary_path(&t, "none.npy"), &array),
                     ASSAY_ERR_NOT_FOUND);
    assert_non_null(strstr(assay_context_error(*state), "none.npy"));
    assert_int_equal(assay_array_read_npy(*state, "/dev/zero", &array), ASSAY_ERR_NOT_FOUND);
    assert_int_equal(assay_array_create(*state, 20000, 1, &array), ASSAY_OK);
    assert_int_equal(assay_array_write_npy(array, "/dev/full"), ASSAY_ERR_WRITE);
    assay_array_destroy(array);
    temporary_destroy(&t);
}

static assay_status write_and_read(assay_context *context, void *user)
{
    assay_array *array = NULL, *back = NULL;
    assay_status status = assay_array_create(context, 2, 2, &array);
    if (status == ASSAY_OK) {
        status = assay_array_write_npy(array, user);
    }
    if (status == ASSAY_OK) {
        status = assay_array_read_npy(context, user, &back);
    }
    assay_array_destroy(array);
    assay_array_destroy(back);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    temporary t = temporary_create();
    (void)state;
    assert_int_equal(failing_each(write_and_read, (void *)temporary_path(&t, "a.npy")), 10);
    temporary_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(tables_are_zero_and_limited, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(round_trip_is_bit_exact, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(accepted_headers, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(half_values, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(refused_headers, counted_set_up, counted_tear_down),
        cmocka_unit_test(broken_files_are_refused),
        cmocka_unit_test_setup_teardown(files_are_told, counted_set_up, counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
