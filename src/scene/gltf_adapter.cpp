// gltf_adapter.cpp - Invariant: no tinygltf type, no exception and no memory of C++ leaves this
// file.
//
// tinygltf is given a text that was checked against the schema and stripped of buffers, images,
// materials, extras and extensions (gltf_write.c), because its 2.7 reads a '+' of a path as a
// space, copies the binary chunk once a buffer, points outside of buffers for images, and cuts
// whole numbers of extensions to 32 bits.  What remains is what it does well: the typed structure.
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include "scene/gltf_document.h"

extern "C" {
#include "core/alloc.h"
#include "core/context.h"
}

namespace
{

// Thrown where the context refuses memory, like the standard one, so that both end the same way.
template <typename T> T *make_array(assay_context *context, size_t count)
{
    void *memory = count ? assay_allocate(context, count, sizeof(T)) : nullptr;
    if (count && !memory) {
        throw std::bad_alloc();
    }
    return static_cast<T *>(memory);
}

uint32_t index_or_none(int index) { return index < 0 ? ASSAY_NONE : static_cast<uint32_t>(index); }

char *take_name(assay_context *context, const std::string &name)
{
    char *copy = assay_gltf_copy_name(context, name.c_str());
    if (!copy) {
        throw std::bad_alloc();
    }
    return copy;
}

// The count is stored only once the array is there, so that a release half-way finds both.
template <typename T>
void take_values(assay_context *context, const std::vector<T> &from, T **values, uint32_t *count)
{
    *values = make_array<T>(context, from.size());
    *count  = static_cast<uint32_t>(from.size());
    for (size_t i = 0; i < from.size(); i++) {
        (*values)[i] = from[i];
    }
}

void take_indices(assay_context *context, const std::vector<int> &from, uint32_t **indices,
                  uint32_t *count)
{
    *indices = make_array<uint32_t>(context, from.size());
    *count   = static_cast<uint32_t>(from.size());
    for (size_t i = 0; i < from.size(); i++) {
        (*indices)[i] = index_or_none(from[i]);
    }
}

void take_views(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->views      = make_array<assay_gltf_view>(context, model.bufferViews.size());
    out->view_count = static_cast<uint32_t>(model.bufferViews.size());
    for (size_t i = 0; i < model.bufferViews.size(); i++) {
        const tinygltf::BufferView &from = model.bufferViews[i];
        assay_gltf_view            &to   = out->views[i];
        to.buffer                        = index_or_none(from.buffer);
        to.offset                        = from.byteOffset;
        to.length                        = from.byteLength;
        to.stride                        = static_cast<uint32_t>(from.byteStride);
    }
}

void take_shape(int type, assay_gltf_accessor *to)
{
    to->columns = 1;
    switch (type) {
    case TINYGLTF_TYPE_VEC2: to->rows = 2; break;
    case TINYGLTF_TYPE_VEC3: to->rows = 3; break;
    case TINYGLTF_TYPE_VEC4: to->rows = 4; break;
    case TINYGLTF_TYPE_MAT2: to->rows = to->columns = 2; break;
    case TINYGLTF_TYPE_MAT3: to->rows = to->columns = 3; break;
    case TINYGLTF_TYPE_MAT4: to->rows = to->columns = 4; break;
    default: to->rows = 1; break;
    }
}

void take_accessors(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->accessors      = make_array<assay_gltf_accessor>(context, model.accessors.size());
    out->accessor_count = static_cast<uint32_t>(model.accessors.size());
    for (size_t i = 0; i < model.accessors.size(); i++) {
        const tinygltf::Accessor &from = model.accessors[i];
        assay_gltf_accessor      &to   = out->accessors[i];
        to.view                        = index_or_none(from.bufferView);
        to.offset                      = from.byteOffset;
        to.count                       = from.count;
        to.component                   = static_cast<assay_gltf_component>(from.componentType);
        to.normalized                  = from.normalized;
        take_shape(from.type, &to);
        if (from.sparse.isSparse) {
            to.sparse_count        = static_cast<uint64_t>(from.sparse.count);
            to.sparse_index_view   = index_or_none(from.sparse.indices.bufferView);
            to.sparse_index_offset = static_cast<uint64_t>(from.sparse.indices.byteOffset);
            to.sparse_index_component =
                static_cast<assay_gltf_component>(from.sparse.indices.componentType);
            to.sparse_value_view   = index_or_none(from.sparse.values.bufferView);
            to.sparse_value_offset = static_cast<uint64_t>(from.sparse.values.byteOffset);
        }
    }
}

// The set of "JOINTS_2" for the prefix "JOINTS_": 2; -1 for any other name.
int attribute_set(const std::string &name, const char *prefix)
{
    const size_t length = std::strlen(prefix);
    if (name.compare(0, length, prefix) != 0 || name.size() == length || name.size() > length + 4) {
        return -1;
    }
    int set = 0;
    for (size_t i = length; i < name.size(); i++) {
        if (name[i] < '0' || name[i] > '9') {
            return -1;
        }
        set = set * 10 + (name[i] - '0');
    }
    return set;
}

void take_attribute(const std::string &name, uint32_t accessor, assay_gltf_primitive *to)
{
    const int texcoord = attribute_set(name, "TEXCOORD_");
    const int joints   = attribute_set(name, "JOINTS_");
    const int weights  = attribute_set(name, "WEIGHTS_");
    if (name == "POSITION") {
        to->position = accessor;
    } else if (name == "NORMAL") {
        to->normal = accessor;
    } else if (name == "TANGENT") {
        to->tangent = accessor;
    } else if (name == "COLOR_0") {
        to->color = accessor;
    } else if (texcoord == 0 || texcoord == 1) {
        to->texcoord[texcoord] = accessor;
    } else if (joints >= 0 && joints < ASSAY_GLTF_MAX_JOINT_SETS) {
        to->joints[joints] = accessor;
    } else if (weights >= 0 && weights < ASSAY_GLTF_MAX_JOINT_SETS) {
        to->weights[weights] = accessor;
    } else if (joints >= 0 || weights >= 0) {
        to->more_joint_sets = true;
    }
}

void take_primitive(assay_context *context, const tinygltf::Primitive &from,
                    assay_gltf_primitive *to)
{
    to->indices  = index_or_none(from.indices);
    to->material = index_or_none(from.material);
    to->mode     = static_cast<uint32_t>(from.mode);
    to->position = to->normal = to->tangent = to->color = ASSAY_NONE;
    to->texcoord[0] = to->texcoord[1] = ASSAY_NONE;
    for (int set = 0; set < ASSAY_GLTF_MAX_JOINT_SETS; set++) {
        to->joints[set] = to->weights[set] = ASSAY_NONE;
    }
    for (const auto &attribute : from.attributes) {
        take_attribute(attribute.first, index_or_none(attribute.second), to);
    }
    to->targets      = make_array<assay_gltf_target>(context, from.targets.size());
    to->target_count = static_cast<uint32_t>(from.targets.size());
    for (size_t i = 0; i < from.targets.size(); i++) {
        to->targets[i] = assay_gltf_target{ASSAY_NONE, ASSAY_NONE, ASSAY_NONE};
        for (const auto &attribute : from.targets[i]) {
            const uint32_t accessor = index_or_none(attribute.second);
            if (attribute.first == "POSITION") {
                to->targets[i].position = accessor;
            } else if (attribute.first == "NORMAL") {
                to->targets[i].normal = accessor;
            } else if (attribute.first == "TANGENT") {
                to->targets[i].tangent = accessor;
            } else if (attribute.first[0] != '_') {
                to->more_target_semantics = true;
            }
        }
    }
}

void take_meshes(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->meshes     = make_array<assay_gltf_mesh>(context, model.meshes.size());
    out->mesh_count = static_cast<uint32_t>(model.meshes.size());
    for (size_t i = 0; i < model.meshes.size(); i++) {
        const tinygltf::Mesh &from = model.meshes[i];
        assay_gltf_mesh      &to   = out->meshes[i];
        to.name                    = take_name(context, from.name);
        to.primitives      = make_array<assay_gltf_primitive>(context, from.primitives.size());
        to.primitive_count = static_cast<uint32_t>(from.primitives.size());
        for (size_t k = 0; k < from.primitives.size(); k++) {
            take_primitive(context, from.primitives[k], &to.primitives[k]);
        }
        take_values(context, from.weights, &to.weights, &to.weight_count);
    }
}

template <size_t N> void take_fixed(const std::vector<double> &from, double (&to)[N])
{
    for (size_t i = 0; i < N && from.size() == N; i++) {
        to[i] = from[i];
    }
}

void take_nodes(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->nodes      = make_array<assay_node>(context, model.nodes.size());
    out->node_count = static_cast<uint32_t>(model.nodes.size());
    out->children   = make_array<assay_gltf_children>(context, model.nodes.size());
    for (size_t i = 0; i < model.nodes.size(); i++) {
        const tinygltf::Node &from = model.nodes[i];
        assay_node           &to   = out->nodes[i];
        to.name                    = take_name(context, from.name);
        to.parent = to.light = ASSAY_NONE;
        to.mesh              = index_or_none(from.mesh);
        to.skin              = index_or_none(from.skin);
        to.camera            = index_or_none(from.camera);
        to.has_matrix        = !from.matrix.empty();
        to.rotation[3]       = 1.0;
        to.scale[0] = to.scale[1] = to.scale[2] = 1.0;
        take_fixed(from.matrix, to.matrix);
        take_fixed(from.translation, to.translation);
        take_fixed(from.rotation, to.rotation);
        take_fixed(from.scale, to.scale);
        take_values(context, from.weights, &to.weights, &to.weight_count);
        take_indices(context, from.children, &out->children[i].children,
                     &out->children[i].child_count);
    }
}

void take_scenes(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->default_scene = index_or_none(model.defaultScene);
    out->scenes        = make_array<assay_gltf_scene>(context, model.scenes.size());
    out->scene_count   = static_cast<uint32_t>(model.scenes.size());
    for (size_t i = 0; i < model.scenes.size(); i++) {
        take_indices(context, model.scenes[i].nodes, &out->scenes[i].nodes,
                     &out->scenes[i].node_count);
    }
}

void take_skins(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->skins      = make_array<assay_gltf_skin>(context, model.skins.size());
    out->skin_count = static_cast<uint32_t>(model.skins.size());
    for (size_t i = 0; i < model.skins.size(); i++) {
        take_indices(context, model.skins[i].joints, &out->skins[i].joints,
                     &out->skins[i].joint_count);
        out->skins[i].inverse_bind = index_or_none(model.skins[i].inverseBindMatrices);
    }
}

bool take_channel(const tinygltf::AnimationChannel &from, assay_gltf_channel *to)
{
    static const char *const paths[] = {"translation", "rotation", "scale", "weights"};
    to->sampler                      = index_or_none(from.sampler);
    to->node                         = index_or_none(from.target_node);
    for (int path = 0; path < 4; path++) {
        if (from.target_path == paths[path]) {
            to->path = static_cast<assay_animation_path>(path);
            return to->node != ASSAY_NONE;
        }
    }
    return false;
}

void take_animations(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->animations      = make_array<assay_gltf_animation>(context, model.animations.size());
    out->animation_count = static_cast<uint32_t>(model.animations.size());
    for (size_t i = 0; i < model.animations.size(); i++) {
        const tinygltf::Animation &from = model.animations[i];
        assay_gltf_animation      &to   = out->animations[i];
        to.name                         = take_name(context, from.name);
        to.samplers      = make_array<assay_gltf_animation_sampler>(context, from.samplers.size());
        to.sampler_count = static_cast<uint32_t>(from.samplers.size());
        for (size_t k = 0; k < from.samplers.size(); k++) {
            const std::string &word      = from.samplers[k].interpolation;
            to.samplers[k].input         = index_or_none(from.samplers[k].input);
            to.samplers[k].output        = index_or_none(from.samplers[k].output);
            to.samplers[k].interpolation = word == "STEP"          ? ASSAY_INTERPOLATE_STEP
                                           : word == "CUBICSPLINE" ? ASSAY_INTERPOLATE_CUBICSPLINE
                                                                   : ASSAY_INTERPOLATE_LINEAR;
        }
        to.channels = make_array<assay_gltf_channel>(context, from.channels.size());
        for (const tinygltf::AnimationChannel &channel : from.channels) {
            to.channel_count += take_channel(channel, &to.channels[to.channel_count]) ? 1 : 0;
        }
    }
}

assay_wrap take_wrap(int code)
{
    return code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? ASSAY_WRAP_CLAMP
           : code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? ASSAY_WRAP_MIRROR
                                                           : ASSAY_WRAP_REPEAT;
}

void take_textures(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->textures      = make_array<assay_gltf_texture>(context, model.textures.size());
    out->texture_count = static_cast<uint32_t>(model.textures.size());
    for (size_t i = 0; i < model.textures.size(); i++) {
        out->textures[i].sampler = index_or_none(model.textures[i].sampler);
        out->textures[i].image   = index_or_none(model.textures[i].source);
    }
    out->samplers      = make_array<assay_gltf_sampler>(context, model.samplers.size());
    out->sampler_count = static_cast<uint32_t>(model.samplers.size());
    for (size_t i = 0; i < model.samplers.size(); i++) {
        out->samplers[i].wrap_u  = take_wrap(model.samplers[i].wrapS);
        out->samplers[i].wrap_v  = take_wrap(model.samplers[i].wrapT);
        out->samplers[i].nearest = model.samplers[i].magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
}

void take_cameras(assay_context *context, const tinygltf::Model &model, assay_gltf_document *out)
{
    out->cameras      = make_array<assay_camera_desc>(context, model.cameras.size());
    out->camera_count = static_cast<uint32_t>(model.cameras.size());
    for (size_t i = 0; i < model.cameras.size(); i++) {
        const tinygltf::Camera &from = model.cameras[i];
        assay_camera_desc      &to   = out->cameras[i];
        to.name                      = take_name(context, from.name);
        to.orthographic              = from.type == "orthographic";
        to.yfov                      = from.perspective.yfov;
        to.xmag                      = from.orthographic.xmag;
        to.ymag                      = from.orthographic.ymag;
        to.znear = to.orthographic ? from.orthographic.znear : from.perspective.znear;
        to.node  = ASSAY_NONE;
    }
}

// tinygltf calls none of these on a stripped text; its own would open files.
bool        refuse_exists(const std::string &, void *) { return false; }
std::string refuse_expand(const std::string &, void *) { return std::string(); }
bool        refuse_read(std::vector<unsigned char> *, std::string *, const std::string &, void *)
{
    return false;
}
bool refuse_write(std::string *, const std::string &, const std::vector<unsigned char> &, void *)
{
    return false;
}
bool refuse_image(tinygltf::Image *, const int, std::string *, std::string *, int, int,
                  const unsigned char *, int, void *)
{
    return false;
}

// tinygltf's JSON tree asks for memory even to release itself, and ends the process where there is
// none.  So it is only started where what it may take at most is there to be had.
void require_room(size_t text_bytes)
{
    enum { BYTES_A_CHARACTER = 32, LEAST = 1 << 16 };
    void *room = ::operator new(LEAST + text_bytes * BYTES_A_CHARACTER, std::nothrow);
    if (!room) {
        throw std::bad_alloc();
    }
    ::operator delete(room);
}

assay_status parse(assay_context *context, const char *file, const char *text, size_t count,
                   assay_gltf_document *out)
{
    tinygltf::TinyGLTF    reader;
    tinygltf::Model       model;
    std::string           error, warning;
    tinygltf::FsCallbacks callbacks = {};
    callbacks.FileExists            = refuse_exists;
    callbacks.ExpandFilePath        = refuse_expand;
    callbacks.ReadWholeFile         = refuse_read;
    callbacks.WriteWholeFile        = refuse_write;
    reader.SetFsCallbacks(callbacks);
    reader.SetImageLoader(refuse_image, nullptr);
    require_room(count);
    if (!reader.LoadASCIIFromString(&model, &error, &warning, text,
                                    static_cast<unsigned int>(count), "")) {
        if (error.find("bad_alloc") != std::string::npos) {
            throw std::bad_alloc(); // swallowed by its parser
        }
        const std::string line = error.substr(0, error.find('\n'));
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: %s", file, line.c_str());
    }
    take_views(context, model, out);
    take_accessors(context, model, out);
    take_meshes(context, model, out);
    take_nodes(context, model, out);
    take_scenes(context, model, out);
    take_skins(context, model, out);
    take_animations(context, model, out);
    take_textures(context, model, out);
    take_cameras(context, model, out);
    return ASSAY_OK;
}

} // namespace

assay_status assay_gltf_parse(assay_context *context, const char *file, const char *text,
                              size_t count, assay_gltf_document *document_out)
{
    assay_gltf_document document = {};
    assay_status        status   = ASSAY_ERR_INTERNAL;
    try {
        status = parse(context, file, text, count, &document);
    } catch (const std::bad_alloc &) {
        status = assay_fail_memory(context, "the scene's structure");
    } catch (const std::exception &problem) {
        status = assay_fail(context, ASSAY_ERR_FORMAT, "%s: %s", file, problem.what());
    } catch (...) {
        status = assay_fail(context, ASSAY_ERR_INTERNAL, "%s: an unknown exception", file);
    }
    if (status != ASSAY_OK) {
        assay_gltf_document_release(context, &document);
        return status;
    }
    *document_out = document;
    return ASSAY_OK;
}
