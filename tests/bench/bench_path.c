/* bench_path.c - the whole path tracer against raw rays of Embree.
 *
 *     bench_path [SCENE.gltf [CAMERA]]     without a scene: Sponza if it is there, else our
 * colonnade
 *
 * Both sides take turns in rounds on one thread, timed by processor time: an image by `path` under
 * a constant sky, counted in rays (camera, scatter, shadow), and rtcIntersect1 on incoherent rays
 * (from what the camera sees, cosine-distributed) with Embree's built-in triangles in its default
 * mode. Then two threads against one, by the wall clock. */
#include <embree3/rtcore.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/render.h"
#include "bench/bench.h"
#include "core/numerics.h"
#include "math/frame.h"
#include "scene/scene_data.h"
#include "scene/scene_size.h"
#include "trace/camera_ray.h"
#include "trace/world.h"

enum { SIDE = 128, RAYS = 1 << 17, ROUNDS = 11 };

typedef struct {
    assay_scene   *scene;
    const char    *camera;
    RTCDevice      device;
    RTCScene       embree;
    struct RTCRay *rays;
} bench;

static assay_scene *load(assay_context *context, const char *path)
{
    assay_scene_options options = assay_scene_options_default();
    assay_scene        *scene   = NULL;
    options.background          = rgb_grey(1.0);
    if (assay_scene_load(context, path, &options, &scene) != ASSAY_OK) {
        bench_stop(assay_context_error(context));
    }
    return scene;
}

static assay_render_stats render(assay_context *context, assay_scene *scene, const char *camera)
{
    assay_render_options options = assay_render_options_default();
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    assay_render_stats   stats;
    options.width = options.height = SIDE;
    options.camera                 = camera;
    options.layers                 = "color";
    if (assay_method_params(context, "path", &params) != ASSAY_OK ||
        assay_params_set(params, "spp", "16") != ASSAY_OK ||
        assay_render(scene, "path", params, &options, &image, &stats) != ASSAY_OK) {
        bench_stop(assay_context_error(context));
    }
    assay_image_destroy(image);
    assay_params_destroy(params);
    return stats;
}

static double ray_count(const assay_render_stats *s)
{
    return (double)(s->camera_rays + s->scatter_rays + s->shadow_rays);
}

/* ---- Embree's side ---- */

static void open_embree(bench *b)
{
    const assay_scene *s        = b->scene;
    b->device                   = rtcNewDevice("threads=1");
    b->embree                   = rtcNewScene(b->device);
    RTCGeometry  geometry       = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const size_t position_bytes = 3 * (size_t)s->vertex_count * sizeof(float);
    const size_t index_bytes    = 3 * (size_t)s->triangle_count * sizeof(uint32_t);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   3 * sizeof(float), s->vertex_count),
           s->positions, position_bytes);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   3 * sizeof(uint32_t), s->triangle_count),
           s->indices, index_bytes);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(b->embree, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(b->embree);
}

static const assay_camera *find_camera(const assay_scene *scene, const char *name)
{
    for (uint32_t i = 0; name && i < scene->world_camera_count; i++) {
        if (strcmp(scene->world_cameras[i].name, name) == 0) {
            return &scene->world_cameras[i];
        }
    }
    return &scene->world_cameras[0];
}

/* Cosine-distributed directions from what random camera rays see. */
static void make_rays(bench *b)
{
    const assay_camera *camera = find_camera(b->scene, b->camera);
    assay_world        *world  = NULL;
    if (assay_world_create(b->scene, &world) != ASSAY_OK) {
        bench_stop("cannot build the tree");
    }
    int made = 0;
    for (uint64_t i = 0; made < RAYS; i++) {
        assay_random  random = assay_random_start(1, ASSAY_STAGE_TEST, i, 0);
        const double  x = SIDE * assay_random_next(&random), y = SIDE * assay_random_next(&random);
        assay_vec3    origin, direction;
        uint64_t      count = 0;
        assay_hit     hit;
        assay_surface surface;
        assay_camera_ray(camera, x, y, SIDE, SIDE, &origin, &direction);
        if (!assay_world_visible(world, origin, direction, &count, &hit)) {
            continue;
        }
        assay_surface_at(b->scene, hit.triangle, hit.u, hit.v, &surface);
        const double       side  = vec3_dot(surface.ng, direction) > 0.0 ? -1.0 : 1.0;
        const assay_frame3 frame = frame3_from_z(vec3_scale(surface.ng, side));
        const double       r2    = assay_random_next(&random);
        const assay_sincos phi   = assay_sincos_turns(assay_random_next(&random));
        const assay_vec3   d =
            frame3_to_world(&frame, vec3(sqrt(r2) * phi.cos, sqrt(r2) * phi.sin, sqrt(1.0 - r2)));
        const assay_vec3 p = vec3_mad(surface.position, 1e-4, frame.z);
        b->rays[made++]    = (struct RTCRay){.org_x = (float)p.x,
                                             .org_y = (float)p.y,
                                             .org_z = (float)p.z,
                                             .dir_x = (float)d.x,
                                             .dir_y = (float)d.y,
                                             .dir_z = (float)d.z,
                                             .tfar  = INFINITY,
                                             .mask  = 0xFFFFFFFFU};
    }
    assay_world_destroy(world);
}

static uint64_t run_embree(const bench *b)
{
    struct RTCIntersectContext context;
    uint64_t                   hits = 0;
    rtcInitIntersectContext(&context);
    for (int i = 0; i < RAYS; i++) {
        struct RTCRayHit query = {.ray = b->rays[i]};
        query.hit.geomID       = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(b->embree, &context, &query);
        hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values)
{
    qsort(values, ROUNDS, sizeof *values, compare_doubles);
    return values[ROUNDS / 2];
}

static void against_embree(assay_context *context, bench *b)
{
    double ratio[ROUNDS], ours[ROUNDS], theirs[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        const double             t0    = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
        const assay_render_stats stats = render(context, b->scene, b->camera);
        const double             t1    = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
        run_embree(b);
        const double t2 = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
        /* the tree is built anew by every render: its (wall) time is not the path tracer's */
        ours[i]   = ray_count(&stats) / (t1 - t0 - stats.seconds_build);
        theirs[i] = RAYS / (t2 - t1);
        ratio[i]  = ours[i] / theirs[i];
    }
    printf(
        "path, one thread: %.2f million rays a second; Embree raw, incoherent: %.2f; ratio %.3f\n",
        median(ours) * 1e-6, median(theirs) * 1e-6, median(ratio));
}

static void two_threads(const char *path, const char *camera)
{
    double ratio[ROUNDS];
    for (int i = 0; i < ROUNDS; i++) {
        double taken[2];
        for (int threads = 1; threads <= 2; threads++) {
            const assay_context_options options = {.threads = threads};
            assay_context              *context = NULL;
            assay_context_create(&options, &context);
            assay_scene *scene = load(context, path);
            taken[threads - 1] = render(context, scene, camera).seconds_render;
            assay_scene_destroy(scene);
            assay_context_destroy(context);
        }
        ratio[i] = taken[0] / taken[1];
    }
    printf("two threads against one (wall clock): %.2f\n", median(ratio));
}

int main(int argc, char **argv)
{
    const assay_context_options options = {.threads = 1};
    assay_context              *context = NULL;
    bench                       b       = {.camera = argc > 2 ? argv[2] : "atrium"};
    char                        sponza[4096];
    const char                 *path = "scenes/colonnade/colonnade.gltf";
    if (argc > 1) {
        path = argv[1];
    } else if (bench_find_scene(sponza, sizeof sponza,
                                "sponza_dabrovic/sponza_dabrovic_nolight.glb")) {
        path = sponza;
    }
    if (argc == 2) {
        b.camera = NULL;
    }
    assay_context_create(&options, &context);
    const double start           = bench_seconds(CLOCK_MONOTONIC);
    b.scene                      = load(context, path);
    const double             end = bench_seconds(CLOCK_MONOTONIC);
    const assay_render_stats s   = render(context, b.scene, b.camera);
    const double             n   = b.scene->triangle_count;
    printf("%s: %.0f triangles; load %.2f s, tree %.2f s; bytes a triangle: %.0f geometry + %.0f "
           "tree = %.0f\n",
           path, n, end - start, s.seconds_build, (double)s.geometry_bytes / n,
           (double)s.bvh_bytes / n, (double)(s.geometry_bytes + s.bvh_bytes) / n);
    b.rays = calloc(RAYS, sizeof *b.rays);
    if (!b.rays) {
        bench_stop("out of memory");
    }
    open_embree(&b);
    make_rays(&b);
    against_embree(context, &b);
    two_threads(path, b.camera);
    free(b.rays);
    rtcReleaseScene(b.embree);
    rtcReleaseDevice(b.device);
    assay_scene_destroy(b.scene);
    assay_context_destroy(context);
    return 0;
}
