/* atomic_file.h - a file that is either written whole or not at all.
 *
 *     assay_atomic_file *file;
 *     status = assay_atomic_file_open(context, path, &file);
 *     assay_atomic_file_write(file, ...);                errors are kept for commit
 *     status = assay_atomic_file_commit(file);           or assay_atomic_file_discard(file)
 *
 * Bytes go to a new file beside the target, which replaces the target at commit; a symbolic link
 * stays, and what it points to is replaced.  A target that exists and is not a regular file (a
 * pipe, a terminal, /dev/null) gets all bytes at commit instead. */
#ifndef ASSAY_IO_ATOMIC_FILE_H
#define ASSAY_IO_ATOMIC_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

typedef struct assay_atomic_file assay_atomic_file;

/* Errors: WRITE (path and the system's words: a folder that is missing, no permission, a folder in
 * the file's place), MEMORY. */
assay_status assay_atomic_file_open(assay_context *context, const char *path,
                                    assay_atomic_file **file_out);

/* Appends, or writes at an offset from the file's start (which may lie past the end).  After an
 * error further writes do nothing. */
void assay_atomic_file_write(assay_atomic_file *file, const void *bytes, size_t count);
void assay_atomic_file_write_at(assay_atomic_file *file, uint64_t offset, const void *bytes,
                                size_t count);
/* Whether a write has failed: a reason to stop early. */
bool assay_atomic_file_failed(const assay_atomic_file *file);

/* Makes the bytes durable and puts them in place; destroys the file object in any case.  On error
 * (also of any earlier write) a regular target is as it was and nothing is left beside it.
 * Errors: WRITE. */
assay_status assay_atomic_file_commit(assay_atomic_file *file);

/* Gives up: the target is as it was, and nothing is left beside it.  NULL is legal. */
void assay_atomic_file_discard(assay_atomic_file *file);

#endif
