/* bench_filling.c - what making records costs: against triangles, and by two threads against one.
 *
 *     bench_filling [NAME]     part of a scene's name
 *
 * A cache is filled from the centres of an image's pixels until so many records are there, with one
 * thread and with two, in turns; the quickest of the rounds counts, by the clock on the wall (what
 * a record costs: by processor time, with one thread).  A busy machine makes two threads look worse
 * than they are: how many processors the two had is shown beside, and how much more processor time
 * they took than one, which with 1.0 on two idle processors is twice the speed.  The last line is
 * what is asked of the program: the middle of these ratios where two threads had their processors.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/bench.h"
#include "core/numerics.h"
#include "record/irradiance_cache.h"
#include "scene/scene_build.h"
#include "trace/visible_point.h"

enum { SIDE = 64, RECORDS = 100, LEAST_ROUNDS = 2, MOST_ROUNDS = 50, THREADS = 2, LIGHTS = 2 };

/* s, of one line of the table: rounds are short and many, so that some have the machine alone. */
static const double PATIENCE = 0.5;
static const double IDLE     = 1.9; /* processors that two threads must have had to be counted */

/* ---- a room with two balls, of as many triangles as one likes ---- */

typedef struct {
    float *values; /* 9 a triangle */
    size_t count;
} soup;

static void add_triangle(soup *s, const assay_vec3 corner[3])
{
    for (int i = 0; i < 3; i++) {
        float *v = s->values + 9 * s->count + 3 * (size_t)i;
        v[0]     = (float)corner[i].x;
        v[1]     = (float)corner[i].y;
        v[2]     = (float)corner[i].z;
    }
    s->count++;
}

static void add_quad(soup *s, assay_vec3 a, assay_vec3 b, assay_vec3 c, assay_vec3 d)
{
    add_triangle(s, (const assay_vec3[3]){a, b, c});
    add_triangle(s, (const assay_vec3[3]){a, c, d});
}

/* A face of an octahedron, cut into n^2 and pushed out to the sphere. */
static void add_face(soup *s, assay_vec3 centre, double radius, assay_vec3 x, assay_vec3 y,
                     assay_vec3 z, int n)
{
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < 2 * (n - i) - 1; k++) {
            const int up = k & 1, j = k / 2;
            const int at[3][2] = {
                {i + up, j}, {up ? i + 1 : i, up ? j + 1 : j + 1}, {i + !up, j + up}};
            assay_vec3 corner[3];
            for (int c = 0; c < 3; c++) {
                const double u = (double)at[c][0] / n, v = (double)at[c][1] / n;
                assay_vec3   d = vec3_scale(x, 1.0 - u - v);
                d              = vec3_mad(vec3_mad(d, u, y), v, z);
                corner[c]      = vec3_mad(centre, radius, vec3_normalize(d));
            }
            add_triangle(s, corner);
        }
    }
}

static void add_ball(soup *s, assay_vec3 centre, double radius, int n)
{
    for (int octant = 0; octant < 8; octant++) {
        const assay_vec3 x = vec3(octant & 1 ? 1 : -1, 0, 0), y = vec3(0, octant & 2 ? 1 : -1, 0);
        add_face(s, centre, radius, x, y, vec3(0, 0, octant & 4 ? 1 : -1), n);
    }
}

static void add_room(soup *s)
{
    const double     h    = 1.0;
    const assay_vec3 v[8] = {{-h, -h, -h}, {h, -h, -h}, {-h, h, -h}, {h, h, -h},
                             {-h, -h, h},  {h, -h, h},  {-h, h, h},  {h, h, h}};
    add_quad(s, v[0], v[1], v[5], v[4]);
    add_quad(s, v[2], v[3], v[7], v[6]);
    add_quad(s, v[0], v[1], v[3], v[2]);
    add_quad(s, v[0], v[2], v[6], v[4]);
    add_quad(s, v[1], v[3], v[7], v[5]);
}

/* One primitive of grey triangles under a point light, as a .glb in memory. */
static assay_scene *load_soup(assay_context *context, const soup *s)
{
    char           json[2048];
    const uint32_t size = (uint32_t)(s->count * 9 * sizeof(float));
    int            length =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_lights_punctual\"],"
                 "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
                 "\"intensity\":5}]}},\"buffers\":[{\"byteLength\":%u}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%u}],\"accessors\":[{"
                 "\"bufferView\":0,\"componentType\":5126,\"type\":\"VEC3\",\"count\":%zu,"
                 "\"min\":[-1,-1,-1],\"max\":[1,1,1]}],\"meshes\":[{\"primitives\":[{"
                 "\"attributes\":{\"POSITION\":0}}]}],\"cameras\":[{\"type\":\"perspective\","
                 "\"perspective\":{\"yfov\":1,\"znear\":0.01}}],\"nodes\":[{\"mesh\":0},"
                 "{\"camera\":0,\"translation\":[0,0,2]},{\"translation\":[0,0.8,0],"
                 "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],"
                 "\"scenes\":[{\"nodes\":[0,1,2]}]}",
                 size, size, s->count * 3);
    for (; length % 4; length++) {
        json[length] = ' ';
    }
    const uint32_t head[5] = {0x46546C67, 2, 28 + (uint32_t)length + size, (uint32_t)length,
                              0x4E4F534A};
    const uint32_t body[2] = {size, 0x004E4942};
    uint8_t       *glb     = malloc(head[2]);
    assay_scene   *scene   = NULL;
    if (!glb) {
        exit(1);
    }
    memcpy(glb, head, sizeof head);
    memcpy(glb + 20, json, (size_t)length);
    memcpy(glb + 20 + length, body, sizeof body);
    memcpy(glb + 28 + length, s->values, size);
    assay_scene_options options = assay_scene_options_default();
    options.force_diffuse       = true;
    bench_require(context, assay_scene_load_memory(context, glb, head[2], "balls.glb", NULL,
                                                   &options, &scene));
    free(glb);
    return scene;
}

static assay_scene *load_balls(assay_context *context, int n)
{
    soup s = {.values = malloc(((size_t)16 * (size_t)n * (size_t)n + 10) * 9 * sizeof(float))};
    if (!s.values) {
        exit(1);
    }
    add_room(&s);
    add_ball(&s, vec3(-0.4, -0.5, -0.3), 0.45, n);
    add_ball(&s, vec3(0.45, -0.6, 0.2), 0.38, n);
    assay_scene *scene = load_soup(context, &s);
    free(s.values);
    return scene;
}

/* ---- scenes ---- */

typedef struct {
    const char *name, *file, *camera; /* file NULL: two balls, ... */
    int         n;                    /* ... cut so many times     */
    bool        sky;                  /* lit from outside          */
} subject;

static const subject SUBJECTS[] = {
    {"two balls", NULL, NULL, 2, false},
    {"two balls", NULL, NULL, 16, false},
    {"two balls", NULL, NULL, 64, false},
    {"two balls", NULL, NULL, 203, false},
    {"Cornell box", "scenes/cornell-box/cornell-box.gltf", NULL, 0, false},
    {"colonnade", "scenes/colonnade/colonnade.gltf", "atrium", 0, false},
    {"Sponza", "sponza_dabrovic/sponza_dabrovic.glb", "atrium", 0, false},
    {"classroom", "bitterli_classroom/bitterli_classroom.glb", NULL, 0, true},
    {"living room", "bitterli_living_room/bitterli_living_room.glb", NULL, 0, true},
};

/* NULL where the file is not there. */
static assay_scene *load(assay_context *context, const subject *what)
{
    char         path[512];
    assay_scene *scene = NULL;
    if (!what->file) {
        return load_balls(context, what->n);
    }
    if (!bench_find_scene(path, sizeof path, what->file)) {
        return NULL;
    }
    assay_scene_options options = assay_scene_options_default();
    options.force_diffuse       = true;
    options.background          = rgb_grey(what->sky ? 1.0 : 0.0);
    bench_require(context, assay_scene_load(context, path, &options, &scene));
    return scene;
}

/* ---- filling ---- */

typedef struct {
    assay_context *context;
    assay_scene   *scene;
    assay_world   *world;
    double         wall, had; /* s, of the quickest round; processors that it had */
    double         processor; /* s, the least of all rounds                       */
    uint64_t       rays, records, bytes;
} bench;

static assay_cache_point POINTS[SIDE * SIDE];

static size_t find_points(const assay_world *world, const char *camera)
{
    const assay_scene *scene  = world->scene;
    assay_ray_counts   counts = {0};
    uint32_t           c      = 0;
    size_t             count  = 0;
    while (camera && c + 1 < scene->world_camera_count &&
           strcmp(scene->world_cameras[c].name, camera) != 0) {
        c++;
    }
    for (int i = 0; i < SIDE * SIDE; i++) {
        assay_vertex vertex;
        if (assay_visible_find(world, &scene->world_cameras[c], SIDE, SIDE, i % SIDE, i / SIDE,
                               &counts, &vertex)) {
            POINTS[count++] =
                (assay_cache_point){.site = assay_gather_site_of(&vertex), .wanted = true};
        }
    }
    return count;
}

static void fill(bench *b, const assay_irradiance_cache_settings *settings, size_t points)
{
    assay_irradiance_cache *cache = NULL;
    assay_ray_counts        rays  = {0};
    bench_require(b->context, assay_irradiance_cache_create(b->world, settings, 1, &cache));
    const double wall = bench_seconds(CLOCK_MONOTONIC),
                 busy = bench_seconds(CLOCK_PROCESS_CPUTIME_ID);
    bench_require(b->context,
                  assay_irradiance_cache_fill(cache, NULL, 0, points, points, POINTS, NULL));
    const double took      = bench_seconds(CLOCK_MONOTONIC) - wall;
    const double processor = bench_seconds(CLOCK_PROCESS_CPUTIME_ID) - busy;
    if (!(b->wall <= took)) {
        b->wall = took;
        b->had  = processor / took;
    }
    b->processor = b->processor <= processor ? b->processor : processor;
    assay_irradiance_cache_count(cache, &rays);
    b->rays    = rays.scatter + rays.shadow;
    b->records = rays.records;
    b->bytes   = assay_record_store_bytes(assay_irradiance_cache_store(cache));
    assay_irradiance_cache_destroy(cache);
}

/* How much faster two threads are than one. */
static double print_scene(const subject *what, const char *light, const bench b[THREADS])
{
    const double n = (double)b[0].records, faster = b[0].wall / b[1].wall;
    printf("%-12s %9u %-6s %8.0f %8.0f %8.1f %8.0f %6.2f (%.2f) %6.2f\n", what->name,
           b[0].scene->triangle_count, light, n, (double)b[0].rays / n, 1e3 * b[0].processor / n,
           (double)b[0].bytes / n, faster, b[1].had, b[1].processor / b[0].processor);
    return faster;
}

/* One number a light for which two threads had two processors; how many there are of them. */
static int compare(const subject *what, double *faster_out)
{
    int done = 0;
    static const struct {
        const char     *name;
        assay_secondary secondary;
    } lights[LIGHTS] = {{"direct", ASSAY_SECONDARY_DIRECT}, {"path", ASSAY_SECONDARY_PATH}};
    bench b[THREADS];
    for (int t = 0; t < THREADS; t++) {
        const assay_context_options options = {.threads = t + 1};
        b[t]                                = (bench){.wall = NAN};
        if (assay_context_create(&options, &b[t].context) != ASSAY_OK) {
            exit(1);
        }
        b[t].scene = load(b[t].context, what);
        if (b[t].scene) {
            bench_require(b[t].context, assay_world_create(b[t].scene, &b[t].world));
        }
    }
    for (int i = 0; i < LIGHTS && b[0].scene; i++) {
        const assay_irradiance_cache_settings settings = {
            .layout       = {.theta = 16, .phi = 50, .strata = ASSAY_STRATA_COSINE, .jitter = true},
            .rules        = {.a = 0.1, .gradients = ASSAY_GRADIENTS_BOTH},
            .r_max        = INFINITY,
            .r_max_pixels = INFINITY,
            .max_records  = RECORDS,
            .secondary    = lights[i].secondary,
            .levels       = 1,
            .path         = {.bounces = i ? ASSAY_BOUNCES_INF : 2, .roulette_depth = 5},
        };
        const size_t points = find_points(b[0].world, what->camera);
        b[0].wall = b[1].wall = b[0].processor = b[1].processor = NAN;
        const double start                                      = bench_seconds(CLOCK_MONOTONIC);
        for (int round = 0;
             round < LEAST_ROUNDS ||
             (round < MOST_ROUNDS && bench_seconds(CLOCK_MONOTONIC) - start < PATIENCE);
             round++) {
            fill(&b[0], &settings, points);
            fill(&b[1], &settings, points);
        }
        const double faster = print_scene(what, lights[i].name, b);
        if (b[1].had >= IDLE) {
            faster_out[done++] = faster;
        }
    }
    for (int t = 0; t < THREADS; t++) {
        assay_world_destroy(b[t].world);
        assay_scene_destroy(b[t].scene);
        assay_context_destroy(b[t].context);
    }
    return done;
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { SUBJECT_COUNT = sizeof SUBJECTS / sizeof SUBJECTS[0] };

int main(int count, char **argv)
{
    double faster[SUBJECT_COUNT * LIGHTS];
    int    lines = 0;
    setvbuf(stdout, NULL, _IOLBF, 0);
    printf("%-12s %9s %-6s %8s %8s %8s %8s %6s\n", "", "triangles", "light", "records", "rays each",
           "ms each", "bytes",
           "two threads against one (processors that the two had), their processor time against "
           "one's");
    for (size_t i = 0; i < SUBJECT_COUNT; i++) {
        if (count < 2 || strstr(SUBJECTS[i].name, argv[1])) {
            lines += compare(&SUBJECTS[i], faster + lines);
        }
    }
    if (lines > 0) {
        qsort(faster, (size_t)lines, sizeof *faster, ascending);
        printf(
            "two threads against one, the middle of the %d that had both processors: %.2f (1.7 is "
            "asked)\n",
            lines, faster[lines / 2]);
    } else {
        printf("the machine is too busy to say how much faster two threads are than one\n");
    }
    return 0;
}
