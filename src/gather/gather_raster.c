/* gather_raster.c - first what every pixel sees, then the light of what is seen.
 *
 * The eye stands off the surface exactly as the origin of a gathering ray does, so a pixel sees
 * what the ray through its centre would.
 *
 * Invariant: a pixel's numbers come from its own stream and pixels are shaded by one worker each,
 * so nothing depends on threads. */
#include "gather/gather_raster.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "gather/hemisphere_plane.h"
#include "gather/raster.h"

/* Pixels of one piece of work. */
enum { CHUNK = 64 };

typedef struct {
    const assay_gatherer      *gatherer;
    const assay_gather_site   *site;
    uint64_t                   item;
    assay_hemisphere          *hemisphere;
    assay_raster_view          view;
    const assay_raster_sample *samples;
} raster_gather_job;

static bool shade(const raster_gather_job *job, int index, int worker)
{
    const assay_gatherer      *g      = job->gatherer;
    const assay_frame3        *frame  = &job->site->frame;
    const assay_raster_sample *sample = &job->samples[index];
    assay_cell                *cell   = &job->hemisphere->cells[index];
    *cell                      = (assay_cell){.distance = INFINITY, .direction = cell->direction};
    const assay_vec3 direction = frame3_to_world(frame, cell->direction);
    if (sample->triangle == ASSAY_NO_TRIANGLE || !(vec3_dot(direction, job->site->ng) > 0.0)) {
        return true;
    }
    const int       columns = job->view.columns;
    const assay_hit hit =
        assay_raster_hit(g->world->scene, &job->view, index % columns, index / columns, sample);
    assay_random random =
        assay_random_start(g->seed, ASSAY_STAGE_GATHER, job->item, (uint64_t)index);
    assay_vertex vertex;
    assay_vertex_place(g->world, &hit, direction, &vertex);
    cell->distance = hit.t;
    cell->hit_normal =
        frame3_to_local(frame, vertex.front ? vertex.surface.ng : vec3_negate(vertex.surface.ng));
    cell->radiance = g->radiance(g->user, index, &vertex, &random, worker);
    return rgb_finite(cell->radiance);
}

static assay_status shade_chunk(void *user, uint64_t chunk, int worker)
{
    const raster_gather_job *job   = user;
    const int                count = job->view.columns * job->view.rows;
    const int                first = (int)chunk * CHUNK;
    for (int i = first; i < first + CHUNK && i < count; i++) {
        if (!shade(job, i, worker)) {
            return ASSAY_ERR_DOMAIN;
        }
    }
    return ASSAY_OK;
}

assay_status gather_raster(const assay_gatherer *gatherer, const assay_gather_site *site,
                           uint64_t item, assay_hemisphere *hemisphere)
{
    const assay_world      *world   = gatherer->world;
    assay_context          *context = world->scene->context;
    const hemisphere_plane *plane   = hemisphere->plane;
    const size_t            count   = (size_t)plane->columns * (size_t)plane->rows;
    assay_raster_sample    *samples = assay_allocate(context, count, sizeof *samples);
    const raster_gather_job job     = {
            .gatherer   = gatherer,
            .site       = site,
            .item       = item,
            .hemisphere = hemisphere,
            .samples    = samples,
            .view       = {.eye     = assay_world_offset(world, site->position, site->ng, site->ng),
                           .frame   = site->frame,
                           .half    = plane->half,
                           .columns = plane->columns,
                           .rows    = plane->rows}};
    if (!samples) {
        return assay_fail_memory(context, "a rasterised hemisphere");
    }
    assay_status status = assay_raster_draw(world, &job.view, samples);
    if (status == ASSAY_OK) {
        status = assay_parallel_for(context, NULL, (count + CHUNK - 1) / CHUNK, shade_chunk,
                                    (void *)&job);
    }
    assay_release(context, samples);
    return status == ASSAY_ERR_DOMAIN ? assay_world_fail_light(world) : status;
}
