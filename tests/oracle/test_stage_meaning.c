/* test_stage_meaning.c - what a wrong array looks like, by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "oracle/stage/stage_meaning.h"

enum { COUNT = 9 };

/* words "": nothing is guessed. */
static void expect(const double *values, const double *right, const char *words)
{
    char said[256];
    stage_meaning(COUNT, COUNT, values, right, said, sizeof said);
    if (*words ? !strstr(said, words) : *said) {
        fail_msg("'%s' does not say '%s'", said, words);
    }
}

static void guesses(void **state)
{
    static const double right[COUNT]      = {1, -2, 3, 4, 5, 6, 7, 8, 9};
    static const double reversed[COUNT]   = {3, -2, 1, 6, 5, 4, 9, 8, 7};
    static const double transposed[COUNT] = {1, 4, 7, -2, 5, 8, 3, 6, 9};
    double              larger[COUNT], negative[COUNT], one[COUNT];
    for (int i = 0; i < COUNT; i++) {
        larger[i]   = 1.25 * right[i];
        negative[i] = -right[i];
        one[i]      = right[i] + (i == 3 ? 0.5 : 0.0);
    }
    expect(larger, right, "All values are 1.25 times");
    expect(negative, right, "wrong sign");
    expect(reversed, right, "first and the third");
    expect(transposed, right, "Vectors of channels");
    expect(one, right, "");
    (void)state;
}

/* Weights of records at their own places, rounded to float, beside weights that are wrong. */
static void large_values_hide_nothing(void **state)
{
    static const double right[COUNT]  = {1e12, 2, 3, 1e12, 5, 6, 7, 8, 9};
    double              values[COUNT] = {0};
    for (int i = 0; i < COUNT; i++) {
        values[i] = i % 3 == 0 ? (double)(float)right[i] : right[i] + 0.25;
    }
    expect(values, right, "");
    (void)state;
}

enum { ROWS = 4, THIRD = 4, COLUMNS = 3 * THIRD, VALUES = ROWS * COLUMNS };

static double right_at(size_t row, size_t channel, size_t k)
{
    return (double)((7 * row + 5 * channel + 3 * k * k) % 11) - 4.0;
}

/* R for B, block by block; and values of which no theory holds. */
static void blocks(void **state)
{
    double right[VALUES], swapped[VALUES];
    char   words[256];
    (void)state;
    for (size_t i = 0; i < VALUES; i++) {
        const size_t row = i / COLUMNS, channel = i % COLUMNS / THIRD, k = i % THIRD;
        right[i]   = right_at(row, channel, k);
        swapped[i] = right_at(row, 2 - channel, k);
    }
    stage_meaning(COLUMNS, VALUES, swapped, right, words, sizeof words);
    assert_non_null(strstr(words, "first and the last third"));
    swapped[5] += 1.0;
    stage_meaning(COLUMNS, VALUES, swapped, right, words, sizeof words);
    assert_null(strstr(words, "third"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(guesses),
        cmocka_unit_test(large_values_hide_nothing),
        cmocka_unit_test(blocks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
