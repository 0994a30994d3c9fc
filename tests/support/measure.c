/* measure.c - see measure.h. */
#include "measure.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

assay_context *measure_context(int threads)
{
    const assay_context_options options = {.threads = threads};
    assay_context              *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    return context;
}

static void require(assay_context *context, assay_status status)
{
    if (status != ASSAY_OK) {
        fail_msg("%s: %s", assay_status_text(status), assay_context_error(context));
    }
}

/* What is no parameter but stands among the settings. */
static const char *special(const setting *settings, const char *name, const char *otherwise)
{
    for (; settings && settings->name; settings++) {
        if (strcmp(settings->name, name) == 0) {
            return settings->value;
        }
    }
    return otherwise;
}

/* The library keeps a scene's context to itself, so parameters are made with one of their own. */
static assay_params *make_params(assay_context *context, const setting *settings)
{
    assay_params *params = NULL;
    require(context, assay_method_params(context, special(settings, "method", "path"), &params));
    for (; settings && settings->name; settings++) {
        if (strcmp(settings->name, "seed") == 0 || strcmp(settings->name, "method") == 0) {
            continue;
        }
        require(context, assay_params_set(params, settings->name, settings->value));
    }
    return params;
}

assay_image *measure_render(assay_scene *scene, const setting *settings, int width, int height,
                            const char *layers)
{
    assay_context       *context = measure_context(1);
    assay_params        *params  = make_params(context, settings);
    assay_render_options options = assay_render_options_default();
    assay_image         *image   = NULL;
    options.width                = width;
    options.height               = height;
    options.layers               = layers;
    options.seed                 = strtoull(special(settings, "seed", "0"), NULL, 10);
    const assay_status status =
        assay_render(scene, special(settings, "method", "path"), params, &options, &image, NULL);
    assay_params_destroy(params);
    assay_context_destroy(context);
    assert_int_equal(status, ASSAY_OK);
    return image;
}

measured measure_mean(const assay_image *image, const char *channel)
{
    char          name[128];
    assay_channel value, variance;
    snprintf(name, sizeof name, "Variance.%s", channel);
    assert_true(assay_image_find_channel(image, channel, &value));
    assert_true(assay_image_find_channel(image, name, &variance));
    const size_t pixels = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
    double       sum = 0.0, squares = 0.0;
    for (size_t i = 0; i < pixels; i++) {
        sum += value.data.f32[i];
        squares += variance.data.f32[i];
    }
    return (measured){sum / (double)pixels, sqrt(squares) / (double)pixels};
}

double measure_difference(const assay_image *a, const assay_image *b, const char *channel)
{
    assay_channel x, y;
    const size_t  pixels = (size_t)assay_image_width(a) * (size_t)assay_image_height(a);
    double        sum    = 0.0;
    assert_true(assay_image_find_channel(a, channel, &x));
    assert_true(assay_image_find_channel(b, channel, &y));
    for (size_t i = 0; i < pixels; i++) {
        sum += fabs((double)x.data.f32[i] - y.data.f32[i]);
    }
    return sum;
}

assay_array *measure_probes(assay_scene *scene, const setting *settings, const double *points,
                            int count)
{
    assay_context *context = measure_context(1);
    assay_params  *params  = make_params(context, settings);
    assay_array   *table = NULL, *result = NULL;
    require(context, assay_array_create(context, (size_t)count, 6, &table));
    memcpy(assay_array_data(table), points, (size_t)count * 6 * sizeof *points);
    const uint64_t     seed = strtoull(special(settings, "seed", "1"), NULL, 10);
    const assay_status status =
        assay_render_probes(scene, "path", params, seed, table, &result, NULL);
    assay_array_destroy(table);
    assay_params_destroy(params);
    assert_int_equal(status, ASSAY_OK);
    assay_context_destroy(context);
    return result;
}

static int find_column(const char *column)
{
    char name[32];
    for (int i = 0; assay_probe_column_name(i, name); i++) {
        if (strcmp(name, column) == 0) {
            return i;
        }
    }
    fail_msg("no column %s", column);
    return -1;
}

measured measure_probe(const assay_array *result, int row, const char *column)
{
    char name[64];
    snprintf(name, sizeof name, "Variance.%s", column);
    const double *values = assay_array_values(result) + (size_t)row * assay_array_columns(result);
    return (measured){values[find_column(column)], sqrt(values[find_column(name)])};
}

bool measure_agrees(measured m, double expected, double sigmas, double slack)
{
    return fabs(m.value - expected) <= sigmas * m.error + slack;
}

void measure_check(const char *what, measured m, double expected, double slack, double mutant)
{
    if (!measure_agrees(m, expected, 5.0, slack)) {
        fail_msg("%s: %.9g +- %.2g, expected %.9g (slack %.2g)", what, m.value, m.error, expected,
                 slack);
    }
    if (measure_agrees(m, mutant, 5.0, slack)) {
        fail_msg("%s: too blunt: %.9g +- %.2g would also pass for %.9g", what, m.value, m.error,
                 mutant);
    }
}

const char *measure_shared_scenes(void)
{
    const char *folder = getenv("ASSAY_SHARED_SCENES");
    if (!folder) {
        folder = "../shared/scenes";
    }
    return access(folder, R_OK) == 0 ? folder : NULL;
}
