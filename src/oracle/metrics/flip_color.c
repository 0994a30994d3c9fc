/* flip_color.c - how far apart two colours look.
 *
 * Invariant: white (1, 1, 1) has X / Xn = Y / Yn = Z / Zn = 1 up to rounding, so that greys have
 * no colour; the rows of the matrix are whole numbers over their sum. */
#include "oracle/metrics/flip_color.h"

#include "core/numerics.h"

/* [andersson20] section 4.1.3, q_c, p_c and p_t. */
static const double EXPONENT = 0.7, KNEE_AT = 0.4, KNEE_VALUE = 0.95;

/* Linear Rec. 709 RGB to XYZ for D65, times the white point's inverse: its denominators cancel. */
static const double PRIMARIES[3][3] = {{10135552.0, 8788810.0, 4435075.0},
                                       {2613072.0, 8788810.0, 887015.0},
                                       {1425312.0, 8788810.0, 70074185.0}};

static double minor_of(const double m[3][3], int row, int column)
{
    const int r = (row + 1) % 3, s = (row + 2) % 3, p = (column + 1) % 3, q = (column + 2) % 3;
    return m[r][p] * m[s][q] - m[r][q] * m[s][p];
}

static void invert(const double m[3][3], double inverse_out[3][3])
{
    const double determinant =
        m[0][0] * minor_of(m, 0, 0) + m[0][1] * minor_of(m, 0, 1) + m[0][2] * minor_of(m, 0, 2);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            inverse_out[k][i] = minor_of(m, i, k) / determinant;
        }
    }
}

static double row_times(const double row[3], double x, double y, double z)
{
    return row[0] * x + row[1] * y + row[2] * z;
}

/* CIELAB's f. */
static double lab(double t)
{
    const double knee = 6.0 / 29.0;
    return t > knee * knee * knee ? assay_cbrt(t) : t / (3.0 * knee * knee) + 4.0 / 29.0;
}

/* L*, and a* and b* that fade with L* as the Hunt effect has it. */
typedef struct {
    double l, a, b;
} hunt_lab;

static hunt_lab to_hunt_lab(double x, double y, double z)
{
    const double fx = lab(x), fy = lab(y), fz = lab(z), l = 116.0 * fy - 16.0;
    return (hunt_lab){l, 0.01 * l * 500.0 * (fx - fy), 0.01 * l * 200.0 * (fy - fz)};
}

/* HyAB: city block in lightness, Euclid in colour. */
static double distance(hunt_lab p, hunt_lab q)
{
    const double da = p.a - q.a, db = p.b - q.b;
    return fabs(p.l - q.l) + sqrt(da * da + db * db);
}

static hunt_lab primary(const assay_flip_colors *colors, int c)
{
    return to_hunt_lab(colors->to_white[0][c], colors->to_white[1][c], colors->to_white[2][c]);
}

assay_flip_colors assay_flip_colors_make(void)
{
    assay_flip_colors colors = {0};
    for (int i = 0; i < 3; i++) {
        const double white = PRIMARIES[i][0] + PRIMARIES[i][1] + PRIMARIES[i][2];
        for (int k = 0; k < 3; k++) {
            colors.to_white[i][k] = PRIMARIES[i][k] / white;
        }
    }
    invert(colors.to_white, colors.from_white);
    const double distance_log = assay_log(distance(primary(&colors, 1), primary(&colors, 2)));
    colors.largest            = assay_exp(EXPONENT * distance_log);
    colors.log_knee           = EXPONENT * distance_log + assay_log(KNEE_AT);
    colors.log_knee_value     = assay_log(KNEE_VALUE);
    return colors;
}

assay_opponent assay_flip_opponent(const assay_flip_colors *colors, assay_rgb linear)
{
    const double x = row_times(colors->to_white[0], linear.r, linear.g, linear.b);
    const double y = row_times(colors->to_white[1], linear.r, linear.g, linear.b);
    const double z = row_times(colors->to_white[2], linear.r, linear.g, linear.b);
    return (assay_opponent){y, x - y, y - z};
}

static double clamp_unit(double x) { return !(x > 0.0) ? 0.0 : x < 1.0 ? x : 1.0; }

/* What the filters have made of a colour, back in the gamut of the display. */
static hunt_lab seen(const assay_flip_colors *colors, assay_opponent color)
{
    const double x = color.y + color.c, y = color.y, z = color.y - color.z;
    const double r = clamp_unit(row_times(colors->from_white[0], x, y, z));
    const double g = clamp_unit(row_times(colors->from_white[1], x, y, z));
    const double b = clamp_unit(row_times(colors->from_white[2], x, y, z));
    return to_hunt_lab(row_times(colors->to_white[0], r, g, b),
                       row_times(colors->to_white[1], r, g, b),
                       row_times(colors->to_white[2], r, g, b));
}

double assay_flip_color_distance(const assay_flip_colors *colors, assay_opponent a,
                                 assay_opponent b)
{
    return distance(seen(colors, a), seen(colors, b));
}

/* [andersson20] section 4.1.3 and eq. 9: Delta E_c is distance^q_c on two straight pieces, Delta E
 * is Delta E_c^(1 - Delta E_f).  On the first piece that is one power of the distance. */
double assay_flip_error(const assay_flip_colors *colors, double distance, double feature)
{
    if (!(distance > 0.0)) {
        return 0.0;
    }
    const double log_power = EXPONENT * assay_log(distance);
    if (log_power < colors->log_knee) {
        return assay_exp((1.0 - feature) * (log_power - colors->log_knee + colors->log_knee_value));
    }
    const double knee = KNEE_AT * colors->largest;
    const double color =
        KNEE_VALUE + (assay_exp(log_power) - knee) / (colors->largest - knee) * (1.0 - KNEE_VALUE);
    return assay_exp((1.0 - feature) * assay_log(color));
}
