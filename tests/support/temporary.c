/* temporary.c - plain stdio and dirent. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "temporary.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

temporary temporary_create(void)
{
    temporary   t;
    const char *root = getenv("TMPDIR");
    snprintf(t.folder, sizeof t.folder, "%.200s/assay-test-XXXXXX", root ? root : "/tmp");
    assert_non_null(mkdtemp(t.folder));
    return t;
}

const char *temporary_path(temporary *t, const char *name)
{
    snprintf(t->path, sizeof t->path, "%s/%s", t->folder, name);
    return t->path;
}

static int walk(const temporary *t, int *hidden_out, int remove_files)
{
    DIR *folder = opendir(t->folder);
    int  count  = 0;
    assert_non_null(folder);
    for (const struct dirent *e = readdir(folder); e; e = readdir(folder)) {
        if (strcmp(e->d_name, ".") == 0 || strcmp(e->d_name, "..") == 0) {
            continue;
        }
        count++;
        *hidden_out += e->d_name[0] == '.';
        if (remove_files) {
            char path[600];
            snprintf(path, sizeof path, "%s/%.255s", t->folder, e->d_name);
            unlink(path);
        }
    }
    closedir(folder);
    return count;
}

int temporary_count(const temporary *t)
{
    int hidden = 0;
    return walk(t, &hidden, 0);
}

void temporary_destroy(temporary *t)
{
    int hidden = 0;
    chmod(t->folder, 0700);
    walk(t, &hidden, 1);
    assert_int_equal(rmdir(t->folder), 0);
    assert_int_equal(hidden, 0);
}

void temporary_write(const char *path, const void *bytes, size_t count)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
}

uint8_t *temporary_read(const char *path, size_t *count_out)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    const long size  = ftell(file);
    uint8_t   *bytes = malloc((size_t)size + 1);
    assert_non_null(bytes);
    rewind(file);
    assert_int_equal(fread(bytes, 1, (size_t)size, file), size);
    fclose(file);
    *count_out = (size_t)size;
    return bytes;
}
