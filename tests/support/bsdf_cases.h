/* bsdf_cases.h - the materials and directions that every test of the BSDFs runs over. */
#ifndef ASSAY_TESTS_BSDF_CASES_H
#define ASSAY_TESTS_BSDF_CASES_H

#include "trace/bsdf.h"

typedef struct {
    const char *name;
    assay_bsdf  bsdf;
    double width; /* radians, of the narrowest lobe that can be evaluated; 1 if none is narrow */
    bool   conserves; /* the albedo of the white variant is at most 1                      */
} bsdf_case;

int       bsdf_case_count(void);
bsdf_case bsdf_case_at(int index);

/* Nothing of it can be evaluated, whatever the direction. */
static inline bool bsdf_is_specular(const assay_bsdf *bsdf)
{
    return assay_bsdf_seen_from(bsdf, vec3(0.0, 0.0, 1.0)).specular;
}

/* The same with white base colour (Phong, Ward: diffuse + specular colour = 1). */
assay_bsdf bsdf_whitened(assay_bsdf bsdf);

/* Polar angles from 0 to nearly pi / 2, with azimuths off the axes. */
int        bsdf_direction_count(void);
assay_vec3 bsdf_direction_at(int index);

/* A solid that refracts has two different sides. */
bool bsdf_has_inside(const assay_bsdf *bsdf);

#endif
