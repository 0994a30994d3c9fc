/* test_path_target.c - what `target_error` decides, and on how much.
 *
 * One pixel that holds the whole Cornell box is the hard case: a path in 171 sees the
 * lamp, so a handful of samples does not know its variance, and an image that stops on it is too
 * dark.  The mutant stops like that. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "support/failing_context.h"
#include "support/measure.h"

static const char BOX[] = "scenes/cornell-box/cornell-box.gltf";

static assay_scene *load(assay_context *context)
{
    assay_scene *scene = NULL;
    assert_int_equal(assay_scene_load(context, BOX, NULL, &scene), ASSAY_OK);
    return scene;
}

/* Mean of G over `seeds` images of one pixel, with its error from their scatter. */
static measured mean_of_images(assay_scene *scene, const char *target, const char *spp, int seeds)
{
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < seeds; i++) {
        char seed[16];
        snprintf(seed, sizeof seed, "%d", 1000 + i);
        const setting settings[] = {
            {"seed", seed}, {"spp", spp}, {"target_error", target}, {NULL, NULL}};
        assay_image *image = measure_render(scene, settings, 1, 1, "color");
        const double g     = measure_mean(image, "G").value;
        sum += g;
        squares += g * g;
        assay_image_destroy(image);
    }
    const double mean = sum / seeds;
    return (measured){mean, sqrt((squares / seeds - mean * mean) / (seeds - 1.0))};
}

/* Stopping is not seen in the mean: it is that of as many samples without stopping.  With 16
 * samples in the first round, the mean of 16 seeds would be 46 % too low (docs/methods/path.md). */
static void stopping_is_unbiased_enough(void **state)
{
    (void)state;
    assay_context *context = measure_context(2);
    assay_scene   *scene   = load(context);
    const measured truth   = mean_of_images(scene, "0", "4096", 24);
    const measured stopped = mean_of_images(scene, "0.3", "16", 16);
    const measured joint   = {stopped.value,
                              sqrt(stopped.error * stopped.error + truth.error * truth.error)};
    measure_check("stopped", joint, truth.value, 0.0, 0.54 * truth.value);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Renders with a context that keeps its last warning. */
static assay_render_stats render(const setting *settings, int side, char warning[256])
{
    failing_memory       memory  = {0};
    assay_context       *context = failing_context(&memory);
    assay_scene         *scene   = load(context);
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    assay_render_options options = assay_render_options_default();
    assay_render_stats   stats;
    options.width = options.height = side;
    options.layers                 = "color";
    assert_int_equal(assay_method_params(context, "path", &params), ASSAY_OK);
    for (; settings->name; settings++) {
        assert_int_equal(assay_params_set(params, settings->name, settings->value), ASSAY_OK);
    }
    memory.log[0] = '\0';
    assert_int_equal(assay_render(scene, "path", params, &options, &image, &stats), ASSAY_OK);
    snprintf(warning, 256, "%s", memory.log);
    assay_image_destroy(image);
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return stats;
}

/* Reached in silence; missed with a word, and told apart from too few samples to know. */
static void outcome(void **state)
{
    (void)state;
    static const struct {
        setting            settings[4];
        int                side;
        assay_error_target target;
        uint64_t           spp; /* 0: whatever it takes */
        const char        *word;
    } cases[] = {
        {{{"spp", "1"}, {"target_error", "0"}}, 8, ASSAY_TARGET_NONE, 1, ""},
        {{{"spp", "1"}, {"target_error", "1"}}, 8, ASSAY_TARGET_REACHED, 64, ""},
        {{{"spp", "100"}, {"target_error", "1"}}, 8, ASSAY_TARGET_REACHED, 100, ""},
        {{{"spp", "1"}, {"target_error", "1"}}, 4, ASSAY_TARGET_REACHED, 256, ""},
        {{{"spp", "1"}, {"target_error", "0.25"}}, 8, ASSAY_TARGET_REACHED, 0, ""},
        {{{"spp", "1"}, {"target_error", "0.001"}, {"max_spp", "99"}},
         8,
         ASSAY_TARGET_MISSED,
         99,
         "was not reached"},
        {{{"spp", "1"}, {"target_error", "1"}, {"max_spp", "63"}},
         8,
         ASSAY_TARGET_MISSED,
         63,
         "takes 64"},
        {{{"spp", "1"}, {"target_error", "1"}, {"max_spp", "1"}},
         8,
         ASSAY_TARGET_MISSED,
         1,
         "takes 64"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char                     warning[256];
        const assay_render_stats stats = render(cases[i].settings, cases[i].side, warning);
        assert_int_equal(stats.target, cases[i].target);
        assert_true(stats.spp_min == stats.spp_max);
        assert_true(cases[i].spp == 0 || stats.spp_min == cases[i].spp);
        assert_true(cases[i].word[0] ? strstr(warning, cases[i].word) != NULL : !warning[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stopping_is_unbiased_enough),
        cmocka_unit_test(outcome),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
