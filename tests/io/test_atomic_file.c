/* test_atomic_file.c - a file is written whole or not at all. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/atomic_file.h"
#include "support/failing_context.h"
#include "support/temporary.h"

static failing_memory memory;
static temporary      folder;

static int set_up(void **state)
{
    folder = temporary_create();
    *state = failing_context(&memory);
    return 0;
}

static int tear_down(void **state)
{
    assert_int_equal(memory.live, 1);
    assay_context_destroy(*state);
    temporary_destroy(&folder);
    return 0;
}

static assay_status write_text(assay_context *context, const char *path, const char *text)
{
    assay_atomic_file *file   = NULL;
    const assay_status status = assay_atomic_file_open(context, path, &file);
    if (status != ASSAY_OK) {
        assert_null(file);
        return status;
    }
    assay_atomic_file_write(file, text, strlen(text));
    return assay_atomic_file_commit(file);
}

static bool holds(const char *path, const void *bytes, size_t count)
{
    size_t     there = 0;
    uint8_t   *read  = temporary_read(path, &there);
    const bool same  = there == count && memcmp(read, bytes, count) == 0;
    free(read);
    return same;
}

static void bytes_arrive_at_commit(void **state)
{
    const char        *path = temporary_path(&folder, "a");
    assay_atomic_file *file = NULL;
    temporary_write(path, "old", 3);
    assert_int_equal(assay_atomic_file_open(*state, path, &file), ASSAY_OK);
    assay_atomic_file_write(file, "new text", 8);
    assert_false(assay_atomic_file_failed(file));
    assert_true(holds(path, "old", 3));
    assert_int_equal(assay_atomic_file_commit(file), ASSAY_OK);
    assert_true(holds(path, "new text", 8));
    assert_false(holds(path, "old", 3));
    assert_int_equal(temporary_count(&folder), 1);
}

static void discarded_files_leave_nothing(void **state)
{
    const char        *path = temporary_path(&folder, "a");
    assay_atomic_file *file = NULL;
    assert_int_equal(assay_atomic_file_open(*state, path, &file), ASSAY_OK);
    assay_atomic_file_write(file, "x", 1);
    assay_atomic_file_discard(file);
    assay_atomic_file_discard(NULL);
    assert_int_equal(temporary_count(&folder), 0);
}

/* Writes of many sizes, in order and at offsets, over the buffer's 64 KiB, against a plain array.
 */
static void offsets_and_long_writes(void **state)
{
    enum { SIZE = 300000 };
    static uint8_t     expected[SIZE], bytes[SIZE];
    assay_atomic_file *file = NULL;
    size_t             at   = 1000;
    memset(expected, 0, sizeof expected);
    for (size_t i = 0; i < SIZE; i++) {
        bytes[i] = (uint8_t)(i * 2654435761u >> 13);
    }
    assert_int_equal(assay_atomic_file_open(*state, temporary_path(&folder, "a"), &file), ASSAY_OK);
    assay_atomic_file_write_at(file, at, bytes, 17);
    memcpy(expected + at, bytes, 17);
    at += 17;
    for (size_t length = 1; at + length < SIZE - 5000; length = length * 3 + 1) {
        assay_atomic_file_write(file, bytes + length % 100, length);
        memcpy(expected + at, bytes + length % 100, length);
        at += length;
    }
    assay_atomic_file_write_at(file, 5, "12345", 5);
    memcpy(expected + 5, "12345", 5);
    assay_atomic_file_write(file, "end", 3);
    memcpy(expected + at, "end", 3);
    assert_int_equal(assay_atomic_file_commit(file), ASSAY_OK);
    assert_true(holds(folder.path, expected, at + 3));
    expected[6] ^= 1;
    assert_false(holds(folder.path, expected, at + 3));
}

static void impossible_places_are_told(void **state)
{
    char path[600];
    snprintf(path, sizeof path, "%s/no/such/file", folder.folder);
    assert_int_equal(write_text(*state, path, "x"), ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), path));
    assert_non_null(strstr(assay_context_error(*state), "No such file or directory"));
    assert_int_equal(write_text(*state, folder.folder, "x"), ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), "Is a directory"));
    temporary_write(temporary_path(&folder, "a"), "old", 3);
    snprintf(path, sizeof path, "%s/a/b", folder.folder);
    assert_int_equal(write_text(*state, path, "x"), ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), "Not a directory"));
    assert_int_equal(write_text(*state, "", "x"), ASSAY_ERR_WRITE);
    memset(path, 'n', sizeof path - 1);
    path[sizeof path - 1] = 0;
    assert_int_equal(write_text(*state, path, "x"), ASSAY_ERR_WRITE);
    assert_int_equal(temporary_count(&folder), 1);
}

/* The superuser may write anywhere, so it becomes somebody else for a while. */
static void permissions_are_respected(void **state)
{
    const char *path = temporary_path(&folder, "a");
    const bool  root = geteuid() == 0;
    struct stat there;
    if (root) {
        assert_int_equal(chown(folder.folder, 65534, 65534), 0);
        assert_int_equal(seteuid(65534), 0);
    }
    temporary_write(path, "old", 3);
    assert_int_equal(chmod(path, 0444), 0);
    assert_int_equal(write_text(*state, path, "new"), ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), "Permission denied"));
    assert_int_equal(chmod(path, 0640), 0);
    assert_int_equal(chmod(folder.folder, 0500), 0);
    assert_int_equal(write_text(*state, path, "new"), ASSAY_ERR_WRITE);
    assert_int_equal(chmod(folder.folder, 0700), 0);
    assert_true(holds(path, "old", 3));
    assert_int_equal(write_text(*state, path, "new"), ASSAY_OK);
    assert_int_equal(stat(path, &there), 0);
    assert_int_equal(there.st_mode & 0777, 0640);
    assert_int_equal(root ? seteuid(0) : 0, 0);
}

static void modes_follow_umask_or_the_old_file(void **state)
{
    struct stat  there;
    const mode_t old = umask(027);
    assert_int_equal(write_text(*state, temporary_path(&folder, "a"), "x"), ASSAY_OK);
    umask(old);
    assert_int_equal(stat(folder.path, &there), 0);
    assert_int_equal(there.st_mode & 0777, 0640);
    assert_int_equal(chmod(folder.path, 0604), 0);
    assert_int_equal(write_text(*state, folder.path, "y"), ASSAY_OK);
    assert_int_equal(stat(folder.path, &there), 0);
    assert_int_equal(there.st_mode & 0777, 0604);
}

static void links_stay_links(void **state)
{
    char        link[600];
    struct stat there;
    temporary_write(temporary_path(&folder, "a"), "old", 3);
    snprintf(link, sizeof link, "%s/link", folder.folder);
    assert_int_equal(symlink(folder.path, link), 0);
    assert_int_equal(write_text(*state, link, "new"), ASSAY_OK);
    assert_int_equal(lstat(link, &there), 0);
    assert_true(S_ISLNK(there.st_mode));
    assert_true(holds(folder.path, "new", 3));
}

/* A limit on the size of files stands for a full disk: the write, not the open, fails. */
static void a_full_disk_leaves_the_old_file(void **state)
{
    static const char long_text[5000] = {[0 ... 4998] = 'x'};
    struct rlimit     old, small;
    const char       *path = temporary_path(&folder, "a");
    temporary_write(path, "old", 3);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &old), 0);
    small                = old;
    small.rlim_cur       = 1000;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const assay_status status = write_text(*state, path, long_text);
    setrlimit(RLIMIT_FSIZE, &old);
    signal(SIGXFSZ, handler);
    assert_int_equal(status, ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), "File too large"));
    assert_true(holds(path, "old", 3));
    assert_int_equal(temporary_count(&folder), 1);
}

static void devices_are_written_through(void **state)
{
    struct stat there;
    assert_int_equal(write_text(*state, "/dev/null", "x"), ASSAY_OK);
    assert_int_equal(stat("/dev/null", &there), 0);
    assert_true(S_ISCHR(there.st_mode));
    assert_int_equal(write_text(*state, "/dev/full", "x"), ASSAY_ERR_WRITE);
    assert_non_null(strstr(assay_context_error(*state), "No space left on device"));
    assert_int_equal(write_text(*state, "/dev/full", ""), ASSAY_OK);
}

static void pipes_are_written_through(void **state)
{
    char        text[8] = {0};
    const char *path    = temporary_path(&folder, "pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    const int end = open(path, O_RDWR);
    assert_true(end >= 0);
    assert_int_equal(write_text(*state, path, "through"), ASSAY_OK);
    assert_int_equal(read(end, text, 7), 7);
    assert_string_equal(text, "through");
    close(end);
}

static assay_status write_short(assay_context *context, void *user)
{
    return write_text(context, user, "text");
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    temporary t = temporary_create();
    assert_int_equal(failing_each(write_short, (void *)temporary_path(&t, "a")), 4);
    assert_int_equal(temporary_count(&t), 1);
    temporary_destroy(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bytes_arrive_at_commit, set_up, tear_down),
        cmocka_unit_test_setup_teardown(discarded_files_leave_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(offsets_and_long_writes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(impossible_places_are_told, set_up, tear_down),
        cmocka_unit_test_setup_teardown(permissions_are_respected, set_up, tear_down),
        cmocka_unit_test_setup_teardown(modes_follow_umask_or_the_old_file, set_up, tear_down),
        cmocka_unit_test_setup_teardown(links_stay_links, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_full_disk_leaves_the_old_file, set_up, tear_down),
        cmocka_unit_test_setup_teardown(devices_are_written_through, set_up, tear_down),
        cmocka_unit_test_setup_teardown(pipes_are_written_through, set_up, tear_down),
        cmocka_unit_test(refused_memory_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
