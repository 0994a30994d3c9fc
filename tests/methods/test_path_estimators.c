/* test_path_estimators.c - `nee`, `bsdf` and `mis` measure the same light on real scenes.
 *
 * Images, each from a seed of its own, are cut into 16 blocks; the difference of two estimators'
 * block means over the root of the sum of their variances is a z-score.  If they agree and the
 * variances are honest, these are normal, and
 *   - the half of them that is largest begins above 1.5 with a probability of 5e-4 (8 or more of
 *     16 of probability 0.134): 2 % for all 40 comparisons, were they independent;
 *   - their root mean square is above 1.6 with a probability of 6e-4 (chi-square of 16 degrees);
 *   - one of the 640 is above 5 with a probability of 4e-4.
 * (Blocks that see nothing do not count; of the 12 that see the bunny, half is 2e-3.)
 * Light sampling near a light divides by the square of its distance: most blocks then miss rare
 * bright samples, and their variances with them.  Where that is the rule (`heavy`), the first
 * statistic, which does not mind a few such blocks, judges alone with the last.
 * The mutant, one estimator's light raised by a tenth or a fifth, must be beyond the first. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/measure.h"

enum { SIDE = 32, BLOCK = 8, BLOCKS = (SIDE / BLOCK) * (SIDE / BLOCK) };

typedef struct {
    double mean[BLOCKS], variance[BLOCKS];
} blocks;

static blocks cut(const assay_image *image, const char *channel)
{
    blocks        out = {{0}, {0}};
    char          name[64];
    assay_channel value, variance;
    snprintf(name, sizeof name, "Variance.%s", channel);
    assert_true(assay_image_find_channel(image, channel, &value));
    assert_true(assay_image_find_channel(image, name, &variance));
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int b = i / SIDE / BLOCK * (SIDE / BLOCK) + i % SIDE / BLOCK;
        out.mean[b] += value.data.f32[i] / (double)(BLOCK * BLOCK);
        out.variance[b] += variance.data.f32[i] / (double)(BLOCK * BLOCK * BLOCK * BLOCK);
    }
    return out;
}

typedef struct {
    double upper_half, rms, largest; /* upper_half: the least of the larger half */
} scores;

static int descending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

static scores compare(const blocks *a, const blocks *b, double factor)
{
    double z[BLOCKS] = {0};
    double squares   = 0.0;
    int    count     = 0;
    for (int i = 0; i < BLOCKS; i++) {
        const double variance = a->variance[i] + factor * factor * b->variance[i];
        if (variance > 0.0) { /* else the block sees nothing at all */
            z[count] = fabs(a->mean[i] - factor * b->mean[i]) / sqrt(variance);
            squares += z[count] * z[count];
            count++;
        }
    }
    assert_true(count >= 8);
    qsort(z, (size_t)count, sizeof z[0], descending);
    return (scores){z[count / 2 - 1], sqrt(squares / count), z[0]};
}

typedef struct {
    const char *file;
    const char *spp[3]; /* of nee, bsdf, mis: the weak ones take more */
    double      sky, mutant;
    bool        heavy; /* light sampling has a heavy tail */
} scene_case;

static const scene_case SCENES[] = {
    {"nori_cbox/nori_cbox.glb", {"256", "1024", "256"}, 0.0, 1.2, false},
    {"pbrt2_bunny/pbrt2_bunny.glb", {"128", "128", "128"}, 0.0, 1.1, false},
    {"lux_kitchen/lux_kitchen.glb", {"256", "256", "128"}, 0.0, 1.2, true},
    {"sponza_dabrovic/sponza_dabrovic_nolight.glb", {"256", "128", "128"}, 1.0, 1.2, false},
    {"bitterli_living_room/bitterli_living_room.glb", {"256", "128", "128"}, 1.0, 1.2, false},
};

static const double UPPER_HALF = 1.5, RMS = 1.6, LARGEST = 5.0;

static void check_scene(const char *folder, const scene_case *c)
{
    static const char *const ESTIMATORS[3] = {"nee", "bsdf", "mis"};
    static const char *const SEEDS[3]      = {"1", "2", "3"};
    static const char *const CHANNELS[]    = {"R", "G", "B", "Irradiance.G"};
    char                     path[512];
    assay_image             *images[3];
    assay_context           *context = measure_context(0);
    assay_scene             *scene   = NULL;
    assay_scene_options      options = assay_scene_options_default();
    options.background               = (assay_rgb){c->sky, c->sky, c->sky};
    snprintf(path, sizeof path, "%s/%s", folder, c->file);
    if (assay_scene_load(context, path, &options, &scene) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    for (int e = 0; e < 3; e++) {
        const setting settings[] = {{"estimator", ESTIMATORS[e]},
                                    {"spp", c->spp[e]},
                                    {"bounces", "3"},
                                    {"seed", SEEDS[e]},
                                    {NULL, NULL}};
        images[e]                = measure_render(scene, settings, SIDE, SIDE, "color,irradiance");
    }
    for (size_t k = 0; k < sizeof CHANNELS / sizeof CHANNELS[0]; k++) {
        for (int e = 0; e < 2; e++) {
            const blocks a = cut(images[2], CHANNELS[k]), b = cut(images[e], CHANNELS[k]);
            const scores s = compare(&a, &b, 1.0), wrong = compare(&a, &b, c->mutant);
            const bool   tail = c->heavy && e == 0;
            printf(
                "#| %-46s %-12s mis/%-4s z upper half %.2f rms %.2f largest %.2f (mutant: %.2f)\n",
                c->file, CHANNELS[k], ESTIMATORS[e], s.upper_half, s.rms, s.largest,
                wrong.upper_half);
            if (s.upper_half > UPPER_HALF || s.largest > LARGEST || (s.rms > RMS && !tail)) {
                fail_msg("%s: %s of mis and %s disagree: upper half %.3f, rms %.3f, largest %.3f",
                         c->file, CHANNELS[k], ESTIMATORS[e], s.upper_half, s.rms, s.largest);
            }
            assert_true(wrong.upper_half > UPPER_HALF);
        }
    }
    for (int e = 0; e < 3; e++) {
        assay_image_destroy(images[e]);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void estimators_agree(void **state)
{
    (void)state;
    const char *folder = measure_shared_scenes();
    if (!folder) {
        skip();
    }
    for (size_t i = 0; i < sizeof SCENES / sizeof SCENES[0]; i++) {
        check_scene(folder, &SCENES[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(estimators_agree)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
