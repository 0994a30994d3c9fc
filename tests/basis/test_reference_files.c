/* test_reference_files.c - refdata/basis: every table is there, unchanged, and has its shape. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "support/reference_table.h"

typedef struct {
    const char *name;
    size_t      keys, values, rows;
} shape;

/* Degree and order conventions of each: refdata/README.md. */
static const shape shapes[] = {
    {"accuracy_phong", 2, 9, 4 * 10},
    {"accuracy_ward", 2, 9, 3 * 10},
    {"clamped_cosine", 1, 2, 33},
    {"conversion", 3, 2,
     10 * 16 + 2 * (9 * 15 + 8 * 14 + 7 * 13 + 6 * 12 + 5 * 11 + 4 * 10 + 3 * 9 + 2 * 8 + 1 * 7)},
    {"conversion_bands", 3, 2, 33 * 33 + 32 * 32 + 31 * 31 + 17 * 17 + 2 * 2 + 1},
    {"digon_order10", 2, 100, 4 * 100},
    {"digon_order6", 2, 36, 8 * 36},
    {"gauss_legendre", 2, 4, 2 + 3 + 5 + 16 + 64},
    {"hsh_gradients", 4, 17 * 17, 3 * 12},
    {"hsh_rotation_order10", 2, 100, 4 * 100},
    {"hsh_rotation_order6", 2, 36, 8 * 36},
    {"hsh_values", 3, 33 * 33, 40},
    {"makhotkin_sqrt_values", 3, 17 * 17, 18},
    {"makhotkin_values", 3, 17 * 17, 18},
    {"sh_gradients", 4, 17 * 17, 3 * 16},
    {"sh_rotation_01", 4, 3, 7 * 3},
    {"sh_rotation_02", 4, 5, 7 * 5},
    {"sh_rotation_05", 4, 11, 7 * 11},
    {"sh_rotation_10", 4, 21, 7 * 21},
    {"sh_rotation_16", 4, 33, 7 * 33},
    {"sh_rotation_32", 4, 65, 5 * 65},
    {"sh_values", 3, 33 * 33, 60},
    {"student_tail", 2, 1, 156},
    {"zernike_values", 3, 17 * 18 / 2, 18},
};
#define SHAPE_COUNT (sizeof shapes / sizeof shapes[0])

static void digest_of(const char *bytes, size_t size, char digest[65])
{
    assay_hash hash;
    assay_hash_start(&hash);
    assay_hash_add(&hash, bytes, size);
    assay_hash_finish(&hash, digest);
}

static void manifest_holds(void **state)
{
    size_t size, lines = 0;
    char  *manifest = reference_file_bytes("refdata/MANIFEST", &size);
    for (char *line = manifest, *end; *line; line = end + 1) {
        end = strchr(line, '\n');
        assert_non_null(end);
        *end = '\0';
        assert_true(lines < SHAPE_COUNT);
        char expected[64 + 2 + 128], path[128], digest[65];
        snprintf(path, sizeof path, "refdata/basis/%s.txt", shapes[lines].name);
        size_t bytes_size;
        char  *bytes = reference_file_bytes(path, &bytes_size);
        digest_of(bytes, bytes_size, digest);
        snprintf(expected, sizeof expected, "%s  basis/%s.txt", digest, shapes[lines].name);
        assert_string_equal(line, expected);
        if (lines == 0) { /* a table with one bit flipped is another one */
            char spoiled[65];
            bytes[bytes_size / 2] ^= 1;
            digest_of(bytes, bytes_size, spoiled);
            assert_string_not_equal(digest, spoiled);
        }
        free(bytes);
        lines++;
    }
    assert_int_equal(lines, SHAPE_COUNT);
    free(manifest);
    (void)state;
}

static void folder_holds_nothing_else(void **state)
{
    DIR   *folder = opendir("refdata/basis");
    size_t files  = 0;
    assert_non_null(folder);
    for (const struct dirent *entry; (entry = readdir(folder));) {
        files += entry->d_name[0] != '.';
    }
    closedir(folder);
    assert_int_equal(files, SHAPE_COUNT);
    (void)state;
}

static void tables_have_their_shapes(void **state)
{
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        reference_table *table = reference_table_read(shapes[i].name);
        assert_int_equal(table->keys, shapes[i].keys);
        assert_int_equal(table->columns, shapes[i].keys + shapes[i].values);
        assert_int_equal(table->rows, shapes[i].rows);
        reference_table_free(table);
    }
    (void)state;
}

/* Every header says what, how, how sharp, in which convention, and by what it was made. */
static void headers_say_where_from(void **state)
{
    static const char *const lines[] = {
        "\n# content: ", "\n# command: make ref", "\n# method: ", "\n# precision: ",
        "\n# radius: ",  "\n# convention: ",      "\n# values: ", "\n# generator: refdata/gen/"};
    for (size_t i = 0; i < SHAPE_COUNT; i++) {
        char   path[128], generator[64] = "";
        size_t size;
        snprintf(path, sizeof path, "refdata/basis/%s.txt", shapes[i].name);
        char *text = reference_file_bytes(path, &size);
        for (size_t k = 0; k < sizeof lines / sizeof lines[0]; k++) {
            assert_non_null(strstr(text, lines[k]));
        }
        assert_int_equal(sscanf(strstr(text, "\n# generator: "), "\n# generator: %63s", generator),
                         1);
        free(text);
        free(reference_file_bytes(generator, &size));
    }
    (void)state;
}

#define HEADER "# table: t\n# keys: a b\n# values: c\n# rows: 2\n# columns: 3\n"

static void broken_tables_are_refused(void **state)
{
    static const char *const broken[] = {
        "",
        HEADER,
        HEADER "1 2 0x1p+0\n",
        HEADER "1 2 0x1p+0\n1 3 0x1p+0\n1 4 0x1p+0\n",
        HEADER "1 2 0x1p+0\n1 3\n",
        HEADER "1 2 0x1p+0\n1 3 0x1p+0 4\n",
        HEADER "1 2 0x1p+0\n1 3 nan\n",
        HEADER "1 2 0x1p+0\n1 3 0x1p+9999\n",
        HEADER "1 2 0x1p+0\n1 3 one\n",
        HEADER "1 2 0x1p+0\n1  3 0x1p+0\n",
        HEADER "1 2 0x1p+0\n1 3 0x1p+0",
        HEADER "1 2 0x1p+0\n# rows: 2\n1 3 0x1p+0\n",
        "# table: t\n# keys: a\n# rows: 1\n1 2\n",
        "# table: t\n# keys: a\n# columns: 2\n1 2\n",
        "# table: t\n# keys: a b\n# rows: 1\n# columns: 2\n1 2\n",
        "# keys: a\n# rows: 1\n# columns: 2\n1 2\n",
    };
    const char *why;
    for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
        char text[256];
        snprintf(text, sizeof text, "%s", broken[i]);
        assert_null(reference_table_parse(text, &why));
        assert_non_null(why);
    }
    char             text[] = HEADER "1 2 0x1.8p+1\n-1 3 -0x0p-1074\n";
    reference_table *table  = reference_table_parse(text, &why);
    assert_non_null(table);
    assert_true(reference_table_values(table, 0)[0] == 3.0);
    assert_int_equal(reference_table_find(table, (double[]){-1, 3}, 2), 1);
    reference_table_free(table);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(manifest_holds),
        cmocka_unit_test(folder_holds_nothing_else),
        cmocka_unit_test(tables_have_their_shapes),
        cmocka_unit_test(headers_say_where_from),
        cmocka_unit_test(broken_tables_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
