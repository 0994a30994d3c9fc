/* bvh_visit.h - a walk through the tree for questions other than rays. */
#ifndef ASSAY_TRACE_BVH_VISIT_H
#define ASSAY_TRACE_BVH_VISIT_H

#include "trace/bvh.h"

enum { ASSAY_BVH_BOXES = 8 };

/* low x, high x, low y, high y, low z, high z of up to ASSAY_BVH_BOXES boxes, m; an absent one has
 * low = +inf and high = -inf. */
typedef float assay_bvh_planes[6][ASSAY_BVH_BOXES];

/* Boxes are asked for together; a key of INFINITY leaves one out with all that is in it, the others
 * are walked through in the order of their keys, the smallest first, each with all that is in it
 * before the next.  Triangles without an area are not met. */
typedef struct {
    void (*boxes)(void *user, const assay_bvh_planes planes, double keys_out[ASSAY_BVH_BOXES]);
    void (*triangle)(void *user, uint32_t triangle);
} assay_bvh_visitor;

void assay_bvh_visit(const assay_bvh *bvh, const assay_bvh_visitor *visitor, void *user);

#endif
