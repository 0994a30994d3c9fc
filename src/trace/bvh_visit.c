/* bvh_visit.c - depth first, nearer children first.
 *
 * Invariant: the stack holds what is still to be walked through, the next on top.  Which boxes
 * there are is the builder's affair: what a visitor finds out must not depend on it. */
#include "trace/bvh_visit.h"

#include <math.h>

#include "trace/bvh_tree.h"

_Static_assert((int)ASSAY_BVH_BOXES == (int)BVH_WIDTH, "a node's boxes are asked for together");

static void visit_leaf(const bvh_leaf *leaf, const assay_bvh_visitor *visitor, void *user)
{
    for (int i = 0; i < BVH_LEAF_SIZE; i++) {
        if (leaf->vertex[0][0][i] == leaf->vertex[0][0][i]) { /* not an absent lane */
            visitor->triangle(user, leaf->triangle[i]);
        }
    }
}

/* Puts the children that are wanted on the stack, the smallest key on top; returns its new height.
 */
static int push_children(const bvh_node *node, const double *keys, uint32_t *stack, int height)
{
    const int base              = height;
    double    sorted[BVH_WIDTH] = {0};
    for (int i = 0; i < BVH_WIDTH; i++) {
        if (!(keys[i] < INFINITY) || !(node->plane[0][i] <= node->plane[1][i])) {
            continue;
        }
        int at = height++;
        for (; at > base && sorted[at - base - 1] < keys[i]; at--) {
            sorted[at - base] = sorted[at - base - 1];
            stack[at]         = stack[at - 1];
        }
        sorted[at - base] = keys[i];
        stack[at]         = node->child[i];
    }
    return height;
}

void assay_bvh_visit(const assay_bvh *bvh, const assay_bvh_visitor *visitor, void *user)
{
    uint32_t stack[BVH_MAX_STACK];
    int      height = 0;
    if (bvh->memory) {
        stack[height++] = bvh->root;
    }
    while (height > 0) {
        const uint32_t reference = stack[--height];
        if (reference & BVH_LEAF_BIT) {
            visit_leaf(bvh_leaf_at(bvh, reference), visitor, user);
        } else {
            const bvh_node *node = bvh_node_at(bvh, reference);
            double          keys[BVH_WIDTH];
            visitor->boxes(user, node->plane, keys);
            height = push_children(node, keys, stack, height);
        }
    }
}
