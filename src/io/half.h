/* half.h - 16-bit floats, exactly. */
#ifndef ASSAY_IO_HALF_H
#define ASSAY_IO_HALF_H

#include <stdint.h>

/* The bits of the float that equals a half (IEEE 754 binary16); a NaN keeps sign and payload, which
 * processors' own conversions do not all promise. */
static inline uint32_t assay_half_to_float_bits(uint16_t half)
{
    const uint32_t sign     = (uint32_t)(half & 0x8000u) << 16;
    const uint32_t exponent = half >> 10 & 31u;
    uint32_t       fraction = half & 1023u;
    if (exponent == 31) {
        return sign | 0x7f800000u | fraction << 13;
    }
    if (exponent != 0) {
        return sign | (exponent + 112) << 23 | fraction << 13;
    }
    if (fraction == 0) {
        return sign;
    }
    /* Subnormal: fraction * 2^-24; every one of them is a normal float. */
    uint32_t shifted = 113;
    while (!(fraction & 1024u)) {
        fraction <<= 1;
        shifted--;
    }
    return sign | shifted << 23 | (fraction & 1023u) << 13;
}

#endif
