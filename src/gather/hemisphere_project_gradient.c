/* hemisphere_project_gradient.c - translational gradients of coefficients, in both forms.
 *
 * Both are sums over the borders of cells of a step of radiance times a function of the basis:
 *
 *     WALLS     (L_b - L_a) / min(r_a, r_b)
 *     POINTS    L_b / r_b - L_a / r_a, and over the cells L / r times the integrals of w H and of
 *               H n / cos xi
 *
 * For POINTS the usual sum of L (H grad Omega + Omega grad H) has been integrated over the cells by
 * Gauss's theorem on the sphere (docs/methods/gathering.md): no slopes of functions are left, which
 * are infinite on the horizon, and what the horizon hides of points that sink cancels.
 *
 * Invariant: column 0 has column N - 1 before it; sums run over columns, then strata. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "gather/hemisphere_grid.h"
#include "gather/hemisphere_plane.h"
#include "gather/hemisphere_project.h"

/* Surfaces seen more nearly edge-on than this do not change their solid angle by turning.
 * HEURISTIC: they cover 2^-20 of what is seen and would add 2^20 of noise. */
#define EDGE_ON 0x1p-20

typedef struct {
    hemisphere_grid     grid;
    assay_gradient_form form;
    assay_vec3         *sums; /* 3 rows of count */
} gradient_work;

/* ---- steps; 1 / INFINITY is 0 ---- */

static assay_rgb between(assay_rgb a, assay_rgb b) { return rgb(b.r - a.r, b.g - a.g, b.b - a.b); }

static assay_rgb moving(const assay_cell *cell)
{
    return rgb_scale(cell->radiance, 1.0 / cell->distance);
}

static assay_rgb border_step(const gradient_work *work, const assay_cell *a, const assay_cell *b)
{
    if (work->form == ASSAY_GRADIENT_POINTS) {
        return between(moving(a), moving(b));
    }
    const double nearer = a->distance < b->distance ? a->distance : b->distance;
    return rgb_scale(between(a->radiance, b->radiance), 1.0 / nearer);
}

/* n / cos xi, xi between the hit's normal and the ray. */
static assay_vec3 tilt(const assay_cell *cell)
{
    const double cosine = -vec3_dot(cell->hit_normal, cell->direction);
    return cosine > EDGE_ON ? vec3_scale(cell->hit_normal, 1.0 / cosine) : vec3(0.0, 0.0, 0.0);
}

/* ---- sums of one stratum ---- */

static const assay_cell *row_of(const gradient_work *work, int j)
{
    const assay_hemisphere *h = work->grid.hemisphere;
    return h->cells + (size_t)j * (size_t)h->layout.phi;
}

/* factor: of the moment's x, y and z. */
static void add_functions(gradient_work *work, assay_vec3 factor)
{
    const hemisphere_grid *grid   = &work->grid;
    const assay_vec3      *moment = grid->moment;
    assay_vec3            *sums   = work->sums;
    for (int c = 0; c < 3; c++, moment += grid->width, sums += grid->count) {
        for (size_t i = 0; i < grid->count; i++) {
            const assay_vec3 at = moment[grid->azimuth[i]];
            sums[i]             = vec3_mad(sums[i], grid->radial[i],
                                           vec3(factor.x * at.x, factor.y * at.y, factor.z * at.z));
        }
    }
}

/* Between strata j - 1 and j, a border of length sin theta: along theta-hat = (cos theta u,
 * -sin theta). */
static assay_status add_theta_borders(gradient_work *work, int j)
{
    hemisphere_grid          *grid  = &work->grid;
    const assay_theta_border *at    = &grid->hemisphere->theta[j];
    const assay_cell         *inner = row_of(work, j - 1), *outer = row_of(work, j);
    hemisphere_grid_clear_moment(grid);
    hemisphere_grid_clear_radial(grid);
    for (int k = 0; k < grid->hemisphere->layout.phi; k++) {
        hemisphere_grid_add_column(grid, border_step(work, &inner[k], &outer[k]), grid->column, k);
    }
    const assay_status status = hemisphere_grid_add_ring(grid, at->theta, at->sin);
    add_functions(work, vec3(at->cos, at->cos, -at->sin));
    return status;
}

/* Between columns of stratum j: along v, borders of length d theta. */
static assay_status add_phi_borders(gradient_work *work, int j)
{
    hemisphere_grid  *grid    = &work->grid;
    const int         columns = grid->hemisphere->layout.phi;
    const assay_cell *row     = row_of(work, j);
    hemisphere_grid_clear_moment(grid);
    hemisphere_grid_clear_radial(grid);
    for (int k = 0; k < columns; k++) {
        const assay_cell *before = &row[k == 0 ? columns - 1 : k - 1];
        hemisphere_grid_add_column(grid, border_step(work, before, &row[k]), grid->border, k);
    }
    const assay_status status = hemisphere_grid_add_stratum(grid, j, GRID_ARC);
    add_functions(work, vec3(1.0, 1.0, 0.0));
    return status;
}

/* Over the cells of stratum j: L / r times the integral of w H. */
static assay_status add_approach(gradient_work *work, int j)
{
    hemisphere_grid  *grid = &work->grid;
    const assay_cell *row  = row_of(work, j);
    hemisphere_grid_clear_moment(grid);
    hemisphere_grid_clear_radial(grid);
    for (int k = 0; k < grid->hemisphere->layout.phi; k++) {
        hemisphere_grid_add_column(grid, moving(&row[k]), grid->column, k);
    }
    assay_status status = hemisphere_grid_add_stratum(grid, j, GRID_SIDEWAYS);
    add_functions(work, vec3(1.0, 1.0, 0.0));
    hemisphere_grid_clear_radial(grid);
    if (status == ASSAY_OK) {
        status = hemisphere_grid_add_stratum(grid, j, GRID_UPWARD);
    }
    add_functions(work, vec3(0.0, 0.0, 1.0));
    return status;
}

/* Over the cells of stratum j: L / r times n / cos xi times the integral of H. */
static assay_status add_tilt(gradient_work *work, int j)
{
    hemisphere_grid  *grid = &work->grid;
    const assay_cell *row  = row_of(work, j);
    hemisphere_grid_clear_radial(grid);
    const assay_status status = hemisphere_grid_add_stratum(grid, j, GRID_SOLID);
    for (int axis = 0; axis < 3; axis++) {
        hemisphere_grid_clear_moment(grid);
        for (int k = 0; k < grid->hemisphere->layout.phi; k++) {
            const assay_vec3 n = tilt(&row[k]);
            hemisphere_grid_add_column(grid,
                                       rgb_scale(moving(&row[k]), axis == 0   ? n.x
                                                                  : axis == 1 ? n.y
                                                                              : n.z),
                                       grid->column, k);
        }
        const assay_vec3 *moment = grid->moment;
        for (size_t i = 0; i < 3 * grid->count; i++) {
            const size_t c = i / grid->count, function = i % grid->count;
            const double x =
                grid->radial[function] * moment[c * grid->width + grid->azimuth[function]].z;
            *(axis == 0 ? &work->sums[i].x : axis == 1 ? &work->sums[i].y : &work->sums[i].z) += x;
        }
    }
    return status;
}

/* ---- all of them ---- */

static assay_status add_stratum(gradient_work *work, int j)
{
    assay_status status = j > 0 ? add_theta_borders(work, j) : ASSAY_OK;
    if (status == ASSAY_OK) {
        status = add_phi_borders(work, j);
    }
    if (status == ASSAY_OK && work->form == ASSAY_GRADIENT_POINTS) {
        status = add_approach(work, j);
    }
    if (status == ASSAY_OK && work->form == ASSAY_GRADIENT_POINTS) {
        status = add_tilt(work, j);
    }
    return status;
}

static assay_status add_strata(gradient_work *work, assay_context *context,
                               const assay_hemisphere *hemisphere, const assay_basis *basis)
{
    assay_status status = hemisphere_grid_open(&work->grid, context, hemisphere, basis);
    for (int j = 0; j < hemisphere->layout.theta && status == ASSAY_OK; j++) {
        status = add_stratum(work, j);
    }
    hemisphere_grid_close(&work->grid, context);
    return status;
}

assay_status assay_hemisphere_project_gradient(const assay_hemisphere *hemisphere,
                                               assay_context *context, const assay_basis *basis,
                                               assay_gradient_form form, assay_vec3 *gradients_out)
{
    const assay_status checked = hemisphere_project_check(context, basis);
    if (checked != ASSAY_OK) {
        return checked;
    }
    if (form != ASSAY_GRADIENT_POINTS && form != ASSAY_GRADIENT_WALLS) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "unknown form of a gradient");
    }
    if (hemisphere->plane && form == ASSAY_GRADIENT_POINTS) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "gradients of coefficients on a plane are those of walls");
    }
    const size_t  count = 3 * assay_basis_count(basis);
    gradient_work work  = {.form = form, .sums = assay_allocate(context, count, sizeof *work.sums)};
    if (!work.sums) {
        return assay_fail_memory(context, "a gradient");
    }
    assay_status status =
        hemisphere->plane ? hemisphere_plane_project_gradient(hemisphere, context, basis, work.sums)
                          : add_strata(&work, context, hemisphere, basis);
    if (status == ASSAY_OK) {
        memcpy(gradients_out, work.sums, count * sizeof *work.sums);
    }
    assay_release(context, work.sums);
    return status;
}
