/* test_report_pack.c - packed pictures, unpacked by a second reader: within half a step everywhere,
 * whatever the values, and within the budget where that can be. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <zlib.h>

#include "core/random.h"
#include "oracle/report/report_pack.h"
#include "support/failing_context.h"
#include "support/random_places.h"

static const int FINE[] = {256, 128, 64, 32, 16, 0};

/* One residual: unfolded, and added to the median of left, above, and left + above - corner. */
static int median(int a, int b, int c)
{
    const int low = a < b ? a : b, high = a < b ? b : a;
    return c < low ? low : c > high ? high : c;
}

static void unpack_plane(const uint8_t *low, const uint8_t *high, int width, int height,
                         int16_t *codes)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            const int i      = y * width + x;
            const int word   = low[i] + 256 * high[i];
            const int error  = word % 2 ? -(word + 1) / 2 : word / 2;
            const int left   = x ? codes[i - 1] : y ? codes[i - width] : 0;
            const int above  = y ? codes[i - width] : left;
            const int corner = x && y ? codes[i - width - 1] : above;
            codes[i]         = (int16_t)(median(left, above, left + above - corner) + error);
        }
    }
}

static double value_of(const assay_report_pack *pack, int code)
{
    if (code == ASSAY_PACK_NAN) {
        return NAN;
    }
    if (abs(code) == ASSAY_PACK_INFINITE) {
        return code < 0 ? -HUGE_VAL : HUGE_VAL;
    }
    return copysign(pack->floor * (pow(2.0, fabs((double)code) / pack->steps) - 1.0), code);
}

static void check_value(const assay_report_pack *pack, float value, double back)
{
    const double half = (pow(2.0, 0.5 / pack->steps) - 1.0) * (1.0 + 1e-3);
    if (isnan(value)) {
        assert_true(isnan(back));
    } else if (isinf(value)) {
        assert_true(back == (double)value);
    } else {
        assert_true(fabs(back - (double)value) <= half * (fabs((double)value) + pack->floor));
        assert_true(back == 0.0 || (back < 0.0) == (value < 0.0F));
    }
}

static void check_pack(const assay_report_pack *pack, const float *const *values)
{
    const size_t pixels = (size_t)pack->width * (size_t)pack->height;
    const size_t planes = (size_t)pack->planes;
    uLongf       size   = 2 * planes * pixels;
    uint8_t     *bytes  = malloc(size);
    int16_t     *codes  = malloc(planes * pixels * sizeof *codes);
    assert_int_equal(uncompress(bytes, &size, pack->bytes, pack->count), Z_OK);
    assert_int_equal(size, 2 * planes * pixels);
    for (size_t p = 0; p < planes; p++) {
        unpack_plane(bytes + p * pixels, bytes + (planes + p) * pixels, pack->width, pack->height,
                     codes + p * pixels);
    }
    for (size_t i = 0; i < pixels; i++) {
        const int16_t green = codes[i];
        if (planes == 1) {
            check_value(pack, values[0][i], value_of(pack, green));
        } else {
            check_value(pack, values[1][i], value_of(pack, green));
            check_value(pack, values[0][i], value_of(pack, (int16_t)(codes[pixels + i] + green)));
            check_value(pack, values[2][i],
                        value_of(pack, (int16_t)(codes[2 * pixels + i] + green)));
        }
    }
    free(bytes);
    free(codes);
}

enum { WIDTH = 61, HEIGHT = 37, PIXELS = WIDTH * HEIGHT };

static void fill(float *plane, int kind, uint64_t seed)
{
    assay_random random = assay_random_start(seed, 0, 0, 0);
    for (int i = 0; i < PIXELS; i++) {
        const double u = random_in(&random, -1.0, 1.0), v = random_in(&random, 0.0, 1.0);
        plane[i] = (float)(kind == 0   ? 0.0
                           : kind == 1 ? (i % WIDTH) / 60.0
                           : kind == 2 ? u
                           : kind == 3 ? pow(10.0, 30.0 * u)
                           : v < 0.1   ? NAN
                           : v < 0.2   ? copysign(HUGE_VAL, u)
                           : v < 0.4   ? 0.0
                                       : u * u * u);
    }
}

static void test_round_trip(void **state)
{
    static const int sizes[][2] = {{WIDTH, HEIGHT}, {1, 1}, {1, HEIGHT}, {PIXELS, 1}};
    float            planes[3][PIXELS];
    const float     *values[3] = {planes[0], planes[1], planes[2]};
    for (int kind = 0; kind < 5; kind++) {
        for (int p = 0; p < 3; p++) {
            fill(planes[p], kind, (uint64_t)(10 * kind + p));
        }
        for (size_t s = 0; s < 4; s++) {
            for (int count = 1; count <= 3; count += 2) {
                assay_report_pack pack;
                /* of 60 decades only 38 fit the largest code above a floor this low */
                const double floor = kind == 3 ? 1e10 : 0x1p-20;
                assert_int_equal(assay_report_pack_create(*state, sizes[s][0], sizes[s][1], count,
                                                          values, floor, FINE, SIZE_MAX, &pack),
                                 ASSAY_OK);
                assert_int_equal(pack.steps, 256);
                check_pack(&pack, values);
                assay_report_pack_release(*state, &pack);
            }
        }
    }
}

static void test_budget(void **state)
{
    float        plane[PIXELS];
    const float *values[1] = {plane};
    size_t       before    = SIZE_MAX;
    fill(plane, 2, 5);
    for (int i = 0; FINE[i]; i++) {
        /* Where just so much is allowed, just that step is taken; and coarser is smaller. */
        const int         one[] = {FINE[i], 0};
        assay_report_pack alone, of_all;
        assert_int_equal(
            assay_report_pack_create(*state, WIDTH, HEIGHT, 1, values, 1e-3, one, 0, &alone),
            ASSAY_OK);
        assert_int_equal(assay_report_pack_create(*state, WIDTH, HEIGHT, 1, values, 1e-3, FINE,
                                                  alone.count, &of_all),
                         ASSAY_OK);
        assert_int_equal(alone.steps, FINE[i]);
        assert_true(of_all.count <= alone.count);
        assert_true(of_all.steps <= FINE[i] && 2 * of_all.steps >= FINE[i]);
        assert_true(alone.count < before);
        before = alone.count;
        check_pack(&alone, values);
        assay_report_pack_release(*state, &alone);
        assay_report_pack_release(*state, &of_all);
    }
    assay_report_pack nothing;
    assert_int_equal(
        assay_report_pack_create(*state, WIDTH, HEIGHT, 1, values, 1e-3, FINE, 1, &nothing),
        ASSAY_OK);
    assert_int_equal(nothing.steps, 16);
    check_pack(&nothing, values);
    assay_report_pack_release(*state, &nothing);
}

/* What is even is small: prediction and the order of bytes are worth their while. */
static void test_small(void **state)
{
    float             plane[PIXELS];
    const float      *values[3] = {plane, plane, plane};
    assay_report_pack pack;
    fill(plane, 1, 0);
    assert_int_equal(
        assay_report_pack_create(*state, WIDTH, HEIGHT, 3, values, 0x1p-20, FINE, SIZE_MAX, &pack),
        ASSAY_OK);
    assert_true(pack.count < PIXELS / 4);
    assay_report_pack_release(*state, &pack);
}

static assay_status work(assay_context *context, void *user)
{
    const float       *values[1] = {user};
    assay_report_pack  pack;
    const assay_status status =
        assay_report_pack_create(context, WIDTH, HEIGHT, 1, values, 1.0, FINE, SIZE_MAX, &pack);
    if (status == ASSAY_OK) {
        assay_report_pack_release(context, &pack);
    }
    return status;
}

static void test_memory(void **state)
{
    float plane[PIXELS];
    (void)state;
    fill(plane, 2, 1);
    assert_true(failing_each(work, plane) >= 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_round_trip, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_budget, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_small, context_set_up, context_tear_down),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
