/* bvh.c - making a tree, choosing how to walk it, and the judge. */
#include "trace/bvh.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "trace/bvh_decision.h"

bvh_tuning bvh_tuning_default(void)
{
    return (bvh_tuning){.box_margin     = 6.5 * 0x1p-24,
                        .residual_limit = 0x1p-40,
                        .leaf_size      = BVH_LEAF_SIZE,
                        .width          = BVH_WIDTH};
}

/* The best kernel of this machine that the ISA allows; NULL for an unknown ISA. */
static const bvh_kernel *choose_kernel(const char *isa)
{
    const bool any    = !isa || strcmp(isa, "avx512") == 0;
    const bool narrow = isa && strcmp(isa, "sse2") == 0;
    if (!any && !narrow && strcmp(isa, "avx2") != 0) {
        return NULL;
    }
#if defined(__x86_64__)
    return !narrow && bvh_kernel_avx2.supported() ? &bvh_kernel_avx2 : &bvh_kernel_sse2;
#elif defined(__aarch64__)
    return &bvh_kernel_neon;
#else
    return &bvh_kernel_double;
#endif
}

assay_status bvh_create_tuned(assay_context *context, const assay_triangles *triangles,
                              const bvh_tuning *tuning, const bvh_kernel *kernel,
                              assay_bvh **bvh_out)
{
    const char       *isa    = assay_context_isa(context);
    const bvh_kernel *chosen = kernel ? kernel : choose_kernel(isa);
    if (!chosen) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "ASSAY_ISA: '%s' is unknown; use sse2, avx2 or avx512", isa);
    }
    assay_bvh *bvh = assay_allocate(context, 1, sizeof *bvh);
    if (!bvh) {
        return assay_fail_memory(context, "a tree of triangles");
    }
    bvh->context   = context;
    bvh->triangles = *triangles;
    bvh->tuning    = *tuning;
    bvh->kernel    = chosen;

    const assay_status status = bvh_build(bvh, isa);
    if (status != ASSAY_OK) {
        assay_release(context, bvh);
        return status;
    }
    *bvh_out = bvh;
    return ASSAY_OK;
}

assay_status assay_bvh_create(assay_context *context, const assay_triangles *triangles,
                              assay_bvh **bvh_out)
{
    const bvh_tuning tuning = bvh_tuning_default();
    return bvh_create_tuned(context, triangles, &tuning, NULL, bvh_out);
}

void assay_bvh_destroy(assay_bvh *bvh)
{
    if (bvh) {
        assay_release(bvh->context, bvh->memory);
        assay_release(bvh->context, bvh);
    }
}

bool assay_bvh_closest(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out)
{
    return bvh->memory && bvh->kernel->closest(bvh, ray, hit_out);
}

bool assay_bvh_occluded(const assay_bvh *bvh, const assay_ray *ray)
{
    return bvh->memory && bvh->kernel->occluded(bvh, ray);
}

uint64_t assay_bvh_bytes(const assay_bvh *bvh) { return sizeof *bvh + bvh->bytes; }

bool assay_bvh_closest_brute_force(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out)
{
    const assay_triangles *t = &bvh->triangles;
    bvh_query              query;
    bvh_query_start(&query, bvh, ray);
    for (uint32_t i = 0; i < t->triangle_count; i++) {
        if (bvh_triangle_is_degenerate(t, i)) {
            continue;
        }
        float corner[3][3];
        for (size_t c = 0; c < 3; c++) {
            memcpy(corner[c], t->positions + 3 * (size_t)t->indices[3 * (size_t)i + c],
                   sizeof corner[c]);
        }
        (void)bvh_query_try(&query, corner[0], 3, 1, i);
    }
    return bvh_query_finish(&query, hit_out);
}
