/* ggx.h - the Trowbridge-Reitz (GGX) distribution of microfacet normals, [trowbridge75],
 * [walter07].
 *
 * Local frame, z = macroscopic normal.  alpha in (0, 1] is the distribution's width. */
#ifndef ASSAY_TRACE_GGX_H
#define ASSAY_TRACE_GGX_H

#include "core/numerics.h"
#include "math/vec.h"

/* Density of normals D(h), 1/sr: D(h) h.z integrates to 1.  h unit, h.z > 0. */
static inline double assay_ggx_density(double alpha, assay_vec3 h)
{
    /* h.z^2 (alpha^2 - 1) + 1 written as sin^2 + alpha^2 cos^2: no cancellation at the peak. */
    const double d = h.x * h.x + h.y * h.y + alpha * alpha * h.z * h.z;
    return alpha * alpha / (ASSAY_PI * d * d);
}

/* cos + sqrt(alpha^2 + (1 - alpha^2) cos^2).  Smith's masking of one direction is
 * G1 = 2 cos / (that), so the visibility V = G1 G1' / (4 cos cos') is 1 / (one times the other). */
static inline double assay_ggx_masking(double alpha, double cosine)
{
    const double a2 = alpha * alpha;
    return cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine);
}

/* Draws a normal from those that wo sees, density D(h) G1(wo) (wo . h) / wo.z = 2 D (wo . h) /
 * masking(wo.z), [heitz18].  wo.z > 0. */
assay_vec3 assay_ggx_sample_visible(double alpha, assay_vec3 wo, double u1, double u2);

#endif
