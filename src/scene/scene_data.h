/* scene_data.h - the inside of a scene: what the file said, and what it amounts to at a time.
 *
 * The document (nodes, meshes, skins, animations) is written once by the loader.  The geometry is
 * evaluated from it by assay_scene_set_time: every instance flattened to world space, positions
 * rounded once to float, so that a triangle is the same nine floats for everyone. */
#ifndef ASSAY_SCENE_DATA_H
#define ASSAY_SCENE_DATA_H

#include "assay/scene.h"
#include "math/vec.h"
#include "scene/material.h"
#include "scene/transform.h"

/* ---- document ---- */

typedef struct {
    float *positions; /* 3 a vertex, displacement, or NULL */
    float *normals;   /* 3 a vertex, or NULL               */
    float *tangents;  /* 3 a vertex, or NULL               */
} assay_morph_target;

/* One glTF primitive made of triangles; vertex arrays in the mesh's own frame.  Strips, fans and
 * missing indices are already turned into indexed triangles. */
typedef struct {
    uint32_t  vertex_count, triangle_count;
    uint32_t *indices;   /* 3 a triangle                                             */
    float    *positions; /* 3 a vertex                                               */
    float    *normals;   /* 3 a vertex; NULL: flat                                   */
    float    *tangents;  /* 4 a vertex, w = sign of the bitangent; or NULL           */
    float    *uv[2];     /* 2 a vertex, or NULL                                      */
    float    *colors;    /* 4 a vertex, linear RGBA (COLOR_0), or NULL               */
    uint16_t *joints;    /* 4 * joint_sets a vertex, or NULL                         */
    float    *weights;   /* likewise, >= 0, sum > 0; divided by the sum when used    */
    uint32_t  joint_sets;
    uint32_t  material; /* index into the scene's materials (the default material of
                           glTF is its last)                                         */
    assay_morph_target *targets;
    uint32_t            target_count;
} assay_primitive;

typedef struct {
    char            *name;
    assay_primitive *primitives;
    uint32_t         primitive_count;
    double          *weights; /* default morph weights */
    uint32_t         weight_count;
} assay_mesh;

typedef struct {
    char    *name;
    uint32_t parent; /* ASSAY_NONE for a root; parents need not come before children */
    uint32_t mesh, skin, camera, light; /* or ASSAY_NONE                             */
    bool     has_matrix;
    bool     in_scene;   /* reachable from the chosen glTF scene              */
    double   matrix[16]; /* column-major, where has_matrix                    */
    double   translation[3], rotation[4] /* x y z w */, scale[3];
    double  *weights; /* morph weights of this node, or NULL               */
    uint32_t weight_count;
    uint32_t first_weight; /* of the current ones, in the scene's morph_weights */
    uint32_t target_count; /* morph targets of its mesh                         */
} assay_node;

typedef struct {
    uint32_t *joints;       /* nodes */
    double   *inverse_bind; /* 16 a joint, column-major; NULL: identities */
    uint32_t  joint_count;
    uint32_t  first_matrix; /* of the current ones, in the scene's joint_matrices */
} assay_skin;

typedef enum {
    ASSAY_PATH_TRANSLATION,
    ASSAY_PATH_ROTATION,
    ASSAY_PATH_SCALE,
    ASSAY_PATH_WEIGHTS
} assay_animation_path;

typedef enum {
    ASSAY_INTERPOLATE_LINEAR,
    ASSAY_INTERPOLATE_STEP,
    ASSAY_INTERPOLATE_CUBICSPLINE
} assay_interpolation;

/* One animated property. values: key_count * width numbers, three times that for CUBICSPLINE
 * (in-tangent, value, out-tangent). */
typedef struct {
    uint32_t             node;
    assay_animation_path path;
    assay_interpolation  interpolation;
    uint32_t             key_count, width;
    double              *times; /* s, strictly increasing */
    double              *values;
} assay_channel_track;

typedef struct {
    char                *name;
    assay_channel_track *tracks;
    uint32_t             track_count;
    double               duration; /* s */
} assay_animation;

typedef struct {
    char    *name;
    bool     orthographic;
    double   yfov;       /* rad                                  */
    double   xmag, ymag; /* m, half width and height             */
    double   znear;      /* m; nothing is clipped, kept for the report */
    uint32_t node;
} assay_camera_desc;

typedef enum { ASSAY_LIGHT_POINT, ASSAY_LIGHT_SPOT, ASSAY_LIGHT_DIRECTIONAL } assay_punctual_kind;

typedef struct {
    char               *name;
    assay_punctual_kind kind;
    assay_rgb           intensity; /* color * intensity: W/sr (point, spot), W/m2 (directional) */
    double              range;     /* m, INFINITY without                                       */
    double              inner_cone, outer_cone; /* rad                                          */
} assay_light_desc;

/* ---- evaluated ---- */

/* What a hit asks of a vertex, side by side: 32 bytes, so that a triangle is read from three places
 * of memory and not from nine. */
typedef struct {
    float position[3]; /* world, m                                    */
    float normal[3];   /* world, unit; 0 where the shape has none     */
    float uv[2];       /* the first set; 0 where the shape has none   */
} assay_world_vertex;

/* A primitive of a node: a run of triangles and vertices with one material. */
typedef struct {
    uint32_t               first_triangle, triangle_count;
    uint32_t               first_vertex, vertex_count;
    uint32_t               node, mesh, primitive_index;
    const assay_primitive *primitive; /* uv and colors come from here                      */
    uint32_t               material;
    float                 *normals;  /* 3 a vertex, world, unit; NULL: flat               */
    float                 *tangents; /* 4 a vertex, world; NULL: none                     */
    bool                   flipped;  /* the node mirrors: the winding in `indices` is
                                        already turned, so that fronts stay fronts        */
} assay_shape;

/* A punctual light in the world. */
typedef struct {
    assay_punctual_kind kind;
    assay_vec3          position;  /* m                                                  */
    assay_vec3          direction; /* unit, the way the light shines                     */
    assay_rgb           intensity;
    double              range, cos_inner, cos_outer;
} assay_punctual_light;

/* A camera in the world; right, up, and -forward are the rows of a rotation. */
typedef struct {
    const char *name;
    assay_vec3  position, right, up, forward; /* unit, orthogonal */
    bool        orthographic;
    double      yfov, xmag, ymag;
    double      tan_half_yfov; /* every ray asks for it */
} assay_camera;

/* Latitude-longitude radiance, already scaled; see scene/environment.h. */
typedef struct assay_environment assay_environment;

struct assay_scene {
    assay_context      *context;
    char               *path;
    assay_scene_options options;
    char                digest[65];             /* of all files and the options           */
    char                files_digest[65];       /* of the glTF file, buffers and images   */
    char                environment_digest[65]; /* of the environment map; "" without one */
    bool                is_static;      /* no animation: every time looks the same           */
    bool                camera_is_made; /* the only camera is one that frames the scene      */
    bool                warnings_lost;  /* memory was refused for one                        */

    assay_texture_image *images;
    assay_texture       *textures;
    assay_material      *materials;
    assay_mesh          *meshes;
    assay_node          *nodes;
    assay_skin          *skins;
    assay_animation     *animations;
    assay_camera_desc   *cameras;
    assay_light_desc    *lights;
    uint32_t image_count, texture_count, material_count, mesh_count, node_count, skin_count,
        animation_count, camera_count, light_count;
    uint32_t warning_count, extension_count;
    uint32_t instance_count; /* nodes in the scene with a mesh             */
    char   **warnings;
    char   **extensions; /* extensionsUsed of the file, the first few  */
    size_t   warning_capacity;

    assay_environment *environment; /* NULL: the constant options.background */

    uint32_t *node_order; /* all nodes, parents before children */

    /* scratch of an evaluation */
    assay_pose   *poses;          /* node_count: animated T, R, S            */
    assay_affine *node_worlds;    /* node_count                              */
    double       *morph_weights;  /* first_weight of each node and on        */
    assay_affine *joint_matrices; /* first_matrix of each skin and on        */

    /* at `time` */
    double                time;
    assay_shape          *shapes;
    float                *positions;      /* vertex_count * 3, world, m                         */
    uint32_t             *indices;        /* triangle_count * 3, into positions                 */
    assay_world_vertex   *vertices;       /* vertex_count: the same again, and more             */
    uint32_t             *triangle_shape; /* triangle_count                                     */
    assay_punctual_light *punctual;
    assay_camera         *world_cameras;
    uint32_t              shape_count, vertex_count, triangle_count, punctual_count;
    uint32_t              world_camera_count; /* at least 1: one that frames the scene if none  */
    assay_vec3            bounds_min, bounds_max;
};

/* Records a warning (kept for the report, and logged). */
void assay_scene_warn(assay_scene *scene, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Textures: rgba in [0, 1] at uv; srgb: decode R, G, B before filtering. */
void assay_texture_sample(const assay_scene *scene, const assay_texture_ref *ref,
                          const double uv[2], bool srgb, double rgba_out[4]);

/* Sends for the texel at uv, so that it is near when it is sampled; ref has a texture. */
void assay_texture_prefetch(const assay_scene *scene, const assay_texture_ref *ref,
                            const double uv[2]);

#endif
