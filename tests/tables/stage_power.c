/* stage_power.c - false alarms and detections of verdicts on deterministic stages.
 *
 *     stage_power [TIMES]
 *
 * Candidates in native float, each on data of its own: 10 TIMES right ones (default 10,000), which
 * must all pass, and TIMES of each planted defect: the translational gradient's sign, the
 * arithmetic mean of distances for the harmonic one, the conversion matrix transposed.  One
 * comparison is of one record (12 + 1 numbers), or of one vector of coefficients. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "assay/basis.h"
#include "core/numerics.h"
#include "core/random.h"
#include "oracle/stage/irradiance_bound.h"

enum { M = 8, N = 25, ORDER = 6, COUNT = ORDER * ORDER };

static const rounding FLOAT = {.u = 0x1p-24 + 0x1p-53, .tiny = 0x1p-126, .given = 0x1p-24};

typedef enum { RIGHT, FLIPPED, ARITHMETIC, TRANSPOSED } defect;

static void require(assay_context *context, assay_status status)
{
    if (status != ASSAY_OK) {
        fprintf(stderr, "stage_power: %s\n", assay_context_error(context));
        exit(1);
    }
}

/* ---- records ---- */

static void fill(assay_hemisphere *h, uint64_t item)
{
    assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, item, 0);
    for (int i = 0; i < M * N; i++) {
        const double r       = assay_random_next(&random);
        const double g       = assay_random_next(&random);
        const double far     = assay_random_next(&random);
        h->cells[i].radiance = rgb(3.0 * r, 3.0 * g, 1.0);
        h->cells[i].distance = far < 0.05 ? INFINITY : 0.1 + 4.0 * far;
    }
}

static float light(const assay_hemisphere *h, int j, int k)
{
    return (float)h->cells[j * N + k].radiance.r;
}
static float far(const assay_hemisphere *h, int j, int k)
{
    return (float)h->cells[j * N + k].distance;
}

/* docs/methods/gathering.md in float, cell by cell: x and y of the red channel. */
static void gradient_of(const assay_hemisphere *h, float sign, float out[2])
{
    float sine[M + 1], cosine[M + 1];
    out[0] = out[1] = 0.0f;
    for (int j = 0; j <= M; j++) {
        sine[j]   = (float)sqrt((double)((float)j / M));
        cosine[j] = (float)sqrt((double)(1.0f - (float)j / M));
    }
    const float chord = 2.0f * (float)assay_sin(3.14159265f / N);
    for (int i = 0; i < M * N; i++) {
        const int   j = i / N, k = i % N, left = k > 0 ? k - 1 : N - 1;
        const float phi = 6.28318531f * (float)k / N, middle = 6.28318531f * ((float)k + 0.5f) / N;
        const float near = fminf(far(h, j, k), far(h, j, left));
        const float side =
            sign * (sine[j + 1] - sine[j]) * (light(h, j, k) - light(h, j, left)) / near;
        out[0] -= side * (float)assay_sin(phi);
        out[1] += side * (float)assay_cos(phi);
        if (j > 0) {
            const float lower = fminf(far(h, j, k), far(h, j - 1, k));
            const float up    = sign * sine[j] * cosine[j] * cosine[j] * chord *
                             (light(h, j, k) - light(h, j - 1, k)) / lower;
            out[0] += up * (float)assay_cos(middle);
            out[1] += up * (float)assay_sin(middle);
        }
    }
}

static float mean_of(const assay_hemisphere *h, bool arithmetic)
{
    float top = 0.0f, bottom = 0.0f;
    for (int i = 0; i < M * N; i++) {
        const int   j     = i / N;
        const float share = (float)sqrt((double)(1.0f - (float)j / M)) -
                            (float)sqrt((double)(1.0f - (float)(j + 1) / M));
        const float r = far(h, j, i % N);
        top += share;
        bottom += arithmetic ? (isinf(r) ? 0.0f : share * r) : share / r;
    }
    return arithmetic ? bottom / top : top / bottom;
}

static bool record_fails(assay_hemisphere *h, uint64_t item, defect planted)
{
    const assay_frame3 frame = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    assay_vec3         right[3];
    float              mine[2];
    fill(h, item);
    const irradiance_bounds b = irradiance_bounds_of(&FLOAT, h, &frame, ASSAY_MEAN_UNIFORM, false);
    assay_hemisphere_translation_gradient(h, false, right);
    gradient_of(h, planted == FLIPPED ? -1.0f : 1.0f, mine);
    const double mean = assay_hemisphere_harmonic_mean(h, ASSAY_MEAN_UNIFORM);
    return !(fabs(mine[0] - right[0].x) <= b.translation[0]) ||
           !(fabs(mine[1] - right[0].y) <= b.translation[1]) ||
           !(fabs(mean_of(h, planted == ARITHMETIC) - mean) <= b.mean);
}

/* ---- coefficients ---- */

static bool vector_fails(const assay_sparse *matrix, uint64_t item, bool transposed)
{
    const assay_sparse_view c      = assay_sparse_entries(matrix);
    assay_random            random = assay_random_start(2, ASSAY_STAGE_TEST, item, 0);
    double                  in[COUNT], right[COUNT];
    float                   mine[COUNT] = {0.0f};
    bool                    fails       = false;
    for (int i = 0; i < COUNT; i++) {
        in[i] = 2.0 * assay_random_next(&random) - 1.0;
    }
    assay_sparse_multiply(matrix, in, right);
    for (size_t i = 0; i < c.rows; i++) {
        for (size_t k = c.row_start[i]; k < c.row_start[i + 1]; k++) {
            const size_t from = transposed ? i : c.column[k], to = transposed ? c.column[k] : i;
            mine[to] += (float)c.value[k] * (float)in[from];
        }
    }
    for (size_t i = 0; i < c.rows; i++) {
        tracked_sum sum = {0};
        for (size_t k = c.row_start[i]; k < c.row_start[i + 1]; k++) {
            tracked_sum_add(&sum, tracked_mul(&FLOAT, tracked_constant(&FLOAT, c.value[k]),
                                              tracked_given(&FLOAT, in[c.column[k]])));
        }
        fails = fails || !(fabs(mine[i] - right[i]) <= tracked_sum_of(&FLOAT, &sum).e);
    }
    return fails;
}

/* ---- the table ---- */

static void tell(const char *what, uint64_t failed, uint64_t times)
{
    printf("| %s | %llu | %llu |\n", what, (unsigned long long)times, (unsigned long long)failed);
}

int main(int argc, char **argv)
{
    const uint64_t                times   = argc > 1 ? strtoull(argv[1], NULL, 10) : 1000;
    assay_context                *context = NULL;
    assay_basis                  *sh = NULL, *hsh = NULL;
    assay_sparse                 *matrix    = NULL;
    assay_hemisphere             *h         = NULL;
    const assay_hemisphere_layout layout    = {.theta = M, .phi = N, .strata = ASSAY_STRATA_COSINE};
    uint64_t                      failed[4] = {0}, vectors = 0;
    if (assay_context_create(NULL, &context) != ASSAY_OK) {
        return 1;
    }
    require(context, assay_hemisphere_create(context, &layout, &h));
    require(context,
            assay_basis_create(context, ASSAY_BASIS_SH, ORDER, ASSAY_CONVENTION_THESIS, &sh));
    require(context,
            assay_basis_create(context, ASSAY_BASIS_HSH, ORDER, ASSAY_CONVENTION_THESIS, &hsh));
    require(context, assay_basis_conversion(context, sh, hsh, &matrix));
    for (uint64_t i = 0; i < 10 * times; i++) {
        failed[RIGHT] += record_fails(h, i, RIGHT);
        vectors += vector_fails(matrix, i, false);
        if (i < times) {
            failed[FLIPPED] += record_fails(h, i, FLIPPED);
            failed[ARITHMETIC] += record_fails(h, i, ARITHMETIC);
            failed[TRANSPOSED] += vector_fails(matrix, i, true);
        }
    }
    printf("| candidate in float | comparisons | fail |\n|---|---|---|\n");
    tell("right: a record from its cells", failed[RIGHT], 10 * times);
    tell("right: a vector converted", vectors, 10 * times);
    tell("flipped translational gradient", failed[FLIPPED], times);
    tell("arithmetic for harmonic mean", failed[ARITHMETIC], times);
    tell("C transposed", failed[TRANSPOSED], times);
    assay_sparse_destroy(matrix);
    assay_basis_destroy(sh);
    assay_basis_destroy(hsh);
    assay_hemisphere_destroy(context, h);
    assay_context_destroy(context);
    return failed[RIGHT] + vectors > 0 ||
           failed[FLIPPED] + failed[ARITHMETIC] + failed[TRANSPOSED] < 3 * times;
}
