/* float_sort.c - by digits of their bits: floats that are not negative are in the order of them as
 * whole numbers.
 *
 * Invariant: after pass p the values are in the order of their lowest 11 (p + 1) bits. */
#include "oracle/metrics/float_sort.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, PASSES = 3 };

static uint32_t digit_of(float value, int pass)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >> (pass * DIGIT_BITS) & (DIGITS - 1);
}

static void sort_pass(const float *from, float *to, size_t count, int pass, size_t *starts)
{
    size_t start = 0;
    memset(starts, 0, DIGITS * sizeof *starts);
    for (size_t i = 0; i < count; i++) {
        starts[digit_of(from[i], pass)]++;
    }
    for (int d = 0; d < DIGITS; d++) {
        const size_t here = starts[d];
        starts[d]         = start;
        start += here;
    }
    for (size_t i = 0; i < count; i++) {
        to[starts[digit_of(from[i], pass)]++] = from[i];
    }
}

assay_status assay_float_sort(assay_context *context, float *values, size_t count)
{
    size_t       starts[DIGITS];
    float       *other  = assay_allocate(context, count, sizeof *other);
    float *const rows[] = {values, other, values, other};
    if (!other) {
        return assay_fail_memory(context, "sorting a picture");
    }
    for (int pass = 0; pass < PASSES; pass++) {
        sort_pass(rows[pass], rows[pass + 1], count, pass, starts);
    }
    memcpy(values, other, count * sizeof *values);
    assay_release(context, other);
    return ASSAY_OK;
}
