/* splat_bounds.c - tangents from the eye, axis by axis.
 *
 * Invariant: what is left out cannot be seen.  Points of the sphere in front of the camera, seen
 * from above, fill the disc of radius r about (X, Z); x / z of them is all that their column
 * depends on.  So the columns of a sphere are those between the two tangents from the origin to a
 * disc, and the same holds for rows, with (Y, Z): two problems in the plane, each solved exactly,
 * in place of an ellipse, parabola or hyperbola on the screen.
 *
 * A tangent is the direction (X, Z) turned by +-alpha, sin alpha = r / d: without any angle,
 *
 *     x / z = (X t -+ Z r) / (Z t +- X r),   t = sqrt(d^2 - r^2).
 *
 * Where the denominator is not positive the disc goes on beside the camera: the range is open.
 *
 * Rounding: the radius is made larger by 1e-11 of itself and 1e-12 of the distance.  A larger
 * radius turns a tangent by dr / t, which is 1e-12 d / t at least; rounding turns it by a few 1e-16
 * of that (the worst is t, whose error is some 1e-16 d^2 / t).  So the larger sphere, with its
 * rounding, holds the smaller without. */
#include "record/splat_bounds.h"

#include <math.h>

static const double SPARE_RADIUS = 1e-11, SPARE_DISTANCE = 1e-12;

/* pixels: of projecting a point, whose rounding is some 1e-16 of the image */
static const double SPARE_STRAY = 1e-9;

assay_splat_view assay_splat_view_of(const assay_camera *camera, int width, int height)
{
    const double     aspect = (double)width / (double)height;
    assay_splat_view view   = {.position     = camera->position,
                               .right        = camera->right,
                               .up           = camera->up,
                               .forward      = camera->forward,
                               .orthographic = camera->orthographic,
                               .half_height  = camera->tan_half_yfov,
                               .width        = width,
                               .height       = height};
    if (view.orthographic) {
        view.half_height = fmax(camera->ymag, camera->xmag / aspect);
    }
    view.half_width = view.half_height * aspect;
    return view;
}

/* Right, up, forward. */
static assay_vec3 to_camera(const assay_splat_view *view, assay_vec3 point)
{
    const assay_vec3 offset = vec3_sub(point, view->position);
    return vec3(vec3_dot(offset, view->right), vec3_dot(offset, view->up),
                vec3_dot(offset, view->forward));
}

/* From multiples of half the image, right and up, to pixels, right and down. */
static double column_of(const assay_splat_view *view, double s)
{
    return 0.5 * (1.0 + s / view->half_width) * view->width;
}

static double row_of(const assay_splat_view *view, double s)
{
    return 0.5 * (1.0 - s / view->half_height) * view->height;
}

double assay_splat_stray(const assay_splat_view *view, int x, int y, assay_vec3 point)
{
    const assay_vec3 p = to_camera(view, point);
    if (!vec3_finite(p) || !(view->orthographic ? p.z >= 0.0 : p.z > 0.0)) {
        return INFINITY;
    }
    const double depth = view->orthographic ? 1.0 : p.z;
    const double dx    = fabs(column_of(view, p.x / depth) - (x + 0.5));
    const double dy    = fabs(row_of(view, p.y / depth) - (y + 0.5));
    return dx > dy ? dx : dy;
}

typedef struct {
    double low, high;
} range;

/* Of a / z over the disc of radius r about (a, z), where z > 0. */
static range range_of(const assay_splat_view *view, double a, double z, double r)
{
    const double squared = a * a + z * z - r * r;
    if (view->orthographic) {
        return (range){a - r, a + r};
    }
    if (!(squared > 0.0)) {
        return (range){-INFINITY, INFINITY};
    }
    const double t   = sqrt(squared);
    const double low = z * t + a * r, high = z * t - a * r;
    return (range){low > 0.0 ? (a * t - z * r) / low : -INFINITY,
                   high > 0.0 ? (a * t + z * r) / high : INFINITY};
}

/* The first pixel of n whose centre is at `place` or beyond. */
static int first_pixel(double place, int n)
{
    const double pixel = ceil(place - 0.5);
    return pixel > 0.0 ? (pixel < n ? (int)pixel : n) : 0;
}

/* One beyond the last pixel of n whose centre is at `place` or before. */
static int end_pixel(double place, int n)
{
    const double pixel = floor(place - 0.5) + 1.0;
    return pixel < n ? (pixel > 0.0 ? (int)pixel : 0) : n;
}

assay_splat_box assay_splat_bounds(const assay_splat_view *view, assay_vec3 centre, double radius)
{
    const assay_splat_box all = {0, 0, view->width, view->height}, none = {0, 0, 0, 0};
    const assay_vec3      c        = to_camera(view, centre);
    const double          distance = fabs(c.x) + fabs(c.y) + fabs(c.z);
    const double          r = radius * (1.0 + SPARE_RADIUS) + SPARE_DISTANCE * (distance + radius);
    if (!vec3_finite(c) || !isfinite(r * r) || !isfinite(distance * distance) ||
        !isfinite(view->stray)) {
        return all;
    }
    if (c.z + r < 0.0) {
        return none;
    }
    const range  x = range_of(view, c.x, c.z, r), y = range_of(view, c.y, c.z, r);
    const double stray = view->stray + SPARE_STRAY;
    return (assay_splat_box){
        .x0 = first_pixel(column_of(view, x.low) - stray, view->width),
        .y0 = first_pixel(row_of(view, y.high) - stray, view->height),
        .x1 = end_pixel(column_of(view, x.high) + stray, view->width),
        .y1 = end_pixel(row_of(view, y.low) + stray, view->height),
    };
}

/* Corners are divided by the centre's depth, whatever its sign: behind the camera the square is
 * drawn where the sphere's mirror image would be. */
assay_splat_box assay_splat_billboard(const assay_splat_view *view, assay_vec3 centre,
                                      double radius)
{
    const assay_splat_box none   = {0, 0, 0, 0};
    const assay_vec3      c      = to_camera(view, centre);
    const double          depth  = view->orthographic ? 1.0 : c.z;
    const double          left   = column_of(view, (c.x - radius) / depth);
    const double          right  = column_of(view, (c.x + radius) / depth);
    const double          top    = row_of(view, (c.y + radius) / depth);
    const double          bottom = row_of(view, (c.y - radius) / depth);
    if (isnan(left) || isnan(right) || isnan(top) || isnan(bottom)) {
        return none;
    }
    return (assay_splat_box){
        .x0 = first_pixel(left < right ? left : right, view->width),
        .y0 = first_pixel(top < bottom ? top : bottom, view->height),
        .x1 = end_pixel(left < right ? right : left, view->width),
        .y1 = end_pixel(top < bottom ? bottom : top, view->height),
    };
}
