/* stage_meaning.c - guesses, none of which changes a verdict.
 *
 * A guess counts where it leaves a thousandth of the difference that is to be explained (by sums of
 * squares), so that a few values that are wrong by themselves make no theory. */
#include "oracle/stage/stage_meaning.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

static const double EXPLAINED = 1e-6;

typedef struct {
    double wrong, left; /* squares of value - right, and of what a guess leaves of it */
} misfit;

static void add(misfit *m, double value, double right, double guess)
{
    if (isfinite(value) && isfinite(right) && isfinite(guess)) {
        m->wrong += (value - right) * (value - right);
        m->left += (value - guess) * (value - guess);
    }
}

static bool explains(const misfit *m) { return m->wrong > 0.0 && m->left <= EXPLAINED * m->wrong; }

/* The best common factor. */
static double factor_of(size_t count, const double *values, const double *right)
{
    double both = 0.0, square = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (isfinite(values[i]) && isfinite(right[i])) {
            both += values[i] * right[i];
            square += right[i] * right[i];
        }
    }
    return square > 0.0 ? both / square : NAN;
}

/* It must explain the parts as well as the whole: the last places of one weight of 1e12 outweigh
 * all that is wrong elsewhere. */
static bool is_factor(size_t count, const double *values, const double *right, double factor)
{
    misfit whole = {0.0, 0.0}, parts = {0.0, 0.0};
    for (size_t i = 0; i < count; i++) {
        add(&whole, values[i], right[i], factor * right[i]);
        if (right[i] != 0.0) {
            add(&parts, values[i] / right[i], 1.0, factor);
        }
    }
    return explains(&whole) && explains(&parts);
}

/* Columns in threes, the first of three for the last. */
static bool is_reversed(size_t columns, size_t count, const double *values, const double *right)
{
    misfit m = {0.0, 0.0};
    for (size_t i = 0; columns % 3 == 0 && i < count; i++) {
        const size_t of_three = i % 3;
        add(&m, values[i], right[i], right[i - of_three + (2 - of_three)]);
    }
    return explains(&m);
}

/* Columns in three blocks, the first for the last. */
static bool is_swapped(size_t columns, size_t count, const double *values, const double *right)
{
    const size_t third = columns / 3;
    misfit       m     = {0.0, 0.0};
    for (size_t i = 0; columns % 3 == 0 && third > 1 && i < count; i++) {
        const size_t block = i % columns / third;
        add(&m, values[i], right[i], right[i - block * third + (2 - block) * third]);
    }
    return explains(&m);
}

/* Columns of three vectors: x y z of R, G, B for R G B of x, y, z. */
static bool is_transposed(size_t columns, size_t count, const double *values, const double *right)
{
    misfit m = {0.0, 0.0};
    for (size_t i = 0; columns == 9 && i < count; i++) {
        const size_t at = i % 9;
        add(&m, values[i], right[i], right[i - at + 3 * (at % 3) + at / 3]);
    }
    return explains(&m);
}

void stage_meaning(size_t columns, size_t count, const double *values, const double *right,
                   char *words, size_t size)
{
    const double factor = factor_of(count, values, right);
    words[0]            = '\0';
    if (isfinite(factor) && is_factor(count, values, right, factor)) {
        if (fabs(factor + 1.0) < 1e-3) {
            snprintf(words, size, " All values have the wrong sign.");
        } else {
            snprintf(words, size, " All values are %.6g times what they should be.", factor);
        }
    } else if (is_reversed(columns, count, values, right)) {
        snprintf(words, size, " The first and the third of every three columns are exchanged.");
    } else if (is_swapped(columns, count, values, right)) {
        snprintf(words, size, " The first and the last third of the columns are exchanged.");
    } else if (is_transposed(columns, count, values, right)) {
        snprintf(words, size, " Vectors of channels and channels of vectors are exchanged.");
    }
}
