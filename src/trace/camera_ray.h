/* camera_ray.h - the ray through a point of the image. */
#ifndef ASSAY_TRACE_CAMERA_RAY_H
#define ASSAY_TRACE_CAMERA_RAY_H

#include "scene/scene_data.h"

/* x in [0, width], y in [0, height], pixels, from the top left corner; the centre of pixel (i, j)
 * is (i + 1/2, j + 1/2).  Pixels are square: a perspective camera's yfov spans the height, an
 * orthographic one's xmag x ymag is fitted inside the image.  direction_out is a unit vector. */
void assay_camera_ray(const assay_camera *camera, double x, double y, int width, int height,
                      assay_vec3 *origin_out, assay_vec3 *direction_out);

/* Distance along the viewing axis of a world point (m): the layer Z. */
double assay_camera_depth(const assay_camera *camera, assay_vec3 point);

#endif
