/* sobol.h - points of the unit square that leave no part of it out for long.
 *
 * The first two coordinates of Sobol's sequence, a (0, 2)-sequence in base 2 [kollig02]: of the
 * points k 2^m ... (k + 1) 2^m - 1 each lies in a rectangle of its own for every division of the
 * square into 2^m equal rectangles by powers of 2.  Owen's scrambling of values and of the order,
 * by hashing [laine11] [burley20], keeps that, makes each point uniform, and makes sequences of
 * different seeds independent of one another. */
#ifndef ASSAY_MATH_SOBOL_H
#define ASSAY_MATH_SOBOL_H

#include <stdint.h>

#include "math/sampling.h"

static inline uint32_t sobol_reverse(uint32_t x)
{
    x = (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
    x = (x & 0x00ff00ffu) << 8 | (x >> 8 & 0x00ff00ffu);
    return x << 16 | x >> 16;
}

/* A permutation in which a bit depends on the seed and on the bits above it alone; constants from
 * [burley20]. */
static inline uint32_t sobol_scramble(uint32_t x, uint32_t seed)
{
    x = sobol_reverse(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return sobol_reverse(x);
}

/* The second coordinate of the point whose first is x: Pascal's triangle modulo 2, which is the
 * sequence's matrix, in five steps. */
static inline uint32_t sobol_second(uint32_t x)
{
    x ^= x << 1 & 0xaaaaaaaau;
    x ^= x << 2 & 0xccccccccu;
    x ^= x << 4 & 0xf0f0f0f0u;
    x ^= x << 8 & 0xff00ff00u;
    return x ^ x << 16;
}

/* Point number `index` of the sequence of two seeds, both coordinates in [0, 1). */
static inline assay_point2 sobol_point(uint32_t index, uint64_t values, uint32_t order)
{
    const uint32_t first = sobol_reverse(sobol_scramble(index, order));
    return (assay_point2){
        0x1p-32 * sobol_scramble(first, (uint32_t)(values >> 32)),
        0x1p-32 * sobol_scramble(sobol_second(first), (uint32_t)values),
    };
}

#endif
