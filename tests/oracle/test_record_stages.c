/* test_record_stages.c - weights, interpolation, splatting, normalising, combining: what candidates
 * of few digits make lies within the bounds and uses them; what is wrong lies far beyond.
 *
 * The candidates are written here, from the papers, in rounded operations and orders of chance. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/measure.h"
#include "support/random_places.h"
#include "support/splat_room.h"
#include "support/stage_case.h"

enum { RECORDS = 150, SIDE = 14, POINTS = SIDE * SIDE };

static const double A = 0.6;

/* ---- the data ---- */

typedef struct {
    double position[3 * RECORDS], normal[3 * RECORDS], radius[RECORDS], irradiance[3 * RECORDS];
    double rotation[9 * RECORDS], translation[9 * RECORDS];
    double at[3 * POINTS], facing[3 * POINTS], frame[9 * POINTS], albedo[3 * POINTS];
} data;

static void put(double *to, const void *from, size_t count)
{
    memcpy(to, from, count * sizeof *to);
}

/* Every fifth point is at a record's very place. */
static data *make_data(void)
{
    data              *d      = calloc(1, sizeof *d);
    const assay_camera camera = splat_room_camera(false);
    assert_non_null(d);
    for (uint32_t k = 0; k < RECORDS; k++) {
        const assay_record r = splat_room_record(3, RECORDS, k);
        put(d->position + 3 * (size_t)k, &r.position, 3);
        put(d->normal + 3 * (size_t)k, &r.normal, 3);
        put(d->irradiance + 3 * (size_t)k, &r.irradiance, 3);
        put(d->rotation + 9 * (size_t)k, r.rotation, 9);
        put(d->translation + 9 * (size_t)k, r.translation, 9);
        d->radius[k] = 0.4 * r.radius;
    }
    for (size_t i = 0; i < POINTS; i++) {
        assay_vec3 p = vec3(0.5, 0.25, 0.0), n = vec3(0.0, 0.0, 1.0);
        splat_room_point(&camera, SIDE, SIDE, i, &p, &n);
        put(d->at + 3 * i, i % 5 == 0 ? (const void *)(d->position + 3 * (i % RECORDS)) : &p, 3);
        put(d->facing + 3 * i, i % 5 == 0 ? (const void *)(d->normal + 3 * (i % RECORDS)) : &n, 3);
        put(d->frame + 9 * i + 6, d->facing + 3 * i, 3);
        for (size_t c = 0; c < 3; c++) {
            d->albedo[3 * i + c] = 0.2 + 0.1 * (double)((i + 3 * c) % 7);
        }
    }
    return d;
}

/* Far from the origin, where positions are known less well than distances. */
static void move(data *d, double far)
{
    for (size_t i = 0; i < 3 * RECORDS; i++) {
        d->position[i] += far;
    }
    for (size_t i = 0; i < 3 * POINTS; i++) {
        d->at[i] += far;
    }
}

static void add_records(const stage_case *c, const data *d)
{
    stage_case_table(c, "records/position", "m", RECORDS, 3, d->position);
    stage_case_table(c, "records/normal", "", RECORDS, 3, d->normal);
    stage_case_table(c, "records/radius", "m", RECORDS, 1, d->radius);
    stage_case_table(c, "records/irradiance", "W/m2", RECORDS, 3, d->irradiance);
    stage_case_table(c, "records/rotation_gradient", "W/(m2 rad)", RECORDS, 9, d->rotation);
    stage_case_table(c, "records/translation_gradient", "W/m3", RECORDS, 9, d->translation);
}

static void add_queries(const stage_case *c, const data *d)
{
    stage_case_table(c, "query/position", "m", POINTS, 3, d->at);
    stage_case_table(c, "query/normal", "", POINTS, 3, d->facing);
}

/* ---- a candidate ---- */

/* What is planted in it. */
typedef enum {
    RIGHT,
    NO_TURN,       /* the weight without its second term  */
    FLIPPED,       /* the translational gradient's sign   */
    SWAPPED_CROSS, /* n' x n for n x n'                   */
    LARGER_RADIUS, /* R by one part in a hundred          */
    SMALLER_A,     /* records left out                    */
    NO_CLAMP,      /* below 0 stays there                 */
    TWICE,         /* the first record counts twice       */
    LOST           /* the last record is lost             */
} defect;

typedef struct {
    few_digits  f;
    const data *d;
    bool        tabellion, in_front;
    defect      defect;
} candidate;

static double few_turn(candidate *c, const double *n, const double *m)
{
    const double one = few(&c->f, 1.0 - few_dot(&c->f, 3, n, m));
    return one > 0.0 ? few(&c->f, sqrt(one)) : 0.0;
}

static void few_offset(const candidate *c, const double *p, const double *q, double *offset)
{
    for (int i = 0; i < 3; i++) {
        offset[i] = few(&c->f, few(&c->f, p[i]) - few(&c->f, q[i]));
    }
}

/* (p - p_k) . (n + n_k) / 2 < -R_k / 1000 */
static bool few_in_front(candidate *c, const double *offset, const double *n, size_t k)
{
    double both[3];
    for (size_t i = 0; i < 3; i++) {
        both[i] = few(&c->f, few(&c->f, n[i]) + few(&c->f, c->d->normal[3 * k + i]));
    }
    return 0.5 * few_dot(&c->f, 3, offset, both) <
           few(&c->f, few(&c->f, -1e-3) * few(&c->f, c->d->radius[k]));
}

static double few_weight(candidate *c, const double *p, const double *n, size_t k)
{
    double            offset[3];
    const few_digits *f = &c->f;
    few_offset(c, p, c->d->position + 3 * k, offset);
    if (c->in_front && few_in_front(c, offset, n, k)) {
        return 0.0;
    }
    const double scale    = c->defect == LARGER_RADIUS ? 1.01 : 1.0;
    const double distance = few(f, sqrt(few_dot(&c->f, 3, offset, offset)));
    const double moved    = few(f, distance / few(f, scale * c->d->radius[k]));
    const double turned   = c->defect == NO_TURN ? 0.0 : few_turn(c, n, c->d->normal + 3 * k);
    const double a        = few(f, c->defect == SMALLER_A ? 0.9 * A : A);
    if (c->tabellion) {
        const double by_turn = few(f, turned / few(f, 0.12325683343243887));
        const double weight  = few(f, 1.0 - few(f, fmax(moved, by_turn) / a));
        return weight > 0.0 ? weight : 0.0;
    }
    const double change = few(f, moved + turned);
    const double weight = change < 1e-12 ? few(f, 1e12) : few(f, 1.0 / change);
    return weight >= few(f, 1.0 / a) ? weight : 0.0;
}

static double few_said(candidate *c, const double *p, const double *n, size_t k, size_t channel)
{
    double            offset[3], cross[3], terms[3];
    const few_digits *f = &c->f;
    const double     *m = c->d->normal + 3 * k;
    few_offset(c, p, c->d->position + 3 * k, offset);
    for (int i = 0; i < 3; i++) {
        const int    j = (i + 1) % 3, l = (i + 2) % 3;
        const double left  = few(f, few(f, m[j]) * few(f, n[l]));
        const double right = few(f, few(f, m[l]) * few(f, n[j]));
        cross[i]           = few(f, c->defect == SWAPPED_CROSS ? right - left : left - right);
        offset[i]          = c->defect == FLIPPED ? -offset[i] : offset[i];
    }
    terms[0]         = few(f, c->d->irradiance[3 * k + channel]);
    terms[1]         = few_dot(&c->f, 3, cross, c->d->rotation + 9 * k + 3 * channel);
    terms[2]         = few_dot(&c->f, 3, offset, c->d->translation + 9 * k + 3 * channel);
    const double sum = few_sum(&c->f, 3, terms);
    return sum < 0.0 && c->defect != NO_CLAMP ? 0.0 : sum;
}

/* Weights of the records that count, and what they say of one channel. */
static size_t few_terms(candidate *c, const double *p, const double *n, size_t channel,
                        double weights[RECORDS + 1], double said[RECORDS + 1])
{
    size_t count = 0;
    for (size_t k = 0; k < RECORDS; k++) {
        const double w = few_weight(c, p, n, k);
        if (w > 0.0) {
            weights[count] = w;
            said[count++]  = few_said(c, p, n, k, channel);
        }
    }
    if (c->defect == TWICE && count > 0) {
        weights[count] = weights[0];
        said[count]    = said[0];
        count++;
    }
    return c->defect == LOST && count > 1 ? count - 1 : count;
}

/* ---- weights ---- */

static bound_use use_weights(const data *d, assay_context *context, assay_precision precision,
                             int digits, bool tabellion, bool in_front, defect planted)
{
    stage_case c   = stage_case_begin(context);
    bound_use  use = {0};
    candidate  me  = {.d = d, .tabellion = tabellion, .in_front = in_front, .defect = planted};
    me.f           = (few_digits){digits, assay_random_start(1, ASSAY_STAGE_TEST, 7, 0)};
    stage_case_text(&c, "a", "0.6");
    stage_case_text(&c, "weight", tabellion ? "tabellion" : "ward");
    stage_case_text(&c, "in_front", in_front ? "on" : "off");
    add_records(&c, d);
    add_queries(&c, d);
    stage_case_run(&c, "weights", precision);
    const stage_output *out = stage_case_output(&c, "query/weight");
    assert_int_equal(out->rows, POINTS);
    assert_int_equal(out->columns, RECORDS);
    for (size_t i = 0; i < POINTS * RECORDS; i++) {
        const double w =
            few_weight(&me, d->at + 3 * (i / RECORDS), d->facing + 3 * (i / RECORDS), i % RECORDS);
        bound_use_add(&use, w, out->values[i], out->bounds[i]);
    }
    stage_case_end(&c);
    return use;
}

static void test_weights(void **state)
{
    data *d = make_data();
    for (int tabellion = 0; tabellion < 2; tabellion++) {
        for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
            const int       digits[] = {11, 24, 53};
            const bound_use right =
                use_weights(d, *state, (assay_precision)p, digits[p], tabellion, false, RIGHT);
            print_message("weights, %d digits, tabellion %d: %.3f of the bound\n", digits[p],
                          tabellion, right.most);
            assert_int_equal(right.beyond, 0);
            assert_true(p == ASSAY_PRECISION_DOUBLE || right.most > 0.1);
        }
        const defect wrong[] = {NO_TURN, LARGER_RADIUS, SMALLER_A};
        for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
            const bound_use bad =
                use_weights(d, *state, ASSAY_PRECISION_FLOAT, 24, tabellion, false, wrong[i]);
            print_message("  defect %d: %.3g times the bound, %zu values\n", wrong[i], bad.most,
                          bad.beyond);
            assert_true(bad.most > 50.0);
        }
    }
    free(d);
}

/* ---- interpolation ---- */

static bound_use use_means(const data *d, assay_context *context, assay_precision precision,
                           int digits, defect planted, bound_use *sums)
{
    stage_case c   = stage_case_begin(context);
    bound_use  use = {0};
    candidate  me  = {.d = d, .defect = planted};
    me.f           = (few_digits){digits, assay_random_start(2, ASSAY_STAGE_TEST, 7, 0)};
    stage_case_text(&c, "a", "0.6");
    add_records(&c, d);
    add_queries(&c, d);
    stage_case_run(&c, "interpolate", precision);
    const stage_output *mean = stage_case_output(&c, "query/irradiance");
    const stage_output *sum  = stage_case_output(&c, "query/weight_sum");
    for (size_t i = 0; i < 3 * POINTS; i++) {
        double       weights[RECORDS + 1], said[RECORDS + 1];
        const size_t count =
            few_terms(&me, d->at + 3 * (i / 3), d->facing + 3 * (i / 3), i % 3, weights, said);
        const double top    = few_dot(&me.f, count, weights, said);
        const double bottom = few_sum(&me.f, count, weights);
        bound_use_add(&use, count ? few(&me.f, top / bottom) : 0.0, mean->values[i],
                      mean->bounds[i]);
        bound_use_add(sums, bottom, sum->values[i / 3], sum->bounds[i / 3]);
    }
    stage_case_end(&c);
    return use;
}

static void test_interpolate(void **state)
{
    data     *d        = make_data();
    const int digits[] = {11, 24, 53};
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        bound_use       sums  = {0};
        const bound_use right = use_means(d, *state, (assay_precision)p, digits[p], RIGHT, &sums);
        print_message("interpolate, %d digits: %.3f of the bound, sums %.3f\n", digits[p],
                      right.most, sums.most);
        assert_int_equal(right.beyond, 0);
        assert_int_equal(sums.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || (right.most > 0.03 && sums.most > 0.03));
    }
    const defect wrong[] = {NO_TURN, FLIPPED, SWAPPED_CROSS, LARGER_RADIUS, SMALLER_A, TWICE, LOST};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        bound_use       sums = {0};
        const bound_use bad  = use_means(d, *state, ASSAY_PRECISION_FLOAT, 24, wrong[i], &sums);
        print_message("  defect %d: %.3g times the bound\n", wrong[i], bad.most);
        assert_true(bad.most > 50.0);
    }
    free(d);
}

/* On one wall all records are as high as the rounding leaves them, and some are just about as high
 * as the margin. */
static void test_in_front(void **state)
{
    data *d = make_data();
    for (size_t k = 0; k < RECORDS; k++) {
        const assay_vec3 p = vec3(0.01 * (double)(k % 12), 0.01 * (double)(k / 12), 0.0);
        const assay_vec3 n = vec3(0.0, 0.0, 1.0);
        put(d->position + 3 * k, &p, 3);
        put(d->normal + 3 * k, &n, 3);
        d->radius[k] = 0.2;
    }
    for (size_t i = 0; i < POINTS; i++) {
        const double     near = -2e-4 * (1.0 + 1e-9 * ((double)i - 98.0));
        const double     high = i % 6 == 0 ? 0.0 : i % 6 == 1 ? -0.01 : near;
        const assay_vec3 p    = vec3(0.008 * (double)(i % 14), 0.008 * (double)(i / 14), high);
        const assay_vec3 n    = vec3(0.0, 0.0, 1.0);
        put(d->at + 3 * i, &p, 3);
        put(d->facing + 3 * i, &n, 3);
    }
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        const int       digits[] = {11, 24, 53};
        const bound_use use =
            use_weights(d, *state, (assay_precision)p, digits[p], false, true, RIGHT);
        assert_int_equal(use.beyond, 0);
    }
    assert_true(use_weights(d, *state, ASSAY_PRECISION_FLOAT, 24, true, true, RIGHT).beyond == 0);
    /* Seen as if records in front counted. */
    stage_case c = stage_case_begin(*state);
    stage_case_text(&c, "a", "0.6");
    stage_case_text(&c, "in_front", "on");
    add_records(&c, d);
    add_queries(&c, d);
    stage_case_run(&c, "weights", ASSAY_PRECISION_FLOAT);
    const stage_output *out  = stage_case_output(&c, "query/weight");
    size_t              sure = 0;
    for (size_t i = 0; i < POINTS * RECORDS; i++) {
        sure += out->values[i] == 0.0 && out->bounds[i] == 0.0;
    }
    assert_true(sure > POINTS * RECORDS / 10);
    stage_case_end(&c);
    free(d);
}

static void test_far_away(void **state)
{
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_FLOAT; p++) {
        data     *d      = make_data();
        bound_use sums   = {0};
        const int digits = p == ASSAY_PRECISION_HALF ? 11 : 24;
        move(d, p == ASSAY_PRECISION_HALF ? 7.0 : 3000.0);
        const bound_use weights =
            use_weights(d, *state, (assay_precision)p, digits, false, false, RIGHT);
        const bound_use means = use_means(d, *state, (assay_precision)p, digits, RIGHT, &sums);
        print_message("far away, %d digits: %.3f, %.3f, %.3f of the bound\n", digits, weights.most,
                      means.most, sums.most);
        assert_int_equal(weights.beyond + means.beyond + sums.beyond, 0);
        free(d);
    }
}

/* ---- splatting ---- */

static bound_use use_splat(const data *d, assay_context *context, assay_precision precision,
                           int digits, defect planted)
{
    stage_case   c      = stage_case_begin(context);
    bound_use    use    = {0};
    candidate    me     = {.d = d, .defect = planted};
    const double ends[] = {0.0, RECORDS / 2, RECORDS};
    me.f                = (few_digits){digits, assay_random_start(3, ASSAY_STAGE_TEST, 7, 0)};
    stage_case_text(&c, "assay:method", "splat");
    stage_case_text(&c, "assay:splat.a", "0.6");
    add_records(&c, d);
    stage_case_table(&c, "splat/position", "m", POINTS, 3, d->at);
    stage_case_table(&c, "splat/frame", "", POINTS, 9, d->frame);
    stage_case_table(&c, "splat/albedo", "", POINTS, 3, d->albedo);
    stage_case_table(&c, "splat/batch_end", "records", 3, 1, ends);
    stage_case_run(&c, "splat", precision);
    assert_int_equal(c.run.out_count, 6);
    const stage_output *none = stage_case_output(&c, "splat/batch.0/weight");
    const stage_output *sum  = stage_case_output(&c, "splat/batch.2/radiance");
    for (size_t i = 0; i < POINTS; i++) {
        assert_true(none->values[i] == 0.0 && none->bounds[i] == 0.0);
    }
    for (size_t i = 0; i < 3 * POINTS; i++) {
        double       weights[RECORDS + 1], said[RECORDS + 1];
        const size_t count =
            few_terms(&me, d->at + 3 * (i / 3), d->facing + 3 * (i / 3), i % 3, weights, said);
        const double total = few_dot(&me.f, count, weights, said);
        const double share = few(&me.f, few(&me.f, d->albedo[i]) * few(&me.f, 0.3183098861837907));
        bound_use_add(&use, few(&me.f, total * share), sum->values[i], sum->bounds[i]);
    }
    stage_case_end(&c);
    return use;
}

static void test_splat(void **state)
{
    data     *d        = make_data();
    const int digits[] = {11, 24, 53};
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        const bound_use right = use_splat(d, *state, (assay_precision)p, digits[p], RIGHT);
        print_message("splat, %d digits: %.3f of the bound\n", digits[p], right.most);
        assert_int_equal(right.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || right.most > 0.03);
    }
    const defect wrong[] = {NO_TURN, FLIPPED, LARGER_RADIUS, TWICE, LOST};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const bound_use bad = use_splat(d, *state, ASSAY_PRECISION_FLOAT, 24, wrong[i]);
        print_message("  defect %d: %.3g times the bound\n", wrong[i], bad.most);
        assert_true(bad.most > 50.0);
    }
    free(d);
}

/* ---- normalising and combining ---- */

static void test_normalise_and_combine(void **state)
{
    enum { PIXELS = 500 };
    double       weight[PIXELS], sum[3 * PIXELS], direct[3 * PIXELS];
    assay_random random   = assay_random_start(4, ASSAY_STAGE_TEST, 7, 0);
    const int    digits[] = {11, 24, 53};
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        weight[i / 3] = i < 30 ? 0.0 : random_in(&random, 0.1, 30.0);
        sum[i]        = i < 30 ? 0.0 : random_in(&random, 0.0, 9.0);
        direct[i]     = random_in(&random, 0.0, 2.0);
    }
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        const few_digits f   = {digits[p], random};
        bound_use        use = {0}, combined = {0};
        for (int stage = 0; stage < 2; stage++) {
            stage_case c = stage_case_begin(*state);
            stage_case_table(&c, "splat/batch.0/weight", "", PIXELS, 1, direct);
            stage_case_table(&c, "splat/batch.1/weight", "", PIXELS, 1, weight);
            stage_case_table(&c, "splat/batch.0/radiance", "W/(m2 sr)", PIXELS, 3, direct);
            stage_case_table(&c, "splat/batch.1/radiance", "W/(m2 sr)", PIXELS, 3, sum);
            stage_case_table(&c, "radiance/direct", "W/(m2 sr)", PIXELS, 3, direct);
            stage_case_table(&c, "radiance/indirect", "W/(m2 sr)", PIXELS, 3, sum);
            stage_case_run(&c, stage ? "combine" : "normalise", (assay_precision)p);
            const stage_output *out = &c.run.out[0];
            for (size_t i = 0; i < 3 * PIXELS; i++) {
                const double a = few(&f, sum[i]), w = few(&f, weight[i / 3]);
                const double b = few(&f, direct[i]);
                if (stage) {
                    bound_use_add(&combined, few(&f, a + b), out->values[i], out->bounds[i]);
                } else {
                    bound_use_add(&use, w > 0.0 ? few(&f, a / w) : 0.0, out->values[i],
                                  out->bounds[i]);
                }
            }
            stage_case_end(&c);
        }
        print_message("normalise, combine, %d digits: %.3f, %.3f of the bound\n", digits[p],
                      use.most, combined.most);
        assert_int_equal(use.beyond + combined.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || (use.most > 0.4 && combined.most > 0.4));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_weights, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_interpolate, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_in_front, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_far_away, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_splat, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_normalise_and_combine, context_set_up,
                                        context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
