#include "bsdf_cases.h"

#include <math.h>

#include "core/numerics.h"

/* Rows that have nothing to say about a parameter leave it 0; see bsdf_case_at. */
typedef struct { /* ordered for the reader NOLINT(clang-analyzer-optin.performance.Padding) */
    const char      *name;
    assay_bsdf_model model;
    double           metallic, roughness, ior, specular_factor, transmission;
    bool             solid;
    double           exponent, alpha_x, alpha_y;
    bool             tinted; /* a specular colour that is not grey */
    bool             conserves;
} row;

#define LAMBERT ASSAY_BSDF_LAMBERT
#define GLTF ASSAY_BSDF_METALLIC_ROUGHNESS
#define PHONG ASSAY_BSDF_PHONG
#define WARD ASSAY_BSDF_WARD
#define WARD92 ASSAY_BSDF_WARD_PUBLISHED

static const row ROWS[] = {
    {"lambert", LAMBERT, 0, 1, 1.5, 1, 0, false, 0, 1, 1, false, true},
    {"plastic 1", GLTF, 0, 1.0, 1.5, 1, 0, false, 0, 1, 1, false, false},
    {"plastic 0.5", GLTF, 0, 0.5, 1.5, 1, 0, false, 0, 1, 1, false, false},
    {"plastic 0.2", GLTF, 0, 0.2, 1.5, 1, 0, false, 0, 1, 1, false, false},
    {"plastic smooth", GLTF, 0, 0.0, 1.5, 1, 0, false, 0, 1, 1, false, false},
    {"plastic tinted", GLTF, 0, 0.4, 1.8, 0.6, 0, false, 0, 1, 1, true, false},
    {"plastic no specular", GLTF, 0, 0.4, 1.5, 0, 0, false, 0, 1, 1, false, true},
    {"plastic ior 1", GLTF, 0, 0.4, 1.0, 1, 0, false, 0, 1, 1, false, false},
    {"plastic ior 0", GLTF, 0, 0.4, 0.0, 1, 0, false, 0, 1, 1, true, true},
    {"metal 1", GLTF, 1, 1.0, 1.5, 1, 0, false, 0, 1, 1, false, true},
    {"metal 0.5", GLTF, 1, 0.5, 1.5, 1, 0, false, 0, 1, 1, false, true},
    {"metal 0.15", GLTF, 1, 0.15, 1.5, 1, 0, false, 0, 1, 1, false, true},
    {"metal smooth", GLTF, 1, 0.0, 1.5, 1, 0, false, 0, 1, 1, false, true},
    {"half metal", GLTF, 0.5, 0.4, 1.5, 1, 0, false, 0, 1, 1, false, false},
    {"thin 0.3", GLTF, 0, 0.3, 1.5, 1, 1.0, false, 0, 1, 1, false, true},
    {"thin 0.8", GLTF, 0, 0.8, 1.5, 1, 1.0, false, 0, 1, 1, false, true},
    {"thin half", GLTF, 0.2, 0.6, 1.5, 0.8, 0.6, false, 0, 1, 1, true, false},
    {"thin smooth", GLTF, 0, 0.0, 1.5, 1, 1.0, false, 0, 1, 1, false, true},
    {"solid 0.3", GLTF, 0, 0.3, 1.5, 1, 1.0, true, 0, 1, 1, false, true},
    {"solid 0.7", GLTF, 0, 0.7, 1.5, 1, 1.0, true, 0, 1, 1, false, true},
    {"solid water", GLTF, 0, 0.5, 1.33, 1, 1.0, true, 0, 1, 1, false, true},
    {"solid diamond", GLTF, 0, 0.5, 2.42, 1, 1.0, true, 0, 1, 1, false, true},
    {"solid half", GLTF, 0.2, 0.5, 1.5, 0.5, 0.6, true, 0, 1, 1, true, false},
    {"solid no specular", GLTF, 0, 0.5, 1.5, 0, 1.0, true, 0, 1, 1, false, true},
    {"solid smooth", GLTF, 0, 0.0, 1.5, 1, 1.0, true, 0, 1, 1, false, true},
    {"solid matched", GLTF, 0.3, 0.5, 1.0, 1, 0.5, true, 0, 1, 1, false, true},
    {"phong 0", PHONG, 0, 1, 1.5, 1, 0, false, 0.0, 1, 1, true, true},
    {"phong 1", PHONG, 0, 1, 1.5, 1, 0, false, 1.0, 1, 1, true, true},
    {"phong 20", PHONG, 0, 1, 1.5, 1, 0, false, 20.0, 1, 1, true, true},
    {"phong 1e4", PHONG, 0, 1, 1.5, 1, 0, false, 1e4, 1, 1, true, true},
    {"ward 0.15", WARD, 0, 1, 1.5, 1, 0, false, 0, 0.15, 0.15, true, true},
    {"ward 0.5 0.1", WARD, 0, 1, 1.5, 1, 0, false, 0, 0.5, 0.1, true, true},
    {"ward 1", WARD, 0, 1, 1.5, 1, 0, false, 0, 1.0, 1.0, true, true},
    {"ward92 0.15", WARD92, 0, 1, 1.5, 1, 0, false, 0, 0.15, 0.15, true, false},
    {"ward92 0.5 0.1", WARD92, 0, 1, 1.5, 1, 0, false, 0, 0.5, 0.1, true, false},
};

int bsdf_case_count(void) { return (int)(sizeof ROWS / sizeof *ROWS); }

static double lobe_width(const row *r)
{
    switch (r->model) {
    case GLTF: return r->roughness >= 0.01 ? fmin(1.0, r->roughness * r->roughness) : 1.0;
    case PHONG: return r->exponent > 20.0 ? 1.0 / sqrt(r->exponent) : 1.0;
    case WARD:
    case WARD92: return fmin(r->alpha_x, r->alpha_y);
    default: return 1.0;
    }
}

bsdf_case bsdf_case_at(int index)
{
    const row *r      = &ROWS[index];
    assay_bsdf b      = assay_bsdf_default(r->model);
    b.base_color      = rgb(0.7, 0.4, 0.2);
    b.metallic        = r->metallic;
    b.roughness       = r->roughness;
    b.ior             = r->ior;
    b.specular_factor = r->specular_factor;
    b.transmission    = r->transmission;
    b.solid           = r->solid;
    b.exponent        = r->exponent;
    b.alpha_x         = r->alpha_x;
    b.alpha_y         = r->alpha_y;
    b.specular_color  = r->tinted ? rgb(0.3, 0.6, 0.8) : rgb_grey(1.0);
    return (bsdf_case){r->name, b, lobe_width(r), r->conserves};
}

assay_bsdf bsdf_whitened(assay_bsdf bsdf)
{
    bsdf.base_color = rgb_grey(1.0);
    if (bsdf.model == PHONG || bsdf.model == WARD || bsdf.model == WARD92) {
        bsdf.base_color     = rgb_grey(0.25);
        bsdf.specular_color = rgb_grey(0.75);
    }
    return bsdf;
}

static const double ANGLES[][2] = {
    {0.0, 0.0}, {0.5, 0.3}, {1.0, 2.5}, {1.35, -1.0}, {1.52, -2.6}, {1.5705, 1.1},
};

int bsdf_direction_count(void) { return (int)(sizeof ANGLES / sizeof *ANGLES); }

assay_vec3 bsdf_direction_at(int index)
{
    const assay_sincos polar   = assay_sincos_radians(ANGLES[index][0]);
    const assay_sincos azimuth = assay_sincos_radians(ANGLES[index][1]);
    return vec3(polar.sin * azimuth.cos, polar.sin * azimuth.sin, polar.cos);
}

bool bsdf_has_inside(const assay_bsdf *bsdf)
{
    return bsdf->model == ASSAY_BSDF_METALLIC_ROUGHNESS && bsdf->solid;
}
