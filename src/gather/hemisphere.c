/* hemisphere.c - the cells, irradiance and distances.
 *
 * Values are estimated as published, from the directions that were looked in; what depends on the
 * borders of cells (distances, gradients) takes every cell as filled by what its direction saw.
 *
 * Invariant: a hemisphere can always be evaluated: until they are written, cells see nothing. */
#include "gather/hemisphere.h"

#include <assert.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "gather/hemisphere_plane.h"

/* sin^2 theta or 1 - cos theta of border j is j / M; the other comes from what is left of M, so
 * that nothing cancels near the horizon and z stays above 0 however the sum rounds. */
static assay_theta_border theta_at(const assay_hemisphere_layout *layout, int j, double u)
{
    const double inner = (j + u) / layout->theta;
    const double outer = ((layout->theta - j) - u) / layout->theta;
    const bool   flat  = layout->strata == ASSAY_STRATA_COSINE;
    const double sine  = flat ? sqrt(inner) : sqrt(inner * (1.0 + outer));
    const double z     = flat ? sqrt(outer) : outer;
    return (assay_theta_border){.sin = sine, .cos = z};
}

assay_vec3 assay_hemisphere_direction(const assay_hemisphere_layout *layout, int j, int k,
                                      double u1, double u2)
{
    if (layout->strata == ASSAY_STRATA_PLANE) {
        return hemisphere_plane_direction(layout, j, k, u1, u2);
    }
    const assay_theta_border theta = theta_at(layout, j, u1);
    const assay_sincos       phi   = assay_sincos_turns((k + u2) / layout->phi);
    return vec3(theta.sin * phi.cos, theta.sin * phi.sin, theta.cos);
}

static void fill_directions(assay_hemisphere *h)
{
    const assay_hemisphere_layout *layout = &h->layout;
    for (int j = 0; j < layout->theta; j++) {
        for (int k = 0; k < layout->phi; k++) {
            h->cells[(size_t)j * (size_t)layout->phi + (size_t)k] =
                (assay_cell){.distance  = INFINITY,
                             .direction = assay_hemisphere_direction(layout, j, k, 0.5, 0.5)};
        }
    }
}

static void fill_borders(assay_hemisphere *h)
{
    const assay_hemisphere_layout *layout = &h->layout;
    for (int j = 0; j <= layout->theta; j++) {
        h->theta[j]       = theta_at(layout, j, 0.0);
        h->theta[j].theta = assay_atan2(h->theta[j].sin, h->theta[j].cos);
    }
    for (int k = 0; k < layout->phi; k++) {
        const assay_sincos border = assay_sincos_turns((double)k / layout->phi);
        const assay_sincos middle = assay_sincos_turns((k + 0.5) / layout->phi);
        h->phi[k] = (assay_phi_column){border.sin, border.cos, middle.sin, middle.cos};
    }
}

assay_status assay_hemisphere_create(assay_context *context, const assay_hemisphere_layout *layout,
                                     assay_hemisphere **hemisphere_out)
{
    if (layout->theta < 2 || layout->theta > ASSAY_STRATA_MAX || layout->phi < 2 ||
        layout->phi > ASSAY_STRATA_MAX) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a hemisphere of %d x %d cells: both must be 2 ... %d", layout->theta,
                          layout->phi, ASSAY_STRATA_MAX);
    }
    if ((int)layout->strata < 0 || layout->strata > ASSAY_STRATA_PLANE) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "unknown stratification of a hemisphere");
    }
    const size_t      rows = (size_t)layout->theta, columns = (size_t)layout->phi;
    assay_hemisphere *h = assay_allocate(context, 1, sizeof *h);
    if (h) {
        h->layout = *layout;
        h->cells  = assay_allocate(context, rows * columns, sizeof *h->cells);
        h->theta  = assay_allocate(context, rows + 1, sizeof *h->theta);
        h->phi    = assay_allocate(context, columns, sizeof *h->phi);
    }
    if (!h || !h->cells || !h->theta || !h->phi) {
        assay_hemisphere_destroy(context, h);
        return assay_fail_memory(context, "a hemisphere");
    }
    fill_directions(h);
    if (layout->strata == ASSAY_STRATA_PLANE) {
        const assay_status status = hemisphere_plane_create(context, layout, &h->plane);
        if (status != ASSAY_OK) {
            assay_hemisphere_destroy(context, h);
            return status;
        }
    } else {
        fill_borders(h);
    }
    *hemisphere_out = h;
    return ASSAY_OK;
}

void assay_hemisphere_destroy(assay_context *context, assay_hemisphere *hemisphere)
{
    if (hemisphere) {
        assay_release(context, hemisphere->cells);
        assay_release(context, hemisphere->theta);
        assay_release(context, hemisphere->phi);
        hemisphere_plane_destroy(context, hemisphere->plane);
        assay_release(context, hemisphere);
    }
}

/* cos theta_j - cos theta_(j + 1), where the difference of what is stored would lose digits. */
static double height(const assay_hemisphere *h, int j)
{
    const assay_theta_border *a = &h->theta[j], *b = &h->theta[j + 1];
    return h->layout.strata == ASSAY_STRATA_UNIFORM ? 1.0 / h->layout.theta
                                                    : (1.0 / h->layout.theta) / (a->cos + b->cos);
}

double assay_hemisphere_solid_angle(const assay_hemisphere *hemisphere, int j)
{
    assert(!hemisphere->plane);
    return ASSAY_TWO_PI / hemisphere->layout.phi * height(hemisphere, j);
}

assay_rgb assay_hemisphere_irradiance(const assay_hemisphere *hemisphere)
{
    if (hemisphere->plane) {
        return hemisphere_plane_irradiance(hemisphere);
    }
    const bool        uniform = hemisphere->layout.strata == ASSAY_STRATA_UNIFORM;
    const assay_cell *cell    = hemisphere->cells;
    const size_t      count   = (size_t)hemisphere->layout.theta * (size_t)hemisphere->layout.phi;
    assay_rgb         sum     = rgb_grey(0.0);
    for (size_t i = 0; i < count; i++) {
        sum = rgb_add(sum, uniform ? rgb_scale(cell[i].radiance, cell[i].direction.z)
                                   : cell[i].radiance);
    }
    return rgb_scale(sum, (uniform ? ASSAY_TWO_PI : ASSAY_PI) / (double)count);
}

/* 1 / INFINITY is 0: what is not hit is infinitely far and counts in the weights alone. */
double assay_hemisphere_harmonic_mean(const assay_hemisphere *hemisphere, assay_mean_weight weight)
{
    if (hemisphere->plane) {
        return hemisphere_plane_mean(hemisphere, weight);
    }
    const assay_cell *cell = hemisphere->cells;
    double            all = 0.0, near = 0.0;
    for (int j = 0; j < hemisphere->layout.theta; j++) {
        const double cosines = 0.5 * (hemisphere->theta[j].cos + hemisphere->theta[j + 1].cos);
        const double share = height(hemisphere, j) * (weight == ASSAY_MEAN_COSINE ? cosines : 1.0);
        for (int k = 0; k < hemisphere->layout.phi; k++, cell++) {
            all += share;
            near += share / cell->distance;
        }
    }
    return all / near;
}

double assay_hemisphere_nearest(const assay_hemisphere *hemisphere)
{
    const size_t count   = (size_t)hemisphere->layout.theta * (size_t)hemisphere->layout.phi;
    double       nearest = INFINITY;
    for (size_t i = 0; i < count; i++) {
        const double d = hemisphere->cells[i].distance;
        nearest        = d < nearest ? d : nearest;
    }
    return nearest;
}
