/* test_json.c - what the command writes as JSON: it parses, and holds what is documented. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <cjson/cJSON.h>

#include "assay/assay.h"
#include "support/run_json.h"
#include "support/temporary.h"

#define BOX "scenes/cornell-box/cornell-box.gltf"

static double number(const cJSON *json, const char *path)
{
    assert_true(cJSON_IsNumber(json_member(json, path)));
    return json_member(json, path)->valuedouble;
}

static const char *text(const cJSON *json, const char *path)
{
    assert_true(cJSON_IsString(json_member(json, path)));
    return json_member(json, path)->valuestring;
}

/* ---- render --stats ---- */

static void check_stats(const cJSON *stats)
{
    assert_string_equal(text(stats, "version"), assay_version());
    assert_string_equal(text(stats, "method"), "path");
    assert_int_equal(strlen(text(stats, "scene_digest")), 64);
    assert_true(number(stats, "rays/total") == number(stats, "rays/camera") +
                                                   number(stats, "rays/scatter") +
                                                   number(stats, "rays/shadow"));
    assert_true(number(stats, "rays/shadow") > 0.0);
    static const char *const positive[] = {"memory_bytes/peak", "memory_bytes/bvh",
                                           "memory_bytes/geometry", "threads"};
    static const char *const seconds[]  = {"seconds/load", "seconds/build", "seconds/render",
                                           "seconds/write", "memory_bytes/textures"};
    for (size_t i = 0; i < sizeof positive / sizeof positive[0]; i++) {
        assert_true(number(stats, positive[i]) > 0.0);
    }
    for (size_t i = 0; i < sizeof seconds / sizeof seconds[0]; i++) {
        assert_true(number(stats, seconds[i]) >= 0.0);
    }
}

static void stats_of_an_image(void **state)
{
    (void)state;
    cJSON *stats = run_json(0, "render " BOX " --size 12x10 --spp 3 --threads 2 --bounces 4 "
                               "-o /dev/null --stats -");
    check_stats(stats);
    assert_true(number(stats, "samples") == 12 * 10 * 3);
    assert_true(number(stats, "spp_min") == 3 && number(stats, "spp_max") == 3);
    assert_true(number(stats, "threads") == 2);
    assert_true(number(stats, "records") == 0 && number(stats, "lost_contributions") == 0);
    assert_true(number(stats, "relative_error") > 0.0);
    assert_true(cJSON_IsNull(json_member(stats, "target_reached")));
    assert_string_equal(text(stats, "params/spp"), "3");
    assert_string_equal(text(stats, "params/bounces"), "4");
    cJSON *scene = run_json(0, "scene " BOX " --json");
    assert_string_equal(text(stats, "scene_digest"), text(scene, "digest"));
    cJSON_Delete(scene);
    cJSON_Delete(stats);
}

/* Every parameter of the table is there, at its default where nothing was said. */
static void stats_hold_all_parameters(void **state)
{
    (void)state;
    cJSON *stats = run_json(0, "render " BOX " --size 4x4 --spp 1 -o /dev/null --stats -");
    for (const assay_param_desc *p = assay_method_at(0).params; p->name; p++) {
        char path[96];
        snprintf(path, sizeof path, "params/%s", p->name);
        assert_string_equal(text(stats, path),
                            strcmp(p->name, "spp") == 0 ? "1" : p->default_value);
    }
    cJSON_Delete(stats);
}

static void stats_count_the_same_for_all_threads(void **state)
{
    (void)state;
    static const char *const counts[] = {"rays/camera", "rays/scatter", "rays/shadow", "samples",
                                         "relative_error"};
    cJSON                   *one      = NULL;
    for (int threads = 1; threads <= 5; threads++) {
        cJSON *stats = run_json(0,
                                "render " BOX " --size 33x17 --spp 2 --target-error 0.3 "
                                "--threads %d -o /dev/null --stats -",
                                threads);
        for (size_t i = 0; one && i < sizeof counts / sizeof counts[0]; i++) {
            assert_true(number(stats, counts[i]) == number(one, counts[i]));
        }
        if (one) {
            cJSON_Delete(stats);
        } else {
            one = stats;
        }
    }
    cJSON_Delete(one);
}

static void stats_of_points(void **state)
{
    (void)state;
    temporary      folder  = temporary_create();
    assay_context *context = NULL;
    assay_array   *points  = NULL;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assert_int_equal(assay_array_create(context, 2, 6, &points), ASSAY_OK);
    const double rows[12] = {0, 0.5, 0, 0, 1, 0, 0.1, 0.5, 0, 1, 0, 0};
    memcpy(assay_array_data(points), rows, sizeof rows);
    assert_int_equal(assay_array_write_npy(points, temporary_path(&folder, "p.npy")), ASSAY_OK);
    cJSON *stats =
        run_json(0, "render " BOX " --spp 3 --points %s -o /dev/null --stats -", folder.path);
    check_stats(stats);
    assert_true(number(stats, "rays/camera") == 0.0);
    assert_true(cJSON_IsNull(json_member(stats, "relative_error")));
    cJSON_Delete(stats);
    assay_array_destroy(points);
    assay_context_destroy(context);
    temporary_destroy(&folder);
}

/* Stops once the error is below the target, or at max_spp. */
static void target_error(void **state)
{
    (void)state;
    const char *command =
        "render " BOX " --size 16x16 --spp 4 --target-error %s --max-spp %d -o /dev/null --stats -";
    cJSON *reached = run_json(0, command, "0.1", 1000000);
    assert_true(cJSON_IsTrue(json_member(reached, "target_reached")));
    assert_true(number(reached, "relative_error") < 0.1);
    assert_true(number(reached, "spp_min") > 4 && number(reached, "spp_max") < 1000000);
    /* Half of the samples cannot have done: a round at most doubles them. */
    assert_true(number(reached, "relative_error") > 0.1 / 2.0);
    cJSON *given_up = run_json(0, command, "0.001", 19);
    assert_true(cJSON_IsFalse(json_member(given_up, "target_reached")));
    assert_true(number(given_up, "relative_error") > 0.001);
    assert_true(number(given_up, "spp_min") == 19 && number(given_up, "spp_max") == 19);
    cJSON *off = run_json(0, command, "0", 19);
    assert_true(number(off, "spp_max") == 4);
    /* One sample knows no error: no number is better than 0. */
    cJSON *one = run_json(0, "render " BOX " --size 4x4 --spp 1 -o /dev/null --stats -");
    assert_true(cJSON_IsNull(json_member(one, "relative_error")));
    cJSON_Delete(reached);
    cJSON_Delete(given_up);
    cJSON_Delete(off);
    cJSON_Delete(one);
}

/* ---- scene, methods, diff ---- */

static void check_triple(const cJSON *json, const char *path)
{
    assert_int_equal(cJSON_GetArraySize(json_member(json, path)), 3);
    const cJSON *item;
    cJSON_ArrayForEach(item, json_member(json, path)) { assert_true(cJSON_IsNumber(item)); }
}

static void scene_report(void **state)
{
    (void)state;
    static const char *const counts[] = {
        "triangles", "vertices", "meshes", "instances", "materials",         "textures",
        "images",    "nodes",    "skins",  "duration",  "emissive_triangles"};
    static const char *const lists[] = {"cameras", "lights", "animations", "warnings",
                                        "extensions_used"};
    cJSON                   *scene   = run_json(0, "scene scenes/animated/animated.gltf --json");
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        assert_true(number(scene, counts[i]) >= 0.0);
    }
    for (size_t i = 0; i < sizeof lists / sizeof lists[0]; i++) {
        assert_true(cJSON_IsArray(json_member(scene, lists[i])));
    }
    check_triple(scene, "bounds/min");
    check_triple(scene, "bounds/max");
    assert_true(cJSON_IsBool(json_member(scene, "has_light")));
    assert_true(number(scene, "triangles") > 0.0 && number(scene, "duration") > 0.0);
    assert_true(cJSON_GetArraySize(json_member(scene, "animations")) > 0);
    assert_true(strlen(text(cJSON_GetArrayItem(json_member(scene, "cameras"), 0), "name")) > 0);
    cJSON_Delete(scene);

    cJSON *lit = run_json(0, "scene " BOX " --json --background 1,2,3");
    check_triple(lit, "background");
    assert_true(cJSON_IsNull(json_member(lit, "environment")));
    cJSON_Delete(lit);
}

/* What the command tells is what the library's table holds. */
static void methods_report(void **state)
{
    (void)state;
    static const char *const types[] = {"int", "real", "bool", "choice", "path"};
    cJSON                   *json    = run_json(0, "methods --json");
    assert_int_equal(cJSON_GetArraySize(json_member(json, "methods")), assay_method_count());
    for (int i = 0; i < assay_method_count(); i++) {
        const assay_method_info info   = assay_method_at(i);
        const cJSON            *method = cJSON_GetArrayItem(json_member(json, "methods"), i);
        assert_string_equal(text(method, "name"), info.name);
        assert_string_equal(text(method, "summary"), info.summary);
        const cJSON *param = json_member(method, "params")->child;
        for (const assay_param_desc *p = info.params; p->name; p++, param = param->next) {
            assert_non_null(param);
            assert_string_equal(text(param, "name"), p->name);
            assert_string_equal(text(param, "type"), types[p->type]);
            assert_string_equal(text(param, "unit"), p->unit);
            assert_string_equal(text(param, "default"), p->default_value);
            assert_string_equal(text(param, "summary"), p->summary);
            assert_string_equal(text(param, "source"), p->source);
            if (p->type == ASSAY_PARAM_CHOICE) {
                assert_string_equal(text(param, "choices"), p->choices);
            } else if (p->type == ASSAY_PARAM_INT || p->type == ASSAY_PARAM_REAL) {
                assert_true(number(param, "minimum") == p->minimum);
                assert_true(p->maximum == ASSAY_PARAM_INF
                                ? strcmp(text(param, "maximum"), "inf") == 0
                                : number(param, "maximum") == p->maximum);
            }
        }
        assert_null(param);
    }
    cJSON_Delete(json);
    cJSON *one = run_json(0, "methods path --json");
    assert_int_equal(cJSON_GetArraySize(json_member(one, "methods")), 1);
    cJSON_Delete(one);
}

static void check_picture(const cJSON *same, const cJSON *other)
{
    static const char *const numbers[] = {"pixels_per_degree",
                                          "mean_a",
                                          "mean_error",
                                          "rmse",
                                          "mse",
                                          "relative_mse",
                                          "relative_rmse",
                                          "flip_hdr/mean",
                                          "flip_hdr/maximum",
                                          "flip_hdr/first_quartile",
                                          "flip_hdr/minimum",
                                          "flip_hdr/third_quartile",
                                          "flip_hdr/max_x",
                                          "flip_hdr/weighted_median",
                                          "flip_hdr/max_y",
                                          "flip_hdr/start_exposure",
                                          "flip_hdr/exposures",
                                          "flip_hdr/stop_exposure",
                                          "flip_ldr/mean",
                                          "flip_ldr/exposures"};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        char path[64];
        snprintf(path, sizeof path, "picture/%s", numbers[i]);
        number(other, path);
    }
    assert_true(number(same, "picture/ssim") == 1.0 &&
                number(same, "picture/flip_hdr/mean") == 0.0);
    assert_true(number(other, "picture/ssim") < 1.0 &&
                number(other, "picture/flip_ldr/mean") > 0.0);
    assert_string_equal(text(other, "picture/tone_mapper"), "aces");
    assert_string_equal(text(other, "picture/layer"), "");
    assert_int_equal(cJSON_GetArraySize(json_member(other, "only_in_a")), 0);
    assert_int_equal(cJSON_GetArraySize(json_member(other, "only_in_b")), 0);
}

static void diff_report(void **state)
{
    (void)state;
    static const char *const numbers[] = {
        "pixels", "differing", "not_finite", "mean_a",        "mean_b", "max_abs",     "max_x",
        "max_y",  "rmse",      "mean_error", "relative_rmse", "mse",    "relative_mse"};
    temporary folder = temporary_create();
    for (int seed = 1; seed <= 2; seed++) {
        char name[16];
        snprintf(name, sizeof name, "%d.exr", seed);
        cJSON_Delete(run_json(0, "render " BOX " --size 16x16 --spp 4 --seed %d -o %s --stats -",
                              seed, temporary_path(&folder, name)));
    }
    cJSON *same = run_json(0, "diff %s/1.exr %s/1.exr --json", folder.folder, folder.folder);
    assert_true(cJSON_IsTrue(json_member(same, "identical")));
    cJSON *other = run_json(1, "diff %s/1.exr %s/2.exr --json", folder.folder, folder.folder);
    assert_true(cJSON_IsFalse(json_member(other, "identical")));
    check_picture(same, other);
    const cJSON *channel;
    int          judged = 0;
    cJSON_ArrayForEach(channel, json_member(other, "channels"))
    {
        for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
            number(channel, numbers[i]);
        }
        assert_true(number(channel, "pixels") == 256.0);
        if (strcmp(text(channel, "channel"), "R") == 0) {
            assert_true(number(channel, "z_rms") > 0.0);
            assert_true(number(channel, "differing") > 0.0);
            judged++;
        } else if (strcmp(text(channel, "channel"), "Z") == 0) {
            assert_true(cJSON_IsNull(json_member(channel, "z_rms")));
            assert_true(number(channel, "differing") == 0.0);
            judged++;
        }
    }
    assert_int_equal(judged, 2);
    cJSON_Delete(same);
    cJSON_Delete(other);
    temporary_destroy(&folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stats_of_an_image),
        cmocka_unit_test(stats_hold_all_parameters),
        cmocka_unit_test(stats_count_the_same_for_all_threads),
        cmocka_unit_test(stats_of_points),
        cmocka_unit_test(target_error),
        cmocka_unit_test(scene_report),
        cmocka_unit_test(methods_report),
        cmocka_unit_test(diff_report),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
