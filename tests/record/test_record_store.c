/* test_record_store.c - sums over what contributes, refusals, and numbers at the edge. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "record/record_store.h"
#include "support/failing_context.h"
#include "support/near.h"
#include "support/random_places.h"

static const assay_vec3 ZERO = {0.0, 0.0, 0.0}, ONE = {1.0, 1.0, 1.0}, UP = {0.0, 0.0, 1.0};

static bool same_bits(const void *a, const void *b, size_t bytes)
{
    return memcmp(a, b, bytes) == 0;
}

/* ---- sums ---- */

static assay_record simple_record(assay_vec3 position, double radius)
{
    return (assay_record){.position = position, .normal = UP, .radius = radius};
}

static assay_record_store *make_store(assay_context *context, const assay_record_rules *rules)
{
    assay_record_store *store = NULL;
    assert_int_equal(
        assay_record_store_create(context, rules, ZERO, ONE, ASSAY_INDEX_OCTREE, &store), ASSAY_OK);
    return store;
}

/* The sums in the order of numbers, made here from the weights of single records. */
static void sums_run_by_number(void **state)
{
    const assay_record_rules rules  = {.a = 0.9};
    assay_random             random = assay_random_start(21, ASSAY_STAGE_TEST, 0, 0);
    assay_record_store      *store  = make_store(*state, &rules);
    assay_contributions      list   = {0};
    for (int i = 0; i < 5000; i++) {
        assay_record r =
            simple_record(random_box(&random, 0.0, 1.0), random_in(&random, 0.01, 0.9));
        r.irradiance = rgb_grey(random_in(&random, 0.0, 2.0));
        assert_int_equal(assay_record_store_add(store, &r), ASSAY_OK);
    }
    for (int k = 0; k < 200; k++) {
        const assay_vec3 p   = random_box(&random, 0.0, 1.0);
        double           sum = 0.0;
        long double      e = 0.0L, all = 0.0L;
        size_t           count = 0;
        for (uint32_t i = 0; i < 5000; i++) {
            const assay_record *r = assay_record_store_at(store, i);
            const double        w = assay_record_weight(r, &rules, p, UP);
            if (w > 0.0) {
                count++;
                sum += w;
                all += (long double)w;
                e += (long double)w * r->irradiance.r;
            }
        }
        assert_int_equal(assay_record_store_find(store, p, UP, UINT32_MAX, &list), ASSAY_OK);
        assert_int_equal(list.count, count);
        assert_true(list.weight == sum);
        assert_near(assay_record_store_interpolate(store, &list, p, UP).r, (double)(e / all),
                    1e-14);
    }
    assay_contributions_release(&list);
    assay_record_store_destroy(store);
}

/* Weights 4 and 2 by distance: (4 (1, 0, 8) + 2 (4, 3, 2)) / 6 */
static void interpolation_by_hand(void **state)
{
    const assay_record_rules rules = {.a = 1.0};
    assay_record_store      *store = make_store(*state, &rules);
    assay_contributions      list  = {0};
    assay_record             a = simple_record(vec3(0.25, 0.5, 0.5), 1.0), b = a;
    a.irradiance       = rgb(1.0, 0.0, 8.0);
    b.irradiance       = rgb(4.0, 3.0, 2.0);
    b.position         = vec3(0.5, 0.0, 0.5);
    const assay_vec3 p = vec3(0.5, 0.5, 0.5);
    assert_int_equal(assay_record_store_add(store, &a), ASSAY_OK);
    assert_int_equal(assay_record_store_add(store, &b), ASSAY_OK);
    assert_int_equal(assay_record_store_find(store, p, UP, UINT32_MAX, &list), ASSAY_OK);
    assert_true(list.count == 2 && list.weight == 6.0);
    const assay_rgb e = assay_record_store_interpolate(store, &list, p, UP);
    assert_near(e.r, 2.0, 1e-15);
    assert_near(e.g, 1.0, 1e-15);
    assert_near(e.b, 6.0, 2e-15);
    assert_int_equal(assay_record_store_find(store, p, UP, 1, &list), ASSAY_OK);
    assert_true(list.count == 1 && list.items[0].number == 0);
    assert_int_equal(assay_record_store_find(store, p, UP, 0, &list), ASSAY_OK);
    assert_true(list.count == 0 && list.weight == 0.0);
    assay_contributions_release(&list);
    assay_record_store_destroy(store);
}

static void constants_stay_what_they_are(void **state)
{
    const assay_record_rules rules  = {.a = 0.9, .gradients = ASSAY_GRADIENTS_BOTH};
    assay_random             random = assay_random_start(22, ASSAY_STAGE_TEST, 0, 0);
    assay_record_store      *store  = make_store(*state, &rules);
    assay_contributions      list   = {0};
    for (int i = 0; i < 500; i++) {
        assay_record r = simple_record(random_box(&random, 0.0, 1.0), random_in(&random, 0.1, 0.9));
        r.irradiance   = rgb(0.1, 0.0, 1e300);
        assert_int_equal(assay_record_store_add(store, &r), ASSAY_OK);
    }
    for (int k = 0; k < 1000; k++) {
        const assay_vec3 p = random_box(&random, 0.0, 1.0);
        assert_int_equal(assay_record_store_find(store, p, UP, UINT32_MAX, &list), ASSAY_OK);
        assert_true(list.count > 0);
        const assay_rgb e = assay_record_store_interpolate(store, &list, p, UP);
        assert_true(e.r == 0.1 && e.g == 0.0 && e.b == 1e300);
    }
    assay_contributions_release(&list);
    assay_record_store_destroy(store);
}

/* For a = 2.5, records of weight 1: two are too few, three are enough. */
static void a_large_a_can_need_several(void **state)
{
    const assay_record_rules rules = {.a = 2.5};
    assay_record_store      *store = make_store(*state, &rules);
    assay_contributions      list  = {0};
    for (size_t count = 1; count <= 3; count++) {
        const assay_record r = simple_record(vec3(0.5, 0.5, 0.5), 0.25);
        assert_int_equal(assay_record_store_add(store, &r), ASSAY_OK);
        assert_int_equal(
            assay_record_store_find(store, vec3(0.5, 0.75, 0.5), UP, UINT32_MAX, &list), ASSAY_OK);
        assert_int_equal(list.count, count);
        assert_true(list.weight == (double)count);
        assert_true((list.weight < rules.a) == (count < 3));
    }
    assay_contributions_release(&list);
    assay_record_store_destroy(store);
}

/* ---- refusals ---- */

static void unsound_records_are_refused(void **state)
{
    const assay_record_rules rules = {.a = 0.5};
    assay_record_store      *store = make_store(*state, &rules);
    const assay_record       good  = simple_record(ZERO, 1.0);
    assay_record             bad[] = {good, good, good, good, good, good, good, good, good, good};
    bad[0].radius                  = 0.0;
    bad[1].radius                  = INFINITY;
    bad[2].radius                  = NAN;
    bad[3].position.y              = NAN;
    bad[4].normal                  = ZERO;
    bad[5].normal.z                = 1.00001;
    bad[6].irradiance.b            = INFINITY;
    bad[7].rotation[1].x           = NAN;
    bad[8].translation[2].z        = -INFINITY;
    bad[9].mean                    = NAN;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_int_equal(assay_record_store_add(store, &bad[i]), ASSAY_ERR_DOMAIN);
        assert_int_equal(assay_record_store_count(store), 0);
    }
    assay_record open = good;
    open.mean         = INFINITY;
    open.nearest      = INFINITY;
    assert_int_equal(assay_record_store_add(store, &open), ASSAY_OK);
    assert_int_equal(assay_record_store_count(store), 1);
    assert_true(same_bits(assay_record_store_at(store, 0), &open, sizeof open));
    assay_record_store_destroy(store);
    assay_record_store_destroy(NULL);
}

static void bad_accuracies_are_refused(void **state)
{
    static const double bad[] = {0.0, -1.0, NAN, INFINITY, 1e-13};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const assay_record_rules rules = {.a = bad[i]};
        assay_record_store      *store = NULL;
        assert_int_equal(
            assay_record_store_create(*state, &rules, ZERO, ONE, ASSAY_INDEX_LIST, &store),
            ASSAY_ERR_ARGUMENT);
        assert_null(store);
    }
    /* At the least accuracy a record still counts at its own place. */
    const assay_record_rules least = {.a = 1.0 / ASSAY_WEIGHT_MAX};
    const assay_record       r     = simple_record(ZERO, 1.0);
    assert_true(assay_record_weight(&r, &least, ZERO, UP) == ASSAY_WEIGHT_MAX);
}

/* Reaches that overflow, and bounds of no use, cost time only. */
static void extreme_numbers(void **state)
{
    for (int bounds = 0; bounds < 2; bounds++) {
        const assay_record_rules rules = {.a = 1e10};
        assay_record_store      *s[2]  = {NULL, NULL};
        assay_contributions      list  = {0};
        const assay_vec3         high  = bounds ? vec3(NAN, INFINITY, -1.0) : ONE;
        for (int i = 0; i < 2; i++) {
            assert_int_equal(assay_record_store_create(*state, &rules, ZERO, high,
                                                       i ? ASSAY_INDEX_OCTREE : ASSAY_INDEX_LIST,
                                                       &s[i]),
                             ASSAY_OK);
            assay_record r = simple_record(vec3(0.5, 0.5, 0.5), 1e308);
            assert_int_equal(assay_record_store_add(s[i], &r), ASSAY_OK);
            r.radius = 5e-324;
            assert_int_equal(assay_record_store_add(s[i], &r), ASSAY_OK);
            r.position = vec3(1e300, -1e308, 1e308);
            assert_int_equal(assay_record_store_add(s[i], &r), ASSAY_OK);
            assert_int_equal(
                assay_record_store_find(s[i], vec3(0.5, 0.5, 0.5), UP, UINT32_MAX, &list),
                ASSAY_OK);
            assert_true(list.count == 2 && list.weight == 2e12);
            assert_int_equal(
                assay_record_store_find(s[i], vec3(0.5, 0.6, 0.5), UP, UINT32_MAX, &list),
                ASSAY_OK);
            assert_true(list.count == 1 && list.items[0].number == 0);
            assay_record_store_destroy(s[i]);
        }
        assay_contributions_release(&list);
    }
}

static void ignore(void *user, uint32_t number)
{
    (void)user;
    (void)number;
}

/* What a query of a worker answers; its caller says the words. */
static assay_status told(assay_context *context, assay_status status)
{
    return status == ASSAY_ERR_MEMORY ? assay_fail_memory(context, "a query") : status;
}

/* A hundred records and a query that finds all of them. */
static assay_status use_everything(assay_context *context, void *user)
{
    const assay_record_rules rules  = {.a = 1.0};
    assay_random             random = assay_random_start(25, ASSAY_STAGE_TEST, 0, 0);
    assay_contributions      list   = {0};
    assay_record_store      *store  = NULL;
    assay_status             status =
        assay_record_store_create(context, &rules, ZERO, ONE, *(assay_record_index *)user, &store);
    if (status != ASSAY_OK) {
        assert_null(store);
        return status;
    }
    for (uint32_t i = 0; i < 100 && status == ASSAY_OK; i++) {
        const assay_record r     = simple_record(random_box(&random, 0.0, 1.0), i % 2 ? 2.0 : 1e-6);
        const uint64_t     bytes = assay_record_store_bytes(store);
        status                   = assay_record_store_add(store, &r);
        assert_int_equal(assay_record_store_count(store), status == ASSAY_OK ? i + 1 : i);
        assert_true(assay_record_store_bytes(store) >= bytes);
        assert_true(assay_context_memory_used(context) >= assay_record_store_bytes(store));
    }
    for (uint32_t i = 10; i <= 100 && status == ASSAY_OK; i += 30) {
        const assay_contributions before = list;
        const assay_vec3          p      = vec3(0.5, 0.5, 0.5);
        status = told(context, assay_record_store_find(store, p, UP, i, &list));
        if (status == ASSAY_OK) {
            assert_int_equal(list.count, i / 2);
        } else {
            assert_int_equal(list.count, before.count);
            assert_true(list.weight == before.weight);
            for (size_t k = 1; k < list.count; k++) {
                assert_true(list.items[k - 1].number < list.items[k].number);
            }
        }
    }
    if (status == ASSAY_OK) {
        status = told(context, assay_record_store_near(store, ZERO, 3.0, ignore, NULL));
    }
    assay_contributions_release(&list);
    assay_record_store_destroy(store);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assay_record_index index = ASSAY_INDEX_OCTREE;
    assert_true(failing_each(use_everything, &index) > 15);
    index = ASSAY_INDEX_LIST;
    assert_true(failing_each(use_everything, &index) > 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sums_run_by_number, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(interpolation_by_hand, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(constants_stay_what_they_are, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(a_large_a_can_need_several, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(unsound_records_are_refused, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(bad_accuracies_are_refused, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(extreme_numbers, context_set_up, context_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
