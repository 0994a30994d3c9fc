/* environment.h - light from infinitely far: a latitude-longitude map.
 *
 * Row 0 looks to +Y; the middle column of the map looks to -Z, and columns go to the right as seen
 * from inside ([docs/conventions]).  Between texel centres radiance is constant (a texel is a patch
 * of the sphere), so that importance sampling is exact and integrals are sums. */
#ifndef ASSAY_SCENE_ENVIRONMENT_H
#define ASSAY_SCENE_ENVIRONMENT_H

#include "scene/scene_data.h"

/* Takes the channels R, G, B of an image; scale and rotation as in assay_scene_options.
 * Errors: FORMAT (no R, G, B; negative, NaN or infinite radiance), LIMIT, MEMORY. */
struct assay_image;
assay_status assay_environment_create(assay_context *context, const struct assay_image *image,
                                      double scale, double rotation, const char *path,
                                      assay_environment **environment_out);
void         assay_environment_destroy(assay_environment *environment);

/* Radiance from a unit direction, W/(m2 sr). */
assay_rgb assay_environment_radiance(const assay_environment *environment, assay_vec3 direction);

/* Draws a direction with density proportional to luminance; pdf_out in 1/sr, 0 only for a black
 * map. */
assay_vec3 assay_environment_sample(const assay_environment *environment, double u1, double u2,
                                    double *pdf_out);
double     assay_environment_pdf(const assay_environment *environment, assay_vec3 direction);

/* Integral of radiance over the sphere, W/m2. */
assay_rgb assay_environment_integral(const assay_environment *environment);

#endif
