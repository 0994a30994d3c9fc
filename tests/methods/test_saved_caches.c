/* test_saved_caches.c - caches that are saved, and images that begin with them.
 *
 * The mistakes that the checks must see: records that are loaded but not used (or used without
 * their coefficients or gradients), saved in another order, or made again for another view. */
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

enum { SIZE = 12, PATH_SIZE = 600, MAX_SETTINGS = 24 };

/* A room with a lamp, a ball of brushed metal, and two cameras. */
static assay_scene *room(assay_context *context)
{
    scene_builder *b     = scene_builder_create();
    const int      walls = scene_builder_diffuse(b, 0.5, 0.0, false);
    const int      lamp  = scene_builder_diffuse(b, 0.0, 12.0, false);
    const int      metal = scene_builder_material(
             b, "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.6,0.3,1],\"metallicFactor\":1,"
                     "\"roughnessFactor\":0.6}");
    scene_builder_box(b, walls, vec3(-1, -1, -1), vec3(1, 1, 1), true);
    scene_builder_sphere(b, metal, vec3(0, -0.4, -0.2), 0.6, 2);
    scene_builder_quad(b, lamp, vec3(-0.3, 0.98, -0.3), vec3(0.3, 0.98, -0.3), vec3(0.3, 0.98, 0.3),
                       vec3(-0.3, 0.98, 0.3));
    scene_builder_camera(b, vec3(0.2, 0.1, 0.95), vec3(0, -0.4, -0.2), 1.0);
    scene_builder_camera(b, vec3(-0.6, 0.3, 0.9), vec3(0.1, -0.4, -0.2), 1.0);
    return scene_builder_load(b, context, NULL);
}

static const setting IRRADIANCE[] = {
    {"method", "irradiance-cache"}, {"spp", "1"},        {"a", "0.5"},
    {"theta_strata", "4"},          {"phi_strata", "9"}, {"bounces", "3"},
    {"estimator", "nee"},           {NULL, NULL}};
static const setting RADIANCE[] = {{"method", "radiance-cache"},
                                   {"spp", "1"},
                                   {"a", "0.5"},
                                   {"theta_strata", "4"},
                                   {"phi_strata", "9"},
                                   {"bounces", "3"},
                                   {"estimator", "nee"},
                                   {"order", "4"},
                                   {"grid", "4"},
                                   {"nodes", "8"},
                                   {"glossy_accuracy", "0"},
                                   {NULL, NULL}};

/* ---- a folder for bundles ---- */

static char *make_folder(void)
{
    static const char *const pattern = "/tmp/assay-caches-XXXXXX";
    char                    *folder  = strdup(pattern);
    assert_non_null(folder);
    assert_non_null(mkdtemp(folder));
    return folder;
}

static void remove_folder(char *folder)
{
    char command[PATH_SIZE];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    assert_int_equal(system(command), 0);
    free(folder);
}

/* ---- renders ---- */

typedef struct {
    assay_status       status;
    assay_image       *image;
    assay_render_stats stats;
    char               said[512];
} outcome;

/* The settings, then more of them, which win, and a path where it is not NULL. */
static outcome render(assay_scene *scene, assay_context *context, const setting *settings,
                      const setting *more, const char *name, const char *path, const char *camera)
{
    assay_render_options options = assay_render_options_default();
    assay_params        *params  = NULL;
    outcome              o       = {0};
    options.width = options.height = SIZE;
    options.camera                 = camera;
    assert_int_equal(assay_method_params(context, settings->value, &params), ASSAY_OK);
    for (const setting *s = settings + 1; s->name; s++) {
        assert_int_equal(assay_params_set(params, s->name, s->value), ASSAY_OK);
    }
    for (const setting *s = more; s && s->name; s++) {
        assert_int_equal(assay_params_set(params, s->name, s->value), ASSAY_OK);
    }
    if (path) {
        assert_int_equal(assay_params_set(params, name, path), ASSAY_OK);
    }
    o.status = assay_render(scene, settings->value, params, &options, &o.image, &o.stats);
    if (o.status != ASSAY_OK) {
        snprintf(o.said, sizeof o.said, "%s", assay_context_error(context));
    }
    assay_params_destroy(params);
    return o;
}

static bool same(const outcome *a, const outcome *b)
{
    char x[65], y[65];
    assert_int_equal(a->status, ASSAY_OK);
    assert_int_equal(b->status, ASSAY_OK);
    assay_image_digest(a->image, x);
    assay_image_digest(b->image, y);
    return strcmp(x, y) == 0;
}

static void drop(outcome *o) { assay_image_destroy(o->image); }

/* ---- what comes in gives what went out ---- */

/* With one sample a pixel: of more, the later ones may find records missing, and what is loaded has
 * them from the first. */

static void check_round_trip(const setting *settings, const setting *more)
{
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context);
    char          *folder  = make_folder();
    char           path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/cache", folder);
    outcome made   = render(scene, context, settings, more, "cache_out", path, NULL);
    outcome loaded = render(scene, context, settings, more, "cache_in", path, NULL);
    outcome plain  = render(scene, context, settings, more, NULL, NULL, NULL);
    print_message("#| %s %s=%s: %llu records\n", settings->value, more ? more->name : "",
                  more ? more->value : "", (unsigned long long)made.stats.records);
    assert_true(same(&made, &loaded));
    assert_true(same(&made, &plain));
    assert_true(made.stats.records == loaded.stats.records);
    /* No hemisphere was gathered; with light sampling nothing else scatters but paths. */
    assert_true(loaded.stats.scatter_rays < made.stats.scatter_rays || made.stats.records == 0);
    if (strcmp(settings->value, "radiance-cache") == 0) {
        assert_true(loaded.stats.scatter_rays == 0);
    }
    drop(&made);
    drop(&loaded);
    drop(&plain);
    remove_folder(folder);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void round_trips(void **state)
{
    (void)state;
    const setting levels[]  = {{"secondary", "cache"}, {NULL, NULL}};
    const setting clamped[] = {{"neighbour_clamp", "on"}, {NULL, NULL}};
    const setting nothing[] = {{"bounces", "1"}, {NULL, NULL}};
    const setting none[]    = {{"coefficient_gradient", "none"}, {NULL, NULL}};
    const setting points[]  = {{"coefficient_gradient", "points"}, {NULL, NULL}};
    check_round_trip(IRRADIANCE, NULL);
    check_round_trip(IRRADIANCE, levels);
    check_round_trip(IRRADIANCE, clamped);
    check_round_trip(IRRADIANCE, nothing);
    check_round_trip(RADIANCE, NULL);
    check_round_trip(RADIANCE, levels);
    check_round_trip(RADIANCE, clamped);
    check_round_trip(RADIANCE, nothing);
    check_round_trip(RADIANCE, none);
    check_round_trip(RADIANCE, points);
}

/* ---- another view ---- */

static assay_array *read_table(assay_context *context, const char *bundle, const char *name)
{
    char         path[PATH_SIZE + 64];
    assay_array *table = NULL;
    snprintf(path, sizeof path, "%s/%s.npy", bundle, name);
    if (assay_array_read_npy(context, path, &table) != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    return table;
}

/* The longer table begins with the shorter one. */
static void check_goes_on(assay_context *context, const char *first, const char *second,
                          const char *name)
{
    assay_array *a = read_table(context, first, name), *b = read_table(context, second, name);
    assert_true(assay_array_columns(a) == assay_array_columns(b));
    assert_true(assay_array_rows(a) > 0 && assay_array_rows(b) > assay_array_rows(a));
    assert_memory_equal(assay_array_values(a), assay_array_values(b),
                        assay_array_rows(a) * assay_array_columns(a) * sizeof(double));
    assay_array_destroy(a);
    assay_array_destroy(b);
}

static void other_views(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context);
    char          *folder  = make_folder();
    char           first[PATH_SIZE], second[PATH_SIZE];
    snprintf(first, sizeof first, "%s/first", folder);
    snprintf(second, sizeof second, "%s/second", folder);
    const setting both[]  = {{"cache_in", first}, {"cache_out", second}, {NULL, NULL}};
    outcome       one     = render(scene, context, RADIANCE, NULL, "cache_out", first, "0");
    outcome       two     = render(scene, context, RADIANCE, both, NULL, NULL, "1");
    outcome       another = render(scene, context, RADIANCE, NULL, NULL, NULL, "1");
    assert_int_equal(one.status, ASSAY_OK);
    assert_true(!same(&two, &another));
    assert_true(two.stats.scatter_rays < another.stats.scatter_rays);
    check_goes_on(context, first, second, "records/irradiance");
    check_goes_on(context, first, second, "radiance_records/position");
    check_goes_on(context, first, second, "radiance_records/coefficients");
    check_goes_on(context, first, second, "radiance_records/coefficient_gradient");
    drop(&one);
    drop(&two);
    drop(&another);
    remove_folder(folder);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- what does not fit ---- */

static void check_refused(assay_scene *scene, assay_context *context, const setting *settings,
                          const char *path, const char *name, const char *value, const char *word)
{
    const setting more[] = {{name, value}, {NULL, NULL}};
    outcome       o      = render(scene, context, settings, more, "cache_in", path, NULL);
    assert_int_equal(o.status, ASSAY_ERR_ARGUMENT);
    if (!strstr(o.said, word)) {
        fail_msg("'%s' has no '%s'", o.said, word);
    }
}

static void refused(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context);
    char          *folder  = make_folder();
    char           path[PATH_SIZE], plain[PATH_SIZE];
    snprintf(path, sizeof path, "%s/cache", folder);
    snprintf(plain, sizeof plain, "%s/plain", folder);
    outcome made  = render(scene, context, RADIANCE, NULL, "cache_out", path, NULL);
    outcome other = render(scene, context, IRRADIANCE, NULL, "cache_out", plain, NULL);
    assert_int_equal(made.status, ASSAY_OK);
    assert_int_equal(other.status, ASSAY_OK);
    check_refused(scene, context, RADIANCE, path, "order", "5", "order");
    check_refused(scene, context, RADIANCE, path, "coefficient_gradient", "none",
                  "coefficient_gradient");
    check_refused(scene, context, RADIANCE, path, "bounces", "2", "bounces");
    check_refused(scene, context, RADIANCE, path, "secondary", "cache", "secondary");
    check_refused(scene, context, RADIANCE, plain, "order", "4", "content");
    check_refused(scene, context, IRRADIANCE, path, "spp", "1", "content");
    /* With nothing within reach the radiance records are left alone. */
    const setting sharp[] = {{"glossy_accuracy", "1"}, {NULL, NULL}};
    outcome       less    = render(scene, context, RADIANCE, sharp, "cache_in", path, NULL);
    assert_int_equal(less.status, ASSAY_OK);
    assert_true(less.stats.records < made.stats.records);
    drop(&less);
    drop(&made);
    drop(&other);
    remove_folder(folder);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- pictures ---- */

static void pictures(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context);
    char          *folder  = make_folder();
    char           path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/reference.exr", folder);
    const setting centre[] = {{"spp", "1"}, {NULL, NULL}};
    outcome       plain    = render(scene, context, RADIANCE, centre, NULL, NULL, NULL);
    assert_int_equal(assay_image_write_exr(plain.image, path), ASSAY_OK);
    const setting kinds[] = {{"debug", "records"}, {"debug", "weights"}, {"debug", "error"}};
    double        seen[3];
    for (int i = 0; i < 3; i++) {
        const setting more[] = {{"spp", "1"}, kinds[i], {"reference", path}, {NULL, NULL}};
        outcome       o      = render(scene, context, RADIANCE, more, NULL, NULL, NULL);
        assert_int_equal(o.status, ASSAY_OK);
        assert_true(measure_difference(o.image, plain.image, "R") > 0.0);
        /* Only the colour is another. */
        assert_true(measure_difference(o.image, plain.image, "Indirect.R") == 0.0);
        assert_true(o.stats.records == plain.stats.records);
        seen[i] = measure_mean(o.image, "R").value;
        drop(&o);
    }
    assert_true(seen[0] > 0.0 && seen[1] > 0.0);
    /* Of one sample against the image of that sample nothing is off where the sphere is. */
    assay_channel red, id;
    const setting more[] = {{"spp", "1"}, {"debug", "error"}, {"reference", path}, {NULL, NULL}};
    outcome       o      = render(scene, context, RADIANCE, more, NULL, NULL, NULL);
    assert_true(assay_image_find_channel(o.image, "R", &red) &&
                assay_image_find_channel(o.image, "MaterialId", &id));
    int glossy = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        glossy += id.data.u32[i] == 2 && red.data.f32[i] < 1e-3F;
    }
    assert_true(glossy > 10);
    drop(&o);
    drop(&plain);
    remove_folder(folder);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- refused memory ---- */

/* While a cache is read, with the n-th block refused: nothing is left behind. */
static void refused_memory(void **state)
{
    (void)state;
    failing_memory memory  = {0};
    assay_context *context = failing_context(&memory);
    assay_scene   *scene   = room(context);
    char          *folder  = make_folder();
    char           path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/cache", folder);
    outcome made = render(scene, context, RADIANCE, NULL, "cache_out", path, NULL);
    assert_int_equal(made.status, ASSAY_OK);
    drop(&made);
    assay_params *params = NULL;
    assert_int_equal(assay_method_params(context, "radiance-cache", &params), ASSAY_OK);
    for (const setting *s = RADIANCE + 1; s->name; s++) {
        assert_int_equal(assay_params_set(params, s->name, s->value), ASSAY_OK);
    }
    assert_int_equal(assay_params_set(params, "cache_in", path), ASSAY_OK);
    const assay_render_options options = {.width = 2, .height = 2};
    const uint64_t             live    = memory.live;
    uint64_t                   n       = 1;
    for (assay_status status = ASSAY_ERR_MEMORY; status != ASSAY_OK; n += n < 20 ? 1 : n / 8) {
        assay_image *image = NULL;
        assert_true(n < 1000);
        memory.asked   = 0;
        memory.fail_at = n;
        status         = assay_render(scene, "radiance-cache", params, &options, &image, NULL);
        memory.fail_at = 0;
        assert_true(status == ASSAY_OK || status == ASSAY_ERR_MEMORY);
        assay_image_destroy(image);
        assert_true(memory.live == live);
    }
    assert_true(n > 50);
    assay_params_destroy(params);
    remove_folder(folder);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trips), cmocka_unit_test(other_views),    cmocka_unit_test(refused),
        cmocka_unit_test(pictures),    cmocka_unit_test(refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
