/* bench_missing.c - how wrong irradiance from one plane is: table 4.1 of [gautron06] again.
 *
 *     bench_missing [COUNT [SCENE.gltf [CAMERA]]]    COUNT irradiance values, 1,000 without
 *
 * At points that a camera sees, on a grid of its image, irradiance after one bounce is taken from
 * 64 x 64 pixels of a plane of 126.87 degrees, with the four ways of dealing with what it misses,
 * and from two full hemispheres of 32 x 100 rays with numbers of their own: the mean of the product
 * of the differences to both is free of their noise.  RMS errors are of luminance, in percent of
 * its mean; "at points": relative to each point's own, with a hundredth of the mean added. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/scene.h"
#include "bench/bench.h"
#include "gather/gather.h"
#include "trace/path_trace.h"
#include "trace/visible_point.h"

enum { SIDE = 64, WAYS = 4 };

static const char *const NAMES[WAYS] = {"plane", "ratio", "border", "border-corrected"};

/* What the thesis prints of the Sibenik cathedral, percent; it has no fourth way. */
static const double PRINTED[WAYS] = {18.1, 10.4, 5.8, NAN};

typedef struct {
    const assay_world *world;
    assay_ray_counts   counts;
    assay_hemisphere  *full, *plane[WAYS];
} bench;

/* Of one point. */
typedef struct {
    double reference[2], plane[WAYS];
} values;

static assay_rgb direct(void *user, int cell, assay_vertex *vertex, assay_random *random,
                        int worker)
{
    bench                    *b    = user;
    const assay_path_settings path = {
        .bounces = 1, .roulette_depth = 5, .estimator = ASSAY_ESTIMATOR_NEE};
    (void)cell;
    (void)worker;
    return assay_path_scatter(b->world, &path, vertex, random, &b->counts).direct;
}

static void create_hemispheres(assay_context *context, bench *b)
{
    const assay_hemisphere_layout full = {
        .theta = 32, .phi = 100, .strata = ASSAY_STRATA_COSINE, .jitter = true};
    bench_require(context, assay_hemisphere_create(context, &full, &b->full));
    for (int i = 0; i < WAYS; i++) {
        const assay_hemisphere_layout plane = {.theta   = SIDE,
                                               .phi     = SIDE,
                                               .strata  = ASSAY_STRATA_PLANE,
                                               .fov     = 2.2142974355881810,
                                               .missing = (assay_missing)i};
        bench_require(context, assay_hemisphere_create(context, &plane, &b->plane[i]));
    }
}

static double luminance(const assay_hemisphere *h)
{
    return rgb_luminance(assay_hemisphere_irradiance(h));
}

static values measure_point(assay_context *context, bench *b, const assay_gather_site *site,
                            uint64_t number)
{
    values v;
    for (uint64_t i = 0; i < 3; i++) {
        const assay_gatherer g = {.world         = b->world,
                                  .seed          = i,
                                  .radiance      = direct,
                                  .user          = b,
                                  .worker_counts = &b->counts};
        bench_require(context, assay_gather(&g, site, number, i < 2 ? b->full : b->plane[0]));
        if (i < 2) {
            v.reference[i] = luminance(b->full);
        }
    }
    for (int i = 0; i < WAYS; i++) {
        if (i > 0) {
            memcpy(b->plane[i]->cells, b->plane[0]->cells, SIDE * SIDE * sizeof(assay_cell));
        }
        v.plane[i] = luminance(b->plane[i]);
    }
    return v;
}

static void report(const char *name, const values *v, int count)
{
    double mean = 0.0;
    for (int i = 0; i < count; i++) {
        mean += 0.5 * (v[i].reference[0] + v[i].reference[1]) / count;
    }
    printf("%s, %d irradiance values, mean %.4g\n", name, count, mean);
    for (int w = 0; w < WAYS; w++) {
        double square = 0.0, relative = 0.0, bias = 0.0;
        for (int i = 0; i < count; i++) {
            const double a = v[i].plane[w] - v[i].reference[0],
                         b = v[i].plane[w] - v[i].reference[1];
            const double e = 0.5 * (v[i].reference[0] + v[i].reference[1]);
            square += a * b / count;
            relative += a * b / (e * e + 0.01 * mean * mean) / count;
            bias += 0.5 * (a + b) / count;
        }
        printf("  %-18s RMS error %5.1f %%, at points %5.1f %%, mean error %+6.1f %%", NAMES[w],
               100.0 * sqrt(fmax(square, 0.0)) / mean, 100.0 * sqrt(fmax(relative, 0.0)),
               100.0 * bias / mean);
        printf(isnan(PRINTED[w]) ? "\n" : "   (thesis, Sibenik: %.1f %%)\n", PRINTED[w]);
    }
}

static void measure(assay_context *context, const char *name, const char *path, const char *camera,
                    int wanted)
{
    bench        b     = {0};
    assay_scene *scene = NULL;
    assay_world *world = NULL;
    bench_require(context, assay_scene_load(context, path, NULL, &scene));
    bench_require(context, assay_world_create(scene, &world));
    b.world = world;
    create_hemispheres(context, &b);
    const assay_camera *chosen = &scene->world_cameras[0];
    for (uint32_t i = 0; camera && i < scene->world_camera_count; i++) {
        if (strcmp(scene->world_cameras[i].name, camera) == 0) {
            chosen = &scene->world_cameras[i];
        }
    }
    const int side  = (int)ceil(sqrt((double)wanted));
    values   *v     = calloc((size_t)wanted, sizeof *v);
    int       count = 0;
    for (int i = 0; v && i < side * side && count < wanted; i++) {
        assay_vertex vertex;
        if (assay_visible_find(world, chosen, side, side, i % side, i / side, &b.counts, &vertex)) {
            const assay_gather_site site = assay_gather_site_of(&vertex);
            v[count]                     = measure_point(context, &b, &site, (uint64_t)i);
            count++;
        }
    }
    report(name, v, count);
    free(v);
    assay_hemisphere_destroy(context, b.full);
    for (int i = 0; i < WAYS; i++) {
        assay_hemisphere_destroy(context, b.plane[i]);
    }
    assay_world_destroy(world);
    assay_scene_destroy(scene);
}

int main(int count, char **argv)
{
    const assay_context_options options = {.threads = 1};
    char                        sponza[4096];
    const int                   wanted  = count > 1 ? atoi(argv[1]) : 1000;
    assay_context              *context = NULL;
    if (wanted < 1 || assay_context_create(&options, &context) != ASSAY_OK) {
        return 1;
    }
    if (count > 2) {
        measure(context, argv[2], argv[2], count > 3 ? argv[3] : NULL, wanted);
    } else {
        measure(context, "colonnade, atrium", "scenes/colonnade/colonnade.gltf", "atrium", wanted);
        if (bench_find_scene(sponza, sizeof sponza, "sponza_dabrovic/sponza_dabrovic.glb")) {
            measure(context, "Sponza, atrium", sponza, "atrium", wanted);
        }
    }
    assay_context_destroy(context);
    return 0;
}
