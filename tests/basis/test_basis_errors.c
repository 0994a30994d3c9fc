/* Names, and what is refused: requests, directions, memory.  Outputs stay as they were. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "../support/failing_context.h"
#include "assay/assay.h"

static int start(void **state)
{
    return assay_context_create(NULL, (assay_context **)state) == ASSAY_OK ? 0 : -1;
}

static int stop(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

static void test_names(void **state)
{
    (void)state;
    for (int i = 0; i < ASSAY_BASIS_KIND_COUNT; i++) {
        assay_basis_kind kind = ASSAY_BASIS_SH;
        assert_int_equal(assay_basis_kind_find(assay_basis_kind_name((assay_basis_kind)i), &kind),
                         ASSAY_OK);
        assert_int_equal(kind, i);
        assert_int_equal(assay_basis_kind_is_hemispherical(kind), i != ASSAY_BASIS_SH);
    }
    for (int i = 0; i < ASSAY_CONVENTION_COUNT; i++) {
        assay_convention convention = ASSAY_CONVENTION_THESIS;
        assert_int_equal(
            assay_convention_find(assay_convention_name((assay_convention)i), &convention),
            ASSAY_OK);
        assert_int_equal(convention, i);
    }
    assert_string_equal(assay_basis_kind_name(ASSAY_BASIS_MAKHOTKIN_SQRT), "makhotkin-sqrt");
    assert_null(assay_basis_kind_name((assay_basis_kind)ASSAY_BASIS_KIND_COUNT));
    assert_null(assay_basis_kind_name((assay_basis_kind)-1));
    assert_null(assay_convention_name((assay_convention)ASSAY_CONVENTION_COUNT));
    assay_basis_kind kind       = ASSAY_BASIS_ESH;
    assay_convention convention = ASSAY_CONVENTION_PLAIN;
    assert_int_equal(assay_basis_kind_find("SH", &kind), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_kind_find(NULL, &kind), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_convention_find("", &convention), ASSAY_ERR_ARGUMENT);
    assert_int_equal(kind, ASSAY_BASIS_ESH);
    assert_int_equal(convention, ASSAY_CONVENTION_PLAIN);
}

static void test_requests(void **state)
{
    assay_context *context = *state;
    assay_basis   *basis   = (assay_basis *)&context;
    const struct {
        assay_basis_kind kind;
        int              order;
        assay_convention convention;
        const char      *word;
    } refused[] = {
        {ASSAY_BASIS_SH, 0, ASSAY_CONVENTION_THESIS, "order"},
        {ASSAY_BASIS_SH, -3, ASSAY_CONVENTION_THESIS, "order"},
        {ASSAY_BASIS_HSH, ASSAY_BASIS_MAX_ORDER + 1, ASSAY_CONVENTION_THESIS, "order"},
        {(assay_basis_kind)7, 2, ASSAY_CONVENTION_THESIS, "kind"},
        {ASSAY_BASIS_SH, 2, (assay_convention)3, "convention"},
        {ASSAY_BASIS_SH, 4, ASSAY_CONVENTION_KONTKANEN, "kontkanen"},
        {ASSAY_BASIS_HSH, 3, ASSAY_CONVENTION_KONTKANEN, "kontkanen"},
        {ASSAY_BASIS_ZERNIKE, 3, ASSAY_CONVENTION_PLAIN, "zernike"},
        {ASSAY_BASIS_MAKHOTKIN, 3, ASSAY_CONVENTION_PLAIN, "makhotkin"},
        {ASSAY_BASIS_ESH, 3, ASSAY_CONVENTION_PLAIN, "esh"},
        {ASSAY_BASIS_LSOSH, 3, ASSAY_CONVENTION_PLAIN, "lsosh"},
    };
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; i++) {
        assert_int_equal(assay_basis_create(context, refused[i].kind, refused[i].order,
                                            refused[i].convention, &basis),
                         ASSAY_ERR_ARGUMENT);
        assert_non_null(strstr(assay_context_error(context), refused[i].word));
        assert_ptr_equal(basis, &context);
    }
    double a[2] = {7.0, 7.0};
    assert_int_equal(assay_clamped_cosine(0, a), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_clamped_cosine(ASSAY_BASIS_MAX_ORDER + 1, a), ASSAY_ERR_ARGUMENT);
    assert_true(a[0] == 7.0);
    assay_basis_destroy(NULL);
}

static void test_counts(void **state)
{
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        for (int order = 1; order <= ASSAY_BASIS_MAX_ORDER; order++) {
            assay_basis *basis = NULL;
            assert_int_equal(assay_basis_create(*state, (assay_basis_kind)kind, order,
                                                ASSAY_CONVENTION_THESIS, &basis),
                             ASSAY_OK);
            const bool half  = kind == ASSAY_BASIS_ZERNIKE || kind == ASSAY_BASIS_ESH;
            const int  count = half ? order * (order + 1) / 2 : order * order;
            assert_int_equal(assay_basis_count(basis), count);
            assert_int_equal(assay_basis_order(basis), order);
            assert_int_equal(assay_basis_kind_of(basis), kind);
            assert_int_equal(assay_basis_convention_of(basis), ASSAY_CONVENTION_THESIS);
            int last_l = 0, last_m = -1;
            for (int i = 0; i < count; i++) { /* ascending in l, then in m */
                int l = 0, m = 0;
                assay_basis_function(basis, (size_t)i, &l, &m);
                assert_true(l > last_l || (l == last_l && m > last_m));
                assert_true(l < order && m >= -l && m <= l);
                assert_true(!half || (l + m) % 2 == 0);
                last_l = l;
                last_m = m;
            }
            assay_basis_destroy(basis);
        }
    }
}

static void refuse(const assay_basis *basis, assay_vec3 d)
{
    double           values[3 * 16];
    assay_vec3       gradients[16];
    const assay_vec3 many[3] = {{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, d};
    memset(values, 0x5A, sizeof values);
    memset(gradients, 0x5A, sizeof gradients);
    assert_int_equal(assay_basis_evaluate(basis, d, values), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_basis_evaluate_many(basis, 3, many, values), ASSAY_ERR_DOMAIN);
    assert_int_equal(assay_basis_gradient(basis, d, values, gradients), ASSAY_ERR_DOMAIN);
    for (size_t i = 0; i < sizeof values; i++) {
        assert_int_equal(((unsigned char *)values)[i], 0x5A);
    }
    for (size_t i = 0; i < sizeof gradients; i++) {
        assert_int_equal(((unsigned char *)gradients)[i], 0x5A);
    }
}

static void test_directions(void **state)
{
    const double     e        = 0x1p-20;
    const assay_vec3 wrong[]  = {{0.0, 0.0, 0.0},      {0.0, 0.0, 1.0 + e},  {0.0, 0.0, 1.0 - e},
                                 {0.6, 0.8, 1e-3 + e}, {NAN, 0.0, 1.0},      {0.0, NAN, 1.0},
                                 {1.0, 0.0, NAN},      {0.0, INFINITY, 1.0}, {0.0, 0.0, INFINITY},
                                 {1e200, 0.0, 1.0}};
    const assay_vec3 around[] = {{0.0, 0.0, 1.0 + 0.49 * e}, {0.6, 0.8, -0.0}, {0.0, 1.0, 0.0}};
    for (int kind = 0; kind < ASSAY_BASIS_KIND_COUNT; kind++) {
        double       values[16];
        assay_vec3   gradients[16];
        assay_basis *basis = NULL;
        assert_int_equal(
            assay_basis_create(*state, (assay_basis_kind)kind, 4, ASSAY_CONVENTION_THESIS, &basis),
            ASSAY_OK);
        for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
            refuse(basis, wrong[i]);
        }
        for (size_t i = 0; i < sizeof around / sizeof around[0]; i++) {
            assert_int_equal(assay_basis_evaluate(basis, around[i], values), ASSAY_OK);
        }
        if (assay_basis_kind_is_hemispherical((assay_basis_kind)kind)) {
            refuse(basis, (assay_vec3){0.6, 0.8, -0x1p-60});
            refuse(basis, (assay_vec3){0.0, 0.0, -1.0});
        } else {
            assert_int_equal(assay_basis_evaluate(basis, (assay_vec3){0.0, 0.0, -1.0}, values),
                             ASSAY_OK);
        }
        const bool steep = kind == ASSAY_BASIS_HSH || kind == ASSAY_BASIS_MAKHOTKIN ||
                           kind == ASSAY_BASIS_MAKHOTKIN_SQRT;
        assert_int_equal(
            assay_basis_gradient(basis, (assay_vec3){0.6, 0.8, 0.0}, values, gradients),
            steep ? ASSAY_ERR_DOMAIN : ASSAY_OK);
        assert_int_equal(assay_basis_rotate_z(basis, NAN, 1, values), ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_basis_rotate_z(basis, INFINITY, 1, values), ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_basis_rotate_z(basis, 0.5, 0, values), ASSAY_ERR_ARGUMENT);
        assay_basis_destroy(basis);
    }
}

static assay_status make_one(assay_context *context, void *user)
{
    (void)user;
    assay_basis       *basis = NULL;
    const assay_status status =
        assay_basis_create(context, ASSAY_BASIS_ZERNIKE, 5, ASSAY_CONVENTION_THESIS, &basis);
    assay_basis_destroy(basis);
    return status;
}

static void test_memory(void **state)
{
    (void)state;
    assert_true(failing_each(make_one, NULL) >= 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),  cmocka_unit_test(test_requests),
        cmocka_unit_test(test_counts), cmocka_unit_test(test_directions),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, start, stop);
}
