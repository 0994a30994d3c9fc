/* test_tile_filter.c - convolutions against sums in long double, and the same bits by all vectors.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/random.h"
#include "oracle/metrics/tile_filter.h"
#include "support/near.h"

enum { WIDTH = 37, RADIUS = 7, STRIDE = WIDTH + 2 * RADIUS, ROWS = 2 * RADIUS + 1 };

static double uniform(uint64_t item)
{
    assay_random random = assay_random_start(3, ASSAY_STAGE_TEST, item, 0);
    return 2.0 * assay_random_next(&random) - 1.0;
}

static assay_kernel random_kernel(int radius, bool odd)
{
    assay_kernel kernel = {.radius = radius, .odd = odd};
    for (int k = odd; k <= radius; k++) {
        kernel.weights[k] = uniform(1000 + (uint64_t)k);
    }
    return kernel;
}

static void fill(double block[ROWS * STRIDE])
{
    for (uint64_t i = 0; i < ROWS * STRIDE; i++) {
        block[i] = uniform(i);
    }
}

static long double exact(const assay_kernel *kernel, const double *at, int step)
{
    long double sum = 0.0L;
    for (int k = -kernel->radius; k <= kernel->radius; k++) {
        const long double w = kernel->weights[k < 0 ? -k : k];
        sum += (kernel->odd && k < 0 ? -w : w) * at[k * step];
    }
    return sum;
}

/* Radii of both parities, and none. */
static void sums_are_right(void **state)
{
    double block[ROWS * STRIDE], out[WIDTH];
    (void)state;
    fill(block);
    for (int i = 0; i < 16; i++) {
        const assay_kernel kernel = random_kernel(i / 2, i % 2);
        const double      *middle = block + RADIUS * STRIDE + RADIUS;
        for (int down = 0; down < 2; down++) {
            if (down) {
                assay_filter_down(&kernel, middle, STRIDE, WIDTH, out);
            } else {
                assay_filter_along(&kernel, middle, STRIDE, WIDTH, 1, out, WIDTH);
            }
            for (int x = 0; x < WIDTH; x++) {
                assert_near(out[x], (double)exact(&kernel, middle + x, down ? STRIDE : 1), 1e-14);
            }
        }
    }
}

/* Nothing outside the taps is read, and nothing beyond the width written. */
static void rows_keep_their_places(void **state)
{
    double block[ROWS * STRIDE], out[3 * STRIDE];
    (void)state;
    fill(block);
    for (int i = 0; i < 3 * STRIDE; i++) {
        out[i] = 7.0;
    }
    const assay_kernel kernel = random_kernel(RADIUS, false);
    assay_filter_along(&kernel, block + RADIUS, STRIDE, WIDTH, 3, out, STRIDE);
    for (int y = 0; y < 3; y++) {
        for (int x = 0; x < STRIDE; x++) {
            const double *at = block + y * STRIDE + RADIUS + x;
            assert_near(out[y * STRIDE + x], x < WIDTH ? (double)exact(&kernel, at, 1) : 7.0,
                        1e-14);
        }
    }
}

static void all_vectors_give_the_same_bits(void **state)
{
    double block[ROWS * STRIDE], wide[WIDTH], pair[WIDTH];
    (void)state;
    if (!assay_filter_has_wide()) {
        skip();
    }
    fill(block);
    for (int i = 0; i < 16; i++) {
        const assay_kernel kernel = random_kernel(i / 2, i % 2);
        const double      *middle = block + RADIUS * STRIDE + RADIUS;
        assay_filter_row_pair(&kernel, middle, STRIDE, WIDTH, pair);
        assay_filter_row_wide(&kernel, middle, STRIDE, WIDTH, wide);
        assert_memory_equal(pair, wide, sizeof pair);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_are_right),
                                       cmocka_unit_test(rows_keep_their_places),
                                       cmocka_unit_test(all_vectors_give_the_same_bits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
