/* euler_zyz.c - Euler angles without the pole's trouble.
 *
 * Invariant: the six numbers are those of one exact rotation to about 2^-100: the matrix is first
 * made orthogonal in double-double, then turned into a unit quaternion [shepperd78].  With
 * q = (w, x, y, z),
 *     w + i z = cos(beta / 2) exp(i (alpha + gamma) / 2)
 *     y - i x = sin(beta / 2) exp(i (alpha - gamma) / 2),
 * so that alpha and gamma come from a product of two phases.  Near a pole one of the phases is
 * uncertain, but whatever depends on it is multiplied by a power of the small half.  (Rotation
 * matrices of any order are the better for it than with angles from atan2: nothing is rounded to an
 * angle and multiplied by m.) */
#include "basis/euler_zyz.h"

#include "assay/basis.h"
#include "core/numerics.h"

static const double TOLERANCE = 0x1p-20;

void assay_rotation_from_euler_zyz(double alpha, double beta, double gamma, double rotation_out[9])
{
    const assay_sincos a = assay_sincos_radians(alpha), b = assay_sincos_radians(beta),
                       g = assay_sincos_radians(gamma);
    rotation_out[0]      = a.cos * b.cos * g.cos - a.sin * g.sin;
    rotation_out[1]      = -a.cos * b.cos * g.sin - a.sin * g.cos;
    rotation_out[2]      = a.cos * b.sin;
    rotation_out[3]      = a.sin * b.cos * g.cos + a.cos * g.sin;
    rotation_out[4]      = -a.sin * b.cos * g.sin + a.cos * g.cos;
    rotation_out[5]      = a.sin * b.sin;
    rotation_out[6]      = -b.sin * g.cos;
    rotation_out[7]      = b.sin * g.sin;
    rotation_out[8]      = b.cos;
}

/* 1 / (1 + z) is (1 - z) / (x^2 + y^2), which keeps its digits below the equator. */
assay_status assay_rotation_to_pole(assay_vec3 pole, double rotation_out[9])
{
    const double square = pole.x * pole.x + pole.y * pole.y + pole.z * pole.z;
    if (!(fabs(square - 1.0) <= ASSAY_BASIS_UNIT_TOLERANCE)) {
        return ASSAY_ERR_DOMAIN;
    }
    const double length = sqrt(square), x = pole.x / length, y = pole.y / length;
    const double z = pole.z / length, aside = x * x + y * y;
    /* x^2, x y and y^2 over 1 + z */
    double xx = 2.0, xy = 0.0, yy = 0.0;
    if (z >= 0.0) {
        xx = x * x / (1.0 + z);
        xy = x * y / (1.0 + z);
        yy = y * y / (1.0 + z);
    } else if (aside > 0.0) {
        xx = (1.0 - z) * (x * x / aside);
        xy = (1.0 - z) * (x * y / aside);
        yy = (1.0 - z) * (y * y / aside);
    }
    const double rotation[9] = {1.0 - xx, -xy, x, -xy, 1.0 - yy, y, -x, -y, z};
    for (int i = 0; i < 9; i++) {
        rotation_out[i] = rotation[i];
    }
    return ASSAY_OK;
}

static bool is_rotation(const double r[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j <= i; j++) {
            const double dot =
                r[3 * i] * r[3 * j] + r[3 * i + 1] * r[3 * j + 1] + r[3 * i + 2] * r[3 * j + 2];
            if (!(fabs(dot - (i == j ? 1.0 : 0.0)) <= TOLERANCE)) {
                return false;
            }
        }
    }
    return r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6]) +
               r[2] * (r[3] * r[7] - r[4] * r[6]) >
           0.0;
}

/* X (3 - X' X) / 2, which squares the distance from orthogonality and tends to the orthogonal
 * matrix nearest to X [bjorck71]. */
static void orthogonalize_once(double_double x[3][3])
{
    double_double correction[3][3], y[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            double_double sum = dd_of(i == j ? -3.0 : 0.0);
            for (int k = 0; k < 3; k++) {
                sum = dd_add(sum, dd_multiply(x[k][i], x[k][j]));
            }
            correction[i][j] = dd_multiply_double(sum, -0.5);
        }
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            y[i][j] = dd_of(0.0);
            for (int k = 0; k < 3; k++) {
                y[i][j] = dd_add(y[i][j], dd_multiply(x[i][k], correction[k][j]));
            }
        }
    }
    for (int i = 0; i < 9; i++) {
        x[i / 3][i % 3] = y[i / 3][i % 3];
    }
}

/* q: x, y, z, w. */
static void quaternion_of(double_double r[3][3], double_double q[4])
{
    const double trace   = r[0][0].hi + r[1][1].hi + r[2][2].hi;
    int          largest = 3;
    double       most    = trace;
    for (int i = 0; i < 3; i++) {
        if (r[i][i].hi > most) {
            largest = i;
            most    = r[i][i].hi;
        }
    }
    if (largest == 3) {
        const double_double sum = dd_add(dd_add(r[0][0], r[1][1]), dd_add(r[2][2], dd_of(1.0)));
        q[3]                    = dd_sqrt(sum); /* twice w; the scale is taken out below */
        for (int i = 0; i < 3; i++) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            q[i] = dd_divide(dd_subtract(r[k][j], r[j][k]), q[3]);
        }
    } else {
        const int           i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
        const double_double sum =
            dd_subtract(dd_add(r[i][i], dd_of(1.0)), dd_add(r[j][j], r[k][k]));
        q[i] = dd_sqrt(sum);
        q[j] = dd_divide(dd_add(r[i][j], r[j][i]), q[i]);
        q[k] = dd_divide(dd_add(r[i][k], r[k][i]), q[i]);
        q[3] = dd_divide(dd_subtract(r[k][j], r[j][k]), q[i]);
    }
    for (int i = 0; i < 4; i++) {
        q[i] = dd_multiply_double(q[i], 0.5);
    }
}

/* |(a, b)|; (a, b) is scaled to length 1, or made (1, 0) where it is zero. */
static double_double take_length(double_double *a, double_double *b)
{
    const double_double length = dd_sqrt(dd_add(dd_multiply(*a, *a), dd_multiply(*b, *b)));
    if (!(length.hi > 0.0)) {
        *a = dd_of(1.0);
        *b = dd_of(0.0);
        return dd_of(0.0);
    }
    *a = dd_divide(*a, length);
    *b = dd_divide(*b, length);
    return length;
}

bool assay_euler_zyz_split(const double rotation[9], assay_euler_zyz *split_out)
{
    if (!is_rotation(rotation)) {
        return false;
    }
    double_double r[3][3], q[4];
    for (int i = 0; i < 9; i++) {
        r[i / 3][i % 3] = dd_of(rotation[i]);
    }
    for (int i = 0; i < 3; i++) {
        orthogonalize_once(r);
    }
    quaternion_of(r, q);

    double_double       a = q[3], ai = q[2], b = q[1], bi = dd_negate(q[0]);
    const double_double c = take_length(&a, &ai), s = take_length(&b, &bi);
    const double_double norm = dd_sqrt(dd_add(dd_multiply(c, c), dd_multiply(s, s)));
    split_out->cos_half_beta = dd_divide(c, norm);
    split_out->sin_half_beta = dd_divide(s, norm);
    split_out->cos_alpha     = dd_subtract(dd_multiply(a, b), dd_multiply(ai, bi));
    split_out->sin_alpha     = dd_add(dd_multiply(a, bi), dd_multiply(ai, b));
    split_out->cos_gamma     = dd_add(dd_multiply(a, b), dd_multiply(ai, bi));
    split_out->sin_gamma     = dd_subtract(dd_multiply(ai, b), dd_multiply(a, bi));
    return true;
}

void assay_angle_multiples(double_double cosine, double_double sine, int count, double *cosines_out,
                           double *sines_out)
{
    double_double c = dd_of(1.0), s = dd_of(0.0);
    for (int m = 0; m < count; m++) {
        cosines_out[m]           = dd_round(c);
        sines_out[m]             = dd_round(s);
        const double_double next = dd_subtract(dd_multiply(c, cosine), dd_multiply(s, sine));
        s                        = dd_add(dd_multiply(s, cosine), dd_multiply(c, sine));
        c                        = next;
    }
}
