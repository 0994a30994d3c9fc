/* test_record_index.c - the octree against the list: the same records, the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "record/record_store.h"
#include "support/random_places.h"

static const assay_vec3 ZERO = {0.0, 0.0, 0.0}, ONE = {1.0, 1.0, 1.0}, UP = {0.0, 0.0, 1.0};

static bool same_bits(const void *a, const void *b, size_t bytes)
{
    return memcmp(a, b, bytes) == 0;
}

/* ---- where records are; the bounds are the unit cube ---- */

enum { UNIFORM, CLUSTERED, ONE_POINT, DECADES, OUTSIDE, FACES, FAR_AWAY, DISTRIBUTIONS };

/* Within a few units of the last place of a cube's face: the root is 1.0001 wide. */
static double near_a_face(assay_random *random)
{
    const double cubes = exp2(floor(random_in(random, 0.0, 7.0)));
    const double face  = floor(random_in(random, 0.0, cubes + 1.0)) / cubes;
    return -5e-5 + 1.0001 * face + floor(random_in(random, -2.0, 3.0)) * 0x1p-53;
}

static assay_vec3 place_of(int distribution, assay_random *random)
{
    const assay_vec3 p = random_box(random, 0.0, 1.0);
    switch (distribution) {
    case CLUSTERED:
        return vec3_mad(vec3(floor(3.0 * p.x) / 3.0, 0.4, 0.7), 1e-4,
                        random_box(random, -1.0, 1.0));
    case ONE_POINT: return vec3(0.5, 0.25, 0.125);
    case OUTSIDE: return random_box(random, -2.0, 3.0);
    case FACES: {
        const double x = near_a_face(random), y = near_a_face(random);
        return vec3(x, y, near_a_face(random));
    }
    case FAR_AWAY: return vec3(1e6 + p.x, -1e7 + p.y, p.z);
    default: return p;
    }
}

static double radius_of(int distribution, assay_random *random)
{
    switch (distribution) {
    case CLUSTERED: return random_in(random, 1e-5, 1e-3);
    case DECADES: return 1e-8 * exp2(random_in(random, 0.0, 30.0));
    case FACES: return exp2(-floor(random_in(random, 0.0, 7.0)));
    default: return random_in(random, 0.02, 0.6);
    }
}

static assay_record random_record(int distribution, assay_random *random)
{
    assay_record r = {.position = place_of(distribution, random), .mean = INFINITY, .nearest = 0.5};
    r.normal       = vec3_normalize(vec3_mad(UP, 0.15, random_box(random, -1.0, 1.0)));
    r.radius       = radius_of(distribution, random);
    r.irradiance   = rgb(assay_random_next(random), 3.0, assay_random_next(random));
    for (int c = 0; c < 3; c++) {
        r.rotation[c]    = random_box(random, -1.0, 1.0);
        r.translation[c] = random_box(random, -1.0, 1.0);
    }
    return r;
}

/* ---- a pair of stores ---- */

typedef struct {
    assay_record_store *octree, *list;
    assay_contributions found, judge;
    double              a;
    int                 distribution;
    size_t              contributions;
    uint32_t            hint;
} pair;

static void pair_make(assay_context *context, pair *s, int distribution,
                      const assay_record_rules *rules)
{
    *s                   = (pair){.distribution = distribution, .a = rules->a};
    const bool       far = distribution == FAR_AWAY;
    const assay_vec3 low = far ? vec3(1e6, -1e7, 0.0) : ZERO, high = vec3_add(low, ONE);
    assert_int_equal(
        assay_record_store_create(context, rules, low, high, ASSAY_INDEX_OCTREE, &s->octree),
        ASSAY_OK);
    assert_int_equal(
        assay_record_store_create(context, rules, low, high, ASSAY_INDEX_LIST, &s->list), ASSAY_OK);
}

/* So that what was known of a neighbourhood no longer is. */
static void pair_add_at(pair *s, assay_vec3 position, assay_random *random)
{
    assay_record r = random_record(s->distribution, random);
    r.position     = position;
    assert_int_equal(assay_record_store_add(s->octree, &r), ASSAY_OK);
    assert_int_equal(assay_record_store_add(s->list, &r), ASSAY_OK);
}

static void pair_fill(pair *s, int count, assay_random *random)
{
    for (int i = 0; i < count; i++) {
        const assay_record r = random_record(s->distribution, random);
        assert_int_equal(assay_record_store_add(s->octree, &r), ASSAY_OK);
        assert_int_equal(assay_record_store_add(s->list, &r), ASSAY_OK);
    }
}

static void pair_destroy(pair *s)
{
    assay_contributions_release(&s->found);
    assay_contributions_release(&s->judge);
    assay_record_store_destroy(s->octree);
    assay_record_store_destroy(s->list);
}

/* A query anywhere, or about a record, often at the very border of its reach. */
static void random_query(const pair *s, assay_random *random, assay_vec3 *p, assay_vec3 *n)
{
    const uint32_t      count = assay_record_store_count(s->list);
    const uint32_t      k     = (uint32_t)random_in(random, 0.0, count);
    const assay_record *r     = assay_record_store_at(s->list, k);
    const double        kind  = assay_random_next(random);
    const double        near  = assay_random_next(random);
    *p                        = place_of(s->distribution, random);
    *n                        = random_unit(random);
    if (kind < 0.7) {
        *n = vec3_normalize(vec3_mad(r->normal, 0.1 * s->a, *n));
    }
    if (kind < 0.5) {
        const double by = kind < 0.2 ? 1.0 + floor(random_in(random, -4.0, 5.0)) * 0x1p-53 : near;
        const assay_vec3 axis =
            kind < 0.1 ? vec3(0.0, near < 0.5 ? 1.0 : -1.0, 0.0) : random_unit(random);
        *n = kind < 0.2 ? r->normal : *n;
        *p = vec3_mad(r->position, s->a * r->radius * by, axis);
    } else if (kind < 0.52) {
        *p = r->position;
    } else if (kind < 0.53) {
        p->x = near < 0.3 ? NAN : near < 0.6 ? INFINITY : -1e300;
    }
}

static void check_query(pair *s, assay_vec3 p, assay_vec3 n, uint32_t limit)
{
    assert_int_equal(assay_record_store_find(s->octree, p, n, limit, &s->found), ASSAY_OK);
    assert_int_equal(assay_record_store_find(s->list, p, n, limit, &s->judge), ASSAY_OK);
    const assay_contributions *f = &s->found, *j = &s->judge;
    assert_int_equal(f->count, j->count);
    assert_true(same_bits(&f->weight, &j->weight, sizeof f->weight));
    for (size_t i = 0; i < f->count; i++) {
        assert_int_equal(f->items[i].number, j->items[i].number);
        assert_true(f->items[i].number < limit);
        assert_true(i == 0 || f->items[i - 1].number < f->items[i].number);
        assert_true(same_bits(&f->items[i].weight, &j->items[i].weight, sizeof(double)));
    }
    s->contributions += f->count;
    if (f->count > 0) {
        const assay_rgb a = assay_record_store_interpolate(s->octree, f, p, n);
        const assay_rgb b = assay_record_store_interpolate(s->list, j, p, n);
        assert_true(same_bits(&a, &b, sizeof a));
    }
}

static void check_reaches(pair *s, assay_vec3 p, assay_vec3 n)
{
    uint32_t   hint = 0;
    const bool any  = s->judge.count > 0;
    assert_int_equal(assay_record_store_reaches(s->octree, p, n, &s->hint), any);
    assert_int_equal(assay_record_store_reaches(s->list, p, n, &hint), any);
}

/* Queries of which half follow closely on the one before, as those of an image do. */
static void check_queries(pair *s, int count, assay_random *random)
{
    assay_vec3 p = ZERO, n = UP;
    for (int i = 0; i < count; i++) {
        if (assay_random_next(random) < 0.5) {
            random_query(s, random, &p, &n);
        } else if (s->judge.count > 0) {
            const uint32_t      k = s->judge.items[0].number;
            const assay_record *r = assay_record_store_at(s->list, k);
            p = vec3_mad(p, s->a * r->radius * exp2(random_in(random, -10.0, 0.0)),
                         random_unit(random));
        }
        const double records = assay_record_store_count(s->list);
        const bool   all     = assay_random_next(random) < 0.7;
        check_query(s, p, n, all ? UINT32_MAX : (uint32_t)random_in(random, 0.0, 1.1 * records));
        if (all) {
            check_reaches(s, p, n);
        }
        if (i % 1000 == 500 && vec3_finite(p)) {
            pair_add_at(s, p, random);
        }
    }
}

static void shrink_some(pair *s, assay_random *random)
{
    const uint32_t count = assay_record_store_count(s->list);
    for (uint32_t i = 0; i < count; i++) {
        if (assay_random_next(random) < 0.4) {
            const double radius =
                assay_record_store_at(s->list, i)->radius * exp2(random_in(random, -8.0, 0.0));
            assay_record_store_shrink(s->octree, i, radius);
            assay_record_store_shrink(s->list, i, radius);
        }
    }
}

/* 7 distributions x 2 weights x 72,000 queries: a million. */
static void octree_and_list_give_the_same_bits(void **state)
{
    enum { RECORDS = 150, QUERIES = 24000 };
    for (int d = 0; d < DISTRIBUTIONS; d++) {
        for (int kind = 0; kind < 2; kind++) {
            const assay_record_rules rules = {.a = kind ? 0.8 : 0.4,
                                              .weight =
                                                  kind ? ASSAY_WEIGHT_TABELLION : ASSAY_WEIGHT_WARD,
                                              .gradients      = ASSAY_GRADIENTS_BOTH,
                                              .in_front       = d % 2 == 0,
                                              .clamp_negative = d % 3 == 0};
            assay_random             random =
                assay_random_start(20, ASSAY_STAGE_TEST, (uint64_t)(2 * d + kind), 0);
            pair s;
            pair_make(*state, &s, d, &rules);
            pair_fill(&s, RECORDS, &random);
            check_queries(&s, QUERIES, &random);
            shrink_some(&s, &random);
            check_queries(&s, QUERIES, &random);
            pair_fill(&s, RECORDS, &random);
            check_queries(&s, QUERIES, &random);
            assert_true(s.contributions > QUERIES / 3);
            pair_destroy(&s);
        }
    }
}

/* Eq. 2.9 as printed, sum < a.  A record that contributes weighs 1 / a or more, so for a <= 1 a
 * miss is: no record contributes. */
static void a_miss_is_an_empty_set_for_small_a(void **state)
{
    static const double accuracy[] = {0.1, 0.5, 1.0};
    for (size_t k = 0; k < 3; k++) {
        const assay_record_rules rules  = {.a = accuracy[k]};
        assay_random             random = assay_random_start(23, ASSAY_STAGE_TEST, k, 0);
        int                      misses = 0;
        pair                     s;
        pair_make(*state, &s, UNIFORM, &rules);
        pair_fill(&s, 50, &random);
        for (int i = 0; i < 20000; i++) {
            assay_vec3 p, n;
            random_query(&s, &random, &p, &n);
            check_query(&s, p, n, UINT32_MAX);
            assert_true((s.found.weight < rules.a) == (s.found.count == 0));
            misses += s.found.count == 0;
        }
        assert_true(misses > 1000 && misses < 19000);
        pair_destroy(&s);
    }
}

/* ---- near ---- */

typedef struct {
    pair    *s;
    uint32_t numbers[512];
    size_t   count;
    bool     shrink;
} visits;

static void visit(void *user, uint32_t number)
{
    visits *v = user;
    assert_true(v->count < 512);
    v->numbers[v->count++] = number;
    if (v->shrink) {
        const double radius = assay_record_store_at(v->s->octree, number)->radius;
        assay_record_store_shrink(v->s->octree, number, 0.5 * radius);
    }
}

static void near_is_what_the_distance_says(void **state)
{
    for (int d = 0; d < DISTRIBUTIONS; d++) {
        const assay_record_rules rules  = {.a = 0.5};
        assay_random             random = assay_random_start(24, ASSAY_STAGE_TEST, (uint64_t)d, 0);
        pair                     s;
        pair_make(*state, &s, d, &rules);
        pair_fill(&s, 300, &random);
        for (int i = 0; i < 2000; i++) {
            const assay_record *r  = assay_record_store_at(s.list, (uint32_t)i % 300);
            visits              of = {.s = &s}, ol = {.s = &s};
            assay_vec3          p        = place_of(d, &random);
            double              distance = exp2(random_in(&random, -12.0, 2.0));
            if (i % 2) { /* a record at the border */
                distance = vec3_length(vec3_sub(p, r->position)) * (1.0 + (i % 5 - 2) * 0x1p-52);
            }
            assert_int_equal(assay_record_store_near(s.octree, p, distance, visit, &of), ASSAY_OK);
            assert_int_equal(assay_record_store_near(s.list, p, distance, visit, &ol), ASSAY_OK);
            assert_int_equal(of.count, ol.count);
            assert_true(same_bits(of.numbers, ol.numbers, of.count * sizeof *of.numbers));
            size_t count = 0;
            for (uint32_t k = 0; k < 300; k++) {
                const assay_vec3 at = assay_record_store_at(s.list, k)->position;
                if (vec3_length(vec3_sub(at, p)) < distance) {
                    assert_int_equal(of.numbers[count++], k);
                }
            }
            assert_int_equal(of.count, count);
        }
        visits all = {.s = &s, .shrink = true};
        assert_int_equal(assay_record_store_near(s.octree, ZERO, INFINITY, visit, &all), ASSAY_OK);
        assert_int_equal(all.count, 300);
        for (uint32_t k = 0; k < 300; k++) {
            assert_true(2.0 * assay_record_store_at(s.octree, k)->radius ==
                        assay_record_store_at(s.list, k)->radius);
        }
        visits none = {.s = &s};
        assert_int_equal(assay_record_store_near(s.octree, ZERO, 0.0, visit, &none), ASSAY_OK);
        assert_int_equal(assay_record_store_near(s.octree, ZERO, NAN, visit, &none), ASSAY_OK);
        assert_int_equal(none.count, 0);
        pair_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(octree_and_list_give_the_same_bits, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(a_miss_is_an_empty_set_for_small_a, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(near_is_what_the_distance_says, context_set_up,
                                        context_tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
