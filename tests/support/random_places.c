/* random_places.c - never two random numbers in one expression: their order would be the
 * compiler's.
 */
#include "random_places.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "assay/context.h"

int context_set_up(void **state)
{
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    *state = context;
    return 0;
}

int context_tear_down(void **state)
{
    assay_context_destroy(*state);
    return 0;
}

double random_in(assay_random *random, double low, double high)
{
    return low + (high - low) * assay_random_next(random);
}

assay_vec3 random_box(assay_random *random, double low, double high)
{
    const double x = random_in(random, low, high);
    const double y = random_in(random, low, high);
    return vec3(x, y, random_in(random, low, high));
}

assay_vec3 random_unit(assay_random *random)
{
    return vec3_normalize(vec3_add(random_box(random, -1.0, 1.0), vec3(1e-3, 0.0, 0.0)));
}
