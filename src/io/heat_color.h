/* heat_color.h - the colour scale of differences. */
#ifndef ASSAY_IO_HEAT_COLOR_H
#define ASSAY_IO_HEAT_COLOR_H

#include "assay/types.h"

/* Linear sRGB of a value on the scale, clamped to [0, 1]; NaN is 0: black, violet, red, orange,
 * yellow, white, of evenly growing CIELAB lightness. */
assay_rgb assay_heat_color(double t);

#endif
