/* bench_bundle.c - how long a verdict on a bundle of 100,000 records takes. */
#include "bench.h"

#include <ftw.h>

#include "assay/replay.h"
#include "core/random.h"
#include "io/bundle.h"
#include "math/vec.h"

enum { RECORDS = 100000, SIDE = 128, PIXELS = SIDE * SIDE };

static int remove_entry(const char *path, const struct stat *info, int kind, struct FTW *at)
{
    (void)info;
    (void)kind;
    (void)at;
    return remove(path);
}

static void add(assay_context *context, assay_bundle *bundle, const char *name, const char *unit,
                size_t rows, size_t columns, const double *values)
{
    assay_array *table = NULL;
    bench_require(context, assay_array_create(context, rows, columns, &table));
    memcpy(assay_array_data(table), values, rows * columns * sizeof *values);
    bench_require(context, assay_bundle_add_table(bundle, name, unit, table));
    assay_array_destroy(table);
}

/* The floor of a unit square seen from above, records that some ten of reach every point. */
typedef struct {
    double position[3 * RECORDS], normal[3 * RECORDS], radius[RECORDS], irradiance[3 * RECORDS];
    double gradient[9 * RECORDS];
    double point[3 * PIXELS], frame[9 * PIXELS], albedo[3 * PIXELS];
} floor_data;

static floor_data *make_floor(void)
{
    floor_data  *d      = calloc(1, sizeof *d);
    assay_random random = assay_random_start(1, ASSAY_STAGE_TEST, 0, 0);
    for (size_t i = 0; d && i < RECORDS; i++) {
        d->position[3 * i]     = assay_random_next(&random);
        d->position[3 * i + 2] = assay_random_next(&random);
        d->normal[3 * i + 1]   = 1.0;
        d->radius[i]           = 0.02;
        for (size_t c = 0; c < 3; c++) {
            d->irradiance[3 * i + c] = 1.0 + assay_random_next(&random);
        }
        for (size_t c = 0; c < 9; c++) {
            d->gradient[9 * i + c] = assay_random_next(&random) - 0.5;
        }
    }
    for (size_t i = 0; d && i < PIXELS; i++) {
        d->point[3 * i]     = ((double)(i % SIDE) + 0.5) / SIDE;
        d->point[3 * i + 2] = ((double)(i / SIDE) + 0.5) / SIDE;
        d->frame[9 * i + 7] = 1.0;
        d->albedo[3 * i] = d->albedo[3 * i + 1] = d->albedo[3 * i + 2] = 0.5;
    }
    return d;
}

static void write_bundle(assay_context *context, const floor_data *d, const char *path,
                         const double *weight, const double *radiance)
{
    static const double size[PIXELS] = {0.0};
    assay_bundle       *bundle       = NULL;
    assay_image        *image        = NULL;
    bench_require(context, assay_bundle_create(context, path, &bundle));
    bench_require(context, assay_bundle_describe(bundle, "a", "0.3"));
    bench_require(context, assay_bundle_describe(bundle, "assay:camera.position", "0.5 1 0.5"));
    bench_require(context, assay_bundle_describe(bundle, "assay:camera.forward", "0 -1 0"));
    bench_require(context, assay_bundle_describe(bundle, "assay:camera.right", "1 0 0"));
    bench_require(context, assay_bundle_describe(bundle, "assay:camera.up", "0 0 -1"));
    bench_require(context,
                  assay_bundle_describe(bundle, "assay:camera.yfov", "0.92729521800161223"));
    bench_require(context, assay_image_create(context, SIDE, SIDE, &image));
    bench_require(context, assay_image_add_channel(image, "Z", ASSAY_CHANNEL_FLOAT, NULL));
    bench_require(context, assay_bundle_add_image(bundle, "gbuffer/depth", "m", image));
    assay_image_destroy(image);
    add(context, bundle, "records/position", "m", RECORDS, 3, d->position);
    add(context, bundle, "records/normal", "", RECORDS, 3, d->normal);
    add(context, bundle, "records/radius", "m", RECORDS, 1, d->radius);
    add(context, bundle, "records/irradiance", "W/m2", RECORDS, 3, d->irradiance);
    add(context, bundle, "records/rotation_gradient", "W/(m2 rad)", RECORDS, 9, d->gradient);
    add(context, bundle, "records/translation_gradient", "W/m3", RECORDS, 9, d->gradient);
    add(context, bundle, "splat/position", "m", PIXELS, 3, d->point);
    add(context, bundle, "splat/frame", "", PIXELS, 9, d->frame);
    add(context, bundle, "splat/albedo", "", PIXELS, 3, d->albedo);
    add(context, bundle, "splat/batch.0/weight", "", PIXELS, 1, weight ? weight : size);
    if (radiance) {
        add(context, bundle, "splat/batch.0/radiance", "W/(m2 sr)", PIXELS, 3, radiance);
    }
    bench_require(context, assay_bundle_finish(bundle));
    assay_bundle_destroy(bundle);
}

static void verify(assay_context *context, const char *path)
{
    assay_verdict *verdict = NULL;
    const double   start   = bench_seconds(CLOCK_MONOTONIC),
                 busy      = bench_seconds(CLOCK_PROCESS_CPUTIME_ID);
    bench_require(context, assay_verdict_create(context, "candidate", "reference", &verdict));
    bench_require(context,
                  assay_verify_bundle(context, path, path, NULL, ASSAY_PRECISION_FLOAT, verdict));
    printf("%d records on %d x %d pixels: %s after %.2f s, %.2f s of processor, %d threads\n",
           RECORDS, SIDE, SIDE, assay_verdict_kind_text(assay_verdict_whole(verdict)),
           bench_seconds(CLOCK_MONOTONIC) - start, bench_seconds(CLOCK_PROCESS_CPUTIME_ID) - busy,
           assay_context_threads(context));
    assay_verdict_destroy(verdict);
}

int main(void)
{
    char           root[]  = "/tmp/assay-bench-XXXXXX", path[64], made[64], file[128];
    assay_context *context = NULL;
    assay_array   *weight = NULL, *radiance = NULL;
    floor_data    *d = make_floor();
    if (!d || !mkdtemp(root) || assay_context_create(NULL, &context) != ASSAY_OK) {
        return 3;
    }
    snprintf(path, sizeof path, "%s/in", root);
    snprintf(made, sizeof made, "%s/made", root);
    write_bundle(context, d, path, NULL, NULL);
    const assay_replay_options options = {.stage = "splat", .in = path, .out = made};
    bench_require(context, assay_replay(context, &options));
    snprintf(file, sizeof file, "%s/splat/batch.0/weight.npy", made);
    bench_require(context, assay_array_read_npy(context, file, &weight));
    snprintf(file, sizeof file, "%s/splat/batch.0/radiance.npy", made);
    bench_require(context, assay_array_read_npy(context, file, &radiance));
    snprintf(path, sizeof path, "%s/whole", root);
    write_bundle(context, d, path, assay_array_values(weight), assay_array_values(radiance));
    verify(context, path);
    assay_array_destroy(weight);
    assay_array_destroy(radiance);
    assay_context_destroy(context);
    free(d);
    return nftw(root, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}
