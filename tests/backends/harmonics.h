/* harmonics.h - stages `project`, `convert`, `rotate` and `reflect`: light in harmonics. */
#ifndef BACKEND_HARMONICS_H
#define BACKEND_HARMONICS_H

#include "bundle.h"

enum { HARMONICS_ORDER = 6, HARMONICS_SH_ORDER = 8 };

/* Light and a lobe from samples of the hemisphere into HSH, their product, and light on to SH. */
void harmonics_of_hemisphere(bundle *to);

/* What the radiance records of a bundle say in a lobe about their normals. */
void harmonics_of_records(const bundle *from, bundle *to);

/* Light from samples of the sphere into SH, turned by the angles of the manifest, and on to HSH. */
void harmonics_of_sphere(bundle *to);

#endif
