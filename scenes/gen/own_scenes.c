/* own_scenes.c - the list of them. */
#include "own_scenes.h"

const own_scene *own_scene_list(void)
{
    static const own_scene scenes[OWN_SCENE_COUNT] = {
        {"cornell-box", make_cornell_box},
        {"cornell-box-glossy", make_cornell_box_glossy},
        {"furnace", make_furnace},
        {"furnace-sphere", make_furnace_sphere},
        {"rectangle-over-plane", make_rectangle_over_plane},
        {"two-plates", make_two_plates},
        {"colonnade", make_colonnade},
        {"spheres", make_spheres},
        {"lobes", make_lobes},
        {"animated", make_animated},
    };
    return scenes;
}
