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
    assay_gather_hit        *hits; /* of the cells from first on; NULL: none are kept */
    int                      first, end;
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

/* What is met in a cell's direction. */
static bool meet(const gather_job *job, int index, assay_vec3 direction, int worker,
                 assay_random *random, assay_hit *hit_out)
{
    const assay_gatherer    *g    = job->gatherer;
    const assay_gather_site *site = job->site;
    if (job->hemisphere->plane) {
        return gather_raster_find(g->world, job->hemisphere, index, hit_out);
    }
    return assay_world_closest(
        g->world, assay_world_offset(g->world, site->position, site->ng, direction), direction,
        false, random, &g->worker_counts[worker].scatter, hit_out);
}

/* Local; pixels are looked at through their middles, as they were made. */
static assay_vec3 direction_of(const gather_job *job, int index, assay_random *random)
{
    const assay_hemisphere_layout *layout = &job->hemisphere->layout;
    if (job->hemisphere->plane) {
        return job->hemisphere->cells[index].direction;
    }
    double u1 = 0.5, u2 = 0.5;
    if (layout->jitter) {
        u1 = assay_random_next(random);
        u2 = assay_random_next(random);
    }
    return assay_hemisphere_direction(layout, index / layout->phi, index % layout->phi, u1, u2);
}

static void trace(const gather_job *job, int index, int worker, assay_gather_hit *hit_out)
{
    const assay_gatherer    *g      = job->gatherer;
    const assay_gather_site *site   = job->site;
    assay_cell              *cell   = &job->hemisphere->cells[index];
    assay_random            *random = &hit_out->random;
    *random      = assay_random_start(g->seed, ASSAY_STAGE_GATHER, job->item, (uint64_t)index);
    hit_out->hit = false;
    const assay_vec3 local     = direction_of(job, index, random);
    *cell                      = (assay_cell){.distance = INFINITY, .direction = local};
    const assay_vec3 direction = frame3_to_world(&site->frame, local);
    if (!(vec3_dot(direction, site->ng) > 0.0)) {
        return;
    }
    assay_hit hit;
    if (!meet(job, index, direction, worker, random, &hit)) {
        return;
    }
    assay_vertex *vertex = &hit_out->vertex;
    assay_vertex_place(g->world, &hit, direction, vertex);
    hit_out->hit     = true;
    cell->distance   = hit.t;
    cell->hit_normal = frame3_to_local(
        &site->frame, vertex->front ? vertex->surface.ng : vec3_negate(vertex->surface.ng));
}

static bool light(const gather_job *job, int index, int worker, assay_gather_hit *hit)
{
    const assay_gatherer *g    = job->gatherer;
    assay_cell           *cell = &job->hemisphere->cells[index];
    if (hit->hit) {
        cell->radiance = g->radiance(g->user, index, &hit->vertex, &hit->random, worker);
    }
    return rgb_finite(cell->radiance);
}

static assay_status serve(void *user, uint64_t chunk, int worker)
{
    const gather_job *job   = user;
    const int         first = job->first + (int)chunk * CHUNK;
    assay_gather_hit  own   = {0};
    for (int i = first; i < first + CHUNK && i < job->end; i++) {
        assay_gather_hit *hit = job->hits ? &job->hits[i - job->first] : &own;
        if (job->site) {
            trace(job, i, worker, hit);
        }
        if ((!job->site || !job->hits) && !light(job, i, worker, hit)) {
            return ASSAY_ERR_DOMAIN;
        }
    }
    return ASSAY_OK;
}

/* Rays where there is a site to send them from, light unless their hits are kept for later. */
static assay_status run(gather_job *job)
{
    const uint64_t     chunks = ((uint64_t)(job->end - job->first) + CHUNK - 1) / CHUNK;
    const assay_world *world  = job->gatherer->world;
    assay_status       status = ASSAY_OK;
    if (job->site && job->hemisphere->plane && job->first == 0) {
        status = gather_raster_draw(world, job->site, job->hemisphere);
    }
    status = status ? status : assay_parallel_for(world->scene->context, NULL, chunks, serve, job);
    return status == ASSAY_ERR_DOMAIN ? assay_world_fail_light(world) : status;
}

assay_status assay_gather(const assay_gatherer *gatherer, const assay_gather_site *site,
                          uint64_t item, assay_hemisphere *hemisphere)
{
    const int  cells = hemisphere->layout.theta * hemisphere->layout.phi;
    gather_job job   = {gatherer, site, item, hemisphere, NULL, 0, cells};
    return run(&job);
}

assay_status assay_gather_rays(const assay_gatherer *gatherer, const assay_gather_site *site,
                               uint64_t item, int first, int count, assay_hemisphere *hemisphere,
                               assay_gather_hit *hits_out)
{
    gather_job job = {gatherer, site, item, hemisphere, hits_out, first, first + count};
    return run(&job);
}

assay_status assay_gather_light(const assay_gatherer *gatherer, int first, int count,
                                assay_gather_hit *hits, assay_hemisphere *hemisphere)
{
    gather_job job = {gatherer, NULL, 0, hemisphere, hits, first, first + count};
    return run(&job);
}
