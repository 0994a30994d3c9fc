/* test_path_surfaces.c - surfaces that are partly there, from one side only, or let light through.
 *
 * Sheets face +Z before an orthographic camera; behind them the sky has radiance 4.  Most values
 * are exact, for nothing is left to chance; means of BLEND are binomial. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "math/vec.h"
#include "support/gltf_maker.h"
#include "support/measure.h"
#include "support/near.h"

#define BLACK "\"baseColorFactor\":[0,0,0,%.17g],\"metallicFactor\":0"
#define NO_COAT "\"KHR_materials_specular\":{\"specularFactor\":0}"

static const setting TWO_SAMPLES[] = {{"spp", "2"}, {NULL, NULL}};

/* A black sheet that emits 1 from its front, with this coverage and alpha mode. */
static int glowing(gltf_maker *m, double alpha, const char *mode)
{
    return gltf_add(m, "materials",
                    "\"emissiveFactor\":[1,1,1],\"pbrMetallicRoughness\":{" BLACK
                    "},\"extensions\":{" NO_COAT "},%s",
                    alpha, mode);
}

/* A square of side 2 h about the Z axis; front to +Z, or to -Z. */
static void add_sheet(gltf_maker *m, double z, double h, bool reversed, const char *attributes,
                      int material)
{
    const float           a = (float)h, b = (float)z;
    const float           corners[12] = {-a, -a, b, a, -a, b, a, a, b, -a, a, b};
    static const uint16_t front[6] = {0, 1, 2, 0, 2, 3}, back[6] = {0, 2, 1, 0, 3, 2};
    const int             positions = gltf_floats(m, "VEC3", 4, corners);
    gltf_shown_mesh(m, "\"attributes\":{\"POSITION\":%d%s},\"indices\":%d,\"material\":%d",
                    positions, attributes, gltf_shorts(m, 6, reversed ? back : front), material);
}

/* Sees [-1, 1] x [-1, 1] from z = 5. */
static void add_camera(gltf_maker *m)
{
    const int camera = gltf_add(m, "cameras",
                                "\"type\":\"orthographic\",\"orthographic\":{\"xmag\":1,"
                                "\"ymag\":1,\"znear\":0,\"zfar\":9}");
    gltf_add(m, "nodes", "\"camera\":%d,\"translation\":[0,0,5]", camera);
}

static assay_scene *load(gltf_maker *m, assay_context *context, double sky)
{
    assay_scene_options options = assay_scene_options_default();
    assay_scene        *scene   = NULL;
    options.background          = rgb_grey(sky);
    add_camera(m);
    if (gltf_load_status(m, context, &options, &scene) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    return scene;
}

static measured see(gltf_maker *m, double sky, const setting *settings)
{
    assay_context *context = measure_context(2);
    assay_scene   *scene   = load(m, context, sky);
    assay_image   *image   = measure_render(scene, settings, 8, 8, "color");
    const measured mean    = measure_mean(image, "R");
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return mean;
}

/* Irradiance with up to three bounces, of which black sheets take all but the first, at (0, 0, z),
 * facing +Z or -Z. */
static measured receive(gltf_maker *m, double sky, double z, bool reversed)
{
    const setting settings[] = {
        {"bounces", "3"}, {"gradients", "off"}, {"spp", "64"}, {NULL, NULL}};
    const double   point[6] = {0, 0, z, 0, 0, reversed ? -1 : 1};
    assay_context *context  = measure_context(1);
    assay_scene   *scene    = load(m, context, sky);
    assay_array   *result   = measure_probes(scene, settings, point, 1);
    const measured e        = measure_probe(result, 0, "E.R");
    assay_array_destroy(result);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return e;
}

static void exactly(measured m, double expected)
{
    assert_near(m.value, expected, 1e-6 * fabs(expected));
    assert_near(m.error, 0.0, 1e-6);
}

/* ---- coverage ---- */

static void blend(void **state)
{
    (void)state;
    const setting many[] = {{"spp", "1024"}, {NULL, NULL}};
    gltf_maker   *one = gltf_maker_create(), *two = gltf_maker_create();
    add_sheet(one, 0, 2, false, "", glowing(one, 0.3, "\"alphaMode\":\"BLEND\""));
    measure_check("one sheet", see(one, 4.0, many), 0.3 + 0.7 * 4.0, 0.0, 0.7 + 0.3 * 4.0);
    const int material = glowing(two, 0.3, "\"alphaMode\":\"BLEND\"");
    add_sheet(two, 0, 2, false, "", material);
    add_sheet(two, 1, 2, false, "", material);
    measure_check("two sheets", see(two, 4.0, many), 0.3 + 0.7 * (0.3 + 0.7 * 4.0), 0.0,
                  0.3 + 0.7 * 4.0);
}

static void blend_at_its_ends(void **state)
{
    (void)state;
    for (int alpha = 0; alpha <= 1; alpha++) {
        gltf_maker *m = gltf_maker_create();
        add_sheet(m, 0, 2, false, "", glowing(m, alpha, "\"alphaMode\":\"BLEND\""));
        exactly(see(m, 4.0, TWO_SAMPLES), alpha ? 1.0 : 4.0);
    }
}

/* At the cutoff a surface is there; OPAQUE asks for no alpha. */
static void mask(void **state)
{
    (void)state;
    static const struct {
        double      alpha, expected;
        const char *mode;
    } cases[] = {{0.3, 4.0, "\"alphaMode\":\"MASK\""},
                 {0.5, 1.0, "\"alphaMode\":\"MASK\""},
                 {0.75, 4.0, "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.8"},
                 {0.75, 1.0, "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.75"},
                 {0.0, 1.0, "\"alphaMode\":\"MASK\",\"alphaCutoff\":0"},
                 {0.0, 1.0, "\"alphaMode\":\"OPAQUE\""}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        gltf_maker *m = gltf_maker_create();
        add_sheet(m, 0, 2, false, "", glowing(m, cases[i].alpha, cases[i].mode));
        exactly(see(m, 4.0, TWO_SAMPLES), cases[i].expected);
    }
}

/* Alpha of the vertices rises from 0 to 1 across the image: what is there is 1 - cutoff of it. */
static void mask_along_a_ramp(void **state)
{
    (void)state;
    static const float colors[16] = {1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0};
    const setting      many[]     = {{"spp", "1024"}, {NULL, NULL}};
    gltf_maker        *m          = gltf_maker_create();
    char               attribute[32];
    snprintf(attribute, sizeof attribute, ",\"COLOR_0\":%d", gltf_floats(m, "VEC4", 4, colors));
    add_sheet(m, 0, 1, false, attribute,
              glowing(m, 1.0, "\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25"));
    measure_check("ramp", see(m, 4.0, many), 0.75 + 0.25 * 4.0, 0.0, 0.25 + 0.75 * 4.0);
}

/* The visible point asks for no random number: BLEND is there from 1/2 on. */
static void visible_point_of_blend(void **state)
{
    (void)state;
    for (int there = 0; there <= 1; there++) {
        gltf_maker    *m       = gltf_maker_create();
        assay_context *context = measure_context(1);
        assay_channel  material;
        add_sheet(m, 0, 2, false, "", glowing(m, there ? 0.5 : 0.4999, "\"alphaMode\":\"BLEND\""));
        assay_scene *scene = load(m, context, 4.0);
        assay_image *image = measure_render(scene, TWO_SAMPLES, 4, 4, "gbuffer");
        assert_true(assay_image_find_channel(image, "MaterialId", &material));
        assert_true(material.data.u32[7] == (there ? 0 : UINT32_MAX));
        assay_image_destroy(image);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* ---- shadows ---- */

static void add_lamp(gltf_maker *m, double z)
{
    gltf_root(m, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
                 "\"intensity\":8}]}}");
    gltf_add(m, "nodes",
             "\"translation\":[0,0,%.17g],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}",
             z);
}

/* 8 / 2^2 times what each sheet between lets through; backs block like fronts. */
static void shadows(void **state)
{
    (void)state;
    static const struct {
        double      alpha, through;
        const char *mode;
    } cases[] = {{0.3, 0.7, "\"alphaMode\":\"BLEND\""},
                 {0.3, 1.0, "\"alphaMode\":\"MASK\""},
                 {0.7, 0.0, "\"alphaMode\":\"MASK\""},
                 {0.3, 0.0, "\"alphaMode\":\"OPAQUE\""}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        for (int sheets = 1; sheets <= 2; sheets++) {
            gltf_maker *m        = gltf_maker_create();
            const int   material = glowing(m, cases[i].alpha, cases[i].mode);
            add_lamp(m, 2.0);
            for (int s = 1; s <= sheets; s++) {
                add_sheet(m, 0.5 * s, 2, s == 1, "", material);
            }
            const double factor = sheets == 1 ? 1.0 : cases[i].through;
            /* The sheets shine, too, towards the point or away from it: seen apart. */
            gltf_maker *dark = gltf_maker_create();
            const int   own  = glowing(dark, cases[i].alpha, cases[i].mode);
            for (int s = 1; s <= sheets; s++) {
                add_sheet(dark, 0.5 * s, 2, s == 1, "", own);
            }
            const measured lit   = receive(m, 0.0, 0.0, false),
                           unlit = receive(dark, 0.0, 0.0, false);
            assert_true(
                measure_agrees((measured){lit.value - unlit.value,
                                          sqrt(lit.error * lit.error + unlit.error * unlit.error)},
                               2.0 * cases[i].through * factor, 5.0, 1e-12));
        }
    }
}

/* ---- sides ---- */

static void backs_are_culled_for_the_camera_alone(void **state)
{
    (void)state;
    gltf_maker *seen = gltf_maker_create(), *both = gltf_maker_create();
    add_sheet(seen, 0, 2, true, "", glowing(seen, 1.0, "\"doubleSided\":false"));
    exactly(see(seen, 4.0, TWO_SAMPLES), 4.0);
    add_sheet(both, 0, 2, true, "", glowing(both, 1.0, "\"doubleSided\":true"));
    exactly(see(both, 4.0, TWO_SAMPLES), 1.0);
    /* The back of a sheet that is black and does not shine keeps the sky from the point, and from
     * the light's rays; the solid angle that it leaves is of 1e-6. */
    for (int reversed = 0; reversed <= 1; reversed++) {
        gltf_maker *m = gltf_maker_create();
        const int   black =
            gltf_add(m, "materials",
                     "\"pbrMetallicRoughness\":{" BLACK "},\"extensions\":{" NO_COAT "}", 1.0);
        add_sheet(m, 0.001, 1, reversed, "", black);
        assert_near(receive(m, 4.0, 0.0, false).value, 0.0, 1e-4);
    }
}

/* The sheet fills the view of the point but for 1e-6: pi in front, nothing behind. */
static void emission_is_one_sided(void **state)
{
    (void)state;
    static const struct {
        const char *sides;
        bool        reversed;
        double      expected;
    } cases[] = {{"\"doubleSided\":false", true, 3.14159265358979323846},
                 {"\"doubleSided\":false", false, 0.0},
                 {"\"doubleSided\":true", true, 3.14159265358979323846},
                 {"\"doubleSided\":true", false, 3.14159265358979323846}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        gltf_maker *m = gltf_maker_create();
        add_sheet(m, 0.001, 1, cases[i].reversed, "", glowing(m, 1.0, cases[i].sides));
        const measured e = receive(m, 0.0, 0.0, false);
        assert_true(measure_agrees(e, cases[i].expected, 5.0, 1e-4));
        assert_true(e.error < 0.2);
    }
}

/* KHR_materials_unlit: the camera sees the base colour whatever the light; the rest sees black. */
static void unlit(void **state)
{
    (void)state;
    static const char MATERIAL[] = "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,1,1,1]},"
                                   "\"emissiveFactor\":[1,1,1],"
                                   "\"extensions\":{\"KHR_materials_unlit\":{}}";
    gltf_maker *m = gltf_maker_create(), *lamp = gltf_maker_create(), *wall = gltf_maker_create();
    add_sheet(m, 0, 2, false, "", gltf_add(m, "materials", MATERIAL));
    exactly(see(m, 4.0, TWO_SAMPLES), 0.25);
    add_sheet(lamp, 0.001, 1, true, "", gltf_add(lamp, "materials", MATERIAL));
    exactly(receive(lamp, 0.0, 0.0, false), 0.0);
    add_lamp(wall, 2.0);
    add_sheet(wall, 1, 1, true, "", gltf_add(wall, "materials", MATERIAL));
    exactly(receive(wall, 0.0, 0.0, false), 0.0);
}

/* ---- bodies ---- */

/* A plate from z = 0 to z = thickness, wider than the image. */
static gltf_maker *plate(double ior, double thickness, double color, double distance)
{
    gltf_maker *m = gltf_maker_create();
    const int   material =
        gltf_add(m, "materials",
                 "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},"
                 "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
                 "\"KHR_materials_ior\":{\"ior\":%.17g},\"KHR_materials_volume\":{"
                 "\"thicknessFactor\":1,\"attenuationDistance\":%.17g,"
                 "\"attenuationColor\":[%.17g,1,1]}}",
                 ior, distance, color);
    add_sheet(m, 0, 50, true, "", material);
    add_sheet(m, thickness, 50, false, "", material);
    return m;
}

/* Without reflection what is left is color^(thickness / distance), exactly. */
static void beer(void **state)
{
    (void)state;
    static const double cases[][3] = {{2.0, 0.8, 0.7}, {0.1, 0.5, 1.0}, {3.0, 0.01, 2.0}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const double   t = cases[i][0], color = cases[i][1], distance = cases[i][2];
        const double   left = pow(color, t / distance);
        const measured m    = see(plate(1.0, t, color, distance), 4.0, TWO_SAMPLES);
        exactly(m, 4.0 * left);
        /* Mutants: the distance forgotten; light that goes the way twice. */
        assert_true(fabs(m.value - 4.0 * pow(color, t)) > 1e-3 || distance == 1.0);
        assert_true(fabs(m.value - 4.0 * left * left) > 1e-3);
    }
}

/* Straight on, each face reflects F = ((n - 1) / (n + 1))^2, and each way through keeps a: the
 * plate reflects and lets through the sums of geometric series.  The sky is the same on both sides.
 */
static void plate_that_reflects(void **state)
{
    (void)state;
    const setting many[] = {{"spp", "4096"}, {"roulette_depth", "50"}, {NULL, NULL}};
    const double  n = 1.5, color = 0.25, thickness = 1.0, distance = 2.0;
    const double  f = (n - 1) * (n - 1) / ((n + 1) * (n + 1)), a = pow(color, thickness / distance);
    const double  series  = 1.0 / (1.0 - f * f * a * a);
    const double  through = (1 - f) * (1 - f) * a * series;
    const double  back    = f + (1 - f) * (1 - f) * f * a * a * series;
    measure_check("plate", see(plate(n, thickness, color, distance), 4.0, many),
                  4.0 * (through + back), 0.0, 4.0 * ((1 - f) * (1 - f) * a + f));
}

/* A rough, infinitely thin sheet passes most of the light behind it.  The three estimators must
 * find the same: light sampling has to look behind it, too.  Sampling the BSDF knows nothing of
 * lights and is the judge; that light behind the sheet is missed is the mutant. */
static measured rough_sheet(const char *estimator)
{
    const setting settings[] = {{"spp", "1024"}, {"estimator", estimator}, {NULL, NULL}};
    gltf_maker   *m          = gltf_maker_create();
    const int     material =
        gltf_add(m, "materials",
                 "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.6},"
                 "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}}");
    add_sheet(m, 0, 50, false, "", material);
    return see(m, 1.0, settings);
}

static void sheet_that_scatters(void **state)
{
    (void)state;
    const measured judge = rough_sheet("bsdf");
    assert_true(judge.value > 0.8 && judge.value <= 1.0);
    measure_check("nee", rough_sheet("nee"), judge.value, 5.0 * judge.error, 0.5 * judge.value);
    measure_check("mis", rough_sheet("mis"), judge.value, 5.0 * judge.error, 0.9 * judge.value);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blend),
        cmocka_unit_test(blend_at_its_ends),
        cmocka_unit_test(mask),
        cmocka_unit_test(mask_along_a_ramp),
        cmocka_unit_test(visible_point_of_blend),
        cmocka_unit_test(shadows),
        cmocka_unit_test(backs_are_culled_for_the_camera_alone),
        cmocka_unit_test(emission_is_one_sided),
        cmocka_unit_test(unlit),
        cmocka_unit_test(beer),
        cmocka_unit_test(plate_that_reflects),
        cmocka_unit_test(sheet_that_scatters),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
