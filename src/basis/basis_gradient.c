/* basis_gradient.c - slopes of all functions along the sphere.
 *
 * f = Q(z) Re (r(z) (x + i y))^m is continued to space by that formula; its gradient there, less
 * the part along d, is the surface gradient.  Nothing is divided by sin theta, so the poles need no
 * care; r'/r has a 1/z for the kinds whose b vanishes on the horizon. */
#include <math.h>
#include <string.h>

#include "basis/basis_data.h"
#include "math/vec.h"

typedef struct {
    assay_vec3 d;                   /* unit                                                   */
    double     t;                   /* argument of the polynomials                            */
    double     t_rate;              /* dt/dz                                                  */
    double     r;                   /* |b| = r |x + i y|                                      */
    double     r_rate;              /* r' / r                                                 */
    double     weight, weight_rate; /* factor of all functions, w'/w              */
} slope_place;

static bool is_steep(assay_basis_kind kind)
{
    return kind == ASSAY_BASIS_HSH || kind == ASSAY_BASIS_MAKHOTKIN ||
           kind == ASSAY_BASIS_MAKHOTKIN_SQRT;
}

static slope_place locate(assay_basis_kind kind, assay_vec3 direction)
{
    const double inverse = 1.0 / sqrt(vec3_dot(direction, direction));
    slope_place  place   = {.d = vec3_scale(direction, inverse), .weight = 1.0};
    const double z       = place.d.z;
    if (basis_is_spherical(kind)) {
        place.t      = z;
        place.t_rate = 1.0;
        place.r      = 1.0;
        return place;
    }
    place.t      = 2.0 * z - 1.0;
    place.t_rate = 2.0;
    if (kind == ASSAY_BASIS_ZERNIKE) {
        place.r      = 1.0 / sqrt(1.0 + z);
        place.r_rate = -0.5 / (1.0 + z);
    } else {
        place.r      = 2.0 * sqrt(z / (1.0 + z));
        place.r_rate = 0.5 / (z * (1.0 + z));
    }
    if (kind == ASSAY_BASIS_MAKHOTKIN_SQRT) {
        place.weight      = sqrt(z);
        place.weight_rate = 0.5 / z;
    }
    return place;
}

/* scale p(t) and its derivative by z. */
typedef struct {
    double value, rate;
} radial;

/* The polynomial, its derivative by t, and both of the degree before. */
typedef struct {
    double p, rate, before, rate_before;
} polynomial;

static void advance(polynomial *at, const basis_step *step, double t)
{
    const double power    = step->exponent < 0 ? 0.5 : step->exponent + 1.0;
    const double distance = power * ((t - step->b_hi) - step->b_lo);
    const double g        = step->g_hi + step->g_lo;
    const double p        = distance * at->p - g * at->before;
    const double rate     = (power * at->p + distance * at->rate) - g * at->rate_before;
    *at                   = (polynomial){p, rate, at->p, at->rate};
}

static assay_vec3 tangential(assay_vec3 g, assay_vec3 d) { return vec3_mad(g, -vec3_dot(g, d), d); }

/* Slopes of functions m and -m of one degree.  (c, s) is b^m, (c1, s1) is b^(m-1). */
static void store_slopes(const basis_step *step, const slope_place *place, int m, radial f,
                         const double c[2], const double s[2], assay_vec3 *gradients)
{
    const double inner = m * place->r * f.value * place->weight;
    const double outer =
        (f.rate + f.value * (m * place->r_rate + place->weight_rate)) * place->weight;
    if (step->plus >= 0) {
        gradients[step->plus] =
            tangential(vec3(inner * c[0], -inner * s[0], outer * c[1]), place->d);
    }
    if (step->minus >= 0) {
        gradients[step->minus] =
            tangential(vec3(inner * s[0], inner * c[0], outer * s[1]), place->d);
    }
}

assay_status assay_basis_gradient(const assay_basis *basis, assay_vec3 direction,
                                  double *values_out, assay_vec3 *gradients_out)
{
    if (basis_check_direction(basis, direction) != ASSAY_OK ||
        (is_steep(basis->kind) && direction.z <= 0.0)) {
        return ASSAY_ERR_DOMAIN;
    }
    const slope_place place = locate(basis->kind, direction);
    const basis_step *step  = basis->step;
    double            c[2] = {0.0, 1.0}, s[2] = {0.0, 0.0}; /* b^(m-1), b^m */
    for (int m = 0; m < basis->order; m++) {
        polynomial at = {.p = 1.0};
        for (int k = 0; k < basis->steps[m]; k++, step++) {
            const radial f = {step->scale * at.p, step->scale * at.rate * place.t_rate};
            store_slopes(step, &place, m, f, c, s, gradients_out);
            advance(&at, step, place.t);
        }
        c[0] = c[1];
        s[0] = s[1];
        c[1] = place.r * (c[0] * place.d.x - s[0] * place.d.y);
        s[1] = place.r * (c[0] * place.d.y + s[0] * place.d.x);
    }
    return assay_basis_evaluate(basis, direction, values_out);
}
