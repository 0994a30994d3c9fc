/* golden_arrays.c - what tests/tools/golden.sh needs to know of bundles and images.
 *
 *     golden_arrays list BUNDLE         version, seed, samples, and a line an array with its hash:
 *                                       what the camera sees, records, what follows, totals
 *     golden_arrays keep IN OUT         the golden part of an image: R G B and their variance
 *     golden_arrays digest IMAGE        hash of its values
 *     golden_arrays compare IMAGE NOW   first pixel that differs; exit code 1 where there is one
 *     golden_arrays nudge IN OUT X Y    R of one pixel one unit in the last place up, for tests
 *
 * Exit code 2: something cannot be read or written, in one line on stderr. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "io/read_file.h"
#include "support/array_hash.h"

enum { PATH_SIZE = 4096, MANIFEST_LIMIT = 16 << 20 };

static assay_context *make_context(void)
{
    assay_context *context = NULL;
    if (assay_context_create(NULL, &context) != ASSAY_OK) {
        fprintf(stderr, "golden_arrays: no memory\n");
        exit(2);
    }
    return context;
}

static void demand(assay_context *context, assay_status status)
{
    if (status != ASSAY_OK) {
        fprintf(stderr, "golden_arrays: %s\n", assay_context_error(context));
        exit(2);
    }
}

static void fail(const char *path, const char *what)
{
    fprintf(stderr, "golden_arrays: %s: %s\n", path, what);
    exit(2);
}

static assay_image *read_image(assay_context *context, const char *path)
{
    assay_image *image = NULL;
    demand(context, assay_image_read(context, path, &image));
    return image;
}

/* ---- list ---- */

static const char *text_of(const char *folder, const cJSON *object, const char *key)
{
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, key));
    if (!text) {
        fail(folder, key);
    }
    return text;
}

static cJSON *read_manifest(assay_context *context, const char *folder)
{
    char     path[PATH_SIZE];
    uint8_t *bytes = NULL;
    size_t   count = 0;
    if (snprintf(path, sizeof path, "%s/manifest.json", folder) >= PATH_SIZE) {
        fail(folder, "the name is too long");
    }
    demand(context, assay_read_file(context, path, MANIFEST_LIMIT, &bytes, &count));
    cJSON *manifest = cJSON_ParseWithLength((const char *)bytes, count);
    assay_release(context, bytes);
    if (!manifest) {
        fail(path, "not JSON");
    }
    return manifest;
}

static void list_image(assay_context *context, const char *name, const char *path)
{
    char         digest[65];
    assay_image *image = read_image(context, path);
    array_hash_image(name, image, digest);
    printf("array %s %s %dx%dx%d %s\n", name, array_hash_image_type(image),
           assay_image_height(image), assay_image_width(image), assay_image_channel_count(image),
           digest);
    assay_image_destroy(image);
}

static void list_table(assay_context *context, const char *name, const char *path)
{
    char         digest[65];
    assay_array *table = NULL;
    demand(context, assay_array_read_npy(context, path, &table));
    array_hash_table(name, table, digest);
    printf("array %s <f8 %zux%zu %s\n", name, assay_array_rows(table), assay_array_columns(table),
           digest);
    assay_array_destroy(table);
}

/* Least and largest number of samples of a pixel. */
static void list_samples(assay_context *context, const char *folder)
{
    char path[PATH_SIZE];
    if (snprintf(path, sizeof path, "%s/radiance/samples.exr", folder) >= PATH_SIZE) {
        fail(folder, "the name is too long");
    }
    assay_image        *image   = read_image(context, path);
    const assay_channel channel = assay_image_channel_at(image, 0);
    const size_t pixels = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
    uint32_t     least = UINT32_MAX, most = 0;
    for (size_t i = 0; i < pixels; i++) {
        const uint32_t count = channel.data.u32[i];
        least                = count < least ? count : least;
        most                 = count > most ? count : most;
    }
    if (least == most) {
        printf("samples %u\n", most);
    } else {
        printf("samples %u to %u\n", least, most);
    }
    assay_image_destroy(image);
}

/* What comes earlier on the way from the scene to the image has a smaller stage. */
enum { STAGES = 4 };
static int stage_of(const char *name)
{
    static const char *const early[] = {"environment/", "records", "radiance_records"};
    if (strncmp(name, "gbuffer/", 8) == 0) {
        return 0;
    }
    for (size_t i = 0; i < sizeof early / sizeof *early; i++) {
        if (strncmp(name, early[i], strlen(early[i])) == 0) {
            return 1;
        }
    }
    return strstr(name, "/total") ? 3 : 2;
}

static void list_array(assay_context *context, const char *folder, const char *name,
                       const cJSON *entry)
{
    char        path[PATH_SIZE];
    const char *file = text_of(folder, entry, "file");
    const char *dot  = strrchr(file, '.');
    if (snprintf(path, sizeof path, "%s/%s", folder, file) >= PATH_SIZE) {
        fail(folder, "the name is too long");
    }
    if (dot && strcmp(dot, ".npy") == 0) {
        list_table(context, name, path);
    } else {
        list_image(context, name, path);
    }
}

static int list(const char *folder)
{
    assay_context *context  = make_context();
    cJSON         *manifest = read_manifest(context, folder);
    printf("version %s\n", text_of(folder, manifest, "tool"));
    printf("seed %s\n", text_of(folder, manifest, "assay:seed"));
    list_samples(context, folder);
    for (int stage = 0; stage < STAGES; stage++) {
        const cJSON *entry = NULL;
        cJSON_ArrayForEach(entry, cJSON_GetObjectItemCaseSensitive(manifest, "arrays"))
        {
            const char *name = text_of(folder, entry, "name");
            if (stage_of(name) == stage) {
                list_array(context, folder, name, entry);
            }
        }
    }
    cJSON_Delete(manifest);
    assay_context_destroy(context);
    return 0;
}

/* ---- images ---- */

static const char *const KEPT[] = {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"};

static int keep(const char *from, const char *to)
{
    assay_context *context = make_context();
    assay_image   *whole = read_image(context, from), *part = NULL;
    const int      width = assay_image_width(whole), height = assay_image_height(whole);
    demand(context, assay_image_create(context, width, height, &part));
    for (size_t i = 0; i < sizeof KEPT / sizeof *KEPT; i++) {
        assay_channel source, target;
        if (!assay_image_find_channel(whole, KEPT[i], &source)) {
            fail(from, KEPT[i]);
        }
        demand(context, assay_image_add_channel(part, KEPT[i], ASSAY_CHANNEL_FLOAT, &target));
        memcpy(target.data.u32, source.data.u32, sizeof(uint32_t) * (size_t)width * (size_t)height);
    }
    for (int i = 0; i < assay_image_attribute_count(whole); i++) {
        const char *name, *value;
        assay_image_attribute_at(whole, i, &name, &value);
        demand(context, assay_image_set_attribute(part, name, value));
    }
    demand(context, assay_image_write_exr(part, to));
    assay_image_destroy(part);
    assay_image_destroy(whole);
    assay_context_destroy(context);
    return 0;
}

static int digest(const char *path)
{
    assay_context *context = make_context();
    assay_image   *image   = read_image(context, path);
    char           text[65];
    array_hash_image("image", image, text);
    puts(text);
    assay_image_destroy(image);
    assay_context_destroy(context);
    return 0;
}

static bool same_sample(const assay_channel *a, const assay_channel *b, size_t pixel)
{
    return a->data.u32[pixel] == b->data.u32[pixel] ||
           (a->type == ASSAY_CHANNEL_FLOAT && isnan(a->data.f32[pixel]) &&
            isnan(b->data.f32[pixel]));
}

/* The pixels of a that differ; *first is the first of them, and *channel the first channel there.
 */
static size_t count_differing(const assay_image *a, const assay_image *b, size_t *first,
                              assay_channel channel[2])
{
    const size_t pixels = (size_t)assay_image_width(a) * (size_t)assay_image_height(a);
    size_t       count  = 0;
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        bool same = true;
        for (int c = 0; same && c < assay_image_channel_count(a); c++) {
            const assay_channel one = assay_image_channel_at(a, c);
            const assay_channel two = assay_image_channel_at(b, c);
            same                    = same_sample(&one, &two, pixel);
            if (!same && count == 0) {
                *first     = pixel;
                channel[0] = one;
                channel[1] = two;
            }
        }
        count += !same;
    }
    return count;
}

static bool same_layout(const assay_image *a, const assay_image *b)
{
    bool same = assay_image_width(a) == assay_image_width(b) &&
                assay_image_height(a) == assay_image_height(b) &&
                assay_image_channel_count(a) == assay_image_channel_count(b);
    for (int c = 0; same && c < assay_image_channel_count(a); c++) {
        const assay_channel one = assay_image_channel_at(a, c), two = assay_image_channel_at(b, c);
        same = one.type == two.type && strcmp(one.name, two.name) == 0;
    }
    return same;
}

static int compare(const char *golden, const char *now)
{
    assay_context *context = make_context();
    assay_image   *a = read_image(context, golden), *b = read_image(context, now);
    assay_channel  channel[2];
    size_t         first = 0, count = 0;
    int            code = 0;
    if (!same_layout(a, b)) {
        printf("image: other size or channels: %d x %d, golden %d x %d\n", assay_image_width(b),
               assay_image_height(b), assay_image_width(a), assay_image_height(a));
        code = 1;
    } else if ((count = count_differing(a, b, &first, channel)) > 0) {
        const size_t width = (size_t)assay_image_width(a);
        printf("image: %zu of %zu pixels differ; first x %zu, y %zu, %s: %a, golden %a\n", count,
               width * (size_t)assay_image_height(a), first % width, first / width, channel[0].name,
               (double)channel[1].data.f32[first], (double)channel[0].data.f32[first]);
        code = 1;
    } else {
        printf("image: every bit the same\n");
    }
    assay_image_destroy(a);
    assay_image_destroy(b);
    assay_context_destroy(context);
    return code;
}

static int nudge(const char *from, const char *to, const char *x, const char *y)
{
    assay_context *context = make_context();
    assay_image   *image   = read_image(context, from);
    assay_channel  red;
    const size_t   column = strtoul(x, NULL, 10), row = strtoul(y, NULL, 10);
    if (!assay_image_find_channel(image, "R", &red) || column >= (size_t)assay_image_width(image) ||
        row >= (size_t)assay_image_height(image)) {
        fail(from, "no such sample");
    }
    red.data.u32[row * (size_t)assay_image_width(image) + column]++;
    demand(context, assay_image_write_exr(image, to));
    assay_image_destroy(image);
    assay_context_destroy(context);
    return 0;
}

int main(int count, char **argv)
{
    const char *command = count > 1 ? argv[1] : "";
    if (count == 3 && strcmp(command, "list") == 0) {
        return list(argv[2]);
    }
    if (count == 4 && strcmp(command, "keep") == 0) {
        return keep(argv[2], argv[3]);
    }
    if (count == 3 && strcmp(command, "digest") == 0) {
        return digest(argv[2]);
    }
    if (count == 4 && strcmp(command, "compare") == 0) {
        return compare(argv[2], argv[3]);
    }
    if (count == 6 && strcmp(command, "nudge") == 0) {
        return nudge(argv[2], argv[3], argv[4], argv[5]);
    }
    fail("usage",
         "list BUNDLE | keep IN OUT | digest IMAGE | compare IMAGE NOW | nudge IN OUT X Y");
    return 2;
}
