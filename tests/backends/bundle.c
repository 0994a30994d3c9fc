/* bundle.c - the manifest, by cJSON; digests by libmd.
 *
 * What was written is listed as it was written: name, unit, shape, dtype and digest of the file. */
#include "bundle.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <sha2.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_SIZE = 4096 };

struct bundle {
    char  *folder;
    cJSON *manifest;
    bool   written;
};

static void path_in(const bundle *b, const char *name, const char *ending, char path[PATH_SIZE])
{
    if (snprintf(path, PATH_SIZE, "%s/%s%s", b->folder, name, ending) >= PATH_SIZE) {
        fail("%s: too long a name", name);
    }
}

static bundle *make(const char *folder)
{
    bundle *b = allocate(1, sizeof *b);
    b->folder = strdup(folder);
    return b;
}

/* ---- in ---- */

static char *read_text(const char *path)
{
    FILE  *file = fopen(path, "rb");
    size_t size = 0, room = 1 << 16;
    char  *text = allocate(room, 1);
    if (!file) {
        fail("%s: cannot be read", path);
    }
    for (size_t got; (got = fread(text + size, 1, room - size - 1, file)) > 0;) {
        size += got;
        if (size + 1 == room) {
            room *= 2;
            text = realloc(text, room);
            if (!text) {
                fail("no memory");
            }
        }
    }
    fclose(file);
    text[size] = 0;
    return text;
}

bundle *bundle_open(const char *folder)
{
    char    path[PATH_SIZE];
    bundle *b = make(folder);
    path_in(b, "manifest", ".json", path);
    char *text  = read_text(path);
    b->manifest = cJSON_Parse(text);
    free(text);
    const char *format = bundle_text(b, "format");
    if (!format || strcmp(format, "assay-bundle") != 0) {
        fail("%s: not a bundle", folder);
    }
    return b;
}

const char *bundle_text(const bundle *b, const char *key)
{
    char        full[256];
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(b->manifest, key));
    const char *method =
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(b->manifest, "assay:method"));
    if (text || !method) {
        return text;
    }
    snprintf(full, sizeof full, "assay:%s.%s", method, key);
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(b->manifest, full));
}

float bundle_number(const bundle *b, const char *parameter)
{
    const char *text = bundle_text(b, parameter);
    return text ? strtof(text, NULL) : (fail("%s: not in the manifest", parameter), 0.0f);
}

bool bundle_is(const bundle *b, const char *parameter, const char *value)
{
    const char *text = bundle_text(b, parameter);
    return text && strcmp(text, value) == 0;
}

static const cJSON *entry_of(const bundle *b, const char *name)
{
    const cJSON *arrays = cJSON_GetObjectItemCaseSensitive(b->manifest, "arrays"), *entry;
    cJSON_ArrayForEach(entry, arrays)
    {
        const char *its = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, "name"));
        if (its && strcmp(its, name) == 0) {
            return entry;
        }
    }
    return NULL;
}

bool bundle_has(const bundle *b, const char *name) { return entry_of(b, name) != NULL; }

table bundle_read(const bundle *b, const char *name, const char *channels)
{
    char         path[PATH_SIZE];
    const cJSON *entry = entry_of(b, name);
    const char  *file  = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, "file"));
    if (!file) {
        fail("%s: no array '%s'", b->folder, name);
    }
    path_in(b, file, "", path);
    const char *ending = strrchr(path, '.');
    return ending && strcmp(ending, ".exr") == 0 ? table_read_exr(path, channels)
                                                 : table_read_npy(path);
}

void bundle_image_size(const bundle *b, const char *name, size_t size_out[2])
{
    const cJSON *shape = cJSON_GetObjectItemCaseSensitive(entry_of(b, name), "shape");
    for (int i = 0; i < 2; i++) {
        size_out[i] = (size_t)cJSON_GetNumberValue(cJSON_GetArrayItem(shape, i));
    }
}

/* ---- out ---- */

bundle *bundle_create(const char *folder, const bundle *like)
{
    bundle *b = make(folder);
    cJSON  *item;
    if (mkdir(folder, 0777) != 0) {
        fail("%s: cannot be made", folder);
    }
    b->written  = true;
    b->manifest = cJSON_CreateObject();
    cJSON_AddStringToObject(b->manifest, "format", "assay-bundle");
    cJSON_AddNumberToObject(b->manifest, "version", 1);
    cJSON_AddStringToObject(b->manifest, "tool", "backend");
    const cJSON *texts = like ? like->manifest : NULL;
    cJSON_ArrayForEach(item, texts)
    {
        if (cJSON_IsString(item) && !cJSON_HasObjectItem(b->manifest, item->string)) {
            cJSON_AddStringToObject(b->manifest, item->string, item->valuestring);
        }
    }
    cJSON_AddArrayToObject(b->manifest, "arrays");
    return b;
}

void bundle_describe(bundle *b, const char *key, const char *value)
{
    cJSON_AddStringToObject(b->manifest, key, value);
}

static void make_folders_of(const char *path)
{
    char folder[PATH_SIZE];
    snprintf(folder, sizeof folder, "%s", path);
    for (char *at = strchr(folder + 1, '/'); at; at = strchr(at + 1, '/')) {
        *at = 0;
        if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
            fail("%s: cannot be made", folder);
        }
        *at = '/';
    }
}

static void list(const bundle *b, const char *name, const char *unit, const table *t,
                 const char *path)
{
    char   file[PATH_SIZE], digest[SHA256_DIGEST_STRING_LENGTH];
    cJSON *entry = cJSON_CreateObject(), *shape;
    snprintf(file, sizeof file, "%s.npy", name);
    if (!SHA256File(path, digest)) {
        fail("%s: cannot be read back", path);
    }
    cJSON_AddStringToObject(entry, "name", name);
    cJSON_AddStringToObject(entry, "file", file);
    cJSON_AddStringToObject(entry, "unit", unit);
    cJSON_AddStringToObject(entry, "dtype", "float32");
    shape = cJSON_AddArrayToObject(entry, "shape");
    cJSON_AddItemToArray(shape, cJSON_CreateNumber((double)t->rows));
    cJSON_AddItemToArray(shape, cJSON_CreateNumber((double)t->columns));
    cJSON_AddStringToObject(entry, "sha256", digest);
    cJSON_AddItemToArray(cJSON_GetObjectItemCaseSensitive(b->manifest, "arrays"), entry);
}

void bundle_write(bundle *b, const char *name, const char *unit, table *t)
{
    char path[PATH_SIZE];
    path_in(b, name, ".npy", path);
    make_folders_of(path);
    table_write_npy(path, t);
    list(b, name, unit, t, path);
    table_release(t);
}

table bundle_pass_on(const bundle *from, bundle *to, const char *name, const char *channels)
{
    const cJSON *entry = entry_of(from, name);
    const char  *unit  = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(entry, "unit"));
    table        t     = bundle_read(from, name, channels);
    table        copy  = table_copy(&t);
    bundle_write(to, name, unit ? unit : "", &copy);
    return t;
}

void bundle_close(bundle *b)
{
    if (b->written) {
        char  path[PATH_SIZE];
        char *text = cJSON_Print(b->manifest);
        path_in(b, "manifest", ".json", path);
        FILE *file = fopen(path, "wb");
        if (!file || fputs(text, file) < 0 || fclose(file) != 0) {
            fail("%s: cannot be written", path);
        }
        free(text);
    }
    cJSON_Delete(b->manifest);
    free(b->folder);
    free(b);
}
