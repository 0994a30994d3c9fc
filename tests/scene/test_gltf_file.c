/* test_gltf_file.c - containers, URIs and the files behind them; the digest. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "assay/image.h"
#include "scene/scene_build.h"
#include "support/gltf_maker.h"
#include "support/temporary.h"

static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/* A triangle whose 36 bytes come from this URI. */
static void write_gltf(const char *path, const char *uri)
{
    char      text[8192];
    const int length = snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
        "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"bufferViews\":[{"
        "\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}]}",
        uri);
    assert_true(length > 0 && (size_t)length < sizeof text);
    temporary_write(path, text, (size_t)length);
}

static assay_status load_path(const char *path, char *message, size_t size)
{
    assay_context     *context = gltf_context();
    assay_scene       *scene   = NULL;
    const assay_status status  = assay_scene_load(context, path, NULL, &scene);
    if (status == ASSAY_OK) {
        assert_int_equal(scene->triangle_count, 1);
        assert_memory_equal(scene->positions, corners, sizeof corners);
    } else {
        assert_null(scene);
    }
    snprintf(message, size, "%s", assay_context_error(context));
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return status;
}

/* ---- external files ---- */

static void test_names_of_files(void **state)
{
    static const struct {
        const char *file, *uri;
    } cases[] = {
        {"plain.bin", "plain.bin"},
        {"with space.bin", "with%20space.bin"},
        {"with space.bin", "with space.bin"},
        {"a+b.bin", "a+b.bin"},
        {"a+b.bin", "a%2Bb.bin"},
        {"gr\xC3\xBC\xC3\x9F.bin", "gr\xC3\xBC\xC3\x9F.bin"},
        {"gr\xC3\xBC\xC3\x9F.bin", "gr%C3%BC%c3%9f.bin"},
        {"gr\xC3\xBC\xC3\x9F.bin", "gr\\u00fc\\u00df.bin"},
        {"100%.bin", "100%.bin"},
        {"100%.bin", "100%25.bin"},
        {"#1?.bin", "%231%3F.bin"},
        {"plain.bin", "./plain.bin"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        temporary t = temporary_create();
        char      message[1024];
        temporary_write(temporary_path(&t, cases[i].file), corners, sizeof corners);
        write_gltf(temporary_path(&t, "sc\xC3\xA8ne a.gltf"), cases[i].uri);
        if (load_path(temporary_path(&t, "sc\xC3\xA8ne a.gltf"), message, sizeof message) !=
            ASSAY_OK) {
            fail_msg("%s: %s", cases[i].uri, message);
        }
        temporary_destroy(&t);
    }
}

/* A buffer may be shorter than its file. */
static void test_longer_file(void **state)
{
    temporary t         = temporary_create();
    uint8_t   bytes[99] = {0};
    char      message[1024];
    (void)state;
    memcpy(bytes, corners, sizeof corners);
    temporary_write(temporary_path(&t, "a.bin"), bytes, sizeof bytes);
    write_gltf(temporary_path(&t, "a.gltf"), "a.bin");
    assert_int_equal(load_path(temporary_path(&t, "a.gltf"), message, sizeof message), ASSAY_OK);
    temporary_destroy(&t);
}

static void test_relative_path(void **state)
{
    temporary t = temporary_create();
    char      before[1024], message[1024];
    (void)state;
    temporary_write(temporary_path(&t, "a.bin"), corners, sizeof corners);
    write_gltf(temporary_path(&t, "a.gltf"), "a.bin");
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(t.folder), 0);
    const assay_status status = load_path("a.gltf", message, sizeof message);
    assert_int_equal(chdir(before), 0);
    assert_int_equal(status, ASSAY_OK);
    temporary_destroy(&t);
}

/* Whatever is no readable regular file is refused at once, and by name. */
static void test_what_is_no_file(void **state)
{
    static const struct {
        const char  *uri;
        assay_status status;
        const char  *message; /* after the path of the .gltf */
    } cases[] = {
        {"missing.bin", ASSAY_ERR_NOT_FOUND, "missing.bin: cannot be opened: No such file"},
        {".", ASSAY_ERR_NOT_FOUND, "is not a regular file"},
        {"fifo", ASSAY_ERR_NOT_FOUND, "fifo: is not a regular file"},
        {"empty.bin", ASSAY_ERR_FORMAT, "empty.bin: is empty"},
        {"short.bin", ASSAY_ERR_FORMAT, "byteLength is 36, but there are only 35 bytes"},
        {"a%00b", ASSAY_ERR_FORMAT, "%00"},
        {"/dev/zero", ASSAY_ERR_UNSUPPORTED, "neither a relative path nor a data URI"},
        {"http://localhost/a.bin", ASSAY_ERR_UNSUPPORTED, "neither a relative path"},
        {"file:///a.bin", ASSAY_ERR_UNSUPPORTED, "neither a relative path"},
        {"", ASSAY_ERR_UNSUPPORTED, "neither a relative path"},
        {"a/b/c.bin", ASSAY_ERR_NOT_FOUND, "cannot be opened"},
        {"a\\nb.bin", ASSAY_ERR_NOT_FOUND, "a?b.bin: cannot be opened"},
    };
    temporary t = temporary_create();
    (void)state;
    temporary_write(temporary_path(&t, "empty.bin"), "", 0);
    temporary_write(temporary_path(&t, "short.bin"), corners, 35);
    assert_int_equal(mkfifo(temporary_path(&t, "fifo"), 0600), 0);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char        message[1024];
        const char *path = temporary_path(&t, "a.gltf");
        write_gltf(path, cases[i].uri);
        const assay_status status = load_path(path, message, sizeof message);
        if (status != cases[i].status || strncmp(message, path, strlen(path)) != 0 ||
            !strstr(message, "buffers/0: ") || !strstr(message, cases[i].message) ||
            strpbrk(message, "\n\r")) {
            fail_msg("%s: status %d, %s", cases[i].uri, status, message);
        }
    }
    temporary_destroy(&t);
}

/* Sizes are looked at before anything is read: the file is sparse. */
static void test_too_large(void **state)
{
    temporary t = temporary_create();
    char      uri[6000], message[1024];
    (void)state;
    temporary_write(temporary_path(&t, "big.bin"), "x", 1);
    assert_int_equal(truncate(t.path, ((off_t)1 << 31) + 1), 0);
    write_gltf(temporary_path(&t, "a.gltf"), "big.bin");
    assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_LIMIT);
    assert_non_null(strstr(message, "has 2147483649 bytes, at most 2147483648 are read"));
    memset(uri, 'a', sizeof uri);
    uri[sizeof uri - 1] = 0;
    write_gltf(temporary_path(&t, "a.gltf"), uri);
    assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_LIMIT);
    assert_non_null(strstr(message, "buffers/0: the path is longer"));
    temporary_destroy(&t);
}

static void test_main_file(void **state)
{
    temporary t = temporary_create();
    char      message[1024];
    (void)state;
    assert_int_equal(load_path(t.folder, message, sizeof message), ASSAY_ERR_NOT_FOUND);
    assert_non_null(strstr(message, "is not a regular file"));
    assert_int_equal(load_path(temporary_path(&t, "no.glb"), message, sizeof message),
                     ASSAY_ERR_NOT_FOUND);
    assert_int_equal(mkfifo(temporary_path(&t, "fifo.gltf"), 0600), 0);
    assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_NOT_FOUND);
    temporary_write(temporary_path(&t, "empty.gltf"), "", 0);
    assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_FORMAT);
    temporary_write(temporary_path(&t, "text.gltf"), "hello", 5);
    assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_FORMAT);
    assert_non_null(strstr(message, "is not a glTF file"));
    if (geteuid() != 0) {
        write_gltf(temporary_path(&t, "locked.gltf"), "a.bin");
        assert_int_equal(chmod(t.path, 0), 0);
        assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_NOT_FOUND);
    }
    temporary_destroy(&t);
}

/* ---- data URIs ---- */

static void test_data_uris(void **state)
{
    /* the 36 bytes of the triangle */
    static const char        base64[] = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    static const char *const heads[]  = {
         "data:application/octet-stream;base64,", "data:application/gltf-buffer;base64,",
         "data:;base64,", "data:model/odd+type;charset=x;base64,", "data:text/plain;base64,"};
    char uri[256], message[1024];
    (void)state;
    temporary t = temporary_create();
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++) {
        snprintf(uri, sizeof uri, "%s%s", heads[i], base64);
        write_gltf(temporary_path(&t, "a.gltf"), uri);
        assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_OK);
    }
    /* percent-encoded bytes, without base64 */
    char *p = uri + snprintf(uri, sizeof uri, "data:,");
    for (size_t i = 0; i < sizeof corners; i++) {
        p += sprintf(p, "%%%02X", ((const uint8_t *)corners)[i]);
    }
    write_gltf(temporary_path(&t, "a.gltf"), uri);
    assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_OK);
    static const char *const wrong[] = {"data:application/octet-stream;base64", "data:;base64,!!!!",
                                        "data:;base64,", "data:;base64,AAAA", "data:,"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_gltf(temporary_path(&t, "a.gltf"), wrong[i]);
        assert_int_equal(load_path(t.path, message, sizeof message), ASSAY_ERR_FORMAT);
        assert_non_null(strstr(message, "buffers/0"));
    }
    temporary_destroy(&t);
}

/* ---- GLB ---- */

static uint8_t *make_glb(size_t *count)
{
    gltf_maker *maker = gltf_maker_create();
    gltf_shown_triangle(maker);
    uint8_t *bytes = gltf_glb(maker, count);
    gltf_maker_destroy(maker);
    return bytes;
}

static assay_status load_bytes(const uint8_t *bytes, size_t count, char *message, size_t size)
{
    assay_context     *context = gltf_context();
    assay_scene       *scene   = NULL;
    const assay_status status =
        assay_scene_load_memory(context, bytes, count, "test.glb", NULL, NULL, &scene);
    snprintf(message, size, "%s", status == ASSAY_OK ? "" : assay_context_error(context));
    if (status == ASSAY_OK) {
        assert_int_equal(scene->triangle_count, 1);
        if (scene->warning_count) {
            snprintf(message, size, "%s", assay_scene_warning(scene, 0));
        }
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return status;
}

static void put_u32(uint8_t *at, uint32_t value) { memcpy(at, &value, sizeof value); }

static void test_glb(void **state)
{
    size_t         count = 0;
    uint8_t       *glb   = make_glb(&count);
    uint8_t       *more  = malloc(count + 64);
    char           message[1024];
    const uint32_t json_size = (uint32_t)glb[12] | (uint32_t)glb[13] << 8;
    uint8_t       *bin       = more + 20 + json_size;
    (void)state;
    assert_int_equal(load_bytes(glb, count, message, sizeof message), ASSAY_OK);

    /* an extra chunk of a type of its own behind the binary one */
    memcpy(more, glb, count);
    memcpy(more + count, "\4\0\0\0XTRA1234", 12);
    put_u32(more + 8, (uint32_t)count + 12);
    assert_int_equal(load_bytes(more, count + 12, message, sizeof message), ASSAY_OK);
    /* bytes after the end */
    memcpy(more, glb, count);
    memset(more + count, 'x', 5);
    assert_int_equal(load_bytes(more, count + 5, message, sizeof message), ASSAY_OK);
    assert_non_null(strstr(message, "5 bytes after its end"));
    /* the text padded with NUL */
    memcpy(more, glb, count);
    for (uint8_t *p = bin - 1; *p == ' '; p--) {
        *p = 0;
    }
    assert_int_equal(load_bytes(more, count, message, sizeof message), ASSAY_OK);
    /* no binary chunk although a buffer asks for it */
    memcpy(more, glb, count);
    put_u32(more + 8, 20 + json_size);
    assert_int_equal(load_bytes(more, 20 + json_size, message, sizeof message), ASSAY_ERR_FORMAT);
    assert_non_null(strstr(message, "buffers/0: has no uri"));
    /* a shorter one */
    memcpy(more, glb, count);
    put_u32(bin, 32);
    put_u32(more + 8, (uint32_t)count - 4);
    assert_int_equal(load_bytes(more, count - 4, message, sizeof message), ASSAY_ERR_FORMAT);
    assert_non_null(strstr(message, "byteLength is 36, but there are only 32 bytes"));
    free(more);
    free(glb);
}

static void test_lying_glb(void **state)
{
    static const struct {
        size_t       at;
        uint32_t     value;
        assay_status status;
        const char  *message;
    } cases[] = {
        {4, 1, ASSAY_ERR_UNSUPPORTED, "GLB: version 1 is not supported"},
        {4, 3, ASSAY_ERR_UNSUPPORTED, "GLB: version 3"},
        {8, 0xFFFFFFFF, ASSAY_ERR_FORMAT, "GLB: the header claims 4294967295 bytes"},
        {8, 0, ASSAY_ERR_FORMAT, "GLB: the header claims 0 bytes"},
        {8, 16, ASSAY_ERR_FORMAT, "no room for its header"},
        {12, 0xFFFFFFFF, ASSAY_ERR_FORMAT, "GLB: the chunk at byte 12 claims 4294967295 bytes"},
        {12, 0xFFFFFFF0, ASSAY_ERR_FORMAT, "claims"},
        {16, 0x004E4942, ASSAY_ERR_FORMAT, "the first chunk, and only that, must be JSON"},
        {0, 0x46546C68, ASSAY_ERR_FORMAT, "is not a glTF file"},
    };
    size_t   count = 0;
    uint8_t *glb = make_glb(&count), *longer = make_glb(&count);
    char     words[1024];
    (void)state;
    put_u32(longer + 12, (uint32_t)count - 19); /* one byte more than there is */
    assert_int_equal(load_bytes(longer, count, words, sizeof words), ASSAY_ERR_FORMAT);
    assert_non_null(strstr(words, "are left"));
    free(longer);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint8_t *copy = malloc(count);
        char     message[1024];
        memcpy(copy, glb, count);
        put_u32(copy + cases[i].at, cases[i].value);
        const assay_status status = load_bytes(copy, count, message, sizeof message);
        if (status != cases[i].status || !strstr(message, cases[i].message)) {
            fail_msg("%zu = %u: status %d, %s", cases[i].at, cases[i].value, status, message);
        }
        free(copy);
    }
    free(glb);
}

/* Every proper prefix is refused, from a block of exactly its size. */
static void test_truncated_glb(void **state)
{
    size_t   count = 0;
    uint8_t *glb   = make_glb(&count);
    (void)state;
    for (size_t size = 0; size < count; size++) {
        uint8_t *copy = malloc(size ? size : 1);
        char     message[1024];
        memcpy(copy, glb, size);
        assert_int_equal(load_bytes(copy, size, message, sizeof message), ASSAY_ERR_FORMAT);
        free(copy);
    }
    free(glb);
}

/* ---- digest ---- */

static void digest_of(const char *path, const assay_scene_options *options, char digest[65])
{
    assay_context *context = gltf_context();
    assay_scene   *scene   = NULL;
    assert_int_equal(assay_scene_load(context, path, options, &scene), ASSAY_OK);
    memcpy(digest, assay_scene_digest(scene), 65);
    assert_int_equal(strlen(digest), 64);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

static void test_digest(void **state)
{
    temporary           t       = temporary_create();
    assay_scene_options options = assay_scene_options_default();
    char                first[65], second[65];
    float               moved[9];
    (void)state;
    temporary_write(temporary_path(&t, "a.bin"), corners, sizeof corners);
    write_gltf(temporary_path(&t, "a.gltf"), "a.bin");
    digest_of(t.path, NULL, first);
    digest_of(t.path, &options, second);
    assert_string_equal(first, second);
    options.background = (assay_rgb){0.0, 0.0, 1.0};
    digest_of(t.path, &options, second);
    assert_string_not_equal(first, second);
    /* a bit of a file that is only referred to counts */
    memcpy(moved, corners, sizeof moved);
    moved[8] = 0x1p-149f;
    temporary_write(temporary_path(&t, "a.bin"), moved, sizeof moved);
    digest_of(temporary_path(&t, "a.gltf"), NULL, second);
    assert_string_not_equal(first, second);
    temporary_destroy(&t);
}

static void test_options_are_checked(void **state)
{
    assay_scene_options wrong[6];
    (void)state;
    for (int i = 0; i < 6; i++) {
        wrong[i] = assay_scene_options_default();
    }
    wrong[0].scene_index          = -2;
    wrong[1].environment_scale    = -1.0;
    wrong[2].environment_scale    = NAN;
    wrong[3].environment_rotation = INFINITY;
    wrong[4].background.g         = -1e-9;
    wrong[5].background.b         = INFINITY;
    for (int i = 0; i < 6; i++) {
        assay_context *context = gltf_context();
        gltf_maker    *maker   = gltf_maker_create();
        assay_scene   *scene   = NULL;
        gltf_shown_triangle(maker);
        assert_int_equal(gltf_load_status(maker, context, &wrong[i], &scene), ASSAY_ERR_ARGUMENT);
        assay_context_destroy(context);
    }
}

/* A map is read, reported, and part of the digest; a missing one is named. */
static void test_environment(void **state)
{
    static const char *const names[] = {"R", "G", "B"};
    assay_context           *context = gltf_context();
    assay_scene_options      options = assay_scene_options_default();
    temporary                t       = temporary_create();
    assay_image             *image   = NULL;
    char                     first[65], second[65], path[512], *report = NULL;
    (void)state;
    assert_int_equal(assay_image_create(context, 8, 4, &image), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        channel.data.f32[0] = 1.0f;
    }
    snprintf(path, sizeof path, "%s", temporary_path(&t, "sky.exr"));
    assert_int_equal(assay_image_write_exr(image, path), ASSAY_OK);
    assay_image_destroy(image);
    temporary_write(temporary_path(&t, "a.bin"), corners, sizeof corners);
    write_gltf(temporary_path(&t, "a.gltf"), "a.bin");
    digest_of(t.path, &options, first);
    options.environment_path = path;
    digest_of(t.path, &options, second);
    assert_string_not_equal(first, second);
    assay_scene *scene = NULL;
    assert_int_equal(assay_scene_load(context, t.path, &options, &scene), ASSAY_OK);
    assert_true(assay_scene_describe(scene).has_environment);
    assert_true(assay_scene_describe(scene).has_light);
    assert_int_equal(assay_scene_report_json(scene, &report), ASSAY_OK);
    assert_non_null(strstr(report, "sky.exr"));
    assay_text_destroy(context, report);
    assay_scene_destroy(scene);
    options.environment_path = "missing.hdr";
    assert_int_equal(assay_scene_load(context, t.path, &options, &scene), ASSAY_ERR_NOT_FOUND);
    assert_non_null(strstr(assay_context_error(context), "missing.hdr"));
    assay_context_destroy(context);
    temporary_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_of_files), cmocka_unit_test(test_longer_file),
        cmocka_unit_test(test_relative_path),  cmocka_unit_test(test_what_is_no_file),
        cmocka_unit_test(test_too_large),      cmocka_unit_test(test_main_file),
        cmocka_unit_test(test_data_uris),      cmocka_unit_test(test_glb),
        cmocka_unit_test(test_lying_glb),      cmocka_unit_test(test_truncated_glb),
        cmocka_unit_test(test_digest),         cmocka_unit_test(test_options_are_checked),
        cmocka_unit_test(test_environment),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
