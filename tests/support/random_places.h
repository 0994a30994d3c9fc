/* random_places.h - numbers, places and directions drawn at random, and a context to use them with.
 */
#ifndef ASSAY_TESTS_RANDOM_PLACES_H
#define ASSAY_TESTS_RANDOM_PLACES_H

#include "core/random.h"
#include "math/vec.h"

/* For cmocka: *state is a context. */
int context_set_up(void **state);
int context_tear_down(void **state);

/* In [low, high). */
double random_in(assay_random *random, double low, double high);

/* In the cube [low, high)^3. */
assay_vec3 random_box(assay_random *random, double low, double high);

/* A unit vector, not uniform. */
assay_vec3 random_unit(assay_random *random);

#endif
