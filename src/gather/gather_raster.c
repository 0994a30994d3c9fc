/* gather_raster.c - a plane instead of rays.
 *
 * Invariant: the eye stands off the surface exactly as the origin of a gathering ray does, so a
 * pixel sees what the ray through its centre would. */
#include "gather/gather_raster.h"

#include "gather/hemisphere_plane.h"

assay_status gather_raster_draw(const assay_world *world, const assay_gather_site *site,
                                assay_hemisphere *hemisphere)
{
    hemisphere_plane *plane = hemisphere->plane;
    plane->view =
        (assay_raster_view){.eye   = assay_world_offset(world, site->position, site->ng, site->ng),
                            .frame = site->frame,
                            .half  = plane->half,
                            .columns = plane->columns,
                            .rows    = plane->rows};
    return assay_raster_draw(world, &plane->view, plane->seen);
}

bool gather_raster_find(const assay_world *world, const assay_hemisphere *hemisphere, int cell,
                        assay_hit *hit_out)
{
    const hemisphere_plane    *plane  = hemisphere->plane;
    const assay_raster_sample *sample = &plane->seen[cell];
    if (sample->triangle == ASSAY_NO_TRIANGLE) {
        return false;
    }
    *hit_out = assay_raster_hit(world->scene, &plane->view, cell % plane->columns,
                                cell / plane->columns, sample);
    return true;
}
