/* bvh_flatten.c - the builder's groups become one block of nodes and leaves, depth first.
 *
 * Invariant: boxes are taken from the triangles' own floats, bottom up, so they are exact whatever
 * the builder rounded. */
#include "core/alloc.h"
#include "core/context.h"
#include "trace/bvh_build.h"

typedef struct {
    uint64_t units;
    uint32_t depth;
    bool     sound; /* every group has a size and depth that the layout can hold */
} measure;

static void measure_tree(const raw_header *raw, uint32_t depth, measure *m)
{
    m->depth = depth > m->depth ? depth : m->depth;
    m->sound = m->sound && depth <= BVH_MAX_DEPTH && raw->count > 0 &&
               raw->count <= (raw->is_leaf ? BVH_LEAF_SIZE : BVH_WIDTH);
    if (!m->sound) {
        return;
    }
    if (raw->is_leaf) {
        m->units += sizeof(bvh_leaf) / BVH_UNIT;
        return;
    }
    m->units += sizeof(bvh_node) / BVH_UNIT;
    const raw_node *node = (const raw_node *)(const void *)raw;
    for (uint32_t i = 0; i < raw->count; i++) {
        measure_tree(node->child[i], depth + 1, m);
    }
}

static box write_leaf(const assay_bvh *bvh, const raw_leaf *raw, bvh_leaf *leaf)
{
    box bounds = box_empty();
    for (uint32_t lane = 0; lane < BVH_LEAF_SIZE; lane++) {
        if (lane >= raw->header.count) {
            leaf->triangle[lane] = ASSAY_NO_TRIANGLE;
            for (int k = 0; k < 9; k++) {
                leaf->vertex[k / 3][k % 3][lane] = NAN;
            }
            continue;
        }
        const uint32_t triangle = raw->triangle[lane];
        const box      own      = triangle_box(&bvh->triangles, triangle);
        for (int c = 0; c < 3; c++) {
            for (int k = 0; k < 3; k++) {
                leaf->vertex[c][k][lane] = corner_of(&bvh->triangles, triangle, c)[k];
            }
        }
        leaf->triangle[lane] = triangle;
        box_add(&bounds, &own);
    }
    return bounds;
}

/* Writes the subtree at *next and after, advances *next, returns the subtree's reference and box.
 */
static uint32_t write_tree(assay_bvh *bvh, const raw_header *raw, uint32_t *next, box *bounds_out)
{
    const uint32_t here = *next;
    void          *at   = bvh->memory + (size_t)here * BVH_UNIT;
    if (raw->is_leaf) {
        *next += sizeof(bvh_leaf) / BVH_UNIT;
        *bounds_out = write_leaf(bvh, (const raw_leaf *)(const void *)raw, at);
        return here | BVH_LEAF_BIT;
    }
    *next += sizeof(bvh_node) / BVH_UNIT;
    const raw_node *from = (const raw_node *)(const void *)raw;
    bvh_node       *node = at;
    *bounds_out          = box_empty();
    for (uint32_t i = 0; i < BVH_WIDTH; i++) {
        box bounds = box_empty();
        if (i < raw->count) {
            node->child[i] = write_tree(bvh, from->child[i], next, &bounds);
        }
        for (int k = 0; k < 3; k++) {
            node->plane[2 * k][i]     = bounds.low[k];
            node->plane[2 * k + 1][i] = bounds.high[k];
        }
        box_add(bounds_out, &bounds);
    }
    return here;
}

assay_status bvh_flatten(assay_bvh *bvh, const raw_header *root)
{
    measure m = {0, 0, true};
    measure_tree(root, 1, &m);
    if (!m.sound) {
        return assay_fail(bvh->context, ASSAY_ERR_INTERNAL,
                          "Embree's tree is deeper or wider than was asked for");
    }
    if (m.units >= BVH_LEAF_BIT) {
        return assay_fail(bvh->context, ASSAY_ERR_LIMIT,
                          "the tree over %u triangles is larger than %u GiB; use fewer triangles",
                          bvh->triangles.triangle_count, BVH_LEAF_BIT / (1U << 30) * BVH_UNIT);
    }
    bvh->memory = assay_allocate(bvh->context, m.units, BVH_UNIT);
    if (!bvh->memory) {
        return assay_fail_memory(bvh->context, "a tree of triangles");
    }
    uint32_t next = 0;
    box      bounds;
    bvh->root  = write_tree(bvh, root, &next, &bounds);
    bvh->bytes = m.units * BVH_UNIT;
    bvh->depth = m.depth;
    return ASSAY_OK;
}
