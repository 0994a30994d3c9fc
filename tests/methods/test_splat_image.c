/* test_splat_image.c - images by splatting against the octree's with the same records, and against
 * `path`.
 *
 * The mistakes that the checks must see: pixels that a record should reach and does not, records
 * that count twice, sums that are not divided, records made where none is missing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/rendered.h"
#include "support/scene_builder.h"

#define METAL                                                                                      \
    "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.6,0.3,1],\"metallicFactor\":1,"          \
    "\"roughnessFactor\":0.6}"
#define WARD                                                                                       \
    "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0},"                        \
    "\"extras\":{\"assay\":{\"brdf\":\"ward\",\"diffuse\":[0.2,0.2,0.2],"                          \
    "\"specular\":[0.5,0.4,0.3],\"alpha\":[0.2,0.5]}}"
#define MIRROR "\"pbrMetallicRoughness\":{\"metallicFactor\":1,\"roughnessFactor\":0}"

/* A room with a lamp and a ball; two cameras. */
static assay_scene *room(assay_context *context, const char *material)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.5, 0.0, false);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int      ball  = material ? scene_builder_material(b, material) : walls;
    scene_builder_box(b, walls, vec3(-1, -1, -1), vec3(1, 1, 1), true);
    scene_builder_sphere(b, ball, vec3(0, -0.4, -0.2), 0.6, 2);
    /* Shows the camera its back, where it has one. */
    scene_builder_quad(b, ball, vec3(-0.9, -0.9, -0.5), vec3(-0.9, 0.4, -0.6),
                       vec3(-0.5, 0.4, -0.9), vec3(-0.5, -0.9, -0.8));
    scene_builder_quad(b, lamp, vec3(-0.3, 0.98, -0.3), vec3(0.3, 0.98, -0.3), vec3(0.3, 0.98, 0.3),
                       vec3(-0.3, 0.98, 0.3));
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    scene_builder_camera(b, vec3(-0.6, 0.3, 0.9), vec3(0.1, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static const setting SPLAT[] = {
    {"method", "splat"},      {"size", "40"},       {"spp", "1"},     {"a", "0.3"},
    {"theta_strata", "6"},    {"phi_strata", "15"}, {"bounces", "2"}, {"secondary", "direct"},
    {"estimator", "nee"},     {"order", "4"},       {"grid", "8"},    {"nodes", "16"},
    {"glossy_accuracy", "0"}, {NULL, NULL}};
static const setting IRRADIANCE[] = {
    {"method", "irradiance-cache"}, {"size", "40"},       {"spp", "1"},     {"a", "0.3"},
    {"theta_strata", "6"},          {"phi_strata", "15"}, {"bounces", "2"}, {"secondary", "direct"},
    {"estimator", "nee"},           {NULL, NULL}};
static const setting RADIANCE[] = {
    {"method", "radiance-cache"}, {"size", "40"},       {"spp", "1"},     {"a", "0.3"},
    {"theta_strata", "6"},        {"phi_strata", "15"}, {"bounces", "2"}, {"secondary", "direct"},
    {"estimator", "nee"},         {"order", "4"},       {"grid", "8"},    {"nodes", "16"},
    {"glossy_accuracy", "0"},     {NULL, NULL}};

typedef struct {
    rendering    r;
    assay_scene *scene;
    char        *folder;
} studio;

static void open_studio(studio *s, const char *material)
{
    rendering_open(&s->r, 1);
    s->scene  = room(s->r.context, material);
    s->folder = rendered_folder();
}

static void close_studio(studio *s)
{
    assay_scene_destroy(s->scene);
    rendering_close(&s->r);
    rendered_remove(s->folder);
}

/* Files that a shell compares: every array of records. */
static bool same_records(const char *a, const char *b)
{
    char command[2 * RENDERED_TEXT + 64];
    snprintf(command, sizeof command, "diff -rq -x manifest.json '%s' '%s' > /dev/null", a, b);
    return system(command) == 0;
}

/* ---- against the octree ---- */

static void check_against(studio *s, const setting *octree, const setting *more, const char *what)
{
    static int number = 0;
    char       names[2][32];
    setting    all[2][RENDERED_MAX_SETTINGS] = {{{NULL, NULL}}};
    rendered   made[2];
    number++;
    for (int k = 0; k < 2; k++) {
        int count = 0;
        snprintf(names[k], sizeof names[k], "%c%d", "os"[k], number);
        for (const setting *m = more; m && m->name; m++) {
            all[k][count++] = *m;
        }
        all[k][count] = (setting){"cache_out", rendered_path(s->folder, names[k])};
        made[k]       = rendered_make(&s->r, s->scene, k ? SPLAT : octree, all[k]);
    }
    const double color = rendered_difference(&made[0], &made[1], "G");
    const double e     = rendered_difference(&made[0], &made[1], "IrradianceIndirect.R");
    print_message("#| %-28s %4llu records; largest difference %.1e, of irradiance %.1e\n", what,
                  (unsigned long long)made[1].stats.records, color, e);
    assert_true(
        same_records(rendered_path(s->folder, names[0]), rendered_path(s->folder, names[1])));
    /* Channels are floats: sums that differ by 1e-12 may be rounded to neighbours. */
    assert_true(color < 1e-6 && e < 1e-6);
    assert_true(made[0].stats.scatter_rays == made[1].stats.scatter_rays);
    rendered_drop(&made[0]);
    rendered_drop(&made[1]);
}

static void same_as_irradiance_cache(void **state)
{
    (void)state;
    const setting coarse[] = {{"traversal", "hierarchical"}, {NULL, NULL}};
    const setting other[] = {{"weight", "tabellion"}, {"in_front", "on"}, {"a", "1"}, {NULL, NULL}};
    const setting large[] = {{"a", "1.5"}, {NULL, NULL}};
    const setting second[] = {{"camera", "1"}, {"seed", "3"}, {NULL, NULL}};
    studio        s;
    open_studio(&s, NULL);
    check_against(&s, IRRADIANCE, NULL, "diffuse");
    check_against(&s, IRRADIANCE, coarse, "hierarchical");
    check_against(&s, IRRADIANCE, other, "tabellion, in_front");
    check_against(&s, IRRADIANCE, large, "a above 1");
    check_against(&s, IRRADIANCE, second, "another camera");
    close_studio(&s);
    open_studio(&s, MIRROR);
    check_against(&s, IRRADIANCE, NULL, "a mirror by paths");
    close_studio(&s);
}

/* Its camera is orthographic. */
static void from_far_away(void **state)
{
    (void)state;
    const setting many[] = {{"a", "0.05"}, {NULL, NULL}};
    studio        s;
    rendering_open(&s.r, 1);
    s.folder = rendered_folder();
    assert_int_equal(assay_scene_load(s.r.context,
                                      "scenes/rectangle-over-plane/rectangle-over-plane.gltf", NULL,
                                      &s.scene),
                     ASSAY_OK);
    check_against(&s, IRRADIANCE, many, "orthographic");
    close_studio(&s);
}

static void same_as_radiance_cache(void **state)
{
    (void)state;
    const setting turned[] = {{"a", "0.6"}, {"coefficient_gradient", "points"}, {NULL, NULL}};
    studio        s;
    open_studio(&s, METAL);
    check_against(&s, RADIANCE, NULL, "glossy");
    check_against(&s, RADIANCE, turned, "glossy, turned further");
    close_studio(&s);
    open_studio(&s, WARD);
    check_against(&s, RADIANCE, turned, "axes of a lobe, both sides");
    close_studio(&s);
}

/* ---- against path ---- */

static void check_mean(const rendered *made, const rendered *truth, const char *channel)
{
    const measured m = measure_mean(made->image, channel), t = measure_mean(truth->image, channel);
    const double   error = sqrt(m.error * m.error + t.error * t.error);
    print_message("#| %-22s %.5f +- %.5f, path %.5f +- %.5f\n", channel, m.value, m.error, t.value,
                  t.error);
    assert_true(fabs(m.value - t.value) <= 5.0 * error + 0.015 * t.value);
    assert_true(fabs(1.15 * m.value - t.value) > 5.0 * error + 0.015 * t.value);
}

static void agrees_with_path(void **state)
{
    (void)state;
    const setting more[] = {{"spp", "16"},          {"a", "0.15"},        {"size", "16"},
                            {"theta_strata", "12"}, {"phi_strata", "25"}, {NULL, NULL}};
    const setting path[] = {
        {"method", "path"}, {"size", "16"}, {"spp", "200"}, {"bounces", "2"}, {NULL, NULL}};
    studio s;
    open_studio(&s, METAL);
    rendered made  = rendered_make(&s.r, s.scene, SPLAT, more),
             truth = rendered_make(&s.r, s.scene, path, NULL);
    assert_int_equal(made.status, ASSAY_OK);
    check_mean(&made, &truth, "Indirect.G");
    check_mean(&made, &truth, "IrradianceIndirect.R");
    rendered_drop(&made);
    rendered_drop(&truth);
    close_studio(&s);
}

/* ---- figure 4.2 ---- */

/* Rms step of the indirect irradiance between neighbours on one plane, in parts of its mean. */
static double steps(const rendered *made, int size)
{
    assay_channel e, nx, ny;
    double        squares = 0.0, sum = 0.0;
    int           pairs = 0;
    assert_true(assay_image_find_channel(made->image, "IrradianceIndirect.G", &e) &&
                assay_image_find_channel(made->image, "N.X", &nx) &&
                assay_image_find_channel(made->image, "N.Y", &ny));
    for (int i = 0; i < size * (size - 1); i++) {
        const int below = i + size, right = i % size + 1 < size ? i + 1 : i;
        for (int k = 0; k < 2; k++) {
            const int    other = k ? below : right;
            const double d     = (double)e.data.f32[i] - e.data.f32[other];
            const bool   same =
                nx.data.f32[i] == nx.data.f32[other] && ny.data.f32[i] == ny.data.f32[other];
            squares += same ? d * d : 0.0;
            pairs += same;
        }
        sum += e.data.f32[i];
    }
    return sqrt(squares / pairs) * size * (size - 1) / sum;
}

/* One pass of the octree leaves seams; splatting in one pass is as smooth as the octree in two. */
static void no_seams(void **state)
{
    (void)state;
    const setting coarse[] = {{"a", "0.4"}, {"gradients", "none"}, {"size", "64"}, {NULL, NULL}};
    const setting once[]   = {
          {"a", "0.4"}, {"gradients", "none"}, {"size", "64"}, {"passes", "1"}, {NULL, NULL}};
    studio s;
    open_studio(&s, NULL);
    rendered     one      = rendered_make(&s.r, s.scene, IRRADIANCE, once);
    rendered     two      = rendered_make(&s.r, s.scene, IRRADIANCE, coarse);
    rendered     splat    = rendered_make(&s.r, s.scene, SPLAT, coarse);
    const double seams[3] = {steps(&one, 64), steps(&two, 64), steps(&splat, 64)};
    print_message("#| steps between neighbours: one pass %.4f, two %.4f, splatting %.4f\n",
                  seams[0], seams[1], seams[2]);
    assert_true(seams[0] > 1.2 * seams[2]);
    assert_true(fabs(seams[2] - seams[1]) <= 1e-6 * seams[1]);
    rendered_drop(&one);
    rendered_drop(&two);
    rendered_drop(&splat);
    close_studio(&s);
}

/* ---- variants ---- */

/* With an empty cache both steps 5 are the same; with old records the published one is wrong, and
 * the corrected one is that of a buffer which is cleared and splatted anew (ERRATA T30). */
static void step_5(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, NULL);
    const char   *one         = rendered_path(s.folder, "one");
    const char   *both        = rendered_path(s.folder, "both");
    const setting published[] = {{"variant", "published"}, {NULL, NULL}};
    const setting save[]      = {{"camera", "0"}, {"cache_out", one}, {NULL, NULL}};
    const setting next[]  = {{"camera", "1"}, {"cache_in", one}, {"cache_out", both}, {NULL, NULL}};
    const setting twice[] = {
        {"camera", "1"}, {"cache_in", one}, {"variant", "published"}, {NULL, NULL}};
    const setting anew[] = {
        {"camera", "1"}, {"cache_in", both}, {"max_new_records", "0"}, {NULL, NULL}};
    const setting again[] = {
        {"camera", "1"}, {"cache_in", both}, {"variant", "published"}, {NULL, NULL}};
    rendered first   = rendered_make(&s.r, s.scene, SPLAT, save);
    rendered literal = rendered_make(&s.r, s.scene, SPLAT, published);
    rendered more    = rendered_make(&s.r, s.scene, SPLAT, next);
    rendered wrong   = rendered_make(&s.r, s.scene, SPLAT, twice);
    rendered fresh   = rendered_make(&s.r, s.scene, SPLAT, anew);
    rendered old     = rendered_make(&s.r, s.scene, SPLAT, again);
    assert_true(rendered_same(&first, &literal));
    assert_true(more.stats.records > first.stats.records);
    assert_true(wrong.stats.records == more.stats.records);
    const double d = rendered_difference(&more, &wrong, "IrradianceIndirect.G");
    print_message("#| old records twice: %.4f of the mean\n", d);
    assert_true(d > 1e-3);
    assert_true(rendered_same(&more, &fresh));
    /* All twice is as good as once. */
    assert_true(rendered_difference(&fresh, &old, "IrradianceIndirect.G") < 1e-6);
    rendered_drop(&first);
    rendered_drop(&literal);
    rendered_drop(&more);
    rendered_drop(&wrong);
    rendered_drop(&fresh);
    rendered_drop(&old);
    close_studio(&s);
}

/* The same records with another a: what an octree answers that is made with it. */
static void check_accuracy(const char *material, const setting *octree_method, const char *channel)
{
    studio s;
    open_studio(&s, material);
    const char   *saved    = rendered_path(s.folder, "saved");
    const setting save[]   = {{"cache_out", saved}, {NULL, NULL}};
    const setting wider[]  = {{"splat_a", "0.9"}, {NULL, NULL}};
    const setting octree[] = {{"a", "0.9"}, {"cache_in", saved}, {NULL, NULL}};
    rendered      plain    = rendered_make(&s.r, s.scene, SPLAT, save);
    rendered      wide     = rendered_make(&s.r, s.scene, SPLAT, wider);
    rendered      judge    = rendered_make(&s.r, s.scene, octree_method, octree);
    assert_true(wide.stats.records == plain.stats.records);
    assert_true(judge.stats.records == plain.stats.records);
    assert_true(rendered_difference(&wide, &judge, channel) < 1e-6);
    assert_true(rendered_difference(&wide, &plain, channel) > 1e-3);
    rendered_drop(&plain);
    rendered_drop(&wide);
    rendered_drop(&judge);
    close_studio(&s);
}

/* Of glossy records those count, too, that are tilted further than their own a lets them. */
static void another_accuracy(void **state)
{
    (void)state;
    check_accuracy(NULL, IRRADIANCE, "IrradianceIndirect.G");
    check_accuracy(METAL, RADIANCE, "Indirect.R");
}

/* The eye in the zones of records, which billboards lose. */
static void published_bounds(void **state)
{
    (void)state;
    const setting published[] = {{"bounds", "published"}, {"a", "0.6"}, {NULL, NULL}};
    const setting exact[]     = {{"a", "0.6"}, {NULL, NULL}};
    studio        s;
    open_studio(&s, NULL);
    rendered good = rendered_make(&s.r, s.scene, SPLAT, exact);
    assert_int_equal(s.r.warnings, 0);
    rendered lossy = rendered_make(&s.r, s.scene, SPLAT, published);
    print_message("#| %s\n", s.r.warning);
    assert_true(s.r.warnings > 0);
    assert_true(good.stats.lost == 0 && lossy.stats.lost > 0);
    assert_true(rendered_difference(&good, &lossy, "IrradianceIndirect.G") > 1e-3);
    /* A pixel that its own record never reaches is no reason to go on for ever. */
    const setting endless[] = {
        {"bounds", "published"}, {"a", "1.5"}, {"neighbour_clamp", "on"}, {NULL, NULL}};
    rendered ended = rendered_make(&s.r, s.scene, SPLAT, endless);
    assert_int_equal(ended.status, ASSAY_OK);
    assert_true(ended.stats.records < 1600);
    rendered_drop(&ended);
    rendered_drop(&good);
    rendered_drop(&lossy);
    close_studio(&s);
}

static int black_pixels(const rendered *made)
{
    assay_channel channel;
    int           count = 0;
    assert_true(assay_image_find_channel(made->image, "IrradianceIndirect.G", &channel));
    for (int i = 0; i < 40 * 40; i++) {
        count += channel.data.f32[i] == 0.0f;
    }
    return count;
}

/* A few records at a time, as a walk adds them: the rest is black, or what the nearest says. */
static void few_new_records(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, NULL);
    const setting none[]  = {{"max_new_records", "0"}, {"uncovered", "black"}, {NULL, NULL}};
    const setting few[]   = {{"max_new_records", "20"}, {"uncovered", "black"}, {NULL, NULL}};
    const setting near[]  = {{"max_new_records", "20"}, {NULL, NULL}};
    rendered      zero    = rendered_make(&s.r, s.scene, SPLAT, none);
    rendered      part    = rendered_make(&s.r, s.scene, SPLAT, few);
    rendered      nearest = rendered_make(&s.r, s.scene, SPLAT, near);
    rendered      full    = rendered_make(&s.r, s.scene, SPLAT, NULL);
    assert_true(zero.stats.records == 0 && part.stats.records == 20 && nearest.stats.records == 20);
    assert_int_equal(s.r.warnings, 3);
    assert_int_equal(black_pixels(&zero), 40 * 40);
    assert_in_range(black_pixels(&part), 100, 40 * 40 - 100);
    assert_int_equal(black_pixels(&nearest), 0);
    assert_int_equal(black_pixels(&full), 0);
    rendered_drop(&zero);
    rendered_drop(&part);
    rendered_drop(&nearest);
    rendered_drop(&full);
    close_studio(&s);
}

/* Records that shrink while they are made leave no pixel without, and nothing of what they were. */
static void shrinking_records(void **state)
{
    (void)state;
    studio s;
    open_studio(&s, NULL);
    const char   *saved   = rendered_path(s.folder, "saved");
    const setting clamp[] = {
        {"neighbour_clamp", "on"}, {"uncovered", "black"}, {"cache_out", saved}, {NULL, NULL}};
    const setting again[] = {{"cache_in", saved}, {"max_new_records", "0"}, {NULL, NULL}};
    rendered      plain   = rendered_make(&s.r, s.scene, SPLAT, NULL);
    rendered      made    = rendered_make(&s.r, s.scene, SPLAT, clamp);
    rendered      anew    = rendered_make(&s.r, s.scene, SPLAT, again);
    assert_int_equal(made.status, ASSAY_OK);
    assert_int_equal(s.r.warnings, 0);
    assert_int_equal(black_pixels(&made), 0);
    assert_true(made.stats.records > plain.stats.records);
    assert_true(rendered_same(&made, &anew));
    rendered_drop(&plain);
    rendered_drop(&made);
    rendered_drop(&anew);
    close_studio(&s);
}

/* Of the centres alone: an unjittered sample of each pixel has its light. */
static void centres(void **state)
{
    (void)state;
    const setting alone[] = {{"gbuffer", "centres"}, {"spp", "3"}, {NULL, NULL}};
    studio        s;
    open_studio(&s, NULL);
    rendered made = rendered_make(&s.r, s.scene, SPLAT, alone);
    assert_int_equal(made.status, ASSAY_OK);
    assay_channel light, e, albedo, variance;
    assert_true(assay_image_find_channel(made.image, "Indirect.G", &light) &&
                assay_image_find_channel(made.image, "Variance.Indirect.G", &variance) &&
                assay_image_find_channel(made.image, "IrradianceIndirect.G", &e) &&
                assay_image_find_channel(made.image, "Albedo.G", &albedo));
    for (int i = 0; i < 40 * 40; i++) {
        const double expected = e.data.f32[i] * albedo.data.f32[i] * ASSAY_INV_PI;
        assert_true(fabs(light.data.f32[i] - expected) <= 1e-6 * expected);
        assert_true(variance.data.f32[i] < 1e-12);
    }
    rendered_drop(&made);
    close_studio(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_as_irradiance_cache),
        cmocka_unit_test(from_far_away),
        cmocka_unit_test(same_as_radiance_cache),
        cmocka_unit_test(agrees_with_path),
        cmocka_unit_test(no_seams),
        cmocka_unit_test(step_5),
        cmocka_unit_test(another_accuracy),
        cmocka_unit_test(published_bounds),
        cmocka_unit_test(few_new_records),
        cmocka_unit_test(shrinking_records),
        cmocka_unit_test(centres),
    };
    return cmocka_run_group_tests_name("splat_image", tests, NULL, NULL);
}
