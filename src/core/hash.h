/* hash.h - SHA-256 of what was read and made (libmd). */
#ifndef ASSAY_CORE_HASH_H
#define ASSAY_CORE_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include <sha2.h>

typedef SHA2_CTX assay_hash;

void assay_hash_start(assay_hash *hash);
void assay_hash_add(assay_hash *hash, const void *bytes, size_t count);
/* Adds the text and its terminating NUL, so that "ab","c" is not "a","bc". */
void assay_hash_add_text(assay_hash *hash, const char *text);
void assay_hash_finish(assay_hash *hash, char digest_out[65]);

#endif
