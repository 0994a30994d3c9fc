/* octree.c - the octree of [ward88]: an item is in one cube, and a walk makes the cubes larger.
 *
 * Invariant: an item is in the chain of exactly one node, whose cube holds its place and has a side
 * of at least twice its reach; so a point within the reach is within half a side of the cube.  An
 * item that no cube serves (outside the root's, or with too large a reach) is in the chain of the
 * root, which every walk goes over.
 *
 * An item is in the smallest such cube, so a level's cubes fit the reaches that they serve, and a
 * point is within at most eight grown cubes of a level.  The alternative, an item in every cube
 * that its sphere meets, would make a walk a plain descent, but needs eight times the entries
 * and more for a sphere that is large beside its cube.
 *
 * Inside, the root is the unit cube.  Places become whole numbers of 2^-32, and cubes are then
 * prefixes of their bits: which cube holds a place is decided once, exactly, and no cube has a
 * rounded border.  What is rounded is the way into the unit cube, relatively by 2^-52 of numbers
 * below 2 wherever a cube can be met, so cubes are grown by 2^-48 more. */
#include "math/octree.h"

#include "core/alloc.h"

enum { DEPTH = ASSAY_OCTREE_DEPTH };

static const double SLACK = 0x1p-48;

static const uint32_t NONE = ASSAY_OCTREE_END;

/* The root has number 0, and is no one's child. */
typedef struct {
    uint32_t child[8]; /* 0: none; bit 0 of the index is x, 1 y, 2 z */
    uint32_t item;     /* the first of its chain, or NONE            */
} tree_node;

typedef struct {
    uint32_t next, previous; /* in the chain, or NONE */
    uint32_t node;
} tree_item;

struct assay_octree {
    assay_context *context;
    double         low[3];  /* of the root's cube, m                     */
    double         inverse; /* of its side, 1/m; 0 where there is no cube */
    tree_node     *nodes;
    size_t         node_count, node_capacity;
    tree_item     *items;
    size_t         item_count, item_capacity;
};

/* ---- making ---- */

/* The root's cube, a little larger than the bounds so that their faces are inside. */
static void set_root(assay_octree *octree, assay_vec3 low, assay_vec3 high)
{
    const assay_vec3 extent = vec3_sub(high, low);
    const double     side   = 1.0001 * fmax(fmax(extent.x, extent.y), extent.z);
    if (!vec3_finite(low) || !vec3_finite(extent) ||
        !(extent.x >= 0.0 && extent.y >= 0.0 && extent.z >= 0.0) ||
        !(side >= 1e-100 && side <= 1e100)) {
        return;
    }
    octree->low[0]  = low.x + 0.5 * (extent.x - side);
    octree->low[1]  = low.y + 0.5 * (extent.y - side);
    octree->low[2]  = low.z + 0.5 * (extent.z - side);
    octree->inverse = 1.0 / side;
}

assay_status assay_octree_create(assay_context *context, assay_vec3 low, assay_vec3 high,
                                 assay_octree **octree_out)
{
    assay_octree *octree = assay_allocate(context, 1, sizeof *octree);
    if (!octree) {
        return assay_fail_memory(context, "an octree");
    }
    octree->context     = context;
    assay_status status = assay_grow(context, (void **)&octree->nodes, &octree->node_capacity, 1,
                                     sizeof *octree->nodes);
    if (status != ASSAY_OK) {
        assay_octree_destroy(octree);
        return status;
    }
    octree->node_count    = 1;
    octree->nodes[0].item = NONE;
    set_root(octree, low, high);
    *octree_out = octree;
    return ASSAY_OK;
}

void assay_octree_destroy(assay_octree *octree)
{
    if (octree) {
        assay_release(octree->context, octree->nodes);
        assay_release(octree->context, octree->items);
        assay_release(octree->context, octree);
    }
}

uint64_t assay_octree_bytes(const assay_octree *octree)
{
    return sizeof *octree + octree->node_capacity * sizeof *octree->nodes +
           octree->item_capacity * sizeof *octree->items;
}

/* ---- where an item belongs ---- */

static void to_unit(const assay_octree *octree, assay_vec3 point, double unit[3])
{
    unit[0] = (point.x - octree->low[0]) * octree->inverse;
    unit[1] = (point.y - octree->low[1]) * octree->inverse;
    unit[2] = (point.z - octree->low[2]) * octree->inverse;
}

/* The smallest cube that exists, or may be made, with the item's place inside and a side of at
 * least twice its reach.  Makes only nodes for which there is room. */
static uint32_t home(assay_octree *octree, assay_vec3 place, double reach)
{
    double   unit[3];
    uint32_t cell[3];
    to_unit(octree, place, unit);
    for (int k = 0; k < 3; k++) {
        if (!(octree->inverse > 0.0 && unit[k] >= 0.0 && unit[k] < 1.0)) {
            return 0;
        }
        cell[k] = (uint32_t)(unit[k] * 0x1p32);
    }
    const double least = 2.0 * reach * octree->inverse;
    uint32_t     node  = 0;
    double       side  = 0.5;
    for (int bit = DEPTH - 1; bit >= 0 && side >= least; bit--, side *= 0.5) {
        const unsigned child =
            (cell[0] >> bit & 1U) | (cell[1] >> bit & 1U) << 1 | (cell[2] >> bit & 1U) << 2;
        uint32_t next = octree->nodes[node].child[child];
        if (!next) {
            if (octree->node_count == octree->node_capacity) {
                return node;
            }
            next                             = (uint32_t)octree->node_count++;
            octree->nodes[next]              = (tree_node){.item = NONE};
            octree->nodes[node].child[child] = next;
        }
        node = next;
    }
    return node;
}

static void link_item(assay_octree *octree, uint32_t number, uint32_t node)
{
    tree_item *item = &octree->items[number];
    *item           = (tree_item){octree->nodes[node].item, NONE, node};
    if (item->next != NONE) {
        octree->items[item->next].previous = number;
    }
    octree->nodes[node].item = number;
}

static void unlink_item(assay_octree *octree, uint32_t number)
{
    const tree_item item = octree->items[number];
    if (item.next != NONE) {
        octree->items[item.next].previous = item.previous;
    }
    if (item.previous != NONE) {
        octree->items[item.previous].next = item.next;
    } else {
        octree->nodes[item.node].item = item.next;
    }
}

/* Room for the longest way down. */
static assay_status make_room(assay_octree *octree)
{
    if (octree->node_count > UINT32_MAX - DEPTH) {
        return assay_fail(octree->context, ASSAY_ERR_LIMIT, "an octree has too many cubes");
    }
    return assay_grow(octree->context, (void **)&octree->nodes, &octree->node_capacity,
                      octree->node_count + DEPTH, sizeof *octree->nodes);
}

assay_status assay_octree_add(assay_octree *octree, assay_vec3 place, double reach)
{
    if (octree->item_count >= NONE) {
        return assay_fail(octree->context, ASSAY_ERR_LIMIT, "an octree has too many items");
    }
    assay_status status = make_room(octree);
    if (status == ASSAY_OK) {
        status = assay_grow(octree->context, (void **)&octree->items, &octree->item_capacity,
                            octree->item_count + 1, sizeof *octree->items);
    }
    if (status == ASSAY_OK) {
        link_item(octree, (uint32_t)octree->item_count, home(octree, place, reach));
        octree->item_count++;
    }
    return status;
}

void assay_octree_shrink(assay_octree *octree, uint32_t number, assay_vec3 place, double reach)
{
    (void)make_room(octree);
    const uint32_t node = home(octree, place, reach);
    if (node != octree->items[number].node) {
        unlink_item(octree, number);
        link_item(octree, number, node);
    }
}

/* ---- walking ---- */

static void start(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point)
{
    walk->octree  = octree;
    walk->item    = NONE;
    walk->waiting = 1;
    to_unit(octree, point, walk->at);
    walk->stack[0].low[0] = 0.0;
    walk->stack[0].low[1] = 0.0;
    walk->stack[0].low[2] = 0.0;
    walk->stack[0].side   = 1.0;
    walk->stack[0].node   = 0;
}

void assay_octree_walk_about(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point)
{
    start(walk, octree, point);
    walk->fixed  = SLACK;
    walk->growth = 0.5;
}

void assay_octree_walk_near(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point,
                            double distance)
{
    start(walk, octree, point);
    walk->fixed  = distance * octree->inverse * (1.0 + 0x1p-48) + SLACK;
    walk->growth = 0.0;
}

/* Which halves of a cube, grown, hold the point along one axis: bit 0 the lower, bit 1 the upper.
 * None for a NaN. */
static unsigned halves(double at, double low, double half, double margin)
{
    const double middle = low + half;
    return (unsigned)(at >= low - margin && at <= middle + margin) |
           (unsigned)(at >= middle - margin && at <= middle + half + margin) << 1;
}

/* Puts the children of a node whose grown cubes hold the point on the stack. */
static void descend(assay_octree_walk *walk, const tree_node *node, const double low[3],
                    double side)
{
    const double   half   = 0.5 * side;
    const double   margin = walk->fixed + walk->growth * half;
    const unsigned x      = halves(walk->at[0], low[0], half, margin);
    const unsigned y      = halves(walk->at[1], low[1], half, margin);
    const unsigned z      = halves(walk->at[2], low[2], half, margin);
    for (unsigned i = 0; i < 8; i++) {
        const unsigned inside = x >> (i & 1U) & y >> (i >> 1 & 1U) & z >> (i >> 2) & 1U;
        if (inside && node->child[i]) {
            const int top = walk->waiting++;

            walk->stack[top].low[0] = i & 1U ? low[0] + half : low[0];
            walk->stack[top].low[1] = i & 2U ? low[1] + half : low[1];
            walk->stack[top].low[2] = i & 4U ? low[2] + half : low[2];
            walk->stack[top].side   = half;
            walk->stack[top].node   = node->child[i];
        }
    }
}

uint32_t assay_octree_walk_next(assay_octree_walk *walk)
{
    while (walk->item == NONE && walk->waiting > 0) {
        const int        top    = --walk->waiting;
        const double     side   = walk->stack[top].side;
        const double     low[3] = {walk->stack[top].low[0], walk->stack[top].low[1],
                                   walk->stack[top].low[2]};
        const tree_node *node   = &walk->octree->nodes[walk->stack[top].node];
        walk->item              = node->item;
        descend(walk, node, low, side);
    }
    const uint32_t number = walk->item;
    if (number != NONE) {
        walk->item = walk->octree->items[number].next;
    }
    return number;
}
