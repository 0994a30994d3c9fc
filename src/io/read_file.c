/* read_file.c - the file is opened first and looked at through its descriptor, so that what was
 * checked is what is read; O_NONBLOCK keeps open() from waiting for a pipe's other end.
 *
 * Files are read instead of mapped: a mapped file that somebody shortens ends the program. */
#include "io/read_file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/alloc.h"
#include "core/context.h"

static assay_status fail_read(assay_context *context, const char *path, int error)
{
    return assay_fail(context, ASSAY_ERR_NOT_FOUND, "%s: cannot be read: %s", path,
                      strerror(error));
}

static assay_status check_file(assay_context *context, const char *path, int fd, uint64_t limit,
                               size_t *size_out)
{
    struct stat there;
    if (fstat(fd, &there) != 0) {
        return fail_read(context, path, errno);
    }
    if (S_ISDIR(there.st_mode)) {
        return fail_read(context, path, EISDIR);
    }
    if (!S_ISREG(there.st_mode)) {
        return assay_fail(context, ASSAY_ERR_NOT_FOUND,
                          "%s: cannot be read: not a regular file; copy it to one", path);
    }
    if ((uint64_t)there.st_size > limit) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "%s: the file has %lld bytes; at most %llu are read", path,
                          (long long)there.st_size, (unsigned long long)limit);
    }
    *size_out = (size_t)there.st_size;
    return ASSAY_OK;
}

/* Reads until the end or until size bytes; a file that shrank meanwhile gives fewer. */
static assay_status read_all(assay_context *context, const char *path, int fd, uint8_t *bytes,
                             size_t size, size_t *count_out)
{
    size_t count = 0;
    while (count < size) {
        const ssize_t got = read(fd, bytes + count, size - count);
        if (got == 0) {
            break;
        }
        if (got < 0 && errno != EINTR) {
            return fail_read(context, path, errno);
        }
        count += got > 0 ? (size_t)got : 0;
    }
    *count_out = count;
    return ASSAY_OK;
}

assay_status assay_read_file(assay_context *context, const char *path, uint64_t limit,
                             uint8_t **bytes_out, size_t *count_out)
{
    if (!*path) {
        return assay_fail(context, ASSAY_ERR_NOT_FOUND, "the name of a file is empty");
    }
    const int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (fd < 0) {
        return fail_read(context, path, errno);
    }
    size_t       size   = 0;
    size_t       count  = 0;
    uint8_t     *bytes  = NULL;
    assay_status status = check_file(context, path, fd, limit, &size);
    if (status == ASSAY_OK) {
        bytes  = assay_allocate(context, size, 1);
        status = bytes ? read_all(context, path, fd, bytes, size, &count)
                       : assay_fail_memory(context, path);
    }
    close(fd);
    if (status != ASSAY_OK) {
        assay_release(context, bytes);
        return status;
    }
    *bytes_out = bytes;
    *count_out = count;
    return ASSAY_OK;
}
