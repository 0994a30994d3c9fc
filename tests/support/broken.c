/* broken.c - see broken.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "broken.h"

#include <stdlib.h>
#include <string.h>

#include "core/random.h"
#include "failing_context.h"

static assay_status read_copy(broken_reader read, const uint8_t *bytes, size_t count)
{
    failing_memory memory  = {0};
    assay_context *context = failing_context(&memory);
    uint8_t       *copy    = malloc(count ? count : 1);
    assert_non_null(copy);
    memcpy(copy, bytes, count);
    const assay_status status = read(context, copy, count);
    free(copy);
    assert_int_equal(memory.live, 1);
    if (status != ASSAY_OK) {
        assert_true(strlen(assay_context_error(context)) > 0);
    }
    assay_context_destroy(context);
    return status;
}

void broken_truncate(broken_reader read, const uint8_t *bytes, size_t count)
{
    for (size_t length = 0; length < count; length++) {
        const assay_status status = read_copy(read, bytes, length);
        if (status != ASSAY_ERR_FORMAT && status != ASSAY_ERR_UNSUPPORTED &&
            status != ASSAY_ERR_LIMIT) {
            fail_msg("cut to %zu of %zu bytes: '%s'", length, count, assay_status_text(status));
        }
    }
}

int broken_flip(broken_reader read, const uint8_t *bytes, size_t count, int times, uint64_t seed)
{
    uint8_t *copy    = malloc(count);
    int      refused = 0;
    assert_non_null(copy);
    for (int i = 0; i < times; i++) {
        assay_random random = assay_random_start(seed, ASSAY_STAGE_TEST, (uint64_t)i, 0);
        const int    flips  = 1 + (int)(8.0 * assay_random_next(&random));
        memcpy(copy, bytes, count);
        for (int k = 0; k < flips; k++) {
            const size_t place = (size_t)((double)count * assay_random_next(&random));
            copy[place] ^= (uint8_t)(1u << (int)(8.0 * assay_random_next(&random)));
        }
        const assay_status status = read_copy(read, copy, count);
        assert_int_not_equal(status, ASSAY_ERR_INTERNAL);
        refused += status != ASSAY_OK;
    }
    free(copy);
    return refused;
}
