/* flip_judge.c - one pixel at a time, from the definitions. */
#include "flip_judge.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define PI 3.14159265358979323846264338327950288L

static const long double RGB_TO_XYZ[3][3] = {
    {10135552.0L / 24577794.0L, 8788810.0L / 24577794.0L, 4435075.0L / 24577794.0L},
    {2613072.0L / 12288897.0L, 8788810.0L / 12288897.0L, 887015.0L / 12288897.0L},
    {1425312.0L / 73733382.0L, 8788810.0L / 73733382.0L, 70074185.0L / 73733382.0L}};

static judge_color to_xyz(judge_color rgb)
{
    judge_color out;
    for (int i = 0; i < 3; i++) {
        out.v[i] = 0.0L;
        for (int k = 0; k < 3; k++) {
            out.v[i] += RGB_TO_XYZ[i][k] * rgb.v[k];
        }
    }
    return out;
}

static long double white(int i) { return RGB_TO_XYZ[i][0] + RGB_TO_XYZ[i][1] + RGB_TO_XYZ[i][2]; }

/* Cramer's rule. */
static long double determinant(const long double m[3][3])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

static judge_color from_xyz(judge_color xyz)
{
    judge_color out;
    for (int k = 0; k < 3; k++) {
        long double m[3][3];
        memcpy(m, RGB_TO_XYZ, sizeof m);
        for (int i = 0; i < 3; i++) {
            m[i][k] = xyz.v[i];
        }
        out.v[k] = determinant(m) / determinant(RGB_TO_XYZ);
    }
    return out;
}

static judge_color to_ycxcz(judge_color rgb)
{
    const judge_color xyz = to_xyz(rgb);
    const long double x = xyz.v[0] / white(0), y = xyz.v[1] / white(1), z = xyz.v[2] / white(2);
    return (judge_color){{116.0L * y - 16.0L, 500.0L * (x - y), 200.0L * (y - z)}};
}

static judge_color from_ycxcz(judge_color c)
{
    const long double y   = (c.v[0] + 16.0L) / 116.0L;
    const judge_color xyz = {
        {(y + c.v[1] / 500.0L) * white(0), y * white(1), (y - c.v[2] / 200.0L) * white(2)}};
    judge_color rgb = from_xyz(xyz);
    for (int i = 0; i < 3; i++) {
        rgb.v[i] = fminl(fmaxl(rgb.v[i], 0.0L), 1.0L);
    }
    return rgb;
}

static judge_color to_hunt(judge_color rgb)
{
    const judge_color xyz = to_xyz(rgb);
    long double       f[3];
    for (int i = 0; i < 3; i++) {
        const long double t = xyz.v[i] / white(i), d = 6.0L / 29.0L;
        f[i] = t > d * d * d ? cbrtl(t) : t / (3.0L * d * d) + 4.0L / 29.0L;
    }
    const long double l = 116.0L * f[1] - 16.0L;
    return (judge_color){
        {l, 0.01L * l * 500.0L * (f[0] - f[1]), 0.01L * l * 200.0L * (f[1] - f[2])}};
}

static long double hyab_power(judge_color p, judge_color q)
{
    const judge_color a = to_hunt(p), b = to_hunt(q);
    return powl(fabsl(a.v[0] - b.v[0]) + hypotl(a.v[1] - b.v[1], a.v[2] - b.v[2]), 0.7L);
}

long double judge_flip_constant(judge_color a, judge_color b)
{
    const judge_color green = {{0.0L, 1.0L, 0.0L}}, blue = {{0.0L, 0.0L, 1.0L}};
    const long double largest = hyab_power(green, blue), knee = 0.4L * largest;
    const long double d = hyab_power(a, b);
    return d < knee ? d * 0.95L / knee : 0.95L + 0.05L * (d - knee) / (largest - knee);
}

static int clamp_index(int i, int n) { return i < 0 ? 0 : i < n ? i : n - 1; }

static judge_color pixel(const judge_picture *p, int x, int y)
{
    return to_ycxcz(p->pixels[clamp_index(y, p->height) * p->width + clamp_index(x, p->width)]);
}

/* Contrast sensitivity of channel c at a squared distance in degrees. */
static long double sensitivity(int c, long double squared)
{
    static const long double A[3][2] = {{1.0L, 0.0L}, {1.0L, 0.0L}, {34.1L, 13.5L}};
    static const long double B[3][2] = {{0.0047L, 1e-5L}, {0.0053L, 1e-5L}, {0.04L, 0.025L}};
    long double              sum     = 0.0L;
    for (int i = 0; i < 2; i++) {
        sum += A[c][i] * sqrtl(PI / B[c][i]) * expl(-PI * PI * squared / B[c][i]);
    }
    return sum;
}

static judge_color filtered(const judge_picture *p, double ppd, int x, int y)
{
    const int   radius  = (int)ceill(3.0L * sqrtl(0.04L / (2.0L * PI * PI)) * ppd);
    judge_color out     = {{0.0L, 0.0L, 0.0L}};
    long double sums[3] = {0.0L, 0.0L, 0.0L};
    for (int j = -radius; j <= radius; j++) {
        for (int i = -radius; i <= radius; i++) {
            const judge_color c = pixel(p, x + i, y + j);
            for (int k = 0; k < 3; k++) {
                const long double w = sensitivity(k, (long double)(i * i + j * j) / ppd / ppd);
                out.v[k] += w * c.v[k];
                sums[k] += w;
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        out.v[k] /= sums[k];
    }
    return from_ycxcz(out);
}

/* Response to a feature detector: along x, or along y. */
static long double response(const judge_picture *p, double ppd, int x, int y, bool point,
                            bool along_y)
{
    const long double deviation = 0.5L * 0.082L * ppd;
    const int         radius    = (int)ceill(3.0L * deviation);
    long double       positive = 0.0L, negative = 0.0L, with_positive = 0.0L, with_negative = 0.0L;
    for (int j = -radius; j <= radius; j++) {
        for (int i = -radius; i <= radius; i++) {
            const long double t = along_y ? j : i;
            const long double g =
                expl(-(long double)(i * i + j * j) / (2.0L * deviation * deviation));
            const long double w = (point ? t * t / (deviation * deviation) - 1.0L : -t) * g;
            const long double v = (pixel(p, x + i, y + j).v[0] + 16.0L) / 116.0L;
            positive += w > 0.0L ? w : 0.0L;
            negative -= w < 0.0L ? w : 0.0L;
            with_positive += w > 0.0L ? w * v : 0.0L;
            with_negative += w < 0.0L ? w * v : 0.0L;
        }
    }
    return with_positive / positive + with_negative / negative;
}

static long double feature(const judge_picture *p, double ppd, int x, int y, bool point)
{
    return hypotl(response(p, ppd, x, y, point, false), response(p, ppd, x, y, point, true));
}

long double judge_flip(const judge_picture *a, const judge_picture *b, double ppd, int x, int y)
{
    const long double color   = judge_flip_constant(filtered(a, ppd, x, y), filtered(b, ppd, x, y));
    long double       largest = 0.0L;
    for (int point = 0; point < 2; point++) {
        largest =
            fmaxl(largest, fabsl(feature(a, ppd, x, y, point) - feature(b, ppd, x, y, point)));
    }
    return powl(color, 1.0L - sqrtl(largest / sqrtl(2.0L)));
}

/* Hable's curve before its white point is scaled to 1. */
static long double hable(long double x)
{
    const long double a = 0.15L, b = 0.5L, c = 0.1L, d = 0.2L, e = 0.02L, f = 0.3L;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

judge_color judge_tone_map(const char *mapper, judge_color c)
{
    const long double light = 0.2126L * c.v[0] + 0.7152L * c.v[1] + 0.0722L * c.v[2];
    for (int i = 0; i < 3; i++) {
        const long double x = c.v[i], s = 0.6L * x;
        if (strcmp(mapper, "reinhard") == 0) {
            c.v[i] = x / (1.0L + light);
        } else if (strcmp(mapper, "hable") == 0) {
            c.v[i] = hable(2.0L * x) / hable(11.2L);
        } else {
            c.v[i] = s * (2.51L * s + 0.03L) / (s * (2.43L * s + 0.59L) + 0.14L);
        }
        c.v[i] = fminl(fmaxl(c.v[i], 0.0L), 1.0L);
    }
    return c;
}
