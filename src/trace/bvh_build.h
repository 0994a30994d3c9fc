/* bvh_build.h - between the builder and the copy of its tree: groups of triangles, and boxes. */
#ifndef ASSAY_TRACE_BVH_BUILD_H
#define ASSAY_TRACE_BVH_BUILD_H

#include <math.h>

#include "trace/bvh_tree.h"

/* What Embree's callbacks make: a group of nodes, or a leaf's triangles. */
typedef struct {
    uint32_t count;
    uint32_t is_leaf;
} raw_header;

typedef struct {
    raw_header        header;
    const raw_header *child[BVH_WIDTH];
} raw_node;

typedef struct {
    raw_header header;
    uint32_t   triangle[BVH_LEAF_SIZE];
} raw_leaf;

typedef struct {
    float low[3], high[3];
} box;

static inline box box_empty(void)
{
    return (box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

static inline void box_add(box *b, const box *other)
{
    for (int k = 0; k < 3; k++) {
        b->low[k]  = other->low[k] < b->low[k] ? other->low[k] : b->low[k];
        b->high[k] = other->high[k] > b->high[k] ? other->high[k] : b->high[k];
    }
}

static inline const float *corner_of(const assay_triangles *t, uint32_t triangle, int corner)
{
    return t->positions + 3 * (size_t)t->indices[3 * (size_t)triangle + (size_t)corner];
}

static inline box triangle_box(const assay_triangles *t, uint32_t triangle)
{
    box b = box_empty();
    for (int c = 0; c < 3; c++) {
        const float *p     = corner_of(t, triangle, c);
        const box    point = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
        box_add(&b, &point);
    }
    return b;
}

/* Copies the tree of raw groups into bvh->memory; sets memory, bytes, root and depth.
 * Errors: MEMORY, LIMIT, INTERNAL (deeper or wider than the layout can hold). */
assay_status bvh_flatten(assay_bvh *bvh, const raw_header *root);

#endif
