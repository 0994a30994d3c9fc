/* octree.h - which of many spheres hold a point?
 *
 * An item is a place and a reach; its number is its place in the order of adding.  Items come in no
 * order to lean on.  Walks may run in parallel with one another, never with a change. */
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

/* The item has a smaller reach from now on.  It moves down, unless memory is refused: then as far
 * as there are cubes, which costs walks time, but changes no answer. */
void assay_octree_shrink(assay_octree *octree, uint32_t number, double reach);

uint64_t assay_octree_bytes(const assay_octree *octree);

/* How far a walk has come; large (9 kB), so made once and started again. */
typedef struct {
    const assay_octree *octree;
    assay_vec3          point;
    double              unit[3]; /* the point in the root's cube    */
    double              margin;  /* a cube counts within this and   */
    double              growth;  /* this times its side             */
    double              more;    /* what is added to reaches, m     */
    double              squared; /* of the distance; < 0: the reach */
    uint32_t            block, next_block;
    unsigned            matches; /* of the block, a bit an item */
    uint32_t            looked;  /* items compared with the point so far: what a walk costs */
    int                 waiting;
    struct {
        double   low[3], side;
        uint32_t node;
    } stack[7 * ASSAY_OCTREE_DEPTH + 8];
} assay_octree_walk;

/* Over the items whose reach holds the point: d . d <= reach * reach as rounded, d = point - place.
 * None where a coordinate is NaN. */
void assay_octree_walk_about(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point);
/* The same for reaches that are all longer by `more`, m, >= 0: what walks about any point within
 * that distance would meet is among it, but for the rounding. */
void assay_octree_walk_around(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point,
                              double more);
/* Over the items whose place is within the distance of the point, whatever their reach:
 * d . d <= distance * distance as rounded; distance >= 0. */
void assay_octree_walk_near(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point,
                            double distance);
/* The next item, or ASSAY_OCTREE_END. */
uint32_t assay_octree_walk_next(assay_octree_walk *walk);

#endif
