/* bench_raster.c - a hemisphere rasterised onto one plane against as many rays.
 *
 *     bench_raster [SCENE.gltf ...]      without a scene: halls of spheres with 1K to 650K
 * triangles, the colonnade, and Sponza if it is there
 *
 * From the same points, which a camera sees, hemispheres of 4096 samples are gathered in both ways
 * by turns on one thread, timed by that thread's processor time: what is seen alone, and with its
 * direct light by shadow rays and, for the raster, by shadow maps.  A figure is the median over the
 * points of the rays' time divided by the raster's: above 1 the raster is faster. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "assay/scene.h"
#include "bench/bench.h"
#include "core/numerics.h"
#include "gather/gather.h"
#include "gather/shadow_map.h"
#include "trace/path_trace.h"
#include "trace/visible_point.h"

enum { SIDE = 64, POINTS = 24, WAYS = 5 };

typedef struct {
    const assay_world       *world;
    const assay_shadow_maps *maps;
    assay_ray_counts         counts;
} bench;

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return values[count / 2];
}

/* ---- halls ---- */

/* Writes numbers to a buffer file and their shape to a glTF. */
typedef struct {
    float    *positions;
    unsigned *indices;
    unsigned  vertices, triangles;
} mesh;

static void add_vertex(mesh *m, double x, double y, double z)
{
    float *p = m->positions + (size_t)3 * m->vertices++;
    p[0]     = (float)x;
    p[1]     = (float)y;
    p[2]     = (float)z;
}

static void add_triangle(mesh *m, unsigned a, unsigned b, unsigned c)
{
    unsigned *t = m->indices + (size_t)3 * m->triangles++;
    t[0]        = a;
    t[1]        = b;
    t[2]        = c;
}

/* n rings of 2 n: 4 n (n - 1) triangles. */
static void add_sphere(mesh *m, double x, double y, double z, double radius, int n)
{
    const unsigned first = m->vertices;
    for (int j = 0; j <= n; j++) {
        for (int i = 0; i < 2 * n; i++) {
            const assay_sincos theta = assay_sincos_turns(0.5 * j / n);
            const assay_sincos phi   = assay_sincos_turns(0.5 * i / n);
            add_vertex(m, x + radius * theta.sin * phi.cos, y + radius * theta.cos,
                       z + radius * theta.sin * phi.sin);
        }
    }
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < 2 * n; i++) {
            const unsigned a   = first + (unsigned)(j * 2 * n + i);
            const unsigned b   = first + (unsigned)(j * 2 * n + (i + 1) % (2 * n));
            const unsigned row = (unsigned)(2 * n);
            if (j > 0) {
                add_triangle(m, a, b, a + row);
            }
            if (j < n - 1) {
                add_triangle(m, b, b + row, a + row);
            }
        }
    }
}

static void add_hall(mesh *m, double x, double y, double z)
{
    static const unsigned faces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    const unsigned        first       = m->vertices;
    for (int i = 0; i < 8; i++) {
        add_vertex(m, i & 4 ? x : -x, i & 2 ? y : 0.0, i & 1 ? z : -z);
    }
    for (int f = 0; f < 6; f++) {
        add_triangle(m, first + faces[f][0], first + faces[f][1], first + faces[f][2]);
        add_triangle(m, first + faces[f][0], first + faces[f][2], first + faces[f][3]);
    }
}

static void save(const mesh *m, const char *folder, char *path, size_t size)
{
    char         name[256];
    const size_t positions = sizeof(float) * 3 * m->vertices;
    const size_t indices   = sizeof(unsigned) * 3 * m->triangles;
    snprintf(name, sizeof name, "%s/hall.bin", folder);
    FILE *bin = fopen(name, "wb");
    snprintf(path, size, "%s/hall.gltf", folder);
    FILE *json = fopen(path, "w");
    if (!bin || !json) {
        bench_stop("cannot write a scene");
    }
    fwrite(m->positions, 1, positions, bin);
    fwrite(m->indices, 1, indices, bin);
    fclose(bin);
    fprintf(json,
            "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\"],"
            "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
            "\"intensity\":100}]}},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2]}],"
            "\"nodes\":[{\"mesh\":0},{\"translation\":[1,5,2],\"extensions\":{"
            "\"KHR_lights_punctual\":{\"light\":0}}},{\"camera\":0,\"translation\":[0,3,7]}],"
            "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.1}}],"
            "\"materials\":[{\"doubleSided\":true}],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
            "\"material\":0}]}],\"buffers\":[{\"uri\":\"hall.bin\",\"byteLength\":%zu}],"
            "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,"
            "\"byteLength\":%zu}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
            "\"count\":%u,\"type\":\"VEC3\",\"min\":[-8,0,-8],\"max\":[8,6,8]},"
            "{\"bufferView\":1,\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}]}",
            positions + indices, positions, positions, indices, m->vertices, 3 * m->triangles);
    fclose(json);
}

/* 8 x 8 spheres with n rings in a hall of 16 x 6 x 16 m. */
static void write_hall(int n, const char *folder, char *path, size_t size)
{
    const size_t vertices = 8 + 64 * (size_t)(2 * n * (n + 1));
    const size_t most     = 12 + 64 * (size_t)(4 * n * (n - 1));
    mesh         m        = {.positions = malloc(vertices * 3 * sizeof(float)),
                             .indices   = malloc(most * 3 * sizeof(unsigned))};
    if (!m.positions || !m.indices) {
        bench_stop("out of memory");
    }
    add_hall(&m, 8.0, 6.0, 8.0);
    for (int i = 0; i < 64; i++) {
        add_sphere(&m, 1.8 * (i % 8 - 3.5), 0.5 + 0.4 * (i * 7 % 9), 1.8 * (i / 8 - 3.5), 0.5, n);
    }
    save(&m, folder, path, size);
    free(m.positions);
    free(m.indices);
}

/* ---- gathering ---- */

static assay_rgb nothing(void *user, int cell, assay_vertex *vertex, assay_random *random,
                         int worker)
{
    (void)user;
    (void)cell;
    (void)vertex;
    (void)random;
    (void)worker;
    return rgb_grey(0.0);
}

static assay_rgb by_ray(void *user, int cell, assay_vertex *vertex, assay_random *random,
                        int worker)
{
    bench                    *b      = user;
    const assay_path_settings direct = {
        .bounces = 1, .roulette_depth = 5, .estimator = ASSAY_ESTIMATOR_NEE};
    (void)cell;
    (void)worker;
    return assay_path_scatter(b->world, &direct, vertex, random, &b->counts).direct;
}

static assay_rgb by_map(void *user, int cell, assay_vertex *vertex, assay_random *random,
                        int worker)
{
    bench *b = user;
    (void)cell;
    (void)worker;
    return assay_shadow_maps_light(b->maps, vertex, random, &b->counts);
}

/* The ways in their order: rays, then the raster; what is seen, with direct light by rays, by maps.
 */
static const struct {
    bool                  raster;
    assay_gather_radiance radiance;
} WAY[WAYS] = {{false, nothing}, {true, nothing}, {false, by_ray}, {true, by_ray}, {true, by_map}};

static int find_points(bench *b, assay_gather_site *sites)
{
    const assay_camera *camera = &b->world->scene->world_cameras[0];
    int                 count  = 0;
    for (int i = 0; i < 64 && count < POINTS; i++) {
        assay_vertex vertex;
        if (assay_visible_find(b->world, camera, 8, 8, i * 5 % 8, i / 8, &b->counts, &vertex)) {
            sites[count++] = assay_gather_site_of(&vertex);
        }
    }
    return count;
}

static void measure(assay_context *context, const char *name, const assay_world *world)
{
    bench                         b         = {.world = world};
    const assay_shadow_settings   shadows   = {1024, 16};
    assay_shadow_maps            *maps      = NULL;
    assay_hemisphere             *planes[2] = {NULL, NULL};
    const assay_hemisphere_layout rays      = {
             .theta = 36, .phi = 114, .strata = ASSAY_STRATA_COSINE, .jitter = true};
    const assay_hemisphere_layout plane = {.theta   = SIDE,
                                           .phi     = SIDE,
                                           .strata  = ASSAY_STRATA_PLANE,
                                           .fov     = 2.2142974355881810,
                                           .missing = ASSAY_MISSING_BORDER_CORRECTED};
    assay_gather_site             sites[POINTS];
    double                        seconds[WAYS][POINTS], ratios[WAYS][POINTS];
    bench_require(context, assay_hemisphere_create(context, &rays, &planes[0]));
    bench_require(context, assay_hemisphere_create(context, &plane, &planes[1]));
    const double start = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    bench_require(context, assay_shadow_maps_create(world, &shadows, &maps));
    const double map_seconds = bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
    b.maps                   = maps;
    const int count          = find_points(&b, sites);
    for (int i = 0; i < count; i++) {
        for (int w = 0; w < WAYS; w++) {
            const assay_gatherer g     = {.world         = world,
                                          .radiance      = WAY[w].radiance,
                                          .user          = &b,
                                          .worker_counts = &b.counts};
            const double         begin = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
            bench_require(context, assay_gather(&g, &sites[i], (uint64_t)i, planes[WAY[w].raster]));
            seconds[w][i] = bench_seconds(CLOCK_THREAD_CPUTIME_ID) - begin;
        }
        ratios[1][i] = seconds[0][i] / seconds[1][i];
        ratios[3][i] = seconds[2][i] / seconds[3][i];
        ratios[4][i] = seconds[2][i] / seconds[4][i];
    }
    printf("%-26s %8u triangles: rays %6.2f ms, raster %6.2f ms: %5.2f; with direct light %6.2f, "
           "%6.2f: %5.2f; by maps %6.2f: %5.2f (made in %.2f s)\n",
           name, world->scene->triangle_count, 1e3 * median(seconds[0], count),
           1e3 * median(seconds[1], count), median(ratios[1], count),
           1e3 * median(seconds[2], count), 1e3 * median(seconds[3], count),
           median(ratios[3], count), 1e3 * median(seconds[4], count), median(ratios[4], count),
           map_seconds);
    assay_hemisphere_destroy(context, planes[0]);
    assay_hemisphere_destroy(context, planes[1]);
    assay_shadow_maps_destroy(maps);
}

static void measure_file(assay_context *context, const char *name, const char *path)
{
    assay_scene *scene = NULL;
    assay_world *world = NULL;
    bench_require(context, assay_scene_load(context, path, NULL, &scene));
    bench_require(context, assay_world_create(scene, &world));
    measure(context, name, world);
    assay_world_destroy(world);
    assay_scene_destroy(scene);
}

int main(int count, char **argv)
{
    static const int            rings[] = {3, 7, 13, 21, 51}; /* 4 n (n - 1) triangles, 64 times */
    const assay_context_options options = {.threads = 1};
    char                        sponza[4096];
    assay_context              *context = NULL;
    if (assay_context_create(&options, &context) != ASSAY_OK) {
        return 1;
    }
    for (int i = 1; i < count; i++) {
        measure_file(context, argv[i], argv[i]);
    }
    if (count < 2) {
        char folder[] = "/tmp/bench_raster.XXXXXX", path[256], bin[256];
        if (!mkdtemp(folder)) {
            bench_stop("cannot make a folder");
        }
        snprintf(bin, sizeof bin, "%s/hall.bin", folder);
        for (size_t i = 0; i < sizeof rings / sizeof rings[0]; i++) {
            write_hall(rings[i], folder, path, sizeof path);
            measure_file(context, "hall of spheres", path);
        }
        unlink(path);
        unlink(bin);
        rmdir(folder);
        measure_file(context, "colonnade", "scenes/colonnade/colonnade.gltf");
        if (bench_find_scene(sponza, sizeof sponza, "sponza_dabrovic/sponza_dabrovic.glb")) {
            measure_file(context, "Sponza", sponza);
        }
    }
    assay_context_destroy(context);
    return 0;
}
