/* bvh_build.c - Embree groups the triangles.
 *
 * Invariant: of Embree's work only the grouping is used.  It sees boxes scaled to about 1, so that
 * no area overflows or vanishes. */
#include <embree3/rtcore.h>
#include <stdio.h>
#include <string.h>
#include <sys/types.h>

#include "core/alloc.h"
#include "core/context.h"
#include "trace/bvh_build.h"

typedef struct {
    assay_bvh                *bvh;
    assay_status              status; /* of the callbacks */
    RTCDevice                 device;
    RTCBVH                    tree;
    struct RTCBuildPrimitive *primitives;
    size_t                    primitive_count;
    uint64_t                  embree_bytes; /* that it holds, as it says */
    char                      message[256]; /* Embree's words                                  */
    raw_node                  spare_node;   /* handed out where Embree refuses memory: it goes */
    raw_leaf                  spare_leaf;   /* on building, and what it builds is thrown away  */
} builder;

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
    builder  *b    = user;
    raw_node *node = rtcThreadLocalAlloc(allocator, sizeof *node, 16);
    if (!node) {
        b->status = ASSAY_ERR_MEMORY;
        node      = &b->spare_node;
    }
    node->header = (raw_header){count, 0};
    return node;
}

static void set_children(void *node, void **children, unsigned int count, void *user)
{
    (void)user;
    raw_node *raw = node;
    for (unsigned int i = 0; i < count && i < BVH_WIDTH; i++) {
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
    builder  *b    = user;
    raw_leaf *leaf = rtcThreadLocalAlloc(allocator, sizeof *leaf, 16);
    if (!leaf) {
        b->status = ASSAY_ERR_MEMORY;
        leaf      = &b->spare_leaf;
    }
    leaf->header = (raw_header){(uint32_t)count, 1};
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

/* Embree takes an ISA at its word, so it is only told what the machine has. */
static bool machine_has(const char *isa)
{
#if defined(__x86_64__)
    if (strcmp(isa, "avx512") == 0) {
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
               __builtin_cpu_supports("avx512vl");
    }
    return strcmp(isa, "sse2") == 0 || __builtin_cpu_supports("avx2");
#else
    (void)isa;
    return false;
#endif
}

/* Embree's memory counts as the context's own; tests of its refusals set a limit of their own. What
 * is refused Embree gives up without saying so again. */
static bool within_limit(void *user, ssize_t bytes, bool done)
{
    builder       *b     = user;
    const uint64_t limit = (uint64_t)b->bvh->tuning.embree_limit;
    (void)done;
    if (bytes < 0) {
        const uint64_t freed =
            (uint64_t)-bytes < b->embree_bytes ? (uint64_t)-bytes : b->embree_bytes;
        assay_memory_discharge(b->bvh->context, freed);
        b->embree_bytes -= freed;
        return true;
    }
    if ((limit > 0 && b->embree_bytes + (uint64_t)bytes > limit) ||
        !assay_memory_charge(b->bvh->context, (uint64_t)bytes)) {
        return false;
    }
    b->embree_bytes += (uint64_t)bytes;
    return true;
}

static assay_status open_device(builder *b, const char *isa)
{
    char config[64] = "threads=1";
    if (isa && machine_has(isa)) {
        snprintf(config, sizeof config, "threads=1,isa=%s", isa);
    }
    b->device = rtcNewDevice(config);
    if (!b->device) {
        return rtcGetDeviceError(NULL) == RTC_ERROR_OUT_OF_MEMORY
                   ? assay_fail_memory(b->bvh->context, "an Embree device")
                   : assay_fail(b->bvh->context, ASSAY_ERR_INTERNAL,
                                "Embree cannot make a device with '%s'", config);
    }
    rtcSetDeviceErrorFunction(b->device, keep_message, b);
    rtcSetDeviceMemoryMonitorFunction(b->device, within_limit, b);
    return ASSAY_OK;
}

static assay_status explain(builder *b, const char *what)
{
    const enum RTCError error = rtcGetDeviceError(b->device);
    if (b->status == ASSAY_ERR_CANCELLED) {
        return b->status;
    }
    if (b->status == ASSAY_ERR_MEMORY || error == RTC_ERROR_OUT_OF_MEMORY) {
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
        if (root) {
            status = bvh_flatten(bvh, root);
        }
    }
    if (b.tree) {
        rtcReleaseBVH(b.tree);
    }
    if (b.device) {
        rtcReleaseDevice(b.device);
    }
    assay_memory_discharge(bvh->context, b.embree_bytes);
    assay_release(bvh->context, b.primitives);
    return status;
}
