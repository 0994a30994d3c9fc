/* gltf_topology.h - the triangles of a glTF primitive. */
#ifndef ASSAY_SCENE_GLTF_TOPOLOGY_H
#define ASSAY_SCENE_GLTF_TOPOLOGY_H

#include "scene/gltf_loader.h"

typedef struct {
    uint32_t  triangle_count, vertex_count;
    uint32_t *indices; /* 3 a triangle, below vertex_count                                      */
    uint32_t *chosen;  /* the file's vertices that are used, ascending; NULL: all, in order     */
} assay_gltf_topology;

/* Reads a primitive of triangles whose POSITION accessor was checked.  Release both arrays.
 * Errors: FORMAT (index out of range, no whole triangles), LIMIT, MEMORY. */
assay_status assay_gltf_read_topology(assay_gltf_loader *loader, const assay_gltf_primitive *from,
                                      const char *place, assay_gltf_topology *topology_out);

#endif
