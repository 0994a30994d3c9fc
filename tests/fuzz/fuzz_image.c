/* fuzz_image.c - every image and table reader on arbitrary bytes (libFuzzer).
 *
 * The first bytes choose the reader, as they do for files: OpenEXR, Radiance, NumPy, PNG, JPEG. The
 * context refuses more than 256 MiB at a time, so that a header which asks for more than its file
 * can fill costs nothing, and the ways out of a refused block are walked too. */
#include <stdlib.h>
#include <string.h>

#include "io/image_data.h"
#include "io/image_decode.h"
#include "io/npy.h"
#include "scene/texture.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

static void *allocate(void *user, size_t bytes)
{
    (void)user;
    return bytes > (size_t)1 << 28 ? NULL : malloc(bytes);
}

static void release(void *user, void *memory)
{
    (void)user;
    free(memory);
}

static void read_table(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_array *array = NULL;
    if (assay_array_decode_npy(context, bytes, count, "fuzz", &array) == ASSAY_OK) {
        assay_array_destroy(array);
    }
}

static void read_image(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_image *image = NULL;
    if (assay_image_decode(context, bytes, count, "fuzz", NULL, &image) == ASSAY_OK) {
        char digest[65];
        assay_image_digest(image, digest);
        assay_image_destroy(image);
    }
}

static void read_texture(assay_context *context, const uint8_t *bytes, size_t count)
{
    assay_texture_image image;
    if (assay_texture_image_decode(context, bytes, count, "fuzz", &image) == ASSAY_OK) {
        assay_texture_image_release(context, &image);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    const assay_context_options options = {.threads = 1, .allocator = {allocate, release, NULL}};
    assay_context              *context = NULL;
    if (assay_context_create(&options, &context) != ASSAY_OK) {
        return 0;
    }
    if (count >= 6 && memcmp(bytes, "\223NUMPY", 6) == 0) {
        read_table(context, bytes, count);
    } else if (count >= 2 && (memcmp(bytes, "v/", 2) == 0 || memcmp(bytes, "#?", 2) == 0)) {
        read_image(context, bytes, count);
    } else {
        read_texture(context, bytes, count);
    }
    assay_context_destroy(context);
    return 0;
}
