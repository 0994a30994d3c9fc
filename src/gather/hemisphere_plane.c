/* hemisphere_plane.c - what pixels of one plane weigh, and irradiance from them.
 *
 * All of a pixel's borders are parts of great circles, also those to the horizon, so its solid
 * angle, its integral of w and its borders' integrals have closed forms; only BORDER is as
 * published, from centres and middles.
 *
 * Invariant: with BORDER_CORRECTED the cells are the hemisphere: solid angles sum to 2 pi, fluxes
 * to (0, 0, pi), both to rounding. */
#include "gather/hemisphere_plane.h"

#include <assert.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"

/* ---- places ---- */

assay_vec3 hemisphere_plane_direction(const assay_hemisphere_layout *layout, int j, int k,
                                      double u1, double u2)
{
    const double half = assay_tan(0.5 * layout->fov);
    return vec3_normalize(vec3(half * ((2.0 * (k + u2) - layout->phi) / layout->phi),
                               half * ((2.0 * (j + u1) - layout->theta) / layout->theta), 1.0));
}

plane_rim hemisphere_plane_rim(const hemisphere_plane *plane, int s)
{
    const int     w = plane->columns, h = plane->rows;
    const double *x = plane->x, *y = plane->y;
    if (s < h) {
        return (plane_rim){(size_t)s * (size_t)w + (size_t)(w - 1), 0, y[s], y[s + 1]};
    }
    if (s < h + w) {
        const int i = h + w - 1 - s;
        return (plane_rim){(size_t)(h - 1) * (size_t)w + (size_t)i, 1, -x[i + 1], -x[i]};
    }
    if (s < h + w + h) {
        const int j = h + w + h - 1 - s;
        return (plane_rim){(size_t)j * (size_t)w, 2, -y[j + 1], -y[j]};
    }
    const int i = s - (h + w + h);
    return (plane_rim){(size_t)i, 3, x[i], x[i + 1]};
}

assay_vec3 hemisphere_plane_turn(assay_vec3 v, int side)
{
    switch (side) {
    case 1: return vec3(-v.y, v.x, v.z);
    case 2: return vec3(-v.x, -v.y, v.z);
    case 3: return vec3(v.y, -v.x, v.z);
    default: return v;
    }
}

/* ---- weights ---- */

/* Solid angle and integral of w of the quadrant's rectangle with the corner (x, y), but for terms
 * that four corners cancel. */
static plane_cell corner_of(double x, double y)
{
    const double r = sqrt(1.0 + x * x), s = sqrt(1.0 + y * y);
    const double a = assay_atan(y / r) / r, b = assay_atan(x / s) / s;
    return (plane_cell){assay_atan(x * y / sqrt(1.0 + x * x + y * y)),
                        vec3(-0.5 * a, -0.5 * b, 0.5 * (x * a + y * b))};
}

static void add_cell(plane_cell *sum, double sign, plane_cell c)
{
    sum->solid += sign * c.solid;
    sum->flux = vec3_mad(sum->flux, sign, c.flux);
}

static plane_cell pixel_exact(const hemisphere_plane *plane, int i, int j)
{
    plane_cell sum = {0};
    add_cell(&sum, 1.0, corner_of(plane->x[i + 1], plane->y[j + 1]));
    add_cell(&sum, -1.0, corner_of(plane->x[i], plane->y[j + 1]));
    add_cell(&sum, -1.0, corner_of(plane->x[i + 1], plane->y[j]));
    add_cell(&sum, 1.0, corner_of(plane->x[i], plane->y[j]));
    return sum;
}

/* A cos theta / d^2 of the pixel's middle [class08]. */
static double pixel_published(const hemisphere_plane *plane, int i, int j)
{
    const double x = 0.5 * (plane->x[i] + plane->x[i + 1]);
    const double y = 0.5 * (plane->y[j] + plane->y[j + 1]);
    const double d = sqrt(1.0 + x * x + y * y);
    return (plane->x[i + 1] - plane->x[i]) * (plane->y[j + 1] - plane->y[j]) / (d * d * d);
}

/* What is beyond the edge from (half, from) to (half, to), by Lambert's formula: half the sum of
 * the angles of its four borders times their circles' normals, inward. */
static plane_cell beyond_exact(double half, double from, double to)
{
    const double r  = sqrt(1.0 + half * half);
    const double p0 = sqrt(half * half + from * from), p1 = sqrt(half * half + to * to);
    const double azimuth = assay_atan(to / half) - assay_atan(from / half);
    const double edge    = assay_atan(to / r) - assay_atan(from / r);
    const double e0 = assay_atan(1.0 / p0), e1 = assay_atan(1.0 / p1); /* elevations */
    const double solid = assay_atan(to / (half * sqrt(r * r + to * to))) -
                         assay_atan(from / (half * sqrt(r * r + from * from)));
    const assay_vec3 flux = vec3(edge / r - e0 * (from / p0) + e1 * (to / p1),
                                 e0 * (half / p0) - e1 * (half / p1), azimuth - edge * half / r);
    return (plane_cell){solid, vec3_scale(flux, 0.5)};
}

/* cos theta_b times the azimuth that the edge subtends, theta_b at its middle [class08]. */
static double beyond_published(double half, double from, double to)
{
    const double middle = 0.5 * (from + to);
    return (assay_atan(to / half) - assay_atan(from / half)) /
           sqrt(1.0 + half * half + middle * middle);
}

static void weigh_pixels(hemisphere_plane *plane)
{
    const bool  published = plane->missing == ASSAY_MISSING_BORDER;
    plane_cell *cell      = plane->cell;
    for (int j = 0; j < plane->rows; j++) {
        for (int i = 0; i < plane->columns; i++, cell++) {
            if (published) {
                cell->solid = pixel_published(plane, i, j);
            } else {
                *cell = pixel_exact(plane, i, j);
            }
        }
    }
}

static void weigh_rim(hemisphere_plane *plane)
{
    for (int s = 0; s < 2 * (plane->columns + plane->rows); s++) {
        const plane_rim rim  = hemisphere_plane_rim(plane, s);
        plane_cell     *cell = &plane->cell[rim.cell];
        if (plane->missing == ASSAY_MISSING_BORDER) {
            cell->solid += beyond_published(plane->half, rim.from, rim.to);
        } else if (plane->missing == ASSAY_MISSING_BORDER_CORRECTED) {
            plane_cell beyond = beyond_exact(plane->half, rim.from, rim.to);
            beyond.flux       = hemisphere_plane_turn(beyond.flux, rim.side);
            add_cell(cell, 1.0, beyond);
        }
    }
}

/* BORDER: all of a cell's solid angle is where the pixel's middle is. */
static void weigh_directions(hemisphere_plane *plane)
{
    plane_cell *cell = plane->cell;
    for (int j = 0; j < plane->rows; j++) {
        for (int i = 0; i < plane->columns; i++, cell++) {
            const assay_vec3 middle = vec3(0.5 * (plane->x[i] + plane->x[i + 1]),
                                           0.5 * (plane->y[j] + plane->y[j + 1]), 1.0);
            cell->flux              = vec3_scale(vec3_normalize(middle), cell->solid);
        }
    }
}

/* RATIO: by what a furnace lacks. */
static void raise(hemisphere_plane *plane)
{
    const size_t count = (size_t)plane->columns * (size_t)plane->rows;
    plane_cell   sum   = {0};
    for (size_t i = 0; i < count; i++) {
        add_cell(&sum, 1.0, plane->cell[i]);
    }
    plane->raise_flux  = ASSAY_PI / sum.flux.z;
    plane->raise_solid = ASSAY_TWO_PI / sum.solid;
    for (size_t i = 0; i < count; i++) {
        plane->cell[i].solid *= plane->raise_solid;
        plane->cell[i].flux = vec3_scale(plane->cell[i].flux, plane->raise_flux);
    }
}

/* ---- borders ---- */

/* Between pixels: on x = at, from y = from to y = to, in a frame turned by `side`. */
static plane_arc inner_arc(double at, double from, double to, int side)
{
    const double r = sqrt(1.0 + at * at);
    return (plane_arc){.across = hemisphere_plane_turn(vec3(1.0 / r, 0.0, -at / r), side),
                       .u      = hemisphere_plane_turn(vec3(at / r, 0.0, 1.0 / r), side),
                       .v      = hemisphere_plane_turn(vec3(0.0, 1.0, 0.0), side),
                       .from   = assay_atan(from / r),
                       .to     = assay_atan(to / r)};
}

/* Beyond the plane: from the horizon up to where edge s of the rim begins. */
static plane_arc rim_arc(const hemisphere_plane *plane, int s)
{
    const int       count = 2 * (plane->columns + plane->rows);
    const plane_rim rim   = hemisphere_plane_rim(plane, s);
    const double    p     = sqrt(plane->half * plane->half + rim.from * rim.from);
    const double    c = plane->half / p, sine = rim.from / p;
    return (plane_arc){.a        = hemisphere_plane_rim(plane, s == 0 ? count - 1 : s - 1).cell,
                       .b        = rim.cell,
                       .across   = hemisphere_plane_turn(vec3(-sine, c, 0.0), rim.side),
                       .u        = hemisphere_plane_turn(vec3(c, sine, 0.0), rim.side),
                       .v        = vec3(0.0, 0.0, 1.0),
                       .from     = 0.0,
                       .to       = assay_atan(1.0 / p),
                       .meridian = true};
}

plane_arc hemisphere_plane_arc(const hemisphere_plane *plane, size_t i)
{
    const size_t w = (size_t)plane->columns, upright = (w - 1) * (size_t)plane->rows;
    plane_arc    arc;
    assert(w >= 2);
    if (i >= plane->inner_count) {
        return rim_arc(plane, (int)(i - plane->inner_count));
    }
    if (i < upright) {
        const size_t row = i / (w - 1), column = i % (w - 1) + 1;
        arc   = inner_arc(plane->x[column], plane->y[row], plane->y[row + 1], 0);
        arc.b = row * w + column;
        arc.a = arc.b - 1;
        return arc;
    }
    const size_t row = (i - upright) / w + 1, column = (i - upright) % w;
    arc   = inner_arc(plane->y[row], -plane->x[column + 1], -plane->x[column], 1);
    arc.b = row * w + column;
    arc.a = arc.b - w;
    return arc;
}

static void build_walls(hemisphere_plane *plane)
{
    for (size_t i = 0; i < plane->wall_count; i++) {
        const plane_arc arc    = hemisphere_plane_arc(plane, i);
        const double    cosine = arc.u.z * (assay_sin(arc.to) - assay_sin(arc.from)) -
                              arc.v.z * (assay_cos(arc.to) - assay_cos(arc.from));
        plane->wall[i] =
            (plane_wall){arc.a, arc.b, vec3_scale(arc.across, plane->raise_flux * cosine)};
    }
}

/* ---- making ---- */

static bool allocate(assay_context *context, hemisphere_plane *plane)
{
    const size_t w = (size_t)plane->columns, h = (size_t)plane->rows;
    const bool   extended =
        plane->missing == ASSAY_MISSING_BORDER || plane->missing == ASSAY_MISSING_BORDER_CORRECTED;
    plane->inner_count = (w - 1) * h + w * (h - 1);
    plane->wall_count  = plane->inner_count + (extended ? 2 * (w + h) : 0);
    plane->x           = assay_allocate(context, w + 1, sizeof *plane->x);
    plane->y           = assay_allocate(context, h + 1, sizeof *plane->y);
    plane->cell        = assay_allocate(context, w * h, sizeof *plane->cell);
    plane->wall        = assay_allocate(context, plane->wall_count, sizeof *plane->wall);
    plane->seen        = assay_allocate(context, w * h, sizeof *plane->seen);
    return plane->x && plane->y && plane->cell && plane->wall && plane->seen;
}

static void fill(hemisphere_plane *plane)
{
    for (int i = 0; i <= plane->columns; i++) {
        plane->x[i] = plane->half * ((2 * i - plane->columns) / (double)plane->columns);
    }
    for (int j = 0; j <= plane->rows; j++) {
        plane->y[j] = plane->half * ((2 * j - plane->rows) / (double)plane->rows);
    }
    weigh_pixels(plane);
    weigh_rim(plane);
    if (plane->missing == ASSAY_MISSING_BORDER) {
        weigh_directions(plane);
    }
    if (plane->missing == ASSAY_MISSING_RATIO) {
        raise(plane);
    }
    build_walls(plane);
}

assay_status hemisphere_plane_create(assay_context *context, const assay_hemisphere_layout *layout,
                                     hemisphere_plane **plane_out)
{
    if (!(layout->fov >= ASSAY_FOV_MIN && layout->fov <= ASSAY_FOV_MAX)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "a hemisphere on a plane with a field of view of %g rad: %g ... %g",
                          layout->fov, ASSAY_FOV_MIN, ASSAY_FOV_MAX);
    }
    if ((int)layout->missing < 0 || layout->missing > ASSAY_MISSING_BORDER_CORRECTED) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "unknown way of dealing with missing directions");
    }
    hemisphere_plane *plane = assay_allocate(context, 1, sizeof *plane);
    if (!plane) {
        return assay_fail_memory(context, "a hemisphere");
    }
    *plane = (hemisphere_plane){.half        = assay_tan(0.5 * layout->fov),
                                .columns     = layout->phi,
                                .rows        = layout->theta,
                                .missing     = layout->missing,
                                .raise_flux  = 1.0,
                                .raise_solid = 1.0};
    if (!allocate(context, plane)) {
        hemisphere_plane_destroy(context, plane);
        return assay_fail_memory(context, "a hemisphere");
    }
    fill(plane);
    *plane_out = plane;
    return ASSAY_OK;
}

void hemisphere_plane_destroy(assay_context *context, hemisphere_plane *plane)
{
    if (plane) {
        assay_release(context, plane->x);
        assay_release(context, plane->y);
        assay_release(context, plane->cell);
        assay_release(context, plane->wall);
        assay_release(context, plane->seen);
        assay_release(context, plane);
    }
}
