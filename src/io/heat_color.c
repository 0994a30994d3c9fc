/* heat_color.c - a scale of colours for how much.
 *
 * Invariant: equal values are equal bits on every machine.  The scale is a path through CIELAB
 * (white D65) whose lightness L* grows evenly from 0 to 100, so that equal steps look equal and the
 * order survives in grey:
 *
 *     L* = 100 t,  hue = 300 + 155 t degrees,  chroma = 260 t (1 - t)
 *
 * black, violet, red, orange, yellow, white.  The chroma is a little below the largest that the
 * sRGB gamut allows along that path (4 * 67.9 t (1 - t), reached at t = 0.35). */
#include "io/heat_color.h"

#include "core/numerics.h"

/* Inverse of CIELAB's f. */
static double from_lab(double t)
{
    const double knee = 6.0 / 29.0;
    return t > knee ? t * t * t : 3.0 * knee * knee * (t - 4.0 / 29.0);
}

static double clamp_unit(double x) { return !(x > 0.0) ? 0.0 : x < 1.0 ? x : 1.0; }

assay_rgb assay_heat_color(double t)
{
    const double       at     = clamp_unit(t);
    const assay_sincos hue    = assay_sincos_turns((300.0 + 155.0 * at) / 360.0);
    const double       chroma = 260.0 * at * (1.0 - at);
    const double       fy     = (100.0 * at + 16.0) / 116.0;
    const double       x      = 0.95047 * from_lab(fy + chroma * hue.cos / 500.0);
    const double       y      = from_lab(fy);
    const double       z      = 1.08883 * from_lab(fy - chroma * hue.sin / 200.0);
    /* XYZ to linear sRGB (IEC 61966-2-1). */
    return (assay_rgb){clamp_unit(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
                       clamp_unit(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
                       clamp_unit(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}
