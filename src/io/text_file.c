/* text_file.c - a text, whole or not at all. */
#include <string.h>

#include "io/atomic_file.h"

assay_status assay_text_write(assay_context *context, const char *path, const char *text)
{
    assay_atomic_file *file   = NULL;
    const assay_status status = assay_atomic_file_open(context, path, &file);
    if (status != ASSAY_OK) {
        return status;
    }
    const size_t length = strlen(text);
    assay_atomic_file_write(file, text, length);
    if (length > 0 && text[length - 1] != '\n') {
        assay_atomic_file_write(file, "\n", 1);
    }
    return assay_atomic_file_commit(file);
}
