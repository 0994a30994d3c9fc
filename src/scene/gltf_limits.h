/* gltf_limits.h - what a scene file may ask for at most; docs/scenes.md lists the same.
 *
 * The limits bound memory and time by the size of what was read, so that a small file cannot ask
 * for a large machine. */
#ifndef ASSAY_SCENE_GLTF_LIMITS_H
#define ASSAY_SCENE_GLTF_LIMITS_H

#include <stdint.h>

#define ASSAY_GLTF_MAX_FILE_BYTES (UINT64_C(1) << 31)    /* of one file                          */
#define ASSAY_GLTF_MAX_TOTAL_BYTES (UINT64_C(1) << 32)   /* of all files and data URIs           */
#define ASSAY_GLTF_MAX_DECODED_BYTES (UINT64_C(1) << 33) /* of accessors, as decoded */
#define ASSAY_GLTF_MAX_TEXEL_BYTES (UINT64_C(1) << 32)   /* of all images, as decoded            */
#define ASSAY_GLTF_MAX_JSON_DEPTH 128                    /* objects and arrays in each other     */
#define ASSAY_GLTF_MAX_JSON_VALUES (1u << 23)            /* numbers, words, objects, arrays      */
#define ASSAY_GLTF_MAX_VERTICES (1u << 28)               /* elements of one accessor             */
#define ASSAY_GLTF_MAX_TRIANGLES (1u << 26)              /* of the scene, instances counted      */
#define ASSAY_GLTF_MAX_MORPH_WORK (UINT64_C(1) << 33) /* sum over instances, vertices * targets */
#define ASSAY_GLTF_MAX_JOINT_SETS 4                   /* JOINTS_n of a primitive              */
#define ASSAY_GLTF_MAX_WARNINGS 100
#define ASSAY_GLTF_MAX_NAME 200 /* bytes of a name that are kept */

#endif
