/* test_frames.c - images one after another: what stays while nothing but the camera moves, and what
 * goes when something else does.
 *
 * The judge is the chain of single images that hand their caches on as files.  The mistakes that
 * the checks must see: records dropped though nothing moved, kept though something did, or counted
 * twice. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "support/gltf_maker.h"
#include "support/measure.h"

enum { SIZE = 10, FRAMES = 3, PATH_SIZE = 600 };

typedef enum { MOVES_CAMERA, MOVES_BOX, MOVES_LAMP, MOVES_NOTHING } mover;

/* A mesh of a box; inside: seen from within. */
static int add_box(gltf_maker *maker, float half, bool inside, int material)
{
    static const uint16_t faces[36] = {0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3, 0, 4, 5, 0, 5, 1,
                                       2, 3, 7, 2, 7, 6, 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5};
    float                 corners[24];
    uint16_t              indices[36];
    for (int i = 0; i < 8; i++) {
        corners[3 * i]     = i & 1 ? half : -half;
        corners[3 * i + 1] = i & 2 ? half : -half;
        corners[3 * i + 2] = i & 4 ? half : -half;
    }
    for (int i = 0; i < 36; i++) {
        indices[i] = faces[i % 3 && !inside ? i + 3 - 2 * (i % 3) : i];
    }
    const int positions = gltf_floats(maker, "VEC3", 8, corners);
    const int triangles = gltf_shorts(maker, 36, indices);
    return gltf_add(maker, "meshes",
                    "\"primitives\":[{\"attributes\":{\"POSITION\":%d},\"indices\":%d,"
                    "\"material\":%d}]",
                    positions, triangles, material);
}

/* A room of 2 m with a small metal box, a point light and a camera, one of which moves along x from
 * 0 s to 2 s. */
static assay_scene *room(assay_context *context, mover what)
{
    gltf_maker *maker   = gltf_maker_create();
    const char *names[] = {"camera", "box", "lamp"};
    int         nodes[3];
    gltf_root(maker, "\"extensionsUsed\":[\"KHR_lights_punctual\"]");
    gltf_root(maker, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\","
                     "\"intensity\":5}]}}");
    gltf_add(maker, "materials",
             "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.6,0.5,0.4,1],"
             "\"metallicFactor\":0},\"extensions\":{\"KHR_materials_specular\":{"
             "\"specularFactor\":0}}");
    gltf_add(maker, "materials",
             "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":1,"
             "\"roughnessFactor\":0.7}");
    gltf_add(maker, "cameras",
             "\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":0.01}");
    gltf_add(maker, "nodes", "\"mesh\":%d", add_box(maker, 1.0F, true, 0));
    nodes[0] = gltf_add(maker, "nodes", "\"name\":\"%s\",\"camera\":0,\"translation\":[0,0,0.9]",
                        names[0]);
    nodes[1] = gltf_add(maker, "nodes", "\"name\":\"%s\",\"mesh\":%d,\"translation\":[0,0,-0.5]",
                        names[1], add_box(maker, 0.3F, false, 1));
    nodes[2] = gltf_add(maker, "nodes",
                        "\"name\":\"%s\",\"translation\":[0,0.7,0],\"extensions\":{"
                        "\"KHR_lights_punctual\":{\"light\":0}}",
                        names[2]);
    if (what != MOVES_NOTHING) {
        const float from[3][3] = {{0, 0, 0.9F}, {0, 0, -0.5F}, {0, 0.7F, 0}};
        const float times[2]   = {0.0F, 2.0F};
        float       way[6];
        memcpy(way, from[what], sizeof from[what]);
        memcpy(way + 3, from[what], sizeof from[what]);
        way[3] += 0.4F;
        const int input  = gltf_floats(maker, "SCALAR", 2, times);
        const int output = gltf_floats(maker, "VEC3", 2, way);
        gltf_add(maker, "animations",
                 "\"samplers\":[{\"input\":%d,\"output\":%d}],\"channels\":[{\"sampler\":0,"
                 "\"target\":{\"node\":%d,\"path\":\"translation\"}}]",
                 input, output, nodes[what]);
    }
    return gltf_load(maker, context);
}

static const setting COMMON[] = {
    {"spp", "2"},  {"a", "0.5"},   {"theta_strata", "4"},    {"phi_strata", "9"}, {"bounces", "3"},
    {"grid", "4"}, {"nodes", "8"}, {"glossy_accuracy", "0"}, {"order", "4"},      {NULL, NULL}};

/* The common settings that the method has, then more. */
static assay_params *make_params(assay_context *context, const char *method, const setting *more)
{
    assay_params *params = NULL;
    assert_int_equal(assay_method_params(context, method, &params), ASSAY_OK);
    for (const setting *s = COMMON; s->name; s++) {
        bool known = false;
        for (const assay_param_desc *p = assay_params_table(params); p->name; p++) {
            known = known || strcmp(p->name, s->name) == 0;
        }
        if (known) {
            assert_int_equal(assay_params_set(params, s->name, s->value), ASSAY_OK);
        }
    }
    for (const setting *s = more; s && s->name; s++) {
        assert_int_equal(assay_params_set(params, s->name, s->value), ASSAY_OK);
    }
    return params;
}

/* What became of a frame. */
typedef struct {
    char               digest[65];
    assay_render_stats stats;
    bool               says_before; /* that frames came before it */
} outcome;

static assay_render_options options_of(uint64_t seed)
{
    assay_render_options options = assay_render_options_default();
    options.width = options.height = SIZE;
    options.seed                   = seed;
    return options;
}

static void look(assay_status status, assay_context *context, assay_image *image, outcome *o)
{
    if (status != ASSAY_OK) {
        fail_msg("%s", assay_context_error(context));
    }
    assay_image_digest(image, o->digest);
    o->says_before = assay_image_get_attribute(image, "assay:frames.before") != NULL;
    assay_image_destroy(image);
}

/* One sequence over all frames; seeds: of each. */
static void render_sequence(assay_context *context, assay_scene *scene, const char *method,
                            const setting *more, const uint64_t seeds[FRAMES],
                            outcome outcomes[FRAMES])
{
    assay_params   *params   = make_params(context, method, more);
    assay_sequence *sequence = NULL;
    assert_int_equal(assay_sequence_create(scene, method, params, &sequence), ASSAY_OK);
    for (int k = 0; k < FRAMES; k++) {
        const assay_render_options options = options_of(seeds[k]);
        assay_image               *image   = NULL;
        assert_int_equal(assay_scene_set_time(scene, k), ASSAY_OK);
        const assay_status status =
            assay_sequence_render(sequence, &options, k == FRAMES - 1, &image, &outcomes[k].stats);
        look(status, context, image, &outcomes[k]);
    }
    assay_sequence_destroy(sequence);
    assay_params_destroy(params);
}

/* An image by itself, its cache from and to files where these are not NULL. */
static void render_one(assay_context *context, assay_scene *scene, const char *method,
                       const setting *more, int k, const char *in, const char *out, outcome *o)
{
    const assay_render_options options = options_of(0);
    assay_params              *params  = make_params(context, method, more);
    assay_image               *image   = NULL;
    assert_int_equal(assay_scene_set_time(scene, k), ASSAY_OK);
    if (in) {
        assert_int_equal(assay_params_set(params, "cache_in", in), ASSAY_OK);
    }
    if (out) {
        assert_int_equal(assay_params_set(params, "cache_out", out), ASSAY_OK);
    }
    const assay_status status = assay_render(scene, method, params, &options, &image, &o->stats);
    look(status, context, image, o);
    assay_params_destroy(params);
}

static bool same(const outcome *a, const outcome *b) { return strcmp(a->digest, b->digest) == 0; }

static void check_same_counts(const assay_render_stats *a, const assay_render_stats *b)
{
    assert_true(a->records == b->records);
    assert_true(a->camera_rays == b->camera_rays);
    assert_true(a->scatter_rays == b->scatter_rays);
    assert_true(a->shadow_rays == b->shadow_rays);
}

static const uint64_t NO_SEEDS[FRAMES] = {0};

/* ---- a camera that moves ---- */

static void check_chain(const char *method, const setting *more)
{
    char folder[] = "/tmp/assay-frames-XXXXXX", path[FRAMES][PATH_SIZE], command[PATH_SIZE];
    assert_non_null(mkdtemp(folder));
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context, MOVES_CAMERA);
    outcome        frames[FRAMES], alone;
    render_sequence(context, scene, method, more, NO_SEEDS, frames);
    for (int k = 0; k < FRAMES; k++) {
        outcome chained;
        snprintf(path[k], PATH_SIZE, "%s/%d", folder, k);
        render_one(context, scene, method, more, k, k ? path[k - 1] : NULL, path[k], &chained);
        assert_true(same(&frames[k], &chained));
        check_same_counts(&frames[k].stats, &chained.stats);
        assert_true(frames[k].says_before == (k > 0));
        assert_true(frames[k].stats.records >= frames[k ? k - 1 : 0].stats.records);
    }
    /* Mutant: another image than that of a frame by itself, which makes all of its records. */
    render_one(context, scene, method, more, FRAMES - 1, NULL, NULL, &alone);
    assert_false(same(&frames[FRAMES - 1], &alone));
    assert_true(frames[FRAMES - 1].stats.scatter_rays < alone.stats.scatter_rays);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    assert_int_equal(system(command), 0);
}

static void camera_moves(void **state)
{
    (void)state;
    const setting once[]    = {{"passes", "1"}, {NULL, NULL}};
    const setting levels[]  = {{"secondary", "cache"}, {NULL, NULL}};
    const setting clamped[] = {{"neighbour_clamp", "on"}, {NULL, NULL}};
    const char   *methods[] = {"irradiance-cache", "radiance-cache"};
    for (int i = 0; i < 2; i++) {
        check_chain(methods[i], NULL);
        check_chain(methods[i], once);
        check_chain(methods[i], levels);
        check_chain(methods[i], clamped);
    }
}

/* A walk: splatted anew for every camera, and at most so many new records a frame. */
static void camera_walks(void **state)
{
    (void)state;
    const setting few[]     = {{"max_new_records", "12"}, {"uncovered", "black"}, {NULL, NULL}};
    const setting printed[] = {{"variant", "published"}, {NULL, NULL}};
    const setting clamped[] = {{"neighbour_clamp", "on"}, {NULL, NULL}};
    check_chain("splat", NULL);
    check_chain("splat", few);
    check_chain("splat", printed);
    check_chain("splat", clamped);
    assay_context *context = measure_context(2);
    assay_scene   *scene   = room(context, MOVES_CAMERA);
    outcome        frames[FRAMES];
    render_sequence(context, scene, "splat", few, NO_SEEDS, frames);
    for (int k = 0; k < FRAMES; k++) {
        /* Of irradiance and of radiance. */
        assert_true(frames[k].stats.records <= (uint64_t)(k + 1) * 2 * 12);
        assert_true(k == 0 || frames[k].stats.records > frames[k - 1].stats.records);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- something else that moves ---- */

/* Each frame is what it is by itself. */
static void check_alone(const char *method, mover what, const uint64_t seeds[FRAMES])
{
    assay_context *context = measure_context(1);
    assay_scene   *scene   = room(context, what);
    outcome        frames[FRAMES];
    render_sequence(context, scene, method, NULL, seeds, frames);
    for (int k = 0; k < FRAMES; k++) {
        outcome alone;
        render_one(context, scene, method, NULL, k, NULL, NULL, &alone);
        assert_true(same(&frames[k], &alone) == (seeds[k] == 0));
        assert_false(frames[k].says_before);
        if (seeds[k] == 0) {
            check_same_counts(&frames[k].stats, &alone.stats);
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void something_moves(void **state)
{
    (void)state;
    for (int i = 0; i < assay_method_count(); i++) {
        check_alone(assay_method_at(i).name, MOVES_BOX, NO_SEEDS);
        if (strcmp(assay_method_at(i).name, "hsh-environment") != 0) {
            check_alone(assay_method_at(i).name, MOVES_LAMP, NO_SEEDS);
        }
    }
}

/* Records of other random numbers are not this frame's. */
static void seeds_change(void **state)
{
    (void)state;
    const uint64_t seeds[FRAMES] = {0, 1, 0};
    check_alone("irradiance-cache", MOVES_NOTHING, seeds);
    check_alone("radiance-cache", MOVES_NOTHING, seeds);
    check_alone("splat", MOVES_NOTHING, seeds);
}

/* A method that keeps nothing gives the same frames, and says nothing of those before. */
static void path_keeps_nothing(void **state)
{
    (void)state;
    check_alone("path", MOVES_CAMERA, NO_SEEDS);
    check_alone("path", MOVES_NOTHING, NO_SEEDS);
}

/* ---- saved at the end ---- */

static void saved_after_the_last(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        char folder[] = "/tmp/assay-frames-XXXXXX", path[PATH_SIZE], command[PATH_SIZE];
        assert_non_null(mkdtemp(folder));
        snprintf(path, sizeof path, "%s/cache", folder);
        assay_context *context = measure_context(1);
        assay_scene   *scene   = room(context, MOVES_CAMERA);
        const char    *method  = i ? "radiance-cache" : "irradiance-cache";
        const setting  out[]   = {{"cache_out", path}, {NULL, NULL}};
        outcome        frames[FRAMES], again;
        render_sequence(context, scene, method, out, NO_SEEDS, frames);
        render_one(context, scene, method, NULL, FRAMES - 1, path, NULL, &again);
        assert_true(again.stats.records == frames[FRAMES - 1].stats.records);
        snprintf(command, sizeof command, "rm -r '%s'", folder);
        assert_int_equal(system(command), 0);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

/* ---- errors ---- */

static void bad_frames(void **state)
{
    (void)state;
    assay_context       *context  = measure_context(1);
    assay_scene         *scene    = room(context, MOVES_NOTHING);
    assay_params        *params   = make_params(context, "irradiance-cache", NULL);
    assay_sequence      *sequence = NULL;
    assay_image         *image    = NULL;
    assay_render_options options  = options_of(0);
    assert_int_equal(assay_sequence_create(scene, "no-such-method", params, &sequence),
                     ASSAY_ERR_ARGUMENT);
    assert_null(sequence);
    assert_int_equal(assay_sequence_create(scene, "irradiance-cache", params, &sequence), ASSAY_OK);
    options.camera = "no such camera";
    assert_int_equal(assay_sequence_render(sequence, &options, true, &image, NULL),
                     ASSAY_ERR_ARGUMENT);
    assert_null(image);
    assay_sequence_destroy(sequence);
    assay_sequence_destroy(NULL);
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_moves),       cmocka_unit_test(camera_walks),
        cmocka_unit_test(something_moves),    cmocka_unit_test(seeds_change),
        cmocka_unit_test(path_keeps_nothing), cmocka_unit_test(saved_after_the_last),
        cmocka_unit_test(bad_frames),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
