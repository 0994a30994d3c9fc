/* gltf_everything.h - a small sound glTF file with something of everything in it, for tests that
 * break it in one place. */
#ifndef ASSAY_TESTS_GLTF_EVERYTHING_H
#define ASSAY_TESTS_GLTF_EVERYTHING_H

#include <stdint.h>

/* All that is binary in it: a triangle (skinned), its normals, two keys of time, moves, turns and
 * morph weights. */
typedef struct {
    float positions[9], normals[9], times[2], moves[6], turns[8], weights[12], bind[16], morph[2];
    uint16_t indices[3];
    uint8_t  joints[12];
} gltf_content;

extern const gltf_content gltf_sound_content;

/* The file with this content.  Release with free.
 *
 * Accessors: 0 positions, 1 normals, 2 indices, 3 joints, 4 weights, 5 bind, 6 times, 7 moves,
 * 8 turns, 9 morph weights, 10 sparse; views have the numbers of their accessors.  Nodes: 0 "hips"
 * (skinned mesh), 1 "bone", 2 its child (morphed mesh, camera), 3 (matrix, spot light). */
char *gltf_everything(const gltf_content *content);

#endif
