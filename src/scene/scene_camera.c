/* scene_camera.c - cameras and punctual lights in the world.
 *
 * Invariant: a camera's frame is orthonormal and right-handed whatever its node does: scale, skew
 * and mirrors are left out, as the specification asks for scale. */
#include "core/numerics.h"
#include "math/frame.h"
#include "scene/scene_build.h"

static assay_vec3 unit_or(assay_vec3 v, assay_vec3 otherwise)
{
    const double length = vec3_length(v);
    return length > 0.0 && isfinite(length) ? vec3_scale(v, 1.0 / length) : otherwise;
}

/* Looks along `forward`, with `up` as near as may be. */
static void set_frame(assay_camera *camera, assay_vec3 forward, assay_vec3 up)
{
    const assay_vec3 back  = vec3_negate(unit_or(forward, vec3(0.0, 0.0, -1.0)));
    const assay_vec3 rise  = vec3_mad(up, -vec3_dot(up, back), back);
    const assay_vec3 other = frame3_from_z(back).y;
    const bool       spans = vec3_length(rise) > 1e-9 * vec3_length(up);
    camera->forward        = vec3_negate(back);
    camera->up             = spans ? unit_or(rise, other) : other;
    camera->right          = vec3_cross(camera->forward, camera->up);
}

static void place_camera(const assay_scene *scene, const assay_camera_desc *from, assay_camera *to)
{
    const assay_affine *world = &scene->node_worlds[from->node];
    *to                       = (assay_camera){.name          = from->name,
                                               .position      = world->t,
                                               .orthographic  = from->orthographic,
                                               .yfov          = from->yfov,
                                               .xmag          = from->xmag,
                                               .ymag          = from->ymag,
                                               .tan_half_yfov = assay_tan(0.5 * from->yfov)};
    set_frame(to, vec3_negate(world->z), world->y);
}

/* From in front of the scene (+Z, as glTF has it), somewhat from the right and above, just so far
 * away that the bounding sphere fills 45 degrees. */
static void frame_scene(const assay_scene *scene, assay_camera *camera)
{
    static const double half_angle_sine = 0.38268343236508977173; /* sin 22.5 degrees */
    const assay_vec3    from            = unit_or(vec3(0.35, 0.25, 1.0), vec3(0.0, 0.0, 1.0));
    const assay_vec3    diagonal        = vec3_sub(scene->bounds_max, scene->bounds_min);
    const double        radius          = 0.5 * vec3_length(diagonal);
    const double        distance        = (radius > 0.0 ? radius : 1.0) / half_angle_sine;
    *camera                             = (assay_camera){
                                    .name          = "framing",
                                    .position      = vec3_mad(vec3_mad(scene->bounds_min, 0.5, diagonal), distance, from),
                                    .yfov          = ASSAY_PI / 4.0,
                                    .tan_half_yfov = assay_tan(ASSAY_PI / 8.0)};
    set_frame(camera, vec3_negate(from), vec3(0.0, 1.0, 0.0));
}

void assay_scene_place_cameras(assay_scene *scene)
{
    scene->camera_is_made = scene->camera_count == 0;
    if (scene->camera_is_made) {
        frame_scene(scene, &scene->world_cameras[0]);
    }
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        place_camera(scene, &scene->cameras[i], &scene->world_cameras[i]);
    }
}

void assay_scene_place_lights(assay_scene *scene)
{
    uint32_t next = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const assay_node *node = &scene->nodes[i];
        if (!node->in_scene || node->light == ASSAY_NONE) {
            continue;
        }
        const assay_light_desc *light = &scene->lights[node->light];
        const assay_affine     *world = &scene->node_worlds[i];
        scene->punctual[next++]       = (assay_punctual_light){
                  .kind      = light->kind,
                  .position  = world->t,
                  .direction = unit_or(vec3_negate(world->z), vec3(0.0, 0.0, -1.0)),
                  .intensity = light->intensity,
                  .range     = light->range,
                  .cos_inner = assay_cos(light->inner_cone),
                  .cos_outer = assay_cos(light->outer_cone),
        };
    }
}
