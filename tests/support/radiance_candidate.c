/* radiance_candidate.c - the candidate. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "radiance_candidate.h"

#include "core/numerics.h"
#include "support/random_places.h"
#include "support/splat_room.h"

static const double A        = 0.6;
static const int    DIGITS[] = {11, 24, 53};

/* What tilts there are between records and points at one place: none, and down to what no
 * precision sees. */
assay_vec3 tilted(assay_vec3 n, size_t i, assay_random *random)
{
    static const double sizes[] = {0.0,  1e-12, 1e-8,    1e-7, 1e-6, 1e-5,
                                   1e-4, 1e-3,  1.35e-3, 1e-2, 0.1};
    const assay_vec3    side    = random_unit(random);
    return vec3_normalize(vec3_mad(n, sizes[i % (sizeof sizes / sizeof sizes[0])], side));
}

static void make_records(radiance_data *d, assay_random *random)
{
    for (uint32_t k = 0; k < RECORDS; k++) {
        const assay_record r = splat_room_record(3, RECORDS, k);
        put_values(d->position + 3 * (size_t)k, &r.position, 3);
        put_values(d->normal + 3 * (size_t)k, &r.normal, 3);
        d->radius[k] = 0.4 * r.radius;
    }
    for (size_t i = 0; i < (size_t)ROW * RECORDS; i++) {
        d->coefficients[i] = random_in(random, -1.0, 2.0);
    }
    for (size_t i = 0; i < (size_t)3 * ROW * RECORDS; i++) {
        d->gradient[i] = random_in(random, -1.0, 1.0);
    }
}

/* So rough that it counts where a direction falls. */
static void make_grids(radiance_data *d, assay_random *random)
{
    for (size_t i = 0; i < (size_t)LOBES * TEXELS * COUNT; i++) {
        d->grids[i] = random_in(random, -1.0, 1.0);
    }
}

/* Every other point is at a record's very place. */
radiance_data *radiance_data_make(void)
{
    radiance_data     *d      = calloc(1, sizeof *d);
    const assay_camera camera = splat_room_camera(false);
    assay_random       random = assay_random_start(21, ASSAY_STAGE_TEST, 3, 0);
    assert_non_null(d);
    d->count = POINTS;
    make_records(d, &random);
    make_grids(d, &random);
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
        put_values(d->at + 3 * i, &p, 3);
        put_values(d->frame + 9 * i, &frame, 9);
        put_values(d->brdf + 15 * i, &frame, 9);
        put_values(d->brdf + 15 * i + 9, &wo, 3);
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

radiance_data *radiance_data_stored(const radiance_data *d, int digits)
{
    const few_digits f      = {.digits = digits};
    radiance_data   *stored = malloc(sizeof *stored);
    assert_non_null(stored);
    *stored        = *d;
    double *values = (double *)stored;
    for (size_t i = 0; i < offsetof(radiance_data, grids) / sizeof *values; i++) {
        values[i] = few(&f, values[i]);
    }
    return stored;
}

void radiance_data_add(const stage_case *c, const radiance_data *d)
{
    stage_case_text(c, "a", "0.6");
    stage_case_text(c, "order", "4");
    stage_case_text(c, "rotation_steps", "8");
    stage_case_text(c, "grid", "40");
    stage_case_table(c, "radiance_records/position", "m", RECORDS, 3, d->position);
    stage_case_table(c, "radiance_records/normal", "", RECORDS, 3, d->normal);
    stage_case_table(c, "radiance_records/radius", "m", RECORDS, 1, d->radius);
    stage_case_table(c, "radiance_records/coefficients", "W/(m2 sr)", RECORDS, ROW,
                     d->coefficients);
    stage_case_table(c, "radiance_records/coefficient_gradient", "W/(m3 sr)", RECORDS,
                     (size_t)3 * ROW, d->gradient);
}

/* ---- a candidate ---- */

void radiance_candidate_open(radiance_candidate *c, assay_context *context, const radiance_data *d)
{
    const double most = 2.0 * assay_asin(A * sqrt(0.5));
    *c                = (radiance_candidate){.d = d, .context = context};
    c->table          = malloc((STEPS + 1) * sizeof *c->table);
    assert_non_null(c->table);
    assert_int_equal(
        assay_basis_create(context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &c->hsh),
        ASSAY_OK);
    for (int k = 0; k <= STEPS; k++) {
        c->nodes[k] = (double)k * k / (STEPS * STEPS) * most;
        assert_int_equal(assay_hsh_rotation_y(c->hsh, context, NULL, c->nodes[k], c->table[k]),
                         ASSAY_OK);
    }
}

void radiance_candidate_close(radiance_candidate *c)
{
    assay_basis_destroy(c->hsh);
    free(c->table);
}

/* [duff17], listing 3. */
void few_frame(const few_digits *f, const double *normal, double frame[9])
{
    const double x = few(f, normal[0]), y = few(f, normal[1]), z = few(f, normal[2]);
    const double s = copysign(1.0, z);
    const double a = few(f, -1.0 / few(f, s + z)), b = few(f, few(f, x * y) * a);
    const double rows[9] = {few(f, 1.0 + few(f, few(f, s * x * x) * a)),
                            s * b,
                            -s * x,
                            b,
                            few(f, s + few(f, few(f, y * y) * a)),
                            -y,
                            x,
                            y,
                            z};
    memcpy(frame, rows, sizeof rows);
}

void few_spin(const few_digits *f, double cosine, double sine, double *row)
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
                row[plus]  = few(f, few(f, cm * a) - few(f, sm * b));
                row[minus] = few(f, few(f, sm * a) + few(f, cm * b));
            }
        }
    }
}

/* M_R(tilt) by linear interpolation between matrices that were rounded once, or itself. */
void few_matrix(radiance_candidate *c, double tilt, double matrix[COUNT * COUNT])
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

void few_multiply(radiance_candidate *c, const double matrix[COUNT * COUNT], double *row)
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
void few_whole_turn(radiance_candidate *c, const double ca, const double sa, const double cg,
                    const double sg, double tilt, double *row)
{
    const few_digits precise = {.digits = 53};
    double           middle[COUNT * COUNT], whole[COUNT * COUNT];
    few_matrix(c, tilt, middle);
    for (size_t j = 0; j < COUNT; j++) {
        double unit[ROW] = {0.0}, out[ROW] = {0.0};
        unit[j] = 1.0;
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
static void few_angles(radiance_candidate *c, const double r[9], double sine, double side,
                       double *unit, double *tilt)
{
    const few_digits *f = &c->f;
    if (c->way == BY_ANGLES) {
        const double alpha     = few(f, assay_atan2(r[5], r[2])),
                     gamma     = few(f, assay_atan2(r[7], -r[6]));
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

void few_turn(radiance_candidate *c, const double from[9], const double to[9], double *row)
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
        few_whole_turn(c, unit[0], unit[1], unit[2], unit[3], tilt, row);
        return;
    }
    few_matrix(c, tilt, matrix);
    few_spin(f, unit[2], unit[3], row);
    few_multiply(c, matrix, row);
    few_spin(f, unit[0], unit[1], row);
}

double few_weight(radiance_candidate *c, const double *p, const double *n, size_t k)
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
static void few_said(radiance_candidate *c, const double *p, const double *n, size_t k,
                     double row[ROW])
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
size_t few_terms(radiance_candidate *c, const double *p, const double *n, double weights[RECORDS],
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

double few_mean(radiance_candidate *c, size_t count, const double *weights, const double *values)
{
    double       terms[RECORDS];
    const double top = few_dot(&c->f, count, weights, values);
    put_values(terms, weights, count);
    return count ? few(&c->f, top / few_sum(&c->f, count, terms)) : 0.0;
}

/* A threshold of a candidate's own, from the least to the largest. */
void radiance_candidate_choose(radiance_candidate *c, int precision, defect planted, turning way,
                               bool high)
{
    const double u = ldexp(1.0, -DIGITS[precision]);
    c->f         = (few_digits){DIGITS[precision], assay_random_start(5, ASSAY_STAGE_TEST, 9, way)};
    c->defect    = planted;
    c->way       = way;
    c->threshold = high ? sqrt(32.0 * u) : 64.0 * (u + 0x1p-53);
}
