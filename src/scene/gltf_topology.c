/* gltf_topology.c - lists, strips and fans, with and without indices, into triangles over the
 * vertices that they use.
 *
 * Invariant: every index that comes out is below the number of vertices that are used, and those
 * are listed in the order of the file. */
#include "scene/gltf_topology.h"

#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"

enum { MODE_LIST = 4, MODE_STRIP = 5, MODE_FAN = 6 };

/* Corners of triangle i as positions in the sequence of indices (glTF 2.0, 3.7.2.1). */
static void corners_of(uint32_t mode, uint64_t i, uint64_t corner[3])
{
    switch (mode) {
    case MODE_STRIP:
        corner[0] = i;
        corner[1] = i + 1 + i % 2;
        corner[2] = i + 2 - i % 2;
        break;
    case MODE_FAN:
        corner[0] = i + 1;
        corner[1] = i + 2;
        corner[2] = 0;
        break;
    default:
        corner[0] = 3 * i;
        corner[1] = 3 * i + 1;
        corner[2] = 3 * i + 2;
    }
}

static assay_status count_triangles(const assay_gltf_loader    *loader,
                                    const assay_gltf_primitive *from, const char *place,
                                    uint64_t corner_count, uint32_t *count_out)
{
    const bool     list  = from->mode == MODE_LIST;
    const uint64_t count = list ? corner_count / 3 : corner_count - 2;
    if (corner_count < 3 || (list && corner_count % 3 != 0)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: %llu %s make no whole triangles",
                               place, (unsigned long long)corner_count,
                               from->indices == ASSAY_NONE ? "vertices" : "indices");
    }
    if (count > ASSAY_GLTF_MAX_TRIANGLES) {
        return assay_gltf_fail(loader, ASSAY_ERR_LIMIT,
                               "%s: has %llu triangles, at most %u are read", place,
                               (unsigned long long)count, ASSAY_GLTF_MAX_TRIANGLES);
    }
    *count_out = (uint32_t)count;
    return ASSAY_OK;
}

/* The sequence of the file; *sequence_out NULL where there are no indices. */
static assay_status read_sequence(assay_gltf_loader *loader, const assay_gltf_primitive *from,
                                  const char *place, uint64_t vertex_count, uint32_t **sequence_out)
{
    if (from->indices == ASSAY_NONE) {
        return ASSAY_OK;
    }
    const assay_gltf_accessor *a   = &loader->document.accessors[from->indices];
    assay_gltf_use             use = {.columns = 1, .rows = 1, .whole = true};
    snprintf(use.place, sizeof use.place, "%.60s: accessor %u (indices)", place, from->indices);
    const uint32_t restart = a->component == ASSAY_GLTF_UNSIGNED_BYTE    ? UINT8_MAX
                             : a->component == ASSAY_GLTF_UNSIGNED_SHORT ? UINT16_MAX
                                                                         : UINT32_MAX;
    assay_status   status  = assay_gltf_check_accessor(loader, from->indices, &use);
    if (status == ASSAY_OK) {
        status = assay_gltf_read_whole(loader, from->indices, &use, NULL, (uint32_t)a->count, 1, 0,
                                       sequence_out);
    }
    for (uint64_t i = 0; i < a->count && status == ASSAY_OK; i++) {
        const uint32_t index = (*sequence_out)[i];
        if (index >= vertex_count || index == restart) {
            status = assay_gltf_fail(
                loader, ASSAY_ERR_FORMAT, "%s: index %llu is %u, but there are %llu vertices",
                use.place, (unsigned long long)i, index, (unsigned long long)vertex_count);
        }
    }
    return status;
}

static assay_status make_triangles(assay_gltf_loader *loader, const assay_gltf_primitive *from,
                                   const uint32_t *sequence, assay_gltf_topology *out)
{
    const assay_status status = assay_gltf_count_decoded(loader, out->triangle_count, 12);
    if (status != ASSAY_OK) {
        return status;
    }
    out->indices = assay_allocate(loader->context, (size_t)out->triangle_count * 3, 4);
    if (!out->indices) {
        return assay_fail_memory(loader->context, "the triangles of a mesh");
    }
    for (uint32_t i = 0; i < out->triangle_count; i++) {
        uint64_t corner[3];
        corners_of(from->mode, i, corner);
        for (int k = 0; k < 3; k++) {
            out->indices[(size_t)i * 3 + (size_t)k] =
                sequence ? sequence[corner[k]] : (uint32_t)corner[k];
        }
    }
    return ASSAY_OK;
}

/* Drops the vertices that no triangle uses: primitives often share one large vertex array. */
static assay_status choose_vertices(assay_gltf_loader *loader, uint32_t vertex_count,
                                    assay_gltf_topology *out)
{
    const size_t index_count = (size_t)out->triangle_count * 3;
    uint32_t    *place_of    = NULL;
    assay_status status      = assay_gltf_count_decoded(loader, vertex_count, 4);
    if (status != ASSAY_OK) {
        return status;
    }
    place_of = assay_allocate(loader->context, vertex_count, sizeof *place_of);
    if (!place_of) {
        return assay_fail_memory(loader->context, "the vertices of a mesh");
    }
    for (size_t i = 0; i < index_count; i++) {
        place_of[out->indices[i]] = 1;
    }
    uint32_t used = 0;
    for (uint32_t v = 0; v < vertex_count; v++) {
        used += place_of[v];
    }
    out->vertex_count = used;
    if (used < vertex_count) {
        out->chosen = assay_allocate(loader->context, used, sizeof *out->chosen);
        if (!out->chosen) {
            assay_release(loader->context, place_of);
            return assay_fail_memory(loader->context, "the vertices of a mesh");
        }
        uint32_t next = 0;
        for (uint32_t v = 0; v < vertex_count; v++) {
            if (place_of[v]) {
                out->chosen[next] = v;
                place_of[v]       = next++;
            }
        }
        for (size_t i = 0; i < index_count; i++) {
            out->indices[i] = place_of[out->indices[i]];
        }
    }
    assay_release(loader->context, place_of);
    return ASSAY_OK;
}

assay_status assay_gltf_read_topology(assay_gltf_loader *loader, const assay_gltf_primitive *from,
                                      const char *place, assay_gltf_topology *topology_out)
{
    const assay_gltf_accessor *accessors    = loader->document.accessors;
    const uint64_t             vertex_count = accessors[from->position].count;
    const uint64_t             corner_count =
        from->indices == ASSAY_NONE ? vertex_count : accessors[from->indices].count;
    assay_gltf_topology topology = {0};
    uint32_t           *sequence = NULL;
    assay_status        status   = read_sequence(loader, from, place, vertex_count, &sequence);
    if (status == ASSAY_OK) {
        status = count_triangles(loader, from, place, corner_count, &topology.triangle_count);
    }
    if (status == ASSAY_OK) {
        status = make_triangles(loader, from, sequence, &topology);
    }
    if (status == ASSAY_OK) {
        status = choose_vertices(loader, (uint32_t)vertex_count, &topology);
    }
    assay_release(loader->context, sequence);
    if (status != ASSAY_OK) {
        assay_release(loader->context, topology.indices);
        assay_release(loader->context, topology.chosen);
        return status;
    }
    *topology_out = topology;
    return ASSAY_OK;
}
