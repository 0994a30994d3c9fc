/* gather.c - one ray a cell.
 *
 * Invariant: a cell's numbers come from its own stream and cells are written by one worker each, so
 * nothing depends on threads. */
#include "gather/gather.h"

#include "core/parallel.h"
#include "gather/gather_raster.h"

/* Rays of one piece of work: enough to pay for handing it out. */
enum { CHUNK = 32 };

typedef struct {
    const assay_gatherer    *gatherer;
    const assay_gather_site *site;
    uint64_t                 item;
    assay_hemisphere        *hemisphere;
} gather_job;

assay_gather_site assay_gather_site_of(const assay_vertex *vertex)
{
    const double side = vertex->front ? 1.0 : -1.0;
    return (assay_gather_site){
        .position = vertex->surface.position,
        .ng       = vec3_scale(vertex->surface.ng, side),
        .frame    = frame3_from_z(vec3_scale(vertex->surface.ns, side)),
    };
}

static bool look(const gather_job *job, int index, int worker)
{
    const assay_gatherer          *g      = job->gatherer;
    const assay_gather_site       *site   = job->site;
    const assay_hemisphere_layout *layout = &job->hemisphere->layout;
    assay_cell                    *cell   = &job->hemisphere->cells[index];
    assay_ray_counts              *counts = &g->worker_counts[worker];
    assay_random                   random =
        assay_random_start(g->seed, ASSAY_STAGE_GATHER, job->item, (uint64_t)index);
    double u1 = 0.5, u2 = 0.5;
    if (layout->jitter) {
        u1 = assay_random_next(&random);
        u2 = assay_random_next(&random);
    }
    *cell                      = (assay_cell){.distance  = INFINITY,
                                              .direction = assay_hemisphere_direction(layout, index / layout->phi,
                                                                                      index % layout->phi, u1, u2)};
    const assay_vec3 direction = frame3_to_world(&site->frame, cell->direction);
    if (!(vec3_dot(direction, site->ng) > 0.0)) {
        return true;
    }
    assay_hit hit;
    if (!assay_world_closest(g->world,
                             assay_world_offset(g->world, site->position, site->ng, direction),
                             direction, false, &random, &counts->scatter, &hit)) {
        return true;
    }
    assay_vertex vertex;
    assay_vertex_place(g->world, &hit, direction, &vertex);
    cell->distance   = hit.t;
    cell->hit_normal = frame3_to_local(&site->frame, vertex.front ? vertex.surface.ng
                                                                  : vec3_negate(vertex.surface.ng));
    cell->radiance   = g->radiance(g->user, index, &vertex, &random, worker);
    return rgb_finite(cell->radiance);
}

static assay_status look_at_chunk(void *user, uint64_t chunk, int worker)
{
    const gather_job *job   = user;
    const int         cells = job->hemisphere->layout.theta * job->hemisphere->layout.phi;
    const int         first = (int)chunk * CHUNK;
    for (int i = first; i < first + CHUNK && i < cells; i++) {
        if (!look(job, i, worker)) {
            return ASSAY_ERR_DOMAIN;
        }
    }
    return ASSAY_OK;
}

assay_status assay_gather(const assay_gatherer *gatherer, const assay_gather_site *site,
                          uint64_t item, assay_hemisphere *hemisphere)
{
    if (hemisphere->layout.strata == ASSAY_STRATA_PLANE) {
        return gather_raster(gatherer, site, item, hemisphere);
    }
    const uint64_t cells   = (uint64_t)hemisphere->layout.theta * (uint64_t)hemisphere->layout.phi;
    gather_job     job     = {gatherer, site, item, hemisphere};
    assay_context *context = gatherer->world->scene->context;
    const assay_status status =
        assay_parallel_for(context, NULL, (cells + CHUNK - 1) / CHUNK, look_at_chunk, &job);
    return status == ASSAY_ERR_DOMAIN ? assay_world_fail_light(gatherer->world) : status;
}
