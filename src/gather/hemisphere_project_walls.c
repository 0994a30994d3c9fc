/* hemisphere_project_walls.c - gradients of coefficients by the motion of the cells' borders.
 *
 * A function is R(theta) t(phi), t a cosine or a sine of m phi, and the borders form a grid.  So
 * every border is integrated exactly in phi, by table, and in theta by Gauss, once a stratum; and
 * differences of radiance meet the azimuths first and the functions only once a stratum: M N (2 n -
 * 1) steps instead of M N n^2.
 *
 * Invariant: column 0 has column N - 1 before it; sums run over columns, then strata. */
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "gather/hemisphere_project.h"
#include "math/quadrature.h"

/* Nodes of a stratum in theta: R is smooth but for roots of cos theta at the horizon. */
enum { NODES = 8 };

/* A vector in the plane. */
typedef struct {
    double x, y;
} planar;

typedef struct {
    const assay_hemisphere *hemisphere;
    const assay_basis      *basis;
    size_t                  count;
    int                     order, width; /* width: of a column of the tables, 2 order - 1        */
    size_t *partner; /* of each function: the one with m >= 0, whose value at phi = 0
                        is R                                                     */
    int    *azimuth; /* of each function: m + order - 1                          */
    planar *along;   /* [k width + m + order - 1]: integral of t u over column k                  */
    planar *across;  /* same: t v at the border before column k                                   */
    double *values;  /* count                                                                     */
    double *radial;  /* count: R, or its integral over a stratum                                  */
    planar *moment;  /* 3 width: sum over columns of difference / distance times a table          */
} walls;

/* ---- tables ---- */

static void find_partners(walls *w)
{
    short zonal[ASSAY_BASIS_MAX_ORDER][ASSAY_BASIS_MAX_ORDER] = {{0}};
    for (size_t i = 0; i < w->count; i++) {
        int l = 0, m = 0;
        assay_basis_function(w->basis, i, &l, &m);
        w->azimuth[i] = m + w->order - 1;
        if (m >= 0) {
            zonal[l][m] = (short)i;
        }
    }
    for (size_t i = 0; i < w->count; i++) {
        int l = 0, m = 0;
        assay_basis_function(w->basis, i, &l, &m);
        w->partner[i] = (size_t)zonal[l][m < 0 ? -m : m];
    }
}

/* Integrals of cos q phi and sin q phi over column k; whole turns are left out of q phi. */
static assay_sincos integrate_wave(int q, int k, int columns)
{
    const long long    half_steps = (long long)q * (2 * k + 1);
    const assay_sincos middle =
        assay_sincos_turns((double)(half_steps % (2LL * columns)) / (2.0 * columns));
    const double width =
        q == 0 ? ASSAY_TWO_PI / columns : 2.0 * assay_sincos_turns(0.5 * q / columns).sin / q;
    return (assay_sincos){width * middle.sin, width * middle.cos};
}

static void fill_column(walls *w, int k)
{
    const int               columns = w->hemisphere->layout.phi;
    const assay_phi_column *at      = &w->hemisphere->phi[k];
    planar                 *along   = w->along + (size_t)k * (size_t)w->width + (w->order - 1);
    planar                 *across  = w->across + (size_t)k * (size_t)w->width + (w->order - 1);
    for (int m = 0; m < w->order; m++) {
        const assay_sincos up   = integrate_wave(m + 1, k, columns);
        const assay_sincos down = integrate_wave(m - 1, k, columns);
        const assay_sincos t = assay_sincos_turns((double)((long long)m * k % columns) / columns);
        if (m > 0) {
            along[-m]  = (planar){0.5 * (up.sin + down.sin), 0.5 * (down.cos - up.cos)};
            across[-m] = (planar){-t.sin * at->border_sin, t.sin * at->border_cos};
        }
        along[m]  = (planar){0.5 * (up.cos + down.cos), 0.5 * (up.sin - down.sin)};
        across[m] = (planar){-t.cos * at->border_sin, t.cos * at->border_cos};
    }
}

/* ---- one border or stratum ---- */

/* Adds `weight` R(theta) of every function. */
static assay_status add_radial(walls *w, double theta, double weight)
{
    const assay_sincos at = assay_sincos_radians(theta);
    const assay_status status =
        assay_basis_evaluate(w->basis, vec3(at.sin, 0.0, at.cos), w->values);
    if (status == ASSAY_OK) {
        for (size_t i = 0; i < w->count; i++) {
            w->radial[i] += weight * w->values[w->partner[i]];
        }
    }
    return status;
}

static void clear(walls *w)
{
    for (size_t i = 0; i < w->count; i++) {
        w->radial[i] = 0.0;
    }
    for (int i = 0; i < 3 * w->width; i++) {
        w->moment[i] = (planar){0.0, 0.0};
    }
}

static void add_moment(walls *w, const assay_cell *a, const assay_cell *b, const planar *table)
{
    const double speed   = 1.0 / (a->distance < b->distance ? a->distance : b->distance);
    const double step[3] = {speed * (b->radiance.r - a->radiance.r),
                            speed * (b->radiance.g - a->radiance.g),
                            speed * (b->radiance.b - a->radiance.b)};
    planar      *moment  = w->moment;
    for (int c = 0; c < 3; c++, moment += w->width) {
        for (int m = 0; m < w->width; m++) {
            moment[m].x += step[c] * table[m].x;
            moment[m].y += step[c] * table[m].y;
        }
    }
}

static void add_functions(const walls *w, assay_vec3 *sums)
{
    const planar *moment = w->moment;
    for (int c = 0; c < 3; c++, moment += w->width, sums += w->count) {
        for (size_t i = 0; i < w->count; i++) {
            sums[i].x += w->radial[i] * moment[w->azimuth[i]].x;
            sums[i].y += w->radial[i] * moment[w->azimuth[i]].y;
        }
    }
}

/* Between strata j - 1 and j: (delta . theta-hat) / r of a border of length sin theta. */
static assay_status add_theta_walls(walls *w, int j, assay_vec3 *sums)
{
    const assay_theta_border *at      = &w->hemisphere->theta[j];
    const size_t              columns = (size_t)w->hemisphere->layout.phi;
    const assay_cell         *outer   = w->hemisphere->cells + (size_t)j * columns;
    clear(w);
    const assay_status status = add_radial(w, at->theta, at->sin * at->cos);
    for (size_t k = 0; k < columns; k++) {
        add_moment(w, outer + k - columns, outer + k, w->along + k * (size_t)w->width);
    }
    add_functions(w, sums);
    return status;
}

/* Between columns of stratum j; the sine of their speed goes out against that of the area. */
static assay_status add_phi_walls(walls *w, int j, assay_vec3 *sums)
{
    const size_t      columns = (size_t)w->hemisphere->layout.phi;
    const assay_cell *row     = w->hemisphere->cells + (size_t)j * columns;
    double            nodes[NODES], weights[NODES];
    assay_status      status = ASSAY_OK;
    clear(w);
    assay_gauss_legendre_on(w->hemisphere->theta[j].theta, w->hemisphere->theta[j + 1].theta, NODES,
                            nodes, weights);
    for (int q = 0; q < NODES && status == ASSAY_OK; q++) {
        status = add_radial(w, nodes[q], weights[q]);
    }
    for (size_t k = 0; k < columns; k++) {
        add_moment(w, &row[k == 0 ? columns - 1 : k - 1], &row[k],
                   w->across + k * (size_t)w->width);
    }
    add_functions(w, sums);
    return status;
}

/* ---- all of them ---- */

static bool open_walls(walls *w, assay_context *context)
{
    const size_t table = (size_t)w->hemisphere->layout.phi * (size_t)w->width;
    w->partner         = assay_allocate(context, w->count, sizeof *w->partner);
    w->azimuth         = assay_allocate(context, w->count, sizeof *w->azimuth);
    w->along           = assay_allocate(context, table, sizeof *w->along);
    w->across          = assay_allocate(context, table, sizeof *w->across);
    w->values          = assay_allocate(context, w->count, sizeof *w->values);
    w->radial          = assay_allocate(context, w->count, sizeof *w->radial);
    w->moment          = assay_allocate(context, 3 * (size_t)w->width, sizeof *w->moment);
    return w->partner && w->azimuth && w->along && w->across && w->values && w->radial && w->moment;
}

static void close_walls(walls *w, assay_context *context)
{
    assay_release(context, w->partner);
    assay_release(context, w->azimuth);
    assay_release(context, w->along);
    assay_release(context, w->across);
    assay_release(context, w->values);
    assay_release(context, w->radial);
    assay_release(context, w->moment);
}

assay_status hemisphere_add_walls(const assay_hemisphere *hemisphere, assay_context *context,
                                  const assay_basis *basis, assay_vec3 *sums)
{
    walls w = {.hemisphere = hemisphere,
               .basis      = basis,
               .count      = assay_basis_count(basis),
               .order      = assay_basis_order(basis)};
    w.width = 2 * w.order - 1;
    assay_status status =
        open_walls(&w, context) ? ASSAY_OK : assay_fail_memory(context, "a gradient");
    if (status == ASSAY_OK) {
        find_partners(&w);
        for (int k = 0; k < hemisphere->layout.phi; k++) {
            fill_column(&w, k);
        }
    }
    for (int j = 0; j < hemisphere->layout.theta && status == ASSAY_OK; j++) {
        status = j > 0 ? add_theta_walls(&w, j, sums) : ASSAY_OK;
        if (status == ASSAY_OK) {
            status = add_phi_walls(&w, j, sums);
        }
    }
    close_walls(&w, context);
    return status;
}
