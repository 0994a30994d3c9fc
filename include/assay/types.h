/* types.h - the small values that every other header speaks of.
 *
 * Units are SI, angles radians.  Directions point away from the surface.  World frame:
 * right-handed, +Y up, as in glTF.  Radiance is linear RGB (Rec. 709 primaries) in W/(m2 sr),
 * irradiance W/m2. */
#ifndef ASSAY_TYPES_H
#define ASSAY_TYPES_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    double x, y, z;
} assay_vec3;

typedef struct {
    double r, g, b;
} assay_rgb;

#ifdef __cplusplus
}
#endif
#endif
