/* test_flip.c - FLIP against closed forms, against its definition in long double, and its
 * symmetries.
 *
 * Maps hold floats: an error in [0, 1] is rounded by at most 2^-25 = 3e-8. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "assay/metrics.h"
#include "support/failing_context.h"
#include "support/flip_judge.h"
#include "support/near.h"
#include "support/pictures.h"

static const double ROUNDING = 4e-8;

static assay_image *flip(const assay_image *a, const assay_image *b, assay_flip_kind kind,
                         const assay_metrics_options *options, assay_flip_summary *summary)
{
    assay_image *map = NULL;
    assert_int_equal(assay_image_flip(a, b, kind, options, summary, &map), ASSAY_OK);
    return map;
}

static void assert_same(const assay_flip_summary *s, const assay_flip_summary *t)
{
    assert_true(s->mean == t->mean && s->minimum == t->minimum && s->maximum == t->maximum);
    assert_true(s->weighted_median == t->weighted_median);
    assert_true(s->first_quartile == t->first_quartile && s->third_quartile == t->third_quartile);
    assert_true(s->start_exposure == t->start_exposure && s->stop_exposure == t->stop_exposure);
    assert_true(s->max_x == t->max_x && s->max_y == t->max_y && s->exposures == t->exposures);
}

/* The judge's picture of an image; to be freed. */
static judge_picture judged(const assay_image *image, double factor)
{
    const int    width = assay_image_width(image), height = assay_image_height(image);
    judge_color *pixels = calloc((size_t)(width * height), sizeof *pixels);
    assert_non_null(pixels);
    for (int c = 0; c < 3; c++) {
        const float *values = picture_channel(image, c == 0 ? "R" : c == 1 ? "G" : "B");
        for (int i = 0; i < width * height; i++) {
            pixels[i].v[c] = (long double)factor * (long double)values[i];
        }
    }
    return (judge_picture){width, height, pixels};
}

static void nothing_is_seen_between_equal_pictures(void **state)
{
    const assay_metrics_options options = assay_metrics_defaults();
    assay_image                *a       = picture_random(*state, 40, 30, 3.0, 1);
    for (int kind = 0; kind < 2; kind++) {
        assay_flip_summary s;
        assay_image       *map = flip(a, a, (assay_flip_kind)kind, &options, &s);
        for (int i = 0; i < 40 * 30; i++) {
            assert_true(picture_channel(map, "FLIP")[i] == 0.0F);
        }
        assert_true(s.mean == 0.0 && s.maximum == 0.0 && s.weighted_median == 0.0);
        assert_int_equal(assay_image_find_channel(map, "Exposure", NULL), kind == ASSAY_FLIP_HDR);
        assay_image_destroy(map);
    }
    assay_image_destroy(a);
}

/* Without features the error is that of two colours, wherever the tiles and borders are. */
static void two_colors(void **state)
{
    static const double PAIRS[][6] = {
        {0.0, 0.0, 0.0, 1.0, 1.0, 1.0},     {0.0, 1.0, 0.0, 0.0, 0.0, 1.0},
        {0.5, 0.25, 0.125, 0.5, 0.5, 0.5},  {0.25, 0.25, 0.25, 0.2501220703125, 0.25, 0.25},
        {1.0, 0.0, 0.0, 0.0, 1.0, 1.0},     {0.0, 0.0, 0.0, 0.0009765625, 0.0, 0.0},
        {0.75, 0.75, 0.75, 0.75, 0.75, 1.0}};
    const assay_metrics_options options = assay_metrics_defaults();
    for (size_t i = 0; i < sizeof PAIRS / sizeof PAIRS[0]; i++) {
        const double      *p     = PAIRS[i];
        const judge_color  first = {{p[0], p[1], p[2]}}, second = {{p[3], p[4], p[5]}};
        const double       expected = (double)judge_flip_constant(first, second);
        assay_image       *a        = picture_constant(*state, 259, 131, p[0], p[1], p[2]);
        assay_image       *b        = picture_constant(*state, 259, 131, p[3], p[4], p[5]);
        assay_flip_summary s;
        assay_image       *map = flip(a, b, ASSAY_FLIP_LDR, &options, &s);
        /* Rounding in the filters leaves features of 1e-16, of which the root is taken. */
        for (int k = 0; k < 259 * 131; k++) {
            assert_near((double)picture_channel(map, "FLIP")[k], expected, 2e-7);
        }
        assert_near(s.mean, expected, 2e-7);
        assert_near(s.weighted_median, expected, 2e-7);
        assay_image_destroy(map);
        assay_image_destroy(a);
        assay_image_destroy(b);
    }
}

/* Green and blue are as far apart as two colours can be; black and white are not. */
static void the_scale_ends_at_one(void **state)
{
    (void)state;
    const judge_color green = {{0.0L, 1.0L, 0.0L}}, blue = {{0.0L, 0.0L, 1.0L}};
    assert_near((double)judge_flip_constant(green, blue), 1.0, 1e-15);
}

/* Every pixel of two small pictures. */
static void check_all(const assay_image *a, const assay_image *b, double exposure, double ppd)
{
    const judge_picture   p = judged(a, exp2(exposure)), q = judged(b, exp2(exposure));
    assay_flip_summary    s;
    assay_metrics_options options = assay_metrics_defaults();
    options.exposure              = exposure;
    options.pixels_per_degree     = ppd;
    assay_image *map              = flip(a, b, ASSAY_FLIP_LDR, &options, &s);
    for (int k = 0; k < p.width * p.height; k++) {
        assert_near((double)picture_channel(map, "FLIP")[k],
                    (double)judge_flip(&p, &q, ppd, k % p.width, k / p.width), ROUNDING);
    }
    assay_image_destroy(map);
    free((void *)p.pixels);
    free((void *)q.pixels);
}

static void all_pixels_by_the_definition(void **state)
{
    assay_image *a = picture_random(*state, 23, 17, 1.0, 2);
    assay_image *b = picture_random(*state, 23, 17, 0.9, 3);
    check_all(a, b, 0.0, 9.5);
    check_all(a, b, -1.0, 31.25);
    assay_image_destroy(a);
    assay_image_destroy(b);
    a = picture_primaries(*state, 23, 17, 2);
    b = picture_primaries(*state, 23, 17, 3);
    check_all(a, b, 0.0, 20.0);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* Pixels beside the borders of tiles, at the default distance. */
static void tiles_do_not_show(void **state)
{
    enum { WIDTH = 270, HEIGHT = 140 };
    static const int            AT[][2] = {{127, 10}, {128, 127}, {257, 128}, {0, 128}, {269, 139}};
    const assay_metrics_options options = assay_metrics_defaults();
    assay_image                *a       = picture_random(*state, WIDTH, HEIGHT, 1.0, 4);
    assay_image                *b       = picture_random(*state, WIDTH, HEIGHT, 1.0, 5);
    const judge_picture         p = judged(a, 1.0), q = judged(b, 1.0);
    assay_flip_summary          s;
    assay_image                *map = flip(a, b, ASSAY_FLIP_LDR, &options, &s);
    for (size_t i = 0; i < sizeof AT / sizeof AT[0]; i++) {
        const int x = AT[i][0], y = AT[i][1];
        assert_near((double)picture_channel(map, "FLIP")[y * WIDTH + x],
                    (double)judge_flip(&p, &q, options.pixels_per_degree, x, y), ROUNDING);
    }
    free((void *)p.pixels);
    free((void *)q.pixels);
    assay_image_destroy(map);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void which_comes_first_does_not_count(void **state)
{
    const assay_metrics_options options = assay_metrics_defaults();
    assay_image                *a       = picture_random(*state, 50, 41, 1.0, 6);
    assay_image                *b       = picture_random(*state, 50, 41, 1.0, 7);
    assay_flip_summary          s, t;
    assay_image                *ab = flip(a, b, ASSAY_FLIP_LDR, &options, &s);
    assay_image                *ba = flip(b, a, ASSAY_FLIP_LDR, &options, &t);
    assert_memory_equal(picture_channel(ab, "FLIP"), picture_channel(ba, "FLIP"),
                        50 * 41 * sizeof(float));
    assert_same(&s, &t);
    assay_image_destroy(ab);
    assay_image_destroy(ba);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static int ascending(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Mean, extremes and weighted quartiles of the map, by sorting and adding. */
static void summaries_are_of_the_map(void **state)
{
    enum { COUNT = 61 * 43 };
    const assay_metrics_options options = assay_metrics_defaults();
    assay_image                *a       = picture_random(*state, 61, 43, 1.0, 8);
    assay_image                *b       = picture_random(*state, 61, 43, 1.0, 9);
    assay_flip_summary          s;
    assay_image                *map = flip(a, b, ASSAY_FLIP_LDR, &options, &s);
    float                       sorted[COUNT];
    double                      total = 0.0, sum = 0.0, quartiles[3] = {0.0, 0.0, 0.0};
    memcpy(sorted, picture_channel(map, "FLIP"), sizeof sorted);
    assert_true(sorted[s.max_y * 61 + s.max_x] == (float)s.maximum);
    qsort(sorted, COUNT, sizeof sorted[0], ascending);
    for (int i = 0; i < COUNT; i++) {
        total += (double)sorted[i];
    }
    for (int i = 0; i < COUNT; i++) {
        sum += (double)sorted[i];
        for (int q = 0; q < 3; q++) {
            quartiles[q] = quartiles[q] == 0.0 && sum > 0.25 * (q + 1) * total ? (double)sorted[i]
                                                                               : quartiles[q];
        }
    }
    assert_near(s.mean, total / COUNT, 1e-15);
    assert_near(s.first_quartile, quartiles[0], 0.0);
    assert_near(s.weighted_median, quartiles[1], 0.0);
    assert_near(s.third_quartile, quartiles[2], 0.0);
    assert_near(s.minimum, (double)sorted[0], 0.0);
    assert_near(s.maximum, (double)sorted[COUNT - 1], 0.0);
    assert_true(s.start_exposure == 0.0 && s.stop_exposure == 0.0 && s.exposures == 1);
    assay_image_destroy(map);
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* ---- HDR ---- */

/* The brightest of 36 pixels is 64, the two in the middle are 3/16 and 5/16; negative light is
 * black. The curve makes 0.85 of the brightest at the start, and of the median at the stop. */
static void exposures_from_the_reference(void **state)
{
    assay_image          *a       = picture_constant(*state, 12, 3, 4.0, 4.0, 4.0);
    assay_metrics_options options = assay_metrics_defaults();
    for (int c = 0; c < 3; c++) {
        float *values = picture_channel(a, c == 0 ? "R" : c == 1 ? "G" : "B");
        for (int i = 0; i < 17; i++) {
            values[i] = 0.125F;
        }
        values[0]  = -3.0F;
        values[17] = 0.1875F;
        values[18] = 0.3125F;
        values[20] = 64.0F;
    }
    for (int tone = 0; tone < 3; tone++) {
        assay_flip_summary s;
        options.tone_mapper = (assay_tone_mapper)tone;
        assay_image_destroy(flip(a, a, ASSAY_FLIP_HDR, &options, &s));
        const char       *name   = assay_tone_mapper_name(options.tone_mapper);
        const long double bright = 64.0L * exp2l((long double)s.start_exposure);
        const long double middle = 0.25L * exp2l((long double)s.stop_exposure);
        assert_near((double)judge_tone_map(name, (judge_color){{bright, bright, bright}}).v[0],
                    0.85, 1e-7);
        assert_near((double)judge_tone_map(name, (judge_color){{middle, middle, middle}}).v[0],
                    0.85, 1e-7);
        assert_near(s.stop_exposure - s.start_exposure, 8.0, 1e-6);
        assert_true(s.exposures == 8 || s.exposures == 9); /* 8 stops, up to rounding */
    }
    assay_image_destroy(a);
}

/* Where most is black, the median of the rest; a black picture has nothing to expose for. */
static void exposures_of_dark_references(void **state)
{
    const assay_metrics_options options = assay_metrics_defaults();
    assay_flip_summary          s;
    assay_image                *a = picture_constant(*state, 8, 2, 0.0, 0.0, 0.0);
    assay_image_destroy(flip(a, a, ASSAY_FLIP_HDR, &options, &s));
    assert_true(s.start_exposure == 0.0 && s.stop_exposure == 0.0 && s.exposures == 2);
    for (int c = 0; c < 3; c++) {
        float *values = picture_channel(a, c == 0 ? "R" : c == 1 ? "G" : "B");
        values[0] = values[1] = 0.5F;
        values[2]             = 8.0F;
    }
    assay_image_destroy(flip(a, a, ASSAY_FLIP_HDR, &options, &s));
    assert_near(s.stop_exposure - s.start_exposure, 4.0, 1e-6);
    assay_image_destroy(a);
}

/* The tone-mapped picture that a display shows at this exposure. */
static assay_image *shown(assay_context *context, const assay_image *image, const char *mapper,
                          double stops)
{
    const int           width = assay_image_width(image), height = assay_image_height(image);
    const judge_picture p   = judged(image, exp2(stops));
    assay_image        *out = picture_constant(context, width, height, 0.0, 0.0, 0.0);
    for (int i = 0; i < width * height; i++) {
        const judge_color c          = judge_tone_map(mapper, p.pixels[i]);
        picture_channel(out, "R")[i] = (float)c.v[0];
        picture_channel(out, "G")[i] = (float)c.v[1];
        picture_channel(out, "B")[i] = (float)c.v[2];
    }
    free((void *)p.pixels);
    return out;
}

/* HDR-FLIP is the largest LDR-FLIP of the tone-mapped pictures, whose rounding to float moves an
 * error by some 1e-6 at most where the feature difference, a square root, is small. */
static void the_largest_of_all_exposures(void **state)
{
    enum { WIDTH = 30, HEIGHT = 21, COUNT = WIDTH * HEIGHT };
    assay_image          *a       = picture_random(*state, WIDTH, HEIGHT, 40.0, 10);
    assay_image          *b       = picture_random(*state, WIDTH, HEIGHT, 35.0, 11);
    assay_metrics_options options = assay_metrics_defaults();
    for (int tone = 0; tone < 3; tone++) {
        float              largest[COUNT] = {0.0F}, at[COUNT] = {0.0F};
        assay_flip_summary s, t;
        options.tone_mapper    = (assay_tone_mapper)tone;
        options.start_exposure = -5.5;
        options.stop_exposure  = 1.5;
        options.exposures      = tone == 2 ? 1 : 4;
        assay_image *map       = flip(a, b, ASSAY_FLIP_HDR, &options, &s);
        assert_true(s.start_exposure == -5.5 && s.stop_exposure == 1.5);
        assert_int_equal(s.exposures, options.exposures);
        for (int i = 0; i < s.exposures; i++) {
            const char  *name  = assay_tone_mapper_name(options.tone_mapper);
            const double stops = s.exposures == 1 ? -5.5 : -5.5 + i * 7.0 / 3.0;
            assay_image *p = shown(*state, a, name, stops), *q = shown(*state, b, name, stops);
            assay_image *one = flip(p, q, ASSAY_FLIP_LDR, &options, &t);
            for (int k = 0; k < COUNT; k++) {
                const float error = picture_channel(one, "FLIP")[k];
                at[k]             = error > largest[k] + 1e-5F ? (float)stops : at[k];
                largest[k]        = fmaxf(error, largest[k]);
            }
            assay_image_destroy(one);
            assay_image_destroy(p);
            assay_image_destroy(q);
        }
        int elsewhere = 0;
        for (int k = 0; k < COUNT; k++) {
            assert_near((double)picture_channel(map, "FLIP")[k], (double)largest[k], 2e-6);
            elsewhere += fabsf(picture_channel(map, "Exposure")[k] - at[k]) > 1e-6F;
        }
        assert_true(elsewhere <= 2); /* two exposures within 1e-5 of one another */
        assay_image_destroy(map);
    }
    assay_image_destroy(a);
    assay_image_destroy(b);
}

/* ---- bits, memory, errors ---- */

static void threads_do_not_show(void **state)
{
    (void)state;
    assay_image       *maps[2];
    assay_flip_summary s[2];
    assay_context     *contexts[2];
    for (int i = 0; i < 2; i++) {
        const assay_context_options threads = {.threads = i ? 5 : 1};
        const assay_metrics_options options = assay_metrics_defaults();
        assert_int_equal(assay_context_create(&threads, &contexts[i]), ASSAY_OK);
        assay_image *a = picture_random(contexts[i], 520, 130, 4.0, 12);
        assay_image *b = picture_random(contexts[i], 520, 130, 4.0, 13);
        maps[i]        = flip(a, b, ASSAY_FLIP_HDR, &options, &s[i]);
        assay_image_destroy(a);
        assay_image_destroy(b);
    }
    assert_same(&s[0], &s[1]);
    char digests[2][65];
    for (int i = 0; i < 2; i++) {
        assay_image_digest(maps[i], digests[i]);
        assay_image_destroy(maps[i]);
        assay_context_destroy(contexts[i]);
    }
    assert_string_equal(digests[0], digests[1]);
}

static void expect_error(assay_context *context, const assay_image *a, const assay_image *b,
                         const assay_metrics_options *options, assay_status status,
                         const char *words)
{
    assay_flip_summary s   = {.mean = 77.0};
    assay_image       *map = NULL;
    assert_int_equal(assay_image_flip(a, b, ASSAY_FLIP_HDR, options, &s, &map), status);
    assert_null(map);
    assert_true(s.mean == 77.0);
    if (!strstr(assay_context_error(context), words)) {
        fail_msg("\"%s\" lacks \"%s\"", assay_context_error(context), words);
    }
}

static void bad_pictures(void **state)
{
    const assay_metrics_options o     = assay_metrics_defaults();
    assay_metrics_options       layer = o;
    assay_image                *a     = picture_constant(*state, 4, 3, 1.0, 1.0, 1.0);
    assay_image                *b     = picture_constant(*state, 3, 4, 1.0, 1.0, 1.0);
    expect_error(*state, a, b, &o, ASSAY_ERR_ARGUMENT, "4 x 3 and 3 x 4");
    assay_image_destroy(b);
    b           = picture_constant(*state, 4, 3, 1.0, 1.0, 1.0);
    layer.layer = "Indirect";
    expect_error(*state, a, b, &layer, ASSAY_ERR_ARGUMENT,
                 "the reference's channel \"Indirect.R\" is missing");
    assert_int_equal(assay_image_add_channel(a, "Indirect.R", ASSAY_CHANNEL_UINT, NULL), ASSAY_OK);
    expect_error(*state, a, b, &layer, ASSAY_ERR_ARGUMENT, "whole numbers");
    picture_channel(b, "G")[7] = NAN;
    expect_error(*state, a, b, &o, ASSAY_ERR_DOMAIN,
                 "the candidate's channel \"G\" is NaN at pixel (3, 1)");
    picture_channel(a, "B")[2] = -INFINITY;
    expect_error(*state, a, b, &o, ASSAY_ERR_DOMAIN,
                 "the reference's channel \"B\" is infinite at pixel (2, 0)");
    assay_image_destroy(a);
    assay_image_destroy(b);
}

static void bad_options(void **state)
{
    const assay_metrics_options good = assay_metrics_defaults();
    assay_metrics_options       o    = good;
    assay_image                *a    = picture_constant(*state, 4, 3, 1.0, 1.0, 1.0);
    o.pixels_per_degree              = 0.5;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "pixels per degree");
    o.pixels_per_degree = NAN;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "pixels per degree");
    o             = good;
    o.tone_mapper = (assay_tone_mapper)3;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "tone mapper");
    o           = good;
    o.exposures = -1;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "exposures");
    o          = good;
    o.exposure = NAN;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "exposure");
    o                = good;
    o.start_exposure = 101.0;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "exposure");
    o.start_exposure = 2.0;
    o.stop_exposure  = 1.0;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "start at 2 stops");
    o       = good;
    o.layer = NULL;
    expect_error(*state, a, a, &o, ASSAY_ERR_ARGUMENT, "layer");
    assay_image_destroy(a);
}

static assay_status flip_once(assay_context *context, void *user)
{
    const assay_metrics_options options = assay_metrics_defaults();
    assay_flip_summary          s;
    assay_image                *a = NULL, *map = NULL;
    (void)user;
    assay_status status = assay_image_create(context, 5, 4, &a);
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        status = assay_image_add_channel(a,
                                         c == 0   ? "R"
                                         : c == 1 ? "G"
                                                  : "B",
                                         ASSAY_CHANNEL_FLOAT, NULL);
    }
    if (status == ASSAY_OK) {
        status = assay_image_flip(a, a, ASSAY_FLIP_HDR, &options, &s, &map);
    }
    assay_image_destroy(a);
    assay_image_destroy(map);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_true(failing_each(flip_once, NULL) > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(nothing_is_seen_between_equal_pictures, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(two_colors, counted_set_up, counted_tear_down),
        cmocka_unit_test(the_scale_ends_at_one),
        cmocka_unit_test_setup_teardown(all_pixels_by_the_definition, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(tiles_do_not_show, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(which_comes_first_does_not_count, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(summaries_are_of_the_map, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(exposures_from_the_reference, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(exposures_of_dark_references, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(the_largest_of_all_exposures, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test(threads_do_not_show),
        cmocka_unit_test_setup_teardown(bad_pictures, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(bad_options, counted_set_up, counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
