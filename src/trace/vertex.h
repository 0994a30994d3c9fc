/* vertex.h - a vertex of a light path: a surface point, its BSDF, and where the path came from. */
#ifndef ASSAY_TRACE_VERTEX_H
#define ASSAY_TRACE_VERTEX_H

#include "trace/bsdf.h"
#include "trace/world.h"

typedef struct {
    assay_surface surface;
    assay_bsdf    bsdf;
    assay_frame3  frame; /* the BSDF's frame in the world                          */
    assay_vec3    wo;    /* unit, world: to where the path came from               */
    assay_vec3    wo_local;
    bool          front;     /* wo on the geometric front                              */
    bool          transmits; /* something may pass to the other side                   */
    bool          dressed;   /* bsdf is there                                          */
} assay_vertex;

/* The vertex at a hit of a ray with this unit direction: all but its BSDF, whose texels are sent
 * for.  What needs no BSDF is best done before the vertex is dressed. */
void assay_vertex_place(const assay_world *world, const assay_hit *hit, assay_vec3 direction,
                        assay_vertex *vertex_out);

/* Looks up the BSDF, unless that is done. */
void assay_vertex_dress(const assay_world *world, assay_vertex *vertex);

/* The BSDF of a material whose values at a point are these. */
assay_bsdf assay_vertex_bsdf(const assay_material *material, const assay_surface_material *at);

/* A vertex that measures irradiance at a point facing frame->z: a Lambertian whose BSDF is 1, so
 * that what it reflects is the integral of radiance times cosine. ng: unit geometric normal on the
 * same side, under which nothing arrives. */
void assay_vertex_receiver(assay_vec3 position, const assay_frame3 *frame, assay_vec3 ng,
                           assay_vertex *vertex_out);

#endif
