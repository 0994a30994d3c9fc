/* srgb_encode.h - linear light to 8-bit sRGB. */
#ifndef ASSAY_IO_SRGB_ENCODE_H
#define ASSAY_IO_SRGB_ENCODE_H

#include <stdint.h>

/* The code nearest to the sRGB curve (IEC 61966-2-1) of a value clamped to [0, 1]; NaN is 0. */
uint8_t assay_srgb_encode8(double linear);

#endif
