/* hemisphere_grid.c - see hemisphere_grid.h.
 *
 * Cells form a grid and functions are products, so a sum over cells meets the azimuths first and
 * the functions only once a stratum: M N (2 n - 1) steps instead of M N n^2.  In phi integrals are
 * exact, in theta by Gauss.
 *
 * Invariant: radial and moment are sums in the order of the calls. */
#include "gather/hemisphere_grid.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

/* Nodes of a stratum: R is smooth but for roots of cos theta at the horizon. */
enum { NODES = 8 };

static void find_partners(hemisphere_grid *grid)
{
    size_t    even[ASSAY_BASIS_MAX_ORDER][ASSAY_BASIS_MAX_ORDER] = {{0}};
    const int order                                              = assay_basis_order(grid->basis);
    for (size_t i = 0; i < grid->count; i++) {
        int l = 0, m = 0;
        assay_basis_function(grid->basis, i, &l, &m);
        grid->azimuth[i] = (size_t)(m + order - 1);
        if (m >= 0) {
            even[l][m] = i;
        }
    }
    for (size_t i = 0; i < grid->count; i++) {
        int l = 0, m = 0;
        assay_basis_function(grid->basis, i, &l, &m);
        grid->partner[i] = even[l][m < 0 ? -m : m];
    }
}

/* Integrals of sin q phi and cos q phi over column k; whole turns are left out of q phi. */
static assay_sincos integrate_wave(int q, int k, int columns)
{
    const int          half_steps = q * (2 * k + 1) % (2 * columns);
    const assay_sincos middle     = assay_sincos_turns(half_steps / (2.0 * columns));
    const double       width =
        q == 0 ? ASSAY_TWO_PI / columns : 2.0 * assay_sincos_turns(0.5 * q / columns).sin / q;
    return (assay_sincos){width * middle.sin, width * middle.cos};
}

static void fill_rows(hemisphere_grid *grid, int k)
{
    const int               columns = grid->hemisphere->layout.phi;
    const int               order   = assay_basis_order(grid->basis);
    const assay_phi_column *at      = &grid->hemisphere->phi[k];
    const size_t            zonal   = (size_t)k * grid->width + (size_t)(order - 1);
    assay_vec3             *column = grid->column + zonal, *border = grid->border + zonal;
    for (int m = 0; m < order; m++) {
        const assay_sincos up    = integrate_wave(m + 1, k, columns);
        const assay_sincos level = integrate_wave(m, k, columns);
        const assay_sincos down  = integrate_wave(m - 1, k, columns);
        const assay_sincos t     = assay_sincos_turns((double)(m * k % columns) / columns);
        if (m > 0) {
            column[-m] = vec3(0.5 * (up.sin + down.sin), 0.5 * (down.cos - up.cos), level.sin);
            border[-m] = vec3(-t.sin * at->border_sin, t.sin * at->border_cos, 0.0);
        }
        column[m] = vec3(0.5 * (up.cos + down.cos), 0.5 * (up.sin - down.sin), level.cos);
        border[m] = vec3(-t.cos * at->border_sin, t.cos * at->border_cos, 0.0);
    }
}

assay_status hemisphere_grid_open(hemisphere_grid *grid, assay_context *context,
                                  const assay_hemisphere *hemisphere, const assay_basis *basis)
{
    const size_t columns = (size_t)hemisphere->layout.phi;
    *grid                = (hemisphere_grid){.hemisphere = hemisphere,
                                             .basis      = basis,
                                             .count      = assay_basis_count(basis),
                                             .width      = (size_t)(2 * assay_basis_order(basis) - 1)};
    grid->partner        = assay_allocate(context, grid->count, sizeof *grid->partner);
    grid->azimuth        = assay_allocate(context, grid->count, sizeof *grid->azimuth);
    grid->column         = assay_allocate(context, columns * grid->width, sizeof *grid->column);
    grid->border         = assay_allocate(context, columns * grid->width, sizeof *grid->border);
    grid->values         = assay_allocate(context, grid->count, sizeof *grid->values);
    grid->radial         = assay_allocate(context, grid->count, sizeof *grid->radial);
    grid->moment         = assay_allocate(context, 3 * grid->width, sizeof *grid->moment);
    if (!grid->partner || !grid->azimuth || !grid->column || !grid->border || !grid->values ||
        !grid->radial || !grid->moment) {
        return assay_fail_memory(context, "a basis on a hemisphere");
    }
    find_partners(grid);
    for (int k = 0; k < hemisphere->layout.phi; k++) {
        fill_rows(grid, k);
    }
    return ASSAY_OK;
}

void hemisphere_grid_close(hemisphere_grid *grid, assay_context *context)
{
    assay_release(context, grid->partner);
    assay_release(context, grid->azimuth);
    assay_release(context, grid->column);
    assay_release(context, grid->border);
    assay_release(context, grid->values);
    assay_release(context, grid->radial);
    assay_release(context, grid->moment);
}

void hemisphere_grid_clear_radial(hemisphere_grid *grid)
{
    for (size_t i = 0; i < grid->count; i++) {
        grid->radial[i] = 0.0;
    }
}

void hemisphere_grid_clear_moment(hemisphere_grid *grid)
{
    for (size_t i = 0; i < 3 * grid->width; i++) {
        grid->moment[i] = vec3(0.0, 0.0, 0.0);
    }
}

assay_status hemisphere_grid_add_ring(hemisphere_grid *grid, double theta, double weight)
{
    const assay_sincos at = assay_sincos_radians(theta);
    const assay_status status =
        assay_basis_evaluate(grid->basis, vec3(at.sin, 0.0, at.cos), grid->values);
    if (status == ASSAY_OK) {
        for (size_t i = 0; i < grid->count; i++) {
            grid->radial[i] += weight * grid->values[grid->partner[i]];
        }
    }
    return status;
}

static double measure_at(hemisphere_grid_measure measure, double theta)
{
    const assay_sincos at = assay_sincos_radians(theta);
    switch (measure) {
    case GRID_SOLID: return at.sin;
    case GRID_SIDEWAYS: return at.sin * at.sin;
    case GRID_UPWARD: return at.sin * at.cos;
    default: return 1.0;
    }
}

assay_status hemisphere_grid_add_stratum(hemisphere_grid *grid, int j,
                                         hemisphere_grid_measure measure)
{
    const assay_theta_border *border = &grid->hemisphere->theta[j];
    double                    nodes[NODES], weights[NODES];
    assay_status              status = ASSAY_OK;
    assay_gauss_legendre_on(border[0].theta, border[1].theta, NODES, nodes, weights);
    for (int i = 0; i < NODES && status == ASSAY_OK; i++) {
        status =
            hemisphere_grid_add_ring(grid, nodes[i], weights[i] * measure_at(measure, nodes[i]));
    }
    return status;
}

void hemisphere_grid_add_column(hemisphere_grid *grid, assay_rgb step, const assay_vec3 *table,
                                int k)
{
    const assay_vec3 *row = table + (size_t)k * grid->width;
    assay_vec3       *r = grid->moment, *g = r + grid->width, *b = g + grid->width;
    for (size_t m = 0; m < grid->width; m++) {
        r[m] = vec3_mad(r[m], step.r, row[m]);
        g[m] = vec3_mad(g[m], step.g, row[m]);
        b[m] = vec3_mad(b[m], step.b, row[m]);
    }
}
