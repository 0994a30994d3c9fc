/* gather.h - fills a hemisphere with what rays from a surface point see. */
#ifndef ASSAY_GATHER_GATHER_H
#define ASSAY_GATHER_GATHER_H

#include "gather/hemisphere.h"
#include "trace/path_trace.h"

/* Where from. */
typedef struct {
    assay_vec3 position; /* m, on the surface                                            */
    assay_vec3 ng;       /* unit geometric normal on the side of frame.z: nothing is seen
                            under it                                                     */
    assay_frame3 frame;  /* z: unit normal of the hemisphere                             */
} assay_gather_site;

/* The side of a path vertex that is looked at. */
assay_gather_site assay_gather_site_of(const assay_vertex *vertex);

/* Radiance that leaves the vertex (placed, not dressed) that a cell sees, towards its wo, W/(m2
 * sr); called by many workers at once.  It may go on with the numbers of `random`. */
typedef assay_rgb (*assay_gather_radiance)(void *user, int cell, assay_vertex *vertex,
                                           assay_random *random, int worker);

typedef struct {
    const assay_world    *world;
    uint64_t              seed;
    assay_gather_radiance radiance;
    void                 *user;
    assay_ray_counts     *worker_counts; /* one a worker */
} assay_gatherer;

/* Fills all cells, in parallel: by rays, or by rasterisation where the strata are PLANE (what
 * blends is then there from coverage 1/2 on).  item: number of the hemisphere among those of the
 * seed; cell i takes its numbers from (seed, ASSAY_STAGE_GATHER, item, i), so the same item sees
 * the same. What misses everything, or looks under the geometric normal, has radiance 0 and
 * distance INFINITY: light from the sky is direct light.  Errors: DOMAIN (radiance that is no
 * finite number), MEMORY, CANCELLED. */
assay_status assay_gather(const assay_gatherer *gatherer, const assay_gather_site *site,
                          uint64_t item, assay_hemisphere *hemisphere);

/* What the ray of a cell met. */
typedef struct {
    bool         hit;
    assay_vertex vertex; /* where hit */
    assay_random random; /* as the radiance goes on with it */
} assay_gather_hit;

/* The same in two steps, for who wants to know all that is seen before any light is asked: rays,
 * with the light still 0 (of a PLANE blocks of cells in their order, the first from 0 on), ... */
assay_status assay_gather_rays(const assay_gatherer *gatherer, const assay_gather_site *site,
                               uint64_t item, int first, int count, assay_hemisphere *hemisphere,
                               assay_gather_hit *hits_out);
/* ... and the light of these cells.  Errors as assay_gather. */
assay_status assay_gather_light(const assay_gatherer *gatherer, int first, int count,
                                assay_gather_hit *hits, assay_hemisphere *hemisphere);

#endif
