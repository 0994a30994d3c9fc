/* splat_bounds.h - the pixels at which a sphere of space may be seen.
 *
 * The box of [gautron06] algorithm 3 about the sphere I_k of a record, eq. 4.4.  Conservative for
 * every sphere, beside, around and behind the camera as well: a point inside the sphere that is
 * seen through a pixel has its pixel in the box, provided that no point strays further from the
 * centre of its pixel than the view's `stray`. */
#ifndef ASSAY_RECORD_SPLAT_BOUNDS_H
#define ASSAY_RECORD_SPLAT_BOUNDS_H

#include "scene/scene_data.h"

/* A camera and an image, as spheres are asked of them. */
typedef struct {
    assay_vec3 position, right, up, forward;
    bool       orthographic;
    double     half_width, half_height; /* of the image: tangents, or m if orthographic */
    int        width, height;           /* pixels                                       */
    double     stray; /* pixels, >= 0: how far points are off the centres of their pixels, along
                         the worse of both axes; INFINITY: anywhere, so boxes are the image */
} assay_splat_view;

/* With stray 0. */
assay_splat_view assay_splat_view_of(const assay_camera *camera, int width, int height);

/* How far a point is off the centre of pixel (x, y), pixels; INFINITY where it is nowhere in the
 * image plane (behind the camera, or not finite). */
double assay_splat_stray(const assay_splat_view *view, int x, int y, assay_vec3 point);

/* Pixels [x0, x1) x [y0, y1) of the image; empty where x0 >= x1 or y0 >= y1. */
typedef struct {
    int x0, y0, x1, y1;
} assay_splat_box;

static inline bool assay_splat_box_holds(const assay_splat_box *box, int x, int y)
{
    return x >= box->x0 && x < box->x1 && y >= box->y0 && y < box->y1;
}

/* The sphere's bounds: no pixel too few, and, but for the stray, one too many at most. */
assay_splat_box assay_splat_bounds(const assay_splat_view *view, assay_vec3 centre, double radius);

/* The square that [class08] draws instead, at the depth of the centre: it loses pixels wherever
 * perspective makes the sphere's outline larger than that, and all of them where the camera is in
 * the sphere. */
assay_splat_box assay_splat_billboard(const assay_splat_view *view, assay_vec3 centre,
                                      double radius);

#endif
