/* scene_build.h - from a loaded document to a scene at a time: the steps behind
 * assay_scene_load and assay_scene_set_time. */
#ifndef ASSAY_SCENE_SCENE_BUILD_H
#define ASSAY_SCENE_SCENE_BUILD_H

#include "scene/scene_data.h"

/* Makes the shapes of all instances and all arrays that an evaluation fills; needs nodes and
 * meshes. Errors: LIMIT (triangles, morph work), MEMORY. */
assay_status assay_scene_build_shapes(assay_scene *scene, const char *file);

/* Makes the scratch of an evaluation; needs nodes and skins too.  Errors: MEMORY. */
assay_status assay_scene_build_scratch(assay_scene *scene);

/* Fills poses and morph_weights with what animations say at a time (s). */
void assay_scene_animate(assay_scene *scene, double seconds);

/* Evaluates everything at a time (s).  Errors: FORMAT (not finite), with `file` in the message. */
assay_status assay_scene_evaluate(assay_scene *scene, double seconds);

/* The last step of it: scene->vertices from positions, normals and uv. */
void assay_scene_join_vertices(assay_scene *scene);

/* Places cameras and punctual lights by the nodes' current worlds, and the camera that frames the
 * scene where there is none. */
void assay_scene_place_cameras(assay_scene *scene);
void assay_scene_place_lights(assay_scene *scene);

/* Loads from memory; the name is for messages.  folder: what relative URIs start from; NULL:
 * nothing but these bytes is read.  Otherwise as assay_scene_load. */
assay_status assay_scene_load_memory(assay_context *context, const uint8_t *bytes, size_t count,
                                     const char *name, const char *folder,
                                     const assay_scene_options *options, assay_scene **scene_out);

#endif
