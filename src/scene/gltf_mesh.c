/* gltf_mesh.c - meshes: attributes, morph targets, and what must agree among them.
 *
 * Invariant: a primitive that has triangles has positions; all its arrays have vertex_count
 * elements; joints and weights come in whole sets with weights >= 0 and a sum > 0. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_topology.h"
#include "scene/surface.h"
#include "scene/tangent_space.h"

/* One primitive while it is read. */
typedef struct {
    assay_gltf_loader          *loader;
    const assay_gltf_primitive *from;
    assay_primitive            *to;
    assay_gltf_topology         topology;
    char                        place[64]; /* "meshes/3/primitives/0" */
} reading;

static assay_gltf_use make_use(const reading *r, uint32_t accessor, const char *name, uint32_t rows)
{
    assay_gltf_use use = {.columns = 1, .rows = rows, .vertex = true};
    snprintf(use.place, sizeof use.place, "%s: accessor %u (%.20s)", r->place, accessor, name);
    return use;
}

/* The accessor fits the use and has as many elements as the positions. */
static assay_status check_attribute(const reading *r, uint32_t accessor, const assay_gltf_use *use)
{
    const assay_gltf_accessor *accessors = r->loader->document.accessors;
    const uint64_t             expected  = accessors[r->from->position].count;
    const uint64_t             count     = accessors[accessor].count;
    if (count != expected) {
        return assay_gltf_fail(r->loader, ASSAY_ERR_FORMAT,
                               "%s: has %llu elements, but POSITION has %llu", use->place,
                               (unsigned long long)count, (unsigned long long)expected);
    }
    return assay_gltf_check_accessor(r->loader, accessor, use);
}

/* Reads an attribute of `rows` components, or none, into elements `stride` floats apart. */
static assay_status read_attribute(reading *r, uint32_t accessor, const char *name, uint32_t rows,
                                   bool needs_unit, uint32_t stride, uint32_t first, float **values)
{
    if (accessor == ASSAY_NONE) {
        return ASSAY_OK;
    }
    assay_gltf_use use        = make_use(r, accessor, name, rows);
    use.needs_unit            = needs_unit;
    const assay_status status = check_attribute(r, accessor, &use);
    return status == ASSAY_OK
               ? assay_gltf_read_floats(r->loader, accessor, &use, r->topology.chosen,
                                        r->to->vertex_count, stride, first, values)
               : status;
}

static assay_status read_tangents(reading *r)
{
    const assay_status status =
        read_attribute(r, r->from->tangent, "TANGENT", 4, true, 4, 0, &r->to->tangents);
    for (uint32_t v = 0; status == ASSAY_OK && r->to->tangents && v < r->to->vertex_count; v++) {
        float *w = &r->to->tangents[(size_t)v * 4 + 3];
        *w       = *w < 0.0f ? -1.0f : 1.0f;
    }
    return status;
}

/* RGB or RGBA; clamped to [0, 1] as the specification asks. */
static assay_status read_colors(reading *r)
{
    if (r->from->color == ASSAY_NONE) {
        return ASSAY_OK;
    }
    const uint32_t     rows = r->loader->document.accessors[r->from->color].rows == 3 ? 3 : 4;
    const assay_status status =
        read_attribute(r, r->from->color, "COLOR_0", rows, true, 4, 0, &r->to->colors);
    const size_t count = (size_t)r->to->vertex_count * 4;
    for (size_t i = 0; status == ASSAY_OK && i < count; i++) {
        float *c = &r->to->colors[i];
        *c       = rows == 3 && i % 4 == 3 ? 1.0f : fminf(fmaxf(*c, 0.0f), 1.0f);
    }
    return status;
}

/* ---- skins ---- */

static assay_status count_joint_sets(const reading *r, uint32_t *count_out)
{
    uint32_t count = 0;
    while (count < ASSAY_GLTF_MAX_JOINT_SETS && r->from->joints[count] != ASSAY_NONE) {
        count++;
    }
    if (r->from->more_joint_sets) {
        return assay_gltf_fail(r->loader, ASSAY_ERR_UNSUPPORTED,
                               "%s: more than %d sets of joints and weights", r->place,
                               ASSAY_GLTF_MAX_JOINT_SETS);
    }
    for (uint32_t set = 0; set < ASSAY_GLTF_MAX_JOINT_SETS; set++) {
        if ((r->from->joints[set] != ASSAY_NONE) != (set < count) ||
            (r->from->weights[set] != ASSAY_NONE) != (set < count)) {
            return assay_gltf_fail(
                r->loader, ASSAY_ERR_FORMAT,
                "%s: JOINTS_%u and WEIGHTS_%u must come together and count from 0", r->place, set,
                set);
        }
    }
    *count_out = count;
    return ASSAY_OK;
}

static assay_status check_weights(const reading *r)
{
    const size_t width = (size_t)r->to->joint_sets * 4;
    for (uint32_t v = 0; v < r->to->vertex_count; v++) {
        const float *w   = &r->to->weights[v * width];
        double       sum = 0.0;
        bool         all = true;
        for (size_t k = 0; k < width; k++) {
            sum += w[k];
            all = all && w[k] >= 0.0f;
        }
        if (!all || !(sum > 0.0)) {
            const uint32_t vertex = r->topology.chosen ? r->topology.chosen[v] : v;
            return assay_gltf_fail(r->loader, ASSAY_ERR_FORMAT, "%s: the weights of vertex %u %s",
                                   r->place, vertex, all ? "are all 0" : "are negative");
        }
    }
    return ASSAY_OK;
}

static assay_status read_joints(reading *r, uint32_t set, uint32_t width)
{
    uint32_t       accessor = r->from->joints[set];
    assay_gltf_use use      = make_use(r, accessor, "JOINTS", 4);
    uint32_t      *joints   = NULL;
    use.whole               = true;
    const bool wide = r->loader->document.accessors[accessor].component == ASSAY_GLTF_UNSIGNED_INT;
    assay_status status =
        wide ? assay_gltf_fail(r->loader, ASSAY_ERR_FORMAT,
                               "%s: the components must be of 8 or 16 bits", use.place)
             : check_attribute(r, accessor, &use);
    if (status == ASSAY_OK) {
        status = assay_gltf_read_whole(r->loader, accessor, &use, r->topology.chosen,
                                       r->to->vertex_count, 4, 0, &joints);
    }
    for (uint32_t v = 0; status == ASSAY_OK && v < r->to->vertex_count; v++) {
        for (uint32_t k = 0; k < 4; k++) {
            r->to->joints[(size_t)v * width + (size_t)set * 4 + k] =
                (uint16_t)joints[(size_t)v * 4 + k];
        }
    }
    assay_release(r->loader->context, joints);
    return status;
}

static assay_status read_skinning(reading *r)
{
    assay_status   status = count_joint_sets(r, &r->to->joint_sets);
    const uint32_t width  = r->to->joint_sets * 4;
    if (status != ASSAY_OK || width == 0) {
        return status;
    }
    status = assay_gltf_count_decoded(r->loader, (uint64_t)r->to->vertex_count * width, 2);
    if (status == ASSAY_OK) {
        r->to->joints = assay_allocate(r->loader->context, (size_t)r->to->vertex_count * width, 2);
        if (!r->to->joints) {
            status = assay_fail_memory(r->loader->context, "the joints of a mesh");
        }
    }
    for (uint32_t set = 0; set < r->to->joint_sets && status == ASSAY_OK; set++) {
        status = read_joints(r, set, width);
        if (status == ASSAY_OK) {
            status = read_attribute(r, r->from->weights[set], "WEIGHTS", 4, true, width, set * 4,
                                    &r->to->weights);
        }
    }
    return status == ASSAY_OK ? check_weights(r) : status;
}

/* ---- morph targets ---- */

static assay_status read_targets(reading *r)
{
    assay_primitive *to = r->to;
    to->targets = assay_allocate(r->loader->context, r->from->target_count, sizeof *to->targets);
    if (!to->targets) {
        return assay_fail_memory(r->loader->context, "the morph targets of a mesh");
    }
    to->target_count = r->from->target_count;
    if (r->from->more_target_semantics) {
        assay_scene_warn(
            r->loader->scene,
            "%s: only positions, normals and tangents are morphed, the rest is ignored", r->place);
    }
    assay_status status = ASSAY_OK;
    for (uint32_t i = 0; i < to->target_count && status == ASSAY_OK; i++) {
        const assay_gltf_target *from   = &r->from->targets[i];
        assay_morph_target      *target = &to->targets[i];
        status = read_attribute(r, from->position, "target POSITION", 3, false, 3, 0,
                                &target->positions);
        if (status == ASSAY_OK && to->normals) {
            status =
                read_attribute(r, from->normal, "target NORMAL", 3, false, 3, 0, &target->normals);
        }
        if (status == ASSAY_OK && to->tangents) {
            status = read_attribute(r, from->tangent, "target TANGENT", 3, false, 3, 0,
                                    &target->tangents);
        }
    }
    return status;
}

/* ---- primitives ---- */

/* Texture coordinates that the material asks for and the mesh lacks count as 0. */
static void warn_of_missing_texcoords(const reading *r)
{
    const assay_material          *m      = &r->loader->scene->materials[r->to->material];
    const assay_texture_ref *const refs[] = {
        &m->base_color_texture,  &m->metallic_roughness_texture, &m->normal_texture,
        &m->emissive_texture,    &m->specular_texture,           &m->specular_color_texture,
        &m->transmission_texture};
    for (int i = 0; i < 7; i++) {
        if (refs[i]->texture != ASSAY_NONE && !r->to->uv[refs[i]->texcoord]) {
            assay_scene_warn(r->loader->scene,
                             "%s: has no TEXCOORD_%u for its material (%s): 0, 0 is used", r->place,
                             refs[i]->texcoord, m->name);
            return;
        }
    }
}

static assay_status read_attributes(reading *r)
{
    const assay_gltf_primitive *from = r->from;
    assay_primitive            *to   = r->to;
    assay_status                status =
        read_attribute(r, from->position, "POSITION", 3, false, 3, 0, &to->positions);
    if (status == ASSAY_OK) {
        status = read_attribute(r, from->normal, "NORMAL", 3, false, 3, 0, &to->normals);
    }
    /* Without normals the specification has tangents ignored. */
    if (status == ASSAY_OK && to->normals) {
        status = read_tangents(r);
    }
    for (int set = 0; set < 2 && status == ASSAY_OK; set++) {
        status = read_attribute(r, from->texcoord[set], set ? "TEXCOORD_1" : "TEXCOORD_0", 2, false,
                                2, 0, &to->uv[set]);
    }
    if (status == ASSAY_OK) {
        status = read_colors(r);
    }
    if (status == ASSAY_OK) {
        status = read_skinning(r);
    }
    return status == ASSAY_OK ? read_targets(r) : status;
}

/* Only where they are looked at: they may double vertices. */
static assay_status make_tangents(const reading *r)
{
    const assay_material *material = &r->loader->scene->materials[r->to->material];
    if (!assay_material_wants_tangent(material)) {
        return ASSAY_OK;
    }
    return assay_primitive_make_tangents(r->loader->context, r->to, &material->normal_texture);
}

static assay_status load_primitive(assay_gltf_loader *loader, uint32_t mesh, uint32_t primitive,
                                   const assay_gltf_primitive *from, assay_primitive *to)
{
    reading r = {.loader = loader, .from = from, .to = to};
    snprintf(r.place, sizeof r.place, "meshes/%u/primitives/%u", mesh, primitive);
    to->material =
        from->material == ASSAY_NONE ? loader->scene->material_count - 1 : from->material;
    if (from->mode < 4) {
        assay_scene_warn(loader->scene, "%s: points and lines are not rendered", r.place);
        return ASSAY_OK;
    }
    if (from->position == ASSAY_NONE) {
        assay_scene_warn(loader->scene, "%s: has no POSITION and is not rendered", r.place);
        return ASSAY_OK;
    }
    const assay_gltf_use use    = make_use(&r, from->position, "POSITION", 3);
    assay_status         status = check_attribute(&r, from->position, &use);
    if (status == ASSAY_OK) {
        status = assay_gltf_read_topology(loader, from, r.place, &r.topology);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    to->triangle_count = r.topology.triangle_count;
    to->vertex_count   = r.topology.vertex_count;
    to->indices        = r.topology.indices;
    status             = read_attributes(&r);
    assay_release(loader->context, r.topology.chosen);
    if (status == ASSAY_OK) {
        warn_of_missing_texcoords(&r);
        status = make_tangents(&r);
    }
    return status;
}

/* Primitives have the same targets, and default weights are one a target. */
static assay_status check_targets(const assay_gltf_loader *loader, const assay_gltf_mesh *from,
                                  uint32_t index)
{
    const uint32_t count = from->primitive_count ? from->primitives[0].target_count : 0;
    for (uint32_t i = 1; i < from->primitive_count; i++) {
        if (from->primitives[i].target_count != count) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "meshes/%u/primitives/%u: has %u morph targets, the first "
                                   "primitive has %u",
                                   index, i, from->primitives[i].target_count, count);
        }
    }
    if (from->weight_count && from->weight_count != count) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "meshes/%u: has %u weights for %u morph targets", index,
                               from->weight_count, count);
    }
    return ASSAY_OK;
}

static assay_status load_mesh(assay_gltf_loader *loader, assay_gltf_mesh *from, uint32_t index,
                              assay_mesh *to)
{
    assay_status status = check_targets(loader, from, index);
    if (status != ASSAY_OK) {
        return status;
    }
    to->name           = from->name;
    to->weights        = from->weights;
    to->weight_count   = from->weight_count;
    from->name         = NULL;
    from->weights      = NULL;
    from->weight_count = 0;
    to->primitives = assay_allocate(loader->context, from->primitive_count, sizeof *to->primitives);
    if (!to->primitives) {
        return assay_fail_memory(loader->context, "a mesh");
    }
    to->primitive_count = from->primitive_count;
    for (uint32_t i = 0; i < from->primitive_count && status == ASSAY_OK; i++) {
        status = load_primitive(loader, index, i, &from->primitives[i], &to->primitives[i]);
    }
    return status;
}

assay_status assay_gltf_load_meshes(assay_gltf_loader *loader)
{
    assay_gltf_document *document = &loader->document;
    assay_scene         *scene    = loader->scene;
    scene->meshes = assay_allocate(loader->context, document->mesh_count, sizeof *scene->meshes);
    if (!scene->meshes) {
        return assay_fail_memory(loader->context, "the scene's meshes");
    }
    scene->mesh_count   = document->mesh_count;
    assay_status status = ASSAY_OK;
    for (uint32_t i = 0; i < document->mesh_count && status == ASSAY_OK; i++) {
        status = load_mesh(loader, &document->meshes[i], i, &scene->meshes[i]);
        if (status == ASSAY_OK) {
            status = assay_gltf_step(loader);
        }
    }
    return status;
}
