/* test_record_store.c - the octree against the list: the same records, the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/random.h"
#include "record/record_store.h"
#include "support/failing_context.h"
#include "support/near.h"

static const assay_vec3 ZERO = {0.0, 0.0, 0.0}, ONE = {1.0, 1.0, 1.0}, UP = {0.0, 0.0, 1.0};

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

static double random_in(assay_random *random, double low, double high)
{
    return low + (high - low) * assay_random_next(random);
}

static assay_vec3 random_box(assay_random *random, double low, double high)
{
    const double x = random_in(random, low, high);
    const double y = random_in(random, low, high);
    return vec3(x, y, random_in(random, low, high));
}

static assay_vec3 random_unit(assay_random *random)
{
    return vec3_normalize(vec3_add(random_box(random, -1.0, 1.0), vec3(1e-3, 0.0, 0.0)));
}

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

static void check_queries(pair *s, int count, assay_random *random)
{
    const double records = assay_record_store_count(s->list);
    for (int i = 0; i < count; i++) {
        assay_vec3 p, n;
        random_query(s, random, &p, &n);
        const bool all = assay_random_next(random) < 0.7;
        check_query(s, p, n, all ? UINT32_MAX : (uint32_t)random_in(random, 0.0, 1.1 * records));
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
        cmocka_unit_test_setup_teardown(octree_and_list_give_the_same_bits, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sums_run_by_number, set_up, tear_down),
        cmocka_unit_test_setup_teardown(interpolation_by_hand, set_up, tear_down),
        cmocka_unit_test_setup_teardown(constants_stay_what_they_are, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_miss_is_an_empty_set_for_small_a, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_large_a_can_need_several, set_up, tear_down),
        cmocka_unit_test_setup_teardown(near_is_what_the_distance_says, set_up, tear_down),
        cmocka_unit_test_setup_teardown(unsound_records_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bad_accuracies_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(extreme_numbers, set_up, tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
