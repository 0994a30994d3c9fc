/* visible_point.c - one ray through the centre of a pixel.
 *
 * Invariant: no random number is asked, so the point is a property of camera and size alone. */
#include "trace/visible_point.h"

#include "trace/camera_ray.h"

bool assay_visible_find(const assay_world *world, const assay_camera *camera, int width, int height,
                        int x, int y, assay_ray_counts *counts, assay_vertex *vertex_out)
{
    assay_vec3 origin, direction;
    assay_hit  hit;
    assay_camera_ray(camera, x + 0.5, y + 0.5, width, height, &origin, &direction);
    if (!assay_world_visible(world, origin, direction, &counts->camera, &hit)) {
        return false;
    }
    assay_vertex_place(world, &hit, direction, vertex_out);
    assay_vertex_dress(world, vertex_out);
    return true;
}

assay_visible_point assay_visible_describe(const assay_camera *camera, const assay_vertex *vertex)
{
    const double side = vertex->front ? 1.0 : -1.0;
    return (assay_visible_point){
        .hit       = true,
        .albedo    = assay_bsdf_albedo(&vertex->bsdf),
        .position  = vertex->surface.position,
        .ng        = vec3_scale(vertex->surface.ng, side),
        .ns        = vec3_scale(vertex->surface.ns, side),
        .z         = assay_camera_depth(camera, vertex->surface.position),
        .uv        = {vertex->surface.uv[0][0], vertex->surface.uv[0][1]},
        .material  = vertex->surface.material,
        .primitive = vertex->surface.triangle,
    };
}

assay_visible_point assay_visible_nothing(void)
{
    return (assay_visible_point){.material = UINT32_MAX, .primitive = UINT32_MAX};
}
