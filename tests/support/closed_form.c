/* closed_form.c - see closed_form.h. */
#include "closed_form.h"

#include <math.h>

typedef struct {
    long double x, y, z;
} wide;

static wide        sub(wide a, wide b) { return (wide){a.x - b.x, a.y - b.y, a.z - b.z}; }
static long double dot(wide a, wide b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static wide        cross(wide a, wide b)
{
    return (wide){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static wide lerp(wide a, wide b, long double t)
{
    return (wide){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}
static wide widen(assay_vec3 v) { return (wide){v.x, v.y, v.z}; }

/* Sutherland-Hodgman against the plane n . q >= 0 through the receiver. */
static int clip(const wide *in, int count, wide n, wide *out)
{
    int kept = 0;
    for (int i = 0; i < count; i++) {
        const wide        a = in[i], b = in[(i + 1) % count];
        const long double da = dot(n, a), db = dot(n, b);
        if (da >= 0.0L) {
            out[kept++] = a;
        }
        if ((da >= 0.0L) != (db >= 0.0L)) {
            out[kept++] = lerp(a, b, da / (da - db));
        }
    }
    return kept;
}

/* Twice the vector, in the direction that the winding gives. */
static wide lambert(const assay_vec3 *vertices, int count, wide p, wide n)
{
    wide relative[8], kept[16], sum = {0.0L, 0.0L, 0.0L};
    for (int i = 0; i < count; i++) {
        relative[i] = sub(widen(vertices[i]), p);
    }
    const int left = clip(relative, count, n, kept);
    for (int i = 0; i < left; i++) {
        const wide        c      = cross(kept[i], kept[(i + 1) % left]);
        const long double length = sqrtl(dot(c, c));
        if (length > 0.0L) {
            const long double w = atan2l(length, dot(kept[i], kept[(i + 1) % left])) / length;
            sum                 = (wide){sum.x + w * c.x, sum.y + w * c.y, sum.z + w * c.z};
        }
    }
    return sum;
}

static long double polygon(const assay_vec3 *vertices, int count, wide p, wide n)
{
    return 0.5L * fabsl(dot(n, lambert(vertices, count, p, n)));
}

long double closed_polygon(const assay_vec3 *vertices, int count, assay_vec3 p, assay_vec3 n)
{
    return polygon(vertices, count, widen(p), widen(n));
}

assay_vec3 closed_polygon_vector(const assay_vec3 *vertices, int count, assay_vec3 p, assay_vec3 n)
{
    const wide        v    = lambert(vertices, count, widen(p), widen(n));
    const long double half = dot(widen(n), v) < 0.0L ? -0.5L : 0.5L;
    return vec3((double)(half * v.x), (double)(half * v.y), (double)(half * v.z));
}

assay_vec3 closed_polygon_gradient(const assay_vec3 *vertices, int count, assay_vec3 p,
                                   assay_vec3 n)
{
    const long double h = 1e-6L;
    double            out[3];
    for (int axis = 0; axis < 3; axis++) {
        const wide step   = {axis == 0 ? h : 0.0L, axis == 1 ? h : 0.0L, axis == 2 ? h : 0.0L};
        const wide ahead  = {p.x + step.x, p.y + step.y, p.z + step.z};
        const wide behind = {p.x - step.x, p.y - step.y, p.z - step.z};
        out[axis]         = (double)((polygon(vertices, count, ahead, widen(n)) -
                              polygon(vertices, count, behind, widen(n))) /
                             (2.0L * h));
    }
    return vec3(out[0], out[1], out[2]);
}

/* n turned by angle h about a unit axis (Rodrigues). */
static wide turned(wide n, wide axis, long double h)
{
    const wide        c = cross(axis, n);
    const long double s = sinl(h), k = cosl(h), d = dot(axis, n) * (1.0L - k);
    return (wide){n.x * k + c.x * s + axis.x * d, n.y * k + c.y * s + axis.y * d,
                  n.z * k + c.z * s + axis.z * d};
}

assay_vec3 closed_polygon_rotation(const assay_vec3 *vertices, int count, assay_vec3 p,
                                   assay_vec3 n)
{
    const long double h       = 1e-6L;
    const wide        axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double            out[3];
    for (int i = 0; i < 3; i++) {
        out[i] = (double)((polygon(vertices, count, widen(p), turned(widen(n), axes[i], h)) -
                           polygon(vertices, count, widen(p), turned(widen(n), axes[i], -h))) /
                          (2.0L * h));
    }
    return vec3(out[0], out[1], out[2]);
}

long double closed_sphere(assay_vec3 centre, double radius, assay_vec3 p, assay_vec3 n)
{
    const wide        r = sub(widen(centre), widen(p));
    const long double d = sqrtl(dot(r, r));
    return acosl(-1.0L) * (long double)radius * radius * dot(widen(n), r) / (d * d * d);
}

assay_vec3 closed_sphere_gradient(assay_vec3 centre, double radius, assay_vec3 p, assay_vec3 n)
{
    const assay_vec3 r      = vec3_sub(centre, p);
    const double     d2     = vec3_dot(r, r);
    const double     factor = (double)acosl(-1.0L) * radius * radius / (d2 * sqrt(d2));
    return vec3_scale(vec3_mad(vec3_scale(n, -1.0), 3.0 * vec3_dot(n, r) / d2, r), factor);
}

/* [howell82] configuration C-11 with X = Y = a / c. */
long double closed_parallel_squares(double a, double c)
{
    const long double x = (long double)a / c, q = 1.0L + x * x;
    return 2.0L / (acosl(-1.0L) * x * x) *
           (logl(sqrtl(q * q / (1.0L + 2.0L * x * x))) + 2.0L * x * sqrtl(q) * atanl(x / sqrtl(q)) -
            2.0L * x * atanl(x));
}
