/* hemisphere_gradient.c - how irradiance changes when the surface turns or moves.
 *
 * Both gradients are those of a hemisphere of cells of constant radiance, integrated exactly over
 * the cells' borders (docs/methods/gathering.md).  They are sums of differences of neighbours, also
 * the rotational one, which [ward-heckbert92] sums over the cells with tan theta at their samples:
 * so both are exactly 0 in a furnace, and no weight grows without bound at the horizon.
 *
 * Invariant: phi is cyclic; column 0 has column N - 1 before it. */
#include "core/numerics.h"
#include "gather/hemisphere_plane.h"

/* b - a per channel. */
static assay_rgb step_between(const assay_cell *a, const assay_cell *b)
{
    return rgb(b->radiance.r - a->radiance.r, b->radiance.g - a->radiance.g,
               b->radiance.b - a->radiance.b);
}

/* The border between two cells moves as the nearer of the things seen; 1 / INFINITY is 0. */
static double wall_speed(const assay_cell *a, const assay_cell *b)
{
    return 1.0 / (a->distance < b->distance ? a->distance : b->distance);
}

static void add(assay_vec3 sum[3], assay_rgb step, assay_vec3 way)
{
    sum[0] = vec3_mad(sum[0], step.r, way);
    sum[1] = vec3_mad(sum[1], step.g, way);
    sum[2] = vec3_mad(sum[2], step.b, way);
}

static const assay_cell *row_of(const assay_hemisphere *h, int j)
{
    return h->cells + (size_t)j * (size_t)h->layout.phi;
}

/* n x Phi, Phi the integral of L w dw.  n x w = sin theta (-sin phi, cos phi), whose integral over
 * a cell is that of sin^2 theta times u(phi_+) - u(phi_-), u = (cos phi, sin phi); the sum over a
 * stratum, by parts, is one of differences of radiance at the borders of columns. */
void assay_hemisphere_rotation_gradient(const assay_hemisphere *hemisphere,
                                        assay_vec3              gradient_out[3])
{
    if (hemisphere->plane) {
        hemisphere_plane_rotation(hemisphere, gradient_out);
        return;
    }
    const int  columns = hemisphere->layout.phi;
    assay_vec3 sum[3]  = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int j = 0; j < hemisphere->layout.theta; j++) {
        const assay_theta_border *inner = &hemisphere->theta[j], *outer = inner + 1;
        const assay_cell         *row    = row_of(hemisphere, j);
        const double              weight = 0.5 * ((outer->theta - outer->sin * outer->cos) -
                                     (inner->theta - inner->sin * inner->cos));
        for (int k = 0; k < columns; k++) {
            const assay_cell       *before = &row[k == 0 ? columns - 1 : k - 1];
            const assay_phi_column *phi    = &hemisphere->phi[k];
            add(sum, step_between(before, &row[k]),
                vec3(-weight * phi->border_cos, -weight * phi->border_sin, 0.0));
        }
    }
    for (int c = 0; c < 3; c++) {
        gradient_out[c] = sum[c];
    }
}

/* Borders of constant theta between strata j - 1 and j: they move along theta at
 * -(delta . theta-hat) / r, theta-hat = (cos theta u, -sin theta). */
static void add_theta_walls(const assay_hemisphere *h, int j, bool normal, assay_vec3 sum[3])
{
    const int                 columns = h->layout.phi;
    const assay_theta_border *at      = &h->theta[j];
    const assay_cell         *inner = row_of(h, j - 1), *outer = row_of(h, j);
    const double              flux   = at->sin * at->cos;
    const double              along  = flux * at->cos * 2.0 * assay_sincos_turns(0.5 / columns).sin;
    const double              upward = normal ? -flux * at->sin * (ASSAY_TWO_PI / columns) : 0.0;
    for (int k = 0; k < columns; k++) {
        const double speed = wall_speed(&inner[k], &outer[k]);
        add(sum, step_between(&inner[k], &outer[k]),
            vec3(speed * along * h->phi[k].middle_cos, speed * along * h->phi[k].middle_sin,
                 speed * upward));
    }
}

/* Borders of constant phi between columns k - 1 and k: they move along phi at
 * -(delta . v) / (r sin theta), v = (-sin phi, cos phi); the sine goes out against the area's. */
static void add_phi_walls(const assay_hemisphere *h, int j, assay_vec3 sum[3])
{
    const int         columns = h->layout.phi;
    const assay_cell *row     = row_of(h, j);
    const double      flux    = h->theta[j + 1].sin - h->theta[j].sin;
    for (int k = 0; k < columns; k++) {
        const assay_cell *before = &row[k == 0 ? columns - 1 : k - 1];
        const double      speed  = flux * wall_speed(before, &row[k]);
        add(sum, step_between(before, &row[k]),
            vec3(-speed * h->phi[k].border_sin, speed * h->phi[k].border_cos, 0.0));
    }
}

void assay_hemisphere_translation_gradient(const assay_hemisphere *hemisphere, bool normal,
                                           assay_vec3 gradient_out[3])
{
    if (hemisphere->plane) {
        hemisphere_plane_translation(hemisphere, normal, gradient_out);
        return;
    }
    assay_vec3 sum[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int j = 0; j < hemisphere->layout.theta; j++) {
        if (j > 0) {
            add_theta_walls(hemisphere, j, normal, sum);
        }
        add_phi_walls(hemisphere, j, sum);
    }
    for (int c = 0; c < 3; c++) {
        gradient_out[c] = sum[c];
    }
}
