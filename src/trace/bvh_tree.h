/* bvh_tree.h - the tree in memory, and the kernels that walk it.  For bvh*.c and its tests alone.
 *
 * One block of memory holds inner nodes of eight children and leaves of four triangles, depth
 * first.  A reference is an offset in units of BVH_UNIT bytes; BVH_LEAF_BIT marks a leaf. */
#ifndef ASSAY_TRACE_BVH_TREE_H
#define ASSAY_TRACE_BVH_TREE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trace/bvh.h"

enum {
    BVH_WIDTH     = 8,  /* children of a node       */
    BVH_LEAF_SIZE = 4,  /* triangles of a leaf      */
    BVH_UNIT      = 32, /* bytes a reference counts */
    BVH_MAX_DEPTH = 64, /* nodes on the way to a leaf; checked by the builder */
    BVH_MAX_STACK = BVH_MAX_DEPTH * (BVH_WIDTH - 1) + 1
};

#define BVH_LEAF_BIT 0x80000000U

/* Boxes: low x, high x, low y, high y, low z, high z of each child, exact bounds of its triangles.
 * An absent child has low = +inf and high = -inf, which no ray meets. */
typedef struct {
    float    plane[6][BVH_WIDTH];
    uint32_t child[BVH_WIDTH];
} bvh_node;

/* Triangles side by side: vertex[corner][axis][lane].  An absent lane is NaN. */
typedef struct {
    float    vertex[3][3][BVH_LEAF_SIZE];
    uint32_t triangle[BVH_LEAF_SIZE];
} bvh_leaf;

_Static_assert(sizeof(bvh_node) % BVH_UNIT == 0, "a node is a whole number of units");
_Static_assert(sizeof(bvh_leaf) % BVH_UNIT == 0, "a leaf is a whole number of units");

/* Safety margins, derived in docs/exact-hits.md, and the shape of the tree.  Only tests change
 * them: to see a wrong margin fail, or another tree give the same answers. */
typedef struct {
    double   box_margin;     /* of the distances to boxes, in units of M |1/d|             */
    double   residual_limit; /* of a plain decision, in units of M; above, it is refined   */
    uint32_t leaf_size;      /* 1 .. BVH_LEAF_SIZE                                         */
    uint32_t width;          /* 2 .. BVH_WIDTH                                             */
    int64_t  embree_limit;   /* bytes that Embree may use while it builds; 0: any number   */
} bvh_tuning;

bvh_tuning bvh_tuning_default(void);

/* One way to walk the tree; all give the same answers. */
typedef struct {
    const char *name;
    bool (*supported)(void);
    bool (*closest)(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out);
    bool (*occluded)(const assay_bvh *bvh, const assay_ray *ray);
} bvh_kernel;

extern const bvh_kernel bvh_kernel_avx2, bvh_kernel_sse2, bvh_kernel_neon; /* float boxes */
extern const bvh_kernel bvh_kernel_double; /* double boxes, any machine, any range of numbers */

struct assay_bvh {
    assay_context    *context;
    assay_triangles   triangles;
    bvh_tuning        tuning;
    const bvh_kernel *kernel;
    unsigned char    *memory; /* NULL: no triangle that can be hit */
    uint64_t          bytes;
    uint32_t          root;
    uint32_t          depth; /* nodes on the longest way to a leaf                              */
    double extent;           /* L: largest |coordinate| of a triangle that can be hit, m          */
};

static inline const bvh_node *bvh_node_at(const assay_bvh *bvh, uint32_t reference)
{
    return (const bvh_node *)(const void *)(bvh->memory + (size_t)reference * BVH_UNIT);
}

static inline const bvh_leaf *bvh_leaf_at(const assay_bvh *bvh, uint32_t reference)
{
    const size_t unit = reference & ~BVH_LEAF_BIT;
    return (const bvh_leaf *)(const void *)(bvh->memory + unit * BVH_UNIT);
}

/* Whether the triangle has no area, as double arithmetic sees it; such a one is never hit. */
bool bvh_triangle_is_degenerate(const assay_triangles *triangles, uint32_t triangle);

/* As assay_bvh_create, with other margins and another shape of the tree; kernel NULL: the best
 * that the context's ISA allows. */
assay_status bvh_create_tuned(assay_context *context, const assay_triangles *triangles,
                              const bvh_tuning *tuning, const bvh_kernel *kernel,
                              assay_bvh **bvh_out);

/* Fills in memory, bytes, root, depth and extent; on an error nothing is held.
 * isa as in assay_context_isa. */
assay_status bvh_build(assay_bvh *bvh, const char *isa);

#endif
