/* atomic_file.c - write beside, then rename.
 *
 * Invariant: until rename() succeeds only the temporary file is touched, and it is removed on every
 * way out.  Its name begins with a dot and is made with O_EXCL in the target's own folder, so that
 * the rename stays inside one file system and two writers never share it.
 *
 * Write errors of a full disk may first show in write, fsync or close: each is asked, and the first
 * errno is kept. */
#include "io/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/alloc.h"
#include "core/context.h"

enum { BUFFER_BYTES = 1 << 16, MAX_ATTEMPTS = 1000 };

struct assay_atomic_file {
    assay_context *context;
    char          *path;      /* as the caller named it, for messages                        */
    char          *target;    /* what is replaced: path with links resolved                  */
    char          *temporary; /* NULL: an anonymous file, copied to the target at commit  */
    int            fd;
    int            error; /* first errno, or 0                                           */
    uint64_t       at;    /* offset of the buffer's first byte                           */
    size_t         used;  /* bytes in the buffer                                         */
    uint64_t       end;   /* file size so far                                            */
    uint8_t        buffer[BUFFER_BYTES];
};

static void keep_error(assay_atomic_file *file, int error)
{
    if (!file->error) {
        file->error = error ? error : EIO;
    }
}

static void destroy(assay_atomic_file *file)
{
    if (file->fd >= 0) {
        close(file->fd);
    }
    if (file->temporary) {
        unlink(file->temporary);
    }
    assay_release(file->context, file->path);
    assay_release(file->context, file->target);
    assay_release(file->context, file->temporary);
    assay_release(file->context, file);
}

static assay_status fail_write(assay_context *context, const char *path, int error)
{
    return assay_fail(context, ASSAY_ERR_WRITE, "%s: cannot be written: %s", path, strerror(error));
}

/* 0 or an errno.  Writes all or fails; pipes may take less at a time. */
static int write_all(int fd, const uint8_t *bytes, size_t count)
{
    while (count) {
        const ssize_t written = write(fd, bytes, count);
        if (written < 0 && errno != EINTR) {
            return errno;
        }
        if (written == 0) {
            return EIO;
        }
        if (written > 0) {
            bytes += written;
            count -= (size_t)written;
        }
    }
    return 0;
}

static void flush(assay_atomic_file *file)
{
    size_t done = 0;
    while (done < file->used && !file->error) {
        const ssize_t written =
            pwrite(file->fd, file->buffer + done, file->used - done, (off_t)(file->at + done));
        if (written > 0) {
            done += (size_t)written;
        } else if (written == 0 || errno != EINTR) {
            keep_error(file, written == 0 ? EIO : errno);
        }
    }
    file->at += file->used;
    file->used = 0;
}

/* Makes "folder/.assay-PID-n.tmp" beside the target. */
static int open_temporary(assay_atomic_file *file, mode_t mode)
{
    const char  *slash  = strrchr(file->target, '/');
    const size_t folder = slash ? (size_t)(slash - file->target) + 1 : 0;
    const size_t room   = folder + 64;
    file->temporary     = assay_allocate(file->context, room, 1);
    if (!file->temporary) {
        return ENOMEM;
    }
    memcpy(file->temporary, file->target, folder);
    for (int i = 0; i < MAX_ATTEMPTS; i++) {
        snprintf(file->temporary + folder, room - folder, ".assay-%ld-%d.tmp", (long)getpid(), i);
        file->fd = open(file->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (file->fd >= 0) {
            return 0;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    const int error = errno;
    assay_release(file->context, file->temporary);
    file->temporary = NULL;
    return error;
}

/* An unnamed file for a target that cannot be replaced. */
static int open_anonymous(assay_atomic_file *file)
{
    FILE *stream = tmpfile();
    if (!stream) {
        return errno;
    }
    file->fd        = dup(fileno(stream));
    const int error = file->fd < 0 ? errno : 0;
    fclose(stream);
    return error;
}

/* Decides what will be replaced, and opens where to write meanwhile. */
static int open_file(assay_atomic_file *file)
{
    struct stat there;
    if (stat(file->path, &there) != 0) {
        if (errno != ENOENT) {
            return errno;
        }
        file->target = assay_copy_text(file->context, file->path);
        return file->target ? open_temporary(file, 0666) : ENOMEM;
    }
    if (S_ISDIR(there.st_mode)) {
        return EISDIR;
    }
    if (faccessat(AT_FDCWD, file->path, W_OK, AT_EACCESS) != 0) {
        return errno;
    }
    char        resolved[PATH_MAX];
    const char *target = realpath(file->path, resolved);
    file->target       = assay_copy_text(file->context, target ? target : file->path);
    if (!file->target) {
        return ENOMEM;
    }
    if (!S_ISREG(there.st_mode)) {
        return open_anonymous(file);
    }
    const int error = open_temporary(file, 0666);
    if (!error && fchmod(file->fd, there.st_mode & 0777) != 0) {
        return errno;
    }
    return error;
}

assay_status assay_atomic_file_open(assay_context *context, const char *path,
                                    assay_atomic_file **file_out)
{
    assay_atomic_file *file = assay_allocate(context, 1, sizeof *file);
    if (!file) {
        return assay_fail_memory(context, path);
    }
    file->context   = context;
    file->fd        = -1;
    file->path      = assay_copy_text(context, path);
    const int error = file->path ? open_file(file) : ENOMEM;
    if (error) {
        destroy(file);
        return error == ENOMEM ? assay_fail_memory(context, path)
                               : fail_write(context, path, error);
    }
    *file_out = file;
    return ASSAY_OK;
}

void assay_atomic_file_write_at(assay_atomic_file *file, uint64_t offset, const void *bytes,
                                size_t count)
{
    const uint8_t *next = bytes;
    if (offset != file->at + file->used) {
        flush(file);
        file->at = offset;
    }
    while (count && !file->error) {
        const size_t room = BUFFER_BYTES - file->used;
        const size_t part = count < room ? count : room;
        memcpy(file->buffer + file->used, next, part);
        file->used += part;
        next += part;
        count -= part;
        if (file->used == BUFFER_BYTES) {
            flush(file);
        }
    }
    if (file->at + file->used > file->end) {
        file->end = file->at + file->used;
    }
}

void assay_atomic_file_write(assay_atomic_file *file, const void *bytes, size_t count)
{
    assay_atomic_file_write_at(file, file->end, bytes, count);
}

bool assay_atomic_file_failed(const assay_atomic_file *file) { return file->error != 0; }

/* 0 or an errno: all bytes of the anonymous file to the target. */
static int copy_to_target(assay_atomic_file *file)
{
    const int out   = open(file->target, O_WRONLY | O_CLOEXEC);
    int       error = out < 0 ? errno : 0;
    for (uint64_t at = 0; at < file->end && !error;) {
        const ssize_t got = pread(file->fd, file->buffer, BUFFER_BYTES, (off_t)at);
        if (got > 0) {
            error = write_all(out, file->buffer, (size_t)got);
            at += (uint64_t)got;
        } else if (got == 0 || errno != EINTR) {
            error = got == 0 ? EIO : errno;
        }
    }
    if (out >= 0 && close(out) != 0 && !error) {
        error = errno;
    }
    return error;
}

static int replace_target(assay_atomic_file *file)
{
    if (fsync(file->fd) != 0) {
        return errno;
    }
    const int fd = file->fd;
    file->fd     = -1;
    if (close(fd) != 0) {
        return errno;
    }
    if (rename(file->temporary, file->target) != 0) {
        return errno;
    }
    assay_release(file->context, file->temporary);
    file->temporary = NULL;
    return 0;
}

assay_status assay_atomic_file_commit(assay_atomic_file *file)
{
    assay_context *context = file->context;
    assay_status   status  = ASSAY_OK;
    flush(file);
    if (!file->error) {
        file->error = file->temporary ? replace_target(file) : copy_to_target(file);
    }
    if (file->error) {
        status = fail_write(context, file->path, file->error);
    }
    destroy(file);
    return status;
}

void assay_atomic_file_discard(assay_atomic_file *file)
{
    if (file) {
        destroy(file);
    }
}
