/* cache_convergence.c - the tables of docs/methods/irradiance-cache.md and radiance-cache.md: error
 * of both caching methods against `path` with the same bounces, by accuracy a and by cells M.
 *
 *     cache_convergence [NAME [A ...]]     part of a table's name; accuracies
 *
 * The relative error (docs/conventions.md, all channels) of an image x is taken against two
 * independent images by path, a and b: the mean of (x - a)(x - b) is free of their noise.  What is
 * left of it, the standard error of that mean, is printed as the error that cannot be told from 0.
 * The noise of x itself counts; where a table has two runs x and y of other random numbers, the
 * mean of (x - a)(y - b) is free of that, too, and tells what is systematic. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assay/render.h"

enum { CHANNELS = 3, MOST_ACCURACIES = 8, COLUMNS = 4, RUNS = 2 };

static const char *const ACCURACY[] = {"0.4", "0.2", "0.1", "0.05"};

static const struct {
    const char *theta, *phi, *gradient_limit;
} COLUMN[COLUMNS] = {
    {"8", "25", "off"}, {"16", "50", "off"}, {"32", "100", "off"}, {"16", "50", "on"}};

typedef struct {
    const char *name, *method, *scene, *camera;
    const char *bounces;
    const char *reference; /* samples a pixel of path                                     */
    const char *layer;     /* that is compared                                            */
    int         material;  /* over its pixels alone; -1: all                              */
    bool        diffuse;   /* --force-diffuse                                             */
    int         side;      /* pixels                                                      */
    int         rows;      /* of ACCURACY                                                 */
    int         columns;   /* the first ones of COLUMN                                    */
    int         runs;      /* 2: with what is systematic                                  */
} table;

#define CORNELL "scenes/cornell-box/cornell-box.gltf"
#define GLOSSY "scenes/cornell-box-glossy/cornell-box-glossy.gltf"
#define SPONZA "sponza_dabrovic/sponza_dabrovic.glb"
#define KITCHEN "lux_kitchen/lux_kitchen.glb"

static const table TABLES[] = {
    {"Cornell box", "irradiance-cache", CORNELL, NULL, "inf", "1024", "IrradianceIndirect", -1,
     true, 48, 4, COLUMNS, 1},
    {"Cornell box", "irradiance-cache", CORNELL, NULL, "inf", "1024", "Indirect", -1, true, 48, 4,
     COLUMNS, 1},
    {"Cornell box, one bounce", "irradiance-cache", CORNELL, NULL, "2", "1024",
     "IrradianceIndirect", -1, true, 48, 4, COLUMNS, 1},
    {"Sponza, atrium", "irradiance-cache", SPONZA, "atrium", "inf", "512", "IrradianceIndirect", -1,
     true, 32, 3, COLUMNS, 1},
    {"Sponza, atrium", "irradiance-cache", SPONZA, "atrium", "inf", "512", "Indirect", -1, true, 32,
     3, COLUMNS, 1},
    {"Kitchen", "irradiance-cache", KITCHEN, NULL, "inf", "512", "IrradianceIndirect", -1, true, 32,
     3, COLUMNS, 1},
    {"Kitchen", "irradiance-cache", KITCHEN, NULL, "inf", "512", "Indirect", -1, true, 32, 3,
     COLUMNS, 1},
    {"Sponza, own materials, one bounce", "radiance-cache", SPONZA, "atrium", "2", "4096",
     "Indirect", -1, false, 16, 4, 2, RUNS},
    {"Sponza, own materials", "radiance-cache", SPONZA, "atrium", "inf", "4096", "Indirect", -1,
     false, 16, 3, 2, RUNS},
    {"Kitchen, own materials, one bounce", "radiance-cache", KITCHEN, NULL, "2", "4096", "Indirect",
     -1, false, 16, 4, 2, RUNS},
    {"Kitchen, own materials", "radiance-cache", KITCHEN, NULL, "inf", "4096", "Indirect", -1,
     false, 16, 3, 2, RUNS},
    {"Glossy box, its wall", "radiance-cache", GLOSSY, NULL, "inf", "2048", "Indirect", 4, false,
     48, 4, COLUMNS, 1},
    {"Glossy box, all of it", "radiance-cache", GLOSSY, NULL, "inf", "2048", "Indirect", -1, false,
     48, 4, COLUMNS, 1},
};

enum { TABLE_COUNT = sizeof TABLES / sizeof TABLES[0] };

static void require(assay_context *context, assay_status status)
{
    if (status != ASSAY_OK) {
        fprintf(stderr, "cache_convergence: %s\n", assay_context_error(context));
        exit(1);
    }
}

/* ---- images ---- */

typedef struct {
    assay_context     *context;
    assay_scene       *scene;
    const table       *about;
    assay_image       *reference[2];
    int                rows; /* accuracies */
    const char *const *accuracy;
} study;

static void set(const study *s, assay_params *params, const char *name, const char *value)
{
    require(s->context, assay_params_set(params, name, value));
}

static assay_image *render(const study *s, const char *method, assay_params *params, uint64_t seed,
                           uint64_t *records_out)
{
    assay_render_options options = assay_render_options_default();
    assay_render_stats   stats;
    assay_image         *image = NULL;
    options.width = options.height = s->about->side;
    options.camera                 = s->about->camera;
    options.layers = strcmp(s->about->method, "radiance-cache") == 0 ? "split,gbuffer"
                                                                     : "split,irradiance,gbuffer";
    options.seed   = seed;
    require(s->context, assay_render(s->scene, method, params, &options, &image, &stats));
    *records_out = stats.records;
    assay_params_destroy(params);
    return image;
}

static assay_image *render_path(const study *s, uint64_t seed)
{
    assay_params *params = NULL;
    uint64_t      records;
    require(s->context, assay_method_params(s->context, "path", &params));
    set(s, params, "spp", s->about->reference);
    set(s, params, "bounces", s->about->bounces);
    return render(s, "path", params, seed, &records);
}

static assay_image *render_cached(const study *s, int row, int column, int run,
                                  uint64_t *records_out)
{
    assay_params *params = NULL;
    require(s->context, assay_method_params(s->context, s->about->method, &params));
    set(s, params, "spp", "16");
    set(s, params, "bounces", s->about->bounces);
    set(s, params, "a", s->accuracy[row]);
    set(s, params, "theta_strata", COLUMN[column].theta);
    set(s, params, "phi_strata", COLUMN[column].phi);
    set(s, params, "gradient_limit", COLUMN[column].gradient_limit);
    return render(s, s->about->method, params, run == 0 ? 1 : 4, records_out);
}

/* ---- errors ---- */

typedef struct {
    double error;  /* relative, rms                              */
    double unseen; /* the error that noise of the references is  */
    double bias;   /* of the mean, in parts of it                */
} verdict;

static const float *channel_of(const assay_image *image, const char *layer, int c)
{
    char          name[64];
    assay_channel found;
    snprintf(name, sizeof name, "%s.%c", layer, "RGB"[c]);
    if (!assay_image_find_channel(image, name, &found)) {
        exit(1);
    }
    return found.data.f32;
}

/* Of two runs, or of one with itself. */
static verdict judge(const study *s, const table *about, assay_image *const runs[RUNS])
{
    assay_channel id;
    const int     pixels = about->side * about->side;
    double        sum = 0.0, squares = 0.0, mean_x = 0.0, mean_truth = 0.0, count = 0.0;
    if (!assay_image_find_channel(s->reference[0], "MaterialId", &id)) {
        exit(1);
    }
    for (int c = 0; c < CHANNELS; c++) {
        const float *x    = channel_of(runs[0], about->layer, c);
        const float *y    = channel_of(runs[1], about->layer, c);
        const float *a    = channel_of(s->reference[0], about->layer, c);
        const float *b    = channel_of(s->reference[1], about->layer, c);
        double       mean = 0.0;
        double       seen = 0.0;
        for (int pass = 0; pass < 2; pass++) {
            for (int i = 0; i < pixels; i++) {
                if (about->material >= 0 && id.data.u32[i] != (uint32_t)about->material) {
                    continue;
                }
                const double truth = 0.5 * ((double)a[i] + b[i]);
                if (pass == 0) {
                    mean += truth;
                    seen += 1.0;
                    continue;
                }
                const double scale = truth * truth + 0.01 * mean * mean / (seen * seen);
                const double one   = 0.5 / scale *
                                   (((double)x[i] - a[i]) * ((double)y[i] - b[i]) +
                                    ((double)y[i] - a[i]) * ((double)x[i] - b[i]));
                sum += one;
                squares += one * one;
                count += 1.0;
                mean_x += 0.5 * ((double)x[i] + y[i]);
                mean_truth += truth;
            }
        }
    }
    const double mean   = sum / count,
                 spread = sqrt(fmax(squares / count - mean * mean, 0.0) / count);
    return (verdict){sqrt(fmax(mean, 0.0)), sqrt(spread), mean_x / mean_truth - 1.0};
}

/* ---- tables ---- */

static bool same_scene(const table *a, const table *b)
{
    return strcmp(a->scene, b->scene) == 0 && strcmp(a->method, b->method) == 0 &&
           strcmp(a->bounces, b->bounces) == 0;
}

static bool open_study(study *s)
{
    char                path[512];
    const char         *shared  = getenv("ASSAY_SHARED_SCENES");
    assay_scene_options options = assay_scene_options_default();
    options.force_diffuse       = s->about->diffuse;
    snprintf(path, sizeof path, "%s/%s",
             strncmp(s->about->scene, "scenes/", 7) == 0 ? "."
             : shared                                    ? shared
                                                         : "../shared/scenes",
             s->about->scene);
    if (access(path, R_OK) != 0) {
        printf("%s: not there, skipped\n\n", s->about->name);
        return false;
    }
    require(s->context, assay_scene_load(s->context, path, &options, &s->scene));
    s->reference[0] = render_path(s, 2);
    s->reference[1] = render_path(s, 3);
    return true;
}

typedef assay_image *pictures[MOST_ACCURACIES][COLUMNS][RUNS];

static void print_cell(const study *s, const table *about, assay_image *const runs[RUNS])
{
    assay_image *const first[RUNS] = {runs[0], runs[0]}, *const second[RUNS] = {runs[1], runs[1]};
    const verdict one = judge(s, about, first);
    if (about->runs == 1) {
        printf(" %.3f (%+.1f %%) |", one.error, 100.0 * one.bias);
        return;
    }
    const verdict other = judge(s, about, second), both = judge(s, about, runs);
    printf(" %.3f, %.3f (%+.1f %%) |",
           sqrt(0.5 * (one.error * one.error + other.error * other.error)), both.error,
           100.0 * both.bias);
}

static void print_table(const study *s, const table *about, pictures images,
                        uint64_t records[][COLUMNS])
{
    const int last = about->columns - 1;
    printf("%s, %s, %s%s\n\n| a | records |", about->name, about->method, about->layer,
           about->runs == RUNS ? ": error, and what of it is systematic" : "");
    for (int m = 0; m < about->columns; m++) {
        printf(" %s x %s%s |", COLUMN[m].theta, COLUMN[m].phi,
               strcmp(COLUMN[m].gradient_limit, "on") == 0 ? ", gradient_limit" : "");
    }
    printf(" not told from 0 |\n|---|---|%.*s---|\n", 4 * about->columns, "---|---|---|---|");
    for (int k = 0; k < s->rows; k++) {
        printf("| %s | %llu, %llu |", s->accuracy[k],
               (unsigned long long)records[k][last == COLUMNS - 1 ? 2 : 0],
               (unsigned long long)records[k][last]);
        for (int m = 0; m < about->columns; m++) {
            print_cell(s, about, images[k][m]);
        }
        printf(" %.3f |\n", judge(s, about, images[k][last]).unseen);
    }
    printf("\n");
    fflush(stdout);
}

static void destroy_all(const study *s, pictures images)
{
    for (int k = 0; k < s->rows; k++) {
        for (int m = 0; m < s->about->columns; m++) {
            for (int r = 0; r < s->about->runs; r++) {
                assay_image_destroy(images[k][m][r]);
            }
        }
    }
    assay_image_destroy(s->reference[0]);
    assay_image_destroy(s->reference[1]);
    assay_scene_destroy(s->scene);
}

/* All tables of the first one's scene, method and bounces. */
static void work_on(study *s, const table *first, const char *wanted)
{
    pictures images                            = {{{NULL}}};
    uint64_t records[MOST_ACCURACIES][COLUMNS] = {{0}};
    if (!open_study(s)) {
        return;
    }
    for (int k = 0; k < s->rows; k++) {
        for (int m = 0; m < first->columns; m++) {
            for (int r = 0; r < first->runs; r++) {
                images[k][m][r] = render_cached(s, k, m, r, &records[k][m]);
            }
            images[k][m][1] = images[k][m][first->runs - 1];
        }
    }
    for (const table *t = first; t < TABLES + TABLE_COUNT; t++) {
        if (same_scene(t, first) && strstr(t->name, wanted)) {
            print_table(s, t, images, records);
        }
    }
    destroy_all(s, images);
}

int main(int count, char **argv)
{
    const assay_context_options options = {.threads = 1};
    const char                 *wanted  = count > 1 ? argv[1] : "";
    assay_context              *context = NULL;
    const char                 *accuracy[MOST_ACCURACIES];
    int                         rows = 0;
    for (int i = 2; i < count && rows < MOST_ACCURACIES; i++) {
        accuracy[rows++] = argv[i];
    }
    if (assay_context_create(&options, &context) != ASSAY_OK) {
        return 1;
    }
    for (size_t i = 0; i < TABLE_COUNT; i++) {
        const bool done =
            i > 0 && same_scene(&TABLES[i], &TABLES[i - 1]) && strstr(TABLES[i - 1].name, wanted);
        if (strstr(TABLES[i].name, wanted) && !done) {
            study s = {.context  = context,
                       .about    = &TABLES[i],
                       .rows     = rows ? rows : TABLES[i].rows,
                       .accuracy = rows ? accuracy : ACCURACY};
            work_on(&s, &TABLES[i], wanted);
        }
    }
    assay_context_destroy(context);
    return 0;
}
