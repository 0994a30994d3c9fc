/* test_stage_meaning.c - what rows of coefficients that are wrong could mean. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "oracle/stage_meaning.h"

enum { ROWS = 4, THIRD = 4, COLUMNS = 3 * THIRD, VALUES = ROWS * COLUMNS };

static double right_at(size_t row, size_t channel, size_t k)
{
    return (double)((7 * row + 5 * channel + 3 * k * k) % 11) - 4.0;
}

/* R for B, block by block; and values of which no theory holds. */
static void test_blocks(void **state)
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
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_blocks)};
    return cmocka_run_group_tests_name("stage_meaning", tests, NULL, NULL);
}
