/* splat.c - [gautron06] algorithm 3 as a GPU would do it: a pass a record over the pixels near it.
 *
 * Tiles of pixels take a record where a box about their points meets its sphere; what counts is
 * decided by the weight alone. */
#include "splat.h"

#include <stdio.h>
#include <stdlib.h>

#include "planted.h"

enum { TILE = 8, SUMS = 4 };

static const float INV_PI = IS_PLANTED(PI_ROUGH) ? 1.0f / 3.14f : 0.318309886f;

typedef struct {
    const records *records;
    size_t         width, height;
    table          position, frame, albedo;
    float         *sums; /* a pixel: weight, then weight times irradiance */
} buffer;

/* Nearest number of binary16, for one that is normal there. */
static float rounded_to_half(float x)
{
    int         exponent;
    const float fraction = frexpf(x, &exponent);
    return x == 0.0f ? 0.0f : ldexpf(rintf(fraction * 2048.0f), exponent - 11);
}

static void grow(float *sum, float by)
{
    *sum = IS_PLANTED(HALF_FLOAT_SUMS) ? rounded_to_half(*sum + rounded_to_half(by)) : *sum + by;
}

static void splat_pixel(const buffer *b, const record *k, size_t pixel)
{
    const vec   position = vec_of(table_row(&b->position, pixel));
    const vec   normal   = vec_of(table_row(&b->frame, pixel) + 6);
    float      *sums     = b->sums + SUMS * pixel;
    float       said[3];
    const float weight = record_weight(b->records, k, position, normal);
    if (weight > 0.0f) {
        record_say(b->records, k, position, normal, said);
        grow(&sums[0], weight);
        for (int c = 0; c < 3; c++) {
            grow(&sums[1 + c], weight * said[c]);
        }
    }
}

/* Squared distance of a record from the box about a tile's points; infinite where it has none. */
static float distance_from_tile(const buffer *b, vec centre, const size_t tile[4])
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    const float at[3] = {centre.x, centre.y, centre.z};
    float       sum   = 0.0f;
    for (size_t y = tile[1]; y < tile[3]; y++) {
        for (size_t x = tile[0]; x < tile[2]; x++) {
            const float *p = table_row(&b->position, y * b->width + x);
            for (int c = 0; c < 3; c++) {
                low[c]  = fminf(low[c], p[c]);
                high[c] = fmaxf(high[c], p[c]);
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        const float away = fmaxf(fmaxf(low[c] - at[c], at[c] - high[c]), 0.0f);
        sum += away * away;
    }
    return sum;
}

static void splat_record(const buffer *b, const record *k)
{
    const float  spare = IS_PLANTED(REACH_TOO_SHORT) ? 0.8f : 1.001f;
    const float  reach = b->records->a * k->radius * spare;
    const size_t wider = IS_PLANTED(DOUBLE_SPLAT) ? TILE + 1 : TILE;
    for (size_t y = 0; y < b->height; y += TILE) {
        for (size_t x = 0; x < b->width; x += TILE) {
            const size_t tile[4] = {x, y, x + wider < b->width ? x + wider : b->width,
                                    y + TILE < b->height ? y + TILE : b->height};
            if (distance_from_tile(b, k->position, tile) > reach * reach) {
                continue;
            }
            for (size_t v = tile[1]; v < tile[3]; v++) {
                for (size_t u = tile[0]; u < tile[2]; u++) {
                    splat_pixel(b, k, v * b->width + u);
                }
            }
        }
    }
}

static void take_sums(const buffer *b, table *weight, table *radiance)
{
    const size_t pixels = b->width * b->height;
    *weight             = table_make(pixels, 1);
    *radiance           = table_make(pixels, 3);
    for (size_t i = 0; i < pixels; i++) {
        weight->values[i] = b->sums[SUMS * i];
        for (size_t c = 0; c < 3; c++) {
            const float albedo        = table_row(&b->albedo, i)[c];
            const float share         = IS_PLANTED(PI_LEFT_OUT) ? albedo : albedo * INV_PI;
            table_row(radiance, i)[c] = share * b->sums[SUMS * i + 1 + c];
        }
    }
}

/* Stage `normalise`. */
static table quotient(const table *weight, const table *radiance)
{
    table result = table_make(weight->rows, 3);
    for (size_t i = 0; i < 3 * weight->rows; i++) {
        const float w    = IS_PLANTED(NOT_NORMALISED) ? 1.0f : weight->values[i / 3];
        result.values[i] = weight->values[i / 3] > 0.0f ? radiance->values[i] / w : 0.0f;
    }
    return result;
}

static void splat_batches(buffer *b, const table *ends, bundle *to)
{
    size_t done = IS_PLANTED(RECORD_LEFT_OUT) ? 1 : 0;
    char   name[64];
    for (size_t k = 0; k < ends->rows; k++) {
        table weight, radiance;
        for (; done < (size_t)ends->values[k]; done++) {
            splat_record(b, &b->records->list[done]);
        }
        take_sums(b, &weight, &radiance);
        if (k + 1 == ends->rows) {
            table result = quotient(&weight, &radiance);
            bundle_write(to, "splat/result", "W/(m2 sr)", &result);
        }
        snprintf(name, sizeof name, "splat/batch.%zu/weight", k);
        bundle_write(to, name, "", &weight);
        snprintf(name, sizeof name, "splat/batch.%zu/radiance", k);
        bundle_write(to, name, "W/(m2 sr)", &radiance);
    }
}

/* Planted: decoded twice. */
static table take_albedo(const bundle *from, bundle *to)
{
    table albedo = bundle_read(from, "splat/albedo", ""), copy;
    for (size_t i = 0; i < albedo.rows * albedo.columns; i++) {
        albedo.values[i] =
            IS_PLANTED(ALBEDO_ENCODED) ? powf(albedo.values[i], 2.2f) : albedo.values[i];
    }
    copy = table_copy(&albedo);
    bundle_write(to, "splat/albedo", "", &copy);
    return albedo;
}

void splat_all(const records *r, const bundle *from, bundle *to, size_t width)
{
    buffer b    = {.records = r, .width = width};
    table  ends = bundle_pass_on(from, to, "splat/batch_end", "");
    b.position  = bundle_pass_on(from, to, "splat/position", "");
    b.frame     = bundle_pass_on(from, to, "splat/frame", "");
    b.albedo    = take_albedo(from, to);
    b.height    = b.position.rows / width;
    b.sums      = allocate(b.position.rows, SUMS * sizeof *b.sums);
    splat_batches(&b, &ends, to);
    table_release(&ends);
    table_release(&b.position);
    table_release(&b.frame);
    table_release(&b.albedo);
    free(b.sums);
}
