/* own_scenes.h - the scenes of this project, each made by one function.
 *
 * What each is for, and what a correct render of it shows, is in the README.md of its folder. */
#ifndef ASSAY_SCENES_OWN_SCENES_H
#define ASSAY_SCENES_OWN_SCENES_H

#include "gltf_writer.h"

typedef struct {
    const char *name; /* of its folder and files */
    gltf_document *(*make)(void);
} own_scene;

#define OWN_SCENE_COUNT 10

/* In the order of scenes/README.md. */
const own_scene *own_scene_list(void);

gltf_document *make_cornell_box(void);
gltf_document *make_cornell_box_glossy(void);
gltf_document *make_furnace(void);
gltf_document *make_furnace_sphere(void);
gltf_document *make_rectangle_over_plane(void);
gltf_document *make_two_plates(void);
gltf_document *make_colonnade(void);
gltf_document *make_spheres(void);
gltf_document *make_lobes(void);
gltf_document *make_animated(void);

#endif
