/* bvh_build.c - Embree builds, and its tree is copied into one block, depth first.
 *
 * Invariant: of Embree's work only the grouping of triangles is used.  Boxes are taken again from
 * the triangles' own floats, bottom up, so they are exact whatever the builder rounded; and the
 * builder sees coordinates scaled to about 1, so that no area overflows or vanishes. */
#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
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
    assay_bvh                *bvh;
    assay_status              status; /* of the progress callback */
    RTCDevice                 device;
    RTCBVH                    tree;
    struct RTCBuildPrimitive *primitives;
    size_t                    primitive_count;
    char                      message[256]; /* Embree's words */
} builder;

typedef struct {
    float low[3], high[3];
} box;

static const box empty_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(box *b, const box *other)
{
    for (int k = 0; k < 3; k++) {
        b->low[k]  = other->low[k] < b->low[k] ? other->low[k] : b->low[k];
        b->high[k] = other->high[k] > b->high[k] ? other->high[k] : b->high[k];
    }
}

static const float *corner_of(const assay_triangles *t, uint32_t triangle, int corner)
{
    return t->positions + 3 * (size_t)t->indices[3 * (size_t)triangle + (size_t)corner];
}

static box triangle_box(const assay_triangles *t, uint32_t triangle)
{
    box b = empty_box;
    for (int c = 0; c < 3; c++) {
        const float *p     = corner_of(t, triangle, c);
        const box    point = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
        box_add(&b, &point);
    }
    return b;
}

bool bvh_triangle_is_degenerate(const assay_triangles *t, uint32_t triangle)
{
    const float *a = corner_of(t, triangle, 0), *b = corner_of(t, triangle, 1),
                *c = corner_of(t, triangle, 2);
    double e[3], f[3];
    for (int k = 0; k < 3; k++) {
        e[k] = (double)b[k] - (double)a[k];
        f[k] = (double)c[k] - (double)a[k];
    }
    return e[1] * f[2] == e[2] * f[1] && e[2] * f[0] == e[0] * f[2] && e[0] * f[1] == e[1] * f[0];
}

/* ---- Embree's callbacks ---- */

static void *create_node(RTCThreadLocalAllocator allocator, unsigned int count, void *user)
{
    (void)user;
    raw_node *node = rtcThreadLocalAlloc(allocator, sizeof *node, 16);
    node->header   = (raw_header){count, 0};
    return node;
}

static void set_children(void *node, void **children, unsigned int count, void *user)
{
    (void)user;
    raw_node *raw = node;
    for (unsigned int i = 0; i < count; i++) {
        raw->child[i] = children[i];
    }
}

static void set_bounds(void *node, const struct RTCBounds **bounds, unsigned int count, void *user)
{
    (void)node;
    (void)bounds;
    (void)count;
    (void)user;
}

static void *create_leaf(RTCThreadLocalAllocator         allocator,
                         const struct RTCBuildPrimitive *primitives, size_t count, void *user)
{
    (void)user;
    raw_leaf *leaf = rtcThreadLocalAlloc(allocator, sizeof *leaf, 16);
    leaf->header   = (raw_header){(uint32_t)count, 1};
    for (size_t i = 0; i < count && i < BVH_LEAF_SIZE; i++) {
        leaf->triangle[i] = primitives[i].primID;
    }
    return leaf;
}

static bool report_progress(void *user, double fraction)
{
    builder *b = user;
    if (b->status == ASSAY_OK) {
        b->status = assay_progress(b->bvh->context, "build", (uint64_t)(fraction * 1000.0), 1000);
    }
    return b->status == ASSAY_OK;
}

static void keep_message(void *user, enum RTCError code, const char *text)
{
    (void)code;
    builder *b = user;
    snprintf(b->message, sizeof b->message, "%s", text ? text : "");
}

/* ---- the steps of a build ---- */

/* Boxes of all triangles that can be hit, scaled by a power of two so that the largest coordinate
 * is about 1, and the largest coordinate itself. */
static assay_status collect(builder *b)
{
    const assay_triangles *t      = &b->bvh->triangles;
    size_t                 count  = 0;
    double                 extent = 0.0;
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        if (bvh_triangle_is_degenerate(t, i)) {
            continue;
        }
        const box bounds = triangle_box(t, i);
        for (int k = 0; k < 3; k++) {
            extent = fmax(extent, fmax(fabs((double)bounds.low[k]), fabs((double)bounds.high[k])));
        }
        count++;
    }
    b->primitive_count = count;
    b->bvh->extent     = extent;
    if (count == 0) {
        return ASSAY_OK;
    }
    b->primitives = assay_allocate(b->bvh->context, count, sizeof *b->primitives);
    if (!b->primitives) {
        return assay_fail_memory(b->bvh->context, "the boxes of the triangles");
    }
    int exponent;
    (void)frexp(extent, &exponent);
    const double scale = ldexp(1.0, -exponent);
    size_t       next  = 0;
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        if (bvh_triangle_is_degenerate(t, i)) {
            continue;
        }
        const box bounds = triangle_box(t, i);
        float     s[6];
        for (int k = 0; k < 3; k++) {
            s[k]     = (float)((double)bounds.low[k] * scale);
            s[k + 3] = (float)((double)bounds.high[k] * scale);
        }
        b->primitives[next++] = (struct RTCBuildPrimitive){.lower_x = s[0],
                                                           .lower_y = s[1],
                                                           .lower_z = s[2],
                                                           .geomID  = 0,
                                                           .upper_x = s[3],
                                                           .upper_y = s[4],
                                                           .upper_z = s[5],
                                                           .primID  = i};
    }
    return ASSAY_OK;
}

static assay_status open_device(builder *b, const char *isa)
{
    char config[64] = "threads=1";
#if defined(__x86_64__) || defined(__i386__)
    if (isa) {
        snprintf(config, sizeof config, "threads=1,isa=%s", isa);
    }
#else
    (void)isa;
#endif
    b->device = rtcNewDevice(config);
    if (!b->device) {
        return rtcGetDeviceError(NULL) == RTC_ERROR_OUT_OF_MEMORY
                   ? assay_fail_memory(b->bvh->context, "an Embree device")
                   : assay_fail(b->bvh->context, ASSAY_ERR_INTERNAL,
                                "Embree cannot make a device with '%s'", config);
    }
    rtcSetDeviceErrorFunction(b->device, keep_message, b);
    return ASSAY_OK;
}

static assay_status explain(builder *b, const char *what)
{
    const enum RTCError error = rtcGetDeviceError(b->device);
    if (b->status != ASSAY_OK) {
        return b->status;
    }
    if (error == RTC_ERROR_OUT_OF_MEMORY) {
        return assay_fail_memory(b->bvh->context, what);
    }
    return assay_fail(b->bvh->context, ASSAY_ERR_INTERNAL, "Embree cannot build %s: error %d, %s",
                      what, (int)error, b->message[0] ? b->message : "no message");
}

static assay_status run_embree(builder *b, const raw_header **root_out)
{
    b->tree = rtcNewBVH(b->device);
    if (!b->tree) {
        return explain(b, "a tree of triangles");
    }
    struct RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality             = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor       = b->bvh->tuning.width;
    arguments.maxDepth                 = BVH_MAX_DEPTH - 8;
    arguments.sahBlockSize             = b->bvh->tuning.leaf_size;
    arguments.minLeafSize              = b->bvh->tuning.leaf_size;
    arguments.maxLeafSize              = b->bvh->tuning.leaf_size;
    arguments.bvh                      = b->tree;
    arguments.primitives               = b->primitives;
    arguments.primitiveCount           = b->primitive_count;
    arguments.primitiveArrayCapacity   = b->primitive_count;
    arguments.createNode               = create_node;
    arguments.setNodeChildren          = set_children;
    arguments.setNodeBounds            = set_bounds;
    arguments.createLeaf               = create_leaf;
    arguments.buildProgress            = report_progress;
    arguments.userPtr                  = b;
    const raw_header *root             = rtcBuildBVH(&arguments);
    if (!root || b->status != ASSAY_OK) {
        return explain(b, "a tree of triangles");
    }
    *root_out = root;
    return ASSAY_OK;
}

/* ---- the copy ---- */

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
    box bounds = empty_box;
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
    *bounds_out          = empty_box;
    for (uint32_t i = 0; i < BVH_WIDTH; i++) {
        box bounds = empty_box;
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

static assay_status copy_tree(assay_bvh *bvh, const raw_header *root)
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

assay_status bvh_build(assay_bvh *bvh, const char *isa)
{
    builder      b      = {.bvh = bvh, .status = ASSAY_OK};
    assay_status status = collect(&b);
    if (status == ASSAY_OK && b.primitive_count > 0) {
        const raw_header *root = NULL;
        status                 = open_device(&b, isa);
        if (status == ASSAY_OK) {
            status = run_embree(&b, &root);
        }
        if (status == ASSAY_OK) {
            status = copy_tree(bvh, root);
        }
    }
    if (b.tree) {
        rtcReleaseBVH(b.tree);
    }
    if (b.device) {
        rtcReleaseDevice(b.device);
    }
    assay_release(bvh->context, b.primitives);
    return status;
}
