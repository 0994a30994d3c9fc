/* near.h - assert_near: two doubles within an absolute tolerance; NaN is never near. */
#ifndef ASSAY_TESTS_NEAR_H
#define ASSAY_TESTS_NEAR_H

#include <math.h>

#define assert_near(value, expected, tolerance)                                                    \
    do {                                                                                           \
        const double near_v = (value), near_e = (expected), near_t = (tolerance);                  \
        if (!(fabs(near_v - near_e) <= near_t)) {                                                  \
            fail_msg(#value " is %.17g, not %.17g within %g", near_v, near_e, near_t);             \
        }                                                                                          \
    } while (0)

#endif
