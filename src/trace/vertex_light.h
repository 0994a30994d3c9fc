/* vertex_light.h - a light, as a vertex gets it: for all that draw lights at a vertex. */
#ifndef ASSAY_TRACE_VERTEX_LIGHT_H
#define ASSAY_TRACE_VERTEX_LIGHT_H

#include <math.h>

#include "trace/vertex.h"

/* The vertex as lights see it. */
static inline assay_receiver assay_vertex_as_receiver(const assay_vertex *vertex)
{
    assay_receiver receiver = {.point = vertex->surface.position};
    if (!vertex->transmits) {
        receiver.normal = vertex->front ? vertex->surface.ng : vec3_negate(vertex->surface.ng);
    }
    return receiver;
}

/* A direction must be on the same side for the shading and the geometric normal: what one of them
 * calls reflection and the other transmission does not exist. */
static inline bool assay_vertex_sides_agree(const assay_vertex *vertex, assay_vec3 wi,
                                            bool transmitted)
{
    const bool crosses = (vec3_dot(wi, vertex->surface.ng) >= 0.0) != vertex->front;
    return crosses == transmitted;
}

/* Part of the light that gets to the vertex; *along_out: the way of the shadow ray, up to the light
 * where it is not infinite.  *count is raised by the rays traced. */
static inline double assay_vertex_sees_light(const assay_world *world, const assay_vertex *vertex,
                                             const assay_light_sample *light, assay_vec3 *along_out,
                                             uint64_t *count)
{
    /* In parts of the way: far above rounding, so that an emitter does not hide itself. */
    const double     before_light = 1.0 - 0x1p-30;
    const assay_vec3 origin =
        assay_world_offset(world, vertex->surface.position, vertex->surface.ng, light->direction);
    *along_out = light->infinite
                     ? light->direction
                     : vec3_sub(vec3_add(vertex->surface.position, light->to_light), origin);
    return assay_world_transmittance(world, origin, *along_out,
                                     light->infinite ? INFINITY : before_light, count);
}

#endif
