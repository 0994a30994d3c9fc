/* solid_mesh.c - vertices, quads, boxes and spheres.
 *
 * Everything is built by sums, products, quotients and square roots, so that the doubles (and the
 * floats rounded from them) are the same wherever IEEE 754 holds. */
#include "solid_mesh.h"

#include <stdio.h>
#include <stdlib.h>

void *tool_grow(void *array, size_t count, size_t *capacity, size_t element_size)
{
    if (count < *capacity) {
        return array;
    }
    const size_t grown = *capacity ? 2 * *capacity : 64;
    void *const  moved = realloc(array, grown * element_size);
    if (!moved) {
        fputs("make_scenes: out of memory\n", stderr);
        exit(1);
    }
    *capacity = grown;
    return moved;
}

void mesh_init(solid_mesh *mesh, bool flat) { *mesh = (solid_mesh){.flat = flat}; }

void mesh_release(solid_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->indices);
    *mesh = (solid_mesh){0};
}

uint32_t mesh_vertex(solid_mesh *mesh, assay_vec3 position, assay_vec3 normal)
{
    size_t capacity = mesh->vertex_capacity;
    mesh->positions =
        tool_grow(mesh->positions, mesh->vertex_count, &capacity, sizeof *mesh->positions);
    mesh->normals =
        tool_grow(mesh->normals, mesh->vertex_count, &mesh->vertex_capacity, sizeof *mesh->normals);
    mesh->positions[mesh->vertex_count] = position;
    mesh->normals[mesh->vertex_count]   = normal;
    return (uint32_t)mesh->vertex_count++;
}

void mesh_triangle(solid_mesh *mesh, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corners[3] = {a, b, c};
    for (int i = 0; i < 3; i++) {
        mesh->indices =
            tool_grow(mesh->indices, mesh->index_count, &mesh->index_capacity, sizeof(uint32_t));
        mesh->indices[mesh->index_count++] = corners[i];
    }
}

void mesh_quad(solid_mesh *mesh, assay_vec3 a, assay_vec3 b, assay_vec3 c, assay_vec3 d)
{
    const assay_vec3 n     = vec3_normalize(vec3_cross(vec3_sub(c, a), vec3_sub(d, b)));
    const uint32_t   first = mesh_vertex(mesh, a, n);
    mesh_vertex(mesh, b, n);
    mesh_vertex(mesh, c, n);
    mesh_vertex(mesh, d, n);
    mesh_triangle(mesh, first, first + 1, first + 2);
    mesh_triangle(mesh, first, first + 2, first + 3);
}

void mesh_box(solid_mesh *mesh, assay_vec3 low, assay_vec3 high, bool inwards)
{
    /* Corner i: bit 0 = x, bit 1 = y, bit 2 = z is high. */
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int f = 0; f < 6; f++) {
        assay_vec3 p[4];
        for (int i = 0; i < 4; i++) {
            const int corner = faces[f][inwards ? 3 - i : i];
            p[i]             = vec3(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                        corner & 4 ? high.z : low.z);
        }
        mesh_quad(mesh, p[0], p[1], p[2], p[3]);
    }
}

/* ---- icosphere ---- */

/* One unit direction a vertex; the middle of every edge is made once. */
typedef struct {
    assay_vec3 *directions;
    size_t      count, capacity;
    uint32_t   *pairs; /* 3 an entry: lower end, higher end, middle */
    size_t      pair_count, pair_capacity;
} sphere_builder;

static uint32_t sphere_vertex(sphere_builder *b, assay_vec3 direction)
{
    b->directions = tool_grow(b->directions, b->count, &b->capacity, sizeof *b->directions);
    b->directions[b->count] = vec3_normalize(direction);
    return (uint32_t)b->count++;
}

static uint32_t sphere_middle(sphere_builder *b, uint32_t i, uint32_t j)
{
    const uint32_t low = i < j ? i : j, high = i < j ? j : i;
    for (size_t k = 0; k < b->pair_count; k++) {
        if (b->pairs[3 * k] == low && b->pairs[3 * k + 1] == high) {
            return b->pairs[3 * k + 2];
        }
    }
    const uint32_t middle = sphere_vertex(b, vec3_add(b->directions[low], b->directions[high]));
    b->pairs = tool_grow(b->pairs, b->pair_count, &b->pair_capacity, 3 * sizeof(uint32_t));
    b->pairs[3 * b->pair_count]     = low;
    b->pairs[3 * b->pair_count + 1] = high;
    b->pairs[3 * b->pair_count + 2] = middle;
    b->pair_count++;
    return middle;
}

/* Replaces `count` triangles by four each. */
static uint32_t *halve_triangles(sphere_builder *b, uint32_t *triangles, size_t count)
{
    uint32_t *finer    = NULL;
    size_t    capacity = 0, made = 0;
    b->pair_count = 0;
    for (size_t t = 0; t < count; t++) {
        const uint32_t *v        = triangles + 3 * t;
        const uint32_t  ab       = sphere_middle(b, v[0], v[1]);
        const uint32_t  bc       = sphere_middle(b, v[1], v[2]);
        const uint32_t  ca       = sphere_middle(b, v[2], v[0]);
        const uint32_t  four[12] = {v[0], ab, ca, ab, v[1], bc, ca, bc, v[2], ab, bc, ca};
        for (int i = 0; i < 12; i++) {
            finer         = tool_grow(finer, made, &capacity, sizeof *finer);
            finer[made++] = four[i];
        }
    }
    free(triangles);
    return finer;
}

static const uint8_t icosahedron[20][3] = {
    {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};

void mesh_icosphere(solid_mesh *mesh, assay_vec3 centre, double radius, int levels)
{
    const double   g              = 0.5 * (1.0 + sqrt(5.0));
    sphere_builder b              = {0};
    const double   corners[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                     {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                     {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    for (int i = 0; i < 12; i++) {
        sphere_vertex(&b, vec3(corners[i][0], corners[i][1], corners[i][2]));
    }
    size_t    count = 20, capacity = 0;
    uint32_t *triangles = NULL;
    for (size_t i = 0; i < 60; i++) {
        triangles    = tool_grow(triangles, i, &capacity, sizeof *triangles);
        triangles[i] = icosahedron[i / 3][i % 3];
    }
    for (int level = 0; level < levels; level++, count *= 4) {
        triangles = halve_triangles(&b, triangles, count);
    }
    const uint32_t first = (uint32_t)mesh->vertex_count;
    for (size_t i = 0; i < b.count; i++) {
        mesh_vertex(mesh, vec3_mad(centre, radius, b.directions[i]), b.directions[i]);
    }
    for (size_t t = 0; t < count; t++) {
        mesh_triangle(mesh, first + triangles[3 * t], first + triangles[3 * t + 1],
                      first + triangles[3 * t + 2]);
    }
    free(triangles);
    free(b.directions);
    free(b.pairs);
}
