/* scene_evaluate.c - every instance flattened to world space.
 *
 * Invariant: positions are computed in double and rounded once to float, in the order of the file,
 * from the document alone; what is not finite is refused.  Normals and tangents are unit vectors,
 * or zero where the file gives a zero vector or the transform makes it one. */
#include <string.h>

#include "core/context.h"
#include "core/numerics.h"
#include "scene/scene_build.h"

static assay_vec3 load3(const float *values, size_t index)
{
    const float *v = values + index * 3;
    return vec3(v[0], v[1], v[2]);
}

static void store3(float *values, size_t index, size_t stride, assay_vec3 v)
{
    float *to = values + index * stride;
    to[0]     = (float)v.x;
    to[1]     = (float)v.y;
    to[2]     = (float)v.z;
}

/* ---- nodes ---- */

static assay_status evaluate_nodes(assay_scene *scene, double seconds)
{
    for (uint32_t at = 0; at < scene->node_count; at++) {
        const uint32_t     i     = scene->node_order[at];
        const assay_node  *node  = &scene->nodes[i];
        const assay_affine local = node->has_matrix ? affine_from_columns(node->matrix)
                                                    : affine_from_pose(&scene->poses[i]);
        scene->node_worlds[i]    = node->parent == ASSAY_NONE
                                       ? local
                                       : affine_multiply(&scene->node_worlds[node->parent], &local);
        if (!affine_finite(&scene->node_worlds[i])) {
            return assay_fail(scene->context, ASSAY_ERR_FORMAT,
                              "%s: nodes/%u (%s): its place in the world is not finite at %g s",
                              scene->path, i, node->name, seconds);
        }
    }
    return ASSAY_OK;
}

static void evaluate_skins(assay_scene *scene)
{
    for (uint32_t i = 0; i < scene->skin_count; i++) {
        const assay_skin *skin = &scene->skins[i];
        for (uint32_t k = 0; k < skin->joint_count; k++) {
            const assay_affine *world = &scene->node_worlds[skin->joints[k]];
            assay_affine        bind  = affine_identity();
            if (skin->inverse_bind) {
                bind = affine_from_columns(skin->inverse_bind + (size_t)k * 16);
            }
            scene->joint_matrices[skin->first_matrix + k] = affine_multiply(world, &bind);
        }
    }
}

/* ---- vertices ---- */

/* What one vertex of a shape looks like before it is placed. */
typedef struct {
    assay_vec3 position, normal, tangent;
} vertex;

static vertex morph(const assay_primitive *p, const double *weights, uint32_t v)
{
    vertex out = {.position = load3(p->positions, v)};
    if (p->normals) {
        out.normal = load3(p->normals, v);
    }
    if (p->tangents) {
        const float *t = p->tangents + (size_t)v * 4;
        out.tangent    = vec3(t[0], t[1], t[2]);
    }
    for (uint32_t i = 0; i < p->target_count; i++) {
        const assay_morph_target *target = &p->targets[i];
        if (weights[i] == 0.0) {
            continue;
        }
        if (target->positions) {
            out.position = vec3_mad(out.position, weights[i], load3(target->positions, v));
        }
        if (target->normals) {
            out.normal = vec3_mad(out.normal, weights[i], load3(target->normals, v));
        }
        if (target->tangents) {
            out.tangent = vec3_mad(out.tangent, weights[i], load3(target->tangents, v));
        }
    }
    return out;
}

/* The map of a skinned vertex: its joints' maps, weighted. */
static assay_affine blend(const assay_primitive *p, const assay_affine *joints, uint32_t v)
{
    const size_t width = (size_t)p->joint_sets * 4, first = v * width;
    assay_affine sum   = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    double       total = 0.0;
    for (size_t k = 0; k < width; k++) {
        total += p->weights[first + k];
    }
    for (size_t k = 0; k < width; k++) {
        if (p->weights[first + k] > 0.0f) {
            affine_add(&sum, p->weights[first + k] / total, &joints[p->joints[first + k]]);
        }
    }
    return sum;
}

/* False where something about it is not finite. */
static bool place_vertex(assay_scene *scene, assay_shape *shape, uint32_t v, const vertex *in,
                         const assay_affine *map, const assay_affine *normal_map, bool mirrored)
{
    const size_t index = (size_t)shape->first_vertex + v;
    store3(scene->positions, index, 3, affine_point(map, in->position));
    bool sound = vec3_finite(load3(scene->positions, index));
    if (shape->normals) {
        const assay_vec3 normal = vec3_normalize(affine_vector(normal_map, in->normal));
        store3(shape->normals, v, 3, normal);
        sound = sound && vec3_finite(normal);
    }
    if (shape->tangents) {
        const assay_vec3 tangent = vec3_normalize(affine_vector(map, in->tangent));
        const float      w       = shape->primitive->tangents[(size_t)v * 4 + 3];
        store3(shape->tangents, v, 4, tangent);
        shape->tangents[(size_t)v * 4 + 3] = mirrored ? -w : w;
        sound                              = sound && vec3_finite(tangent);
    }
    return sound;
}

/* Returns the first vertex that is not finite, vertex_count when all are. */
static uint32_t place_vertices(assay_scene *scene, assay_shape *shape)
{
    const assay_node      *node    = &scene->nodes[shape->node];
    const assay_primitive *p       = shape->primitive;
    const double          *weights = scene->morph_weights + node->first_weight;
    const bool             skinned = node->skin != ASSAY_NONE;
    const assay_affine    *joints =
        skinned ? scene->joint_matrices + scene->skins[node->skin].first_matrix : NULL;
    assay_affine map        = scene->node_worlds[shape->node];
    assay_affine normal_map = affine_normal_map(&map);
    bool         mirrored   = affine_determinant(&map) < 0.0;
    uint32_t     mirrors    = 0;
    for (uint32_t v = 0; v < shape->vertex_count; v++) {
        const vertex in = morph(p, weights, v);
        if (skinned) {
            map        = blend(p, joints, v);
            normal_map = affine_normal_map(&map);
            mirrored   = affine_determinant(&map) < 0.0;
        }
        if (!place_vertex(scene, shape, v, &in, &map, &normal_map, mirrored)) {
            return v;
        }
        mirrors += mirrored;
    }
    shape->flipped = mirrors > shape->vertex_count / 2;
    return shape->vertex_count;
}

static void place_triangles(assay_scene *scene, const assay_shape *shape)
{
    const uint32_t *from = shape->primitive->indices;
    uint32_t       *to   = scene->indices + (size_t)shape->first_triangle * 3;
    for (size_t i = 0; i < shape->triangle_count; i++, from += 3, to += 3) {
        to[0] = shape->first_vertex + from[0];
        to[1] = shape->first_vertex + from[shape->flipped ? 2 : 1];
        to[2] = shape->first_vertex + from[shape->flipped ? 1 : 2];
    }
}

void assay_scene_join_vertices(assay_scene *scene)
{
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        const assay_shape *shape = &scene->shapes[i];
        const float       *uv    = shape->primitive->uv[0];
        for (uint32_t v = 0; v < shape->vertex_count; v++) {
            const size_t        index = (size_t)shape->first_vertex + v;
            assay_world_vertex *to    = &scene->vertices[index];
            *to                       = (assay_world_vertex){0};
            memcpy(to->position, scene->positions + 3 * index, sizeof to->position);
            if (shape->normals) {
                memcpy(to->normal, shape->normals + 3 * (size_t)v, sizeof to->normal);
            }
            if (uv) {
                memcpy(to->uv, uv + 2 * (size_t)v, sizeof to->uv);
            }
        }
    }
}

static void find_bounds(assay_scene *scene)
{
    scene->bounds_min = scene->bounds_max = vec3(0.0, 0.0, 0.0);
    for (uint32_t v = 0; v < scene->vertex_count; v++) {
        const assay_vec3 p = load3(scene->positions, v);
        scene->bounds_min  = v ? vec3_min(scene->bounds_min, p) : p;
        scene->bounds_max  = v ? vec3_max(scene->bounds_max, p) : p;
    }
}

assay_status assay_scene_evaluate(assay_scene *scene, double seconds)
{
    assay_scene_animate(scene, seconds);
    const assay_status status = evaluate_nodes(scene, seconds);
    if (status != ASSAY_OK) {
        return status;
    }
    evaluate_skins(scene);
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        assay_shape   *shape = &scene->shapes[i];
        const uint32_t bad   = place_vertices(scene, shape);
        if (bad < shape->vertex_count) {
            return assay_fail(scene->context, ASSAY_ERR_FORMAT,
                              "%s: nodes/%u (%s), meshes/%u/primitives/%u: vertex %u is not finite "
                              "in the world at %g s",
                              scene->path, shape->node, scene->nodes[shape->node].name, shape->mesh,
                              shape->primitive_index, bad, seconds);
        }
        place_triangles(scene, shape);
    }
    assay_scene_join_vertices(scene);
    find_bounds(scene);
    assay_scene_place_cameras(scene);
    assay_scene_place_lights(scene);
    scene->time = seconds;
    return ASSAY_OK;
}
