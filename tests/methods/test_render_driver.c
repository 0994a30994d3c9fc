/* test_render_driver.c - what happens around a method: options, metadata, statistics, passes,
 * dumps, points.  The method is `path`. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "io/film.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/scene_builder.h"
#include "support/temporary.h"

/* A lamp over a floor, and a camera; or nothing of it. */
static assay_scene *lit_floor(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      floor = scene_builder_diffuse(b, 0.5, 0.0, true);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 4.0, false);
    scene_builder_quad(b, floor, vec3(-2, 0, 2), vec3(2, 0, 2), vec3(2, 0, -2), vec3(-2, 0, -2));
    scene_builder_quad(b, lamp, vec3(-1, 2, -1), vec3(1, 2, -1), vec3(1, 2, 1), vec3(-1, 2, 1));
    scene_builder_camera(b, vec3(0, 1, 4), vec3(0, 0.5, 0), 0.8);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *nothing(assay_context *context)
{
    return scene_builder_load(scene_builder_create(), context, NULL);
}

typedef struct {
    assay_context *context;
    assay_scene   *scene;
    assay_params  *params;
} bench;

static bench open_bench(int threads, assay_scene *(*make)(assay_context *context))
{
    bench b = {.context = measure_context(threads)};
    b.scene = make(b.context);
    assert_int_equal(assay_method_params(b.context, "path", &b.params), ASSAY_OK);
    assert_int_equal(assay_params_set(b.params, "spp", "1"), ASSAY_OK);
    return b;
}

static void close_bench(bench *b)
{
    assay_params_destroy(b->params);
    assay_scene_destroy(b->scene);
    assay_context_destroy(b->context);
}

static void set(bench *b, const char *name, const char *value)
{
    assert_int_equal(assay_params_set(b->params, name, value), ASSAY_OK);
}

static assay_render_options size(int width, int height)
{
    assay_render_options options = assay_render_options_default();
    options.width                = width;
    options.height               = height;
    return options;
}

static assay_image *render(bench *b, assay_render_options options, assay_render_stats *stats)
{
    assay_image *image = NULL;
    if (assay_render(b->scene, "path", b->params, &options, &image, stats) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(b->context));
    }
    return image;
}

/* ---- options ---- */

static void refuse(bench *b, const char *method, assay_render_options options,
                   assay_status expected, const char *word)
{
    assay_image *const no_image = (assay_image *)b;
    assay_image       *image    = no_image;
    assay_render_stats stats    = {.threads = -1};
    assert_int_equal(assay_render(b->scene, method, b->params, &options, &image, &stats), expected);
    assert_ptr_equal(image, no_image);
    assert_int_equal(stats.threads, -1);
    if (!strstr(assay_context_error(b->context), word)) {
        fail_msg("'%s' does not speak of '%s'", assay_context_error(b->context), word);
    }
    assert_null(strchr(assay_context_error(b->context), '\n'));
}

static void bad_options(void **state)
{
    (void)state;
    static const int     sides[][2] = {{0, 1}, {1, 0}, {-1, 5}, {65537, 1}, {1, 65537}};
    bench                b          = open_bench(1, lit_floor);
    assay_render_options options    = size(4, 4);
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        refuse(&b, "path", size(sides[i][0], sides[i][1]), ASSAY_ERR_ARGUMENT, "65536");
    }
    refuse(&b, "path", size(65536, 65536), ASSAY_ERR_LIMIT, "too large");
    refuse(&b, "radiosity", options, ASSAY_ERR_ARGUMENT, "path");
    refuse(&b, "", options, ASSAY_ERR_ARGUMENT, "path");
    static const char *const layers[] = {"",       "colour", "color,",
                                         ",color", "Color",  "color gbuffer"};
    for (size_t i = 0; i < sizeof layers / sizeof layers[0]; i++) {
        options.layers = layers[i];
        refuse(&b, "path", options, ASSAY_ERR_ARGUMENT, "layers");
    }
    options.layers                     = NULL;
    static const char *const cameras[] = {"", "1", "-0", "0x0", " 0", "99999999999999999999"};
    for (size_t i = 0; i < sizeof cameras / sizeof cameras[0]; i++) {
        options.camera = cameras[i];
        refuse(&b, "path", options, ASSAY_ERR_ARGUMENT, "no camera");
    }
    options.camera = NULL;
    options.layers = "gbuffer";
    set(&b, "target_error", "0.5");
    refuse(&b, "path", options, ASSAY_ERR_ARGUMENT, "target_error");
    options.layers = NULL;
    set(&b, "spp", "9");
    set(&b, "max_spp", "8");
    refuse(&b, "path", options, ASSAY_ERR_ARGUMENT, "max_spp");
    close_bench(&b);
}

/* Defaults where options are NULL; no statistics where none are asked for. */
static void no_options(void **state)
{
    (void)state;
    bench        b     = open_bench(2, nothing);
    assay_image *image = NULL;
    assert_int_equal(assay_render(b.scene, "path", b.params, NULL, &image, NULL), ASSAY_OK);
    assert_int_equal(assay_image_width(image), 512);
    assert_int_equal(assay_image_height(image), 512);
    assert_true(assay_image_find_channel(image, "IrradianceIndirect.R", NULL));
    assay_image_destroy(image);
    close_bench(&b);
}

static bool count_calls(void *user, const char *phase, double fraction)
{
    (void)phase;
    (void)fraction;
    ++*(int *)user;
    return true;
}

/* What does not fit is refused before a tree is built or a ray is traced, with the sum of what
 * film, image and dump will take; what fits it is rendered, and nothing is held afterwards. */
static void memory_is_asked_for_up_front(void **state)
{
    (void)state;
    const uint64_t        limit = UINT64_C(64) << 20;
    int                   calls = 0;
    assay_context_options asked = {
        .threads = 1, .memory_limit = limit, .progress = count_calls, .user = &calls};
    bench b = {0};
    assert_int_equal(assay_context_create(&asked, &b.context), ASSAY_OK);
    b.scene = lit_floor(b.context);
    assert_int_equal(assay_method_params(b.context, "path", &b.params), ASSAY_OK);
    set(&b, "spp", "1");
    const uint64_t before = assay_context_memory_used(b.context);
    calls                 = 0;
    refuse(&b, "path", size(8192, 8192), ASSAY_ERR_MEMORY, "8192 x 8192 pixels with its layers");
    refuse(&b, "path", size(8192, 8192), ASSAY_ERR_MEMORY, "of a limit of 64 MiB");
    assert_int_equal(calls, 0);
    assert_int_equal(assay_context_memory_used(b.context), before);
    assay_image *image = render(&b, size(200, 200), NULL);
    assert_true(calls > 0);
    assay_image_destroy(image);
    assert_int_equal(assay_context_memory_used(b.context), before);
    close_bench(&b);
}

/* Film and image really take what is asked for. */
static void what_is_asked_for_is_what_is_taken(void **state)
{
    (void)state;
    static const struct {
        const char     *text;
        assay_layer_set set;
    } groups[] = {{"color", ASSAY_LAYERS_COLOR},
                  {"gbuffer", ASSAY_LAYERS_GBUFFER},
                  {"split", ASSAY_LAYERS_SPLIT},
                  {"irradiance", ASSAY_LAYERS_IRRADIANCE},
                  {"all", ASSAY_LAYERS_ALL}};
    enum { SIDE = 64 };
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; i++) {
        assay_context *context = measure_context(1);
        assay_film    *film    = NULL;
        assay_image   *image   = NULL;
        const uint64_t asked   = assay_film_pixel_bytes(groups[i].set) * SIDE * SIDE;
        assert_int_equal(assay_film_create(context, SIDE, SIDE, groups[i].set, &film), ASSAY_OK);
        assert_int_equal(assay_film_develop(film, &image), ASSAY_OK);
        assert_in_range(assay_context_memory_used(context), asked, asked + asked / 10);
        assay_image_destroy(image);
        assay_film_destroy(film);
        assay_context_destroy(context);
    }
}

/* ---- metadata ---- */

static const char *attribute(const assay_image *image, const char *name)
{
    const char *value = assay_image_get_attribute(image, name);
    if (!value) {
        fail_msg("no attribute %s", name);
    }
    return value;
}

static void metadata(void **state)
{
    (void)state;
    bench                b       = open_bench(1, lit_floor);
    assay_render_options options = size(4, 4);
    options.seed                 = UINT64_MAX;
    assert_int_equal(assay_scene_set_time(b.scene, 0.1), ASSAY_OK);
    set(&b, "spp", "3");
    set(&b, "target_error", "0.9");
    set(&b, "estimator", "nee");
    assay_image *image = render(&b, options, NULL);
    assert_string_equal(attribute(image, "assay:version"), assay_version());
    assert_string_equal(attribute(image, "assay:method"), "path");
    assert_string_equal(attribute(image, "assay:seed"), "18446744073709551615");
    assert_string_equal(attribute(image, "assay:scene.digest"), assay_scene_digest(b.scene));
    assert_true(strtod(attribute(image, "assay:scene.time"), NULL) == 0.1);
    assert_string_equal(attribute(image, "assay:camera"), assay_scene_camera_name(b.scene, 0));
    assert_string_equal(attribute(image, "assay:camera.position"), "0 1 4");
    assert_near(strtod(attribute(image, "assay:camera.yfov"), NULL), 0.8, 1e-15);
    assert_null(assay_image_get_attribute(image, "assay:camera.xmag"));
    int params = 0;
    for (const assay_param_desc *p = assay_params_table(b.params); p->name; p++, params++) {
        char name[96];
        snprintf(name, sizeof name, "assay:path.%s", p->name);
        assert_string_equal(attribute(image, name), assay_params_text(b.params, p->name));
    }
    assert_string_equal(attribute(image, "assay:path.spp"), "3");
    assert_string_equal(attribute(image, "assay:path.estimator"), "nee");
    /* version, method, seed, 8 of the scene, camera, four vectors, yfov: and nothing that is not
     * the same on every machine. */
    assert_int_equal(assay_image_attribute_count(image), 17 + params);
    assay_image_destroy(image);
    close_bench(&b);
}

/* An image can be made again from what it says of itself. */
static void metadata_makes_the_same_image(void **state)
{
    (void)state;
    char                 digest[2][65];
    bench                a = open_bench(1, lit_floor), b = open_bench(1, lit_floor);
    assay_render_options options = size(6, 5);
    options.seed                 = 77;
    set(&a, "spp", "4");
    set(&a, "roulette_depth", "2");
    set(&a, "gradient_angle", "0.1");
    assay_image *first = render(&a, options, NULL);
    for (const assay_param_desc *p = assay_params_table(b.params); p->name; p++) {
        char name[96];
        snprintf(name, sizeof name, "assay:path.%s", p->name);
        set(&b, p->name, attribute(first, name));
    }
    options.seed        = strtoull(attribute(first, "assay:seed"), NULL, 10);
    options.camera      = attribute(first, "assay:camera");
    assay_image *second = render(&b, options, NULL);
    assay_image_digest(first, digest[0]);
    assay_image_digest(second, digest[1]);
    assert_string_equal(digest[0], digest[1]);
    assay_image_destroy(first);
    assay_image_destroy(second);
    close_bench(&a);
    close_bench(&b);
}

/* ---- statistics ---- */

static void statistics(void **state)
{
    (void)state;
    bench              b = open_bench(2, lit_floor);
    assay_render_stats stats;
    set(&b, "spp", "5");
    set(&b, "bounces", "0");
    assay_image_destroy(render(&b, size(7, 3), &stats));
    assert_int_equal(stats.samples, 7 * 3 * 5);
    assert_int_equal(stats.spp_min, 5);
    assert_int_equal(stats.spp_max, 5);
    assert_int_equal(stats.threads, 2);
    /* Camera paths, one ray for the visible point, and rays that pass the lamp's back; without
     * bounces there are no others. */
    assert_true(stats.camera_rays >= 7 * 3 * 6 && stats.camera_rays < 7 * 3 * 12);
    assert_int_equal(stats.scatter_rays, 0);
    assert_int_equal(stats.shadow_rays, 0);
    assert_true(stats.bvh_bytes > 0 && stats.geometry_bytes > 0 && stats.texture_bytes == 0);
    assert_true(stats.peak_memory > 1000000);
    assert_true(stats.seconds_build >= 0.0 && stats.seconds_render > 0.0);
    /* Light sampling alone casts one shadow ray a vertex at most. */
    assay_render_options split = size(7, 3);
    split.layers               = "split";
    set(&b, "bounces", "1");
    assay_image_destroy(render(&b, split, &stats));
    assert_int_equal(stats.samples, 7 * 3 * 5);
    assert_true(stats.shadow_rays > 0 && stats.shadow_rays <= 7 * 3 * 5);
    split.layers = "gbuffer";
    assay_image_destroy(render(&b, split, &stats));
    assert_int_equal(stats.samples, 0);
    assert_int_equal(stats.spp_min, 0);
    assert_true(isnan(stats.relative_error) && stats.target == ASSAY_TARGET_NONE);
    /* One sample does not know its variance; two think they do. */
    set(&b, "spp", "1");
    assay_image_destroy(render(&b, size(7, 3), &stats));
    assert_true(isnan(stats.relative_error));
    set(&b, "spp", "2");
    assay_image_destroy(render(&b, size(7, 3), &stats));
    assert_true(stats.relative_error > 0.0);
    close_bench(&b);
}

/* ---- passes ---- */

static void render_digest(int threads, const setting *settings, char digest[65],
                          assay_render_stats *stats)
{
    bench b = open_bench(threads, lit_floor);
    for (; settings->name; settings++) {
        set(&b, settings->name, settings->value);
    }
    assay_image *image = render(&b, size(18, 5), stats);
    assay_image_digest(image, digest);
    assay_image_destroy(image);
    close_bench(&b);
}

/* 150 samples are three passes; 7 and what doubling adds to them are cut at other places. */
static void passes_change_no_bit(void **state)
{
    (void)state;
    static const setting once[]   = {{"spp", "150"}, {NULL, NULL}};
    static const setting rounds[] = {
        {"spp", "7"}, {"target_error", "1e-9"}, {"max_spp", "150"}, {NULL, NULL}};
    static const setting less[] = {{"spp", "149"}, {NULL, NULL}};
    char                 digest[3][65];
    assay_render_stats   stats[3];
    render_digest(2, once, digest[0], &stats[0]);
    render_digest(2, rounds, digest[1], &stats[1]);
    render_digest(2, less, digest[2], &stats[2]);
    assert_string_equal(digest[0], digest[1]);
    assert_string_not_equal(digest[0], digest[2]);
    assert_int_equal(stats[1].spp_min, 150);
    assert_true(stats[0].relative_error == stats[1].relative_error);
    assert_true(stats[0].shadow_rays == stats[1].shadow_rays);
    assert_true(stats[0].scatter_rays == stats[1].scatter_rays);
}

static void target_error_is_the_same_for_all_threads(void **state)
{
    (void)state;
    static const setting settings[] = {{"spp", "4"}, {"target_error", "0.08"}, {NULL, NULL}};
    char                 digest[4][65];
    assay_render_stats   stats[4];
    for (int threads = 1; threads <= 3; threads++) {
        render_digest(threads, settings, digest[threads], &stats[threads]);
        assert_string_equal(digest[threads], digest[1]);
        assert_int_equal(stats[threads].spp_max, stats[1].spp_max);
    }
    assert_true(stats[1].relative_error <= 0.08 && stats[1].spp_max > 4);
}

/* The same numbers whatever else is asked for. */
static void layers_do_not_touch_each_other(void **state)
{
    (void)state;
    static const char *const groups[] = {"color", "split", "irradiance", "gbuffer"};
    bench                    b        = open_bench(1, lit_floor);
    set(&b, "spp", "3");
    assay_image *all = render(&b, size(8, 8), NULL);
    int          sum = 0;
    for (int i = 0; i < 4; i++) {
        assay_render_options options = size(8, 8);
        options.layers               = groups[i];
        assay_image *part            = render(&b, options, NULL);
        for (int c = 0; c < assay_image_channel_count(part); c++) {
            const assay_channel one = assay_image_channel_at(part, c);
            assay_channel       other;
            assert_true(assay_image_find_channel(all, one.name, &other));
            assert_memory_equal(one.data.f32, other.data.f32, 64 * sizeof(float));
        }
        sum += assay_image_channel_count(part);
        assay_image_destroy(part);
    }
    assert_int_equal(sum, assay_image_channel_count(all));
    assay_image_destroy(all);
    close_bench(&b);
}

/* ---- dumps ---- */

static assay_status dump_once(uint64_t fail_at, uint64_t cancel_at)
{
    temporary            folder  = temporary_create();
    failing_memory       memory  = {0};
    assay_context       *context = failing_context(&memory);
    assay_scene         *scene   = lit_floor(context);
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    assay_render_options options = size(17, 2);
    options.dump                 = temporary_path(&folder, "bundle");
    options.layers               = "color";
    assert_int_equal(assay_method_params(context, "path", &params), ASSAY_OK);
    assert_int_equal(assay_params_set(params, "spp", "1"), ASSAY_OK);
    memory.asked = memory.progress_calls = 0;
    memory.fail_at                       = fail_at;
    memory.cancel_at                     = cancel_at;
    const uint64_t     live              = memory.live;
    const assay_status status = assay_render(scene, "path", params, &options, &image, NULL);
    memory.fail_at            = 0;
    if (status == ASSAY_OK) {
        char command[600];
        assay_image_destroy(image);
        snprintf(command, sizeof command, "rm -r '%s'", options.dump);
        assert_int_equal(system(command), 0);
    }
    assert_int_equal(memory.live, live);
    assert_int_equal(temporary_count(&folder), 0);
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    temporary_destroy(&folder);
    return status;
}

static void refused_memory_leaves_no_dump(void **state)
{
    (void)state;
    uint64_t     n      = 0;
    assay_status status = ASSAY_ERR_MEMORY;
    while (n < 3000 && (status = dump_once(++n, 0)) == ASSAY_ERR_MEMORY) {
    }
    assert_int_equal(status, ASSAY_OK);
    assert_true(n > 100);
}

static void cancelling_leaves_no_dump(void **state)
{
    (void)state;
    uint64_t     n      = 0;
    assay_status status = ASSAY_ERR_CANCELLED;
    while (n < 1000 && (status = dump_once(0, ++n)) == ASSAY_ERR_CANCELLED) {
    }
    assert_int_equal(status, ASSAY_OK);
    assert_true(n >= 3);
}

/* ---- lists and parameters under refused memory ---- */

static assay_status make_texts(assay_context *context, void *user)
{
    assay_params *params = NULL;
    char         *text   = NULL;
    (void)user;
    assay_status status = assay_method_params(context, "path", &params);
    if (status == ASSAY_OK) {
        assert_int_equal(assay_params_set(params, "spp", "7"), ASSAY_OK);
        status = assay_methods_json(context, NULL, &text);
    }
    assay_text_destroy(context, text);
    assay_params_destroy(params);
    return status;
}

static void refused_memory_for_texts(void **state)
{
    (void)state;
    assert_true(failing_each(make_texts, NULL) >= 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_options),
        cmocka_unit_test(no_options),
        cmocka_unit_test(memory_is_asked_for_up_front),
        cmocka_unit_test(what_is_asked_for_is_what_is_taken),
        cmocka_unit_test(metadata),
        cmocka_unit_test(metadata_makes_the_same_image),
        cmocka_unit_test(statistics),
        cmocka_unit_test(passes_change_no_bit),
        cmocka_unit_test(target_error_is_the_same_for_all_threads),
        cmocka_unit_test(layers_do_not_touch_each_other),
        cmocka_unit_test(refused_memory_leaves_no_dump),
        cmocka_unit_test(cancelling_leaves_no_dump),
        cmocka_unit_test(refused_memory_for_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
