/* test_scene_memory.c - refused memory and cancelling, at every single step of a load. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_build.h"
#include "support/failing_context.h"
#include "support/gltf_maker.h"
#include "support/temporary.h"

static const char png[] =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmM"
    "IQAAAABJRU5ErkJggg==";

/* A file with something of everything. */
static char *make_text(void)
{
    static const float    normals[9]  = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    static const float    weights[12] = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    static const uint8_t  joints[12]  = {0};
    static const float    bind[16]    = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const float    times[2] = {0, 1}, moves[6] = {0, 0, 0, 1, 2, 3};
    static const uint16_t indices[3] = {2, 1, 0};
    gltf_maker           *maker      = gltf_maker_create();
    gltf_shown_triangle(maker);
    const int n = gltf_floats(maker, "VEC3", 3, normals),
              w = gltf_floats(maker, "VEC4", 3, weights);
    const int v = gltf_view(maker, joints, sizeof joints, 0);
    const int j =
        gltf_add(maker, "accessors",
                 "\"bufferView\":%d,\"componentType\":5121,\"count\":3,\"type\":\"VEC4\"", v);
    const int i = gltf_shorts(maker, 3, indices), b = gltf_floats(maker, "MAT4", 1, bind);
    const int in  = gltf_floats(maker, "SCALAR", 2, times),
              out = gltf_floats(maker, "VEC3", 2, moves);
    gltf_add(maker, "images", "\"uri\":\"%s\"", png);
    gltf_add(maker, "textures", "\"source\":0");
    gltf_add(maker, "materials", "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}");
    gltf_add(maker, "meshes",
             "\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":%d,\"JOINTS_0\":%d,"
             "\"WEIGHTS_0\":%d},\"indices\":%d,\"material\":0,\"targets\":[{\"POSITION\":0}]}],"
             "\"weights\":[0.5]",
             n, j, w, i);
    gltf_add(maker, "skins", "\"joints\":[2],\"inverseBindMatrices\":%d", b);
    gltf_add(maker, "cameras", "\"type\":\"perspective\",\"perspective\":{\"yfov\":1,\"znear\":1}");
    gltf_add(maker, "nodes", "\"mesh\":1,\"skin\":0,\"weights\":[0.25]");
    gltf_add(maker, "nodes",
             "\"camera\":0,\"extensions\":{\"KHR_lights_punctual\":{\"light\":0},\"EXT_x\":{}}");
    gltf_root(maker, "\"extensionsUsed\":[\"EXT_y\"],\"extensions\":{\"KHR_lights_punctual\":{"
                     "\"lights\":[{\"type\":\"point\"}]}}");
    gltf_add(maker, "animations",
             "\"channels\":[{\"sampler\":0,\"target\":{\"node\":2,\"path\":\"translation\"}}],"
             "\"samplers\":[{\"input\":%d,\"output\":%d}]",
             in, out);
    char *text = gltf_text(maker);
    gltf_maker_destroy(maker);
    return text;
}

static assay_status load_and_use(assay_context *context, void *user)
{
    assay_scene *scene  = NULL;
    char        *report = NULL;
    assay_status status = gltf_load_text(context, user, &scene);
    if (status == ASSAY_OK) {
        status = assay_scene_set_time(scene, 0.5);
    }
    if (status == ASSAY_OK) {
        status = assay_scene_report_json(scene, &report);
    }
    assay_text_destroy(context, report);
    assay_scene_destroy(scene);
    return status;
}

/* Every n-th allocation of the library refused: ASSAY_ERR_MEMORY and nothing left. */
static void test_refused_memory(void **state)
{
    char     *text     = make_text();
    const int refusals = failing_each(load_and_use, text);
    (void)state;
    print_message("%d refusals\n", refusals);
    assert_true(refusals > 100);
    free(text);
}

static assay_status load_path(assay_context *context, void *user)
{
    assay_scene       *scene  = NULL;
    const assay_status status = assay_scene_load(context, user, NULL, &scene);
    assay_scene_destroy(scene);
    return status;
}

static void test_refused_memory_from_files(void **state)
{
    temporary         t      = temporary_create();
    static const char gltf[] = "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":4,"
                               "\"uri\":\"a%20b.bin\"}]}";
    char              path[512];
    (void)state;
    temporary_write(temporary_path(&t, "a b.bin"), "1234", 4);
    temporary_write(temporary_path(&t, "a.gltf"), gltf, sizeof gltf - 1);
    snprintf(path, sizeof path, "%s", temporary_path(&t, "a.gltf"));
    assert_true(failing_each(load_path, path) > 10);
    temporary_destroy(&t);
}

/* ---- cancelling ---- */

typedef struct {
    int    calls, cancel_at;
    double last;
} steps;

static bool on_progress(void *user, const char *phase, double fraction)
{
    steps *s = user;
    assert_string_equal(phase, "load");
    assert_true(fraction >= s->last && fraction <= 1.0);
    s->last = fraction;
    return ++s->calls != s->cancel_at;
}

static void test_cancel(void **state)
{
    char *text = make_text();
    (void)state;
    int calls = 0;
    for (int cancel_at = 1000; cancel_at >= 1;
         cancel_at     = (cancel_at > calls ? calls : cancel_at - 1)) {
        steps                       s       = {.cancel_at = cancel_at};
        const assay_context_options options = {.threads = 1, .progress = on_progress, .user = &s};
        assay_context              *context = NULL;
        assay_scene                *scene   = NULL;
        assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
        const assay_status status = gltf_load_text(context, text, &scene);
        if (cancel_at == 1000) {
            calls = s.calls;
            assert_int_equal(status, ASSAY_OK);
            assert_true(s.last == 1.0 && calls >= 5);
        } else {
            assert_int_equal(status, ASSAY_ERR_CANCELLED);
            assert_null(scene);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refused_memory),
        cmocka_unit_test(test_refused_memory_from_files),
        cmocka_unit_test(test_cancel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
