/* writer_document.h - the inside of a document; for gltf_writer.c and writer_json.c alone. */
#ifndef ASSAY_SCENES_WRITER_DOCUMENT_H
#define ASSAY_SCENES_WRITER_DOCUMENT_H

#include "gltf_writer.h"

/* Buffer views, in the order in which they lie in the .bin file. */
typedef enum {
    GLTF_VIEW_VECTORS, /* positions, normals, displacements: 3 floats */
    GLTF_VIEW_WEIGHTS, /* 4 floats                                    */
    GLTF_VIEW_JOINTS,  /* 4 bytes                                     */
    GLTF_VIEW_KEYS,    /* key frames and matrices: floats             */
    GLTF_VIEW_INDICES, /* 16 bits                                     */
    GLTF_VIEW_COUNT
} gltf_view;

typedef struct {
    uint8_t *bytes;
    size_t   size, capacity;
} gltf_view_bytes;

typedef struct {
    gltf_view   view;
    size_t      offset, count;
    const char *type;
    bool        is_u16, is_u8; /* neither: float */
    int         bound_count;   /* components of min and max that are written */
    float       low[4], high[4];
} gltf_accessor;

typedef struct {
    const char *name;
    int         material, position, normal, indices, morph, joints, weights;
    double      morph_weight;
} gltf_mesh;

typedef struct {
    gltf_node node;
    char      name[48];
} gltf_stored_node;

typedef struct {
    const char *name;
    double      yfov, xmag, ymag; /* yfov 0: orthographic */
} gltf_camera;

typedef struct {
    const char *name;
    double      color[3], intensity;
} gltf_light;

typedef struct {
    int                node;
    gltf_path          path;
    gltf_interpolation interpolation;
    int                input, output;
} gltf_channel;

typedef struct {
    int    joints[4], inverse_bind;
    size_t joint_count;
} gltf_skin;

struct gltf_document {
    const char       *name, *description;
    gltf_view_bytes   views[GLTF_VIEW_COUNT];
    gltf_accessor    *accessors;
    gltf_material    *materials;
    gltf_mesh        *meshes;
    gltf_stored_node *nodes;
    gltf_camera      *cameras;
    gltf_light       *lights;
    gltf_channel     *channels;
    gltf_skin        *skins;
    size_t accessor_count, material_count, mesh_count, node_count, camera_count, light_count,
        channel_count, skin_count;
    size_t accessor_capacity, material_capacity, mesh_capacity, node_capacity, camera_capacity,
        light_capacity, channel_capacity, skin_capacity;
};

#endif
