/* flip_judge.h - FLIP by its definition: two-dimensional kernels, XYZ, YCxCz and CIELAB as the
 * papers have them, in long double.  Slow, and sharing nothing with src/oracle. */
#ifndef ASSAY_TESTS_FLIP_JUDGE_H
#define ASSAY_TESTS_FLIP_JUDGE_H

typedef struct {
    long double v[3];
} judge_color;

/* Three planes of width * height; sRGB-linear light in [0, 1]. */
typedef struct {
    int                width, height;
    const judge_color *pixels;
} judge_picture;

/* The error of one pixel; ppd: pixels per degree. */
long double judge_flip(const judge_picture *a, const judge_picture *b, double ppd, int x, int y);

/* The error of two colours that fill the picture. */
long double judge_flip_constant(judge_color a, judge_color b);

/* The tone mappers of HDR-FLIP: "aces", "hable", "reinhard"; of values that are not negative. */
judge_color judge_tone_map(const char *mapper, judge_color c);

#endif
