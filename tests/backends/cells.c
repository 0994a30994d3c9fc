/* cells.c - docs/methods/gathering.md in single precision: cosine strata, cells of constant
 * radiance whose borders move by the nearer side's distance.
 *
 * The first stratum of a column follows on its last one. */
#include "cells.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "planted.h"
#include "vector.h"

enum { PLACES = 24, CHANNELS = 3 };

static const float PI = 3.14159265f;

typedef struct {
    size_t m, n;
    float *radiance, *distance;  /* theta by theta */
    float *sine, *cosine, *lift; /* of the m + 1 borders; lift: (theta - sin cos) / 2 */
} hemisphere;

/* ---- seeing ---- */

/* How far a box with the corners -1 and 1 is from a point within it, and the wall's radiance. */
static float look(vec from, vec along, float radiance[CHANNELS])
{
    const float p[3] = {from.x, from.y, from.z}, d[3] = {along.x, along.y, along.z};
    float       nearest = INFINITY;
    int         wall    = 0;
    for (int axis = 0; axis < 3; axis++) {
        const float away = ((d[axis] > 0.0f ? 1.0f : -1.0f) - p[axis]) / d[axis];
        if (d[axis] != 0.0f && away < nearest) {
            nearest = away;
            wall    = 2 * axis + (d[axis] > 0.0f);
        }
    }
    const vec at = add(from, scale(along, nearest));
    for (int c = 0; c < CHANNELS; c++) {
        radiance[c] =
            0.2f + 0.1f * (float)((wall + 2 * c) % 5) + (at.x * at.y > 0.3f ? 1.0f : 0.0f);
    }
    return nearest;
}

static void gather(const hemisphere *h, vec from, const vec axes[3])
{
    for (size_t j = 0; j < h->m; j++) {
        const float sine   = sqrtf(((float)j + 0.5f) / (float)h->m);
        const float cosine = sqrtf(((float)(h->m - j) - 0.5f) / (float)h->m);
        for (size_t k = 0; k < h->n; k++) {
            const float  phi   = 2.0f * PI * ((float)k + 0.5f) / (float)h->n;
            const vec    along = add(scale(axes[0], sine * cosf(phi)),
                                     add(scale(axes[1], sine * sinf(phi)), scale(axes[2], cosine)));
            const size_t cell  = j * h->n + k;
            h->distance[cell]  = look(from, along, h->radiance + CHANNELS * cell);
        }
    }
}

/* ---- what follows ---- */

static float radiance_of(const hemisphere *h, size_t j, size_t k, size_t channel)
{
    return h->radiance[CHANNELS * (j * h->n + k % h->n) + channel];
}

static float nearer(const hemisphere *h, size_t a, size_t b)
{
    const float x = h->distance[a], y = h->distance[b];
    return IS_PLANTED(FARTHER_SIDE) ? fmaxf(x, y) : fminf(x, y);
}

static float irradiance_of(const hemisphere *h, size_t channel)
{
    float sum = 0.0f;
    for (size_t i = 0; i < h->m * h->n; i++) {
        const float again = IS_PLANTED(COSINE_TWICE) ? h->cosine[i / h->n] : 1.0f;
        sum += again * h->radiance[CHANNELS * i + channel];
    }
    return PI / (float)(h->m * h->n) * sum;
}

static vec rotation_of(const hemisphere *h, size_t channel)
{
    vec sum = {0.0f, 0.0f, 0.0f};
    for (size_t j = 0; j < h->m; j++) {
        for (size_t k = 0; k < h->n; k++) {
            const float phi = 2.0f * PI * (float)k / (float)h->n;
            const float step =
                radiance_of(h, j, k, channel) - radiance_of(h, j, k + h->n - 1, channel);
            const float size = (h->lift[j] - h->lift[j + 1]) * step;
            sum              = add(sum, (vec){size * cosf(phi), size * sinf(phi), 0.0f});
        }
    }
    return IS_PLANTED(ROTATION_FLIPPED) ? scale(sum, -1.0f) : sum;
}

static vec translation_of(const hemisphere *h, size_t channel)
{
    const float wide = 2.0f * sinf(PI / (float)h->n);
    vec         sum  = {0.0f, 0.0f, 0.0f};
    for (size_t j = 0; j < h->m; j++) {
        for (size_t k = 0; k < h->n; k++) {
            const float  low    = 2.0f * PI * (float)k / (float)h->n;
            const float  middle = 2.0f * PI * ((float)k + 0.5f) / (float)h->n;
            const size_t cell = j * h->n + k, beside = j * h->n + (k + h->n - 1) % h->n;
            const float  here = radiance_of(h, j, k, channel);
            float by = (here - radiance_of(h, j, k + h->n - 1, channel)) / nearer(h, cell, beside) *
                       (h->sine[j + 1] - h->sine[j]);
            sum = add(sum, (vec){-by * sinf(low), by * cosf(low), 0.0f});
            if (j > 0) {
                by = (here - radiance_of(h, j - 1, k, channel)) / nearer(h, cell, cell - h->n) *
                     h->sine[j] * h->cosine[j] * h->cosine[j] * wide;
                sum = add(sum, (vec){by * cosf(middle), by * sinf(middle), 0.0f});
            }
        }
    }
    return sum;
}

/* All directions count alike. */
static float mean_distance(const hemisphere *h)
{
    float sum = 0.0f;
    for (size_t i = 0; i < h->m * h->n; i++) {
        const size_t j     = i / h->n;
        const float  share = (h->cosine[j] - h->cosine[j + 1]) / (float)h->n;
        sum += IS_PLANTED(ARITHMETIC_MEAN) ? share * h->distance[i] : share / h->distance[i];
    }
    return IS_PLANTED(ARITHMETIC_MEAN) ? sum : 1.0f / sum;
}

/* ---- all of it ---- */

static hemisphere make(const bundle *to)
{
    const size_t m = (size_t)bundle_number(to, "theta_strata");
    const size_t n = (size_t)bundle_number(to, "phi_strata");
    hemisphere   h = {.m        = m,
                      .n        = n,
                      .radiance = allocate(m * n, CHANNELS * sizeof(float)),
                      .distance = allocate(m * n, sizeof(float)),
                      .sine     = allocate(m + 1, sizeof(float)),
                      .cosine   = allocate(m + 1, sizeof(float)),
                      .lift     = allocate(m + 1, sizeof(float))};
    for (size_t j = 0; j <= m; j++) {
        const double sine = sqrt((double)j / (double)m), cosine = sqrt((double)(m - j) / (double)m);
        h.sine[j]   = (float)sine;
        h.cosine[j] = (float)cosine;
        h.lift[j]   = (float)(0.5 * (atan2(sine, cosine) - sine * cosine));
    }
    return h;
}

static void release(hemisphere *h)
{
    free(h->radiance);
    free(h->distance);
    free(h->sine);
    free(h->cosine);
    free(h->lift);
}

static void put_world(const vec axes[3], vec local, float *out)
{
    const vec world =
        add(scale(axes[0], local.x), add(scale(axes[1], local.y), scale(axes[2], local.z)));
    memcpy(out, &world, sizeof world);
}

static void place(size_t i, vec *from, vec axes[3])
{
    const float turn = 0.7f * (float)i;
    axes[2]          = unit((vec){cosf(turn), 0.3f, sinf(1.3f * turn)});
    axes[0]          = unit(cross(axes[2], (vec){0.2f, 1.0f, -0.1f}));
    axes[1]          = cross(axes[2], axes[0]);
    *from            = (vec){0.6f * sinf(2.1f * turn), 0.6f * cosf(turn), 0.5f * sinf(0.4f * turn)};
}

void cells_gather(bundle *to)
{
    hemisphere   h     = make(to);
    const size_t cells = h.m * h.n;
    table        seen = table_make(PLACES * cells, 3), far = table_make(PLACES * cells, 1);
    table        frames = table_make(PLACES, 9), irradiance = table_make(PLACES, 3);
    table        rotation = table_make(PLACES, 9), translation = table_make(PLACES, 9);
    table        mean = table_make(PLACES, 1), nearest = table_make(PLACES, 1);
    for (size_t i = 0; i < PLACES; i++) {
        vec from, axes[3];
        place(i, &from, axes);
        gather(&h, from, axes);
        memcpy(table_row(&frames, i), axes, sizeof axes);
        memcpy(table_row(&seen, i * cells), h.radiance, cells * CHANNELS * sizeof(float));
        memcpy(table_row(&far, i * cells), h.distance, cells * sizeof(float));
        for (size_t c = 0; c < CHANNELS; c++) {
            table_row(&irradiance, i)[c] = irradiance_of(&h, c);
            put_world(axes, rotation_of(&h, c), table_row(&rotation, i) + 3 * c);
            put_world(axes, translation_of(&h, c), table_row(&translation, i) + 3 * c);
        }
        mean.values[i]    = mean_distance(&h);
        nearest.values[i] = INFINITY;
        for (size_t k = 0; k < cells; k++) {
            nearest.values[i] = fminf(nearest.values[i], h.distance[k]);
        }
    }
    bundle_write(to, "gather/radiance", "W/(m2 sr)", &seen);
    bundle_write(to, "gather/distance", "m", &far);
    bundle_write(to, "gather/frame", "", &frames);
    bundle_write(to, "records/irradiance", "W/m2", &irradiance);
    bundle_write(to, "records/rotation_gradient", "W/(m2 rad)", &rotation);
    bundle_write(to, "records/translation_gradient", "W/m3", &translation);
    bundle_write(to, "records/harmonic_mean", "m", &mean);
    bundle_write(to, "records/nearest", "m", &nearest);
    release(&h);
}
