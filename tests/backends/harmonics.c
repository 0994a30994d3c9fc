/* harmonics.c - light is made here, of any kind: what is judged is what becomes of it. */
#include "harmonics.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "planted.h"
#include "tables.h"

#define REAL float
#define ROOT sqrtf
#define NAME(what) float_##what
#include "harmonics_body.h"

enum { ORDER = HARMONICS_ORDER, COUNT = ORDER * ORDER, CHANNELS = 3, SAMPLES = 600 };
enum { MOST_COUNT = 400 };

static const float TWO_PI = 6.28318531f;

/* ---- samples ---- */

/* Multiples of 1 / p and 1 / p^2, p^3 = p + 1, modulo 1 fill a square evenly; the square is drawn
 * to a hemisphere or a sphere, area by area. */
static void spread(bool hemisphere, table *directions, table *pdf)
{
    for (size_t i = 0; i < directions->rows; i++) {
        const float u = fmodf(0.5f + 0.754877666f * (float)i, 1.0f);
        const float v = fmodf(0.5f + 0.569840291f * (float)i, 1.0f);
        const float z = hemisphere ? u : 2.0f * u - 1.0f, sine = sqrtf((1.0f - z) * (1.0f + z));
        const float d[3] = {sine * cosf(TWO_PI * v), sine * sinf(TWO_PI * v), z};
        memcpy(table_row(directions, i), d, sizeof d);
        pdf->values[i] = 1.0f / (hemisphere ? TWO_PI : 2.0f * TWO_PI);
    }
}

/* A lobe about a direction beside the pole, on a ground of its own colour. */
static void shine(const table *directions, float ground, table *values)
{
    for (size_t i = 0; i < directions->rows; i++) {
        const float *d      = table_row(directions, i);
        const float  cosine = 0.6f * d[0] - 0.2f * d[1] + 0.7745967f * d[2];
        const float  lobe   = cosine > 0.0f ? cosine * cosine * cosine * cosine : 0.0f;
        for (size_t c = 0; c < CHANNELS; c++) {
            table_row(values, i)[c] = ground + lobe * (1.0f - 0.3f * (float)c);
        }
    }
}

/* Stage `project`: a row a channel. */
static table project(int order, bool hemisphere, const table *directions, const table *pdf,
                     const table *values)
{
    const size_t count        = (size_t)(order * order);
    table        coefficients = table_make(CHANNELS, count);
    for (size_t i = 0; i < directions->rows; i++) {
        float functions[MOST_COUNT];
        float_evaluate(order, hemisphere, table_row(directions, i), functions);
        for (size_t c = 0; c < CHANNELS; c++) {
            const float density = IS_PLANTED(SOLID_ANGLE_LEFT_OUT) ? 1.0f : pdf->values[i];
            const float share   = table_row(values, i)[c] / density;
            for (size_t k = 0; k < count; k++) {
                table_row(&coefficients, c)[k] += share * functions[k];
            }
        }
    }
    for (size_t k = 0; k < CHANNELS * count; k++) {
        coefficients.values[k] /= (float)directions->rows;
    }
    return coefficients;
}

static table sample_and_project(int order, bool hemisphere, float ground, bundle *to)
{
    table directions = table_make(SAMPLES, 3), pdf = table_make(SAMPLES, 1);
    table values = table_make(SAMPLES, CHANNELS);
    spread(hemisphere, &directions, &pdf);
    shine(&directions, ground, &values);
    table coefficients = project(order, hemisphere, &directions, &pdf, &values);
    if (to) {
        table written = table_copy(&coefficients);
        bundle_write(to, "project/direction", "", &directions);
        bundle_write(to, "project/pdf", "1/sr", &pdf);
        bundle_write(to, "project/value", "W/(m2 sr)", &values);
        bundle_write(to, "project/coefficients", "W/(m2 sr)", &written);
    } else {
        table_release(&directions);
        table_release(&pdf);
        table_release(&values);
    }
    return coefficients;
}

/* ---- matrices ---- */

/* out = M in, or the transpose of M; rows of coefficients. */
static table multiply(const table *matrix, bool transposed, const table *in)
{
    const size_t count = transposed ? matrix->columns : matrix->rows;
    table        out   = table_make(in->rows, count);
    for (size_t row = 0; row < in->rows; row++) {
        for (size_t i = 0; i < count; i++) {
            float sum = 0.0f;
            for (size_t j = 0; j < in->columns; j++) {
                sum += (transposed ? table_row(matrix, j)[i] : table_row(matrix, i)[j]) *
                       table_row(in, row)[j];
            }
            table_row(&out, row)[i] = sum;
        }
    }
    return out;
}

/* Stage `convert`: h = C s; s = C' h.  Planted: C of equal orders the wrong way round. */
static void convert(bool to_sh, const table *in, bundle *to)
{
    const bool wrong = IS_PLANTED(CONVERSION_TRANSPOSED);
    table      c     = table_of_conversion(ORDER, to_sh && !wrong ? HARMONICS_SH_ORDER : ORDER);
    table      out = multiply(&c, to_sh != wrong, in), given = table_copy(in);
    if (to_sh && wrong) {
        table wide = table_make(out.rows, HARMONICS_SH_ORDER * HARMONICS_SH_ORDER);
        for (size_t i = 0; i < out.rows; i++) {
            memcpy(table_row(&wide, i), table_row(&out, i), COUNT * sizeof(float));
        }
        table_release(&out);
        out = wide;
    }
    bundle_write(to, "convert/in", "W/(m2 sr)", &given);
    bundle_write(to, "convert/out", "W/(m2 sr)", &out);
    table_release(&c);
}

static table turn(const table *in, bundle *to)
{
    static const char *const names[3] = {"alpha", "beta", "gamma"};
    double                   angles[3];
    for (int i = 0; i < 3; i++) {
        const char *text = bundle_text(to, names[i]);
        angles[i]        = strtod(text ? text : "0", NULL);
        angles[i] *= IS_PLANTED(ANGLE_ROUGH) ? 1.00005 : 1.0;
        angles[i] = IS_PLANTED(TURN_BACKWARDS) && i == 1 ? -angles[i] : angles[i];
    }
    table d   = table_of_turn(ORDER, angles);
    table out = multiply(&d, IS_PLANTED(TURN_TRANSPOSED), in), given = table_copy(in);
    table written = table_copy(&out);
    bundle_write(to, "rotate/in", "W/(m2 sr)", &given);
    bundle_write(to, "rotate/out", "W/(m2 sr)", &written);
    table_release(&d);
    return out;
}

/* ---- product ---- */

/* Stage `reflect`: points whose light is a row of CHANNELS times count numbers, and one lobe. */
static void reflect(table *light, const table *lobe, bundle *to)
{
    const size_t count = lobe->columns;
    table brdf = table_make(light->rows, light->columns), out = table_make(light->rows, CHANNELS);
    for (size_t i = 0; i < light->rows; i++) {
        memcpy(table_row(&brdf, i), lobe->values, light->columns * sizeof(float));
        for (size_t c = 0; c < CHANNELS; c++) {
            for (size_t k = 0; k < count; k++) {
                const bool   mixed = IS_PLANTED(COEFFICIENTS_BY_FUNCTION);
                const size_t at    = mixed ? CHANNELS * k + c : count * c + k;
                table_row(&out, i)[c] += table_row(light, i)[at] * table_row(&brdf, i)[at];
            }
        }
    }
    bundle_write(to, "reflect/light", "W/(m2 sr)", light);
    bundle_write(to, "reflect/brdf", "1/sr", &brdf);
    bundle_write(to, "reflect/radiance", "W/(m2 sr)", &out);
}

void harmonics_of_records(const bundle *from, bundle *to)
{
    table light = bundle_read(from, "radiance_records/coefficients", "");
    table lobe  = sample_and_project((int)bundle_number(from, "order"), true, 0.0f, NULL);
    if (light.columns != CHANNELS * lobe.columns) {
        fail("radiance_records/coefficients: not of the order that the manifest says");
    }
    reflect(&light, &lobe, to);
    table_release(&lobe);
}

void harmonics_of_hemisphere(bundle *to)
{
    table light = sample_and_project(ORDER, true, 0.25f, to);
    table lobe  = sample_and_project(ORDER, true, 0.0f, NULL);
    table point = table_make(1, CHANNELS * COUNT);
    memcpy(point.values, light.values, CHANNELS * COUNT * sizeof(float));
    convert(true, &light, to);
    reflect(&point, &lobe, to);
    table_release(&light);
    table_release(&lobe);
}

void harmonics_of_sphere(bundle *to)
{
    table light  = sample_and_project(ORDER, false, 0.25f, to);
    table turned = turn(&light, to);
    convert(false, &turned, to);
    table_release(&light);
    table_release(&turned);
}
