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
#include "support/gltf_everything.h"
#include "support/gltf_maker.h"
#include "support/temporary.h"

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
    char     *text     = gltf_everything(&gltf_sound_content);
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
    char *text = gltf_everything(&gltf_sound_content);
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
