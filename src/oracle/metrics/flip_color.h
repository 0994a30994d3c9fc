/* flip_color.h - the colour spaces and the colour difference of FLIP; private to oracle. */
#ifndef ASSAY_ORACLE_FLIP_COLOR_H
#define ASSAY_ORACLE_FLIP_COLOR_H

#include "assay/types.h"

/* Opponent coordinates: y is luminance, c and z are red-green and blue-yellow: X / Xn - Y / Yn and
 * Y / Yn - Z / Zn of the white point n.  (YCxCz of [andersson20] is 116 y - 16, 500 c, 200 z;
 * filters whose weights sum to 1 do not see these factors.) */
typedef struct {
    double y, c, z;
} assay_opponent;

typedef struct {
    double to_white[3][3];   /* linear RGB to X / Xn, Y / Yn, Z / Zn: rows sum to 1            */
    double from_white[3][3]; /* the inverse                                                   */
    double log_knee;         /* of the distance^0.7 where the scale of errors bends            */
    double log_knee_value;   /* of the error there                                            */
    double largest;          /* distance^0.7 of the farthest colours, green and blue          */
} assay_flip_colors;

assay_flip_colors assay_flip_colors_make(void);

assay_opponent assay_flip_opponent(const assay_flip_colors *colors, assay_rgb linear);

/* HyAB distance of two colours that the eye's filters have gone over, and Hunt's effect. */
double assay_flip_color_distance(const assay_flip_colors *colors, assay_opponent a,
                                 assay_opponent b);

/* Delta E of [andersson20], 0 to 1: colour distance and feature difference Delta E_f as one. */
double assay_flip_error(const assay_flip_colors *colors, double distance, double feature);

#endif
