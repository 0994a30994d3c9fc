/* raster_triangle.h - one triangle and one pixel: the rule that every sample rests on. */
#ifndef ASSAY_GATHER_RASTER_TRIANGLE_H
#define ASSAY_GATHER_RASTER_TRIANGLE_H

#include "gather/raster.h"

/* A corner in the view's frame; (x, y, w) is its homogeneous place on the plane: w = z in
 * perspective, 1 in parallel. */
typedef struct {
    double x, y, z, w;
} raster_corner;

typedef struct {
    raster_corner corner[3];
    double        tolerance; /* m: by how much the point of the weights may miss the ray */
    uint32_t      triangle;
} raster_triangle;

void raster_triangle_load(const assay_scene *scene, const assay_raster_view *view,
                          uint32_t triangle, raster_triangle *out);

/* What a covered pixel has: its depth, and the weights of the second and the third corner in space,
 * which are not those on the screen. */
typedef struct {
    double depth, u, v;
} raster_fragment;

/* Edge functions at a pixel, opposite to each corner: twice the signed areas that the sheared
 * corners span with the pixel's ray. */
typedef struct {
    double a, b, c;
} raster_areas;

/* The areas again with products that do not round, where their plain ones are noise. */
raster_areas raster_areas_refine(const double x[3], const double y[3]);

/* The signs of a closed triangle: none below zero, or none above. */
static inline bool raster_areas_enclose(raster_areas e)
{
    return (e.a >= 0.0 && e.b >= 0.0 && e.c >= 0.0) || (e.a <= 0.0 && e.b <= 0.0 && e.c <= 0.0);
}

/* Whether the point that the areas stand for is on the ray; false where they are all zero. */
static inline bool raster_areas_agree(raster_areas e, double tolerance, const double x[3],
                                      const double y[3])
{
    const double limit = tolerance * fabs(e.a + e.b + e.c);
    return fabs(e.a * x[0] + e.b * x[1] + e.c * x[2]) < limit &&
           fabs(e.a * y[0] + e.b * y[1] + e.c * y[2]) < limit;
}

/* Whether the triangle covers the point, and how deep. */
static inline bool raster_triangle_covers(const raster_triangle *t, assay_raster_point at,
                                          raster_fragment *out)
{
    const raster_corner *p = t->corner;
    const double x[3] = {p[0].x - at.x * p[0].w, p[1].x - at.x * p[1].w, p[2].x - at.x * p[2].w};
    const double y[3] = {p[0].y - at.y * p[0].w, p[1].y - at.y * p[1].w, p[2].y - at.y * p[2].w};
    raster_areas e    = {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2],
                         x[1] * y[0] - y[1] * x[0]};
    if (!raster_areas_enclose(e)) {
        return false;
    }
    if (!raster_areas_agree(e, t->tolerance, x, y)) {
        e = raster_areas_refine(x, y);
        if (!raster_areas_enclose(e) || !raster_areas_agree(e, t->tolerance, x, y)) {
            return false;
        }
    }
    const double sum = e.a + e.b + e.c;
    *out =
        (raster_fragment){(e.a * p[0].z + e.b * p[1].z + e.c * p[2].z) / sum, e.b / sum, e.c / sum};
    return true;
}

#endif
