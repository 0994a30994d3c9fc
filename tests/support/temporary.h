/* temporary.h - folders and files that a test makes and takes away again. */
#ifndef ASSAY_TESTS_TEMPORARY_H
#define ASSAY_TESTS_TEMPORARY_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    char folder[256];
    char path[512]; /* what temporary_path gave last */
} temporary;

/* A new empty folder under $TMPDIR (or /tmp); fails the test where there is none to be had. */
temporary temporary_create(void);
/* Removes the folder with all files in it (no folders), and fails the test if any of them is
 * hidden: a writer left something behind. */
void temporary_destroy(temporary *t);

/* "folder/name"; borrowed until the next call. */
const char *temporary_path(temporary *t, const char *name);
/* Files in the folder. */
int temporary_count(const temporary *t);

void     temporary_write(const char *path, const void *bytes, size_t count);
uint8_t *temporary_read(const char *path, size_t *count_out); /* release with free */

#endif
