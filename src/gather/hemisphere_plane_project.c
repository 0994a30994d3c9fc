/* hemisphere_plane_project.c - coefficients, and their gradients of moving walls, from pixels of
 * one plane.
 *
 * Functions are integrated by Gauss: over a pixel, over what is beyond an edge of the rim, and
 * along the borders.  Towards the horizon functions go as odd powers of the root of z, so what
 * reaches it is integrated in that root.  BORDER takes them at the pixel's middle, as published.
 *
 * Invariant: sums are in the order of cells, then edges of the rim; of borders by number. */
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "gather/hemisphere_plane.h"
#include "math/quadrature.h"

/* Nodes a side of a pixel and along an edge; towards the horizon; all of one batch at most. */
enum { SIDE = 2, RISE = 10, BATCH = SIDE * RISE };

typedef struct {
    const hemisphere_plane *plane;
    const assay_basis      *basis;
    size_t                  count;
    double                  side[SIDE], side_weight[SIDE]; /* of [0, 1] */
    double                  rise[RISE], rise_weight[RISE];
    double                 *values; /* BATCH rows of count */
    double                 *sum;    /* count               */
} plane_projection;

static assay_status open_projection(plane_projection *p, assay_context *context,
                                    const assay_hemisphere *h, const assay_basis *basis)
{
    *p = (plane_projection){.plane = h->plane, .basis = basis, .count = assay_basis_count(basis)};
    assay_gauss_legendre_on(0.0, 1.0, SIDE, p->side, p->side_weight);
    assay_gauss_legendre_on(0.0, 1.0, RISE, p->rise, p->rise_weight);
    p->values = assay_allocate(context, BATCH * p->count, sizeof *p->values);
    p->sum    = assay_allocate(context, p->count, sizeof *p->sum);
    return p->values && p->sum ? ASSAY_OK : assay_fail_memory(context, "a projection");
}

static void close_projection(plane_projection *p, assay_context *context)
{
    assay_release(context, p->values);
    assay_release(context, p->sum);
}

/* sum = the functions at the directions, weighted. */
static assay_status weigh(plane_projection *p, size_t n, const assay_vec3 *directions,
                          const double *weights)
{
    const assay_status status = assay_basis_evaluate_many(p->basis, n, directions, p->values);
    for (size_t i = 0; i < p->count; i++) {
        p->sum[i] = 0.0;
    }
    for (size_t k = 0; k < n && status == ASSAY_OK; k++) {
        const double *row = p->values + k * p->count;
        for (size_t i = 0; i < p->count; i++) {
            p->sum[i] += weights[k] * row[i];
        }
    }
    return status;
}

/* ---- over cells ---- */

static assay_status over_pixel(plane_projection *p, size_t cell)
{
    const hemisphere_plane *plane = p->plane;
    const size_t            i = cell % (size_t)plane->columns, j = cell / (size_t)plane->columns;
    const double            width  = plane->x[i + 1] - plane->x[i];
    const double            height = plane->y[j + 1] - plane->y[j];
    assay_vec3              directions[SIDE * SIDE];
    double                  weights[SIDE * SIDE];
    if (plane->missing == ASSAY_MISSING_BORDER) {
        directions[0] =
            vec3_normalize(vec3(plane->x[i] + 0.5 * width, plane->y[j] + 0.5 * height, 1.0));
        weights[0] = plane->cell[cell].solid;
        return weigh(p, 1, directions, weights);
    }
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int        a = k % SIDE, b = k / SIDE;
        const assay_vec3 at =
            vec3(plane->x[i] + p->side[a] * width, plane->y[j] + p->side[b] * height, 1.0);
        const double d = vec3_length(at);
        directions[k]  = vec3_scale(at, 1.0 / d);
        weights[k] = plane->raise_solid * width * height * p->side_weight[a] * p->side_weight[b] /
                     (d * d * d);
    }
    return weigh(p, SIDE * SIDE, directions, weights);
}

/* Beyond edge s of the rim: dw = dz d phi, z = s^2 up to the edge. */
static assay_status over_beyond(plane_projection *p, const plane_rim *rim)
{
    const double half = p->plane->half, length = rim->to - rim->from;
    assay_vec3   directions[BATCH];
    double       weights[BATCH];
    for (int k = 0; k < BATCH; k++) {
        const int    a = k % SIDE, b = k / SIDE;
        const double t = rim->from + p->side[a] * length, squared = half * half + t * t;
        const double azimuth = p->side_weight[a] * length * half / squared;
        const double root    = sqrt(sqrt(1.0 / (1.0 + squared))); /* of z at the edge */
        const double s = p->rise[b] * root, z = s * s;
        const double out = sqrt((1.0 - z) * (1.0 + z) / squared);
        directions[k]    = hemisphere_plane_turn(vec3(out * half, out * t, z), rim->side);
        weights[k]       = azimuth * 2.0 * s * root * p->rise_weight[b];
    }
    return weigh(p, BATCH, directions, weights);
}

static void add_radiance(const plane_projection *p, assay_rgb radiance, double *sums)
{
    for (size_t i = 0; i < p->count; i++) {
        sums[i] += radiance.r * p->sum[i];
        sums[p->count + i] += radiance.g * p->sum[i];
        sums[2 * p->count + i] += radiance.b * p->sum[i];
    }
}

assay_status hemisphere_plane_project(const assay_hemisphere *h, assay_context *context,
                                      const assay_basis *basis, double *sums)
{
    const hemisphere_plane *plane = h->plane;
    const size_t            cells = (size_t)plane->columns * (size_t)plane->rows;
    const int               edges =
        plane->missing == ASSAY_MISSING_BORDER_CORRECTED ? 2 * (plane->columns + plane->rows) : 0;
    plane_projection p;
    assay_status     status = open_projection(&p, context, h, basis);
    for (size_t i = 0; i < cells && status == ASSAY_OK; i++) {
        if (!rgb_is_black(h->cells[i].radiance)) {
            status = over_pixel(&p, i);
            add_radiance(&p, h->cells[i].radiance, sums);
        }
    }
    for (int s = 0; s < edges && status == ASSAY_OK; s++) {
        const plane_rim rim = hemisphere_plane_rim(plane, s);
        status              = over_beyond(&p, &rim);
        add_radiance(&p, h->cells[rim.cell].radiance, sums);
    }
    close_projection(&p, context);
    return status;
}

/* ---- along borders ---- */

/* A meridian is walked in the root of its elevation. */
static assay_status along(plane_projection *p, const plane_arc *arc)
{
    assay_vec3   directions[RISE];
    double       weights[RISE];
    const int    nodes  = arc->meridian ? RISE : SIDE;
    const double length = arc->to - arc->from;
    for (int k = 0; k < nodes; k++) {
        const double node = arc->meridian ? p->rise[k] * p->rise[k] : p->side[k];
        const double weight =
            arc->meridian ? 2.0 * p->rise[k] * p->rise_weight[k] : p->side_weight[k];
        const assay_sincos at = assay_sincos_radians(arc->from + node * length);
        directions[k]         = vec3_mad(vec3_scale(arc->u, at.cos), at.sin, arc->v);
        weights[k]            = weight * length;
    }
    return weigh(p, (size_t)nodes, directions, weights);
}

static void add_step(const plane_projection *p, assay_rgb step, assay_vec3 across, assay_vec3 *sums)
{
    const double channel[3] = {step.r, step.g, step.b};
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 0; i < p->count; i++) {
            sums[c * p->count + i] =
                vec3_mad(sums[c * p->count + i], channel[c] * p->sum[i], across);
        }
    }
}

assay_status hemisphere_plane_project_gradient(const assay_hemisphere *h, assay_context *context,
                                               const assay_basis *basis, assay_vec3 *sums)
{
    plane_projection p;
    assay_status     status = open_projection(&p, context, h, basis);
    for (size_t i = 0; i < h->plane->wall_count && status == ASSAY_OK; i++) {
        const plane_wall *wall = &h->plane->wall[i];
        const assay_cell *a = &h->cells[wall->a], *b = &h->cells[wall->b];
        const double      speed = 1.0 / (a->distance < b->distance ? a->distance : b->distance);
        const assay_rgb   step =
            rgb_scale(rgb_sub(b->radiance, a->radiance), speed * h->plane->raise_solid);
        if (!rgb_is_black(step)) {
            const plane_arc arc = hemisphere_plane_arc(h->plane, i);
            status              = along(&p, &arc);
            add_step(&p, step, arc.across, sums);
        }
    }
    close_projection(&p, context);
    return status;
}
