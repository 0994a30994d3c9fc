/* test_every_method.c - what holds for all methods of the registry, so that a new one is tested
 * from its first day: a furnace, the same bits for any number of threads, bad parameters, refused
 * memory, cancelling. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/scene_builder.h"

/* The sky is as bright as the inside, for methods that see it through walls. */
static assay_scene *furnace(assay_context *context)
{
    assay_scene_options options = assay_scene_options_default();
    scene_builder      *b       = scene_builder_create();
    options.background          = rgb_grey(2.0);
    scene_builder_sphere(b, scene_builder_diffuse(b, 0.5, 1.0, true), vec3(0, 0, 0), 1.0, 1);
    scene_builder_camera(b, vec3(0.3, 0.2, 0.1), vec3(-1, 0, 0), 1.2);
    return scene_builder_load(b, context, &options);
}

static const assay_param_desc *find(const char *method, const char *name)
{
    for (int i = 0; i < assay_method_count(); i++) {
        const assay_method_info info = assay_method_at(i);
        for (const assay_param_desc *p = info.params; p->name; p++) {
            if (strcmp(info.name, method) == 0 && strcmp(p->name, name) == 0) {
                return p;
            }
        }
    }
    return NULL;
}

/* Defaults, with so many samples where the method knows samples, and small where it can be: all of
 * it is done again for every block of memory that can be refused. */
static assay_status make_params(assay_context *context, const char *method, const char *spp,
                                assay_params **params_out)
{
    const assay_status status = assay_method_params(context, method, params_out);
    const struct {
        const char *name, *value;
    } cheap[] = {{"spp", spp},      {"grid", "4"},         {"nodes", "8"},     {"order", "4"},
                 {"sh_order", "4"}, {"theta_strata", "4"}, {"phi_strata", "8"}};
    for (size_t i = 0; i < sizeof cheap / sizeof cheap[0] && status == ASSAY_OK; i++) {
        if (find(method, cheap[i].name)) {
            assert_int_equal(assay_params_set(*params_out, cheap[i].name, cheap[i].value),
                             ASSAY_OK);
        }
    }
    return status;
}

static assay_render_options size(int width, int height)
{
    assay_render_options options = assay_render_options_default();
    options.width                = width;
    options.height               = height;
    return options;
}

static assay_image *render(assay_context *context, assay_scene *scene, const char *method,
                           const char *spp, assay_render_options options, assay_render_stats *stats)
{
    assay_params *params = NULL;
    assay_image  *image  = NULL;
    assert_int_equal(make_params(context, method, spp, &params), ASSAY_OK);
    if (assay_render(scene, method, params, &options, &image, stats) != ASSAY_OK) {
        fail_msg("%s: %s", method, assay_context_error(context));
    }
    assay_params_destroy(params);
    return image;
}

static void for_each_method(void (*check)(const char *method))
{
    assert_true(assay_method_count() > 0);
    for (int i = 0; i < assay_method_count(); i++) {
        check(assay_method_at(i).name);
    }
}

/* ---- furnace ---- */

/* Radiance 1 / (1 - 1/2), irradiance pi times that.  A method with a bias may be off by 1 %; what
 * the check must see is a bounce too few among many. */
static void check_furnace(const char *method)
{
    const double   r       = 2.0;
    assay_context *context = measure_context(2);
    assay_scene   *scene   = furnace(context);
    assay_image   *image   = render(context, scene, method, "256", size(12, 12), NULL);
    measure_check(method, measure_mean(image, "R"), r, 0.01 * r, 0.95 * r);
    if (assay_image_find_channel(image, "Irradiance.G", NULL)) {
        measure_check(method, measure_mean(image, "Irradiance.G"), ASSAY_PI * r,
                      0.01 * ASSAY_PI * r, 0.95 * ASSAY_PI * r);
    }
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void furnaces(void **state)
{
    (void)state;
    for_each_method(check_furnace);
}

/* ---- same bits ---- */

typedef struct {
    char               digest[65];
    assay_render_stats stats;
} outcome;

static outcome render_with_threads(const char *method, int threads, uint64_t seed)
{
    outcome              o;
    assay_context       *context = measure_context(threads);
    assay_scene         *scene   = furnace(context);
    assay_render_options options = size(37, 21);
    options.seed                 = seed;
    assay_image *image           = render(context, scene, method, "3", options, &o.stats);
    assay_image_digest(image, o.digest);
    assert_int_equal(o.stats.threads, threads);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return o;
}

static void check_threads(const char *method)
{
    const outcome one = render_with_threads(method, 1, 5);
    for (int threads = 1; threads <= 3; threads++) {
        const outcome many = render_with_threads(method, threads, 5);
        assert_string_equal(many.digest, one.digest);
        assert_true(many.stats.camera_rays == one.stats.camera_rays);
        assert_true(many.stats.scatter_rays == one.stats.scatter_rays);
        assert_true(many.stats.shadow_rays == one.stats.shadow_rays);
        assert_true(many.stats.samples == one.stats.samples);
        assert_true(many.stats.relative_error == one.stats.relative_error);
    }
    /* Mutant, where there is noise: numbers that are not the same. */
    assert_true(one.stats.relative_error == 0.0 ||
                strcmp(render_with_threads(method, 1, 6).digest, one.digest) != 0);
}

static void same_bits_for_all_threads(void **state)
{
    (void)state;
    for_each_method(check_threads);
}

/* One object renders twice: nothing may be left over from the first time. */
static void check_again(const char *method)
{
    char           digest[2][65];
    assay_context *context = measure_context(2);
    assay_scene   *scene   = furnace(context);
    for (int i = 0; i < 2; i++) {
        assay_image *image = render(context, scene, method, "2", size(9, 7), NULL);
        assay_image_digest(image, digest[i]);
        assay_image_destroy(image);
    }
    assert_string_equal(digest[0], digest[1]);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void same_bits_again(void **state)
{
    (void)state;
    for_each_method(check_again);
}

/* ---- parameters ---- */

static bool takes(assay_params *params, const char *name, const char *value)
{
    char before[64];
    snprintf(before, sizeof before, "%s", assay_params_text(params, name));
    if (assay_params_set(params, name, value) == ASSAY_OK) {
        return true;
    }
    assert_string_equal(assay_params_text(params, name), before);
    return false;
}

static bool takes_number(assay_params *params, const char *name, double value)
{
    char text[64];
    snprintf(text, sizeof text, "%.17g", value);
    return takes(params, name, text);
}

static void check_range(assay_params *params, const assay_param_desc *p)
{
    const bool   whole   = p->type == ASSAY_PARAM_INT;
    const bool   endless = whole && p->maximum == ASSAY_PARAM_INF;
    const double step    = whole ? 1.0 : 1e-3 * (fabs(p->minimum) + 1e-9);
    assert_true(takes_number(params, p->name, p->minimum));
    assert_false(takes_number(params, p->name, p->minimum - step));
    assert_true(endless ? takes(params, p->name, "inf")
                        : takes_number(params, p->name, p->maximum));
    assert_false(takes_number(params, p->name, p->maximum * (1.0 + 1e-9) + (whole ? 1.0 : 0.0)));
    assert_true(endless || !takes(params, p->name, "inf"));
    assert_false(whole && takes_number(params, p->name, p->minimum + 0.5));
}

static void check_choices(assay_params *params, const assay_param_desc *p)
{
    char words[256], *rest = words;
    snprintf(words, sizeof words, "%s", p->choices);
    for (char *word; (word = strsep(&rest, "|"));) {
        assert_true(takes(params, p->name, word));
    }
    assert_false(takes(params, p->name, p->choices));
}

static void check_parameters(const char *method)
{
    static const char *const garbage[] = {"",   " ",  "x",   "nan",    "-inf", "1e999", "0x1",
                                          "1 ", " 1", "1,5", "on off", "--",   "1e",    "\n"};
    assay_context           *context   = measure_context(1);
    assay_params            *params    = NULL;
    assert_int_equal(assay_method_params(context, method, &params), ASSAY_OK);
    for (const assay_param_desc *p = assay_params_table(params); p->name; p++) {
        assert_string_equal(assay_params_text(params, p->name), p->default_value);
        assert_true(strlen(p->summary) > 0 && p->summary[strlen(p->summary) - 1] == '.');
        assert_true(takes(params, p->name, p->default_value));
        for (size_t i = 0; i < sizeof garbage / sizeof garbage[0] && p->type != ASSAY_PARAM_PATH;
             i++) {
            assert_false(takes(params, p->name, garbage[i]));
            assert_non_null(strstr(assay_context_error(context), p->name));
        }
        switch (p->type) {
        case ASSAY_PARAM_INT:
        case ASSAY_PARAM_REAL: check_range(params, p); break;
        case ASSAY_PARAM_CHOICE: check_choices(params, p); break;
        case ASSAY_PARAM_PATH:
            assert_true(takes(params, p->name, "a/b c.d"));
            assert_string_equal(assay_params_text(params, p->name), "a/b c.d");
            break;
        case ASSAY_PARAM_BOOL:
            assert_true(takes(params, p->name, "on") && takes(params, p->name, "off"));
            assert_false(takes(params, p->name, "1"));
            break;
        }
    }
    assert_int_equal(assay_params_set(params, "no_such_parameter", "1"), ASSAY_ERR_ARGUMENT);
    assay_params_destroy(params);
    assay_context_destroy(context);
}

static void parameters(void **state)
{
    (void)state;
    for_each_method(check_parameters);
}

/* ---- refused memory, and cancelling ---- */

typedef enum { WORK_IMAGE, WORK_PROBES } work_kind;

/* One render or probing on counted memory, with the n-th block refused or cancelled at the n-th
 * call of the progress callback.  What it wrote must be nothing unless it is ASSAY_OK. */
static assay_status work_once(const char *method, work_kind kind, uint64_t fail_at,
                              uint64_t cancel_at)
{
    const bool     refused = cancel_at == 0;
    failing_memory memory  = {0};
    assay_context *context = failing_context(&memory);
    assay_scene   *scene   = furnace(context);
    assay_params  *params  = NULL;
    assay_array   *points  = NULL;
    assay_image *image = NULL, *const no_image = (assay_image *)&memory;
    assay_array *result = NULL, *const no_result = (assay_array *)&memory;
    assay_render_stats stats = {.threads = -1};
    assert_int_equal(make_params(context, method, refused ? "1" : "65", &params), ASSAY_OK);
    assert_int_equal(assay_array_create(context, 3, 6, &points), ASSAY_OK);
    for (size_t i = 0; i < 3; i++) {
        assay_array_data(points)[6 * i]     = 0.2 * (double)i;
        assay_array_data(points)[6 * i + 4] = 1.0;
    }
    const assay_render_options options = size(17, 2);
    const uint64_t             live    = memory.live;
    memory.asked = memory.progress_calls = 0;
    memory.fail_at                       = fail_at;
    memory.cancel_at                     = cancel_at;
    image                                = no_image;
    result                               = no_result;
    const assay_status status =
        kind == WORK_IMAGE ? assay_render(scene, method, params, &options, &image, &stats)
                           : assay_render_probes(scene, method, params, 1, points, &result, &stats);
    if (status == ASSAY_OK) {
        assert_true(memory.asked < fail_at || fail_at == 0);
        assert_true(memory.progress_calls < cancel_at || cancel_at == 0);
        assert_int_equal(stats.threads, 1);
        if (kind == WORK_IMAGE) {
            assay_image_destroy(image);
        } else {
            assay_array_destroy(result);
        }
    } else {
        assert_ptr_equal(image, no_image);
        assert_ptr_equal(result, no_result);
        assert_int_equal(stats.threads, -1);
        assert_true(strlen(assay_context_error(context)) > 0);
    }
    if (memory.live != live) {
        fail_msg("%s: %lld blocks are left after refusal %llu, cancelling %llu", method,
                 (long long)(memory.live - live), (unsigned long long)fail_at,
                 (unsigned long long)cancel_at);
    }
    memory.fail_at = 0;
    assay_array_destroy(points);
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assert_int_equal(memory.live, 1);
    assay_context_destroy(context);
    return status;
}

/* Until it succeeds; the last n at which it did not.  Calls of the progress callback are many: from
 * the 32nd on an eighth is left out each time. */
static uint64_t until_success(const char *method, work_kind kind, bool refuse,
                              assay_status expected)
{
    uint64_t last = 0;
    for (uint64_t n = 1; n < 2000; n += refuse || n < 32 ? 1 : n / 8) {
        const assay_status status = work_once(method, kind, refuse ? n : 0, refuse ? 0 : n);
        if (status == ASSAY_OK) {
            return last;
        }
        assert_int_equal(status, expected);
        last = n;
    }
    fail_msg("%s: it does not end", method);
    return 0;
}

static void check_memory(const char *method)
{
    assert_true(until_success(method, WORK_IMAGE, true, ASSAY_ERR_MEMORY) > 10);
    if (work_once(method, WORK_PROBES, 0, 0) != ASSAY_ERR_UNSUPPORTED) {
        assert_true(until_success(method, WORK_PROBES, true, ASSAY_ERR_MEMORY) > 5);
    }
}

static void refused_memory(void **state)
{
    (void)state;
    for_each_method(check_memory);
}

/* Once a tile of each pass at least: 2 tiles; one point in one pass or more. */
static void check_cancel(const char *method)
{
    assert_true(until_success(method, WORK_IMAGE, false, ASSAY_ERR_CANCELLED) >= 4);
    if (work_once(method, WORK_PROBES, 0, 0) != ASSAY_ERR_UNSUPPORTED) {
        assert_true(until_success(method, WORK_PROBES, false, ASSAY_ERR_CANCELLED) >= 3);
    }
}

static void cancelling(void **state)
{
    (void)state;
    for_each_method(check_cancel);
}

/* ---- the list ---- */

static void names_are_found_again(void **state)
{
    (void)state;
    for (int i = 0; i < assay_method_count(); i++) {
        const assay_method_info info = assay_method_at(i);
        assert_true(strlen(info.name) > 0 && strlen(info.summary) > 0);
        for (int j = 0; j < i; j++) {
            assert_string_not_equal(info.name, assay_method_at(j).name);
        }
        for (const assay_param_desc *p = info.params; p->name; p++) {
            assert_ptr_equal(find(info.name, p->name), p);
            assert_true(strspn(p->name, "abcdefghijklmnopqrstuvwxyz_0123456789") ==
                        strlen(p->name));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnaces),
        cmocka_unit_test(same_bits_for_all_threads),
        cmocka_unit_test(same_bits_again),
        cmocka_unit_test(parameters),
        cmocka_unit_test(refused_memory),
        cmocka_unit_test(cancelling),
        cmocka_unit_test(names_are_found_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
