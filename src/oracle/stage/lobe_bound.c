/* lobe_bound.c - the paraboloid of [gautron06] eq. 3.35, 3.36 in tracked arithmetic.
 *
 * What is looked up is continuous in the direction and bilinear between texels: a coordinate that
 * is off by e texels changes it by e times the largest difference between neighbours that are
 * touched, so it does not matter in which cell a direction near a border is taken to be.
 *
 * Invariant: products are bounded by pairs, so a candidate may turn the BRDF into the frame of the
 * light, or the light into the frame of the BRDF. */
#include "oracle/stage/lobe_bound.h"

#include "basis/brdf_grid.h"
#include "core/alloc.h"
#include "core/context.h"

enum { CHANNELS = ASSAY_MATERIAL_CHANNELS };

/* Roundings of one bilinear lookup, of the largest texel. */
static const double LOOK_UP = 10.0;

assay_status lobe_grids_open(assay_context *context, int side, size_t count, size_t lobe_count,
                             const double *texels, lobe_grids *grids_out)
{
    const size_t entries = (size_t)side * (size_t)side * count;
    lobe_grids   made    = {.context    = context,
                            .side       = side,
                            .count      = count,
                            .lobe_count = lobe_count,
                            .texels     = texels};
    made.grids           = assay_allocate(context, lobe_count, sizeof(assay_brdf_grid *));
    assay_status status  = made.grids ? ASSAY_OK : assay_fail_memory(context, "lobes");
    for (size_t i = 0; i < lobe_count && status == ASSAY_OK; i++) {
        status =
            assay_brdf_grid_from_texels(context, side, count, texels + i * entries, &made.grids[i]);
    }
    if (status != ASSAY_OK) {
        lobe_grids_close(&made);
        return status;
    }
    *grids_out = made;
    return ASSAY_OK;
}

void lobe_grids_close(lobe_grids *grids)
{
    for (size_t i = 0; grids->grids && i < grids->lobe_count; i++) {
        assay_brdf_grid_destroy(grids->grids[i]);
    }
    if (grids->context) {
        assay_release(grids->context, (void *)grids->grids);
    }
}

assay_status lobe_look_up(const lobe_grids *grids, const lobe_pixel *pixel, double *scratch,
                          double *brdf_out)
{
    assay_material_grids found = {.slope = grids->grids[pixel->slope]};
    for (int c = 0; c < CHANNELS; c++) {
        found.black[c] = grids->grids[pixel->black[c]];
    }
    return assay_material_grids_brdf(&found, grids->count, pixel->base_color, pixel->wo, scratch,
                                     brdf_out);
}

/* ---- a lookup ---- */

/* Texels first ... last of an axis are touched, and the coordinate is off by `off`. */
typedef struct {
    size_t first, last;
    double at, off;
} touched_axis;

static touched_axis touch(const rounding *r, int side, tracked along, tracked whole)
{
    const tracked half = tracked_exact(0.5);
    const tracked u    = tracked_add(r, half, tracked_mul(r, half, tracked_div(r, along, whole)));
    const tracked at   = tracked_sub(r, tracked_mul(r, u, tracked_exact(side)), half);
    const double  most = side - 1.0;
    const double  low  = fmin(fmax(at.v - at.e, 0.0), most),
                 high  = fmin(fmax(at.v + at.e, 0.0), most);
    return (touched_axis){.first = (size_t)low,
                          .last  = (size_t)fmin(assay_floor(high) + 1.0, most),
                          .at    = fmin(fmax(at.v, 0.0), most),
                          .off   = at.e};
}

typedef struct {
    touched_axis column, row;
} touched_texels;

static touched_texels touch_texels(const rounding *r, const lobe_grids *grids, assay_vec3 wo)
{
    const double   length = vec3_length(wo);
    const tracked3 d      = tracked3_given(r, wo);
    /* 1 + z, or |wo| + z. */
    tracked whole = tracked_add(r, tracked_exact(1.0), d.z);
    whole.e += fabs(length - 1.0) + r->given + 4.0 * r->u;
    return (touched_texels){touch(r, grids->side, d.x, whole), touch(r, grids->side, d.y, whole)};
}

/* Coefficient k of a lobe. */
static tracked look(const rounding *r, const lobe_grids *grids, size_t lobe, size_t k,
                    const touched_texels *t)
{
    const size_t  side = (size_t)grids->side, row = side * grids->count;
    const double *texels = grids->texels + lobe * side * row + k;
    double        most = 0.0, across = 0.0, down = 0.0;
    for (size_t j = t->row.first; j <= t->row.last; j++) {
        for (size_t i = t->column.first; i <= t->column.last; i++) {
            const double *texel = texels + j * row + i * grids->count;
            most                = fmax(most, fabs(*texel));
            if (i < t->column.last) {
                across = fmax(across, fabs(texel[grids->count] - *texel));
            }
            if (j < t->row.last) {
                down = fmax(down, fabs(texel[row] - *texel));
            }
        }
    }
    return (tracked){most, t->column.off * across + t->row.off * down +
                               (LOOK_UP * r->u + r->given) * most +
                               4.0 * (r->tiny + r->given_tiny)};
}

void lobe_bound(const lobe_grids *grids, const turn_bound *bound, const rounding *r,
                const lobe_pixel *pixel, double *sizes_out, double *errors_out)
{
    const size_t         pairs  = turn_bound_pairs(bound);
    const touched_texels t      = touch_texels(r, grids, pixel->wo);
    const double base[CHANNELS] = {pixel->base_color.r, pixel->base_color.g, pixel->base_color.b};
    for (size_t i = 0; i < CHANNELS * pairs; i++) {
        sizes_out[i]  = 0.0;
        errors_out[i] = 0.0;
    }
    for (size_t i = 0; i < CHANNELS * grids->count && pixel->wo.z > 0.0; i++) {
        const size_t  c = i / grids->count, k = i % grids->count;
        const tracked slope = look(r, grids, pixel->slope, k, &t);
        const tracked sum   = tracked_add(r, look(r, grids, pixel->black[c], k, &t),
                                          tracked_mul(r, tracked_given(r, base[c]), slope));
        const size_t  at    = c * pairs + turn_bound_pair_of(bound, k);
        sizes_out[at]       = sqrt(sizes_out[at] * sizes_out[at] + sum.v * sum.v);
        errors_out[at]      = sqrt(errors_out[at] * errors_out[at] + sum.e * sum.e);
    }
}

double lobe_product_bound(const turn_bound *bound, const rounding *r, size_t count,
                          const double *sizes, const double *errors, const double *other_sizes,
                          const double *other_errors)
{
    const double grown = rounding_growth(r, (double)count + 4.0);
    double       sum   = 0.0;
    for (size_t i = 0; i < turn_bound_pairs(bound); i++) {
        const double all = (sizes[i] + errors[i]) * (other_sizes[i] + other_errors[i]);
        sum += all - sizes[i] * other_sizes[i] + grown * all;
    }
    return sum + r->tiny * (double)count;
}
