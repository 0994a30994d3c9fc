/* scene_size.h - what a scene costs. */
#ifndef ASSAY_SCENE_SCENE_SIZE_H
#define ASSAY_SCENE_SCENE_SIZE_H

#include "scene/scene_data.h"

/* Bytes of geometry and textures that the scene holds at its current time. */
uint64_t assay_scene_geometry_bytes(const assay_scene *scene);
uint64_t assay_scene_texture_bytes(const assay_scene *scene);

#endif
