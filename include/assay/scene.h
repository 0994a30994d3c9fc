/* scene.h - a glTF scene, loaded, checked and evaluated at a time.
 *
 * What of glTF 2.0 is supported, and every choice where the specification leaves one, is in
 * docs/scenes.md. */
#ifndef ASSAY_SCENE_H
#define ASSAY_SCENE_H

#include <stdint.h>

#include "assay/context.h"
#include "assay/types.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct assay_scene assay_scene;

typedef struct {
    int         scene_index;        /* which glTF scene; -1: the file's default, else 0          */
    const char *environment_path;   /* latitude-longitude map (.exr or .hdr), or NULL            */
    double      environment_scale;  /* radiance multiplier, finite, >= 0                         */
    double    environment_rotation; /* radians about +Y, counter-clockwise seen from above       */
    assay_rgb background;           /* constant radiance of rays that leave the scene; used only
                                       where there is no environment map; finite, >= 0          */
    bool force_diffuse;             /* every surface a two-sided Lambertian of its base colour   */
    bool solid_transmission;        /* transmissive materials without KHR_materials_volume are
                                       taken as solid (refracting) instead of thin-walled        */
} assay_scene_options;

/* Defaults: scene -1, no environment, scale 1, rotation 0, black, false, false. */
ASSAY_API assay_scene_options assay_scene_options_default(void);

/* Loads a .gltf or .glb file with everything it refers to, and evaluates it at time 0.
 * options may be NULL.  Errors: NOT_FOUND, FORMAT, UNSUPPORTED, LIMIT, MEMORY, ARGUMENT,
 * CANCELLED; the message names the file and the thing in it. */
ASSAY_API assay_status assay_scene_load(assay_context *context, const char *path,
                                        const assay_scene_options *options,
                                        assay_scene              **scene_out);
ASSAY_API void         assay_scene_destroy(assay_scene *scene);

/* Evaluates animations, skins and morph targets at a time (s).  Where an animation does not reach,
 * its nearest key frame holds.  On error the scene may only be destroyed.
 * Errors: DOMAIN (not finite), FORMAT (geometry no longer finite), MEMORY. */
ASSAY_API assay_status assay_scene_set_time(assay_scene *scene, double seconds);

/* What was loaded. Strings are borrowed from the scene. */
typedef struct {
    uint32_t triangles, vertices; /* after instancing, of the current time                       */
    uint32_t meshes;              /* distinct glTF meshes                                        */
    uint32_t instances;           /* glTF nodes of the scene with a mesh                         */
    uint32_t materials, textures, images, nodes, skins, animations, cameras;
    uint32_t point_lights, spot_lights, directional_lights, emissive_triangles;
    bool     has_environment;
    bool     has_light; /* anything at all that emits, the background included                */
    double   duration;  /* s, of the longest animation; 0 without                             */
    assay_vec3 bounds_min, bounds_max; /* m; all zero where there is no triangle */
    uint32_t   warnings;
} assay_scene_info;

ASSAY_API assay_scene_info assay_scene_describe(const assay_scene *scene);
ASSAY_API const char      *assay_scene_camera_name(const assay_scene *scene, uint32_t index);
ASSAY_API const char      *assay_scene_warning(const assay_scene *scene, uint32_t index);

/* SHA-256 in hexadecimal of all files that the scene was read from, in the order of their reading,
 * and of the options.  Borrowed. */
ASSAY_API const char *assay_scene_digest(const assay_scene *scene);
/* The same of the glTF file, its buffers and images alone, whatever the options.  Borrowed. */
ASSAY_API const char *assay_scene_files_digest(const assay_scene *scene);

/* The whole report as a JSON text; release it with assay_text_destroy.  Errors: MEMORY. */
ASSAY_API assay_status assay_scene_report_json(const assay_scene *scene, char **text_out);

#ifdef __cplusplus
}
#endif
#endif
