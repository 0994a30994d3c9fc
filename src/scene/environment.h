/* environment.h - light from infinitely far: a latitude-longitude map.
 *
 * At x in [0, 1) from the left and y in [0, 1) from the top of the map, with phi = 2 pi (x - 1/2)
 * and theta = pi y, the direction is (sin theta sin phi, cos theta, -sin theta cos phi): the top
 * row looks to +Y, the middle column to -Z, and columns go to the right as seen from inside (-Z,
 * +X, +Z).  The rotation turns the map about +Y, counter-clockwise as seen from above.
 *
 * A texel is a patch of the sphere with constant radiance, so that importance sampling is exact and
 * integrals are sums. */
#ifndef ASSAY_SCENE_ENVIRONMENT_H
#define ASSAY_SCENE_ENVIRONMENT_H

#include "scene/scene_data.h"

/* Takes the channels R, G, B of an image; scale and rotation as in assay_scene_options.
 * path is for messages.  Errors: FORMAT (no R, G, B; negative, NaN or infinite radiance), LIMIT
 * (over 2^27 texels, or radiance too large to sum), MEMORY. */
struct assay_image;
assay_status assay_environment_create(assay_context *context, const struct assay_image *image,
                                      double scale, double rotation, const char *path,
                                      assay_environment **environment_out);
void         assay_environment_destroy(assay_environment *environment);

/* The map as an image again: R, G, B, unscaled, unturned.  Errors: MEMORY. */
assay_status assay_environment_image(const assay_environment *environment,
                                     struct assay_image     **image_out);
/* What its radiance is multiplied with. */
double assay_environment_scale(const assay_environment *environment);

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
