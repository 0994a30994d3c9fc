/* test_radiance_cache_image.c - images by radiance-cache against `path` with the same bounces.
 *
 * Looked at are the glossy surfaces alone, by material: there the mistakes are that the checks must
 * see (a lobe turned the wrong way, counted twice or not at all, without its cosine). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/scene_builder.h"

enum { SIZE = 20, MAX_SETTINGS = 20 };

#define GLOSSY_BOX "scenes/cornell-box-glossy/cornell-box-glossy.gltf"
enum { GLOSSY_WALL = 4 }; /* its material */

/* One indirect bounce: paths have the least noise. */
static const setting CACHE[] = {{"method", "radiance-cache"},
                                {"spp", "8"},
                                {"bounces", "2"},
                                {"secondary", "direct"},
                                {"a", "0.25"},
                                {"theta_strata", "12"},
                                {"phi_strata", "38"},
                                {"glossy_accuracy", "0"},
                                {"grid", "16"},
                                {"nodes", "32"},
                                {NULL, NULL}};
static const setting PATH[]  = {{"spp", "200"}, {"bounces", "2"}, {NULL, NULL}};

static assay_image *render(assay_scene *scene, const setting *settings, const setting *more)
{
    setting all[MAX_SETTINGS] = {{NULL, NULL}};
    int     count             = 0;
    for (const setting *s = settings; s->name; s++) {
        all[count++] = *s;
    }
    for (const setting *s = more; s && s->name; s++) {
        assert_true(count + 1 < MAX_SETTINGS);
        all[count++] = *s;
    }
    return measure_render(scene, all, SIZE, SIZE, "split,gbuffer");
}

/* Over the pixels of a material. */
typedef struct {
    measured mean;
    double   error; /* rms against the truth in parts of the mean, without the truth's noise */
} seen;

static seen look_at(const assay_image *image, const assay_image *truth, const char *channel,
                    uint32_t material)
{
    char          name[40];
    assay_channel value, exact, variance, noise, id;
    double        sum = 0.0, squares = 0.0, variances = 0.0, mean = 0.0, noises = 0.0;
    int           count = 0;
    snprintf(name, sizeof name, "Variance.%s", channel);
    assert_true(assay_image_find_channel(image, channel, &value) &&
                assay_image_find_channel(truth, channel, &exact) &&
                assay_image_find_channel(image, name, &variance) &&
                assay_image_find_channel(truth, name, &noise) &&
                assay_image_find_channel(truth, "MaterialId", &id));
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (id.data.u32[i] == material) {
            const double d = (double)value.data.f32[i] - exact.data.f32[i];
            squares += d * d - noise.data.f32[i];
            sum += value.data.f32[i];
            mean += exact.data.f32[i];
            variances += variance.data.f32[i];
            noises += noise.data.f32[i];
            count++;
        }
    }
    assert_true(count > 20);
    return (seen){.mean  = {sum / mean, sqrt(variances + noises) / mean},
                  .error = sqrt(fmax(squares * count, 0.0)) / mean};
}

/* The mean within 5 standard errors and `slack`, where `mistake` is seen. */
static void check(const char *what, const seen *s, double slack, double mistake, double most)
{
    print_message("#| %-34s mean %.4f +- %.4f of path's, rms error %.3f\n", what, s->mean.value,
                  s->mean.error, s->error);
    assert_true(measure_agrees(s->mean, 1.0, 5.0, slack));
    assert_false(measure_agrees(s->mean, 1.0 + mistake, 5.0, slack));
    assert_false(measure_agrees(s->mean, 1.0 - mistake, 5.0, slack));
    assert_true(s->error < most);
}

static assay_scene *load(assay_context *context, const char *path)
{
    const assay_scene_options options = assay_scene_options_default();
    assay_scene              *scene   = NULL;
    if (assay_scene_load(context, path, &options, &scene) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    return scene;
}

/* ---- the glossy Cornell box ---- */

static void orders(void **state)
{
    (void)state;
    static const char *const order[] = {"2", "10"};
    assay_context           *context = measure_context(1);
    assay_scene             *scene   = load(context, GLOSSY_BOX);
    const setting            many[]  = {{"spp", "1000"}, {NULL, NULL}};
    assay_image             *truth   = render(scene, PATH, many);
    double                   error[2];
    for (int i = 0; i < 2; i++) {
        const setting more[] = {
            {"order", order[i]}, {"theta_strata", "20"}, {"phi_strata", "63"}, {NULL, NULL}};
        assay_image *image = render(scene, CACHE, more);
        const seen   s     = look_at(image, truth, "Indirect.G", GLOSSY_WALL);
        print_message("#| order %s: mean %.4f +- %.4f of path's, rms error %.3f\n", order[i],
                      s.mean.value, s.mean.error, s.error);
        error[i] = s.error;
        if (i == 1) {
            check("Phong 20, order 10", &s, 0.04, 0.2, 0.15);
        }
        assay_image_destroy(image);
    }
    assert_true(error[1] < error[0]);
    assay_image_destroy(truth);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- other lobes, on curved and twisted surfaces ---- */

enum { WALLS, LAMP, THING };

/* A room with a ball of some material, or a screen that shows the camera its back. */
static assay_scene *room_with(assay_context *context, const char *material, bool screen)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.6, 0.0, false);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int      thing = scene_builder_material(b, material);
    scene_builder_box(b, walls, vec3(-1, -1, -1), vec3(1, 1, 1), true);
    if (screen) {
        scene_builder_quad(b, thing, vec3(-0.6, -0.9, -0.5), vec3(-0.5, 0.4, -0.6),
                           vec3(0.6, 0.4, -0.3), vec3(0.5, -0.9, -0.2));
    } else {
        scene_builder_sphere(b, thing, vec3(0, -0.4, -0.2), 0.6, 2);
    }
    scene_builder_quad(b, lamp, vec3(-0.3, 0.98, -0.3), vec3(0.3, 0.98, -0.3), vec3(0.3, 0.98, 0.3),
                       vec3(-0.3, 0.98, 0.3));
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *room(assay_context *context, const char *material)
{
    return room_with(context, material, false);
}

static const char *const GGX =
    "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.6,0.3,1],\"metallicFactor\":1,"
    "\"roughnessFactor\":0.6}";
static const char *const WARD =
    "\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
    "\"extras\":{\"assay\":{\"brdf\":\"ward\",\"diffuse\":[0.2,0.2,0.2],"
    "\"specular\":[0.5,0.5,0.5],\"alpha\":[0.2,0.5]}}";
static const char *const WARD_BOTH =
    "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0},"
    "\"extras\":{\"assay\":{\"brdf\":\"ward\",\"diffuse\":[0.1,0.1,0.1],"
    "\"specular\":[0.6,0.6,0.6],\"alpha\":[0.2,0.5]}}";
static const char *const PLASTIC =
    "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.6,0.3,1],"
    "\"metallicFactor\":0,\"roughnessFactor\":0.6}";

static void lobes_and_rotations(void **state)
{
    (void)state;
    static const struct {
        const char *what, *material, *rotation;
        double      most;
    } cases[]              = {{"GGX metal 0.6, table", GGX, "table", 0.06},
                              {"GGX metal 0.6, conversion", GGX, "conversion", 0.06},
                              {"GGX metal 0.6, digon", GGX, "digon", 0.06},
                              {"GGX metal 0.6, analytical", GGX, "analytical", 0.06},
                              {"Ward 0.2, 0.5, table", WARD, "table", 0.06},
                              {"plastic 0.6, table", PLASTIC, "table", 0.06}};
    const char    *before  = NULL;
    assay_scene   *scene   = NULL;
    assay_image   *truth   = NULL;
    assay_context *context = measure_context(1);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const setting more[] = {{"rotation", cases[i].rotation}, {NULL, NULL}};
        if (cases[i].material != before) {
            assay_image_destroy(truth);
            assay_scene_destroy(scene);
            scene = room(context, cases[i].material);
            truth = render(scene, PATH, NULL);
        }
        before             = cases[i].material;
        assay_image *image = render(scene, CACHE, more);
        const seen   s     = look_at(image, truth, "Indirect.R", THING);
        check(cases[i].what, &s, 0.02, 0.06, cases[i].most);
        assay_image_destroy(image);
    }
    assay_image_destroy(truth);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Seen from the back, too, the records are found: nothing is left to paths. */
static void seen_from_the_back(void **state)
{
    (void)state;
    failing_memory memory  = {0};
    assay_context *context = failing_context(&memory);
    assay_scene   *scene   = room_with(context, WARD_BOTH, true);
    assay_image   *truth   = render(scene, PATH, NULL);
    assay_image   *image   = render(scene, CACHE, NULL);
    const seen     s       = look_at(image, truth, "Indirect.G", THING);
    check("Ward from the back", &s, 0.03, 0.1, 0.06);
    assert_non_null(strstr(memory.log, "radiance records")); /* and no warning after it */
    assay_image_destroy(image);
    assay_image_destroy(truth);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static double rms(const assay_image *a, const assay_image *b, const char *name)
{
    assay_channel x, y, id;
    double        squares = 0.0, sum = 0.0;
    int           count = 0;
    assert_true(assay_image_find_channel(a, name, &x) && assay_image_find_channel(b, name, &y) &&
                assay_image_find_channel(b, "MaterialId", &id));
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (id.data.u32[i] == THING) {
            const double d = (double)x.data.f32[i] - y.data.f32[i];
            squares += d * d;
            sum += y.data.f32[i];
            count++;
        }
    }
    return sqrt(squares * count) / sum;
}

/* The very same records and samples, turned by one way or another: what is left is the way. */
static void rotations_against_exact(void **state)
{
    (void)state;
    static const char *const ways[] = {"table", "conversion", "digon", "analytical"};
    double                   error[4];
    assay_context           *context   = measure_context(1);
    assay_scene             *scene     = room(context, GGX);
    const setting            exactly[] = {
                   {"rotation", "exact"}, {"order", "5"}, {"spp", "1"}, {"a", "0.4"}, {NULL, NULL}};
    assay_image *exact = render(scene, CACHE, exactly);
    for (int i = 0; i < 4; i++) {
        const setting more[] = {{"rotation", ways[i]}, {"order", "5"},    {"spp", "1"},
                                {"a", "0.4"},          {"sh_order", "8"}, {NULL, NULL}};
        assay_image  *image  = render(scene, CACHE, more);
        error[i]             = rms(image, exact, "Indirect.G");
        print_message("#| rotation %-10s differs from exact by %.5f\n", ways[i], error[i]);
        assay_image_destroy(image);
    }
    assert_true(error[0] < 1e-3);
    for (int i = 1; i < 4; i++) {
        assert_true(error[i] > 3.0 * error[0] && error[i] < 0.1);
    }
    assay_image_destroy(exact);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- which cache ---- */

/* Out of reach, by the parameter or by kind, the light is that of irradiance-cache to the bit. */
static void what_is_out_of_reach(void **state)
{
    (void)state;
    static const struct {
        const char *what, *material, *accuracy;
    } cases[] = {
        {"not accurate enough", GGX, "1"},
        {"mirror", "\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}", "0"},
        {"thin wall",
         "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"extensions\":{"
         "\"KHR_materials_transmission\":{\"transmissionFactor\":0.5}}",
         "0"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        assay_context *context = measure_context(1);
        assay_scene   *scene   = room(context, cases[i].material);
        const setting more[] = {{"spp", "1"}, {"glossy_accuracy", cases[i].accuracy}, {NULL, NULL}};
        const setting paths[] = {
            {"method", "irradiance-cache"}, {"spp", "1"},  {"bounces", "2"},
            {"secondary", "direct"},        {"a", "0.25"}, {"theta_strata", "12"},
            {"phi_strata", "38"},           {NULL, NULL}};
        assay_image *image    = render(scene, CACHE, more);
        assay_image *expected = render(scene, paths, NULL);
        assert_true(measure_difference(image, expected, "Indirect.G") == 0.0);
        assay_image_destroy(image);
        assay_image_destroy(expected);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* Fewer records than are needed: paths answer where none reaches. */
static void few_records(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context, GGX);
    const setting  few[]   = {{"max_records", "40"}, {NULL, NULL}};
    assay_image   *truth   = render(scene, PATH, NULL);
    assay_image   *image   = render(scene, CACHE, few);
    const seen     s       = look_at(image, truth, "Indirect.G", THING);
    print_message("#| 40 records: mean %.4f +- %.4f of path's\n", s.mean.value, s.mean.error);
    assert_true(measure_agrees(s.mean, 1.0, 5.0, 0.05));
    assay_image_destroy(image);
    assay_image_destroy(truth);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- same bits, passes ---- */

static const setting QUICK[] = {
    {"method", "radiance-cache"}, {"spp", "2"},   {"a", "0.4"},  {"theta_strata", "4"},
    {"phi_strata", "8"},          {"order", "4"}, {"grid", "4"}, {"nodes", "8"},
    {"glossy_accuracy", "0"},     {NULL, NULL}};

static void same_bits_for_all_threads(void **state)
{
    (void)state;
    for (int passes = 1; passes <= 2; passes++) {
        char first[65] = "";
        for (int threads = 1; threads <= 3; threads++) {
            char           digest[65];
            assay_context *context = measure_context(threads);
            assay_scene   *scene   = room(context, WARD);
            const setting  more[]  = {{"passes", passes == 1 ? "1" : "2"},
                                      {"secondary", "cache"},
                                      {"bounces", "3"},
                                      {NULL, NULL}};
            assay_image   *image   = render(scene, QUICK, more);
            assay_image_digest(image, threads == 1 ? first : digest);
            assert_true(threads == 1 || strcmp(first, digest) == 0);
            assay_image_destroy(image);
            assay_scene_destroy(scene);
            assay_context_destroy(context);
        }
    }
}

/* A single pass sees fewer records; direct light is the same. */
static void passes(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context, GGX);
    const setting  once[]  = {{"passes", "1"}, {"a", "0.1"}, {NULL, NULL}};
    const setting  twice[] = {{"passes", "2"}, {"a", "0.1"}, {NULL, NULL}};
    assay_image   *two     = render(scene, QUICK, twice);
    assay_image   *one     = render(scene, QUICK, once);
    assert_true(measure_difference(one, two, "Indirect.G") > 0.0);
    assert_true(measure_difference(one, two, "Direct.G") == 0.0);
    assay_image_destroy(one);
    assay_image_destroy(two);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- refused memory, cancelling, bad settings ---- */

static assay_status quick_render(assay_context *context, assay_scene *scene, const char *method)
{
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    assay_render_options options = assay_render_options_default();
    options.width = options.height = 6;
    assay_status status            = assay_method_params(context, method, &params);
    for (const setting *s = QUICK + 1; s->name && !status; s++) {
        status = assay_params_set(params, s->name, s->value);
    }
    status = status ? status : assay_params_set(params, "rotation_steps", "2");
    status = status ? status : assay_render(scene, method, params, &options, &image, NULL);
    assay_image_destroy(image);
    assay_params_destroy(params);
    return status;
}

/* With the n-th block refused, or cancelled at the n-th call, until it succeeds. */
static int until_success(bool refuse, assay_status expected)
{
    for (uint64_t n = 1; n < 5000; n += n < 20 ? 1 : n / 8) {
        failing_memory memory  = {0};
        assay_context *context = failing_context(&memory);
        assay_scene   *scene   = room(context, WARD);
        const uint64_t live    = memory.live;
        memory.asked = memory.progress_calls = 0;
        memory.fail_at                       = refuse ? n : 0;
        memory.cancel_at                     = refuse ? 0 : n;
        const assay_status status            = quick_render(context, scene, "radiance-cache");
        memory.fail_at = memory.cancel_at = 0;
        assert_true(memory.live == live);
        if (status != ASSAY_OK) {
            assert_int_equal(status, expected);
            assert_true(strlen(assay_context_error(context)) > 0);
        }
        assay_scene_destroy(scene);
        assert_int_equal(memory.live, 1);
        assay_context_destroy(context);
        if (status == ASSAY_OK) {
            return (int)n;
        }
    }
    fail_msg("it does not end");
    return 0;
}

static void refused_and_cancelled(void **state)
{
    (void)state;
    assert_true(until_success(true, ASSAY_ERR_MEMORY) > 100);
    assert_true(until_success(false, ASSAY_ERR_CANCELLED) > 20);
}

/* Two materials of one lobe and a third: grids are released as often as made. */
static void lobes_that_are_shared(void **state)
{
    (void)state;
    static const char *const colors[] = {"[0.9,0.6,0.3,1]", "[0.2,0.3,0.4,1]", "[0.9,0.6,0.3,1]"};
    failing_memory           memory   = {0};
    assay_context           *context  = failing_context(&memory);
    scene_builder           *b        = scene_builder_create();
    for (int i = 0; i < 3; i++) {
        char text[256];
        snprintf(text, sizeof text,
                 "\"pbrMetallicRoughness\":{\"baseColorFactor\":%s,\"metallicFactor\":1,"
                 "\"roughnessFactor\":%g}",
                 colors[i], i == 1 ? 0.8 : 0.6);
        scene_builder_sphere(b, scene_builder_material(b, text), vec3(i - 1.0, 0, 0), 0.4, 2);
    }
    scene_builder_camera(b, vec3(0, 0, 3), vec3(0, 0, 0), 1.0);
    assay_scene   *scene = scene_builder_load(b, context, NULL);
    const uint64_t live  = memory.live;
    assert_int_equal(quick_render(context, scene, "radiance-cache"), ASSAY_OK);
    assert_true(memory.live == live);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Eq. 3.30 has no angle beyond 90 degrees, and a record of a = 1.2 reaches there. */
static void rotations_that_are_undefined(void **state)
{
    (void)state;
    assay_context *context   = measure_context(1);
    assay_scene   *scene     = room(context, GGX);
    assay_params  *params    = NULL;
    assay_image   *image     = NULL;
    const char    *wide[][2] = {{"a", "1.2"},          {"rotation", "analytical"},
                                {"theta_strata", "4"}, {"grid", "4"},
                                {"nodes", "8"},        {"glossy_accuracy", "0"}};
    assert_int_equal(assay_method_params(context, "radiance-cache", &params), ASSAY_OK);
    for (size_t i = 0; i < sizeof wide / sizeof wide[0]; i++) {
        assert_int_equal(assay_params_set(params, wide[i][0], wide[i][1]), ASSAY_OK);
    }
    assert_int_equal(assay_render(scene, "radiance-cache", params, NULL, &image, NULL),
                     ASSAY_ERR_ARGUMENT);
    assert_null(image);
    assert_non_null(strstr(assay_context_error(context), "90 degrees"));
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- messages ---- */

typedef struct {
    const char *method;
    int         own, others; /* lines that begin with its name, or do not */
} speaker;

static void listen(void *user, assay_log_level level, const char *line)
{
    speaker     *s      = user;
    const size_t length = strlen(s->method);
    (void)level;
    if (strstr(line, "material '")) {
        const bool own = strncmp(line, s->method, length) == 0 && line[length] == ':';
        *(own ? &s->own : &s->others) += 1;
    }
}

/* Of a material within reach and of one that is not, in the name of the method that was called. */
static void messages_name_their_method(void **state)
{
    (void)state;
    static const char *const methods[]   = {"radiance-cache", "splat"};
    static const char *const materials[] = {
        GGX, "\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}"};
    for (int i = 0; i < 4; i++) {
        speaker                     s       = {.method = methods[i / 2]};
        const assay_context_options options = {.threads = 1, .log = listen, .user = &s};
        assay_context              *context = NULL;
        assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
        assay_scene *scene = room(context, materials[i % 2]);
        assert_int_equal(quick_render(context, scene, s.method), ASSAY_OK);
        assert_int_equal(s.own, 1);
        assert_int_equal(s.others, 0);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders),
        cmocka_unit_test(lobes_and_rotations),
        cmocka_unit_test(seen_from_the_back),
        cmocka_unit_test(rotations_against_exact),
        cmocka_unit_test(what_is_out_of_reach),
        cmocka_unit_test(few_records),
        cmocka_unit_test(same_bits_for_all_threads),
        cmocka_unit_test(passes),
        cmocka_unit_test(refused_and_cancelled),
        cmocka_unit_test(lobes_that_are_shared),
        cmocka_unit_test(rotations_that_are_undefined),
        cmocka_unit_test(messages_name_their_method),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
