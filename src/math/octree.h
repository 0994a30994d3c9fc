/* octree.h - which of many spheres may hold a point?
 *
 * An item is a place and a reach; its number is its place in the order of adding.  A walk over the
 * items about a point offers every item that is within its reach of the point, and some that are
 * not: the caller looks again.  It offers them in no order to lean on.  Walks may run in parallel
 * with one another, never with a change. */
#ifndef ASSAY_MATH_OCTREE_H
#define ASSAY_MATH_OCTREE_H

#include <stdint.h>

#include "core/context.h"
#include "math/vec.h"

typedef struct assay_octree assay_octree;

/* No item: the end of a walk. */
#define ASSAY_OCTREE_END UINT32_MAX

/* Levels below the root: the smallest cube has 2^-32 of the root's side. */
enum { ASSAY_OCTREE_DEPTH = 32 };

/* low, high: where the items will be, m.  Items outside are held, too, but every walk looks at
 * each of them; so it is for all items where the bounds are not finite, are empty, or are not
 * within 1e-100 ... 1e100 m in size.  Errors: MEMORY. */
assay_status assay_octree_create(assay_context *context, assay_vec3 low, assay_vec3 high,
                                 assay_octree **octree_out);
void         assay_octree_destroy(assay_octree *octree);

/* reach: m, >= 0; may be INFINITY.  The octree is as it was on error.  Errors: MEMORY, LIMIT. */
assay_status assay_octree_add(assay_octree *octree, assay_vec3 place, double reach);

/* The item at that place, the one it was added with, has a smaller reach from now on.  It moves
 * down, unless memory for new cubes is refused: then as far as there are cubes, which costs time,
 * but changes no answer. */
void assay_octree_shrink(assay_octree *octree, uint32_t number, assay_vec3 place, double reach);

uint64_t assay_octree_bytes(const assay_octree *octree);

/* How far a walk has come; large (9 kB), so made once and started again. */
typedef struct {
    const assay_octree *octree;
    double              at[3];  /* the point, in the root's side */
    double              fixed;  /* a cube counts within this and */
    double              growth; /* this times its side           */
    uint32_t            item;
    int                 waiting;
    struct {
        double   low[3], side;
        uint32_t node;
    } stack[7 * ASSAY_OCTREE_DEPTH + 8];
} assay_octree_walk;

/* Over the items that may be within their reach of the point. */
void assay_octree_walk_about(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point);
/* Over the items whose place may be within the distance of the point, whatever their reach. */
void assay_octree_walk_near(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point,
                            double distance);
/* The next item, or ASSAY_OCTREE_END. */
uint32_t assay_octree_walk_next(assay_octree_walk *walk);

#endif
