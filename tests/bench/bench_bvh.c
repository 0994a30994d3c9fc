/* bench_bvh.c - exact hits against Embree's built-in triangles, on the same rays.
 *
 *     bench_bvh [SCENE.gltf ...]      without a scene: Sponza if it is there, and a hall of dented
 *                                     spheres with 614K triangles
 *
 * Both sides take turns in short rounds on one thread, timed by that thread's processor time; the
 * figure is the median over the rounds of Embree's time divided by ours, so 1 is Embree's speed.
 * Embree runs in its default mode, once with the instructions it chooses by itself and once, where
 * the machine has it, with AVX2, which can be faster; ASSAY_ISA lowers ours alone. */
#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/scene.h"
#include "bench/bench.h"
#include "core/numerics.h"
#include "core/random.h"
#include "math/frame.h"
#include "scene/scene_data.h"
#include "trace/bvh.h"

enum {
    SIDE    = 512,
    RAYS    = SIDE * SIDE,
    ROUND   = 16384,
    REPEATS = 9,
    ROUNDS  = RAYS / ROUND * REPEATS
};

typedef struct {
    float origin[3], direction[3], t_max;
} bench_ray;

/* What is measured: both sides and their rays. */
typedef struct {
    const char     *name, *isa; /* of Embree */
    assay_triangles triangles;
    assay_bvh      *bvh;
    RTCDevice       device;
    RTCScene        scene;
    bench_ray      *rays;
} bench;

static void *allocate(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (!memory) {
        bench_stop("out of memory");
    }
    return memory;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* ---- the two sides ---- */

static assay_ray ray_of(const bench_ray *r)
{
    return assay_ray_start(vec3(r->origin[0], r->origin[1], r->origin[2]),
                           vec3(r->direction[0], r->direction[1], r->direction[2]), r->t_max);
}

static struct RTCRay embree_ray_of(const bench_ray *r)
{
    return (struct RTCRay){.org_x = r->origin[0],
                           .org_y = r->origin[1],
                           .org_z = r->origin[2],
                           .tnear = 0.0F,
                           .dir_x = r->direction[0],
                           .dir_y = r->direction[1],
                           .dir_z = r->direction[2],
                           .time  = 0.0F,
                           .tfar  = r->t_max,
                           .mask  = 0xFFFFFFFFU,
                           .id    = 0,
                           .flags = 0};
}

static uint64_t run_ours(const bench *b, const bench_ray *rays, bool closest)
{
    uint64_t sum = 0;
    for (int i = 0; i < ROUND; i++) {
        const assay_ray ray = ray_of(&rays[i]);
        if (closest) {
            assay_hit hit;
            sum += assay_bvh_closest(b->bvh, &ray, &hit) ? hit.triangle : 0;
        } else {
            sum += assay_bvh_occluded(b->bvh, &ray);
        }
    }
    return sum;
}

static uint64_t run_embree(const bench *b, const bench_ray *rays, bool closest)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    uint64_t sum = 0;
    for (int i = 0; i < ROUND; i++) {
        if (closest) {
            struct RTCRayHit query = {.ray = embree_ray_of(&rays[i])};
            query.hit.geomID       = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(b->scene, &context, &query);
            sum += query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? query.hit.primID : 0;
        } else {
            struct RTCRay ray = embree_ray_of(&rays[i]);
            rtcOccluded1(b->scene, &context, &ray);
            sum += ray.tfar < 0.0F;
        }
    }
    return sum;
}

static void measure(const bench *b, const char *kind, bool closest)
{
    double  *ratios = allocate(ROUNDS, sizeof *ratios);
    double   ours = 0.0, theirs = 0.0;
    uint64_t found = 0, rounds = 0;
    for (int repeat = 0; repeat < REPEATS; repeat++) {
        for (int first = 0; first < RAYS; first += ROUND) {
            const bench_ray *rays = b->rays + first;
            const double     t0   = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
            found += run_ours(b, rays, closest);
            const double t1 = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
            found += run_embree(b, rays, closest);
            const double t2  = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
            ratios[rounds++] = (t2 - t1) / (t1 - t0);
            ours += t1 - t0;
            theirs += t2 - t1;
        }
    }
    qsort(ratios, rounds, sizeof *ratios, compare_doubles);
    printf("%-26s %-8s %-10s %7.2f %7.2f   %6.3f   [%.3f, %.3f]\n", b->name, b->isa, kind,
           (double)rounds * ROUND / ours * 1e-6, (double)rounds * ROUND / theirs * 1e-6,
           ratios[rounds / 2], ratios[rounds / 10], ratios[rounds * 9 / 10]);
    fflush(stdout);
    if (found == 0) {
        bench_stop("no ray met anything");
    }
    free(ratios);
}

/* ---- rays ---- */

static void set_ray(bench_ray *r, assay_vec3 o, assay_vec3 d, double t_max)
{
    *r = (bench_ray){
        {(float)o.x, (float)o.y, (float)o.z}, {(float)d.x, (float)d.y, (float)d.z}, (float)t_max};
}

/* Pixels in tiles of 8 x 8, as a renderer goes. */
static void make_primary_rays(bench_ray *rays, const assay_camera *camera)
{
    const double half = tan(0.5 * camera->yfov);
    for (int i = 0; i < RAYS; i++) {
        const int        tile = i / 64, within = i % 64;
        const int        px = tile % (SIDE / 8) * 8 + within % 8;
        const int        py = tile / (SIDE / 8) * 8 + within / 8;
        const double     x  = (2.0 * (px + 0.5) / SIDE - 1.0) * half;
        const double     y  = (1.0 - 2.0 * (py + 0.5) / SIDE) * half;
        const assay_vec3 d  = vec3_mad(vec3_mad(camera->forward, x, camera->right), y, camera->up);
        set_ray(&rays[i], camera->position, vec3_normalize(d), INFINITY);
    }
}

/* A point just in front of what a ray sees, and the normal there; false when it sees nothing. */
static bool surface_point(const bench *b, const bench_ray *from, assay_vec3 *p, assay_vec3 *n)
{
    const assay_ray ray = ray_of(from);
    assay_hit       hit;
    if (!assay_bvh_closest(b->bvh, &ray, &hit)) {
        return false;
    }
    assay_vec3 c[3];
    for (int k = 0; k < 3; k++) {
        const float *q = b->triangles.positions +
                         3 * (size_t)b->triangles.indices[3 * (size_t)hit.triangle + (size_t)k];
        c[k] = vec3(q[0], q[1], q[2]);
    }
    *n = vec3_normalize(vec3_cross(vec3_sub(c[1], c[0]), vec3_sub(c[2], c[0])));
    if (vec3_dot(*n, ray.direction) > 0.0) {
        *n = vec3_negate(*n);
    }
    *p = vec3_mad(vec3_mad(ray.origin, hit.t, ray.direction), 1e-4, *n);
    return true;
}

/* From what the camera sees: cosine-distributed where toward is NULL, else to that point.  Rays
 * that see nothing stay as they are. */
static void make_secondary_rays(const bench *b, bench_ray *rays, const assay_vec3 *toward)
{
    for (int i = 0; i < RAYS; i++) {
        assay_vec3 p, n;
        if (!surface_point(b, &rays[i], &p, &n)) {
            continue;
        }
        if (toward) {
            set_ray(&rays[i], p, vec3_sub(*toward, p), 0.9999);
            continue;
        }
        assay_random       random = assay_random_start(1, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        const double       r2     = assay_random_next(&random);
        const assay_sincos phi    = assay_sincos_turns(assay_random_next(&random));
        const assay_frame3 frame  = frame3_from_z(n);
        const assay_vec3   local  = vec3(sqrt(r2) * phi.cos, sqrt(r2) * phi.sin, sqrt(1.0 - r2));
        set_ray(&rays[i], p, frame3_to_world(&frame, local), INFINITY);
    }
}

/* ---- scenes ---- */

static void open_embree(bench *b, const char *isa)
{
    char config[64];
    snprintf(config, sizeof config, "threads=1%s%s", isa ? ",isa=" : "", isa ? isa : "");
    b->isa                      = isa ? isa : "default";
    b->device                   = rtcNewDevice(config);
    b->scene                    = rtcNewScene(b->device);
    RTCGeometry  geometry       = rtcNewGeometry(b->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const size_t position_bytes = 3 * (size_t)b->triangles.vertex_count * sizeof(float);
    const size_t index_bytes    = 3 * (size_t)b->triangles.triangle_count * sizeof(uint32_t);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   3 * sizeof(float), b->triangles.vertex_count),
           b->triangles.positions, position_bytes);
    memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   3 * sizeof(uint32_t), b->triangles.triangle_count),
           b->triangles.indices, index_bytes);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(b->scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(b->scene);
}

static void close_embree(bench *b)
{
    rtcReleaseScene(b->scene);
    rtcReleaseDevice(b->device);
}

static void measure_kinds(bench *b, const assay_camera *camera, assay_vec3 light)
{
    make_primary_rays(b->rays, camera);
    measure(b, "primary", true);
    make_secondary_rays(b, b->rays, &light);
    measure(b, "occlusion", false);
    make_primary_rays(b->rays, camera);
    make_secondary_rays(b, b->rays, NULL);
    measure(b, "incoherent", true);
}

static void run_scene(assay_context *context, const char *name, const assay_triangles *triangles,
                      const assay_camera *camera, assay_vec3 light)
{
    bench        b  = {.name = name, .triangles = *triangles};
    const double t0 = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    if (assay_bvh_create(context, triangles, &b.bvh) != ASSAY_OK) {
        bench_stop(assay_context_error(context));
    }
    const double t1 = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    b.rays          = allocate(RAYS, sizeof *b.rays);
    open_embree(&b, NULL);
    const double t2 = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
    printf("%s: %u triangles; built in %.2f s, Embree's own in %.2f s; %.1f bytes a triangle\n",
           name, triangles->triangle_count, t1 - t0, t2 - t1,
           (double)assay_bvh_bytes(b.bvh) / triangles->triangle_count);
    measure_kinds(&b, camera, light);
    close_embree(&b);
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) {
        open_embree(&b, "avx2");
        measure_kinds(&b, camera, light);
        close_embree(&b);
    }
#endif
    free(b.rays);
    assay_bvh_destroy(b.bvh);
}

static assay_camera looking(assay_vec3 from, assay_vec3 to, double yfov)
{
    assay_camera c = {.position = from, .yfov = yfov};
    c.forward      = vec3_normalize(vec3_sub(to, from));
    c.right        = vec3_normalize(vec3_cross(c.forward, vec3(0.0, 1.0, 0.0)));
    c.up           = vec3_cross(c.right, c.forward);
    return c;
}

/* A light over the middle of the scene. */
static assay_vec3 middle_light(const assay_triangles *t)
{
    assay_vec3 low = vec3(INFINITY, INFINITY, INFINITY), high = vec3_negate(low);
    for (uint32_t i = 0; i < t->vertex_count; i++) {
        const float     *p = t->positions + 3 * (size_t)i;
        const assay_vec3 v = vec3(p[0], p[1], p[2]);
        low                = vec3_min(low, v);
        high               = vec3_max(high, v);
    }
    return vec3(0.5 * (low.x + high.x), low.y + 0.8 * (high.y - low.y), 0.5 * (low.z + high.z));
}

static bool run_file(assay_context *context, const char *path)
{
    assay_scene *scene = NULL;
    if (assay_scene_load(context, path, NULL, &scene) != ASSAY_OK) {
        fprintf(stderr, "bench_bvh: %s\n", assay_context_error(context));
        return false;
    }
    const assay_triangles triangles = {scene->positions, scene->indices, scene->vertex_count,
                                       scene->triangle_count};
    const char           *slash     = strrchr(path, '/');
    const assay_vec3      light     = middle_light(&triangles);
    run_scene(context, slash ? slash + 1 : path, &triangles, &scene->world_cameras[0], light);
    assay_scene_destroy(scene);
    return true;
}

/* ---- a hall of dented spheres between six walls ---- */

enum { RINGS = 96, SECTORS = 128, GRID = 5, SPHERES = GRID * GRID };

typedef struct {
    float    *positions;
    uint32_t *indices;
    uint32_t  vertices, triangles;
} mesh;

static uint32_t add_vertex(mesh *m, assay_vec3 p)
{
    float *at = m->positions + 3 * (size_t)m->vertices;
    at[0]     = (float)p.x;
    at[1]     = (float)p.y;
    at[2]     = (float)p.z;
    return m->vertices++;
}

static void add_quad(mesh *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    const uint32_t corners[6] = {a, b, c, a, c, d};
    memcpy(m->indices + 3 * (size_t)m->triangles, corners, sizeof corners);
    m->triangles += 2;
}

static void add_sphere(mesh *m, assay_vec3 centre, double radius, uint64_t seed)
{
    const uint32_t first  = m->vertices;
    assay_random   random = assay_random_start(seed, ASSAY_STAGE_TEST, 0, 0);
    for (int i = 0; i <= RINGS; i++) {
        const assay_sincos theta = assay_sincos_turns(0.5 * i / RINGS);
        for (int j = 0; j < SECTORS; j++) {
            const assay_sincos phi = assay_sincos_turns((double)j / SECTORS);
            const double       r   = radius * (1.0 + 0.03 * assay_random_next(&random));
            add_vertex(m, vec3(centre.x + r * theta.sin * phi.cos, centre.y + r * theta.cos,
                               centre.z + r * theta.sin * phi.sin));
        }
    }
    for (uint32_t i = 0; i < RINGS; i++) {
        for (uint32_t j = 0; j < SECTORS; j++) {
            const uint32_t k = (j + 1) % SECTORS, row = first + i * SECTORS;
            add_quad(m, row + j, row + k, row + SECTORS + k, row + SECTORS + j);
        }
    }
}

static void add_box(mesh *m, assay_vec3 low, assay_vec3 high)
{
    const uint32_t first = m->vertices;
    for (int i = 0; i < 8; i++) {
        add_vertex(m, vec3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z));
    }
    static const unsigned char side[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    for (int i = 0; i < 6; i++) {
        add_quad(m, first + side[i][0], first + side[i][1], first + side[i][2], first + side[i][3]);
    }
}

static void run_hall(assay_context *context)
{
    mesh m      = {0};
    m.positions = allocate(3 * (size_t)(SPHERES * (RINGS + 1) * SECTORS + 8), sizeof *m.positions);
    m.indices   = allocate(3 * (size_t)(SPHERES * RINGS * SECTORS * 2 + 12), sizeof *m.indices);
    for (int i = 0; i < SPHERES; i++) {
        add_sphere(&m, vec3(2.0 * (i % GRID), 0.3 * (i % 4), 2.0 * (double)(i / GRID)), 0.85,
                   (uint64_t)i);
    }
    add_box(&m, vec3(-2.0, -1.0, -2.0), vec3(10.0, 5.0, 10.0));
    const assay_triangles triangles = {m.positions, m.indices, m.vertices, m.triangles};
    const assay_camera    camera    = looking(vec3(-1.5, 2.5, -1.5), vec3(4.0, 0.0, 4.0), 1.0);
    run_scene(context, "hall of dented spheres", &triangles, &camera, vec3(4.0, 4.5, 4.0));
    free(m.positions);
    free(m.indices);
}

int main(int argc, char **argv)
{
    assay_context *context = NULL;
    if (assay_context_create(NULL, &context) != ASSAY_OK) {
        bench_stop("cannot make a context");
    }
    printf("%-26s %-8s %-10s %7s %7s   %6s   %s\n", "", "Embree", "", "Mrays/s", "Embree", "ratio",
           "[10 %, 90 % of rounds]");
    bool ok = true;
    for (int i = 1; i < argc; i++) {
        ok = run_file(context, argv[i]) && ok;
    }
    if (argc == 1) {
        char path[4096];
        if (bench_find_scene(path, sizeof path, "sponza_dabrovic/sponza_dabrovic_nolight.glb")) {
            ok = run_file(context, path);
        }
        run_hall(context);
    }
    assay_context_destroy(context);
    return ok ? 0 : 1;
}
