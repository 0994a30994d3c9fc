/* bench_caches.c - time to the same error: irradiance-cache against path.
 *
 *     bench_caches [VIEW [SETTINGS]]     part of a view's name; name=value,... of irradiance-cache
 *
 * On a view, irradiance-cache renders once, and path as often as it takes to know its cost: both on
 * one thread, by processor time.  The relative error of an image (docs/conventions.md, over all
 * pixels and channels) is measured against two independent references by path: the mean of the
 * product of the two differences is free of their noise.  Path's own error is that of its measured
 * variance; it falls with the square root of its samples, which gives the time that it would take
 * to the error of irradiance-cache. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/render.h"
#include "bench/bench.h"
#include "core/numerics.h"

enum { SIDE = 256, CHANNELS = 3, REFERENCE_SPP = 128 };

typedef struct {
    const char *name, *scene, *camera;
    const char *bounces;  /* of both methods                       */
    const char *settings; /* of irradiance-cache: name=value,...   */
    double      asked;    /* times less time than path             */
} view;

#define CORNELL "scenes/cornell-box/cornell-box.gltf"
#define SPONZA "sponza_dabrovic/sponza_dabrovic.glb"
#define CACHES "estimator=nee,secondary=cache,gradient_limit=on,"
#define BOX CACHES "spp=64,a=0.25,theta_strata=16,phi_strata=50,levels=4,r_min=0.06"
#define HALL CACHES "spp=32,a=0.3,theta_strata=8,phi_strata=25,levels=3,r_min=2"

static const view VIEWS[] = {
    {"Cornell box, all bounces", CORNELL, NULL, "inf", BOX, 25},
    {"Cornell box, one bounce", CORNELL, NULL, "2", BOX, 7},
    {"Sponza, atrium", SPONZA, "atrium", "inf", HALL, 15},
    {"Sponza, atrium, one bounce", SPONZA, "atrium", "2", HALL, 9},
    {"Sponza, lower arcade", SPONZA, "lower_arcade", "inf", HALL, 60},
};

typedef struct {
    assay_image       *image;
    assay_render_stats stats;
    double             seconds;
} result;

static void set(assay_context *context, assay_params *params, const char *name, const char *value)
{
    bench_require(context, assay_params_set(params, name, value));
}

/* name=value,name=value */
static void set_all(assay_context *context, assay_params *params, const char *settings)
{
    while (*settings) {
        char name[64], value[64];
        int  length = 0;
        if (sscanf(settings, "%63[^=]=%63[^,]%n", name, value, &length) != 2) {
            exit(1);
        }
        set(context, params, name, value);
        settings += length + (settings[length] == ',');
    }
}

static result render(assay_context *context, assay_scene *scene, const view *v, const char *method,
                     const char *settings, uint64_t seed)
{
    assay_render_options options = assay_render_options_default();
    assay_params        *params  = NULL;
    result               r       = {0};
    options.width = options.height = SIDE;
    options.camera                 = v->camera;
    options.layers                 = "color,split";
    options.seed                   = seed;
    bench_require(context, assay_method_params(context, method, &params));
    set(context, params, "bounces", v->bounces);
    set_all(context, params, settings);
    const double start = bench_seconds(CLOCK_PROCESS_CPUTIME_ID);
    bench_require(context, assay_render(scene, method, params, &options, &r.image, &r.stats));
    r.seconds = bench_seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
    assay_params_destroy(params);
    return r;
}

static const float *pixels(const assay_image *image, const char *prefix, int channel)
{
    char          name[32];
    assay_channel found;
    snprintf(name, sizeof name, "%s%c", prefix, "RGB"[channel]);
    if (!assay_image_find_channel(image, name, &found)) {
        exit(1);
    }
    return found.data.f32;
}

/* Squared relative error of a layer of an image against two references, in parts of the whole
 * color; of NULL: of the first reference's own variance, for one sample a pixel.  What the color is
 * is taken from `known`: a reference's noise would be in both factors. */
static double squared_error(const char *layer, const assay_image *image, const assay_image *known,
                            const assay_image *one, const assay_image *two)
{
    double sum = 0.0;
    for (int c = 0; c < CHANNELS; c++) {
        const float *a = pixels(one, "", c), *b = pixels(two, "", c);
        const float *p = pixels(one, layer, c), *q = pixels(two, layer, c);
        const float *x    = image ? pixels(image, layer, c) : NULL;
        const float *norm = pixels(known, "", c);
        const float *v    = pixels(one, "Variance.", c);
        double       mean = 0.0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            mean += 0.5 * ((double)a[i] + b[i]) / (SIDE * SIDE);
        }
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double truth = norm[i];
            const double error =
                x ? ((double)x[i] - p[i]) * ((double)x[i] - q[i]) : (double)v[i] * REFERENCE_SPP;
            sum += error / (truth * truth + 0.01 * mean * mean);
        }
    }
    return sum / (CHANNELS * SIDE * SIDE);
}

static void compare(assay_context *context, const view *v, const char *settings)
{
    char                path[512];
    assay_scene        *scene   = NULL;
    assay_scene_options options = assay_scene_options_default();
    options.force_diffuse       = true;
    if (!bench_find_scene(path, sizeof path, v->scene)) {
        printf("%-28s not there: skipped\n", v->name);
        return;
    }
    bench_require(context, assay_scene_load(context, path, &options, &scene));
    const result cache = render(context, scene, v, "irradiance-cache", settings, 1);
    char         spp[16];
    snprintf(spp, sizeof spp, "spp=%d", REFERENCE_SPP);
    const result one = render(context, scene, v, "path", spp, 2);
    const result two = render(context, scene, v, "path", spp, 3);
    const double e   = squared_error("", cache.image, cache.image, one.image, two.image);
    const double s   = squared_error("", NULL, cache.image, one.image, two.image);
    /* Samples, and so seconds, that path takes to the same error. */
    const double a_sample = 0.5 * (one.seconds + two.seconds) / REFERENCE_SPP;
    const double path_for = a_sample * s / e;
    printf("%-28s relative error %.4f: %7llu records, %.1f s; path %.0f samples, %.0f s: %.1f "
           "times (asked: %.0f)\n",
           v->name, sqrt(e), (unsigned long long)cache.stats.records, cache.seconds, s / e,
           path_for, path_for / cache.seconds, v->asked);
    printf("%-28s squared error %.2e: direct light %.2e, indirect %.2e\n", "", e,
           squared_error("Direct.", cache.image, cache.image, one.image, two.image),
           squared_error("Indirect.", cache.image, cache.image, one.image, two.image));
    assay_image_destroy(cache.image);
    assay_image_destroy(one.image);
    assay_image_destroy(two.image);
    assay_scene_destroy(scene);
}

int main(int count, char **argv)
{
    const assay_context_options options = {.threads = 1};
    assay_context              *context = NULL;
    if (assay_context_create(&options, &context) != ASSAY_OK) {
        return 1;
    }
    for (size_t i = 0; i < sizeof VIEWS / sizeof VIEWS[0]; i++) {
        if (count < 2 || strstr(VIEWS[i].name, argv[1])) {
            compare(context, &VIEWS[i], count > 2 ? argv[2] : VIEWS[i].settings);
        }
    }
    assay_context_destroy(context);
    return 0;
}
