/* test_memory_budget.c - what a context counts, what it refuses, and what the machine says it has.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/machine_memory.h"
#include "core/parallel.h"
#include "support/temporary.h"

static const uint64_t MEBIBYTE = UINT64_C(1) << 20;

static assay_context *limited(uint64_t limit, int threads)
{
    const assay_context_options options = {.threads = threads, .memory_limit = limit};
    assay_context              *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    return context;
}

static void blocks_are_counted(void **state)
{
    (void)state;
    assay_context *context = limited(MEBIBYTE, 1);
    assert_int_equal(assay_context_memory_limit(context), MEBIBYTE);
    assert_int_equal(assay_context_memory_used(context), 0);
    void          *a    = assay_allocate(context, 1000, 100);
    const uint64_t once = assay_context_memory_used(context);
    assert_in_range(once, 100000, 100000 + 128);
    void *b = assay_allocate(context, 1, 100000);
    assert_int_equal(assay_context_memory_used(context), 2 * once);
    assay_release(context, a);
    assert_int_equal(assay_context_memory_used(context), once);
    void  *array    = NULL;
    size_t capacity = 0;
    for (size_t n = 1; n < 5000; n++) {
        assert_int_equal(assay_grow(context, &array, &capacity, n, 1), ASSAY_OK);
    }
    assert_in_range(assay_context_memory_used(context), once + 4999, once + 3 * 5000);
    assay_release(context, array);
    assay_release(context, b);
    assert_int_equal(assay_context_memory_used(context), 0);
    assay_context_destroy(context);
}

static void the_limit_holds(void **state)
{
    (void)state;
    assay_context *context = limited(MEBIBYTE, 1);
    assert_null(assay_allocate(context, 1, MEBIBYTE));
    void *half = assay_allocate(context, 1, MEBIBYTE / 2);
    assert_non_null(half);
    assert_null(assay_allocate(context, 1, MEBIBYTE / 2));
    assert_int_equal(assay_fail_memory(context, "a half"), ASSAY_ERR_MEMORY);
    assert_string_equal(assay_context_error(context), "out of memory for a half: it needs 512 KiB, "
                                                      "and 512 KiB are left of a limit of 1 MiB");
    /* Only the refusal that was just told is told. */
    assert_int_equal(assay_fail_memory(context, "a foreign block"), ASSAY_ERR_MEMORY);
    assert_string_equal(assay_context_error(context), "out of memory for a foreign block");
    void *rest = assay_allocate(context, 1, MEBIBYTE / 2 - 256);
    assert_non_null(rest);
    assay_release(context, rest);
    assay_release(context, half);
    void *most = assay_allocate(context, 1, MEBIBYTE - 128);
    assert_non_null(most);
    assay_release(context, most);
    assay_context_destroy(context);
}

static void asking_and_charging(void **state)
{
    (void)state;
    assay_context *context = limited(3 * MEBIBYTE, 1);
    assert_int_equal(assay_memory_ask(context, 3 * MEBIBYTE, "all"), ASSAY_OK);
    assert_int_equal(assay_context_memory_used(context), 0);
    assert_int_equal(assay_memory_ask(context, 3 * MEBIBYTE + 1, "more"), ASSAY_ERR_MEMORY);
    assert_non_null(strstr(assay_context_error(context), "more: it needs 3 MiB, and 3 MiB are"));
    assert_int_equal(assay_memory_ask(context, UINT64_MAX, "all there is"), ASSAY_ERR_MEMORY);
    assert_non_null(strstr(assay_context_error(context), "it needs 16 EiB"));
    assert_true(assay_memory_charge(context, 2 * MEBIBYTE));
    assert_false(assay_memory_charge(context, 2 * MEBIBYTE));
    assert_null(assay_allocate(context, 1, MEBIBYTE));
    assert_int_equal(assay_memory_ask(context, MEBIBYTE, "the rest"), ASSAY_OK);
    assay_memory_discharge(context, 2 * MEBIBYTE);
    assert_int_equal(assay_context_memory_used(context), 0);
    assay_context_destroy(context);
}

static void no_limit(void **state)
{
    (void)state;
    assay_context *context = limited(UINT64_MAX, 1);
    assert_int_equal(assay_memory_ask(context, UINT64_MAX / 2, "anything"), ASSAY_OK);
    void *block = assay_allocate(context, 1, 100);
    assert_non_null(block);
    assay_release(context, block);
    assay_context_destroy(context);
    /* Without options: something of the machine, whatever it has. */
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    assert_true(assay_context_memory_limit(context) > 0);
    assay_context_destroy(context);
}

static void *refuse(void *user, size_t bytes)
{
    return bytes == *(size_t *)user ? NULL : malloc(bytes);
}

static void give_back(void *user, void *memory)
{
    (void)user;
    free(memory);
}

/* A block that the caller's own allocator refuses is not counted, and the words say who refused. */
static void the_allocator_refuses(void **state)
{
    (void)state;
    enum { BYTES = 4096, HEAD = 80 };
    size_t                      bad     = BYTES + HEAD;
    const assay_context_options options = {
        .threads = 1, .allocator = {refuse, give_back, &bad}, .memory_limit = MEBIBYTE};
    assay_context *context = NULL;
    assert_int_equal(assay_context_create(&options, &context), ASSAY_OK);
    assert_null(assay_allocate(context, 1, BYTES));
    assert_int_equal(assay_context_memory_used(context), 0);
    assert_int_equal(assay_fail_memory(context, "x"), ASSAY_ERR_MEMORY);
    assert_non_null(strstr(assay_context_error(context), "the system refuses 4.08 KiB"));
    assay_context_destroy(context);
}

/* ---- several threads ---- */

enum { ITEMS = 20000, BLOCK = 1000 };

static assay_status take_and_return(void *user, uint64_t index, int worker)
{
    assay_context *context = user;
    (void)worker;
    char *block = assay_allocate(context, 1, BLOCK + index % 7);
    if (block) {
        block[0] = 1;
    }
    assay_release(context, block);
    return assay_context_memory_used(context) <= assay_context_memory_limit(context)
               ? ASSAY_OK
               : ASSAY_ERR_INTERNAL;
}

/* There is room for two blocks and four threads want one each: the sum is never above the limit,
 * and nothing is left of it. */
static void threads_count_together(void **state)
{
    (void)state;
    assay_context *context = limited(2 * (BLOCK + 100), 4);
    assert_int_equal(assay_parallel_for(context, NULL, ITEMS, take_and_return, context), ASSAY_OK);
    assert_int_equal(assay_context_memory_used(context), 0);
    assay_context_destroy(context);
}

/* ---- the machine ---- */

static void put(const char *root, const char *path, const char *text)
{
    char whole[512], command[600];
    snprintf(whole, sizeof whole, "%s%s", root, path);
    snprintf(command, sizeof command, "mkdir -p \"$(dirname '%s')\"", whole);
    assert_int_equal(system(command), 0);
    FILE *file = fopen(whole, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static void fresh(char *root, size_t size, const char *meminfo, const char *cgroup)
{
    const temporary folder = temporary_create();
    snprintf(root, size, "%s", folder.folder);
    put(root, "/proc/meminfo", meminfo);
    put(root, "/proc/self/cgroup", cgroup);
}

static void drop(const char *root)
{
    char command[600];
    snprintf(command, sizeof command, "rm -r '%s'", root);
    assert_int_equal(system(command), 0);
}

static const char MEMINFO[] = "MemTotal:       16000000 kB\n"
                              "MemFree:         1000000 kB\n"
                              "MemAvailable:    8000000 kB\n";

static void machine_alone(void **state)
{
    (void)state;
    char root[256];
    assert_true(assay_machine_memory("/there/is/no/such/folder") == ASSAY_MEMORY_UNKNOWN);
    fresh(root, sizeof root, MEMINFO, "0::/\n");
    assert_true(assay_machine_memory(root) == UINT64_C(8000000) * 1024);
    drop(root);
    fresh(root, sizeof root, "MemTotal: 16000000 kB\n", "");
    assert_true(assay_machine_memory(root) == ASSAY_MEMORY_UNKNOWN);
    drop(root);
}

/* Version 2: the group's own limit is "max", the one above it says 1000 MiB, of which 700 are used,
 * 300 of them an inactive page cache. */
static void groups_of_version_2(void **state)
{
    (void)state;
    char root[256];
    fresh(root, sizeof root, MEMINFO, "0::/user/job\n");
    put(root, "/sys/fs/cgroup/user/job/memory.max", "max\n");
    put(root, "/sys/fs/cgroup/user/job/memory.current", "1000\n");
    assert_true(assay_machine_memory(root) == UINT64_C(8000000) * 1024);
    put(root, "/sys/fs/cgroup/user/memory.max", "1048576000\n");
    put(root, "/sys/fs/cgroup/user/memory.current", "734003200\n");
    put(root, "/sys/fs/cgroup/user/memory.stat",
        "anon 1\ninactive_file_other 5\ninactive_file 314572800\n");
    assert_true(assay_machine_memory(root) == 600 * MEBIBYTE);
    /* In a container its own group is the root of what is seen. */
    put(root, "/sys/fs/cgroup/memory.max", "104857600\n");
    put(root, "/sys/fs/cgroup/memory.current", "0\n");
    assert_true(assay_machine_memory(root) == 100 * MEBIBYTE);
    put(root, "/sys/fs/cgroup/memory.current", "204857600\n");
    assert_true(assay_machine_memory(root) == 0);
    drop(root);
}

static void groups_of_version_1(void **state)
{
    (void)state;
    char root[256];
    fresh(root, sizeof root, MEMINFO, "9:cpu,memoryless:/a\n4:memory:/job\n0::/\n");
    put(root, "/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    put(root, "/sys/fs/cgroup/memory/memory.usage_in_bytes", "5000\n");
    assert_true(assay_machine_memory(root) == UINT64_C(8000000) * 1024);
    put(root, "/sys/fs/cgroup/memory/job/memory.limit_in_bytes", "1048576000\n");
    put(root, "/sys/fs/cgroup/memory/job/memory.usage_in_bytes", "524288000\n");
    put(root, "/sys/fs/cgroup/memory/job/memory.stat", "inactive_file 7\ntotal_inactive_file 0\n");
    assert_true(assay_machine_memory(root) == 500 * MEBIBYTE);
    drop(root);
}

static void budget_leaves_a_reserve(void **state)
{
    (void)state;
    assert_true(assay_machine_memory_budget(ASSAY_MEMORY_UNKNOWN) == UINT64_MAX);
    assert_true(assay_machine_memory_budget(16384 * MEBIBYTE) == 15360 * MEBIBYTE);
    assert_true(assay_machine_memory_budget(512 * MEBIBYTE) == 448 * MEBIBYTE);
    assert_true(assay_machine_memory_budget(100 * MEBIBYTE) == 50 * MEBIBYTE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_counted),    cmocka_unit_test(the_limit_holds),
        cmocka_unit_test(asking_and_charging),   cmocka_unit_test(no_limit),
        cmocka_unit_test(the_allocator_refuses), cmocka_unit_test(threads_count_together),
        cmocka_unit_test(machine_alone),         cmocka_unit_test(groups_of_version_2),
        cmocka_unit_test(groups_of_version_1),   cmocka_unit_test(budget_leaves_a_reserve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
