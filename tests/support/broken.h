/* broken.h - what readers must survive: files cut at every length, and files with flipped bits. */
#ifndef ASSAY_TESTS_BROKEN_H
#define ASSAY_TESTS_BROKEN_H

#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

/* Reads bytes and releases what it made. */
typedef assay_status (*broken_reader)(assay_context *context, const uint8_t *bytes, size_t count);

/* Every proper prefix must be refused, with a message, with one of FORMAT, UNSUPPORTED or LIMIT,
 * and without a block left.  Each prefix lies at the end of its own heap block, so that a sanitizer
 * sees reading past it. */
void broken_truncate(broken_reader read, const uint8_t *bytes, size_t count);

/* Flips 1 to 8 bits at places from a counter-based generator, `times` times: any answer but a
 * crash, a leak or ASSAY_ERR_INTERNAL.  Returns how many were refused. */
int broken_flip(broken_reader read, const uint8_t *bytes, size_t count, int times, uint64_t seed);

#endif
