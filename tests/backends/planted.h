/* planted.h - the mistakes that test_backends.sh compiles in, one at a time: -DPLANTED=NAME.
 *
 * mutations.txt says of each where it is and which stage must find it.  All branches are compiled
 * always; without the flag none is taken. */
#ifndef BACKEND_PLANTED_H
#define BACKEND_PLANTED_H

enum {
    NOTHING,
    HALF_PIXEL,
    PIXEL_SHIFTED,
    ROWS_FROM_BELOW,
    DEPTH_ALONG_RAY,
    COSINE_TWICE,
    ROTATION_FLIPPED,
    FARTHER_SIDE,
    ARITHMETIC_MEAN,
    SQRT_LEFT_OUT,
    RADIUS_DOUBLED,
    RADIUS_ROUGH,
    THRESHOLD_INVERTED,
    IN_FRONT_DROPPED,
    ROTATION_SIGN,
    TRANSLATION_SIGN,
    CHANNELS_SWAPPED,
    RELATIVE_GRADIENTS,
    CLAMP_DROPPED,
    ALL_AT_ONE_WEIGHT,
    ALBEDO_ENCODED,
    DOUBLE_SPLAT,
    RECORD_LEFT_OUT,
    PI_LEFT_OUT,
    PI_ROUGH,
    REACH_TOO_SHORT,
    HALF_FLOAT_SUMS,
    NOT_NORMALISED,
    DIRECT_LEFT_OUT,
    HIGHLIGHTS_CLAMPED,
    ZONAL_NORM,
    CONDON_SHORTLEY,
    HEMISPHERE_NOT_SHIFTED,
    SOLID_ANGLE_LEFT_OUT,
    SIGN_OF_SINES,
    CONVERSION_TRANSPOSED,
    TURN_TRANSPOSED,
    TURN_BACKWARDS,
    ANGLE_ROUGH,
    COEFFICIENTS_BY_FUNCTION
};

#ifndef PLANTED
#define PLANTED NOTHING
#endif

#define IS_PLANTED(name) (PLANTED == (name))

#endif
