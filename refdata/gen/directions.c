/* directions.c - the list.
 *
 * Invariant: the same doubles on every machine: literals, and IEEE operations on integers from a
 * fixed linear congruential sequence. */
#include "directions.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "ref.h"

#define R2 0x1.6a09e667f3bcdp-1           /* double nearest to 1 / sqrt(2) */
#define R3 0x1.279a74590331cp-1           /* 1 / sqrt(3) */
#define COS_HALF_PI 0x1.1a62633145c07p-54 /* cosine of the double nearest to pi / 2 */

static const ref_direction upper_listed[] = {
    /* the pole, within 1e-12 and 1e-6 of it */
    {{0, 0, 1}},
    {{1e-12, 0, 1}},
    {{0, -1e-12, 1}},
    {{-6e-13, 7e-13, 1}},
    {{1e-6, 0, 1}},
    {{-3e-7, 9e-7, 1}},
    /* the horizon: z = 0, the double nearest to pi / 2, within 1e-12 and 1e-6 */
    {{1, 0, 0}},
    {{0, 1, 0}},
    {{-1, 0, 0}},
    {{0, -1, 0}},
    {{0.6, 0.8, 0}},
    {{-R2, R2, 0}},
    {{1, 0, COS_HALF_PI}},
    {{-0.28, 0.96, COS_HALF_PI}},
    {{0, 1, 1e-12}},
    {{0.8, -0.6, 1e-12}},
    {{-1, 0, 1e-6}},
    {{0.6, 0.8, 1e-6}},
    /* planes of symmetry, the cube's diagonal, the middle of the hemisphere's z */
    {{0.6, 0, 0.8}},
    {{0, 0.8, 0.6}},
    {{-R2, 0, R2}},
    {{R3, R3, R3}},
    {{-R3, R3, R3}},
    {{0.5, -0.5, R2}},
    {{0x1.bb67ae8584caap-1, 0, 0.5}},
};

static const ref_direction lower_listed[] = {
    {{0, 0, -1}},           {{1e-12, 0, -1}},       {{-6e-13, 7e-13, -1}},
    {{3e-7, -9e-7, -1}},    {{1, 0, -COS_HALF_PI}}, {{0.6, -0.8, -1e-12}},
    {{-0.28, 0.96, -1e-6}}, {{R3, -R3, -R3}},       {{0, 0.6, -0.8}},
};

#define COUNT(a) ((int)(sizeof(a) / sizeof((a)[0])))
#define RANDOM_UPPER 15
#define RANDOM_LOWER 11

/* In [-1, 1), 31 bits. */
static double next_number(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 33) * 0x1p-30 - 1.0;
}

static ref_direction random_direction(uint64_t *state, int sign)
{
    for (;;) {
        const double x = next_number(state), y = next_number(state), z = next_number(state);
        const double squared = (x * x + y * y) + z * z;
        if (squared < 1.0 && squared > 0.01 && z != 0.0) {
            const double r = sqrt(squared);
            return (ref_direction){{x / r, y / r, sign * fabs(z) / r}};
        }
    }
}

ref_direction *ref_directions(int *count_out, int *upper_out)
{
    const int upper = COUNT(upper_listed) + RANDOM_UPPER;
    const int count = upper + COUNT(lower_listed) + RANDOM_LOWER;
    uint64_t  state = 2006;

    ref_direction *all = ref_allocate((size_t)count, sizeof *all), *next = all;
    memcpy(next, upper_listed, sizeof upper_listed);
    next += COUNT(upper_listed);
    for (int i = 0; i < RANDOM_UPPER; i++) {
        *next++ = random_direction(&state, 1);
    }
    memcpy(next, lower_listed, sizeof lower_listed);
    next += COUNT(lower_listed);
    for (int i = 0; i < RANDOM_LOWER; i++) {
        *next++ = random_direction(&state, -1);
    }
    *count_out = count;
    *upper_out = upper;
    return all;
}

ref_direction *ref_few_directions(int *count_out)
{
    static const int chosen[] = {0, 1, 4, 5, 6, 10, 12, 15, 17, 18, 21, 23};
    const int        random   = 6;

    int            all_count, upper;
    ref_direction *all = ref_directions(&all_count, &upper);
    ref_direction *few = ref_allocate((size_t)(COUNT(chosen) + random), sizeof *few);
    for (int i = 0; i < COUNT(chosen); i++) {
        few[i] = all[chosen[i]];
    }
    memcpy(few + COUNT(chosen), all + COUNT(upper_listed), (size_t)random * sizeof *few);
    free(all);
    *count_out = COUNT(chosen) + random;
    return few;
}

ref_direction *ref_gradient_directions(int *count_out, int *hemisphere_out)
{
    static const int chosen[] = {0, 1, 5, 13, 15, 17, 18, 19};
    const int        random   = 4;

    int            all_count, upper;
    ref_direction *all  = ref_directions(&all_count, &upper);
    ref_direction *some = ref_allocate((size_t)(COUNT(chosen) + random + 4), sizeof *some);
    ref_direction *next = some;
    for (int i = 0; i < COUNT(chosen); i++) {
        *next++ = all[chosen[i]];
    }
    for (int i = 0; i < random; i++) {
        *next++ = all[COUNT(upper_listed) + i];
    }
    *hemisphere_out = (int)(next - some);
    *next++         = all[6];         /* on the horizon   */
    *next++         = all[upper];     /* the other pole   */
    *next++         = all[upper + 2]; /* close to it      */
    *next++         = all[upper + COUNT(lower_listed)];
    free(all);
    *count_out = (int)(next - some);
    return some;
}
