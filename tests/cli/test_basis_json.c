/* test_basis_json.c - `assay basis ... --json`: it holds the library's numbers, every bit of them.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "assay/assay.h"
#include "support/near.h"
#include "support/run_json.h"
#include "support/temporary.h"

static int set_up(void **state)
{
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    *state = context;
    return 0;
}

static int tear_down(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

static assay_basis *make(assay_context *context, assay_basis_kind kind, int order,
                         assay_convention convention)
{
    assay_basis *basis = NULL;
    assert_int_equal(assay_basis_create(context, kind, order, convention, &basis), ASSAY_OK);
    return basis;
}

static void is_text(const cJSON *json, const char *path, const char *expected)
{
    assert_string_equal(cJSON_GetStringValue(json_member(json, path)), expected);
}

static void is_list(const cJSON *list, const double *expected, size_t count)
{
    assert_true(cJSON_IsArray(list));
    assert_int_equal(cJSON_GetArraySize(list), count);
    for (size_t i = 0; i < count; i++) {
        const cJSON *item = cJSON_GetArrayItem(list, (int)i);
        assert_true(cJSON_IsNumber(item));
        assert_true(item->valuedouble == expected[i]);
    }
}

static void is_matrix(const cJSON *matrix, const double *expected, size_t rows, size_t columns)
{
    assert_int_equal(cJSON_GetArraySize(matrix), rows);
    for (size_t r = 0; r < rows; r++) {
        is_list(cJSON_GetArrayItem(matrix, (int)r), expected + r * columns, columns);
    }
}

static void names_functions(const cJSON *json, const assay_basis *basis)
{
    const cJSON *list = json_member(json, "functions");
    assert_int_equal(cJSON_GetArraySize(list), assay_basis_count(basis));
    for (size_t i = 0; i < assay_basis_count(basis); i++) {
        int          l, m;
        const cJSON *pair = cJSON_GetArrayItem(list, (int)i);
        assay_basis_function(basis, i, &l, &m);
        assert_int_equal(cJSON_GetArrayItem(pair, 0)->valueint, l);
        assert_int_equal(cJSON_GetArrayItem(pair, 1)->valueint, m);
    }
}

static void eval_of_every_basis(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        const char  *name  = assay_basis_kind_name((assay_basis_kind)kind);
        assay_basis *basis = make(*state, (assay_basis_kind)kind, 4, ASSAY_CONVENTION_THESIS);
        double       values[16];
        assert_int_equal(assay_basis_evaluate(basis, (assay_vec3){0.48, -0.6, 0.64}, values),
                         ASSAY_OK);
        cJSON *json =
            run_json(0, "basis eval --basis %s --order 4 --dir 0.48,-0.6,0.64 --json", name);
        is_text(json, "basis", name);
        is_text(json, "convention", "thesis");
        is_text(json, "index",
                kind == ASSAY_BASIS_ZERNIKE || kind == ASSAY_BASIS_ESH ? "l*(l+1)/2+(l+m)/2"
                                                                       : "l*l+l+m");
        assert_int_equal(json_member(json, "order")->valueint, 4);
        is_list(json_member(json, "values"), values, assay_basis_count(basis));
        names_functions(json, basis);
        cJSON_Delete(json);
        assay_basis_destroy(basis);
    }
}

/* --hex: strings that strtod reads to the same bits. */
static void hexadecimal_floats(void **state)
{
    assay_basis *basis = make(*state, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_KONTKANEN);
    double       values[9];
    assert_int_equal(assay_basis_evaluate(basis, (assay_vec3){0.48, -0.6, 0.64}, values), ASSAY_OK);
    cJSON *json = run_json(0, "basis eval --basis sh --order 3 --dir 0.48,-0.6,0.64 --json --hex "
                              "--convention kontkanen");
    is_text(json, "index", "see functions");
    names_functions(json, basis);
    for (int i = 0; i < 9; i++) {
        const char *word = cJSON_GetStringValue(cJSON_GetArrayItem(json_member(json, "values"), i));
        assert_non_null(strstr(word, "0x"));
        assert_true(strtod(word, NULL) == values[i]);
    }
    cJSON_Delete(json);
    assay_basis_destroy(basis);
}

/* Rows are outputs. */
static void conversion_is_not_square(void **state)
{
    assay_basis  *hsh    = make(*state, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS);
    assay_basis  *sh     = make(*state, ASSAY_BASIS_SH, 4, ASSAY_CONVENTION_THESIS);
    assay_sparse *sparse = NULL;
    double        dense[16 * 4], unit[4];
    assert_int_equal(assay_basis_conversion(*state, hsh, sh, &sparse), ASSAY_OK);
    for (int c = 0; c < 4; c++) {
        double column[16];
        for (int i = 0; i < 4; i++) {
            unit[i] = i == c;
        }
        assay_sparse_multiply(sparse, unit, column);
        for (int r = 0; r < 16; r++) {
            dense[r * 4 + c] = column[r];
        }
    }
    cJSON *json = run_json(0, "basis convert --from hsh --to sh --order 2 --to-order 4 --json");
    is_text(json, "rows/basis", "sh");
    is_text(json, "columns/basis", "hsh");
    names_functions(json_member(json, "rows"), sh);
    names_functions(json_member(json, "columns"), hsh);
    is_matrix(json_member(json, "matrix"), dense, 16, 4);
    cJSON_Delete(json);
    json = run_json(0, "basis convert --from hsh --to sh --order 2 --to-convention plain --json");
    is_text(json, "rows/convention", "plain");
    is_text(json, "columns/convention", "thesis");
    for (int i = 0; i < 16; i++) { /* rows with odd m */
        const double other = i / 4 == 1 || i / 4 == 3 ? -dense[i] : dense[i];
        assert_near(
            cJSON_GetArrayItem(cJSON_GetArrayItem(json_member(json, "matrix"), i / 4), i % 4)
                ->valuedouble,
            other, 1e-15);
    }
    cJSON_Delete(json);
    assay_sparse_destroy(sparse);
    assay_basis_destroy(hsh);
    assay_basis_destroy(sh);
}

static void rotations_and_digon(void **state)
{
    static const double pi  = 3.14159265358979323846;
    assay_basis        *sh  = make(*state, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_PLAIN);
    assay_basis        *hsh = make(*state, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS);
    double              r[9], m[81];
    assay_rotation_from_euler_zyz(10.0 / 180.0 * pi, 20.0 / 180.0 * pi, -30.0 / 180.0 * pi, r);
    assert_int_equal(assay_sh_rotation(sh, r, m), ASSAY_OK);
    cJSON *json = run_json(0, "basis rotate --basis sh --order 3 --euler-zyz-deg 10,20,-30 "
                              "--convention plain --json");
    is_text(json, "convention", "plain");
    is_matrix(json_member(json, "matrix"), m, 9, 9);
    cJSON_Delete(json);

    const assay_hsh_rotation_options options = {.way = ASSAY_HSH_EXACT};
    assert_int_equal(assay_hsh_rotation_y(hsh, *state, &options, 30.0 / 180.0 * pi, m), ASSAY_OK);
    json = run_json(0, "basis rotate --basis hsh --order 3 --beta-deg 30 --json");
    is_matrix(json_member(json, "matrix"), m, 9, 9);
    cJSON_Delete(json);

    assert_int_equal(assay_hsh_digon(hsh, *state, 30.0 / 180.0 * pi, m), ASSAY_OK);
    json = run_json(0, "basis digon --order 3 --beta-deg 30 --json");
    is_matrix(json_member(json, "matrix"), m, 9, 9);
    cJSON_Delete(json);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
}

static void accuracies(void **state)
{
    static const double pi    = 3.14159265358979323846;
    assay_basis        *basis = make(*state, ASSAY_BASIS_ZERNIKE, 3, ASSAY_CONVENTION_THESIS);
    const assay_lobe    lobe  = {.kind      = ASSAY_LOBE_WARD,
                                 .alpha_x   = 0.2,
                                 .alpha_y   = 0.5,
                                 .theta_out = 30.0 / 180.0 * pi,
                                 .phi_out   = 40.0 / 180.0 * pi};
    double              values[3];
    static const double counts[3] = {1, 3, 6};
    assert_int_equal(assay_basis_accuracy(basis, *state, &lobe, values, NULL), ASSAY_OK);
    cJSON *json = run_json(0, "basis accuracy --lobe ward:0.2,0.5@30,40 --basis zernike "
                              "--max-order 3 --json");
    is_list(json_member(json, "values"), values, 3);
    is_list(json_member(json, "counts"), counts, 3);
    cJSON_Delete(json);
    json = run_json(0, "basis accuracy --lobe phong:5@30 --max-order 2 --json");
    assert_int_equal(cJSON_GetArraySize(json), ASSAY_BASIS_KIND_COUNT);
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        is_text(cJSON_GetArrayItem(json, kind), "basis",
                assay_basis_kind_name((assay_basis_kind)kind));
    }
    cJSON_Delete(json);
    assay_basis_destroy(basis);
}

/* A map of one bright half, in both ways: radiance and irradiance. */
static void projection_of_a_map(void **state)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_basis             *basis    = make(*state, ASSAY_BASIS_SH, 3, ASSAY_CONVENTION_THESIS);
    assay_image             *map      = NULL;
    temporary                t        = temporary_create();
    const char              *path     = temporary_path(&t, "map.exr");
    double                   c[27], a[3];
    assert_int_equal(assay_image_create(*state, 4, 2, &map), ASSAY_OK);
    for (int i = 0; i < 3; i++) {
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(map, names[i], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        channel.data.f32[i] = 1.5f;
    }
    assert_int_equal(assay_image_write_exr(map, path), ASSAY_OK);
    assert_int_equal(assay_basis_project_environment(basis, map, 0.0, c), ASSAY_OK);
    cJSON *json = run_json(0, "basis project --env %s --order 3 --json", path);
    is_text(json, "basis", "sh");
    assert_string_equal(cJSON_GetArrayItem(json_member(json, "channels"), 2)->valuestring, "B");
    is_matrix(json_member(json, "values"), c, 3, 9);
    cJSON_Delete(json);
    assert_int_equal(assay_clamped_cosine(3, a), ASSAY_OK);
    for (int i = 0; i < 27; i++) {
        c[i] *= a[i % 9 == 0 ? 0 : i % 9 < 4 ? 1 : 2];
    }
    json = run_json(0, "basis project --env %s --order 3 --irradiance --json", path);
    is_matrix(json_member(json, "values"), c, 3, 9);
    cJSON_Delete(json);
    const double normal[3] = {0.36, 0.48, -0.8};
    double       frame[9];
    assay_basis *hsh = make(*state, ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_THESIS);
    assert_int_equal(assay_rotation_to_pole((assay_vec3){0.36, 0.48, -0.8}, frame), ASSAY_OK);
    assert_int_equal(assay_basis_project_environment_hemisphere(hsh, *state, map, 0.0, frame, c),
                     ASSAY_OK);
    json = run_json(
        0, "basis project --env %s --basis hsh --order 3 --normal 0.36,0.48,-0.8 --json", path);
    is_text(json, "basis", "hsh");
    is_list(json_member(json, "normal"), normal, 3);
    is_matrix(json_member(json, "values"), c, 3, 9);
    cJSON_Delete(json);
    assay_basis_destroy(hsh);
    assay_image_destroy(map);
    assay_basis_destroy(basis);
    temporary_destroy(&t);
}

static void lobe_value(void *user, assay_vec3 d, double *values_out)
{
    assert_int_equal(assay_lobe_value(user, d, values_out), ASSAY_OK);
}

static void projection_of_a_lobe(void **state)
{
    assay_basis *basis = make(*state, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS);
    assay_lobe   lobe  = {.kind = ASSAY_LOBE_PHONG, .exponent = 5.0};
    double       c[4], v[4];
    assert_int_equal(assay_basis_project_random(basis, *state, lobe_value, &lobe, 1, 500, 9, c, v),
                     ASSAY_OK);
    cJSON *json = run_json(0, "basis project --lobe phong:5@0 --basis hsh --order 2 --samples 500 "
                              "--seed 9 --json");
    is_list(json_member(json, "values"), c, 4);
    is_list(json_member(json, "variances"), v, 4);
    cJSON_Delete(json);
    assert_int_equal(assay_basis_project_lobe(basis, *state, &lobe, c), ASSAY_OK);
    json = run_json(0, "basis project --lobe phong:5@0 --basis hsh --order 2 --json");
    is_list(json_member(json, "values"), c, 4);
    cJSON_Delete(json);
    /* A narrow lobe, off the pole: 2 pi / (k + 1) times the constant 1 / sqrt(2 pi). */
    json = run_json(0, "basis project --lobe phong:10000@30 --basis hsh --order 1 --json");
    const double value = cJSON_GetArrayItem(json_member(json, "values"), 0)->valuedouble;
    assert_true(fabs(value * 10001.0 / sqrt(2.0 * 3.14159265358979323846) - 1.0) < 1e-10);
    cJSON_Delete(json);
    assay_basis_destroy(basis);
}

/* Degrees whose sine or cosine is 0 or 1/2 mean just that: 90 is the horizon itself. */
static void degrees_are_exact(void **state)
{
    (void)state;
    cJSON *json =
        run_json(0, "basis eval --basis hsh --order 3 --theta-deg 90 --phi-deg 180 --json");
    for (int i = 0; i < 9; i++) {
        const bool zonal = i == 0 || i == 2 || i == 6;
        assert_true(zonal ||
                    cJSON_GetArrayItem(json_member(json, "values"), i)->valuedouble == 0.0);
    }
    cJSON_Delete(json);
    json = run_json(0, "basis eval --basis hsh --order 2 --theta-deg 60 --phi-deg 0 --json");
    assert_true(fabs(cJSON_GetArrayItem(json_member(json, "values"), 2)->valuedouble) < 6e-17);
    cJSON_Delete(json);
    json = run_json(0, "basis eval --basis sh --order 2 --theta-deg 90 --phi-deg -90 --json");
    assert_true(cJSON_GetArrayItem(json_member(json, "values"), 3)->valuedouble == 0.0);
    assert_true(cJSON_GetArrayItem(json_member(json, "values"), 1)->valuedouble > 0.0);
    cJSON_Delete(json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(eval_of_every_basis, set_up, tear_down),
        cmocka_unit_test_setup_teardown(hexadecimal_floats, set_up, tear_down),
        cmocka_unit_test_setup_teardown(conversion_is_not_square, set_up, tear_down),
        cmocka_unit_test_setup_teardown(rotations_and_digon, set_up, tear_down),
        cmocka_unit_test_setup_teardown(accuracies, set_up, tear_down),
        cmocka_unit_test_setup_teardown(projection_of_a_map, set_up, tear_down),
        cmocka_unit_test_setup_teardown(projection_of_a_lobe, set_up, tear_down),
        cmocka_unit_test(degrees_are_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
