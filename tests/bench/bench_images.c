/* bench_images.c - how long a verdict on a pair of 1920 x 1080 images with variance takes, of
 * files: R, G and B alone, and all layers that assay writes. */
#include "bench.h"

#include <math.h>

#include "assay/image.h"
#include "assay/verify.h"
#include "core/random.h"

enum { WIDTH = 1920, HEIGHT = 1080, PIXELS = WIDTH * HEIGHT, SAMPLES = 64 };

static const char *const LAYERS[] = {
    "", "Direct.", "Indirect.", "Irradiance.", "IrradianceDirect.", "IrradianceIndirect."};

static float *add(assay_context *context, assay_image *image, const char *prefix, const char *layer,
                  char colour)
{
    char          name[64];
    assay_channel channel;
    snprintf(name, sizeof name, "%s%s%c", prefix, layer, colour);
    bench_require(context, assay_image_add_channel(image, name, ASSAY_CHANNEL_FLOAT, &channel));
    return channel.data.f32;
}

/* A mean of 1 with a deviation of a tenth; mantissas are as full as a renderer's. */
static void fill(float *mean, float *variance, uint64_t seed)
{
    for (uint64_t i = 0; i < PIXELS; i++) {
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, i, 0);
        const double noise  = assay_random_next(&random) + assay_random_next(&random) - 1.0;
        mean[i]             = (float)(1.0 + 0.1 * sqrt(6.0) * noise);
        variance[i]         = (float)(0.01 * (0.9 + 0.2 * assay_random_next(&random)));
    }
}

static void write_image(assay_context *context, const char *path, int layers, uint64_t seed)
{
    assay_image  *image = NULL;
    assay_channel count;
    bench_require(context, assay_image_create(context, WIDTH, HEIGHT, &image));
    for (int l = 0; l < layers; l++) {
        for (int c = 0; c < 3; c++) {
            float *mean = add(context, image, "", LAYERS[l], "RGB"[c]);
            fill(mean, add(context, image, "Variance.", LAYERS[l], "RGB"[c]),
                 100 * seed + (uint64_t)(3 * l + c));
        }
    }
    for (int k = 0; k < (layers > 1 ? 2 : 1); k++) {
        bench_require(context,
                      assay_image_add_channel(image, k ? "SampleCount.Irradiance" : "SampleCount",
                                              ASSAY_CHANNEL_UINT, &count));
        for (int i = 0; i < PIXELS; i++) {
            count.data.u32[i] = SAMPLES;
        }
    }
    bench_require(context, assay_image_write_exr(image, path));
    assay_image_destroy(image);
}

static void verify(assay_context *context, const char *candidate, const char *reference, int layers)
{
    const assay_verify_options options = assay_verify_options_default();
    assay_verdict             *verdict = NULL;
    const double               start   = bench_seconds(CLOCK_MONOTONIC);
    const double               busy    = bench_seconds(CLOCK_PROCESS_CPUTIME_ID);
    bench_require(context,
                  assay_verify_files(context, &candidate, 1, reference, &options, &verdict));
    printf("%d x %d, %2d channels with variance: %s after %.2f s, %.2f s of processor, "
           "%d threads\n",
           WIDTH, HEIGHT, 3 * layers, assay_verdict_kind_text(assay_verdict_whole(verdict)),
           bench_seconds(CLOCK_MONOTONIC) - start, bench_seconds(CLOCK_PROCESS_CPUTIME_ID) - busy,
           assay_context_threads(context));
    assay_verdict_destroy(verdict);
}

int main(void)
{
    char           folder[] = "/tmp/assay-bench-XXXXXX", candidate[64], reference[64];
    assay_context *context  = NULL;
    if (!mkdtemp(folder) || assay_context_create(NULL, &context) != ASSAY_OK) {
        bench_stop("no folder or no memory");
    }
    snprintf(candidate, sizeof candidate, "%s/candidate.exr", folder);
    snprintf(reference, sizeof reference, "%s/reference.exr", folder);
    for (int layers = 1; layers <= 6; layers += 5) {
        write_image(context, candidate, layers, 1);
        write_image(context, reference, layers, 2);
        verify(context, candidate, reference, layers);
    }
    assay_context_destroy(context);
    remove(candidate);
    remove(reference);
    return remove(folder);
}
