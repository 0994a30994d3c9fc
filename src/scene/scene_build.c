/* scene_build.c - Invariant: nothing is allocated for instances before their total was checked, and
 * an evaluation afterwards only fills what is there. */
#include "scene/scene_build.h"

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_limits.h"

typedef struct {
    uint64_t shapes, triangles, vertices, morph_work;
} totals;

/* Whether an instance of the node contributes triangles. */
static bool has_shapes(const assay_node *node)
{
    return node->in_scene && node->mesh != ASSAY_NONE;
}

static assay_status add_up(const assay_scene *scene, const char *file, totals *sum)
{
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const assay_node *node = &scene->nodes[i];
        if (!has_shapes(node)) {
            continue;
        }
        const assay_mesh *mesh = &scene->meshes[node->mesh];
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            const assay_primitive *p = &mesh->primitives[k];
            sum->shapes += p->triangle_count > 0;
            sum->triangles += p->triangle_count;
            sum->vertices += p->vertex_count;
            sum->morph_work += (uint64_t)p->vertex_count * p->target_count;
        }
        if (sum->triangles > ASSAY_GLTF_MAX_TRIANGLES) {
            return assay_fail(scene->context, ASSAY_ERR_LIMIT,
                              "%s: its instances have more than %u triangles", file,
                              ASSAY_GLTF_MAX_TRIANGLES);
        }
        if (sum->morph_work > ASSAY_GLTF_MAX_MORPH_WORK) {
            return assay_fail(scene->context, ASSAY_ERR_LIMIT,
                              "%s: its instances have more than %llu vertices times morph targets",
                              file, (unsigned long long)ASSAY_GLTF_MAX_MORPH_WORK);
        }
    }
    return ASSAY_OK;
}

static assay_status make_shape(assay_scene *scene, uint32_t node, uint32_t primitive)
{
    const assay_primitive *p     = &scene->meshes[scene->nodes[node].mesh].primitives[primitive];
    assay_shape           *shape = &scene->shapes[scene->shape_count];
    *shape                       = (assay_shape){
                              .first_triangle  = scene->triangle_count,
                              .triangle_count  = p->triangle_count,
                              .first_vertex    = scene->vertex_count,
                              .vertex_count    = p->vertex_count,
                              .node            = node,
                              .mesh            = scene->nodes[node].mesh,
                              .primitive_index = primitive,
                              .primitive       = p,
                              .material        = p->material,
    };
    scene->shape_count++;
    if (p->normals) {
        shape->normals = assay_allocate(scene->context, p->vertex_count, 3 * sizeof(float));
    }
    if (p->tangents) {
        shape->tangents = assay_allocate(scene->context, p->vertex_count, 4 * sizeof(float));
    }
    if ((p->normals && !shape->normals) || (p->tangents && !shape->tangents)) {
        return assay_fail_memory(scene->context, "the scene's vertices");
    }
    for (uint32_t i = 0; i < p->triangle_count; i++) {
        scene->triangle_shape[shape->first_triangle + i] = scene->shape_count - 1;
    }
    scene->triangle_count += p->triangle_count;
    scene->vertex_count += p->vertex_count;
    return ASSAY_OK;
}

assay_status assay_scene_build_shapes(assay_scene *scene, const char *file)
{
    totals       sum    = {0};
    assay_status status = add_up(scene, file, &sum);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t triangles = (size_t)sum.triangles;
    scene->shapes          = assay_allocate(scene->context, sum.shapes, sizeof *scene->shapes);
    scene->positions = assay_allocate(scene->context, sum.vertices, 3 * sizeof *scene->positions);
    scene->vertices  = assay_allocate(scene->context, sum.vertices, sizeof *scene->vertices);
    scene->indices   = assay_allocate(scene->context, triangles, 3 * sizeof *scene->indices);
    scene->triangle_shape =
        assay_allocate(scene->context, triangles, sizeof *scene->triangle_shape);
    if (!scene->shapes || !scene->positions || !scene->vertices || !scene->indices ||
        !scene->triangle_shape) {
        return assay_fail_memory(scene->context, "the scene's triangles");
    }
    for (uint32_t i = 0; i < scene->node_count && status == ASSAY_OK; i++) {
        if (!has_shapes(&scene->nodes[i])) {
            continue;
        }
        const assay_mesh *mesh = &scene->meshes[scene->nodes[i].mesh];
        for (uint32_t k = 0; k < mesh->primitive_count && status == ASSAY_OK; k++) {
            if (mesh->primitives[k].triangle_count) {
                status = make_shape(scene, i, k);
            }
        }
    }
    return status;
}

assay_status assay_scene_build_scratch(assay_scene *scene)
{
    uint64_t weights = 0, matrices = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        scene->nodes[i].first_weight = (uint32_t)weights;
        weights += scene->nodes[i].target_count;
    }
    for (uint32_t i = 0; i < scene->skin_count; i++) {
        scene->skins[i].first_matrix = (uint32_t)matrices;
        matrices += scene->skins[i].joint_count;
    }
    for (uint32_t i = 0; i < scene->node_count; i++) {
        scene->punctual_count += scene->nodes[i].in_scene && scene->nodes[i].light != ASSAY_NONE;
    }
    if (weights > UINT32_MAX || matrices > UINT32_MAX) {
        return assay_fail(scene->context, ASSAY_ERR_LIMIT,
                          "more than 2^32 morph weights or joints in the scene");
    }
    assay_context *context    = scene->context;
    const uint32_t nodes      = scene->node_count;
    scene->world_camera_count = scene->camera_count ? scene->camera_count : 1;
    scene->poses              = assay_allocate(context, nodes, sizeof *scene->poses);
    scene->node_worlds        = assay_allocate(context, nodes, sizeof *scene->node_worlds);
    scene->morph_weights      = assay_allocate(context, weights, sizeof *scene->morph_weights);
    scene->joint_matrices     = assay_allocate(context, matrices, sizeof *scene->joint_matrices);
    scene->punctual = assay_allocate(context, scene->punctual_count, sizeof *scene->punctual);
    scene->world_cameras =
        assay_allocate(context, scene->world_camera_count, sizeof *scene->world_cameras);
    if (!scene->poses || !scene->node_worlds || !scene->morph_weights || !scene->joint_matrices ||
        !scene->punctual || !scene->world_cameras) {
        return assay_fail_memory(context, "the scene's nodes");
    }
    return ASSAY_OK;
}
