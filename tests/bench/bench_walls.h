/* bench_walls.h - places on the walls of a unit cube, where benches of records put theirs. */
#ifndef ASSAY_TESTS_BENCH_WALLS_H
#define ASSAY_TESTS_BENCH_WALLS_H

#include <math.h>

#include "core/numerics.h"
#include "core/random.h"
#include "math/vec.h"

typedef struct {
    assay_vec3 position, normal; /* the normal looks in */
} bench_site;

static inline bench_site bench_random_site(assay_random *random)
{
    const double u    = assay_random_next(random);
    const double v    = assay_random_next(random);
    const double wall = 6.0 * assay_random_next(random);
    const double at = (int)wall % 2, in = 1.0 - 2.0 * at;
    switch ((int)wall / 2) {
    case 0: return (bench_site){vec3(at, u, v), vec3(in, 0.0, 0.0)};
    case 1: return (bench_site){vec3(u, at, v), vec3(0.0, in, 0.0)};
    default: return (bench_site){vec3(u, v, at), vec3(0.0, 0.0, in)};
    }
}

/* The R with which a disc of a R on the walls holds `wanted` of `count` records on the average. */
static inline double bench_record_radius(uint32_t count, double a, double wanted)
{
    return sqrt(wanted * 6.0 / (ASSAY_PI * count)) / a;
}

#endif
