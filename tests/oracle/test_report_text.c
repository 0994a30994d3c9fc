/* test_report_text.c - what is written is read back the same by others' readers, and cannot leave
 * its place; records are drawn where the ray of their pixel goes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "io/bundle.h"
#include "oracle/report/report_records.h"
#include "support/random_places.h"
#include "support/temporary.h"
#include "trace/camera_ray.h"

static const char *const HOSTILE[] = {"plain",
                                      "",
                                      "</script><script>x()</script>",
                                      "<!--",
                                      "a & b",
                                      "\"\\/\b\f\n\r\t\x01\x1f\x7f",
                                      "\xc3\xbc \xe2\x80\xa8 \xf0\x9f\x8c\x8d"};
enum { HOSTILE_COUNT = sizeof HOSTILE / sizeof HOSTILE[0] };

/* The text that `write` makes; release with free. */
static char *written(assay_context *context, void (*write)(assay_report_text *text, void *user),
                     void          *user)
{
    temporary         t    = temporary_create();
    assay_report_text text = {.file = NULL};
    size_t            size;
    char              path[512];
    snprintf(path, sizeof path, "%s", temporary_path(&t, "text"));
    assert_int_equal(assay_atomic_file_open(context, path, &text.file), ASSAY_OK);
    write(&text, user);
    assert_int_equal(assay_atomic_file_commit(text.file), ASSAY_OK);
    char *bytes = (char *)temporary_read(path, &size);
    char *copy  = calloc(size + 1, 1);
    memcpy(copy, bytes, size);
    free(bytes);
    temporary_destroy(&t);
    return copy;
}

static void write_hostile(assay_report_text *text, void *user)
{
    (void)user;
    assay_report_open(text, NULL, '{');
    assay_report_open(text, "list", '[');
    for (int i = 0; i < HOSTILE_COUNT; i++) {
        assay_report_put_text(text, NULL, HOSTILE[i]);
    }
    assay_report_close(text, ']');
    for (int i = 0; i < HOSTILE_COUNT; i++) {
        assay_report_put_number(text, HOSTILE[i], i == 1 ? NAN : i == 2 ? HUGE_VAL : i / 8.0);
    }
    assay_report_put_json(text, "json", "{\"a\":[\"</script>\",1]}");
    assay_report_put_bool(text, "yes", true);
    assay_report_close(text, '}');
}

static void test_json(void **state)
{
    char  *text = written(*state, write_hostile, NULL);
    cJSON *root = cJSON_Parse(text);
    assert_non_null(root);
    assert_null(strpbrk(text, "<>&"));
    for (int i = 0; i < HOSTILE_COUNT; i++) {
        const cJSON *item = cJSON_GetArrayItem(cJSON_GetObjectItem(root, "list"), i);
        assert_string_equal(item->valuestring, HOSTILE[i]);
        const cJSON *number = cJSON_GetObjectItemCaseSensitive(root, HOSTILE[i]);
        assert_true(i == 1 || i == 2 ? cJSON_IsNull(number) : number->valuedouble == i / 8.0);
    }
    const cJSON *inner = cJSON_GetObjectItem(cJSON_GetObjectItem(root, "json"), "a");
    assert_string_equal(cJSON_GetArrayItem(inner, 0)->valuestring, "</script>");
    assert_true(cJSON_IsTrue(cJSON_GetObjectItem(root, "yes")));
    cJSON_Delete(root);
    free(text);
}

static void write_html(assay_report_text *text, void *user) { assay_report_put_html(text, user); }

static void test_html(void **state)
{
    char  hostile[] = "</title><b a=\"1\">&amp;";
    char *text      = written(*state, write_html, hostile);
    assert_string_equal(text, "&lt;/title&gt;&lt;b a=&quot;1&quot;&gt;&amp;amp;");
    free(text);
}

typedef struct {
    uint8_t bytes[5000];
    size_t  count;
} byte_string;

static void write_bytes(assay_report_text *text, void *user)
{
    const byte_string *bytes = user;
    assay_report_put_base64(text, bytes->bytes, bytes->count);
}

static int digit(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : c >= '0' && c <= '9' ? c - '0' + 52
           : c == '+'             ? 62
                                  : 63;
}

static void test_base64(void **state)
{
    static const size_t counts[] = {0, 1, 2, 3, 4, 5, 3071, 3072, 3073, 5000};
    byte_string         bytes;
    for (size_t i = 0; i < sizeof bytes.bytes; i++) {
        bytes.bytes[i] = (uint8_t)(i * 167 + i / 256);
    }
    for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
        bytes.count = counts[k];
        char *text  = written(*state, write_bytes, &bytes);
        assert_int_equal(strlen(text), (bytes.count + 2) / 3 * 4);
        for (size_t i = 0; i < bytes.count; i++) {
            const char *at    = text + i / 3 * 4 + i % 3;
            const int   shift = 2 * (int)(i % 3) + 2;
            const int   byte  = (digit(at[0]) << shift | digit(at[1]) >> (6 - shift)) & 255;
            assert_int_equal(byte, bytes.bytes[i]);
        }
        for (size_t i = strlen(text); bytes.count % 3 && i > strlen(text) - (3 - bytes.count % 3);
             i--) {
            assert_int_equal(text[i - 1], '=');
        }
        free(text);
    }
}

/* ---- records ---- */

enum { RECORDS = 200, WIDTH = 40, HEIGHT = 30 };

typedef struct {
    double x[RECORDS], y[RECORDS], radius[RECORDS]; /* pixels */
    bool   hidden[RECORDS];
} expected;

static assay_camera make_camera(bool orthographic)
{
    assay_camera camera  = {.name         = "c",
                            .position     = {1.0, 2.0, 3.0},
                            .right        = {0.0, 0.0, -1.0},
                            .up           = {0.0, 1.0, 0.0},
                            .forward      = {1.0, 0.0, 0.0},
                            .orthographic = orthographic,
                            .yfov         = 0.9,
                            .xmag         = 4.0,
                            .ymag         = 2.0};
    camera.tan_half_yfov = tan(0.45);
    return camera;
}

static void describe(assay_bundle *bundle, const assay_camera *camera)
{
    assert_int_equal(assay_bundle_describe(bundle, "assay:camera.position", "1 2 3"), ASSAY_OK);
    assert_int_equal(assay_bundle_describe(bundle, "assay:camera.right", "0 0 -1"), ASSAY_OK);
    assert_int_equal(assay_bundle_describe(bundle, "assay:camera.up", "0 1 0"), ASSAY_OK);
    assert_int_equal(assay_bundle_describe(bundle, "assay:camera.forward", "1 0 0"), ASSAY_OK);
    if (camera->orthographic) {
        assert_int_equal(assay_bundle_describe(bundle, "assay:camera.xmag", "4"), ASSAY_OK);
        assert_int_equal(assay_bundle_describe(bundle, "assay:camera.ymag", "2"), ASSAY_OK);
    } else {
        assert_int_equal(assay_bundle_describe(bundle, "assay:camera.yfov", "0.9"), ASSAY_OK);
    }
}

static void add_image(assay_context *context, assay_bundle *bundle, const char *array,
                      const char *const *channels, float value)
{
    assay_image *image = NULL;
    assert_int_equal(assay_image_create(context, WIDTH, HEIGHT, &image), ASSAY_OK);
    for (; *channels; channels++) {
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(image, *channels, ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            channel.data.f32[i] = value;
        }
    }
    assert_int_equal(assay_bundle_add_image(bundle, array, "", image), ASSAY_OK);
    assay_image_destroy(image);
}

/* Records on the rays of random places in the image, before and behind a wall at depth 5 m. */
static void add_records(assay_context *context, assay_bundle *bundle, const assay_camera *camera,
                        expected *out)
{
    assay_array *positions = NULL, *radii = NULL;
    assay_random random = assay_random_start(3, 0, 0, 0);
    assert_int_equal(assay_array_create(context, RECORDS, 3, &positions), ASSAY_OK);
    assert_int_equal(assay_array_create(context, RECORDS, 1, &radii), ASSAY_OK);
    for (int k = 0; k < RECORDS; k++) {
        assay_vec3 origin, direction, beside;
        out->x[k]      = random_in(&random, 1.0, WIDTH - 1.0);
        out->y[k]      = random_in(&random, 1.0, HEIGHT - 1.0);
        out->hidden[k] = k % 3 == 0;
        assay_camera_ray(camera, out->x[k], out->y[k], WIDTH, HEIGHT, &origin, &direction);
        const double     depth = out->hidden[k] ? 6.5 : random_in(&random, 4.0, 5.05);
        const double     along = depth / vec3_dot(direction, camera->forward);
        const assay_vec3 p     = vec3_mad(origin, along, direction);
        /* The radius, seen straight on: how far a step to the right goes in the image. */
        assay_camera_ray(camera, out->x[k] + 1.0, out->y[k], WIDTH, HEIGHT, &origin, &direction);
        beside = vec3_mad(origin, depth / vec3_dot(direction, camera->forward), direction);
        const double pixel         = vec3_length(vec3_sub(beside, p));
        out->radius[k]             = random_in(&random, 0.5, 4.0);
        assay_array_data(radii)[k] = out->radius[k] * pixel;
        double *row                = assay_array_data(positions) + 3 * (size_t)k;
        row[0]                     = p.x;
        row[1]                     = p.y;
        row[2]                     = p.z;
    }
    assert_int_equal(assay_bundle_add_table(bundle, "records/position", "m", positions), ASSAY_OK);
    assert_int_equal(assay_bundle_add_table(bundle, "records/radius", "m", radii), ASSAY_OK);
    assay_array_destroy(positions);
    assay_array_destroy(radii);
}

static void write_records(assay_report_text *text, void *user)
{
    assay_report_open(text, NULL, '{');
    assert_int_equal(assay_report_records_put(user, text), ASSAY_OK);
    assay_report_close(text, '}');
}

static void check_records(const char *text, const expected *want)
{
    cJSON       *root    = cJSON_Parse(text);
    const cJSON *records = cJSON_GetObjectItem(root, "records");
    const cJSON *circles = cJSON_GetObjectItem(records, "circles");
    assert_int_equal(cJSON_GetObjectItem(records, "count")->valueint, RECORDS);
    assert_int_equal(cJSON_GetArraySize(circles), 4 * RECORDS);
    const cJSON *item = circles->child;
    for (int k = 0; k < RECORDS; k++) {
        const double numbers[4] = {8.0 * want->x[k], 8.0 * want->y[k], 8.0 * want->radius[k],
                                   want->hidden[k]};
        for (int i = 0; i < 4; i++, item = item->next) {
            assert_true(fabs(item->valuedouble - numbers[i]) <= (i < 3 ? 0.5 + 1e-6 : 0.0));
        }
    }
    cJSON_Delete(root);
}

static void test_records(void **state)
{
    static const char *const colours[] = {"R", "G", "B", NULL}, *const depth[] = {"Z", NULL};
    for (int orthographic = 0; orthographic < 2; orthographic++) {
        const assay_camera  camera   = make_camera(orthographic);
        char                folder[] = "/tmp/assay-report-XXXXXX", path[64], command[128];
        assay_bundle       *bundle   = NULL;
        assay_report_source source;
        expected            want;
        assert_non_null(mkdtemp(folder));
        snprintf(path, sizeof path, "%s/bundle", folder);
        assert_int_equal(assay_bundle_create(*state, path, &bundle), ASSAY_OK);
        describe(bundle, &camera);
        add_image(*state, bundle, "radiance/total", colours, 1.0F);
        add_image(*state, bundle, "gbuffer/depth", depth, 5.0F);
        add_records(*state, bundle, &camera, &want);
        assert_int_equal(assay_bundle_finish(bundle), ASSAY_OK);
        assay_bundle_destroy(bundle);
        assert_int_equal(assay_report_source_read(*state, path, &source), ASSAY_OK);
        assert_string_equal(source.name, "bundle");
        char *text = written(*state, write_records, &source);
        check_records(text, &want);
        free(text);
        assay_report_source_release(&source);
        snprintf(command, sizeof command, "rm -r %s", folder);
        assert_int_equal(system(command), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_json, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_html, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_base64, context_set_up, context_tear_down),
        cmocka_unit_test_setup_teardown(test_records, context_set_up, context_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
