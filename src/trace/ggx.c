/* ggx.c - visible normals.
 *
 * Invariant: the result is a unit vector with z >= 0 for every wo with z > 0 and every u.
 * Stretching by alpha turns the microsurface into one with the normals of a hemisphere, whose
 * projection along wo is a disk cut by half a disk: the draw is uniform in that area [heitz18]. */
#include "trace/ggx.h"

#include "math/sampling.h"

assay_vec3 assay_ggx_sample_visible(double alpha, assay_vec3 wo, double u1, double u2)
{
    const assay_vec3 v       = vec3_normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const double     across2 = v.x * v.x + v.y * v.y;
    const double     inverse = across2 > 0.0 ? 1.0 / sqrt(across2) : 0.0;
    const assay_vec3 t1 =
        across2 > 0.0 ? vec3(-v.y * inverse, v.x * inverse, 0.0) : vec3(1.0, 0.0, 0.0);
    const assay_vec3   t2   = vec3_cross(v, t1);
    const assay_point2 disk = assay_sample_disk(u1, u2);
    const double       s    = 0.5 * (1.0 + v.z);
    const double       half = 1.0 - disk.x * disk.x;
    const double       y    = (1.0 - s) * sqrt(half > 0.0 ? half : 0.0) + s * disk.y;
    const double       z2   = half - y * y;
    const double       z    = sqrt(z2 > 0.0 ? z2 : 0.0);
    const assay_vec3   n    = vec3_mad(vec3_mad(vec3_scale(t1, disk.x), y, t2), z, v);
    const double       up   = n.z > 0.0 ? n.z : 0.0;
    return vec3_normalize(vec3(alpha * n.x, alpha * n.y, up));
}
