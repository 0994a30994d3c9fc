/* bvh_kernel_double.c - the walk in scalar double: for any machine and any range of numbers.
 *
 * Used where float boxes would overflow or vanish, and on machines without a kernel of their own.
 * It has no filter: every triangle of a leaf is decided.  Boxes are widened by 2^-36 M, far more
 * than double arithmetic can err (docs/exact-hits.md). */
#include "trace/bvh_decision.h"

static const double widening   = 0x1p-36; /* of the boxes, in units of M                   */
static const double least_step = 0x1p-40; /* of a direction against its largest component  */

/* The ray by tau = t |dz|, in the world's axes. */
typedef struct {
    double o[3], inverse[3];
    double widening;
} slabs;

static slabs slabs_start(const bvh_query *query)
{
    const bvh_shear *shear = &query->shear;
    const double     sign  = copysign(1.0, shear->inverse_dz);
    const double     d[3]  = {shear->sx * sign, shear->sy * sign, sign};
    slabs            s;
    for (int k = 0; k < 3; k++) {
        const double step         = fabs(d[k]) >= least_step ? d[k] : copysign(least_step, d[k]);
        s.inverse[shear->axis[k]] = 1.0 / step;
        s.o[shear->axis[k]]       = shear->o[k];
    }
    s.widening = widening * shear->magnitude;
    return s;
}

/* Whether the ray may meet something in child i of the node at t in [t_after, best_t]. */
static bool meets(const slabs *s, const bvh_query *query, const bvh_node *node, int i)
{
    double near = -INFINITY, far = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double low = ((double)node->plane[2 * k][i] - s->widening - s->o[k]) * s->inverse[k];
        const double high =
            ((double)node->plane[2 * k + 1][i] + s->widening - s->o[k]) * s->inverse[k];
        near = fmax(near, s->inverse[k] > 0.0 ? low : high);
        far  = fmin(far, s->inverse[k] > 0.0 ? high : low);
    }
    const double dz = query->shear.abs_dz;
    return !(near > far) && !(near - s->widening > query->best_t * dz) &&
           !(far + s->widening < query->t_after * dz);
}

static void walk(const assay_bvh *bvh, bvh_query *query, bool any)
{
    const slabs s = slabs_start(query);
    uint32_t    stack[BVH_MAX_STACK];
    uint32_t    count = 0;
    stack[count++]    = bvh->root;
    while (count > 0) {
        const uint32_t reference = stack[--count];
        if (reference & BVH_LEAF_BIT) {
            const bvh_leaf *leaf = bvh_leaf_at(bvh, reference);
            for (int lane = 0; lane < BVH_LEAF_SIZE; lane++) {
                if (leaf->triangle[lane] != ASSAY_NO_TRIANGLE &&
                    bvh_query_try(query, &leaf->vertex[0][0][lane], 3 * BVH_LEAF_SIZE,
                                  BVH_LEAF_SIZE, leaf->triangle[lane]) &&
                    any) {
                    return;
                }
            }
            continue;
        }
        const bvh_node *node = bvh_node_at(bvh, reference);
        for (int i = BVH_WIDTH - 1; i >= 0; i--) {
            if (meets(&s, query, node, i)) {
                stack[count++] = node->child[i];
            }
        }
    }
}

static bool closest(const assay_bvh *bvh, const assay_ray *ray, assay_hit *hit_out)
{
    bvh_query query;
    bvh_query_start(&query, bvh, ray);
    walk(bvh, &query, false);
    return bvh_query_finish(&query, hit_out);
}

static bool occluded(const assay_bvh *bvh, const assay_ray *ray)
{
    bvh_query query;
    bvh_query_start(&query, bvh, ray);
    walk(bvh, &query, true);
    return query.det != 0.0;
}

static bool supported(void) { return true; }

const bvh_kernel bvh_kernel_double = {"double", supported, closest, occluded};
