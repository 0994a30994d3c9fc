/* shadow_map.h - direct light of punctual lights, shadowed by uniform maps of depth [williams78]
 * with percentage-closer filtering [reeves87].
 *
 * A map for a directional light and for a spot light, six for a point light and for a very wide
 * spot.  Light of other kinds (emitting surfaces, environment, background) has no map and is drawn
 * and ray-traced.  What a mask or blending leaves less than half there casts no shadow in a map,
 * everything else a full one. */
#ifndef ASSAY_GATHER_SHADOW_MAP_H
#define ASSAY_GATHER_SHADOW_MAP_H

#include "gather/gather.h"

typedef struct {
    int side; /* texels of a map: 16 ... 8192                              */
    int taps; /* depths that are compared: 1, 4, 9, ...; at most (side / 8)^2 */
} assay_shadow_settings;

typedef struct assay_shadow_maps assay_shadow_maps;

/* Of a world, which must outlive them.  Errors: ARGUMENT (settings), MEMORY. */
assay_status assay_shadow_maps_create(const assay_world           *world,
                                      const assay_shadow_settings *settings,
                                      assay_shadow_maps          **maps_out);
void         assay_shadow_maps_destroy(assay_shadow_maps *maps);

/* Part of the taps at which a point on a surface with this unit geometric normal sees the light
 * numbered so among the scene's punctual ones.  An infinite plane never shadows itself. */
double assay_shadow_maps_visibility(const assay_shadow_maps *maps, uint32_t light,
                                    assay_vec3 position, assay_vec3 ng);

/* Direct light that the vertex scatters towards its wo, of all lights; of those without a map one
 * sample, drawn by light sampling alone.  Perfectly specular lobes reflect none of it. */
assay_rgb assay_shadow_maps_light(const assay_shadow_maps *maps, assay_vertex *vertex,
                                  assay_random *random, assay_ray_counts *counts);

#endif
