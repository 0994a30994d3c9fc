/* octree.c - the octree of [ward88]: an item is in one cube, and a walk makes the cubes larger.
 *
 * Invariant: an item belongs to exactly one node, whose cube holds its place and has a side of at
 * least twice its reach; so a point within the reach is within half a side of the cube.  An item
 * that no cube serves (outside the root's, or with too large a reach) belongs to the root, which
 * every walk goes over.
 *
 * An item is in the smallest such cube, so a level's cubes fit the reaches that they serve, and a
 * point is within at most eight grown cubes of a level.  The alternative, an item in every cube
 * that its sphere meets, would make a walk a plain descent, but needs up to eight times the
 * entries. Here a walk meets items in vain: on a plane, with sides of 2 to 4 reaches r, a disc of
 * pi r^2 is sought in the square of two sides, so 5 to 20 in a hundred reach the point.  Therefore
 * nodes keep items in blocks, places and reaches side by side, and most are done with there.
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
    uint32_t block;    /* the first of its blocks, or NONE; the others are full */
    uint32_t children; /* which there are: a bit each */
} tree_node;

enum { SLOTS = 8 };

/* Items of a node; slots from count on are 0. */
typedef struct {
    double   x[SLOTS], y[SLOTS], z[SLOTS];
    double   reach[SLOTS];
    uint32_t number[SLOTS];
    uint32_t count, node, next;
} tree_block;

struct assay_octree {
    assay_context *context;
    double         low[3];  /* of the root's cube, m                      */
    double         inverse; /* of its side, 1/m; 0 where there is no cube */
    tree_node     *nodes;
    size_t         node_count, node_capacity;
    tree_block    *blocks;
    size_t         block_count, block_capacity;
    uint32_t       free_block; /* the first of those that were given back */
    uint32_t      *slots;      /* of each item: block * SLOTS + slot      */
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
    octree->node_count     = 1;
    octree->nodes[0].block = NONE;
    octree->free_block     = NONE;
    set_root(octree, low, high);
    *octree_out = octree;
    return ASSAY_OK;
}

void assay_octree_destroy(assay_octree *octree)
{
    if (octree) {
        assay_release(octree->context, octree->nodes);
        assay_release(octree->context, octree->blocks);
        assay_release(octree->context, octree->slots);
        assay_release(octree->context, octree);
    }
}

uint64_t assay_octree_bytes(const assay_octree *octree)
{
    return sizeof *octree + octree->node_capacity * sizeof *octree->nodes +
           octree->block_capacity * sizeof *octree->blocks +
           octree->item_capacity * sizeof *octree->slots;
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
    for (int bit = DEPTH - 1; bit >= 0 && side >= least; bit--) {
        const unsigned child =
            (cell[0] >> bit & 1U) | (cell[1] >> bit & 1U) << 1 | (cell[2] >> bit & 1U) << 2;
        uint32_t next = octree->nodes[node].child[child];
        if (!next) {
            if (octree->node_count == octree->node_capacity) {
                return node;
            }
            next                             = (uint32_t)octree->node_count++;
            octree->nodes[next]              = (tree_node){.block = NONE};
            octree->nodes[node].child[child] = next;
            octree->nodes[node].children |= 1U << child;
        }
        node = next;
        side *= 0.5;
    }
    return node;
}

/* Room for the longest way down and one more block. */
static assay_status make_room(assay_octree *octree)
{
    if (octree->node_count > UINT32_MAX - DEPTH || octree->block_count >= UINT32_MAX / SLOTS) {
        return assay_fail(octree->context, ASSAY_ERR_LIMIT, "an octree has too many cubes");
    }
    const assay_status status =
        assay_grow(octree->context, (void **)&octree->nodes, &octree->node_capacity,
                   octree->node_count + DEPTH, sizeof *octree->nodes);
    return status == ASSAY_OK
               ? assay_grow(octree->context, (void **)&octree->blocks, &octree->block_capacity,
                            octree->block_count + 1, sizeof *octree->blocks)
               : status;
}

/* Puts a block without items in front of a node's; make_room has been. */
static void add_block(assay_octree *octree, uint32_t node)
{
    const uint32_t reused = octree->free_block;
    const uint32_t block  = reused != NONE ? reused : (uint32_t)octree->block_count++;
    if (reused != NONE) {
        octree->free_block = octree->blocks[reused].next;
    }
    octree->blocks[block]     = (tree_block){.node = node, .next = octree->nodes[node].block};
    octree->nodes[node].block = block;
}

static void put_item(assay_octree *octree, uint32_t node, uint32_t number, assay_vec3 place,
                     double reach)
{
    if (octree->nodes[node].block == NONE ||
        octree->blocks[octree->nodes[node].block].count == SLOTS) {
        add_block(octree, node);
    }
    tree_block    *block = &octree->blocks[octree->nodes[node].block];
    const uint32_t slot  = block->count++;
    block->x[slot]       = place.x;
    block->y[slot]       = place.y;
    block->z[slot]       = place.z;
    block->reach[slot]   = reach;
    block->number[slot]  = number;

    octree->slots[number] = octree->nodes[node].block * SLOTS + slot;
}

/* The last item of the node's first block takes the place of the one that goes. */
static void take_item(assay_octree *octree, uint32_t number)
{
    const uint32_t at    = octree->slots[number];
    tree_block    *block = &octree->blocks[at / SLOTS];
    tree_node     *node  = &octree->nodes[block->node];
    const uint32_t first = node->block;
    tree_block    *from  = &octree->blocks[first];
    const uint32_t last = --from->count, to = at % SLOTS;

    block->x[to]      = from->x[last];
    block->y[to]      = from->y[last];
    block->z[to]      = from->z[last];
    block->reach[to]  = from->reach[last];
    block->number[to] = from->number[last];

    octree->slots[from->number[last]] = at;
    if (from->count == 0) {
        node->block        = from->next;
        from->next         = octree->free_block;
        octree->free_block = first;
    }
}

assay_status assay_octree_add(assay_octree *octree, assay_vec3 place, double reach)
{
    if (octree->item_count >= ASSAY_OCTREE_END) {
        return assay_fail(octree->context, ASSAY_ERR_LIMIT, "an octree has too many items");
    }
    assay_status status = make_room(octree);
    if (status == ASSAY_OK) {
        status = assay_grow(octree->context, (void **)&octree->slots, &octree->item_capacity,
                            octree->item_count + 1, sizeof *octree->slots);
    }
    if (status == ASSAY_OK) {
        put_item(octree, home(octree, place, reach), (uint32_t)octree->item_count, place, reach);
        octree->item_count++;
    }
    return status;
}

void assay_octree_shrink(assay_octree *octree, uint32_t number, double reach)
{
    const bool       room  = make_room(octree) == ASSAY_OK;
    const uint32_t   slot  = octree->slots[number] % SLOTS;
    tree_block      *block = &octree->blocks[octree->slots[number] / SLOTS];
    const assay_vec3 place = vec3(block->x[slot], block->y[slot], block->z[slot]);
    const uint32_t   node  = room ? home(octree, place, reach) : block->node;
    block->reach[slot]     = reach;
    if (node != block->node) {
        take_item(octree, number);
        put_item(octree, node, number, place, reach);
    }
}

/* ---- walking ---- */

static void start(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point)
{
    walk->octree     = octree;
    walk->point      = point;
    walk->next_block = NONE;
    walk->matches    = 0;
    walk->looked     = 0;
    walk->waiting    = 1;
    to_unit(octree, point, walk->unit);
    walk->stack[0].low[0] = 0.0;
    walk->stack[0].low[1] = 0.0;
    walk->stack[0].low[2] = 0.0;
    walk->stack[0].side   = 1.0;
    walk->stack[0].node   = 0;
}

void assay_octree_walk_about(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point)
{
    start(walk, octree, point);
    walk->margin  = SLACK;
    walk->growth  = 0.5;
    walk->more    = 0.0;
    walk->squared = -1.0;
}

void assay_octree_walk_around(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point,
                              double more)
{
    assay_octree_walk_about(walk, octree, point);
    walk->more = more;
    walk->margin += more * octree->inverse * (1.0 + SLACK);
}

void assay_octree_walk_near(assay_octree_walk *walk, const assay_octree *octree, assay_vec3 point,
                            double distance)
{
    start(walk, octree, point);
    walk->margin  = distance * octree->inverse * (1.0 + SLACK) + SLACK;
    walk->growth  = 0.0;
    walk->more    = 0.0;
    walk->squared = distance * distance;
}

/* Which halves of a cube, grown, hold the point along one axis: bit 0 the lower, bit 1 the upper.
 * None for a NaN. */
static unsigned halves(double at, double low, double half, double margin)
{
    const double middle = low + half;
    return (unsigned)((at >= low - margin) & (at <= middle + margin)) |
           (unsigned)((at >= middle - margin) & (at <= middle + half + margin)) << 1;
}

static unsigned lowest_bit(unsigned bits) { return (unsigned)__builtin_ctz(bits); }

/* Puts the children of a node whose grown cubes hold the point on the stack. */
static void descend(assay_octree_walk *walk, const tree_node *node, const double low[3],
                    double side)
{
    /* The children in the lower half, the upper half, or both. */
    static const uint8_t along_x[4] = {0, 0x55, 0xaa, 0xff}, along_y[4] = {0, 0x33, 0xcc, 0xff},
                         along_z[4] = {0, 0x0f, 0xf0, 0xff};

    const double half   = 0.5 * side;
    const double margin = walk->margin + walk->growth * half;
    unsigned     inside = node->children & along_x[halves(walk->unit[0], low[0], half, margin)] &
                      along_y[halves(walk->unit[1], low[1], half, margin)] &
                      along_z[halves(walk->unit[2], low[2], half, margin)];
    for (; inside; inside &= inside - 1) {
        const unsigned i   = lowest_bit(inside);
        const int      top = walk->waiting++;

        walk->stack[top].low[0] = i & 1U ? low[0] + half : low[0];
        walk->stack[top].low[1] = i & 2U ? low[1] + half : low[1];
        walk->stack[top].low[2] = i & 4U ? low[2] + half : low[2];
        walk->stack[top].side   = half;
        walk->stack[top].node   = node->child[i];
    }
}

/* Which items of a block hold the point: a bit each. */
static unsigned match(const assay_octree_walk *walk, const tree_block *block)
{
    const assay_vec3 p = walk->point;
    double           squared[SLOTS];
    for (int i = 0; i < SLOTS; i++) {
        const double x = p.x - block->x[i], y = p.y - block->y[i], z = p.z - block->z[i];
        squared[i] = x * x + y * y + z * z;
    }
    unsigned matches = 0;
    for (unsigned i = 0; i < block->count; i++) {
        const double reach = block->reach[i] + walk->more;
        const double limit = walk->squared < 0.0 ? reach * reach : walk->squared;
        matches |= (unsigned)(squared[i] <= limit) << i;
    }
    return matches;
}

static void enter_node(assay_octree_walk *walk)
{
    const int        top    = --walk->waiting;
    const double     side   = walk->stack[top].side;
    const double     low[3] = {walk->stack[top].low[0], walk->stack[top].low[1],
                               walk->stack[top].low[2]};
    const tree_node *node   = &walk->octree->nodes[walk->stack[top].node];
    walk->next_block        = node->block;
    descend(walk, node, low, side);
}

uint32_t assay_octree_walk_next(assay_octree_walk *walk)
{
    while (walk->matches == 0) {
        if (walk->next_block != NONE) {
            const tree_block *block = &walk->octree->blocks[walk->next_block];
            walk->block             = walk->next_block;
            walk->next_block        = block->next;
            walk->looked += block->count;
            walk->matches = match(walk, block);
        } else if (walk->waiting > 0) {
            enter_node(walk);
        } else {
            return ASSAY_OCTREE_END;
        }
    }
    const unsigned slot = lowest_bit(walk->matches);
    walk->matches &= walk->matches - 1;
    return walk->octree->blocks[walk->block].number[slot];
}
