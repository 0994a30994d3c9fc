/* test_scene_exhausted.c - a machine without memory: not only the library's own allocations, but
 * those of tinygltf, the C++ runtime and the image decoders too, end in ASSAY_ERR_MEMORY.
 *
 * The program brings its own malloc, on top of glibc's, that holds no more than a cap.  Sanitizers
 * bring theirs, so the test is skipped there. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <malloc.h>
#include <stdlib.h>
#include <string.h>

#include "scene/scene_build.h"
#include "support/gltf_maker.h"

#if defined(__SANITIZE_ADDRESS__)
#define HAS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAS_SANITIZER 1
#endif
#endif

#ifdef HAS_SANITIZER

static void test_exhausted(void **state)
{
    (void)state;
    skip();
}

#else

void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t bytes);
void  __libc_free(void *block);

/* A program's malloc cannot be without state; one thread uses it. */
static size_t held, cap = SIZE_MAX;
static long   blocks;

static void *keep(void *block)
{
    if (block) {
        held += malloc_usable_size(block);
        blocks++;
    }
    return block;
}

static bool refuses(size_t bytes) { return bytes > cap || held > cap - bytes; }

void *malloc(size_t bytes) { return refuses(bytes) ? NULL : keep(__libc_malloc(bytes)); }

void *calloc(size_t count, size_t size)
{
    return (size && count > SIZE_MAX / size) || refuses(count * size)
               ? NULL
               : keep(__libc_calloc(count, size));
}

void *realloc(void *block, size_t bytes)
{
    if (refuses(bytes)) {
        return NULL;
    }
    const size_t before = block ? malloc_usable_size(block) : 0;
    void        *grown  = __libc_realloc(block, bytes);
    if (grown) {
        held -= before;
        blocks -= block != NULL;
        keep(grown);
    }
    return grown;
}

void free(void *block)
{
    if (block) {
        held -= malloc_usable_size(block);
        blocks--;
    }
    __libc_free(block);
}

static const char png[] =
    "data:image/png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQDwAEhQGAhKmM"
    "IQAAAABJRU5ErkJggg==";

static assay_status load_and_report(assay_context *context, const char *text)
{
    assay_scene *scene  = NULL;
    char        *report = NULL;
    assay_status status = gltf_load_text(context, text, &scene);
    if (status == ASSAY_OK) {
        status = assay_scene_report_json(scene, &report);
    }
    assay_text_destroy(context, report);
    assay_scene_destroy(scene);
    return status;
}

static void test_exhausted(void **state)
{
    gltf_maker    *maker   = gltf_maker_create();
    assay_context *context = gltf_context();
    int            refused = 0;
    assay_status   status  = ASSAY_ERR_MEMORY;
    (void)state;
    gltf_shown_triangle(maker);
    gltf_add(maker, "images", "\"uri\":\"%s\"", png);
    gltf_add(maker, "textures", "\"source\":0");
    gltf_add(maker, "materials", "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}");
    for (int i = 0; i < 50; i++) {
        gltf_add(maker, "nodes", "\"name\":\"some node\",\"mesh\":0,\"translation\":[1,2,3]");
    }
    char *text = gltf_text(maker);
    gltf_maker_destroy(maker);
    assert_int_equal(load_and_report(context, text), ASSAY_OK); /* what is made once, is made */
    const long before = blocks;
    for (size_t room = 0; status != ASSAY_OK; room += 509) {
        assert_true(room < (size_t)64 << 20);
        cap    = held + room;
        status = load_and_report(context, text);
        cap    = SIZE_MAX;
        assert_true(status == ASSAY_OK || status == ASSAY_ERR_MEMORY);
        assert_int_equal(blocks, before);
        refused += status != ASSAY_OK;
    }
    print_message("%d sizes of memory were too small\n", refused);
    assert_true(refused > 100);
    assay_context_destroy(context);
    free(text);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_exhausted)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
