/* test_octree.c - what walks offer, against all items. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "math/octree.h"
#include "support/failing_context.h"
#include "support/random_places.h"

enum { ITEMS = 2000, WALKS = 1000 };

static const assay_vec3 LOW = {-1.0, 2.0, 3.0}, HIGH = {3.0, 5.0, 4.0};

/* A place in the bounds, grown by a factor about their middle. */
static assay_vec3 random_place(assay_random *random, double factor)
{
    const double x = random_in(random, -factor, factor), y = random_in(random, -factor, factor);
    const double z = random_in(random, -factor, factor);
    return vec3(1.0 + 2.0 * x, 3.5 + 1.5 * y, 3.5 + 0.5 * z);
}

static double largest(assay_vec3 v) { return fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z)); }

typedef struct {
    assay_octree *octree;
    assay_vec3    place[ITEMS];
    double        reach[ITEMS];
    unsigned char offered[ITEMS];
    size_t        count; /* offered by the last walk */
} crowd;

static void fill(assay_context *context, crowd *c, double factor, double smallest, uint64_t seed)
{
    assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, 0, 0);
    assert_int_equal(assay_octree_create(context, LOW, HIGH, &c->octree), ASSAY_OK);
    for (int i = 0; i < ITEMS; i++) {
        c->place[i] = random_place(&random, factor);
        c->reach[i] = smallest * exp2(random_in(&random, 0.0, -log2(smallest)));
        assert_int_equal(assay_octree_add(c->octree, c->place[i], c->reach[i]), ASSAY_OK);
    }
}

/* Walks to the end; no item may come twice. */
static void finish(crowd *c, assay_octree_walk *walk)
{
    memset(c->offered, 0, sizeof c->offered);
    c->count = 0;
    for (uint32_t i; (i = assay_octree_walk_next(walk)) != ASSAY_OCTREE_END; c->count++) {
        assert_true(i < ITEMS && !c->offered[i]);
        c->offered[i] = 1;
    }
}

static void check_about(crowd *c, assay_random *random, double factor, bool selective)
{
    assay_octree_walk walk;
    for (int k = 0; k < WALKS; k++) {
        const assay_vec3 p = random_place(random, factor);
        assay_octree_walk_about(&walk, c->octree, p);
        finish(c, &walk);
        uint32_t close = 0;
        for (int i = 0; i < ITEMS; i++) {
            const assay_vec3 d = vec3_sub(p, c->place[i]);
            assert_true(c->offered[i] == (vec3_dot(d, d) <= c->reach[i] * c->reach[i]));
            close += largest(d) < 6.0001 * c->reach[i];
        }
        /* A cube's side is below 4 reaches, the point within one and a half sides. */
        assert_true(!selective || walk.looked <= close);
    }
}

/* The items whose reach holds the point, each once; those far away are not even looked at. */
static void walks_offer_what_reaches(void **state)
{
    static crowd c;
    assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, 1, 0);
    fill(*state, &c, 1.0, 1e-3, 5);
    check_about(&c, &random, 1.2, true);
    assay_octree_destroy(c.octree);
    fill(*state, &c, 1.0, 1e-9, 6);
    check_about(&c, &random, 1.0, true);
    assay_octree_destroy(c.octree);
    fill(*state, &c, 3.0, 1e-2, 7); /* many outside of the bounds */
    check_about(&c, &random, 4.0, false);
    assay_octree_destroy(c.octree);
    assay_octree_destroy(NULL);
}

/* On a cube's face, with half the cube's side as reach, and asked at the far end of it: every
 * rounding of the way into the root's cube would lose some. */
static void borders_are_inside(void **state)
{
    static crowd      c;
    assay_octree_walk walk;
    const double      side   = 1.0001 * 4.0; /* of the root; its low corner: */
    const assay_vec3  corner = vec3(1.0 - 0.5 * side, 3.5 - 0.5 * side, 3.5 - 0.5 * side);
    assay_random      random = assay_random_start(6, ASSAY_STAGE_TEST, 1, 0);
    size_t            within = 0;
    assert_int_equal(assay_octree_create(*state, LOW, HIGH, &c.octree), ASSAY_OK);
    for (int i = 0; i < ITEMS; i++) {
        const double cubes = exp2(1.0 + i % 12), unit = side / cubes;
        const double x = floor(random_in(&random, 0.0, cubes)) * unit;
        const double y = floor(random_in(&random, 0.0, cubes)) * unit;
        const double z = floor(random_in(&random, 0.0, cubes)) * unit;
        c.place[i]     = vec3_add(corner, vec3(x, y, z));
        c.reach[i]     = 0.5 * unit * (1.0 + (double)(i % 5 - 3) * 0x1p-53);
        assert_int_equal(assay_octree_add(c.octree, c.place[i], c.reach[i]), ASSAY_OK);
    }
    for (int i = 0; i < ITEMS * 6; i++) {
        const int        k    = i / 6;
        const double     by   = i % 2 ? c.reach[k] : -c.reach[k];
        const assay_vec3 axis = vec3(i % 6 / 2 == 0, i % 6 / 2 == 1, i % 6 / 2 == 2);
        const assay_vec3 p    = vec3_mad(c.place[k], by, axis);
        const assay_vec3 d    = vec3_sub(p, c.place[k]);
        const bool       in   = vec3_dot(d, d) <= c.reach[k] * c.reach[k];
        assay_octree_walk_about(&walk, c.octree, p);
        finish(&c, &walk);
        assert_true(c.offered[k] == in);
        within += in;
    }
    assert_true(within > ITEMS * 2);
    assay_octree_destroy(c.octree);
}

static void walks_offer_what_is_near(void **state)
{
    static crowd      c;
    assay_octree_walk walk;
    size_t            all    = 0;
    assay_random      random = assay_random_start(2, ASSAY_STAGE_TEST, 1, 0);
    fill(*state, &c, 1.1, 1e-9, 8);
    for (int k = 0; k < WALKS; k++) {
        const assay_vec3 p        = random_place(&random, 1.5);
        const double     distance = exp2(random_in(&random, -10.0, 3.0));
        assay_octree_walk_near(&walk, c.octree, p, distance);
        finish(&c, &walk);
        all += walk.looked;
        for (int i = 0; i < ITEMS; i++) {
            const assay_vec3 d = vec3_sub(p, c.place[i]);
            assert_true(c.offered[i] == (vec3_dot(d, d) <= distance * distance));
        }
    }
    assert_true(all < (size_t)WALKS * ITEMS * 2 / 3);
    assay_octree_walk_near(&walk, c.octree, vec3(1e9, 0.0, 0.0), INFINITY);
    finish(&c, &walk);
    assert_int_equal(c.count, ITEMS);
    assay_octree_destroy(c.octree);
}

/* As selective as if they had been added so. */
static void shrunk_items_move_down(void **state)
{
    static crowd c;
    assay_random random = assay_random_start(3, ASSAY_STAGE_TEST, 1, 0);
    fill(*state, &c, 1.0, 1e-3, 9);
    for (int round = 0; round < 3; round++) {
        for (uint32_t i = 0; i < ITEMS; i++) {
            c.reach[i] *= i % 3 ? exp2(random_in(&random, -4.0, 0.0)) : 1.0;
            assay_octree_shrink(c.octree, i, c.reach[i]);
        }
        check_about(&c, &random, 1.1, true);
    }
    assay_octree_destroy(c.octree);
}

/* Refused at every place: the items stay, and are offered as before. */
static void shrinking_without_memory(void **state)
{
    (void)state;
    for (uint64_t n = 1; n < 20; n++) {
        static crowd   c;
        failing_memory memory  = {0};
        assay_context *context = failing_context(&memory);
        assay_random   random  = assay_random_start(4, ASSAY_STAGE_TEST, 1, 0);
        fill(context, &c, 1.0, 0.2, 10);
        memory.fail_at = memory.asked + n;
        for (uint32_t i = 0; i < ITEMS; i++) {
            c.reach[i] *= 1e-6;
            assay_octree_shrink(c.octree, i, c.reach[i]);
        }
        const bool refused = memory.asked >= memory.fail_at;
        memory.fail_at     = 0;
        check_about(&c, &random, 1.1, !refused);
        assay_octree_destroy(c.octree);
        assert_int_equal(memory.live, 1);
        assay_context_destroy(context);
        if (!refused) {
            assert_true(n > 1);
            return;
        }
    }
    fail_msg("refusals do not end");
}

/* A reach below the smallest cube, and none at all, end at the last level. */
static void the_depth_is_bounded(void **state)
{
    static crowd      c;
    assay_octree_walk walk;
    assert_int_equal(assay_octree_create(*state, LOW, HIGH, &c.octree), ASSAY_OK);
    for (int i = 0; i < ITEMS; i++) {
        const double reach = i % 2 ? 0.0 : 5e-324;
        assert_int_equal(assay_octree_add(c.octree, vec3(0.1, 2.3, 3.7), reach), ASSAY_OK);
    }
    assert_true(assay_octree_bytes(c.octree) < 100 * 1024);
    assay_octree_walk_about(&walk, c.octree, vec3(0.1, 2.3, 3.7));
    finish(&c, &walk);
    assert_int_equal(c.count, ITEMS);
    assay_octree_walk_about(&walk, c.octree, vec3(0.1, 2.3 + 1e-8, 3.7));
    finish(&c, &walk);
    assert_int_equal(c.count, 0);
    assay_octree_destroy(c.octree);
}

/* Bounds of no use change no answer. */
static void strange_bounds(void **state)
{
    static const struct {
        assay_vec3 low, high;
    } bounds[] = {{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}},
                  {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}},
                  {{1.0, 1.0, 1.0}, {0.0, 0.0, 0.0}},
                  {{0.0, 0.0, 0.0}, {1.0, NAN, 1.0}},
                  {{-1e308, 0.0, 0.0}, {1e308, 1.0, 1.0}},
                  {{0.0, 0.0, 0.0}, {1e-200, 0.0, 0.0}}};
    static crowd      c;
    assay_octree_walk walk;
    for (size_t k = 0; k < sizeof bounds / sizeof *bounds; k++) {
        assert_int_equal(assay_octree_create(*state, bounds[k].low, bounds[k].high, &c.octree),
                         ASSAY_OK);
        for (int i = 0; i < 100; i++) {
            assert_int_equal(assay_octree_add(c.octree, vec3(i, 1e300, -1e-300 * i), i * 1e-9),
                             ASSAY_OK);
        }
        assay_octree_shrink(c.octree, 50, 1e-12);
        assay_octree_walk_about(&walk, c.octree, vec3(NAN, 0.0, INFINITY));
        finish(&c, &walk);
        assert_int_equal(c.count, 0);
        assay_octree_walk_about(&walk, c.octree, vec3(7.0 + 6e-9, 1e300, 0.0));
        finish(&c, &walk);
        assert_true(c.count == 1 && c.offered[7]);
        assay_octree_walk_near(&walk, c.octree, vec3(0.0, 0.0, 0.0), INFINITY);
        finish(&c, &walk);
        assert_int_equal(c.count, 100);
        assay_octree_destroy(c.octree);
    }
}

static assay_status grow_one(assay_context *context, void *user)
{
    (void)user;
    assay_random  random = assay_random_start(5, ASSAY_STAGE_TEST, 1, 0);
    assay_octree *octree = NULL;
    assay_status  status = assay_octree_create(context, LOW, HIGH, &octree);
    if (status != ASSAY_OK) {
        assert_null(octree);
        return status;
    }
    for (uint32_t i = 0; i < 300 && status == ASSAY_OK; i++) {
        status = assay_octree_add(octree, random_place(&random, 1.0), 1e-4);
    }
    assay_octree_destroy(octree);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_true(failing_each(grow_one, NULL) > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(walks_offer_what_reaches, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(borders_are_inside, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(walks_offer_what_is_near, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(shrunk_items_move_down, context_set_up, context_tear_down),
        cmocka_unit_test(shrinking_without_memory),
        cmocka_unit_test_setup_teardown(the_depth_is_bounded, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(strange_bounds, context_set_up, context_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
