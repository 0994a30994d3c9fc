/* test_scene_report.c - counts, warnings and the JSON report. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

#include "scene/gltf_limits.h"
#include "support/gltf_maker.h"
#include "support/near.h"

static double number_of(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!cJSON_IsNumber(item)) {
        fail_msg("no number '%s'", name);
    }
    return item->valuedouble;
}

static const char *text_of(const cJSON *object, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, name);
    if (!cJSON_IsString(item)) {
        fail_msg("no text '%s'", name);
    }
    return item->valuestring;
}

static const cJSON *element_of(const cJSON *object, const char *name, int index)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(object, name);
    assert_true(cJSON_IsArray(array) && index < cJSON_GetArraySize(array));
    return cJSON_GetArrayItem(array, index);
}

static cJSON *report_of(const assay_scene *scene, assay_context *context)
{
    char *text = NULL;
    assert_int_equal(assay_scene_report_json(scene, &text), ASSAY_OK);
    cJSON *root = cJSON_Parse(text);
    assert_non_null(root);
    assay_text_destroy(context, text);
    return root;
}

static gltf_maker *make_rich_scene(void)
{
    static const float times[2] = {0.5f, 2.5f}, moves[6] = {0, 0, 0, 1, 0, 0};
    gltf_maker        *maker = gltf_maker_create();
    gltf_shown_triangle(maker);
    const int in  = gltf_floats(maker, "SCALAR", 2, times),
              out = gltf_floats(maker, "VEC3", 2, moves);
    gltf_root(maker, "\"extensionsUsed\":[\"KHR_lights_punctual\",\"EXT_nice\\u0007\"],"
                     "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":["
                     "{\"type\":\"point\",\"name\":\"lamp\",\"intensity\":3}]}}");
    gltf_add(maker, "materials", "\"emissiveFactor\":[1,1,1]");
    gltf_add(maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]");
    gltf_add(maker, "cameras",
             "\"type\":\"perspective\",\"name\":\"q\\\"\\u00e9\",\"perspective\":{"
             "\"yfov\":1.5707963267948966,\"znear\":0.5}");
    gltf_add(maker, "cameras",
             "\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,\"ymag\":3,\"znear\":0,"
             "\"zfar\":9}");
    gltf_add(maker, "nodes", "\"mesh\":1,\"translation\":[0,0,-4],\"camera\":0");
    gltf_add(maker, "nodes",
             "\"camera\":1,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0},"
             "\"EXT_other\":{}}");
    gltf_add(maker, "animations",
             "\"name\":\"walk\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,\"path\":"
             "\"translation\"}}],\"samplers\":[{\"input\":%d,\"output\":%d}]",
             in, out);
    return maker;
}

static void test_json(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = gltf_load(make_rich_scene(), context);
    cJSON         *root    = report_of(scene, context);
    (void)state;
    assert_string_equal(text_of(root, "path"), "test.gltf");
    assert_string_equal(text_of(root, "digest"), assay_scene_digest(scene));
    assert_true(number_of(root, "triangles") == 2 && number_of(root, "vertices") == 6);
    assert_true(number_of(root, "meshes") == 2 && number_of(root, "instances") == 2);
    assert_true(number_of(root, "materials") == 1 && number_of(root, "nodes") == 3);
    assert_true(number_of(root, "emissive_triangles") == 1);
    assert_true(number_of(root, "duration") == 2.5);
    const cJSON *camera = element_of(root, "cameras", 0), *ortho = element_of(root, "cameras", 1);
    assert_string_equal(text_of(camera, "name"), "q\"\xC3\xA9");
    assert_near(number_of(camera, "yfov_deg"), 90.0, 1e-12);
    assert_true(number_of(camera, "znear") == 0.5);
    assert_string_equal(text_of(ortho, "type"), "orthographic");
    assert_true(number_of(ortho, "xmag") == 2 && number_of(ortho, "ymag") == 3);
    const cJSON *light = element_of(root, "lights", 0);
    assert_string_equal(text_of(light, "kind"), "point");
    assert_string_equal(text_of(light, "name"), "lamp");
    assert_true(element_of(light, "intensity", 1)->valuedouble == 3.0);
    const cJSON *animation = element_of(root, "animations", 0);
    assert_string_equal(text_of(animation, "name"), "walk");
    assert_true(number_of(animation, "duration") == 2.5 && number_of(animation, "channels") == 1);
    const cJSON *bounds = cJSON_GetObjectItemCaseSensitive(root, "bounds");
    assert_true(element_of(bounds, "min", 2)->valuedouble == -4.0);
    assert_true(element_of(bounds, "max", 0)->valuedouble == 1.0);
    assert_string_equal(element_of(root, "extensions_used", 1)->valuestring, "EXT_nice?");
    assert_string_equal(element_of(root, "warnings", 0)->valuestring,
                        "the extension EXT_other is not supported and ignored");
    assert_string_equal(element_of(root, "warnings", 1)->valuestring,
                        "the extension EXT_nice? is not supported and ignored");
    assert_true(cJSON_IsNull(cJSON_GetObjectItemCaseSensitive(root, "environment")));
    cJSON_Delete(root);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_empty_scene(void **state)
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = NULL;
    (void)state;
    assert_int_equal(gltf_load_text(context, "{\"asset\":{\"version\":\"2.0\"}}", &scene),
                     ASSAY_OK);
    const assay_scene_info info = assay_scene_describe(scene);
    assert_int_equal(info.triangles, 0);
    assert_int_equal(info.materials, 0);
    assert_false(info.has_light);
    assert_true(info.bounds_min.x == 0.0 && info.bounds_max.z == 0.0);
    assert_int_equal(info.warnings, 4); /* no scene, no triangles, no light, no camera */
    assert_non_null(strstr(assay_scene_warning(scene, 2), "nothing in the scene emits"));
    assert_null(assay_scene_warning(scene, 4));
    cJSON_Delete(report_of(scene, context));
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* What counts as light: an emitter, a lamp, a background; an unlit surface does not. */
static void test_has_light(void **state)
{
    (void)state;
    for (int kind = 0; kind < 5; kind++) {
        assay_context      *context = gltf_context();
        gltf_maker         *maker   = gltf_maker_create();
        assay_scene_options options = assay_scene_options_default();
        assay_scene        *scene   = NULL;
        gltf_shown_triangle(maker);
        gltf_add(maker, "materials",
                 kind == 1   ? "\"emissiveFactor\":[0,1e-9,0]"
                 : kind == 4 ? "\"extensions\":{\"KHR_materials_unlit\":{}}"
                             : "\"name\":\"x\"");
        gltf_add(maker, "meshes",
                 "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]");
        gltf_add(maker, "nodes", "\"mesh\":1");
        if (kind == 2) {
            gltf_root(maker, "\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":"
                             "\"directional\"}]}}");
            gltf_add(maker, "nodes", "\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}");
        }
        options.background.b = kind == 3 ? 0.5 : 0.0;
        assert_int_equal(gltf_load_status(maker, context, &options, &scene), ASSAY_OK);
        assert_int_equal(assay_scene_describe(scene).has_light, kind >= 1 && kind <= 3);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

static void test_warnings_are_limited(void **state)
{
    assay_context *context = gltf_context();
    gltf_maker    *maker   = gltf_maker_create();
    (void)state;
    const int mesh = gltf_shown_triangle(maker);
    for (int i = 0; i < 150; i++) {
        gltf_add(maker, "meshes", "\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":0}]");
    }
    (void)mesh;
    assay_scene *scene = gltf_load(maker, context);
    assert_int_equal(assay_scene_describe(scene).warnings, ASSAY_GLTF_MAX_WARNINGS);
    assert_string_equal(assay_scene_warning(scene, ASSAY_GLTF_MAX_WARNINGS - 1),
                        "there are more warnings, which are not listed");
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void count_lines(void *user, assay_log_level level, const char *line)
{
    assert_int_equal(level, ASSAY_LOG_WARNING);
    assert_non_null(strstr(line, "test.gltf: "));
    ++*(int *)user;
}

static void test_warnings_are_logged(void **state)
{
    int                         lines   = 0;
    const assay_context_options options = {.threads = 1, .log = count_lines, .user = &lines};
    assay_context              *context = NULL;
    (void)state;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    assay_scene *scene = gltf_load(make_rich_scene(), context);
    assert_int_equal(lines, assay_scene_describe(scene).warnings);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_json),
        cmocka_unit_test(test_empty_scene),
        cmocka_unit_test(test_has_light),
        cmocka_unit_test(test_warnings_are_limited),
        cmocka_unit_test(test_warnings_are_logged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
