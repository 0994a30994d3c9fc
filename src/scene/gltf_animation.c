/* gltf_animation.c - animations as tracks of key frames.
 *
 * Invariant: times of a track rise strictly, its values are finite and as many as its keys ask for,
 * and a rotation's keys are no zero quaternions. */
#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"

/* Where in the file a track comes from. */
typedef struct {
    assay_gltf_loader                  *loader;
    uint32_t                            animation, channel;
    const assay_gltf_channel           *from;
    const assay_gltf_animation_sampler *sampler;
    assay_channel_track                *to;
} reading;

/* Reads a whole accessor of `rows` components as doubles. */
static assay_status read_doubles(const reading *r, uint32_t accessor, const char *name,
                                 uint32_t rows, bool needs_unit, uint64_t expected,
                                 double **values_out)
{
    assay_gltf_loader         *loader = r->loader;
    const assay_gltf_accessor *a      = &loader->document.accessors[accessor];
    assay_gltf_use             use    = {.columns = 1, .rows = rows, .needs_unit = needs_unit};
    float                     *floats = NULL;
    const uint64_t             count  = a->count * rows;
    snprintf(use.place, sizeof use.place, "animations/%u/channels/%u: accessor %u (%s)",
             r->animation, r->channel, accessor, name);
    assay_status status = assay_gltf_check_accessor(loader, accessor, &use);
    if (status == ASSAY_OK && a->count != expected) {
        status =
            assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: has %llu elements, must have %llu",
                            use.place, (unsigned long long)a->count, (unsigned long long)expected);
    }
    if (status == ASSAY_OK) {
        status = assay_gltf_count_decoded(loader, count, sizeof **values_out);
    }
    if (status == ASSAY_OK) {
        status = assay_gltf_read_floats(loader, accessor, &use, NULL, (uint32_t)a->count, rows, 0,
                                        &floats);
    }
    if (status == ASSAY_OK) {
        *values_out = assay_allocate(loader->context, (size_t)count, sizeof **values_out);
        if (!*values_out) {
            status = assay_fail_memory(loader->context, "an animation");
        }
    }
    for (uint64_t i = 0; i < count && status == ASSAY_OK; i++) {
        assert(floats && *values_out);
        (*values_out)[i] = floats[i];
    }
    assay_release(loader->context, floats);
    return status;
}

static assay_status read_times(const reading *r)
{
    const assay_gltf_accessor *a = &r->loader->document.accessors[r->sampler->input];
    if (a->component != ASSAY_GLTF_FLOAT) {
        return assay_gltf_fail(
            r->loader, ASSAY_ERR_FORMAT,
            "animations/%u/channels/%u: accessor %u (input): the components must "
            "be float",
            r->animation, r->channel, r->sampler->input);
    }
    const assay_status status =
        read_doubles(r, r->sampler->input, "input", 1, false, a->count, &r->to->times);
    if (status != ASSAY_OK) {
        return status;
    }
    r->to->key_count = (uint32_t)a->count;
    for (uint32_t i = 1; i < r->to->key_count; i++) {
        if (!(r->to->times[i] > r->to->times[i - 1])) {
            return assay_gltf_fail(r->loader, ASSAY_ERR_FORMAT,
                                   "animations/%u/channels/%u: accessor %u (input): key %u is not "
                                   "later than the one before",
                                   r->animation, r->channel, r->sampler->input, i);
        }
    }
    return ASSAY_OK;
}

static assay_status check_rotations(const reading *r)
{
    const bool   spline = r->to->interpolation == ASSAY_INTERPOLATE_CUBICSPLINE;
    const size_t step = spline ? 12 : 4, first = spline ? 4 : 0;
    for (uint32_t i = 0; i < r->to->key_count; i++) {
        const double *q = &r->to->values[i * step + first];
        if (q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 && q[3] == 0.0) {
            return assay_gltf_fail(r->loader, ASSAY_ERR_FORMAT,
                                   "animations/%u/channels/%u: accessor %u (output): the rotation "
                                   "of key %u has length 0",
                                   r->animation, r->channel, r->sampler->output, i);
        }
    }
    return ASSAY_OK;
}

static assay_status check_target(const reading *r)
{
    const assay_node *node    = &r->loader->scene->nodes[r->from->node];
    const bool        weights = r->from->path == ASSAY_PATH_WEIGHTS;
    if (!weights && node->has_matrix) {
        return assay_gltf_fail(
            r->loader, ASSAY_ERR_FORMAT,
            "animations/%u/channels/%u: nodes/%u (%s) has a matrix, which cannot "
            "be animated",
            r->animation, r->channel, r->from->node, node->name);
    }
    if (weights && node->target_count == 0) {
        return assay_gltf_fail(r->loader, ASSAY_ERR_FORMAT,
                               "animations/%u/channels/%u: nodes/%u (%s) has no morph targets",
                               r->animation, r->channel, r->from->node, node->name);
    }
    return ASSAY_OK;
}

static assay_status load_track(const reading *r)
{
    const assay_node    *node    = &r->loader->scene->nodes[r->from->node];
    assay_channel_track *to      = r->to;
    const bool           weights = r->from->path == ASSAY_PATH_WEIGHTS;
    to->node                     = r->from->node;
    to->path                     = r->from->path;
    to->interpolation            = r->sampler->interpolation;
    to->width = weights ? node->target_count : r->from->path == ASSAY_PATH_ROTATION ? 4 : 3;
    assay_status status = check_target(r);
    if (status == ASSAY_OK) {
        status = read_times(r);
    }
    const uint64_t parts    = to->interpolation == ASSAY_INTERPOLATE_CUBICSPLINE ? 3 : 1;
    const uint64_t elements = to->key_count * parts * (weights ? to->width : 1);
    if (status == ASSAY_OK) {
        status =
            read_doubles(r, r->sampler->output, "output", weights ? 1 : to->width,
                         weights || r->from->path == ASSAY_PATH_ROTATION, elements, &to->values);
    }
    return status == ASSAY_OK && to->path == ASSAY_PATH_ROTATION ? check_rotations(r) : status;
}

static assay_status load_animation(assay_gltf_loader *loader, uint32_t index,
                                   assay_gltf_animation *from, assay_animation *to)
{
    to->name   = from->name;
    from->name = NULL;
    to->tracks = assay_allocate(loader->context, from->channel_count, sizeof *to->tracks);
    if (!to->tracks) {
        return assay_fail_memory(loader->context, "an animation");
    }
    to->track_count = from->channel_count;
    for (uint32_t i = 0; i < from->channel_count; i++) {
        const assay_gltf_channel *channel = &from->channels[i];
        if (channel->sampler >= from->sampler_count) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "animations/%u/channels/%u: sampler is %u, but there are %u",
                                   index, i, channel->sampler, from->sampler_count);
        }
        const reading      r = {loader,        index, i, channel, &from->samplers[channel->sampler],
                                &to->tracks[i]};
        const assay_status status = load_track(&r);
        if (status != ASSAY_OK) {
            return status;
        }
        to->duration = fmax(to->duration, r.to->times[r.to->key_count - 1]);
    }
    return ASSAY_OK;
}

assay_status assay_gltf_load_animations(assay_gltf_loader *loader)
{
    assay_gltf_document *document = &loader->document;
    assay_scene         *scene    = loader->scene;
    scene->animations =
        assay_allocate(loader->context, document->animation_count, sizeof *scene->animations);
    if (!scene->animations) {
        return assay_fail_memory(loader->context, "the scene's animations");
    }
    scene->animation_count = document->animation_count;
    scene->is_static       = true;
    for (uint32_t i = 0; i < document->animation_count; i++) {
        const assay_status status =
            load_animation(loader, i, &document->animations[i], &scene->animations[i]);
        if (status != ASSAY_OK) {
            return status;
        }
        scene->is_static = scene->is_static && scene->animations[i].track_count == 0;
    }
    return ASSAY_OK;
}
