/* gltf_node.c - the node graph, and where cameras and lights stand in it.
 *
 * Invariant: behind this the graph is a forest, node_order lists parents before children, and no
 * step of it recursed, so its depth does not matter. */
#include <math.h>
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"

/* ---- single nodes ---- */

/* The last row must be 0 0 0 1, up to what exporters round. */
static bool is_affine(const double m[16])
{
    return fabs(m[3]) < 1e-6 && fabs(m[7]) < 1e-6 && fabs(m[11]) < 1e-6 && fabs(m[15] - 1.0) < 1e-6;
}

static assay_status check_node(const assay_gltf_loader *loader, const assay_json *json,
                               uint32_t index)
{
    assay_node   *node = &loader->scene->nodes[index];
    const double *q    = node->rotation;
    if (node->has_matrix &&
        (assay_json_member(json, "translation") || assay_json_member(json, "rotation") ||
         assay_json_member(json, "scale"))) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "nodes/%u (%s): has a matrix besides translation, rotation or scale",
                               index, node->name);
    }
    if (node->has_matrix && !is_affine(node->matrix)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "nodes/%u (%s): the last row of its matrix is not 0 0 0 1", index,
                               node->name);
    }
    if (q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "nodes/%u (%s): its rotation has length 0",
                               index, node->name);
    }
    const assay_json *light =
        assay_json_member(assay_json_member(json, "extensions"), "KHR_lights_punctual");
    node->light = assay_json_index(light, "light");
    return ASSAY_OK;
}

static assay_status check_nodes(const assay_gltf_loader *loader)
{
    const assay_json *array = assay_json_member(loader->json.nodes, "nodes");
    uint32_t          index = 0;
    for (const assay_json *n = array ? array->child : NULL; n; n = n->next, index++) {
        const assay_status status = check_node(loader, n, index);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return ASSAY_OK;
}

/* Morph weights of a node: one a target of its mesh. */
static assay_status check_weights(const assay_gltf_loader *loader)
{
    assay_scene *scene = loader->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        assay_node            *node = &scene->nodes[i];
        const assay_gltf_mesh *mesh =
            node->mesh == ASSAY_NONE ? NULL : &loader->document.meshes[node->mesh];
        node->target_count = mesh && mesh->primitive_count ? mesh->primitives[0].target_count : 0;
        if (node->weight_count && node->weight_count != node->target_count) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "nodes/%u (%s): has %u weights for %u morph targets", i,
                                   node->name, node->weight_count, node->target_count);
        }
    }
    return ASSAY_OK;
}

/* ---- the graph ---- */

static assay_status set_parents(const assay_gltf_loader *loader)
{
    assay_scene *scene = loader->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const assay_gltf_children *list = &loader->document.children[i];
        for (uint32_t k = 0; k < list->child_count; k++) {
            assay_node *child = &scene->nodes[list->children[k]];
            if (child->parent != ASSAY_NONE) {
                return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                       "nodes/%u (%s): is a child of nodes/%u and of nodes/%u",
                                       list->children[k], child->name, child->parent, i);
            }
            child->parent = i;
        }
    }
    return ASSAY_OK;
}

/* Roots first, then level by level; what is never reached lies on a cycle or below one. */
static assay_status order_nodes(const assay_gltf_loader *loader)
{
    assay_scene *scene = loader->scene;
    uint32_t     end   = 0;
    scene->node_order =
        assay_allocate(loader->context, scene->node_count, sizeof *scene->node_order);
    if (!scene->node_order) {
        return assay_fail_memory(loader->context, "the scene's nodes");
    }
    for (uint32_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].parent == ASSAY_NONE) {
            scene->node_order[end++] = i;
        }
    }
    for (uint32_t at = 0; at < end; at++) {
        const assay_gltf_children *list = &loader->document.children[scene->node_order[at]];
        for (uint32_t k = 0; k < list->child_count; k++) {
            scene->node_order[end++] = list->children[k];
        }
    }
    if (end == scene->node_count) {
        return ASSAY_OK;
    }
    /* The parent of an unreached node is unreached too, so node_count steps up end on the cycle. */
    bool *reached = assay_allocate(loader->context, scene->node_count, sizeof *reached);
    if (!reached) {
        return assay_fail_memory(loader->context, "the scene's nodes");
    }
    for (uint32_t at = 0; at < end; at++) {
        reached[scene->node_order[at]] = true;
    }
    uint32_t on_cycle = 0;
    while (reached[on_cycle]) {
        on_cycle++;
    }
    for (uint32_t step = 0; step < scene->node_count; step++) {
        on_cycle = scene->nodes[on_cycle].parent;
    }
    assay_release(loader->context, reached);
    return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "nodes/%u (%s): is its own ancestor", on_cycle,
                           scene->nodes[on_cycle].name);
}

/* Marks the roots of the scene that is asked for. */
static assay_status mark_roots(const assay_gltf_loader *loader)
{
    const assay_gltf_document *document = &loader->document;
    assay_scene               *scene    = loader->scene;
    const int                  asked    = scene->options.scene_index;
    if (asked >= 0 && (uint32_t)asked >= document->scene_count) {
        return assay_gltf_fail(loader, ASSAY_ERR_ARGUMENT,
                               "scene %d is asked for, but the file has %u", asked,
                               document->scene_count);
    }
    if (document->scene_count == 0) {
        assay_scene_warn(scene, "the file has no scene: all of its nodes are taken");
        for (uint32_t i = 0; i < scene->node_count; i++) {
            scene->nodes[i].in_scene = scene->nodes[i].parent == ASSAY_NONE;
        }
        return ASSAY_OK;
    }
    const uint32_t chosen =
        asked >= 0 ? (uint32_t)asked
                   : (document->default_scene == ASSAY_NONE ? 0 : document->default_scene);
    const assay_gltf_scene *from = &document->scenes[chosen];
    for (uint32_t k = 0; k < from->node_count; k++) {
        assay_node *node = &scene->nodes[from->nodes[k]];
        if (node->parent != ASSAY_NONE) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "scenes/%u/nodes/%u: nodes/%u (%s) is no root but a child of "
                                   "nodes/%u",
                                   chosen, k, from->nodes[k], node->name, node->parent);
        }
        node->in_scene = true;
    }
    return ASSAY_OK;
}

static void mark_descendants(assay_scene *scene)
{
    for (uint32_t at = 0; at < scene->node_count; at++) {
        assay_node *node = &scene->nodes[scene->node_order[at]];
        if (node->parent != ASSAY_NONE) {
            node->in_scene = scene->nodes[node->parent].in_scene;
        }
        scene->instance_count += node->in_scene && node->mesh != ASSAY_NONE;
    }
}

/* ---- cameras ---- */

/* One camera a node of the scene that has one, named after the camera, else the node. */
static assay_status place_cameras(const assay_gltf_loader *loader)
{
    assay_scene *scene = loader->scene;
    uint32_t     count = 0;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        count += scene->nodes[i].in_scene && scene->nodes[i].camera != ASSAY_NONE;
    }
    scene->cameras = assay_allocate(loader->context, count, sizeof *scene->cameras);
    if (!scene->cameras) {
        return assay_fail_memory(loader->context, "the scene's cameras");
    }
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const assay_node *node = &scene->nodes[i];
        if (!node->in_scene || node->camera == ASSAY_NONE) {
            continue;
        }
        assay_camera_desc *camera = &scene->cameras[scene->camera_count];
        char               number[32];
        snprintf(number, sizeof number, "camera %u", scene->camera_count);
        *camera          = loader->document.cameras[node->camera];
        const char *name = camera->name[0] ? camera->name : node->name[0] ? node->name : number;
        camera->name     = assay_copy_text(loader->context, name);
        camera->node     = i;
        if (!camera->name) {
            return assay_fail_memory(loader->context, "the scene's cameras");
        }
        scene->camera_count++;
    }
    return ASSAY_OK;
}

typedef assay_status (*node_step)(const assay_gltf_loader *);

assay_status assay_gltf_load_nodes(assay_gltf_loader *loader)
{
    assay_scene *scene             = loader->scene;
    scene->nodes                   = loader->document.nodes;
    scene->node_count              = loader->document.node_count;
    loader->document.nodes         = NULL;
    static const node_step steps[] = {check_nodes, check_weights, set_parents, order_nodes,
                                      mark_roots};
    for (int i = 0; i < 5; i++) {
        const assay_status status = steps[i](loader);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    mark_descendants(scene);
    return place_cameras(loader);
}
