/* make_corpus.c - seeds for the fuzzers, from our own scenes and our own writers.
 *
 *     make_corpus SCENES_DIR OUT_DIR
 *
 * OUT_DIR/gltf gets every scene as one .glb (its buffer as the binary chunk) and as the bare JSON;
 * OUT_DIR/image gets small images and tables in the formats that can be written. */
#include <cjson/cJSON.h>
#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "assay/assay.h"

static void stop(const char *what)
{
    fprintf(stderr, "make_corpus: %s\n", what);
    exit(1);
}

static char *read_file(const char *path, size_t *count)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        stop(path);
    }
    fseek(file, 0, SEEK_END);
    *count      = (size_t)ftell(file);
    char *bytes = calloc(*count + 1, 1);
    rewind(file);
    if (!bytes || fread(bytes, 1, *count, file) != *count) {
        stop(path);
    }
    fclose(file);
    return bytes;
}

static void write_word(FILE *out, uint32_t word)
{
    const unsigned char bytes[4] = {(unsigned char)word, (unsigned char)(word >> 8),
                                    (unsigned char)(word >> 16), (unsigned char)(word >> 24)};
    fwrite(bytes, 1, 4, out);
}

static void write_chunk(FILE *out, uint32_t type, const char *bytes, size_t count, char filler)
{
    const size_t padded = (count + 3) & ~(size_t)3;
    write_word(out, (uint32_t)padded);
    write_word(out, type);
    fwrite(bytes, 1, count, out);
    for (size_t i = count; i < padded; i++) {
        fputc(filler, out);
    }
}

static void pack_scene(const char *scenes, const char *name, const char *out_folder)
{
    char   path[4096];
    size_t text_count, bin_count;
    snprintf(path, sizeof path, "%s/%s/%s.gltf", scenes, name, name);
    char  *text   = read_file(path, &text_count);
    cJSON *json   = cJSON_Parse(text);
    cJSON *buffer = cJSON_GetArrayItem(cJSON_GetObjectItem(json, "buffers"), 0);
    snprintf(path, sizeof path, "%s/%s/%s.bin", scenes, name, name);
    char *bin = read_file(path, &bin_count);
    if (!buffer || cJSON_GetArraySize(cJSON_GetObjectItem(json, "buffers")) != 1) {
        stop("a scene must have one buffer");
    }
    cJSON_DeleteItemFromObject(buffer, "uri");
    char        *packed = cJSON_PrintUnformatted(json);
    const size_t length = strlen(packed);
    snprintf(path, sizeof path, "%s/%s.glb", out_folder, name);
    FILE *out = fopen(path, "wb");
    if (!out) {
        stop(path);
    }
    write_word(out, 0x46546C67u);
    write_word(out, 2);
    write_word(out, (uint32_t)(12 + 8 + ((length + 3) & ~3u) + 8 + ((bin_count + 3) & ~3u)));
    write_chunk(out, 0x4E4F534Au, packed, length, ' ');
    write_chunk(out, 0x004E4942u, bin, bin_count, 0);
    fclose(out);
    snprintf(path, sizeof path, "%s/%s.gltf", out_folder, name);
    out = fopen(path, "wb");
    if (!out || fwrite(text, 1, text_count, out) != text_count || fclose(out)) {
        stop(path);
    }
    cJSON_free(packed);
    cJSON_Delete(json);
    free(text);
    free(bin);
}

static void pack_scenes(const char *scenes, const char *out_folder)
{
    DIR *folder = opendir(scenes);
    if (!folder) {
        stop(scenes);
    }
    for (struct dirent *entry; (entry = readdir(folder));) {
        char        path[4096];
        struct stat info;
        snprintf(path, sizeof path, "%s/%s/%s.gltf", scenes, entry->d_name, entry->d_name);
        if (entry->d_name[0] != '.' && stat(path, &info) == 0) {
            pack_scene(scenes, entry->d_name, out_folder);
        }
    }
    closedir(folder);
}

static void write_images(const char *out_folder)
{
    assay_context *context = NULL;
    assay_image   *image   = NULL;
    assay_array   *array   = NULL;
    assay_channel  channel;
    char           path[4096];
    bool           ok = assay_context_create(NULL, &context) == ASSAY_OK &&
              assay_image_create(context, 5, 3, &image) == ASSAY_OK;
    for (const char *name = "BGR"; ok && *name; name++) {
        const char one[2] = {*name, '\0'};
        ok = assay_image_add_channel(image, one, ASSAY_CHANNEL_FLOAT, &channel) == ASSAY_OK;
        for (int i = 0; ok && i < 15; i++) {
            channel.data.f32[i] = 0.1F * (float)i;
        }
    }
    ok = ok && assay_image_add_channel(image, "Id", ASSAY_CHANNEL_UINT, NULL) == ASSAY_OK &&
         assay_image_set_attribute(image, "assay:method", "path") == ASSAY_OK;
    snprintf(path, sizeof path, "%s/small.exr", out_folder);
    ok = ok && assay_image_write_exr(image, path) == ASSAY_OK;
    snprintf(path, sizeof path, "%s/small.png", out_folder);
    ok = ok && assay_image_write_png(image, "", 0.0, path) == ASSAY_OK;
    snprintf(path, sizeof path, "%s/small.npy", out_folder);
    ok = ok && assay_array_create(context, 2, 6, &array) == ASSAY_OK &&
         assay_array_write_npy(array, path) == ASSAY_OK;
    if (!ok) {
        stop("cannot write the images");
    }
    snprintf(path, sizeof path, "%s/small.hdr", out_folder);
    FILE *out = fopen(path, "wb");
    if (!out || fputs("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n", out) < 0 ||
        fwrite("\200\100\40\201\1\2\3\200\10\20\30\202\4\5\6\177", 1, 16, out) != 16 ||
        fclose(out)) {
        stop(path);
    }
    assay_array_destroy(array);
    assay_image_destroy(image);
    assay_context_destroy(context);
}

int main(int argc, char **argv)
{
    char folder[4096];
    if (argc != 3) {
        stop("usage: make_corpus SCENES_DIR OUT_DIR");
    }
    mkdir(argv[2], 0777);
    snprintf(folder, sizeof folder, "%s/gltf", argv[2]);
    mkdir(folder, 0777);
    pack_scenes(argv[1], folder);
    snprintf(folder, sizeof folder, "%s/image", argv[2]);
    mkdir(folder, 0777);
    write_images(folder);
    return 0;
}
