/* raster_bounds.c - Invariant: what is left out holds no pixel's centre; rounding only keeps more.
 */
#include "gather/raster_bounds.h"

#include "core/numerics.h"

/* A pixel's breadth that bounds are widened by, above the rounding of w >= 2^-30 of the largest
 * coordinate. */
static const double MARGIN = 0.0625, NEAR_EYE = 0x1p-30;

/* What is above this part of its terms is not made by their rounding. */
static const double SURE = 0x1p-30;

/* fmin and fmax are calls, as they must see to NaN. */
static inline double least(double a, double b) { return a < b ? a : b; }
static inline double most(double a, double b) { return a > b ? a : b; }

/* Whole numbers from low to high, within first ... last. */
static pixel_range clamp_range(double low, double high, pixel_range all)
{
    return (pixel_range){
        low > all.first ? (low < all.last   ? (int)-assay_floor(-low)
                           : low > all.last ? all.last + 1
                                            : all.last)
                        : all.first,
        high < all.last ? (high < all.first ? all.first - 1 : (int)assay_floor(high)) : all.last};
}

/* From places on the plane. */
static pixel_range columns_between(const raster_band *band, double low, double high)
{
    const assay_raster_view *view   = band->view;
    const double             scale  = 0.5 * view->columns / view->half;
    const double             middle = 0.5 * view->columns - 0.5;
    return clamp_range(low * scale + (middle - MARGIN), high * scale + (middle + MARGIN),
                       (pixel_range){0, view->columns - 1});
}

static pixel_range rows_between(const raster_band *band, double low, double high)
{
    const assay_raster_view *view   = band->view;
    const double             scale  = 0.5 * view->rows / view->half;
    const double             middle = 0.5 * view->rows - 0.5;
    return clamp_range(low * scale + (middle - MARGIN), high * scale + (middle + MARGIN),
                       band->rows);
}

static double largest_of(assay_vec3 v) { return most(fabs(v.x), most(fabs(v.y), fabs(v.z))); }

raster_band raster_band_of(const assay_scene *scene, const assay_raster_view *view,
                           pixel_range rows)
{
    const double step = 2.0 * view->half / view->rows;
    raster_band  band = {
         .view   = view,
         .rows   = rows,
         .low_y  = rows.first * step - view->half,
         .high_y = (rows.last + 1) * step - view->half,
         .slack  = 0x1p-44 * (most(largest_of(scene->bounds_min), largest_of(scene->bounds_max)) +
                            largest_of(view->eye))};
    return band;
}

/* ---- triangles ---- */

bool raster_band_misses(const raster_band *band, const raster_triangle *t)
{
    const raster_corner *p    = t->corner;
    const double         half = band->view->half, low = band->low_y, high = band->high_y;
    return (p[0].x < -half * p[0].w && p[1].x < -half * p[1].w && p[2].x < -half * p[2].w) ||
           (p[0].x > half * p[0].w && p[1].x > half * p[1].w && p[2].x > half * p[2].w) ||
           (p[0].y < low * p[0].w && p[1].y < low * p[1].w && p[2].y < low * p[2].w) ||
           (p[0].y > high * p[0].w && p[1].y > high * p[1].w && p[2].y > high * p[2].w) ||
           (p[0].w <= 0.0 && p[1].w <= 0.0 && p[2].w <= 0.0);
}

bool raster_band_bound(const raster_band *band, const raster_triangle *t, pixel_range *columns_out,
                       pixel_range *rows_out)
{
    const raster_corner *p       = t->corner;
    const double         nearest = least(p[0].w, least(p[1].w, p[2].w));
    double               x[3], y[3], largest = 0.0;
    for (int i = 0; i < 3; i++) {
        largest = most(largest, most(fabs(p[i].x), most(fabs(p[i].y), fabs(p[i].w))));
    }
    if (!(nearest > NEAR_EYE * largest)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        const double scale = 1.0 / p[i].w;
        x[i]               = p[i].x * scale;
        y[i]               = p[i].y * scale;
    }
    *columns_out =
        columns_between(band, least(x[0], least(x[1], x[2])), most(x[0], most(x[1], x[2])));
    *rows_out = rows_between(band, least(y[0], least(y[1], y[2])), most(y[0], most(y[1], y[2])));
    return true;
}

/* The sign is that of the triangle's volume with the eye, unless rounding could have made it. */
raster_crossing raster_crossing_of(const raster_triangle *t)
{
    raster_crossing c;
    for (int i = 0; i < 3; i++) {
        const raster_corner *p = &t->corner[(i + 1) % 3], *q = &t->corner[(i + 2) % 3];
        c.edge[i] = (edge_plane){p->w * q->y - p->y * q->w, p->x * q->w - p->w * q->x,
                                 p->y * q->x - p->x * q->y};
    }
    const raster_corner *p = &t->corner[0];
    const double         x = p->x * c.edge[0].x, y = p->y * c.edge[0].y, w = p->w * c.edge[0].c;
    const double         volume = x + y + w, size = fabs(x) + fabs(y) + fabs(w);
    c.sign = fabs(volume) > SURE * size ? copysign(1.0, volume) : 0.0;
    return c;
}

/* An edge that the row runs along, as far as rounding tells, leaves all columns. */
pixel_range raster_crossing_span(const raster_crossing *c, const assay_raster_view *view, double y)
{
    double low = -view->half, high = view->half;
    for (int i = 0; i < 3 && c->sign != 0.0; i++) {
        const edge_plane *e = &c->edge[i];
        if (fabs(e->x) * view->half > SURE * (fabs(e->y * y) + fabs(e->c))) {
            const double at = -(e->y * y + e->c) / e->x;
            low             = c->sign * e->x > 0.0 ? most(low, at) : low;
            high            = c->sign * e->x > 0.0 ? high : least(high, at);
        }
    }
    const double scale = 0.5 * view->columns;
    return clamp_range((low / view->half + 1.0) * scale - 1.5,
                       (high / view->half + 1.0) * scale + 0.5,
                       (pixel_range){0, view->columns - 1});
}

/* ---- boxes ---- */

/* Middles, from the eye, and half sizes, m. */
typedef struct {
    double x[ASSAY_BVH_BOXES], y[ASSAY_BVH_BOXES], z[ASSAY_BVH_BOXES];
    double wide[ASSAY_BVH_BOXES], high[ASSAY_BVH_BOXES], deep[ASSAY_BVH_BOXES];
} box_lanes;

/* The range of n . (p - eye) over each box. */
static inline void extend(const box_lanes *b, assay_vec3 n, double *low, double *high)
{
    const double wx = fabs(n.x), wy = fabs(n.y), wz = fabs(n.z);
    for (int i = 0; i < ASSAY_BVH_BOXES; i++) {
        const double middle = n.x * b->x[i] + n.y * b->y[i] + n.z * b->z[i];
        const double reach  = wx * b->wide[i] + wy * b->high[i] + wz * b->deep[i];
        low[i]              = middle - reach;
        high[i]             = middle + reach;
    }
}

/* Where a box lies on the plane, between the depths near and far > 0. */
static void bound_box(const raster_band *band, raster_box *box, double near, double far,
                      const double x[2], const double y[2])
{
    const double over_near = 1.0 / near, over_far = 1.0 / far;
    box->bounded = true;
    box->columns = columns_between(band, x[0] * (x[0] < 0.0 ? over_near : over_far),
                                   x[1] * (x[1] > 0.0 ? over_near : over_far));
    box->rows    = rows_between(band, y[0] * (y[0] < 0.0 ? over_near : over_far),
                                y[1] * (y[1] > 0.0 ? over_near : over_far));
    if (box->columns.first > box->columns.last || box->rows.first > box->rows.last) {
        box->depth = INFINITY;
    }
}

void raster_band_boxes(const raster_band *band, const assay_bvh_planes planes,
                       raster_box boxes_out[ASSAY_BVH_BOXES])
{
    const assay_raster_view *view = band->view;
    const assay_vec3         eye  = view->eye;
    box_lanes                b;
    double                   x[2][ASSAY_BVH_BOXES], y[2][ASSAY_BVH_BOXES], z[2][ASSAY_BVH_BOXES];
    bool                     out[ASSAY_BVH_BOXES];
    for (int i = 0; i < ASSAY_BVH_BOXES; i++) {
        b.x[i]    = 0.5 * ((double)planes[0][i] + (double)planes[1][i]) - eye.x;
        b.y[i]    = 0.5 * ((double)planes[2][i] + (double)planes[3][i]) - eye.y;
        b.z[i]    = 0.5 * ((double)planes[4][i] + (double)planes[5][i]) - eye.z;
        b.wide[i] = 0.5 * ((double)planes[1][i] - (double)planes[0][i]);
        b.high[i] = 0.5 * ((double)planes[3][i] - (double)planes[2][i]);
        b.deep[i] = 0.5 * ((double)planes[5][i] - (double)planes[4][i]);
    }
    extend(&b, view->frame.z, z[0], z[1]);
    for (int i = 0; i < ASSAY_BVH_BOXES; i++) {
        /* An absent box is nowhere: NaN. */
        out[i] = !(z[1][i] + band->slack > view->near);
    }
    extend(&b, view->frame.x, x[0], x[1]);
    extend(&b, view->frame.y, y[0], y[1]);
    for (int i = 0; i < ASSAY_BVH_BOXES; i++) {
        raster_box *box   = &boxes_out[i];
        *box              = (raster_box){.depth = out[i] ? INFINITY : z[0][i] - band->slack};
        const double far  = view->parallel ? 1.0 : z[1][i];
        const double near = view->parallel ? 1.0 : z[0][i];
        const double largest =
            most(far, most(most(fabs(x[0][i]), fabs(x[1][i])), most(fabs(y[0][i]), fabs(y[1][i]))));
        if (!out[i] && near > NEAR_EYE * largest) {
            bound_box(band, box, near, far, (const double[2]){x[0][i], x[1][i]},
                      (const double[2]){y[0][i], y[1][i]});
        }
    }
}
