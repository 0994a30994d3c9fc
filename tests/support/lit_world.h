/* lit_world.h - worlds for caches to gather in: a wall of known radiance, and a furnace. */
#ifndef ASSAY_TESTS_LIT_WORLD_H
#define ASSAY_TESTS_LIT_WORLD_H

#include "record/irradiance_cache.h"
#include "support/scene_builder.h"

typedef struct {
    assay_context *context;
    assay_scene   *scene;
    assay_world   *world;
} lit_world;

/* A rectangle at y = 1 that a directional light shines on from below: after one indirect bounce its
 * radiance is LIT_RADIANCE for whoever is under it, and nothing else is there. */
extern const assay_vec3 LIT_WALL[4];
#define LIT_RADIANCE (0.6 * 5.0 * ASSAY_INV_PI)
lit_world lit_world_wall(int threads);

/* A closed box [-1, 1]^3 of reflectance 0.5 whose walls shine with 1: radiance 2 everywhere, 1 of
 * it indirect.  With one indirect bounce, found by BSDF sampling, that is exactly 1/2. */
lit_world lit_world_furnace(int threads);

/* Of a scene; the builder is destroyed. */
lit_world lit_world_open(scene_builder *builder, int threads);
void      lit_world_close(lit_world *w);

/* A point that needs no surface of its own. */
assay_cache_point lit_point(assay_vec3 position, assay_vec3 normal);

/* Settings of one indirect bounce, a = 0.2, M x N centred cells by their cosine, all gradients. */
assay_irradiance_cache_settings lit_settings(int theta, int phi);

/* LIT_FLOOR_POINTS points over a floor below the wall, in rows; bend 1: slightly bent, 0: flat.
 * Free them. */
enum { LIT_FLOOR_SIDE = 40, LIT_FLOOR_POINTS = LIT_FLOOR_SIDE * LIT_FLOOR_SIDE };
assay_cache_point *lit_floor(double bend);

#endif
