/* test_splat.c - sums of splatted records against queries of a store, pixel by pixel. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/measure.h"
#include "support/splat_room.h"

enum { WIDTH = 131, HEIGHT = 97, PIXELS = WIDTH * HEIGHT, RECORDS = 700 };

static const assay_record_rules RULES = {
    .a = 0.25, .gradients = ASSAY_GRADIENTS_BOTH, .clamp_negative = true};

typedef struct {
    assay_context      *context;
    assay_camera        camera;
    assay_record_store *store;
    assay_splat_buffer *buffer;
    assay_splat_source  source;
} room;

static room open_room(int threads, bool orthographic, const assay_record_rules *rules)
{
    room r = {.context = measure_context(threads), .camera = splat_room_camera(orthographic)};
    assert_int_equal(assay_record_store_create(r.context, rules, vec3(0, 0, 0), vec3(1, 1, 1),
                                               ASSAY_INDEX_OCTREE, &r.store),
                     ASSAY_OK);
    for (uint32_t k = 0; k < RECORDS; k++) {
        const assay_record record = splat_room_record(1, RECORDS, k);
        assert_int_equal(assay_record_store_add(r.store, &record), ASSAY_OK);
    }
    assert_int_equal(assay_splat_buffer_create(r.context, WIDTH, HEIGHT, &r.buffer), ASSAY_OK);
    splat_room_fill(r.buffer, &r.camera, WIDTH, HEIGHT);
    r.source = (assay_splat_source){.store = r.store, .rules = *rules};
    return r;
}

static void close_room(room *r)
{
    assay_splat_buffer_destroy(r->buffer);
    assay_record_store_destroy(r->store);
    assay_context_destroy(r->context);
}

static void splat_all(room *r)
{
    assert_int_equal(assay_splat_records(r->buffer, &r->source, 0, RECORDS), ASSAY_OK);
}

static bool near_to(double a, double b) { return fabs(a - b) <= 1e-12 * fabs(b); }

/* The largest sum of weights of a pixel that is not the query's, or 0; *reached: pixels with any
 * weight. */
static double check_against_queries(const room *r, size_t *reached)
{
    assay_contributions found = {0};
    double              worst = 0.0;
    *reached                  = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        assay_vec3 p, n;
        assay_rgb  sum = rgb_grey(0.0);
        if (!splat_room_point(&r->camera, WIDTH, HEIGHT, i, &p, &n)) {
            assert_true(assay_splat_weight(r->buffer, i) == 0.0);
            assert_true(rgb_is_black(assay_splat_mean(r->buffer, i)));
            continue;
        }
        assert_int_equal(assay_record_store_find(r->store, p, n, UINT32_MAX, &found), ASSAY_OK);
        if (assay_splat_weight(r->buffer, i) != found.weight) {
            worst = fmax(worst, found.weight);
            continue;
        }
        *reached += found.count > 0;
        for (size_t k = 0; k < found.count; k++) {
            const assay_record *record = assay_record_store_at(r->store, found.items[k].number);
            sum = rgb_add(sum, rgb_scale(assay_record_extrapolate(record, &r->source.rules, p, n),
                                         found.items[k].weight));
        }
        const assay_rgb got = assay_splat_sum(r->buffer, i);
        assert_true(near_to(got.r, sum.r) && near_to(got.g, sum.g) && near_to(got.b, sum.b));
        if (found.count > 0) {
            const assay_rgb said = assay_record_store_interpolate(r->store, &found, p, n);
            const assay_rgb mean = assay_splat_mean(r->buffer, i);
            assert_true(near_to(mean.r, said.r) && near_to(mean.g, said.g) &&
                        near_to(mean.b, said.b));
        }
    }
    assay_contributions_release(&found);
    return worst;
}

/* The weights to the bit, since they are added in the same order. */
static void same_as_queries(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        assay_record_rules rules = RULES;
        rules.weight             = kind == 2 ? ASSAY_WEIGHT_TABELLION : ASSAY_WEIGHT_WARD;
        rules.in_front           = kind == 3;
        room   r                 = open_room(2, kind == 1, &rules);
        size_t reached           = 0;
        splat_all(&r);
        assert_true(check_against_queries(&r, &reached) == 0.0);
        assert_true(reached > PIXELS / 2);
        assert_true(assay_splat_lost(r.buffer) == 0);
        close_room(&r);
    }
}

/* Another a with the same records: a store that is made for it knows the answer. */
static void another_accuracy(void **state)
{
    (void)state;
    assay_record_rules wide = RULES;
    wide.a                  = 0.6;
    room   r = open_room(1, false, &RULES), s = open_room(1, false, &wide);
    size_t reached = 0;
    r.source.rules = wide;
    splat_all(&r);
    splat_all(&s);
    assert_true(check_against_queries(&s, &reached) == 0.0);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(assay_splat_weight(r.buffer, i) == assay_splat_weight(s.buffer, i));
    }
    /* Mutant: the old a. */
    splat_room_fill(r.buffer, &r.camera, WIDTH, HEIGHT);
    r.source.rules = RULES;
    splat_all(&r);
    assert_true(assay_splat_weight(r.buffer, PIXELS / 2) !=
                assay_splat_weight(s.buffer, PIXELS / 2));
    close_room(&r);
    close_room(&s);
}

static void copy_sums(const room *r, double *sums)
{
    for (size_t i = 0; i < PIXELS; i++) {
        const assay_rgb sum    = assay_splat_sum(r->buffer, i);
        const double    all[4] = {sum.r, sum.g, sum.b, assay_splat_weight(r->buffer, i)};
        memcpy(sums + 4 * i, all, sizeof all);
    }
}

/* In one call, or one by one, by any number of threads. */
static void same_bits(void **state)
{
    (void)state;
    static double one[4 * PIXELS], other[4 * PIXELS];
    room          r = open_room(1, false, &RULES);
    splat_all(&r);
    copy_sums(&r, one);
    close_room(&r);
    for (int threads = 1; threads <= 3; threads++) {
        r = open_room(threads, false, &RULES);
        for (uint32_t k = 0; k < RECORDS;) {
            const uint32_t end = k < 100 ? k + 1 : k < 300 ? k + 7 : RECORDS;
            assert_int_equal(assay_splat_records(r.buffer, &r.source, k, end), ASSAY_OK);
            k = end;
        }
        copy_sums(&r, other);
        assert_memory_equal(one, other, sizeof one);
        assay_splat_buffer_clear(r.buffer);
        copy_sums(&r, other);
        assert_true(other[3] == 0.0 && other[4 * PIXELS - 1] == 0.0);
        splat_all(&r);
        copy_sums(&r, other);
        assert_memory_equal(one, other, sizeof one);
        close_room(&r);
    }
}

/* The same records backwards. */
static void any_order(void **state)
{
    (void)state;
    static double one[4 * PIXELS], other[4 * PIXELS];
    room          r     = open_room(2, false, &RULES);
    double        worst = 0.0;
    splat_all(&r);
    copy_sums(&r, one);
    assay_splat_buffer_clear(r.buffer);
    for (uint32_t k = RECORDS; k-- > 0;) {
        assert_int_equal(assay_splat_records(r.buffer, &r.source, k, k + 1), ASSAY_OK);
    }
    copy_sums(&r, other);
    for (size_t i = 0; i < sizeof one / sizeof *one; i++) {
        assert_true(near_to(other[i], one[i]));
        worst = one[i] > 0.0 ? fmax(worst, fabs(other[i] / one[i] - 1.0)) : worst;
    }
    print_message("#| backwards: sums differ by %.1e at most\n", worst);
    /* Mutant: some records twice. */
    assert_int_equal(assay_splat_records(r.buffer, &r.source, 0, 50), ASSAY_OK);
    copy_sums(&r, other);
    bool same = true;
    for (size_t i = 0; i < sizeof one / sizeof *one; i++) {
        same = same && near_to(other[i], one[i]);
    }
    assert_false(same);
    close_room(&r);
}

/* What the billboard loses is counted: so many contributions less than there are. */
static void billboards_lose(void **state)
{
    (void)state;
    room                r     = open_room(2, false, &RULES);
    assay_contributions found = {0};
    uint64_t            left  = 0;
    splat_all(&r);
    static double exact[4 * PIXELS], published[4 * PIXELS];
    copy_sums(&r, exact);
    assay_splat_buffer_clear(r.buffer);
    r.source.bounds = ASSAY_SPLAT_BOUNDS_PUBLISHED;
    splat_all(&r);
    copy_sums(&r, published);
    const assay_splat_view view = assay_splat_view_of(&r.camera, WIDTH, HEIGHT);
    for (size_t i = 0; i < PIXELS; i++) {
        assay_vec3 p, n;
        if (splat_room_point(&r.camera, WIDTH, HEIGHT, i, &p, &n)) {
            assert_int_equal(assay_record_store_find(r.store, p, n, UINT32_MAX, &found), ASSAY_OK);
            for (size_t k = 0; k < found.count; k++) {
                const assay_record *record = assay_record_store_at(r.store, found.items[k].number);
                const assay_splat_box box =
                    assay_splat_billboard(&view, record->position, 0.25 * record->radius);
                left += !assay_splat_box_holds(&box, (int)(i % WIDTH), (int)(i / WIDTH));
            }
        }
        assert_true(published[4 * i + 3] <= exact[4 * i + 3]);
    }
    print_message("#| contributions lost by billboards: %llu\n", (unsigned long long)left);
    assert_true(left > 500 && assay_splat_lost(r.buffer) == left);
    assay_contributions_release(&found);
    close_room(&r);
}

/* ---- what is said ---- */

typedef struct {
    size_t pixel[4][ASSAY_SPLAT_SLOTS];
    int    fail_at;
} listener;

static assay_status listen(void *user, const assay_splat_place *place, uint32_t record,
                           assay_rgb *said_out)
{
    listener *l = user;
    if (l->fail_at >= 0 && l->fail_at <= (int)record) {
        return ASSAY_ERR_DOMAIN;
    }
    assert_in_range(place->slot, 0, ASSAY_SPLAT_SLOTS - 1);
    l->pixel[place->worker][place->slot] = place->pixel;
    *said_out                            = rgb(3.0, (double)place->pixel, place->position.x);
    return ASSAY_OK;
}

static void others_speak(void **state)
{
    (void)state;
    static listener l;
    room            r = open_room(2, false, &RULES);
    l.fail_at         = -1;
    r.source.say      = listen;
    r.source.user     = &l;
    splat_all(&r);
    for (size_t i = 0; i < PIXELS; i++) {
        if (assay_splat_weight(r.buffer, i) > 0.0) {
            assay_vec3 p, n;
            splat_room_point(&r.camera, WIDTH, HEIGHT, i, &p, &n);
            const assay_rgb mean = assay_splat_mean(r.buffer, i);
            assert_true(near_to(mean.r, 3.0) && near_to(mean.g, (double)i) && near_to(mean.b, p.x));
        }
    }
    l.fail_at = 20;
    assert_int_equal(assay_splat_records(r.buffer, &r.source, 0, RECORDS), ASSAY_ERR_DOMAIN);
    close_room(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_queries), cmocka_unit_test(another_accuracy),
        cmocka_unit_test(same_bits),       cmocka_unit_test(any_order),
        cmocka_unit_test(billboards_lose), cmocka_unit_test(others_speak),
    };
    return cmocka_run_group_tests_name("splat", tests, NULL, NULL);
}
