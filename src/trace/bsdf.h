/* bsdf.h - how a surface scatters light at one point.
 *
 * All directions are unit vectors in the local shading frame (z = shading normal on the side of the
 * material's front), pointing away from the surface: wo to where light is seen from, wi to where it
 * comes from.  Reflection: wo.z wi.z > 0, transmission: < 0.  A two-sided reflecting model treats
 * wo.z < 0 by mirroring both directions; where a solid's boundary refracts, wo.z < 0 is inside.
 * Refraction is of radiance: light that goes from a medium of index n into one of index n' gains
 * (n' / n)^2, so that inside a solid radiance is n^2 times what it is outside.
 * Formulas, sources and departures: docs/bsdf.md. */
#ifndef ASSAY_TRACE_BSDF_H
#define ASSAY_TRACE_BSDF_H

#include <stdbool.h>

#include "math/vec.h"

typedef enum {
    ASSAY_BSDF_BLACK,              /* nothing is scattered                                       */
    ASSAY_BSDF_LAMBERT,            /* base_color / pi                                            */
    ASSAY_BSDF_METALLIC_ROUGHNESS, /* glTF 2.0 appendix B, with KHR ior, specular, transmission  */
    ASSAY_BSDF_PHONG, /* base_color / pi + specular (n + 2) / (2 pi) cos^n, [lafortune94] */
    ASSAY_BSDF_WARD_PUBLISHED, /* [ward92] eq. 5                                             */
    ASSAY_BSDF_WARD            /* the same with the bounded albedo of [geisler10]            */
} assay_bsdf_model;

/* Everything of a material that counts at one point, textures looked up.  A plain value. */
typedef struct {
    assay_bsdf_model model;
    assay_rgb base_color;      /* [0, 1]                                                          */
    double    metallic;        /* [0, 1]                                                          */
    double    roughness;       /* [0, 1], perceptual: alpha = roughness^2; below ASSAY_ALPHA_MIN
                                  the lobe is a perfect mirror                                    */
    double    ior;             /* 1.5; >= 1, or 0 for a Fresnel term of 1 (KHR_materials_ior)     */
    double    specular_factor; /* KHR_materials_specular, 1                                       */
    assay_rgb specular_color;  /* KHR_materials_specular, 1 1 1; the specular lobe of Phong, Ward */
    double    transmission;    /* KHR_materials_transmission, 0                                   */
    bool      solid;           /* transmission refracts (a volume is behind the surface) instead of
                                  passing an infinitely thin wall                                 */
    double exponent;           /* Phong, >= 0                                                     */
    double alpha_x, alpha_y;   /* Ward, > 0, slopes along local x and y                         */
} assay_bsdf;

/* alpha under which a GGX lobe is taken as a mirror. */
#define ASSAY_ALPHA_MIN 1e-4

/* Material defaults of glTF: white, metallic 1, roughness 1, ior 1.5, ...; for Phong and Ward the
 * specular colour is black, exponent and slopes 1. */
assay_bsdf assay_bsdf_default(assay_bsdf_model model);

/* What one direction scatters. */
typedef struct {
    assay_rgb value; /* f(wo, wi) |wi.z|, 1/sr; without perfectly specular lobes                 */
    double    pdf;   /* of assay_bsdf_view_sample choosing wi, 1/sr; without them too            */
} assay_bsdf_value;

typedef struct {
    assay_vec3 wi;
    assay_rgb  weight;      /* f |wi.z| / pdf; for a specular lobe what it scatters / probability */
    double     pdf;         /* as assay_bsdf_evaluate would say; of a specular lobe: probability */
    bool       specular;    /* from a lobe with a single direction                               */
    bool       transmitted; /* wi is on the other side                                           */
} assay_bsdf_sample;

/* The lobes of metallic-roughness as one wo sees them; bsdf_metallic_roughness.c alone reads it. */
typedef struct {
    double    alpha;
    double    metallic;
    assay_rgb base_color;
    assay_rgb f0;                             /* of the dielectric, at normal incidence      */
    double    f90;                            /* at grazing incidence                        */
    assay_rgb diffuse;                        /* albedo of the base that is diffuse          */
    assay_rgb through;                        /* tint of the base that transmits             */
    double    eta;                            /* index behind over index in front            */
    double    masking;                        /* of wo, rough microfacets only               */
    bool      refracts;                       /* a solid's boundary, Fresnel's own equations */
    bool      matched;                        /* a solid that does not bend light            */
    bool      smooth;                         /* microfacets are one mirror                  */
    bool      transmits;                      /* through is not black                        */
    double    p_diffuse, p_straight, p_facet; /* sum 1, or all 0                             */
} assay_bsdf_lobes;

/* A BSDF as seen from one wo: made once where several directions are asked for. */
typedef struct {
    const assay_bsdf *bsdf;
    assay_vec3        wo;       /* mirrored to wo.z > 0                                         */
    bool              back;     /* it was mirrored                                              */
    bool              scatters; /* wo is off the horizon and the surface is not black           */
    bool              specular; /* no lobe can be evaluated: light sampling is then of no use   */
    assay_bsdf_lobes  lobes;
} assay_bsdf_view;

assay_bsdf_view  assay_bsdf_seen_from(const assay_bsdf *bsdf, assay_vec3 wo);
assay_bsdf_value assay_bsdf_view_evaluate(const assay_bsdf_view *view, assay_vec3 wi);

/* Chooses wi from three uniform numbers in [0, 1).  False where the path ends (nothing scattered,
 * or a direction under the horizon was drawn, which counts as a zero contribution). */
bool assay_bsdf_view_sample(const assay_bsdf_view *view, double u_lobe, double u1, double u2,
                            assay_bsdf_sample *sample_out);

/* The same for a single direction. */
assay_bsdf_value assay_bsdf_evaluate(const assay_bsdf *bsdf, assay_vec3 wo, assay_vec3 wi);
bool assay_bsdf_sample_direction(const assay_bsdf *bsdf, assay_vec3 wo, double u_lobe, double u1,
                                 double u2, assay_bsdf_sample *sample_out);

/* Albedo of a Lambertian near to the diffuse part of what the view reflects, for methods that know
 * the irradiance: exact for Lambert, Phong and Ward; of metallic-roughness the base under its coat,
 * seen at normal incidence. */
assay_rgb assay_bsdf_view_lambert(const assay_bsdf_view *view);

/* The reflectance that a G-buffer calls albedo: base colour (diffuse, metal or tint; of unlit
 * surfaces, too, though they scatter nothing) + specular colour for Phong and Ward. */
assay_rgb assay_bsdf_albedo(const assay_bsdf *bsdf);

#endif
