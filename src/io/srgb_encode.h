/* srgb_encode.h - linear light to sRGB. */
#ifndef ASSAY_IO_SRGB_ENCODE_H
#define ASSAY_IO_SRGB_ENCODE_H

#include <stdint.h>

/* The sRGB curve (IEC 61966-2-1) of a value clamped to [0, 1]; NaN is 0. */
double assay_srgb_encode(double linear);

/* The code nearest to 255 times that. */
uint8_t assay_srgb_encode8(double linear);

#endif
