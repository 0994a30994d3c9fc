/* scene_moment.h - whether a scene looks the same at two times. */
#ifndef ASSAY_SCENE_SCENE_MOMENT_H
#define ASSAY_SCENE_SCENE_MOMENT_H

#include "assay/scene.h"

/* "static" where nothing is animated, else the SHA-256 of everything that animations move and light
 * depends on: triangles with their normals and tangents, and punctual lights; not of cameras.  Of
 * the same file and options, equal texts mean the same light at both times. */
void assay_scene_moment(const assay_scene *scene, char text_out[65]);

#endif
