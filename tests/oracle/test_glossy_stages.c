/* test_glossy_stages.c - records of radiance on glossy pixels: what candidates of few digits make
 * of them lies within the bounds of stages `splat-glossy` and `splat-glossy-light`; what is wrong
 * lies far beyond. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "oracle/stage/lobe_bound.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/radiance_candidate.h"
#include "support/random_places.h"

static const int DIGITS[] = {11, 24, 53};

/* ---- splatting ---- */

/* Coefficients of f cos, in the frame of the BRDF. */
static void few_brdf(radiance_candidate *c, size_t i, double row[ROW])
{
    const few_digits *f    = &c->f;
    const double     *wo   = c->d->brdf + 15 * i + 9;
    const double      down = few(f, 1.0 + few(f, wo[2]));
    double            share[2];
    size_t            first[2];
    for (int k = 0; k < 2; k++) {
        const double u = few(f, 0.5 + few(f, 0.5 * few(f, few(f, wo[k]) / down)));
        const double t = fmin(fmax(few(f, few(f, u * GRID) - 0.5), 0.0), GRID - 1.0);
        first[k]       = t < GRID - 1.0 ? (size_t)t : GRID - 2;
        share[k]       = few(f, t - (double)first[k]);
    }
    for (size_t n = 0; n < ROW; n++) {
        const double base =
            c->defect == NO_BASE ? 1.0 : few(f, c->d->brdf[15 * i + 12 + n / COUNT]);
        double looked[2];
        for (size_t k = 0; k < 2; k++) {
            const size_t lobe = (size_t)c->d->lobe[LOBES * i + (k ? 1 + n / COUNT : 0)];
            double       terms[4];
            for (size_t j = 0; j < 4; j++) {
                const size_t x = first[0] + j % 2, y = first[1] + j / 2;
                const size_t at = c->defect == TRANSPOSED ? x * GRID + y : y * GRID + x;
                const double w  = few(f, (j % 2 ? share[0] : few(f, 1.0 - share[0])) *
                                             (j / 2 ? share[1] : few(f, 1.0 - share[1])));
                terms[j] =
                    few(f, w * few(f, c->d->grids[(lobe * TEXELS + at) * COUNT + n % COUNT]));
            }
            looked[k] = few_sum(&c->f, 4, terms);
        }
        row[n] = few(f, looked[1] + few(f, base * looked[0]));
    }
}

/* Lookups by themselves. */
static void test_lobes(void **state)
{
    enum { PAIRS = ORDER * (ORDER + 1) / 2 };
    const assay_radiance_turn_settings exact = {.way = ASSAY_HSH_EXACT};
    radiance_data                     *d     = radiance_data_make();
    turn_bound                        *bound = NULL;
    lobe_grids                         grids = {0};
    radiance_candidate                 c;
    radiance_candidate_open(&c, *state, d);
    assert_int_equal(turn_bound_create(*state, c.hsh, NULL, &exact, &bound), ASSAY_OK);
    assert_int_equal(lobe_grids_open(*state, GRID, COUNT, LOBES, d->grids, &grids), ASSAY_OK);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        const rounding r   = stage_rounding_of((assay_precision)p);
        bound_use      use = {0};
        radiance_candidate_choose(&c, p, RIGHT, BY_SINES, false);
        for (size_t i = 0; i < POINTS; i++) {
            const double    *b = d->brdf + 15 * i, *n = d->lobe + LOBES * i;
            const lobe_pixel pixel = {.slope      = (size_t)n[0],
                                      .black      = {(size_t)n[1], (size_t)n[2], (size_t)n[3]},
                                      .wo         = vec3(b[9], b[10], b[11]),
                                      .base_color = rgb(b[12], b[13], b[14])};
            double           ours[ROW], theirs[ROW], scratch[COUNT], away[PAIRS];
            double           sizes[3 * PAIRS], errors[3 * PAIRS];
            few_brdf(&c, i, theirs);
            assert_int_equal(lobe_look_up(&grids, &pixel, scratch, ours), ASSAY_OK);
            lobe_bound(&grids, bound, &r, &pixel, sizes, errors);
            for (size_t k = 0; k < ROW; k++) {
                ours[k] -= theirs[k];
            }
            for (size_t k = 0; k < (size_t)3 * PAIRS; k++) {
                turn_bound_sizes(bound, ours + k / PAIRS * COUNT, away);
                bound_use_add(&use, away[k % PAIRS], 0.0, errors[k]);
            }
        }
        print_message("lobes, %d digits: %.3f of the bound\n", DIGITS[p], use.most);
        assert_int_equal(use.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || use.most > 0.1);
    }
    lobe_grids_close(&grids);
    turn_bound_destroy(bound);
    radiance_candidate_close(&c);
    free(d);
}

/* The light comes to the BRDF, or the BRDF to the light. */
static void few_reflected(radiance_candidate *c, size_t i, bool light_turns, double out[3])
{
    static double said[RECORDS][ROW];
    double        weights[RECORDS], brdf[ROW], here[9], frame[9], reflected[3][RECORDS];
    const double *n     = c->d->brdf + 15 * i + 6;
    const size_t  count = few_terms(c, c->d->at + 3 * i, n, weights, said);
    few_brdf(c, i, brdf);
    few_frame(&c->f, n, here);
    for (size_t k = 0; k < 9; k++) {
        frame[k] = few(&c->f, c->d->brdf[15 * i + k]);
    }
    c->threshold += 1.0; /* one z */
    if (!light_turns && c->defect != OTHER_FRAME) {
        few_turn(c, frame, here, brdf);
    }
    for (size_t k = 0; k < count; k++) {
        if (light_turns && c->defect != OTHER_FRAME) {
            few_turn(c, here, frame, said[k]);
        }
        for (size_t j = 0; j < 3; j++) {
            const size_t light = c->defect == SWAPPED ? 2 - j : j;
            reflected[j][k]    = few_dot(&c->f, COUNT, said[k] + light * COUNT, brdf + j * COUNT);
        }
    }
    c->threshold -= 1.0;
    for (size_t j = 0; j < 3; j++) {
        out[j] =
            few(&c->f, few(&c->f, c->d->weight[i]) * few_mean(c, count, weights, reflected[j]));
    }
}

static void add_pixels(const stage_case *s, const radiance_data *d, const double *ends)
{
    stage_case_text(s, "assay:method", "splat");
    stage_case_table(s, "splat_glossy/position", "m", POINTS, 3, d->at);
    stage_case_table(s, "splat_glossy/batch_end", "records", 3, 1, ends);
    stage_case_table(s, "splat_glossy/frame", "", POINTS, 9, d->frame);
    stage_case_table(s, "splat_glossy/brdf", "", POINTS, 15, d->brdf);
    stage_case_table(s, "splat_glossy/lobe", "", POINTS, LOBES, d->lobe);
    stage_case_table(s, "splat_glossy/lobe_grid", "1/sr", (size_t)LOBES * TEXELS, COUNT, d->grids);
    stage_case_table(s, "splat_glossy/batch.2/weight", "", POINTS, 1, d->weight);
}

static bound_use use_light(const radiance_data *d, radiance_candidate *c, assay_precision precision,
                           double last)
{
    const double ends[] = {0.0, 10.0, last};
    stage_case   s      = stage_case_begin(c->context);
    bound_use    use    = {0};
    radiance_data_add(&s, d);
    add_pixels(&s, d, ends);
    stage_case_run(&s, "splat-glossy-light", precision);
    const stage_output *sum = stage_case_output(&s, "splat_glossy/batch.2/radiance");
    for (size_t i = 0; i < POINTS; i++) {
        double out[3];
        few_reflected(c, i, i % 3 == 0, out);
        for (size_t k = 0; k < 3; k++) {
            bound_use_add(&use, out[k], sum->values[3 * i + k], sum->bounds[3 * i + k]);
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_splat_glossy_light(void **state)
{
    radiance_data     *d = radiance_data_make();
    radiance_candidate c;
    radiance_candidate_open(&c, *state, d);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        double most = 0.0;
        for (int way = 0; way < WAYS; way++) {
            radiance_candidate_choose(&c, p, RIGHT, (turning)way, way % 2);
            const bound_use right = use_light(d, &c, (assay_precision)p, RECORDS);
            assert_int_equal(right.beyond, 0);
            most = fmax(most, right.most);
        }
        print_message("splat-glossy-light, %d digits: %.3f of the bound\n", DIGITS[p], most);
        assert_true(p == ASSAY_PRECISION_DOUBLE || most > 0.01);
    }
    static const defect wrong[] = {FLIPPED, NOT_LOCAL, NOT_TURNED, INVERSE,    OTHER_FRAME,
                                   SWAPPED, LOST,      LARGER_R,   TRANSPOSED, NO_BASE};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, wrong[i], BY_SINES, false);
        const bound_use bad = use_light(d, &c, ASSAY_PRECISION_FLOAT, RECORDS);
        print_message("  defect %d: %.3g times the bound, %zu values\n", wrong[i], bad.most,
                      bad.beyond);
        assert_true(bad.most > 50.0);
    }
    /* Records beyond the last batch are not heard, and no bound is wider for them. */
    radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, RIGHT, BY_SINES, false);
    assert_true(use_light(d, &c, ASSAY_PRECISION_FLOAT, RECORDS - 20).most > 50.0);
    radiance_candidate_close(&c);
    free(d);
}

/* Weights up to record 45, a batch later up to 70. */
static bound_use use_sums(const radiance_data *d, radiance_candidate *c, assay_precision precision,
                          const char *variant)
{
    const double ends[] = {20.0, 45.0, 70.0};
    const size_t last   = c->defect == LOST ? 69 : 70;
    stage_case   s      = stage_case_begin(c->context);
    bound_use    use    = {0};
    radiance_data_add(&s, d);
    add_pixels(&s, d, ends);
    stage_case_text(&s, "variant", variant);
    stage_case_run(&s, "splat-glossy", precision);
    assert_int_equal(s.run.out_count, 3);
    for (size_t i = 0; i < POINTS; i++) {
        double       terms[2 * RECORDS];
        size_t       count     = 0;
        const double before[3] = {0.0, 20.0, 45.0};
        for (size_t b = 0; b < 3; b++) {
            char name[64];
            snprintf(name, sizeof name, "splat_glossy/batch.%zu/weight", b);
            const stage_output *sum = stage_case_output(&s, name);
            for (size_t k = (size_t)before[b]; k < (b == 2 ? last : (size_t)ends[b]); k++) {
                terms[count++] = few_weight(c, d->at + 3 * i, d->frame + 9 * i + 6, k);
            }
            for (size_t k = 0; b == 2 && *variant == 'p' && k < 20; k++) {
                terms[count++] = few_weight(c, d->at + 3 * i, d->frame + 9 * i + 6, k);
            }
            bound_use_add(&use, few_sum(&c->f, count, terms), sum->values[i], sum->bounds[i]);
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_splat_glossy(void **state)
{
    radiance_data     *d = radiance_data_make();
    radiance_candidate c;
    radiance_candidate_open(&c, *state, d);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        radiance_candidate_choose(&c, p, RIGHT, BY_SINES, false);
        const bound_use right     = use_sums(d, &c, (assay_precision)p, "corrected");
        const bound_use published = use_sums(d, &c, (assay_precision)p, "published");
        print_message("splat-glossy, %d digits: %.3f of the bound\n", DIGITS[p], right.most);
        assert_int_equal(right.beyond + published.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || right.most > 0.03);
    }
    static const defect wrong[] = {LARGER_R, LOST};
    for (size_t i = 0; i < 2; i++) {
        radiance_candidate_choose(&c, ASSAY_PRECISION_FLOAT, wrong[i], BY_SINES, false);
        const bound_use bad = use_sums(d, &c, ASSAY_PRECISION_FLOAT, "corrected");
        print_message("  defect %d: %.3g times the bound\n", wrong[i], bad.most);
        assert_true(bad.most > 50.0);
    }
    radiance_candidate_close(&c);
    free(d);
}

/* Arrays that a stage makes of records that shrink, when the last batch ends at `last`. */
static int made_of_shrinking(assay_context *context, const radiance_data *d, const char *stage,
                             double last)
{
    const double ends[] = {0.0, 10.0, last};
    stage_case   s      = stage_case_begin(context);
    radiance_data_add(&s, d);
    add_pixels(&s, d, ends);
    stage_case_text(&s, "neighbour_clamp", "on");
    stage_case_run(&s, stage, ASSAY_PRECISION_FLOAT);
    const int made = s.run.out_count;
    stage_case_end(&s);
    return made;
}

/* Records beyond the last end have shrunk the others since. */
static void test_later_sweeps(void **state)
{
    static const char *const stages[] = {"splat-glossy", "splat-glossy-light"};
    radiance_data           *d        = radiance_data_make();
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(made_of_shrinking(*state, d, stages[i], RECORDS), 1);
        assert_int_equal(made_of_shrinking(*state, d, stages[i], RECORDS - 1), 0);
    }
    free(d);
}

/* Nearer to unit length than is refused, farther than a grid takes. */
static void test_nearly_unit(void **state)
{
    const double   ends[] = {0.0, 10.0, RECORDS};
    radiance_data *d      = radiance_data_make();
    stage_case     s      = stage_case_begin(*state);
    for (size_t k = 9; k < 12; k++) {
        d->brdf[k] *= 1.0 + 9e-7;
    }
    radiance_data_add(&s, d);
    add_pixels(&s, d, ends);
    stage_case_run(&s, "splat-glossy-light", ASSAY_PRECISION_FLOAT);
    assert_int_equal(s.run.out_count, 1);
    stage_case_end(&s);
    free(d);
}

/* ---- without memory ---- */

typedef struct {
    const char *path, *stage;
} small_run;

static assay_status run_once(assay_context *context, void *user)
{
    const small_run      *run       = user;
    const assay_precision precision = ASSAY_PRECISION_FLOAT;
    assay_bundle_reader  *reader    = NULL;
    stage_run             made;
    assay_status          status = assay_bundle_open(context, run->path, &reader);
    if (status == ASSAY_OK) {
        status = stage_run_start(&made, context, assay_stage_find(run->stage), reader, NULL,
                                 &precision, 0, NULL);
        stage_run_release(&made);
    }
    assay_bundle_close(reader);
    return status;
}

/* A dozen records and a few pixels: every block that is refused is named, and nothing is left. */
static void test_no_memory(void **state)
{
    enum { FEW = 12, SPOTS = 4, SIDE_OF_GRID = 2 };
    radiance_data *d = radiance_data_make();
    stage_case     s = stage_case_begin(*state);
    stage_case_text(&s, "a", "0.6");
    stage_case_text(&s, "order", "4");
    stage_case_text(&s, "rotation_steps", "2");
    stage_case_text(&s, "grid", "2");
    stage_case_table(&s, "radiance_records/position", "m", FEW, 3, d->position);
    stage_case_table(&s, "radiance_records/normal", "", FEW, 3, d->normal);
    stage_case_table(&s, "radiance_records/radius", "m", FEW, 1, d->radius);
    stage_case_table(&s, "radiance_records/coefficients", "W/(m2 sr)", FEW, ROW, d->coefficients);
    stage_case_table(&s, "radiance_records/coefficient_gradient", "W/(m3 sr)", FEW, (size_t)3 * ROW,
                     d->gradient);
    stage_case_table(&s, "radiance_query/position", "m", SPOTS, 3, d->at);
    stage_case_table(&s, "radiance_query/frame", "", SPOTS, 9, d->frame);
    stage_case_table(&s, "splat_glossy/position", "m", SPOTS, 3, d->at);
    stage_case_table(&s, "splat_glossy/frame", "", SPOTS, 9, d->frame);
    stage_case_table(&s, "splat_glossy/brdf", "", SPOTS, 15, d->brdf);
    stage_case_table(&s, "splat_glossy/lobe", "", SPOTS, LOBES, d->lobe);
    stage_case_table(&s, "splat_glossy/lobe_grid", "1/sr",
                     (size_t)LOBES * SIDE_OF_GRID * SIDE_OF_GRID, COUNT, d->grids);
    stage_case_table(&s, "splat_glossy/batch.0/weight", "", SPOTS, 1, d->weight);
    stage_case_finish(&s);
    static const char *const stages[] = {"interpolate-radiance", "splat-glossy",
                                         "splat-glossy-light"};
    for (size_t i = 0; i < sizeof stages / sizeof stages[0]; i++) {
        small_run run      = {s.path, stages[i]};
        const int refusals = failing_each(run_once, &run);
        print_message("%s: %d refusals\n", stages[i], refusals);
        assert_true(refusals > 40);
    }
    stage_case_end(&s);
    free(d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_lobes, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_splat_glossy_light, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_splat_glossy, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_later_sweeps, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_nearly_unit, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_no_memory, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
