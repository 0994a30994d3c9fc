/* test_impossible_scenes.c - scenes of which a cache can make nothing: what comes out is stated in
 * docs/methods/irradiance-cache.md, and is never NaN, infinite, negative or endless.
 *
 * Every scene goes through both caching methods with all kinds of weights, limits and levels. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/measure.h"
#include "support/scene_builder.h"
#include "support/temporary.h"

enum { SIZE = 6 };

/* ---- renders ---- */

static const setting COMMON[] = {{"spp", "2"},        {"a", "0.5"},           {"theta_strata", "3"},
                                 {"phi_strata", "6"}, {"max_records", "500"}, {NULL, NULL}};
enum { METHODS = 3 };
static const char *const METHOD[METHODS] = {"irradiance-cache", "radiance-cache", "splat"};
/* Of all but the first. */
static const setting GLOSSY[] = {
    {"order", "4"}, {"grid", "4"}, {"nodes", "8"}, {"glossy_accuracy", "0"}, {NULL, NULL}};

enum { VARIANTS = 10, MOST = 4 };
static const setting VARIANT[VARIANTS][MOST] = {
    {{NULL, NULL}},
    {{"bounces", "2"}, {"secondary", "direct"}, {NULL, NULL}},
    {{"secondary", "cache"}, {"levels", "3"}, {NULL, NULL}},
    {{"weight", "tabellion"}, {"neighbour_clamp", "on"}, {NULL, NULL}},
    {{"in_front", "on"}, {"r_min_pixels", "2"}, {"r_max_pixels", "20"}, {NULL, NULL}},
    {{"gradient_limit", "on"}, {"r_min_pixels", "1"}, {NULL, NULL}},
    {{"passes", "1"}, {"a", "0.000001"}, {"max_records", "9"}, {NULL, NULL}},
    {{"a", "1000"}, {"normal_gradient", "on"}, {"clamp_negative", "off"}, {NULL, NULL}},
    {{"max_records", "1"}, {NULL, NULL}},
    {{"theta_strata", "2"}, {"phi_strata", "2"}, {"mean", "cosine"}, {NULL, NULL}},
};

static bool has(const assay_params *params, const char *name)
{
    const assay_param_desc *row = assay_params_table(params);
    while (row->name && strcmp(row->name, name) != 0) {
        row++;
    }
    return row->name != NULL;
}

/* Splatting knows no passes. */
static void set_all(assay_params *params, const setting *settings)
{
    for (const setting *s = settings; s->name; s++) {
        assert_true(has(params, s->name) || strcmp(s->name, "passes") == 0);
        if (has(params, s->name)) {
            assert_int_equal(assay_params_set(params, s->name, s->value), ASSAY_OK);
        }
    }
}

static assay_status render(assay_context *context, assay_scene *scene, int method_number,
                           int variant, assay_image **image_out, assay_render_stats *stats)
{
    const char          *method  = METHOD[method_number];
    assay_render_options options = assay_render_options_default();
    assay_params        *params  = NULL;
    options.width = options.height = SIZE;
    assert_int_equal(assay_method_params(context, method, &params), ASSAY_OK);
    set_all(params, COMMON);
    if (method_number > 0) {
        set_all(params, GLOSSY);
    }
    set_all(params, VARIANT[variant]);
    const assay_status status = assay_render(scene, method, params, &options, image_out, stats);
    assay_params_destroy(params);
    return status;
}

/* ---- what is looked for ---- */

static bool starts(const char *name, const char *with)
{
    return strncmp(name, with, strlen(with)) == 0;
}

/* No number that is none.  Z is infinite where nothing is seen, by convention. */
static void check_numbers(const char *what, const assay_image *image)
{
    for (int c = 0; c < assay_image_channel_count(image); c++) {
        const assay_channel channel = assay_image_channel_at(image, c);
        for (int i = 0; i < SIZE * SIZE && channel.type == ASSAY_CHANNEL_FLOAT; i++) {
            const double x = channel.data.f32[i];
            if (!isfinite(x) && !(strcmp(channel.name, "Z") == 0 && x > 0.0)) {
                fail_msg("%s: %s of pixel %d is %g", what, channel.name, i, x);
            }
        }
    }
}

/* Indirect light: none anywhere. */
static void check_dark(const char *what, const assay_image *image)
{
    for (int c = 0; c < assay_image_channel_count(image); c++) {
        const assay_channel channel = assay_image_channel_at(image, c);
        const bool          indirect =
            starts(channel.name, "Indirect.") || starts(channel.name, "IrradianceIndirect.");
        for (int i = 0; indirect && i < SIZE * SIZE; i++) {
            if (channel.data.f32[i] != 0.0F) {
                fail_msg("%s: %s of pixel %d is %g", what, channel.name, i,
                         (double)channel.data.f32[i]);
            }
        }
    }
}

typedef struct {
    bool dark;   /* no indirect light                 */
    bool unseen; /* no records                        */
} expected;

static void check(const char *what, assay_scene *(*make)(assay_context *context), expected e)
{
    assay_context *context = measure_context(1);
    assay_scene   *scene   = make(context);
    for (int variant = 0; variant < VARIANTS; variant++) {
        for (int method = 0; method < METHODS; method++) {
            char               words[128];
            assay_render_stats stats = {0};
            assay_image       *image = NULL;
            snprintf(words, sizeof words, "%s, variant %d, %s", what, variant, METHOD[method]);
            if (render(context, scene, method, variant, &image, &stats) != ASSAY_OK) {
                fail_msg("%s: %s", words, assay_context_error(context));
            }
            check_numbers(words, image);
            if (e.dark) {
                check_dark(words, image);
            }
            if (e.unseen) {
                assert_true(stats.records == 0);
            }
            assay_image_destroy(image);
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- scenes ---- */

static const char *const METAL  = "\"pbrMetallicRoughness\":{\"metallicFactor\":1,"
                                  "\"roughnessFactor\":0.6},\"doubleSided\":true";
static const char *const MIRROR = "\"pbrMetallicRoughness\":{\"metallicFactor\":1,"
                                  "\"roughnessFactor\":0},\"doubleSided\":true";
static const char *const GLASS =
    "\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0},\"extensions\":{"
    "\"KHR_materials_transmission\":{\"transmissionFactor\":1},\"KHR_materials_volume\":{"
    "\"thicknessFactor\":1}}";

/* A room with a lamp of some emission and a box of some material. */
static scene_builder *start_room(int walls_of, double emission, const char *thing_of)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = walls_of == 0   ? scene_builder_diffuse(b, 0.5, 0.0, true)
                           : walls_of == 1 ? scene_builder_diffuse(b, 0.0, 0.0, true)
                                           : scene_builder_material(b, MIRROR);
    const int      lamp  = scene_builder_diffuse(b, 0.0, emission, true);
    const int      thing = thing_of ? scene_builder_material(b, thing_of) : walls;
    scene_builder_box(b, walls, vec3(-1, -1, -1), vec3(1, 1, 1), true);
    scene_builder_box(b, thing, vec3(-0.4, -1, -0.4), vec3(0.4, 0.2, 0.4), false);
    scene_builder_quad(b, lamp, vec3(-0.3, 0.9, -0.3), vec3(0.3, 0.9, -0.3), vec3(0.3, 0.9, 0.3),
                       vec3(-0.3, 0.9, 0.3));
    return b;
}

static assay_scene *no_light(assay_context *context)
{
    scene_builder *b = start_room(0, 0.0, METAL);
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *all_black(assay_context *context)
{
    scene_builder *b = start_room(1, 5.0, NULL);
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *all_mirrors(assay_context *context)
{
    scene_builder *b = start_room(2, 5.0, MIRROR);
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

/* The box's sides face outward and are seen from within: two-sided, it is a dark cell. */
static assay_scene *inside_a_solid(assay_context *context)
{
    scene_builder *b = start_room(0, 5.0, METAL);
    scene_builder_camera(b, vec3(0.0, -0.5, 0.0), vec3(0.1, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *inside_glass(assay_context *context)
{
    scene_builder *b = start_room(0, 5.0, GLASS);
    scene_builder_camera(b, vec3(0.0, -0.5, 0.0), vec3(0.1, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

/* The eye in the very plane of a wall, and that of the box's front. */
static assay_scene *on_a_surface(assay_context *context)
{
    scene_builder *b = start_room(0, 5.0, METAL);
    scene_builder_camera(b, vec3(0.0, -0.2, 0.4), vec3(0.1, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *looks_away(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      floor = scene_builder_diffuse(b, 0.5, 1.0, true);
    scene_builder_quad(b, floor, vec3(-1, 0, -1), vec3(1, 0, -1), vec3(1, 0, 1), vec3(-1, 0, 1));
    scene_builder_camera(b, vec3(0, 1, 0), vec3(0.1, 3, 0), 0.5);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *no_triangle(assay_context *context)
{
    scene_builder *b = scene_builder_create();
    scene_builder_camera(b, vec3(0, 1, 0), vec3(0.1, 0, 0), 0.5);
    return scene_builder_load(b, context, NULL);
}

/* Triangles without area: points and lines, some at the origin. */
static assay_scene *no_area(assay_context *context)
{
    scene_builder *b    = scene_builder_create();
    const int      grey = scene_builder_diffuse(b, 0.5, 1.0, true);
    scene_builder_quad(b, grey, vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0), vec3(0, 0, 0));
    scene_builder_camera(b, vec3(0, 0, 1), vec3(0, 0, 0), 0.5);
    return scene_builder_load(b, context, NULL);
}

/* Rays that leave it see nothing: R is the diagonal. */
static assay_scene *alone_under_a_sky(assay_context *context)
{
    assay_scene_options options = assay_scene_options_default();
    scene_builder      *b       = scene_builder_create();
    const int           floor   = scene_builder_material(b, METAL);
    options.background          = rgb_grey(1.0);
    scene_builder_quad(b, floor, vec3(-1, 0, 1), vec3(1, 0, 1), vec3(1, 0, -1), vec3(-1, 0, -1));
    scene_builder_camera(b, vec3(0, 1, 1), vec3(0, 0, 0), 1.0);
    return scene_builder_load(b, context, &options);
}

/* A floor that is a needle, with a wall that touches it: rays with hits at distance 0 or near. */
static assay_scene *needles(assay_context *context)
{
    scene_builder *b    = scene_builder_create();
    const int      grey = scene_builder_diffuse(b, 0.5, 0.0, true);
    const int      lamp = scene_builder_diffuse(b, 0.5, 3.0, true);
    scene_builder_quad(b, grey, vec3(-1, 0, 1), vec3(1, 0, 1), vec3(1, 0, -1), vec3(-1, 0, -1));
    scene_builder_quad(b, grey, vec3(-1, 0, 0), vec3(1, 0, 0), vec3(1, 1e-6, 0), vec3(-1, 1e-6, 0));
    scene_builder_quad(b, lamp, vec3(-1, 1e-7, 1), vec3(1, 1e-7, 1), vec3(1, 1e-7, 0.5),
                       vec3(-1, 1e-7, 0.5));
    scene_builder_camera(b, vec3(0, 1, 1), vec3(0, 0, 0), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *scaled_room(assay_context *context, double s)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.5, 0.0, true);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 5.0, true);
    const int      metal = scene_builder_material(b, METAL);
    scene_builder_box(b, walls, vec3(-s, -s, -s), vec3(s, s, s), true);
    scene_builder_box(b, metal, vec3(-0.4 * s, -s, -0.4 * s), vec3(0.4 * s, 0.2 * s, 0.4 * s),
                      false);
    scene_builder_quad(b, lamp, vec3(-0.3 * s, 0.9 * s, -0.3 * s), vec3(0.3 * s, 0.9 * s, -0.3 * s),
                       vec3(0.3 * s, 0.9 * s, 0.3 * s), vec3(-0.3 * s, 0.9 * s, 0.3 * s));
    scene_builder_camera(b, vec3(0.2 * s, 0.1 * s, 0.95 * s), vec3(0, -0.4 * s, -0.2 * s), 1.0);
    return scene_builder_load(b, context, NULL);
}

static assay_scene *tiny(assay_context *context) { return scaled_room(context, 1e-15); }
static assay_scene *huge(assay_context *context) { return scaled_room(context, 1e15); }

/* ---- tests ---- */

static void dark_scenes(void **state)
{
    (void)state;
    const expected dark = {.dark = true};
    check("no light", no_light, dark);
    check("all black", all_black, dark);
    check("inside a solid", inside_a_solid, dark);
}

static void empty_scenes(void **state)
{
    (void)state;
    const expected nothing = {.dark = true, .unseen = true};
    check("looks away", looks_away, nothing);
    check("no triangle", no_triangle, nothing);
    check("no area", no_area, nothing);
}

static void odd_scenes(void **state)
{
    (void)state;
    const expected anything = {0};
    check("all mirrors", all_mirrors, anything);
    check("inside glass", inside_glass, anything);
    check("on a surface", on_a_surface, anything);
    check("alone under a sky", alone_under_a_sky, anything);
    check("needles", needles, anything);
}

static void sizes(void **state)
{
    (void)state;
    const expected anything = {0};
    check("tiny", tiny, anything);
    check("huge", huge, anything);
}

/* Metres play no part: scaled by a power of two, which no float rounds, the light has the same
 * bits.
 */
static void scale_plays_no_part(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *plain   = scaled_room(context, 1.0);
    for (int method = 0; method < METHODS; method++) {
        for (int variant = 0; variant < VARIANTS; variant++) {
            assay_image *image = NULL;
            assert_int_equal(render(context, plain, method, variant, &image, NULL), ASSAY_OK);
            assert_true(measure_mean(image, "IrradianceIndirect.G").value > 0.0);
            for (int sign = -1; sign <= 1; sign += 2) {
                assay_scene *scaled = scaled_room(context, sign > 0 ? 0x1p30 : 0x1p-30);
                assay_image *other  = NULL;
                assert_int_equal(render(context, scaled, method, variant, &other, NULL), ASSAY_OK);
                assert_true(measure_difference(image, other, "G") == 0.0);
                assert_true(measure_difference(image, other, "IrradianceIndirect.G") == 0.0);
                assay_image_destroy(other);
                assay_scene_destroy(scaled);
            }
            assay_image_destroy(image);
        }
    }
    assay_scene_destroy(plain);
    assay_context_destroy(context);
}

/* All mirrors: nothing Lambertian asks the cache, so the image is that of paths. */
static void mirrors_are_paths(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = all_mirrors(context);
    const setting  path[]  = {{"spp", "600"}, {"bounces", "6"}, {NULL, NULL}};
    const setting  cache[] = {{"method", "irradiance-cache"}, {"spp", "600"},      {"bounces", "6"},
                              {"theta_strata", "3"},          {"phi_strata", "6"}, {NULL, NULL}};
    assay_image   *truth   = measure_render(scene, path, SIZE, SIZE, "split");
    assay_image   *image   = measure_render(scene, cache, SIZE, SIZE, "split");
    const measured t = measure_mean(truth, "Indirect.G"), m = measure_mean(image, "Indirect.G");
    const measured both = {m.value, sqrt(m.error * m.error + t.error * t.error)};
    measure_check("mirrors", both, t.value, 0.0, 0.8 * t.value);
    assay_image_destroy(truth);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* Against an image without indirect light, too, an error is a colour. */
static void pictures_of_nothing(void **state)
{
    (void)state;
    temporary      t       = temporary_create();
    const char    *file    = temporary_path(&t, "reference.exr");
    assay_context *context = measure_context(1);
    assay_scene   *scene   = no_light(context);
    assay_image   *dark    = NULL;
    assert_int_equal(render(context, scene, true, 0, &dark, NULL), ASSAY_OK);
    assert_int_equal(assay_image_write_exr(dark, file), ASSAY_OK);
    assay_image_destroy(dark);
    for (int kind = 1; kind < 4; kind++) {
        static const char *const kinds[] = {"off", "records", "weights", "error"};
        const setting            more[]  = {{"method", "radiance-cache"},
                                            {"spp", "1"},
                                            {"theta_strata", "3"},
                                            {"phi_strata", "6"},
                                            {"order", "4"},
                                            {"grid", "4"},
                                            {"nodes", "8"},
                                            {"glossy_accuracy", "0"},
                                            {"debug", kinds[kind]},
                                            {"reference", file},
                                            {NULL, NULL}};
        assay_image             *image   = measure_render(scene, more, SIZE, SIZE, NULL);
        check_numbers(kinds[kind], image);
        assert_true(kind != 3 || measure_mean(image, "G").value == 0.0);
        assay_image_destroy(image);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    temporary_destroy(&t);
}

/* Light that no double holds is refused by name, whichever method meets it. */
static void too_bright(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    scene_builder *b       = start_room(0, 3e38, METAL);
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    assay_scene *scene = scene_builder_load(b, context, NULL);
    for (int method = 0; method < METHODS; method++) {
        assay_image       *image  = NULL;
        const assay_status status = render(context, scene, method, 0, &image, NULL);
        assert_int_equal(status, ASSAY_ERR_DOMAIN);
        assert_non_null(strstr(assay_context_error(context), "too bright"));
        assert_null(image);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(dark_scenes),         cmocka_unit_test(empty_scenes),
        cmocka_unit_test(odd_scenes),          cmocka_unit_test(sizes),
        cmocka_unit_test(scale_plays_no_part), cmocka_unit_test(mirrors_are_paths),
        cmocka_unit_test(pictures_of_nothing), cmocka_unit_test(too_bright),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
