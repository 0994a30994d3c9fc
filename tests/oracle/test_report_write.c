/* test_report_write.c - a whole page where memory is refused, block by block: an error, and nothing
 * left behind; and what a folder's images are taken for. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/image.h"
#include "assay/report.h"
#include "oracle/report/report_folder.h"
#include "support/failing_context.h"
#include "support/random_places.h"
#include "support/temporary.h"

static void write_image(assay_context *context, const char *path, const char *method,
                        uint32_t samples)
{
    static const char *const names[] = {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"};
    assay_image             *image   = NULL;
    assay_channel            channel;
    assert_int_equal(assay_image_create(context, 6, 5, &image), ASSAY_OK);
    for (int c = 0; c < 6; c++) {
        assert_int_equal(assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        for (int i = 0; i < 30; i++) {
            channel.data.f32[i] = 0.1F * (float)(1 + (i + c + (int)samples) % 7);
        }
    }
    assert_int_equal(assay_image_add_channel(image, "SampleCount", ASSAY_CHANNEL_UINT, &channel),
                     ASSAY_OK);
    for (int i = 0; i < 30; i++) {
        channel.data.u32[i] = samples;
    }
    assert_int_equal(assay_image_set_attribute(image, "assay:method", method), ASSAY_OK);
    assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
    assay_image_destroy(image);
}

typedef struct {
    char a[512], b[512], page[512];
} paths;

static assay_status work(assay_context *context, void *user)
{
    const paths         *p            = user;
    const char          *candidates[] = {p->b};
    assay_report_options options      = assay_report_options_default();
    options.reference                 = p->a;
    options.candidates                = candidates;
    options.candidate_count           = 1;
    return assay_report_write(context, &options, p->page);
}

static void test_memory(void **state)
{
    temporary t = temporary_create();
    paths     p;
    snprintf(p.a, sizeof p.a, "%s", temporary_path(&t, "a.exr"));
    snprintf(p.b, sizeof p.b, "%s", temporary_path(&t, "b.exr"));
    snprintf(p.page, sizeof p.page, "%s", temporary_path(&t, "page.html"));
    write_image(*state, p.a, "path", 4);
    write_image(*state, p.b, "path", 1);
    assert_true(failing_each(work, &p) > 20);
    assert_int_equal(temporary_count(&t), 3);
    temporary_destroy(&t);
}

static void test_folder(void **state)
{
    static const struct {
        const char *name, *method;
        uint32_t    samples;
    } images[] = {
        {"z.exr", "path", 2}, {"m.exr", "path", 9}, {"b.exr", "splat", 99}, {"a.exr", "path", 3}};
    temporary t = temporary_create();
    for (size_t i = 0; i < 4; i++) {
        write_image(*state, temporary_path(&t, images[i].name), images[i].method,
                    images[i].samples);
    }
    temporary_write(temporary_path(&t, "notes.txt"), "x", 1);
    const char          *candidates[] = {t.folder};
    assay_report_options options      = assay_report_options_default();
    assay_report_list    list;
    options.candidates      = candidates;
    options.candidate_count = 1;
    assert_int_equal(assay_report_list_make(*state, &options, &list), ASSAY_OK);
    assert_string_equal(strrchr(list.reference, '/'), "/m.exr");
    assert_int_equal(list.count, 3);
    assert_string_equal(strrchr(list.candidates[0], '/'), "/a.exr");
    assert_string_equal(strrchr(list.candidates[1], '/'), "/b.exr");
    assert_string_equal(strrchr(list.candidates[2], '/'), "/z.exr");
    assay_report_list_release(*state, &list);
    temporary_destroy(&t);
}

/* Bundles among them: tests/cli/test_report.sh. */
static void test_labels(void **state)
{
    static const char *const PATHS[]  = {"x/ic.exr", "x/other.exr", "y/ic.exr", "ic.hdr", "y/z.ic"};
    static const char *const LABELS[] = {"ic.exr", "other", "ic.exr, 2", "ic.hdr", "z.ic"};
    char                    *names[5];
    for (size_t i = 0; i < 5; i++) {
        names[i] = (char *)PATHS[i];
    }
    const assay_report_list list = {.candidates = names, .count = 5};
    for (size_t i = 0; i < 5; i++) {
        char label[ASSAY_REPORT_LABEL_SIZE];
        assay_report_list_label(&list, i, label);
        assert_string_equal(label, LABELS[i]);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_memory, context_set_up, context_tear_down),
        cmocka_unit_test(test_labels),
        cmocka_unit_test_setup_teardown(test_folder, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
