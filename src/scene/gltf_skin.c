/* gltf_skin.c - skins, and whether the meshes under them fit.
 *
 * Invariant: every joint that a vertex of a skinned instance gives weight to exists. */
#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"

static assay_status read_matrices(assay_gltf_loader *loader, uint32_t index,
                                  const assay_gltf_skin *from, assay_skin *to)
{
    const uint64_t available = loader->document.accessors[from->inverse_bind].count;
    assay_gltf_use use       = {.columns = 4, .rows = 4};
    float         *values    = NULL;
    snprintf(use.place, sizeof use.place, "skins/%u: accessor %u (inverseBindMatrices)", index,
             from->inverse_bind);
    assay_status status = assay_gltf_check_accessor(loader, from->inverse_bind, &use);
    if (status == ASSAY_OK && available < to->joint_count) {
        status = assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: has %llu matrices for %u joints",
                                 use.place, (unsigned long long)available, to->joint_count);
    }
    if (status == ASSAY_OK) {
        status = assay_gltf_count_decoded(loader, to->joint_count, 16 * sizeof *to->inverse_bind);
    }
    if (status == ASSAY_OK) {
        status = assay_gltf_read_floats(loader, from->inverse_bind, &use, NULL, to->joint_count, 16,
                                        0, &values);
    }
    if (status == ASSAY_OK) {
        to->inverse_bind =
            assay_allocate(loader->context, to->joint_count, 16 * sizeof *to->inverse_bind);
        if (!to->inverse_bind) {
            status = assay_fail_memory(loader->context, "the matrices of a skin");
        }
    }
    for (size_t i = 0; status == ASSAY_OK && i < (size_t)to->joint_count * 16; i++) {
        assert(values && to->inverse_bind);
        to->inverse_bind[i] = values[i];
    }
    assay_release(loader->context, values);
    return status;
}

static assay_status load_skin(assay_gltf_loader *loader, uint32_t index, assay_gltf_skin *from,
                              assay_skin *to)
{
    to->joints      = from->joints;
    to->joint_count = from->joint_count;
    from->joints    = NULL;
    if (to->joint_count == 0) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "skins/%u: has no joints", index);
    }
    return from->inverse_bind == ASSAY_NONE ? ASSAY_OK : read_matrices(loader, index, from, to);
}

static assay_status check_primitive(const assay_gltf_loader *loader, uint32_t node_index,
                                    const assay_primitive *p, uint32_t primitive)
{
    const assay_node *node        = &loader->scene->nodes[node_index];
    const uint32_t    joint_count = loader->scene->skins[node->skin].joint_count;
    const size_t      width       = (size_t)p->joint_sets * 4;
    if (p->triangle_count && width == 0) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "meshes/%u/primitives/%u: has no joints for skins/%u of nodes/%u",
                               node->mesh, primitive, node->skin, node_index);
    }
    for (size_t i = 0; i < p->vertex_count * width; i++) {
        if (p->joints[i] >= joint_count && p->weights[i] > 0.0f) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "meshes/%u/primitives/%u: joint %u is used, but skins/%u has %u",
                                   node->mesh, primitive, p->joints[i], node->skin, joint_count);
        }
    }
    return ASSAY_OK;
}

static assay_status check_instances(const assay_gltf_loader *loader)
{
    const assay_scene *scene = loader->scene;
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const assay_node *node = &scene->nodes[i];
        if (!node->in_scene || node->skin == ASSAY_NONE || node->mesh == ASSAY_NONE) {
            continue;
        }
        const assay_mesh *mesh = &scene->meshes[node->mesh];
        for (uint32_t k = 0; k < mesh->primitive_count; k++) {
            const assay_status status = check_primitive(loader, i, &mesh->primitives[k], k);
            if (status != ASSAY_OK) {
                return status;
            }
        }
    }
    return ASSAY_OK;
}

assay_status assay_gltf_load_skins(assay_gltf_loader *loader)
{
    assay_gltf_document *document = &loader->document;
    assay_scene         *scene    = loader->scene;
    scene->skins = assay_allocate(loader->context, document->skin_count, sizeof *scene->skins);
    if (!scene->skins) {
        return assay_fail_memory(loader->context, "the scene's skins");
    }
    scene->skin_count = document->skin_count;
    for (uint32_t i = 0; i < document->skin_count; i++) {
        const assay_status status = load_skin(loader, i, &document->skins[i], &scene->skins[i]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    return check_instances(loader);
}
