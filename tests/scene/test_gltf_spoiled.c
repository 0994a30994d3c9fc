/* test_gltf_spoiled.c - wrong bytes behind sound text, small files that ask for much, and bytes of
 * any kind. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/gltf_loader.h"
#include "scene/scene_build.h"
#include "support/broken.h"
#include "support/gltf_everything.h"
#include "support/gltf_maker.h"

static assay_status load(const char *text, char *message, size_t size)
{
    assay_context     *context = gltf_context();
    assay_scene       *scene   = NULL;
    const assay_status status  = gltf_load_text(context, text, &scene);
    snprintf(message, size, "%s", assay_context_error(context));
    if (status == ASSAY_OK) {
        assert_int_equal(assay_scene_set_time(scene, 0.5), ASSAY_OK);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return status;
}

/* ---- wrong bytes ---- */

typedef struct {
    size_t      at; /* of the value in the content */
    float       value;
    const char *message;
} float_case;

#define AT(member, index) (offsetof(gltf_content, member) + (index) * sizeof(float))

static const float_case float_cases[] = {
    {AT(positions, 4), NAN, "accessor 0 (POSITION): element 1 is not finite"},
    {AT(positions, 8), INFINITY, "accessor 0 (POSITION): element 2 is not finite"},
    {AT(normals, 0), -INFINITY, "accessor 1 (NORMAL): element 0 is not finite"},
    {AT(weights, 0), NAN, "(WEIGHTS): element 0 is not finite"},
    {AT(weights, 4), 0.0f, "the weights of vertex 1 are all 0"},
    {AT(weights, 5), -1.0f, "the weights of vertex 1 are negative"},
    {AT(bind, 3), NAN, "accessor 5 (inverseBindMatrices): element 0 is not finite"},
    {AT(times, 0), NAN, "accessor 6 (input): element 0 is not finite"},
    {AT(times, 1), 0.0f, "key 1 is not later than the one before"},
    {AT(times, 1), -1.0f, "key 1 is not later than the one before"},
    {AT(moves, 5), INFINITY, "accessor 7 (output): element 1 is not finite"},
    {AT(turns, 3), 0.0f, "accessor 8 (output): the rotation of key 0 has length 0"},
    {AT(morph, 0), NAN, "accessor 9 (output): element 0 is not finite"},
};

static void test_wrong_floats(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof float_cases / sizeof *float_cases; i++) {
        gltf_content spoiled = gltf_sound_content;
        char         message[1024];
        memcpy((char *)&spoiled + float_cases[i].at, &float_cases[i].value, sizeof(float));
        char              *text   = gltf_everything(&spoiled);
        const assay_status status = load(text, message, sizeof message);
        if (status != ASSAY_ERR_FORMAT || !strstr(message, float_cases[i].message)) {
            fail_msg("%s: status %d, %s", float_cases[i].message, status, message);
        }
        free(text);
    }
}

static void test_wrong_indices(void **state)
{
    static const uint16_t wrong[3] = {3, 65535, 32768};
    (void)state;
    for (int i = 0; i < 3; i++) {
        gltf_content spoiled = gltf_sound_content;
        char         message[1024];
        spoiled.indices[1] = wrong[i];
        char *text         = gltf_everything(&spoiled);
        assert_int_equal(load(text, message, sizeof message), ASSAY_ERR_FORMAT);
        assert_non_null(strstr(message, "accessor 2 (indices): index 1 is "));
        free(text);
    }
    gltf_content spoiled = gltf_sound_content;
    char         message[1024];
    spoiled.joints[4] = 1;
    char *text        = gltf_everything(&spoiled);
    assert_int_equal(load(text, message, sizeof message), ASSAY_ERR_FORMAT);
    assert_non_null(strstr(message, "joint 1 is used, but skins/0 has 1"));
    free(text);
}

/* The largest index of a type would start a new strip on some machines, and is never a vertex. */
static void test_restart_index(void **state)
{
    static const uint16_t indices[3] = {0, 65535, 1};
    gltf_maker           *maker      = gltf_maker_create();
    assay_context        *context    = gltf_context();
    assay_scene          *scene      = NULL;
    (void)state;
    gltf_add(maker, "accessors", "\"componentType\":5126,\"count\":70000,\"type\":\"VEC3\"");
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":0},\"indices\":%d",
                    gltf_shorts(maker, 3, indices));
    assert_int_equal(gltf_load_status(maker, context, NULL, &scene), ASSAY_ERR_FORMAT);
    assert_non_null(strstr(assay_context_error(context), "index 1 is 65535"));
    assay_context_destroy(context);
}

static void test_no_whole_triangles(void **state)
{
    static const struct {
        int mode, count;
    } cases[] = {{4, 1}, {4, 2}, {4, 4}, {5, 2}, {6, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        static const float points[12] = {0};
        gltf_maker        *maker      = gltf_maker_create();
        assay_context     *context    = gltf_context();
        assay_scene       *scene      = NULL;
        const int          p          = gltf_floats(maker, "VEC3", cases[i].count, points);
        gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":%d},\"mode\":%d", p, cases[i].mode);
        assert_int_equal(gltf_load_status(maker, context, NULL, &scene), ASSAY_ERR_FORMAT);
        assert_non_null(strstr(assay_context_error(context), "make no whole triangles"));
        assay_context_destroy(context);
    }
}

/* ---- small files that ask for much ---- */

/* Zeros by the million without a byte behind them, shown by many nodes. */
static void test_many_instances(void **state)
{
    gltf_maker    *maker   = gltf_maker_create();
    assay_context *context = gltf_context();
    assay_scene   *scene   = NULL;
    (void)state;
    gltf_add(maker, "accessors", "\"componentType\":5126,\"count\":3000000,\"type\":\"VEC3\"");
    gltf_shown_mesh(maker, "\"attributes\":{\"POSITION\":0}");
    for (int i = 0; i < 100; i++) {
        gltf_add(maker, "nodes", "\"mesh\":0");
    }
    assert_int_equal(gltf_load_status(maker, context, NULL, &scene), ASSAY_ERR_LIMIT);
    assert_non_null(strstr(assay_context_error(context), "more than 67108864 triangles"));
    assay_context_destroy(context);
}

/* What is decoded is counted, so that many primitives over one array cannot add up to more. */
static void test_decoded_bytes_are_limited(void **state)
{
    assay_context    *context = gltf_context();
    assay_gltf_loader loader  = {.context = context, .file = "x"};
    (void)state;
    assert_int_equal(assay_gltf_count_decoded(&loader, ASSAY_GLTF_MAX_DECODED_BYTES / 4 - 1, 4),
                     ASSAY_OK);
    assert_int_equal(assay_gltf_count_decoded(&loader, UINT64_MAX, 16), ASSAY_ERR_LIMIT);
    assert_int_equal(assay_gltf_count_decoded(&loader, 1, 5), ASSAY_ERR_LIMIT);
    assert_int_equal(assay_gltf_count_decoded(&loader, 1, 4), ASSAY_OK);
    assert_int_equal(assay_gltf_count_decoded(&loader, 1, 1), ASSAY_ERR_LIMIT);
    assert_non_null(strstr(assay_context_error(context), "8589934592 bytes when decoded"));
    assay_context_destroy(context);
}

/* ---- any bytes ---- */

static assay_status read_scene(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_scene       *scene = NULL;
    const assay_status status =
        assay_scene_load_memory(context, bytes, count, "x", NULL, NULL, &scene);
    if (status == ASSAY_OK) {
        assay_scene_set_time(scene, 0.5);
    }
    assay_scene_destroy(scene);
    return status;
}

static void test_truncated_and_flipped(void **state)
{
    char *text = gltf_everything(&gltf_sound_content);
    (void)state;
    broken_truncate(read_scene, (const uint8_t *)text, strlen(text));
    const int refused = broken_flip(read_scene, (const uint8_t *)text, strlen(text), 2000, 7);
    print_message("%d of 2000 files with flipped bits were refused\n", refused);
    assert_true(refused > 1000);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_wrong_floats),
        cmocka_unit_test(test_wrong_indices),
        cmocka_unit_test(test_restart_index),
        cmocka_unit_test(test_no_whole_triangles),
        cmocka_unit_test(test_many_instances),
        cmocka_unit_test(test_decoded_bytes_are_limited),
        cmocka_unit_test(test_truncated_and_flipped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
