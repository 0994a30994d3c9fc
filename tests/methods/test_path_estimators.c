/* test_path_estimators.c - `nee`, `bsdf` and `mis` measure the same light on real scenes.
 *
 * Images, each from a seed of its own, are cut into 16 blocks; the difference of two estimators'
 * block means over the root of the sum of their variances is a z-score.  If they agree, the sum of
 * the squares is chi-square of 16 degrees: a root mean square over 1.8 has a probability of 1e-5.
 * Two is asked, since variances are estimated from few samples of heavy-tailed light.  The mutant,
 * one estimator's light raised by a tenth or a fifth, must be beyond it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
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
    double rms, largest;
} scores;

static scores compare(const blocks *a, const blocks *b, double factor)
{
    scores s     = {0, 0};
    int    count = 0;
    for (int i = 0; i < BLOCKS; i++) {
        const double variance = a->variance[i] + factor * factor * b->variance[i];
        if (variance > 0.0) {
            const double z = fabs(a->mean[i] - factor * b->mean[i]) / sqrt(variance);
            s.rms += z * z;
            s.largest = z > s.largest ? z : s.largest;
            count++;
        }
    }
    s.rms = count ? sqrt(s.rms / count) : 0.0;
    return s;
}

typedef struct {
    const char *file;
    const char *spp[3]; /* of nee, bsdf, mis: the weak ones take more */
    double      sky, mutant;
} scene_case;

static const scene_case SCENES[] = {
    {"nori_cbox/nori_cbox.glb", {"256", "1024", "256"}, 0.0, 1.2},
    {"pbrt2_bunny/pbrt2_bunny.glb", {"128", "128", "128"}, 0.0, 1.1},
    {"lux_kitchen/lux_kitchen.glb", {"256", "256", "128"}, 0.0, 1.2},
    {"sponza_dabrovic/sponza_dabrovic_nolight.glb", {"256", "128", "128"}, 1.0, 1.2},
    {"bitterli_living_room/bitterli_living_room.glb", {"256", "128", "128"}, 1.0, 1.2},
};

/* Root mean square of the scores that is still agreement. */
static const double LIMIT = 2.0;

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
            printf("#| %-46s %-12s mis/%-4s z rms %.2f largest %.2f (mutant: %.2f)\n", c->file,
                   CHANNELS[k], ESTIMATORS[e], s.rms, s.largest, wrong.rms);
            if (!(s.rms < LIMIT && s.largest < 6.0)) {
                fail_msg("%s: %s of mis and %s disagree: rms %.3f, largest %.3f", c->file,
                         CHANNELS[k], ESTIMATORS[e], s.rms, s.largest);
            }
            assert_true(wrong.rms > LIMIT);
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
