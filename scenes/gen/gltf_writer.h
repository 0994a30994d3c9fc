/* gltf_writer.h - a glTF 2.0 document in memory, and its two files: NAME.gltf and NAME.bin.
 *
 * The same calls write the same bytes on every machine: numbers are formatted with nine significant
 * digits (which bring a float back exactly), arrays are little-endian.  An exhausted memory or a
 * misuse ends the program: this is a build tool, not part of the library. */
#ifndef ASSAY_SCENES_GLTF_WRITER_H
#define ASSAY_SCENES_GLTF_WRITER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "solid_mesh.h"

typedef struct gltf_document gltf_document;

/* name: of the folder and both files.  description: written into asset.extras. */
gltf_document *gltf_create(const char *name, const char *description);
void           gltf_destroy(gltf_document *document);

/* Writes DIRECTORY/NAME/NAME.gltf and .bin and makes the folder where it is missing.  False with
 * errno set when that fails. */
bool gltf_write(const gltf_document *document, const char *directory);

/* ---- materials ---- */

typedef struct {
    const char *name;     /* borrowed until gltf_write                                        */
    double base_color[3]; /* linear Rec. 709                                                  */
    double metallic, roughness;
    double specular;          /* KHR_materials_specular; 0 turns the dielectric coat off      */
    double emissive[3];       /* factor, [0, 1]                                               */
    double emissive_strength; /* radiance = factor * strength, W/(m2 sr)                      */
    bool   double_sided;
    double transmission; /* KHR_materials_transmission, [0, 1]                                */
    double ior;
    bool   solid; /* KHR_materials_volume: refraction at a closed surface                    */
    const char *extras; /* the value of "extras" as JSON text, or NULL */
} gltf_material;

/* A plain Lambertian reflector: metallic 0, roughness 1, no specular term. */
gltf_material gltf_lambertian(const char *name, double r, double g, double b);

/* Returns its index; so do the functions below. */
int gltf_add_material(gltf_document *document, gltf_material material);

/* ---- meshes: one primitive each ---- */

int gltf_add_mesh(gltf_document *document, const char *name, const solid_mesh *mesh, int material);

/* The same geometry (the same accessors) with another material. */
int gltf_add_mesh_like(gltf_document *document, const char *name, int mesh, int material);

/* Gives the mesh one morph target: a displacement (m) a vertex. */
void gltf_add_morph_target(gltf_document *document, int mesh, const assay_vec3 *displacements,
                           size_t count, double weight);

/* Binds every vertex to two joints with weights 1 - w and w. */
void gltf_bind_to_joints(gltf_document *document, int mesh, const double *weights, size_t count);

/* ---- nodes ---- */

typedef enum { GLTF_IDENTITY, GLTF_TRS, GLTF_MATRIX } gltf_transform;

typedef struct {
    const char    *name;                              /* copied, at most 47 bytes      */
    int            parent, mesh, camera, light, skin; /* -1: none */
    gltf_transform transform;
    assay_vec3     translation; /* m                      */
    double         rotation[4]; /* unit quaternion x y z w, TRS only */
    assay_vec3     axes[3];     /* columns of the linear part, MATRIX only */
} gltf_node;

/* No mesh, no parent, identity. */
gltf_node gltf_node_default(const char *name);
int       gltf_add_node(gltf_document *document, gltf_node node);
int       gltf_add_mesh_node(gltf_document *document, const char *name, int mesh, assay_vec3 at);

/* ---- cameras and lights ---- */

/* A camera at `eye` (m) that looks at `target`, +Y up; fields of view in radians. */
int gltf_add_perspective(gltf_document *document, const char *name, double yfov, assay_vec3 eye,
                         assay_vec3 target);
/* xmag, ymag: half width and half height of what is seen, m. */
int gltf_add_orthographic(gltf_document *document, const char *name, double xmag, double ymag,
                          assay_vec3 eye, assay_vec3 target);

/* A directional light (KHR_lights_punctual) that shines along `direction`; irradiance on a facing
 * plane, W/m2, is color * intensity. */
int gltf_add_sun(gltf_document *document, const char *name, const double color[3], double intensity,
                 assay_vec3 direction);

/* ---- animation: all channels of a document form one animation ---- */

typedef enum { GLTF_LINEAR, GLTF_STEP, GLTF_CUBICSPLINE } gltf_interpolation;
typedef enum { GLTF_TRANSLATION, GLTF_ROTATION, GLTF_SCALE, GLTF_WEIGHTS } gltf_path;

/* values: key_count * width numbers (width 3, 4, 3, 1 by path), three times that for CUBICSPLINE.
 */
void gltf_add_channel(gltf_document *document, int node, gltf_path path,
                      gltf_interpolation interpolation, const float *times, size_t key_count,
                      const float *values);

/* A skin of joints; inverse_bind: the translation of each (m), the bind pose being unrotated. */
int gltf_add_skin(gltf_document *document, const int *joints, const assay_vec3 *inverse_bind,
                  size_t count);

#endif
