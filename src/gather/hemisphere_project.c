/* hemisphere_project.c - coefficients of the radiance that arrives.
 *
 * In UNIFORM strata a cell's solid angle times the functions in the direction that was looked in
 * has no bias.  In COSINE strata the last one covers M^-1/2 of the hemisphere: the unbiased weight,
 * pi / (M N cos theta), has no finite variance there, and the solid angle times the functions in
 * one direction errs by 1 / M and much; so functions are integrated over the cells
 * (docs/methods/gathering.md).
 *
 * Invariant: outputs are copied from sums of our own when all has gone well. */
#include "gather/hemisphere_project.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "gather/hemisphere_grid.h"
#include "gather/hemisphere_plane.h"

/* Orthonormal under solid angle on the hemisphere, so that a coefficient is an integral. */
assay_status hemisphere_project_check(assay_context *context, const assay_basis *basis)
{
    switch (assay_basis_kind_of(basis)) {
    case ASSAY_BASIS_HSH:
    case ASSAY_BASIS_ZERNIKE:
    case ASSAY_BASIS_MAKHOTKIN_SQRT:
    case ASSAY_BASIS_ESH: return ASSAY_OK;
    default: break;
    }
    return assay_fail(context, ASSAY_ERR_ARGUMENT,
                      "%s: a hemisphere is projected onto hsh, zernike, makhotkin-sqrt or esh",
                      assay_basis_kind_name(assay_basis_kind_of(basis)));
}

static assay_status fail_direction(assay_context *context, assay_status status, int j)
{
    return status == ASSAY_ERR_DOMAIN
               ? assay_fail(context, status,
                            "stratum %d of a hemisphere: a direction is not of unit length or not "
                            "above the horizon",
                            j)
               : status;
}

/* ---- coefficients ---- */

static void add_value(double *sums, size_t count, size_t i, assay_rgb value)
{
    sums[i] += value.r;
    sums[count + i] += value.g;
    sums[2 * count + i] += value.b;
}

/* From the directions of stratum j; values: a row of count for each. */
static assay_status add_directions(const assay_hemisphere *h, const assay_basis *basis, int j,
                                   assay_vec3 *directions, double *values, double *sums)
{
    const size_t      count = assay_basis_count(basis), columns = (size_t)h->layout.phi;
    const assay_cell *row   = h->cells + (size_t)j * columns;
    const double      angle = assay_hemisphere_solid_angle(h, j);
    for (size_t k = 0; k < columns; k++) {
        directions[k] = row[k].direction;
    }
    const assay_status status = assay_basis_evaluate_many(basis, columns, directions, values);
    for (size_t k = 0; k < columns && status == ASSAY_OK; k++) {
        const assay_rgb power = rgb_scale(row[k].radiance, angle);
        for (size_t i = 0; i < count; i++) {
            add_value(sums, count, i, rgb_scale(power, values[k * count + i]));
        }
    }
    return status;
}

static assay_status project_directions(const assay_hemisphere *h, assay_context *context,
                                       const assay_basis *basis, double *sums)
{
    const size_t columns    = (size_t)h->layout.phi;
    assay_vec3  *directions = assay_allocate(context, columns, sizeof *directions);
    double *values = assay_allocate(context, columns * assay_basis_count(basis), sizeof *values);
    assay_status status = ASSAY_OK;
    if (directions && values) {
        for (int j = 0; j < h->layout.theta && status == ASSAY_OK; j++) {
            status =
                fail_direction(context, add_directions(h, basis, j, directions, values, sums), j);
        }
    } else {
        status = assay_fail_memory(context, "a projection");
    }
    assay_release(context, directions);
    assay_release(context, values);
    return status;
}

static assay_status project_cells(const assay_hemisphere *h, assay_context *context,
                                  const assay_basis *basis, double *sums)
{
    hemisphere_grid   grid;
    assay_status      status = hemisphere_grid_open(&grid, context, h, basis);
    const assay_cell *cell   = h->cells;
    for (int j = 0; j < h->layout.theta && status == ASSAY_OK; j++) {
        hemisphere_grid_clear_moment(&grid);
        hemisphere_grid_clear_radial(&grid);
        for (int k = 0; k < h->layout.phi; k++, cell++) {
            hemisphere_grid_add_column(&grid, cell->radiance, grid.column, k);
        }
        status = hemisphere_grid_add_stratum(&grid, j, GRID_SOLID);
        for (size_t i = 0; i < grid.count; i++) {
            const assay_vec3 *at = grid.moment + grid.azimuth[i];
            add_value(
                sums, grid.count, i,
                rgb_scale(rgb(at[0].z, at[grid.width].z, at[2 * grid.width].z), grid.radial[i]));
        }
    }
    hemisphere_grid_close(&grid, context);
    return status;
}

assay_status assay_hemisphere_project(const assay_hemisphere *hemisphere, assay_context *context,
                                      const assay_basis *basis, double *coefficients_out)
{
    assay_status status = hemisphere_project_check(context, basis);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t count = 3 * assay_basis_count(basis);
    double      *sums  = assay_allocate(context, count, sizeof *sums);
    if (!sums) {
        return assay_fail_memory(context, "a projection");
    }
    status = hemisphere->plane ? hemisphere_plane_project(hemisphere, context, basis, sums)
             : hemisphere->layout.strata == ASSAY_STRATA_UNIFORM
                 ? project_directions(hemisphere, context, basis, sums)
                 : project_cells(hemisphere, context, basis, sums);
    if (status == ASSAY_OK) {
        memcpy(coefficients_out, sums, count * sizeof *sums);
    }
    assay_release(context, sums);
    return status;
}
