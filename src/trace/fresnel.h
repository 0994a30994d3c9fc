/* fresnel.h - how much of unpolarised light a smooth interface reflects.
 *
 * c is the cosine of the angle of incidence, in [0, 1]; eta the index of refraction behind the
 * interface over the one in front of it, > 0. */
#ifndef ASSAY_TRACE_FRESNEL_H
#define ASSAY_TRACE_FRESNEL_H

#include "math/vec.h"

/* (1 - c)^5, what carries a reflectance from normal to grazing incidence, [schlick94]. */
static inline double assay_schlick(double c)
{
    const double x  = c < 1.0 ? 1.0 - c : 0.0;
    const double x2 = x * x;
    return x2 * x2 * x;
}

/* Reflectance at normal incidence, ((n - 1) / (n + 1))^2, n the index or its reciprocal. */
static inline double assay_normal_reflectance(double n)
{
    const double r = (n - 1.0) / (n + 1.0);
    return r * r;
}

/* Cosine of the angle of refraction; 0 under total internal reflection. */
static inline double assay_refracted_cosine(double c, double eta)
{
    const double squared = 1.0 - (1.0 - c) * (1.0 + c) / (eta * eta);
    return squared > 0.0 ? sqrt(squared) : 0.0;
}

/* Fresnel's equations, mean of both polarisations; 1 under total internal reflection. */
static inline double assay_fresnel_dielectric(double c, double eta)
{
    const double t = assay_refracted_cosine(c, eta);
    if (t == 0.0) {
        return 1.0;
    }
    const double s = (c - eta * t) / (c + eta * t);
    const double p = (eta * c - t) / (eta * c + t);
    return 0.5 * (s * s + p * p);
}

/* wo, unit, mirrored in the plane with unit normal h; c = wo . h. */
static inline assay_vec3 assay_reflect(assay_vec3 wo, assay_vec3 h, double c)
{
    return vec3_mad(vec3_negate(wo), 2.0 * c, h);
}

/* wo, unit, refracted to the other side of that plane; c = wo . h > 0, t the refracted cosine. */
static inline assay_vec3 assay_refract(assay_vec3 wo, assay_vec3 h, double c, double t, double eta)
{
    return vec3_mad(vec3_scale(wo, -1.0 / eta), c / eta - t, h);
}

#endif
