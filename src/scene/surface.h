/* surface.h - everything about the point where a ray meets a triangle. */
#ifndef ASSAY_SCENE_SURFACE_H
#define ASSAY_SCENE_SURFACE_H

#include "math/frame.h"
#include "scene/scene_data.h"

/* Geometry at a hit. */
typedef struct {
    uint32_t     triangle, shape, material;
    double       u, v;      /* barycentric, of the triangle's second and third vertex              */
    assay_vec3   position;  /* m, world                                                            */
    assay_vec3   ng;        /* unit geometric normal of the front side (counter-clockwise winding) */
    assay_vec3   ns;        /* unit shading normal: interpolated and normal-mapped; ng . ns > 0    */
    assay_frame3 frame;     /* z = ns, x along the tangent (for anisotropy)                        */
    double       uv[2][2];  /* texture coordinates of both sets, 0 without                         */
    double       color[4];  /* COLOR_0, 1 1 1 1 without                                            */
} assay_surface;

/* u, v: barycentrics as in assay_hit. */
void assay_surface_at(const assay_scene *scene, uint32_t triangle, double u, double v,
                      assay_surface *surface_out);

/* A cheaper look: geometric normal (unit) and area (m2) of a triangle. */
void assay_triangle_geometry(const assay_scene *scene, uint32_t triangle, assay_vec3 *ng_out,
                             double *area_out);

/* Base colour (factor * texture * COLOR_0), linear, a = coverage after the material's alpha mode:
 * 1 where opaque, 0 or 1 for MASK, [0, 1] for BLEND. */
void assay_surface_base_color(const assay_scene *scene, const assay_surface *surface,
                              assay_rgb *color_out, double *coverage_out);

/* Coverage alone, straight from a hit: what a shadow ray asks.  1 for an opaque material without
 * any look-up. */
double assay_triangle_coverage(const assay_scene *scene, uint32_t triangle, double u, double v);

/* Radiance that leaves the surface by itself towards a direction on the front side (front = true) or
 * the back: 0 behind a one-sided emitter.  W/(m2 sr). Unlit materials emit their base colour. */
assay_rgb assay_surface_emission(const assay_scene *scene, const assay_surface *surface, bool front);

/* Whether a triangle's material emits at all (factor not zero), unlit included only where
 * `unlit_too`. */
bool assay_material_emits(const assay_material *material);

#endif
