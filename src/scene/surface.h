/* surface.h - everything about the point where a ray meets a triangle.
 *
 * No call allocates; all are thread-safe and cost no look-up where a material has no texture. */
#ifndef ASSAY_SCENE_SURFACE_H
#define ASSAY_SCENE_SURFACE_H

#include "math/frame.h"
#include "scene/scene_data.h"

/* Geometry at a hit. */
typedef struct {
    uint32_t     triangle, shape, material;
    double       u, v;     /* barycentric, of the triangle's second and third vertex              */
    assay_vec3   position; /* m, world                                                            */
    assay_vec3   ng;       /* unit geometric normal of the front side (counter-clockwise winding) */
    assay_vec3   ns;       /* unit shading normal: interpolated and normal-mapped; ng . ns > 0    */
    assay_frame3 frame;    /* z = ns; x along the tangent where the material is anisotropic or
                              normal-mapped and has one, else any                                */
    double uv[2][2];       /* texture coordinates of both sets, 0 without                         */
    double color[4];       /* COLOR_0, 1 1 1 1 without                                            */
} assay_surface;

/* u, v: barycentrics as in assay_hit. */
void assay_surface_at(const assay_scene *scene, uint32_t triangle, double u, double v,
                      assay_surface *surface_out);

/* A cheaper look: geometric normal (unit; +Z for a triangle without area) and area (m2). */
void assay_triangle_geometry(const assay_scene *scene, uint32_t triangle, assay_vec3 *ng_out,
                             double *area_out);

/* Sends for the texels of the base colour, which are mostly far away in memory. */
void assay_surface_prefetch(const assay_scene *scene, const assay_surface *surface);

/* Base colour (factor * texture * COLOR_0), linear, clamped to [0, 1]; coverage after the
 * material's alpha mode: 1 where opaque, 0 or 1 for MASK, [0, 1] for BLEND.  Of
 * ASSAY_MATERIAL_LAMBERT the coverage is 1, whatever the alpha. */
void assay_surface_base_color(const assay_scene *scene, const assay_surface *surface,
                              assay_rgb *color_out, double *coverage_out);

/* Coverage alone, straight from a hit: what a shadow ray asks.  1 for an opaque material without
 * any look-up. */
double assay_triangle_coverage(const assay_scene *scene, uint32_t triangle, double u, double v);

/* Radiance that leaves the surface by itself towards a direction on the front side (front = true)
 * or the back: 0 behind a one-sided emitter (emission_two_sided decides; double_sided for unlit).
 * W/(m2 sr).  Unlit materials emit their base colour, and nothing else. */
assay_rgb assay_surface_emission(const assay_scene *scene, const assay_surface *surface,
                                 bool front);

/* Whether a material lights others: an emissive factor that is not black.  Unlit materials do not.
 */
bool assay_material_emits(const assay_material *material);

/* Whether a material's frame must follow tangents: a normal map, or an anisotropic lobe. */
bool assay_material_wants_tangent(const assay_material *material);

/* A material's values at a point, all textures looked up; each in [0, 1]. */
typedef struct {
    assay_rgb base_color;
    double    coverage; /* as assay_surface_base_color gives it                                   */
    double    metallic, roughness;
    double    transmission;
    double    specular_factor;
    assay_rgb specular_color; /* factor * texture; may exceed 1, as KHR_materials_specular allows */
} assay_surface_material;

void assay_surface_material_at(const assay_scene *scene, const assay_surface *surface,
                               assay_surface_material *material_out);

#endif
