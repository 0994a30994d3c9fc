/* camera_ray.c - pinhole and orthographic cameras. */
#include "trace/camera_ray.h"

#include "core/numerics.h"

void assay_camera_ray(const assay_camera *camera, double x, double y, int width, int height,
                      assay_vec3 *origin_out, assay_vec3 *direction_out)
{
    const double aspect = (double)width / (double)height;
    const double sx     = 2.0 * x / width - 1.0;  /* right */
    const double sy     = 1.0 - 2.0 * y / height; /* up    */
    if (camera->orthographic) {
        const double half_height = fmax(camera->ymag, camera->xmag / aspect);
        const double half_width  = half_height * aspect;
        *origin_out    = vec3_mad(vec3_mad(camera->position, sx * half_width, camera->right),
                                  sy * half_height, camera->up);
        *direction_out = camera->forward;
        return;
    }
    const double half_height = camera->tan_half_yfov;
    const double half_width  = half_height * aspect;
    *origin_out              = camera->position;
    *direction_out           = vec3_normalize(vec3_mad(
                  vec3_mad(camera->forward, sx * half_width, camera->right), sy * half_height, camera->up));
}

double assay_camera_depth(const assay_camera *camera, assay_vec3 point)
{
    return vec3_dot(vec3_sub(point, camera->position), camera->forward);
}
