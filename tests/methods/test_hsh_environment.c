/* test_hsh_environment.c - distant light in harmonics against closed forms and path tracing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "assay/compare.h"
#include "core/numerics.h"
#include "math/frame.h"
#include "support/failing_context.h"
#include "support/measure.h"
#include "support/scene_builder.h"
#include "support/temporary.h"

enum { SIDE = 24 };

#define LOBES "scenes/lobes/lobes.gltf"

static assay_image *render(assay_context *context, assay_scene *scene, const char *method,
                           const char *camera, const setting *settings)
{
    assay_render_options options = assay_render_options_default();
    assay_params        *params  = NULL;
    assay_image         *image   = NULL;
    options.width = options.height = SIDE;
    options.camera                 = camera;
    options.layers                 = "color,irradiance";
    assert_int_equal(assay_method_params(context, method, &params), ASSAY_OK);
    for (; settings->name; settings++) {
        assert_int_equal(assay_params_set(params, settings->name, settings->value), ASSAY_OK);
    }
    if (assay_render(scene, method, params, &options, &image, NULL) != ASSAY_OK) {
        fail_msg("%s: %s", method, assay_context_error(context));
    }
    assay_params_destroy(params);
    return image;
}

static assay_scene *load(assay_context *context, const char *path, const char *map, double rotation)
{
    assay_scene_options options  = assay_scene_options_default();
    assay_scene        *scene    = NULL;
    options.environment_path     = map;
    options.environment_rotation = rotation;
    options.environment_scale    = map ? 1.5 : 1.0;
    options.background           = rgb_grey(map ? 0.0 : 1.0);
    if (assay_scene_load(context, path, &options, &scene) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    return scene;
}

/* A smooth sky in which no two directions are alike; `spot` adds a bright patch. */
static void write_map(assay_context *context, const char *path, bool spot)
{
    enum { W = 64, H = 32 };
    static const char *const names[3] = {"R", "G", "B"};
    assay_image             *image    = NULL;
    assert_int_equal(assay_image_create(context, W, H, &image), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        for (int i = 0; i < W * H; i++) {
            const assay_sincos phi   = assay_sincos_turns((i % W + 0.5) / W - 0.5);
            const assay_sincos theta = assay_sincos_radians(ASSAY_PI * (i / W + 0.5) / H);
            const double       d[3]  = {theta.sin * phi.sin, theta.cos, -theta.sin * phi.cos};
            channel.data.f32[i]      = (float)(1.0 + 0.7 * d[c] + 0.2 * d[c] * d[(c + 1) % 3] +
                                          (spot && d[0] > 0.6 && d[1] > 0.6 ? 30.0 : 0.0));
        }
    }
    assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
    assay_image_destroy(image);
}

static assay_channel_difference difference(const assay_image *a, const assay_image *b,
                                           const char *channel)
{
    assay_comparison        *comparison = NULL;
    assay_channel_difference found      = {0};
    assert_int_equal(assay_image_compare(a, b, &comparison), ASSAY_OK);
    for (int i = 0; i < assay_comparison_count(comparison); i++) {
        const assay_channel_difference d = assay_comparison_at(comparison, i);
        if (strcmp(d.channel, channel) == 0) {
            found         = d;
            found.channel = NULL;
        }
    }
    assay_comparison_destroy(comparison);
    return found;
}

/* ---- a constant sky ---- */

/* A Lambertian of 0.9 shows 0.9 and has irradiance pi, without any error of truncation: a constant
 * is one coefficient in every basis. */
static void furnace(void **state)
{
    (void)state;
    assay_context *context = measure_context(2);
    assay_scene   *scene   = load(context, "scenes/furnace-sphere/furnace-sphere.gltf", NULL, 0.0);
    static const char *const orders[] = {"1", "4"}, *const bases[] = {"hsh", "sh"};
    for (int i = 0; i < 4; i++) {
        const setting settings[] = {{"order", orders[i / 2]},
                                    {"brdf_basis", bases[i % 2]},
                                    {"spp", "1"},
                                    {"grid", "8"},
                                    {NULL, NULL}};
        assay_image  *image      = render(context, scene, "hsh-environment", NULL, settings);
        assay_channel g, e;
        assert_true(assay_image_find_channel(image, "G", &g));
        assert_true(assay_image_find_channel(image, "Irradiance.G", &e));
        int body = 0;
        for (int p = 0; p < SIDE * SIDE; p++) {
            const double value = (double)g.data.f32[p];
            assert_true(fabs(value - 0.9) < 1e-6 || value == 1.0);
            if (e.data.f32[p] != 0.0F) {
                assert_true(fabs((double)e.data.f32[p] - ASSAY_PI) < 1e-6);
                body++;
            }
        }
        assert_true(body > SIDE * SIDE / 8 && body < SIDE * SIDE);
        assay_image_destroy(image);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- against path tracing ---- */

static const setting PATH[] = {{"bounces", "1"}, {"spp", "128"}, {NULL, NULL}};

/* rms of z over all pixels of a channel: 1 where nothing but the noise of path differs.  What the
 * truncated harmonics leave may add a little. */
static void check_agreement(const char *what, const assay_image *truth, const assay_image *image)
{
    static const char *const channels[] = {"R", "G", "B", "Irradiance.R", "Irradiance.B"};
    for (size_t i = 0; i < sizeof channels / sizeof channels[0]; i++) {
        const assay_channel_difference d = difference(truth, image, channels[i]);
        if (!(d.z_rms > 0.7 && d.z_rms < 1.25)) {
            fail_msg("%s, %s: z rms %.3f", what, channels[i], d.z_rms);
        }
    }
}

static void agrees_with_path(void **state)
{
    (void)state;
    static const char *const cameras[]  = {"phong", "satin", "plastic"};
    const setting            settings[] = {
                   {"order", "10"}, {"sh_order", "8"}, {"spp", "32"}, {"nodes", "24"}, {NULL, NULL}};
    assay_context *context = measure_context(2);
    temporary      folder  = temporary_create();
    char           map[512];
    snprintf(map, sizeof map, "%s", temporary_path(&folder, "sky.exr"));
    write_map(context, map, false);
    assay_scene *scene = load(context, LOBES, map, 0.7);
    for (int i = 0; i < 3; i++) {
        assay_image *truth = render(context, scene, "path", cameras[i], PATH);
        assay_image *image = render(context, scene, "hsh-environment", cameras[i], settings);
        check_agreement(cameras[i], truth, image);
        assay_image_destroy(truth);
        assay_image_destroy(image);
    }
    assay_scene_destroy(scene);
    temporary_destroy(&folder);
    assay_context_destroy(context);
}

/* A two-sided leaf seen from behind, tilted in every direction. */
static void agrees_from_behind(void **state)
{
    (void)state;
    const setting settings[] = {
        {"order", "10"}, {"sh_order", "8"}, {"spp", "32"}, {"nodes", "24"}, {NULL, NULL}};
    assay_context      *context = measure_context(2);
    temporary           folder  = temporary_create();
    assay_scene_options options = assay_scene_options_default();
    scene_builder      *b       = scene_builder_create();
    const int           leaf    = scene_builder_material(
                     b, "\"doubleSided\":true,\"extras\":{\"assay\":{\"brdf\":\"phong\",\"exponent\":8,"
                                     "\"diffuse\":[0.2,0.3,0.4],\"specular\":[0.5,0.5,0.5]}}");
    const assay_vec3   n = vec3_normalize(vec3(0.4, 0.3, -0.9));
    const assay_frame3 f = frame3_from_z(n);
    scene_builder_quad(b, leaf, vec3_sub(vec3_negate(f.x), f.y), vec3_sub(f.x, f.y),
                       vec3_add(f.x, f.y), vec3_sub(f.y, f.x));
    scene_builder_camera(b, vec3(0.3, 0.2, 4.0), vec3(0, 0, 0), 0.7);
    write_map(context, temporary_path(&folder, "sky.exr"), false);
    options.environment_path = temporary_path(&folder, "sky.exr");
    assay_scene *scene       = scene_builder_load(b, context, &options);
    assay_image *truth       = render(context, scene, "path", NULL, PATH);
    assay_image *image       = render(context, scene, "hsh-environment", NULL, settings);
    check_agreement("a leaf from behind", truth, image);
    assay_image_destroy(truth);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    temporary_destroy(&folder);
    assay_context_destroy(context);
}

/* Under a sky with a bright spot the error falls with the order, and at the same order HSH beats
 * SH. The judge is a high order: nothing is random. */
static void error_falls_with_the_order(void **state)
{
    (void)state;
    static const char *const orders[] = {"2", "4", "8"};
    const setting            judge[]  = {{"order", "16"}, {"sh_order", "16"}, {"spp", "1"},
                                         {"grid", "20"},  {"nodes", "24"},    {NULL, NULL}};
    assay_context           *context  = measure_context(2);
    temporary                folder   = temporary_create();
    char                     map[512];
    snprintf(map, sizeof map, "%s", temporary_path(&folder, "sky.exr"));
    write_map(context, map, true);
    assay_scene *scene  = load(context, LOBES, map, 0.0);
    assay_image *truth  = render(context, scene, "hsh-environment", "phong", judge);
    double       before = INFINITY;
    for (int i = 0; i < 3; i++) {
        double error[2];
        for (int sh = 0; sh < 2; sh++) {
            const setting settings[] = {{"order", orders[i]}, {"sh_order", "16"},
                                        {"spp", "1"},         {"grid", "20"},
                                        {"nodes", "24"},      {"brdf_basis", sh ? "sh" : "hsh"},
                                        {NULL, NULL}};
            assay_image  *image      = render(context, scene, "hsh-environment", "phong", settings);
            error[sh]                = difference(truth, image, "G").relative_rmse;
            assay_image_destroy(image);
        }
        print_message("order %s: relative rmse hsh %.4f, sh %.4f\n", orders[i], error[0], error[1]);
        assert_true(error[0] < 0.7 * before && error[0] < error[1]);
        before = error[0];
    }
    assay_image_destroy(truth);
    assay_scene_destroy(scene);
    temporary_destroy(&folder);
    assay_context_destroy(context);
}

/* ---- what it cannot do ---- */

static void refuses(const char *path, const setting *settings, assay_status expected,
                    const char *word)
{
    assay_context *context = measure_context(1);
    assay_scene   *scene   = load(context, path, NULL, 0.0);
    assay_params  *params  = NULL;
    assay_image   *image   = NULL;
    assert_int_equal(assay_method_params(context, "hsh-environment", &params), ASSAY_OK);
    for (; settings->name; settings++) {
        assert_int_equal(assay_params_set(params, settings->name, settings->value), ASSAY_OK);
    }
    assert_int_equal(assay_render(scene, "hsh-environment", params, NULL, &image, NULL), expected);
    assert_null(image);
    if (!strstr(assay_context_error(context), word)) {
        fail_msg("'%s' is not in: %s", word, assay_context_error(context));
    }
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void refusals(void **state)
{
    (void)state;
    const setting none[]   = {{NULL, NULL}};
    const setting orders[] = {
        {"brdf_basis", "sh"}, {"order", "8"}, {"sh_order", "4"}, {NULL, NULL}};
    refuses("scenes/spheres/spheres.gltf", none, ASSAY_ERR_UNSUPPORTED, "'mirror'");
    const setting hours[] = {{"grid", "512"}, {"nodes", "512"}, {"order", "33"}, {NULL, NULL}};
    refuses(LOBES, orders, ASSAY_ERR_ARGUMENT, "'sh_order'");
    refuses(LOBES, hours, ASSAY_ERR_ARGUMENT, "hours of work");
}

/* Lights of the scene's own are not what this method is for, and it says so. */
static void warns_of_emitters(void **state)
{
    const setting  settings[] = {{"nodes", "8"}, {"grid", "4"}, {"spp", "1"}, {NULL, NULL}};
    failing_memory memory     = {0};
    assay_context *context    = failing_context(&memory);
    assay_scene   *scene      = load(context, "scenes/cornell-box/cornell-box.gltf", NULL, 0.0);
    (void)state;
    assay_image_destroy(render(context, scene, "hsh-environment", NULL, settings));
    assert_non_null(strstr(memory.log, "nothing is lit by them"));
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace),
        cmocka_unit_test(agrees_with_path),
        cmocka_unit_test(agrees_from_behind),
        cmocka_unit_test(error_falls_with_the_order),
        cmocka_unit_test(refusals),
        cmocka_unit_test(warns_of_emitters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
