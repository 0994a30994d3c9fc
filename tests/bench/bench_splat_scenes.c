/* bench_splat_scenes.c - splatting against the octree on the thesis's scenes that are here: table
 * 4.2 and the Cornell box of figure 4.9(b) with its glossy wall [gautron06].
 *
 *     bench_splat_scenes [SCENE [SIDE [SETTINGS]]]     part of a name; name=value,... of splat
 *
 * The method renders once, on all processors, and dumps its steps.  What it dumped is splatted
 * again, and asked of an octree: both from points to mean irradiance, or to what glossy pixels
 * reflect, one thread, by processor time, the least of some rounds. */
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/render.h"
#include "bench/bench.h"
#include "core/numerics.h"
#include "methods/cache_params.h"
#include "methods/radiance_params.h"
#include "methods/splat/splat_gloss.h"
#include "record/radiance_bundle.h"
#include "record/record_bundle.h"
#include "scene/scene_data.h"

enum { ROUNDS = 3, SIDE = 1000, BRDF = 15 };

typedef struct {
    const char *name, *scene, *camera;
    bool        diffuse;
    const char *settings;
} subject;

#define ONE_BOUNCE "spp=1,bounces=2,secondary=direct,gbuffer=centres,"

static const subject SUBJECTS[] = {
    {"Sponza", "sponza_dabrovic/sponza_dabrovic.glb", "atrium", true,
     ONE_BOUNCE "a=0.1,theta_strata=4,phi_strata=12,r_min_pixels=1400"},
    {"Cornell box", "scenes/cornell-box-glossy/cornell-box-glossy.gltf", "0", false,
     ONE_BOUNCE "a=0.25,theta_strata=8,phi_strata=25,order=10,glossy_accuracy=0.8"},
};

/* ---- the render, and what it left ---- */

typedef struct {
    assay_context       *context;
    assay_scene         *scene;
    assay_world         *world;
    const assay_camera  *camera;
    assay_params        *params;
    int                  side;
    size_t               pixels;
    char                 folder[64], dump[80];
    assay_bundle_reader *reader;
} bench;

static void set_all(bench *b, const char *list)
{
    char  buffer[512];
    char *rest = buffer;
    snprintf(buffer, sizeof buffer, "%s", list);
    for (char *item = strtok_r(NULL, ",", &rest); item; item = strtok_r(NULL, ",", &rest)) {
        char *value = strchr(item, '=');
        if (value) {
            *value = '\0';
            bench_require(b->context, assay_params_set(b->params, item, value + 1));
        }
    }
}

static bool load(bench *b, const subject *what)
{
    char                path[512];
    assay_scene_options options = assay_scene_options_default();
    options.force_diffuse       = what->diffuse;
    if (!bench_find_scene(path, sizeof path, what->scene)) {
        printf("%-14s not there: skipped\n", what->name);
        return false;
    }
    bench_require(b->context, assay_scene_load(b->context, path, &options, &b->scene));
    bench_require(b->context, assay_world_create(b->scene, &b->world));
    b->camera = b->scene->world_cameras;
    for (uint32_t i = 0; i < b->scene->world_camera_count; i++) {
        if (strcmp(b->scene->world_cameras[i].name, what->camera) == 0) {
            b->camera = &b->scene->world_cameras[i];
        }
    }
    return true;
}

static void render(bench *b, const subject *what, const char *settings)
{
    assay_image         *image   = NULL;
    assay_render_options options = assay_render_options_default();
    assay_render_stats   stats;
    bench_require(b->context, assay_method_params(b->context, "splat", &b->params));
    set_all(b, what->settings);
    set_all(b, settings);
    snprintf(b->folder, sizeof b->folder, "/tmp/assay_bench_XXXXXX");
    if (!mkdtemp(b->folder)) {
        exit(1);
    }
    snprintf(b->dump, sizeof b->dump, "%s/dump", b->folder);
    options.width = options.height = b->side;
    options.camera                 = what->camera;
    options.layers                 = "color";
    options.dump                   = b->dump;
    bench_require(b->context, assay_render(b->scene, "splat", b->params, &options, &image, &stats));
    bench_require(b->context, assay_bundle_open(b->context, b->dump, &b->reader));
    printf("%-14s %d x %d, %llu records, rendered in %.1f s on %d threads\n", what->name, b->side,
           b->side, (unsigned long long)stats.records, stats.seconds_render, stats.threads);
    assay_image_destroy(image);
}

static const double *values_of(bench *b, const char *name, size_t columns, assay_array **array_out)
{
    bench_require(b->context,
                  assay_bundle_read_table(b->reader, name, b->pixels, columns, array_out));
    return assay_array_values(*array_out);
}

/* A G-buffer that was dumped. */
typedef struct {
    assay_array        *arrays[2];
    const double       *position, *frame;
    assay_splat_buffer *buffer;
} points;

static points open_points(bench *b, const char *position, const char *frame)
{
    points p;
    p.position = values_of(b, position, 3, &p.arrays[0]);
    p.frame    = values_of(b, frame, 9, &p.arrays[1]);
    bench_require(b->context, assay_splat_buffer_create(b->context, b->side, b->side, &p.buffer));
    assay_splat_buffer_look(p.buffer, b->camera);
    for (size_t i = 0; i < b->pixels; i++) {
        const double *x = p.position + 3 * i, *n = p.frame + 9 * i + 6;
        if (!isnan(x[0])) {
            assay_splat_buffer_set(p.buffer, i, vec3(x[0], x[1], x[2]), vec3(n[0], n[1], n[2]));
        }
    }
    return p;
}

static void close_points(points *p)
{
    assay_splat_buffer_destroy(p->buffer);
    assay_array_destroy(p->arrays[0]);
    assay_array_destroy(p->arrays[1]);
}

/* ---- times ---- */

typedef assay_rgb (*asker)(void *user, size_t pixel, assay_vec3 position, assay_vec3 normal);

/* user: of the octree's questions. */
static void compare(bench *b, points *p, const assay_splat_source *source, const char *what,
                    asker ask, void *user)
{
    const uint32_t count  = assay_record_store_count(source->store);
    double         octree = INFINITY, splat = INFINITY, sums[2] = {0.0, 0.0};
    for (int round = 0; round < ROUNDS; round++) {
        double start = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
        sums[0] = sums[1] = 0.0;
        for (size_t i = 0; i < b->pixels; i++) {
            const double *x = p->position + 3 * i, *n = p->frame + 9 * i + 6;
            sums[0] +=
                isnan(x[0]) ? 0.0 : ask(user, i, vec3(x[0], x[1], x[2]), vec3(n[0], n[1], n[2])).g;
        }
        octree = fmin(octree, bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
        start  = bench_seconds(CLOCK_THREAD_CPUTIME_ID);
        bench_require(b->context, assay_splat_buffer_close(p->buffer));
        bench_require(b->context, assay_splat_records(p->buffer, source, 0, count));
        for (size_t i = 0; i < b->pixels; i++) {
            sums[1] += assay_splat_mean(p->buffer, i).g;
        }
        splat = fmin(splat, bench_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
    }
    printf("%14s %6u %s records: octree %.0f ms, splatting %.0f ms, octree / splatting %.2f\n", "",
           count, what, 1e3 * octree, 1e3 * splat, octree / splat);
    if (!(sums[0] != 0.0 && fabs(sums[0] - sums[1]) <= 1e-9 * fabs(sums[0]))) {
        fprintf(stderr, "bench_splat_scenes: the images differ: %.17g, %.17g\n", sums[0], sums[1]);
        exit(1);
    }
}

typedef struct {
    const assay_record_store *store;
    assay_contributions       found;
} diffuse_user;

static assay_rgb ask_irradiance(void *user, size_t pixel, assay_vec3 position, assay_vec3 normal)
{
    diffuse_user *u = user;
    (void)pixel;
    if (assay_record_store_find(u->store, position, normal, UINT32_MAX, &u->found) != ASSAY_OK) {
        exit(1);
    }
    return u->found.count > 0
               ? assay_record_store_interpolate(u->store, &u->found, position, normal)
               : rgb_grey(0.0);
}

static void compare_irradiance(bench *b, assay_irradiance_cache *cache)
{
    points                   p      = open_points(b, "splat/position", "splat/frame");
    assay_record_store      *store  = assay_irradiance_cache_store(cache);
    const assay_splat_source source = {.store = store, .rules = *assay_record_store_rules(store)};
    diffuse_user             user   = {.store = store};
    compare(b, &p, &source, "irradiance", ask_irradiance, &user);
    assay_contributions_release(&user.found);
    close_points(&p);
}

typedef struct {
    bench                      *bench;
    assay_radiance_cache       *cache;
    const assay_material_grids *grids;
    const double               *brdf;
    double                     *light, *scratch;
    size_t                      count;
} glossy_user;

/* A vertex as far as BRDFs by coefficients look at it. */
static assay_vertex vertex_of(const double *row)
{
    assay_vertex vertex = {.front = true};
    assay_vec3   wo;
    memcpy(&vertex.frame, row, sizeof vertex.frame);
    memcpy(&wo, row + 9, sizeof wo);
    memcpy(&vertex.bsdf.base_color, row + 12, sizeof vertex.bsdf.base_color);
    vertex.wo = frame3_to_world(&vertex.frame, wo);
    return vertex;
}

static assay_rgb ask_radiance(void *user, size_t pixel, assay_vec3 position, assay_vec3 normal)
{
    glossy_user       *u      = user;
    const assay_vertex vertex = vertex_of(u->brdf + BRDF * pixel);
    bool               found  = false;
    assay_rgb          result = rgb_grey(0.0);
    (void)normal;
    bench_require(u->bench->context, assay_radiance_cache_look_up(u->cache, position, &vertex.frame,
                                                                  UINT32_MAX, 0, u->light, &found));
    if (found) {
        bench_require(u->bench->context,
                      assay_material_grids_reflect(u->grids, u->count, &vertex, u->light,
                                                   u->scratch, &result));
    }
    return result;
}

static void compare_radiance(bench *b, assay_radiance_cache *cache, const glossy_materials *made)
{
    points       p     = open_points(b, "splat_glossy/position", "splat_glossy/frame");
    assay_array *brdf  = NULL;
    glossy_user  user  = {.bench = b,
                          .cache = cache,
                          .brdf  = values_of(b, "splat_glossy/brdf", BRDF, &brdf),
                          .count = assay_basis_count(assay_radiance_cache_basis(cache))};
    splat_gloss *gloss = NULL;
    user.light         = malloc(3 * user.count * sizeof *user.light);
    user.scratch       = malloc(3 * user.count * sizeof *user.scratch);
    for (uint32_t i = 0; i < made->count; i++) { /* these scenes have one */
        user.grids = made->grids[i].slope ? &made->grids[i] : user.grids;
    }
    bench_require(b->context, splat_gloss_create(b->context, b->pixels, cache, &gloss));
    for (size_t i = 0; i < b->pixels; i++) {
        const assay_vertex vertex = vertex_of(user.brdf + BRDF * i);
        splat_gloss_set(gloss, i, user.grids, &vertex);
    }
    assay_record_store *store = assay_irradiance_cache_store(assay_radiance_cache_records(cache));
    const assay_splat_source source = {.store = store,
                                       .rules = *assay_record_store_rules(store),
                                       .say   = splat_gloss_say,
                                       .user  = gloss};
    if (user.light && user.scratch && user.grids) {
        compare(b, &p, &source, "radiance", ask_radiance, &user);
    }
    splat_gloss_destroy(gloss);
    free(user.light);
    free(user.scratch);
    assay_array_destroy(brdf);
    close_points(&p);
}

/* ---- scenes ---- */

static void compare_all(bench *b)
{
    assay_radiance_params       read;
    assay_cached_image_settings image;
    glossy_materials            made       = {0};
    assay_irradiance_cache     *irradiance = NULL;
    assay_radiance_cache       *radiance   = NULL;
    bench_require(b->context, assay_radiance_params_read(b->context, "splat", b->params, &read));
    bench_require(b->context,
                  assay_cache_params_read(b->context, b->params, &read.cache.records, &image));
    bench_require(b->context,
                  assay_irradiance_cache_create(b->world, &read.cache.records, 0, &irradiance));
    bench_require(b->context, assay_record_bundle_read(b->context, b->reader, "records", SIZE_MAX,
                                                       assay_irradiance_cache_store(irradiance)));
    compare_irradiance(b, irradiance);
    if (assay_record_bundle_is_there(b->reader, "radiance_records")) {
        bench_require(b->context,
                      assay_radiance_params_materials(b->context, b->scene, &read, &made));
        bench_require(b->context,
                      assay_radiance_cache_create(b->context, irradiance, &read.cache, &radiance));
        bench_require(b->context, assay_radiance_bundle_read(b->context, b->reader,
                                                             "radiance_records", radiance));
        compare_radiance(b, radiance, &made);
    }
    assay_radiance_cache_destroy(radiance);
    assay_irradiance_cache_destroy(irradiance);
    glossy_materials_release(&made);
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *walk)
{
    (void)info;
    (void)kind;
    (void)walk;
    return remove(path);
}

static void run(const subject *what, int side, const char *settings)
{
    bench b = {.side = side, .pixels = (size_t)side * (size_t)side};
    if (assay_context_create(NULL, &b.context) != ASSAY_OK) {
        exit(1);
    }
    if (load(&b, what)) {
        render(&b, what, settings);
        compare_all(&b);
        assay_bundle_close(b.reader);
        nftw(b.folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
        assay_params_destroy(b.params);
        assay_world_destroy(b.world);
        assay_scene_destroy(b.scene);
    }
    assay_context_destroy(b.context);
}

int main(int count, char **argv)
{
    for (size_t i = 0; i < sizeof SUBJECTS / sizeof SUBJECTS[0]; i++) {
        if (count < 2 || strstr(SUBJECTS[i].name, argv[1])) {
            run(&SUBJECTS[i], count > 2 ? atoi(argv[2]) : SIDE, count > 3 ? argv[3] : "");
        }
    }
    return 0;
}
