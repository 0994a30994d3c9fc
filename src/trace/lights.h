/* lights.h - everything that emits, and how to choose among it.
 *
 * One light is drawn with a probability proportional to its power: an emissive triangle, a punctual
 * light, or the environment.  Drawing is then by area on a triangle, by luminance on an environment
 * map, and of a constant background uniform over the directions that the receiver can use. */
#ifndef ASSAY_TRACE_LIGHTS_H
#define ASSAY_TRACE_LIGHTS_H

#include "scene/surface.h"

typedef struct assay_lights assay_lights;

/* Whether a triangle is a light: its material emits, and not for the camera alone. */
static inline bool assay_triangle_emits(const assay_scene *scene, uint32_t triangle)
{
    const assay_shape *shape = &scene->shapes[scene->triangle_shape[triangle]];
    return assay_material_emits(&scene->materials[shape->material]);
}

/* Of the scene at its current time, which is borrowed.  A scene without light is legal.
 * Errors: MEMORY. */
assay_status assay_lights_create(const assay_scene *scene, assay_lights **lights_out);
void         assay_lights_destroy(assay_lights *lights);

typedef struct {
    assay_vec3 to_light; /* from the point: end of the shadow ray at t = 1 when finite, a unit
                            vector when infinitely far                                        */
    bool       infinite;
    assay_vec3 direction; /* unit                                                             */
    assay_rgb  radiance;  /* W/(m2 sr); of a delta light: irradiance on a facing plane, W/m2  */
    double     pdf;       /* 1/sr, choice of the light included; of a delta light: the
                             probability of its choice                                        */
    bool delta;           /* punctual: no other technique can find it                         */
} assay_light_sample;

/* Who is lit. */
typedef struct {
    assay_vec3 point;  /* m                                                                     */
    assay_vec3 normal; /* unit: what comes from behind is of no use; 0 0 0: everything is       */
} assay_receiver;

/* Draws a light as seen from a receiver.  delta_only: among punctual lights alone.
 * False: nothing arrives (no light, behind a one-sided emitter, out of range). */
bool assay_lights_sample(const assay_lights *lights, const assay_receiver *receiver,
                         bool delta_only, double u_choice, double u1, double u2,
                         assay_light_sample *sample_out);

/* What arrives from one punctual light, with pdf 1.  False: nothing. */
bool assay_lights_punctual(const assay_punctual_light *light, assay_vec3 point,
                           assay_light_sample *sample_out);

/* Whether all light comes from punctual lights. */
bool assay_lights_all_punctual(const assay_lights *lights);

/* Density (1/sr) with which assay_lights_sample draws the direction to a point on an emissive
 * triangle at `distance` whose geometric normal makes cosine |cos_light|; 0 for a triangle that is
 * not a light. */
double assay_lights_pdf_triangle(const assay_lights *lights, uint32_t triangle, double distance,
                                 double cos_light);

/* The same for a direction that leaves the scene, and that the receiver can use. */
double assay_lights_pdf_infinite(const assay_lights *lights, const assay_receiver *receiver,
                                 assay_vec3 direction);

/* Radiance from outside the scene along a unit direction. */
assay_rgb assay_lights_infinite_radiance(const assay_lights *lights, assay_vec3 direction);

#endif
