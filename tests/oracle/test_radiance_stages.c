/* test_radiance_stages.c - what records of radiance say, splatted or asked: what candidates of few
 * digits make lies within the bounds; what is wrong lies far beyond.
 *
 * The candidates are written here, from [gautron06] 2.2.6, 3.4 and 4.1, in rounded operations and
 * orders of chance; of the library they have the matrices M_R alone, rounded as a table would be.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "math/frame.h"
#include "oracle/turn_bound.h"
#include "support/measure.h"
#include "support/random_places.h"
#include "support/splat_room.h"
#include "support/stage_case.h"

enum { RECORDS = 90, SIDE = 11, POINTS = SIDE * SIDE, ORDER = 4, COUNT = ORDER * ORDER };
enum { ROW = 3 * COUNT, STEPS = 8, LOBES = 4, GRID = 6, TEXELS = GRID * GRID };

static const double A        = 0.6;
static const int    DIGITS[] = {11, 24, 53};

/* ---- the data ---- */

typedef struct {
    double position[3 * RECORDS], normal[3 * RECORDS], radius[RECORDS];
    double coefficients[ROW * RECORDS], gradient[3 * ROW * RECORDS];
    double at[3 * POINTS], frame[9 * POINTS]; /* queries, and pixels with the frame of the BRDF */
    double brdf[15 * POINTS], lobe[4 * POINTS], weight[POINTS];
    double grids[LOBES * TEXELS * COUNT];
} data;

static void put(double *to, const void *from, size_t count)
{
    memcpy(to, from, count * sizeof *to);
}

/* What tilts there are between records and points at one place: none, and down to what no
 * precision sees. */
static assay_vec3 tilted(assay_vec3 n, size_t i, assay_random *random)
{
    static const double sizes[] = {0.0, 1e-12, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1};
    const assay_vec3    side    = random_unit(random);
    return vec3_normalize(vec3_mad(n, sizes[i % (sizeof sizes / sizeof sizes[0])], side));
}

static void make_records(data *d, assay_random *random)
{
    for (uint32_t k = 0; k < RECORDS; k++) {
        const assay_record r = splat_room_record(3, RECORDS, k);
        put(d->position + 3 * (size_t)k, &r.position, 3);
        put(d->normal + 3 * (size_t)k, &r.normal, 3);
        d->radius[k] = 0.4 * r.radius;
    }
    for (size_t i = 0; i < (size_t)ROW * RECORDS; i++) {
        d->coefficients[i] = random_in(random, -1.0, 2.0);
    }
    for (size_t i = 0; i < (size_t)3 * ROW * RECORDS; i++) {
        d->gradient[i] = random_in(random, -1.0, 1.0);
    }
}

/* Smooth, as lobes are. */
static void make_grids(data *d)
{
    for (size_t i = 0; i < (size_t)LOBES * TEXELS * COUNT; i++) {
        const size_t texel = i / COUNT % TEXELS, lobe = i / COUNT / TEXELS;
        const double x = (double)(texel % GRID) / GRID, y = (double)texel / TEXELS;
        d->grids[i] = assay_cos((double)(i % COUNT) + 2.0 * x - 1.3 * y + (double)lobe);
    }
}

/* Every other point is at a record's very place. */
static data *make_data(void)
{
    data              *d      = calloc(1, sizeof *d);
    const assay_camera camera = splat_room_camera(false);
    assay_random       random = assay_random_start(21, ASSAY_STAGE_TEST, 3, 0);
    assert_non_null(d);
    make_records(d, &random);
    make_grids(d);
    for (size_t i = 0; i < POINTS; i++) {
        assay_vec3 p = vec3(0.5, 0.25, 0.0), n = vec3(0.0, 0.0, 1.0);
        splat_room_point(&camera, SIDE, SIDE, i, &p, &n);
        if (i % 2 == 0) {
            const size_t k = i % RECORDS;
            memcpy(&p, d->position + 3 * k, sizeof p);
            memcpy(&n, d->normal + 3 * k, sizeof n);
            p.x += i % 4 == 0 ? 0.0 : 0.02 * d->radius[k];
            n = tilted(n, i / 2, &random);
        }
        const assay_frame3 frame = frame3_from_zx(n, random_unit(&random));
        assay_vec3         wo    = random_unit(&random);
        wo.z                     = fabs(wo.z);
        put(d->at + 3 * i, &p, 3);
        put(d->frame + 9 * i, &frame, 9);
        put(d->brdf + 15 * i, &frame, 9);
        put(d->brdf + 15 * i + 9, &wo, 3);
        for (size_t c = 0; c < 3; c++) {
            d->brdf[15 * i + 12 + c] = random_in(&random, 0.0, 1.0);
        }
        for (size_t c = 0; c < LOBES; c++) {
            d->lobe[LOBES * i + c] = (double)((c + i) % LOBES);
        }
        d->weight[i] = random_in(&random, 0.6, 40.0);
    }
    return d;
}

static void add_records(const stage_case *c, const data *d)
{
    stage_case_text(c, "a", "0.6");
    stage_case_text(c, "order", "4");
    stage_case_text(c, "rotation_steps", "8");
    stage_case_text(c, "grid", "6");
    stage_case_table(c, "radiance_records/position", "m", RECORDS, 3, d->position);
    stage_case_table(c, "radiance_records/normal", "", RECORDS, 3, d->normal);
    stage_case_table(c, "radiance_records/radius", "m", RECORDS, 1, d->radius);
    stage_case_table(c, "radiance_records/coefficients", "W/(m2 sr)", RECORDS, ROW,
                     d->coefficients);
    stage_case_table(c, "radiance_records/coefficient_gradient", "W/(m3 sr)", RECORDS,
                     (size_t)3 * ROW, d->gradient);
}

/* ---- a candidate ---- */

typedef enum {
    RIGHT,
    FLIPPED,    /* the gradient's sign                         */
    NOT_LOCAL,  /* gradients dotted with the offset in the world */
    NOT_TURNED, /* coefficients stay in the record's frame     */
    INVERSE,    /* turned the other way                        */
    OTHER_FRAME,/* in frame3_from_z of the normal              */
    SWAPPED,    /* R and B                                     */
    MIRRORED,   /* m for -m                                    */
    LOST,       /* the last record                             */
    LARGER_R,   /* radii by 1 percent                          */
    TRANSPOSED, /* a grid's rows for columns                   */
    NO_BASE     /* base colour 1                               */
} defect;

/* How it turns. */
typedef enum { BY_SINES, BY_ANGLES, BY_ONE_MATRIX, WAYS } turning;

typedef struct {
    few_digits    f;
    const data   *d;
    defect        defect;
    turning       way;
    bool          exact;     /* one matrix a tilt and no table                         */
    double        threshold; /* of the tilt's sine, below which there is none          */
    double        nodes[STEPS + 1];
    double      (*table)[COUNT * COUNT];
    assay_basis  *hsh;
    assay_context *context;
} candidate;

static void open_candidate(candidate *c, assay_context *context, const data *d)
{
    const double most = 2.0 * assay_asin(A * sqrt(0.5));
    *c                = (candidate){.d = d, .context = context};
    c->table          = malloc((STEPS + 1) * sizeof *c->table);
    assert_non_null(c->table);
    assert_int_equal(
        assay_basis_create(context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &c->hsh),
        ASSAY_OK);
    for (int k = 0; k <= STEPS; k++) {
        c->nodes[k] = (double)k * k / (STEPS * STEPS) * most;
        assert_int_equal(
            assay_hsh_rotation_y(c->hsh, context, NULL, c->nodes[k], c->table[k]), ASSAY_OK);
    }
}

static void close_candidate(candidate *c)
{
    assay_basis_destroy(c->hsh);
    free(c->table);
}

/* [duff17], listing 3. */
static void few_frame(const few_digits *f, const double *normal, double frame[9])
{
    const double x = few(f, normal[0]), y = few(f, normal[1]), z = few(f, normal[2]);
    const double s = copysign(1.0, z);
    const double a = few(f, -1.0 / few(f, s + z)), b = few(f, few(f, x * y) * a);
    const double rows[9] = {few(f, 1.0 + few(f, few(f, s * x * x) * a)), s * b, -s * x,
                            b, few(f, s + few(f, few(f, y * y) * a)), -y, x, y, z};
    memcpy(frame, rows, sizeof rows);
}

static void few_spin(const few_digits *f, double cosine, double sine, double *row)
{
    double cm = 1.0, sm = 0.0;
    for (int m = 1; m < ORDER; m++) {
        const double next = few(f, few(f, cm * cosine) - few(f, sm * sine));
        sm                = few(f, few(f, cm * sine) + few(f, sm * cosine));
        cm                = next;
        for (int i = 0; i < ROW; i += COUNT) {
            for (int l = m; l < ORDER; l++) {
                const int    plus = i + l * l + l + m, minus = plus - 2 * m;
                const double a = row[plus], b = row[minus];
                row[plus]      = few(f, few(f, cm * a) - few(f, sm * b));
                row[minus]     = few(f, few(f, sm * a) + few(f, cm * b));
            }
        }
    }
}

/* M_R(tilt) by linear interpolation between matrices that were rounded once, or itself. */
static void few_matrix(candidate *c, double tilt, double matrix[COUNT * COUNT])
{
    const few_digits *f = &c->f;
    int               k = 0;
    if (c->exact) {
        assert_int_equal(assay_hsh_rotation_y(c->hsh, c->context, NULL, tilt, matrix), ASSAY_OK);
        for (size_t i = 0; i < COUNT * COUNT; i++) {
            matrix[i] = few(f, matrix[i]);
        }
        return;
    }
    while (k + 1 < STEPS && tilt > few(f, c->nodes[k + 1])) {
        k++;
    }
    const double from = few(f, c->nodes[k]), to = few(f, c->nodes[k + 1]);
    const double share = fmin(1.0, few(f, few(f, tilt - from) / few(f, to - from)));
    for (size_t i = 0; i < COUNT * COUNT; i++) {
        const double below = few(f, c->table[k][i]), above = few(f, c->table[k + 1][i]);
        matrix[i] = few(f, few(f, few(f, 1.0 - share) * below) + few(f, share * above));
    }
}

static void few_multiply(candidate *c, const double matrix[COUNT * COUNT], double *row)
{
    double out[COUNT];
    for (int channel = 0; channel < ROW; channel += COUNT) {
        for (size_t i = 0; i < COUNT; i++) {
            out[i] = few_dot(&c->f, COUNT, matrix + i * COUNT, row + channel);
        }
        memcpy(row + channel, out, sizeof out);
    }
}

/* Rz(alpha) M Rz(gamma) in double, rounded: each column is what a unit vector becomes. */
static void one_matrix(candidate *c, const double ca, const double sa, const double cg,
                       const double sg, double tilt, double *row)
{
    const few_digits precise = {.digits = 53};
    double           middle[COUNT * COUNT], whole[COUNT * COUNT];
    few_matrix(c, tilt, middle);
    for (size_t j = 0; j < COUNT; j++) {
        double unit[ROW] = {0.0}, out[ROW] = {0.0};
        unit[j]          = 1.0;
        few_spin(&precise, cg, sg, unit);
        for (size_t i = 0; i < COUNT; i++) {
            for (size_t k = 0; k < COUNT; k++) {
                out[i] += middle[i * COUNT + k] * unit[k];
            }
        }
        few_spin(&precise, ca, sa, out);
        for (size_t i = 0; i < COUNT; i++) {
            whole[i * COUNT + j] = few(&c->f, out[i]);
        }
    }
    few_multiply(c, whole, row);
}

/* Unit vectors of alpha and gamma, and the tilt. */
static void few_angles(candidate *c, const double r[9], double sine, double side, double *unit,
                       double *tilt)
{
    const few_digits *f = &c->f;
    if (c->way == BY_ANGLES) {
        const double alpha = few(f, assay_atan2(r[5], r[2])), gamma = few(f, assay_atan2(r[7], -r[6]));
        const double values[4] = {few(f, assay_cos(alpha)), few(f, assay_sin(alpha)),
                                  few(f, assay_cos(gamma)), few(f, assay_sin(gamma))};
        memcpy(unit, values, sizeof values);
        *tilt = few(f, assay_acos(fmin(1.0, r[8])));
        return;
    }
    const double values[4] = {few(f, r[2] / sine), few(f, r[5] / sine), few(f, -r[6] / side),
                              few(f, r[7] / side)};
    memcpy(unit, values, sizeof values);
    *tilt = few(f, assay_atan2(sine, r[8]));
}

static void few_turn(candidate *c, const double from[9], const double to[9], double *row)
{
    few_digits *f = &c->f;
    double      r[9], unit[4], tilt = 0.0, matrix[COUNT * COUNT];
    for (size_t i = 0; i < 9; i++) {
        r[i] = few_dot(f, 3, to + 3 * (i / 3), from + 3 * (i % 3));
    }
    const double sine = few(f, sqrt(few(f, few(f, r[2] * r[2]) + few(f, r[5] * r[5]))));
    const double side = few(f, sqrt(few(f, few(f, r[6] * r[6]) + few(f, r[7] * r[7]))));
    if (!(sine > c->threshold) || !(side > 0.0)) {
        const double length = few(f, sqrt(few(f, few(f, r[0] * r[0]) + few(f, r[3] * r[3]))));
        few_spin(f, few(f, r[0] / length), few(f, r[3] / length), row);
        return;
    }
    few_angles(c, r, sine, side, unit, &tilt);
    tilt = fmin(tilt, few(f, c->nodes[STEPS]));
    if (c->way == BY_ONE_MATRIX) {
        one_matrix(c, unit[0], unit[1], unit[2], unit[3], tilt, row);
        return;
    }
    few_matrix(c, tilt, matrix);
    few_spin(f, unit[2], unit[3], row);
    few_multiply(c, matrix, row);
    few_spin(f, unit[0], unit[1], row);
}

static double few_weight(candidate *c, const double *p, const double *n, size_t k)
{
    few_digits   *f = &c->f;
    double        offset[3];
    const double *q = c->d->position + 3 * k, *m = c->d->normal + 3 * k;
    for (int i = 0; i < 3; i++) {
        offset[i] = few(f, few(f, p[i]) - few(f, q[i]));
    }
    const double radius = few(f, c->defect == LARGER_R ? 1.01 * c->d->radius[k] : c->d->radius[k]);
    const double moved  = few(f, few(f, sqrt(few_dot(f, 3, offset, offset))) / radius);
    const double one    = few(f, 1.0 - few_dot(f, 3, n, m));
    const double change = few(f, moved + (one > 0.0 ? few(f, sqrt(one)) : 0.0));
    const double weight = change < 1e-12 ? few(f, 1e12) : few(f, 1.0 / change);
    return weight >= few(f, 1.0 / few(f, A)) ? weight : 0.0;
}

/* Coefficients in frame3_from_z of the point's normal. */
static void few_said(candidate *c, const double *p, const double *n, size_t k, double row[ROW])
{
    few_digits   *f = &c->f;
    const double *m = c->d->normal + 3 * k;
    double        there[9], here[9], offset[3], local[3];
    few_frame(f, m, there);
    few_frame(f, n, here);
    for (int i = 0; i < 3; i++) {
        offset[i] = few(f, few(f, p[i]) - few(f, c->d->position[3 * k + (size_t)i]));
        offset[i] = c->defect == FLIPPED ? -offset[i] : offset[i];
    }
    for (int i = 0; i < 3; i++) {
        local[i] = c->defect == NOT_LOCAL ? offset[i] : few_dot(f, 3, there + 3 * i, offset);
    }
    for (size_t i = 0; i < ROW; i++) {
        const double change = few_dot(f, 3, c->d->gradient + 3 * (ROW * k + i), local);
        row[i]              = few(f, few(f, c->d->coefficients[ROW * k + i]) + change);
    }
    if (c->defect != NOT_TURNED && memcmp(m, n, 3 * sizeof *m) != 0) {
        few_turn(c, c->defect == INVERSE ? here : there, c->defect == INVERSE ? there : here, row);
    }
}

/* Weights of the records that count, and what they say. */
static size_t few_terms(candidate *c, const double *p, const double *n, double weights[RECORDS],
                        double (*said)[ROW])
{
    size_t count = 0;
    for (size_t k = 0; k < RECORDS; k++) {
        const double w = few_weight(c, p, n, k);
        if (w > 0.0) {
            few_said(c, p, n, k, said[count]);
            weights[count++] = w;
        }
    }
    return c->defect == LOST && count > 1 ? count - 1 : count;
}

static double few_mean(candidate *c, size_t count, const double *weights, const double *values)
{
    double       terms[RECORDS];
    const double top = few_dot(&c->f, count, weights, values);
    put(terms, weights, count);
    return count ? few(&c->f, top / few_sum(&c->f, count, terms)) : 0.0;
}

static size_t few_ask(candidate *c, size_t i, double out[ROW], double *sum_out)
{
    static double said[RECORDS][ROW];
    double        weights[RECORDS], terms[RECORDS], values[RECORDS], here[9], frame[9];
    const double *n     = c->d->frame + 9 * i + 6;
    const size_t  count = few_terms(c, c->d->at + 3 * i, n, weights, said);
    put(terms, weights, count);
    *sum_out = few_sum(&c->f, count, terms);
    for (size_t k = 0; k < ROW; k++) {
        for (size_t j = 0; j < count; j++) {
            values[j] = said[j][c->defect == SWAPPED ? (k + 2 * COUNT) % ROW : k];
        }
        out[k] = few_mean(c, count, weights, values);
    }
    few_frame(&c->f, n, here);
    for (int k = 0; k < 9; k++) {
        frame[k] = few(&c->f, c->d->frame[9 * i + (size_t)k]);
    }
    if (c->defect != OTHER_FRAME) {
        c->threshold += 1.0; /* one z */
        few_turn(c, here, frame, out);
        c->threshold -= 1.0;
    }
    for (size_t l = 1; l < ORDER && c->defect == MIRRORED; l++) {
        for (size_t k = 0; k < ROW; k += COUNT) {
            const double last        = out[k + l * l + 2 * l];
            out[k + l * l + 2 * l]   = out[k + l * l];
            out[k + l * l]           = last;
        }
    }
    return count;
}

/* A threshold of a candidate's own, from the least to the largest. */
static void choose(candidate *c, int precision, defect planted, turning way, bool high)
{
    const double u = ldexp(1.0, -DIGITS[precision]);
    c->f         = (few_digits){DIGITS[precision], assay_random_start(5, ASSAY_STAGE_TEST, 9, way)};
    c->defect    = planted;
    c->way       = way;
    c->threshold = high ? sqrt(32.0 * u) : 64.0 * (u + 0x1p-53);
}

/* ---- asking ---- */

/* alone: of points where one record counts, so that no weight is in the answer. */
static bound_use use_coefficients(const data *d, candidate *c, assay_precision precision,
                                  bound_use *sums, bound_use *alone)
{
    stage_case s   = stage_case_begin(c->context);
    bound_use  use = {0};
    stage_case_text(&s, "rotation", c->exact ? "exact" : "table");
    add_records(&s, d);
    stage_case_table(&s, "radiance_query/position", "m", POINTS, 3, d->at);
    stage_case_table(&s, "radiance_query/frame", "", POINTS, 9, d->frame);
    stage_case_run(&s, "interpolate-radiance", precision);
    const stage_output *mean = stage_case_output(&s, "radiance_query/coefficients");
    const stage_output *sum  = stage_case_output(&s, "radiance_query/weight_sum");
    assert_int_equal(mean->columns, ROW);
    for (size_t i = 0; i < POINTS; i++) {
        double       out[ROW], weight = 0.0;
        const size_t count = few_ask(c, i, out, &weight);
        bound_use_add(sums, weight, sum->values[i], sum->bounds[i]);
        for (size_t k = 0; k < ROW; k++) {
            bound_use_add(&use, out[k], mean->values[ROW * i + k], mean->bounds[ROW * i + k]);
            if (count == 1) {
                bound_use_add(alone, out[k], mean->values[ROW * i + k], mean->bounds[ROW * i + k]);
            }
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_interpolate_radiance(void **state)
{
    data     *d = make_data();
    candidate c;
    open_candidate(&c, *state, d);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        bound_use alone = {0};
        double    most  = 0.0;
        for (int way = 0; way < 2 * WAYS; way++) {
            bound_use sums = {0};
            choose(&c, p, RIGHT, (turning)(way / 2), way % 2);
            c.exact               = p == ASSAY_PRECISION_FLOAT && way == 1;
            const bound_use right = use_coefficients(d, &c, (assay_precision)p, &sums, &alone);
            assert_int_equal(right.beyond, 0);
            assert_int_equal(sums.beyond, 0);
            most = fmax(most, right.most);
        }
        print_message("interpolate-radiance, %d digits: %.3f of the bound, one record %.3f\n",
                      DIGITS[p], most, alone.most);
        assert_true(p == ASSAY_PRECISION_DOUBLE || (most > 0.03 && alone.most > 0.03));
    }
    static const defect wrong[] = {FLIPPED, NOT_LOCAL, NOT_TURNED, INVERSE, OTHER_FRAME,
                                   SWAPPED, MIRRORED,  LOST,       LARGER_R};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        bound_use sums = {0}, alone = {0};
        choose(&c, ASSAY_PRECISION_FLOAT, wrong[i], BY_SINES, false);
        c.exact             = false;
        const bound_use bad = use_coefficients(d, &c, ASSAY_PRECISION_FLOAT, &sums, &alone);
        print_message("  defect %d: %.3g times the bound, %zu values\n", wrong[i], bad.most,
                      bad.beyond);
        assert_true(bad.most > 50.0);
    }
    close_candidate(&c);
    free(d);
}

/* ---- turns by themselves ---- */

/* As a stage reads what was stored with few digits. */
static assay_vec3 stored(const few_digits *given, assay_vec3 n)
{
    const assay_vec3 rounded = vec3(few(given, n.x), few(given, n.y), few(given, n.z));
    return given->digits == 53 ? n : vec3_normalize(rounded);
}

/* Normals were stored with fewer digits than the candidate computes with, or with as many. */
static bound_use use_turns(candidate *c, const rounding *r, const few_digits *given)
{
    enum { PAIRS = ORDER * (ORDER + 1) / 2 };
    const assay_radiance_turn_settings settings = {
        .way      = c->exact ? ASSAY_HSH_EXACT : ASSAY_HSH_TABLE,
        .steps    = STEPS,
        .tilt_max = c->nodes[STEPS]};
    assay_radiance_turn *turn  = NULL;
    turn_bound          *bound = NULL;
    bound_use            use   = {0};
    assay_random         random = assay_random_start(31, ASSAY_STAGE_TEST, 3, 0);
    assert_int_equal(assay_radiance_turn_create(c->context, c->hsh, &settings, 1, &turn), ASSAY_OK);
    assert_int_equal(turn_bound_create(c->context, c->hsh, turn, &settings, &bound), ASSAY_OK);
    for (size_t i = 0; i < 400; i++) {
        const assay_vec3 a = random_unit(&random), b = tilted(a, i, &random);
        const assay_vec3 n = stored(given, a), m = stored(given, b);
        const assay_frame3  from = frame3_from_z(n), to = frame3_from_z(m);
        const tracked_frame near = tracked_frame_from_z(r, n), far = tracked_frame_from_z(r, m);
        double there[9], here[9], ours[ROW], theirs[ROW], scratch[2 * (PAIRS + PAIRS * PAIRS)];
        double before[3 * PAIRS], after[3 * PAIRS], errors[3 * PAIRS] = {0.0}, away[3 * PAIRS];
        for (size_t k = 0; k < ROW; k++) {
            ours[k]   = few(&c->f, random_in(&random, -1.0, 1.0));
            theirs[k] = ours[k];
        }
        for (size_t k = 0; k < 3; k++) {
            turn_bound_sizes(bound, ours + k * COUNT, before + k * PAIRS);
        }
        few_frame(&c->f, &a.x, there);
        few_frame(&c->f, &b.x, here);
        few_turn(c, there, here, theirs);
        assert_int_equal(assay_radiance_turn_apply(turn, 0, &from, &to, ours), ASSAY_OK);
        for (size_t k = 0; k < 3; k++) {
            turn_bound_sizes(bound, ours + k * COUNT, after + k * PAIRS);
        }
        assert_int_equal(
            turn_bound_turn(bound, r, &near, &far, false, before, after, errors, scratch),
            ASSAY_OK);
        for (size_t k = 0; k < ROW; k++) {
            theirs[k] -= ours[k];
        }
        for (size_t k = 0; k < 3; k++) {
            turn_bound_sizes(bound, theirs + k * COUNT, away + k * PAIRS);
        }
        for (size_t k = 0; k < (size_t)3 * PAIRS; k++) {
            bound_use_add(&use, away[k], 0.0, errors[k]);
        }
    }
    turn_bound_destroy(bound);
    assay_radiance_turn_destroy(turn);
    return use;
}

static void test_turns(void **state)
{
    candidate c;
    open_candidate(&c, *state, NULL);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        for (int stored = 0; stored <= p; stored++) {
            bound_use most = {0};
            for (int way = 0; way < 4 * WAYS; way++) {
                choose(&c, p, RIGHT, (turning)(way / 4), way % 2);
                c.exact                = way % 4 > 1;
                const few_digits given = {.digits = DIGITS[stored]};
                rounding         r     = stage_rounding_of((assay_precision)p);
                r.given = fmax(r.given, (stored < p ? 2.0 : 1.0) * ldexp(1.0, -DIGITS[stored]));
                const bound_use use    = use_turns(&c, &r, &given);
                most.most              = fmax(most.most, use.most);
                most.beyond += use.beyond;
            }
            print_message("turns, %d digits of %d given: %.3f of the bound\n", DIGITS[p],
                          DIGITS[stored], most.most);
            assert_int_equal(most.beyond, 0);
            assert_true(p == ASSAY_PRECISION_DOUBLE || most.most > (stored < p ? 0.003 : 0.03));
        }
    }
    close_candidate(&c);
}

/* ---- splatting ---- */

/* Coefficients of f cos, in the frame of the BRDF. */
static void few_brdf(candidate *c, size_t i, double row[ROW])
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
        const double base = c->defect == NO_BASE ? 1.0 : few(f, c->d->brdf[15 * i + 12 + n / COUNT]);
        double       looked[2];
        for (size_t k = 0; k < 2; k++) {
            const size_t lobe = (size_t)c->d->lobe[LOBES * i + (k ? 1 + n / COUNT : 0)];
            double       terms[4];
            for (size_t j = 0; j < 4; j++) {
                const size_t x = first[0] + j % 2, y = first[1] + j / 2;
                const size_t at = c->defect == TRANSPOSED ? x * GRID + y : y * GRID + x;
                const double w  = few(f, (j % 2 ? share[0] : few(f, 1.0 - share[0])) *
                                             (j / 2 ? share[1] : few(f, 1.0 - share[1])));
                terms[j] = few(f, w * few(f, c->d->grids[(lobe * TEXELS + at) * COUNT + n % COUNT]));
            }
            looked[k] = few_sum(&c->f, 4, terms);
        }
        row[n] = few(f, looked[1] + few(f, base * looked[0]));
    }
}

/* The light comes to the BRDF, or the BRDF to the light. */
static void few_reflected(candidate *c, size_t i, bool light_turns, double out[3])
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
            reflected[j][k] = few_dot(&c->f, COUNT, said[k] + light * COUNT, brdf + j * COUNT);
        }
    }
    c->threshold -= 1.0;
    for (size_t j = 0; j < 3; j++) {
        out[j] = few(&c->f, few(&c->f, c->d->weight[i]) * few_mean(c, count, weights, reflected[j]));
    }
}

static void add_pixels(const stage_case *s, const data *d, const double *ends)
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

static bound_use use_light(const data *d, candidate *c, assay_precision precision, double last)
{
    const double ends[] = {0.0, 10.0, last};
    stage_case   s      = stage_case_begin(c->context);
    bound_use    use    = {0};
    add_records(&s, d);
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
    data     *d = make_data();
    candidate c;
    open_candidate(&c, *state, d);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        double most = 0.0;
        for (int way = 0; way < WAYS; way++) {
            choose(&c, p, RIGHT, (turning)way, way % 2);
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
        choose(&c, ASSAY_PRECISION_FLOAT, wrong[i], BY_SINES, false);
        const bound_use bad = use_light(d, &c, ASSAY_PRECISION_FLOAT, RECORDS);
        print_message("  defect %d: %.3g times the bound, %zu values\n", wrong[i], bad.most,
                      bad.beyond);
        assert_true(bad.most > 50.0);
    }
    /* Records beyond the last batch are not heard, and no bound is wider for them. */
    choose(&c, ASSAY_PRECISION_FLOAT, RIGHT, BY_SINES, false);
    assert_true(use_light(d, &c, ASSAY_PRECISION_FLOAT, RECORDS - 20).most > 50.0);
    close_candidate(&c);
    free(d);
}

/* Weights up to record 45, a batch later up to 70. */
static bound_use use_sums(const data *d, candidate *c, assay_precision precision, const char *variant)
{
    const double ends[] = {20.0, 45.0, 70.0};
    const size_t last   = c->defect == LOST ? 69 : 70;
    stage_case   s      = stage_case_begin(c->context);
    bound_use    use    = {0};
    add_records(&s, d);
    add_pixels(&s, d, ends);
    stage_case_text(&s, "variant", variant);
    stage_case_run(&s, "splat-glossy", precision);
    assert_int_equal(s.run.out_count, 3);
    for (size_t i = 0; i < POINTS; i++) {
        double       terms[2 * RECORDS];
        size_t       count = 0;
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
    data     *d = make_data();
    candidate c;
    open_candidate(&c, *state, d);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        choose(&c, p, RIGHT, BY_SINES, false);
        const bound_use right     = use_sums(d, &c, (assay_precision)p, "corrected");
        const bound_use published = use_sums(d, &c, (assay_precision)p, "published");
        print_message("splat-glossy, %d digits: %.3f of the bound\n", DIGITS[p], right.most);
        assert_int_equal(right.beyond + published.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || right.most > 0.03);
    }
    static const defect wrong[] = {LARGER_R, LOST};
    for (size_t i = 0; i < 2; i++) {
        choose(&c, ASSAY_PRECISION_FLOAT, wrong[i], BY_SINES, false);
        const bound_use bad = use_sums(d, &c, ASSAY_PRECISION_FLOAT, "corrected");
        print_message("  defect %d: %.3g times the bound\n", wrong[i], bad.most);
        assert_true(bad.most > 50.0);
    }
    close_candidate(&c);
    free(d);
}

/* ---- HSH by angles ---- */

static bound_use use_angles(candidate *c, int precision, double sign, bool whole)
{
    const double alpha = 0.3, beta = 1.1, gamma = -2.0;
    double       in[2 * ROW], matrix[COUNT * COUNT];
    bound_use    use = {0};
    stage_case   s   = stage_case_begin(c->context);
    for (size_t i = 0; i < (size_t)2 * ROW; i++) {
        in[i] = random_in(&c->f.random, -1.0, 1.0);
    }
    stage_case_text(&s, "basis", "hsh");
    stage_case_text(&s, "order", "4");
    stage_case_text(&s, "alpha", "0.3");
    stage_case_text(&s, "beta", "1.1");
    stage_case_text(&s, "gamma", "-2");
    stage_case_table(&s, "rotate/in", "W/(m2 sr)", 6, COUNT, in);
    stage_case_run(&s, "rotate", (assay_precision)precision);
    const stage_output *out = stage_case_output(&s, "rotate/out");
    const few_digits   *f   = &c->f;
    for (size_t i = 0; i < 2; i++) {
        double       row[ROW];
        const double a = few(f, alpha), b = few(f, beta), g = few(f, gamma);
        for (size_t k = 0; k < ROW; k++) {
            row[k] = few(f, in[ROW * i + k]);
        }
        few_matrix(c, sign * b, matrix);
        if (whole) {
            one_matrix(c, few(f, assay_cos(a)), few(f, assay_sin(a)), few(f, assay_cos(g)),
                       few(f, assay_sin(g)), sign * b, row);
        } else {
            few_spin(f, few(f, assay_cos(g)), few(f, assay_sin(g)), row);
            few_multiply(c, matrix, row);
            few_spin(f, few(f, assay_cos(a)), few(f, assay_sin(a)), row);
        }
        for (size_t k = 0; k < ROW; k++) {
            bound_use_add(&use, row[k], out->values[ROW * i + k], out->bounds[ROW * i + k]);
        }
    }
    stage_case_end(&s);
    return use;
}

static void test_angles(void **state)
{
    candidate c;
    open_candidate(&c, *state, NULL);
    for (int p = ASSAY_PRECISION_HALF; p <= ASSAY_PRECISION_DOUBLE; p++) {
        choose(&c, p, RIGHT, BY_ANGLES, false);
        c.exact               = true;
        const bound_use parts = use_angles(&c, p, 1.0, false), whole = use_angles(&c, p, 1.0, true);
        print_message("rotate, hsh, %d digits: %.3f, %.3f of the bound\n", DIGITS[p], parts.most,
                      whole.most);
        assert_int_equal(parts.beyond + whole.beyond, 0);
        assert_true(p == ASSAY_PRECISION_DOUBLE || parts.most > 5e-4);
    }
    choose(&c, ASSAY_PRECISION_FLOAT, RIGHT, BY_ANGLES, false);
    c.exact             = true;
    const bound_use bad = use_angles(&c, ASSAY_PRECISION_FLOAT, -1.0, false);
    print_message("  inverse: %.3g times the bound\n", bad.most);
    assert_true(bad.most > 100.0);
    close_candidate(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_turns, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_interpolate_radiance, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(test_splat_glossy_light, context_set_up,
                                        context_tear_down),
        cmocka_unit_test_setup_teardown(test_splat_glossy, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_angles, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
