/* gltf_document.h - a glTF document as plain structs: what the adapter takes over from tinygltf.
 *
 * Indices were checked against the schema; ASSAY_NONE where the file has none.  Byte ranges,
 * lengths that must agree, and the node graph are checked by the files that use them. */
#ifndef ASSAY_SCENE_GLTF_DOCUMENT_H
#define ASSAY_SCENE_GLTF_DOCUMENT_H

#include <stddef.h>

#include "scene/gltf_limits.h"
#include "scene/scene_data.h"

#ifdef __cplusplus
extern "C" {
#endif

/* componentType of an accessor, as in the file. */
typedef enum {
    ASSAY_GLTF_BYTE           = 5120,
    ASSAY_GLTF_UNSIGNED_BYTE  = 5121,
    ASSAY_GLTF_SHORT          = 5122,
    ASSAY_GLTF_UNSIGNED_SHORT = 5123,
    ASSAY_GLTF_UNSIGNED_INT   = 5125,
    ASSAY_GLTF_FLOAT          = 5126
} assay_gltf_component;

typedef struct {
    uint32_t buffer;
    uint64_t offset, length; /* bytes                */
    uint32_t stride;         /* bytes, 0: packed     */
} assay_gltf_view;

typedef struct {
    uint32_t             view; /* ASSAY_NONE: zeros */
    uint64_t             offset, count;
    assay_gltf_component component;
    uint32_t             columns, rows; /* VEC3: 1 x 3; MAT4: 4 x 4 */
    bool                 normalized;
    uint64_t             sparse_count; /* 0: not sparse */
    uint32_t             sparse_index_view, sparse_value_view;
    uint64_t             sparse_index_offset, sparse_value_offset;
    assay_gltf_component sparse_index_component;
} assay_gltf_accessor;

typedef struct {
    uint32_t position, normal, tangent; /* accessors */
} assay_gltf_target;

typedef struct {
    uint32_t           indices, material;
    uint32_t           mode; /* 0 points ... 4 triangles, 5 strip, 6 fan */
    uint32_t           position, normal, tangent, texcoord[2], color;
    uint32_t           joints[ASSAY_GLTF_MAX_JOINT_SETS], weights[ASSAY_GLTF_MAX_JOINT_SETS];
    bool               more_joint_sets;       /* than that                             */
    bool               more_target_semantics; /* targets for other than the three above */
    assay_gltf_target *targets;
    uint32_t           target_count;
} assay_gltf_primitive;

typedef struct {
    char                 *name;
    assay_gltf_primitive *primitives;
    uint32_t              primitive_count;
    double               *weights;
    uint32_t              weight_count;
} assay_gltf_mesh;

typedef struct {
    uint32_t *nodes;
    uint32_t  node_count;
} assay_gltf_scene;

typedef struct {
    uint32_t *children;
    uint32_t  child_count;
} assay_gltf_children;

typedef struct {
    uint32_t *joints;
    uint32_t  joint_count;
    uint32_t  inverse_bind; /* accessor */
} assay_gltf_skin;

typedef struct {
    uint32_t             sampler, node;
    assay_animation_path path;
} assay_gltf_channel;

typedef struct {
    uint32_t            input, output;
    assay_interpolation interpolation;
} assay_gltf_animation_sampler;

typedef struct {
    char                         *name;
    assay_gltf_channel           *channels; /* without those that have no node */
    uint32_t                      channel_count;
    assay_gltf_animation_sampler *samplers;
    uint32_t                      sampler_count;
} assay_gltf_animation;

typedef struct {
    uint32_t sampler, image;
} assay_gltf_texture;

typedef struct {
    assay_wrap wrap_u, wrap_v;
    bool       nearest;
} assay_gltf_sampler;

typedef struct {
    assay_gltf_view      *views;
    assay_gltf_accessor  *accessors;
    assay_gltf_mesh      *meshes;
    assay_gltf_scene     *scenes;
    assay_node           *nodes;    /* parent and light unset */
    assay_gltf_children  *children; /* one a node             */
    assay_gltf_skin      *skins;
    assay_gltf_animation *animations;
    assay_gltf_texture   *textures;
    assay_gltf_sampler   *samplers;
    assay_camera_desc    *cameras; /* node unset */
    uint32_t view_count, accessor_count, mesh_count, scene_count, node_count, skin_count,
        animation_count, texture_count, sampler_count, camera_count;
    uint32_t default_scene; /* or ASSAY_NONE */
} assay_gltf_document;

/* Releases everything that is left in it; what was moved out must have been set to NULL. */
void assay_gltf_document_release(assay_context *context, assay_gltf_document *document);

/* gltf_adapter.cpp: parses a checked text with tinygltf, which sees no buffers, images, materials,
 * extras and extensions and opens no file.  Errors: FORMAT with tinygltf's words, MEMORY. */
assay_status assay_gltf_parse(assay_context *context, const char *file, const char *text,
                              size_t count, assay_gltf_document *document_out);

/* A copy of a name for messages and reports: one line, valid UTF-8, at most ASSAY_GLTF_MAX_NAME
 * bytes; NULL when memory is refused. */
char *assay_gltf_copy_name(assay_context *context, const char *name);

#ifdef __cplusplus
}
#endif

#endif
