/* visible_point.h - what a pixel shows: the point that a G-buffer holds and a cache interpolates
 * at.
 */
#ifndef ASSAY_TRACE_VISIBLE_POINT_H
#define ASSAY_TRACE_VISIBLE_POINT_H

#include "io/film.h"
#include "trace/vertex.h"

/* The vertex, dressed, that the ray through the centre of pixel (x, y) of a width x height image
 * ends at; false where it leaves the scene. */
bool assay_visible_find(const assay_world *world, const assay_camera *camera, int width, int height,
                        int x, int y, assay_ray_counts *counts, assay_vertex *vertex_out);

/* The same as a film takes it. */
assay_visible_point assay_visible_describe(const assay_camera *camera, const assay_vertex *vertex);

/* Where nothing is seen. */
assay_visible_point assay_visible_nothing(void);

#endif
