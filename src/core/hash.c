/* hash.c - SHA-256 through libmd. */
#include "core/hash.h"

#include <string.h>

void assay_hash_start(assay_hash *hash) { SHA256Init(hash); }

void assay_hash_add(assay_hash *hash, const void *bytes, size_t count)
{
    if (count) {
        SHA256Update(hash, bytes, count);
    }
}

void assay_hash_add_text(assay_hash *hash, const char *text)
{
    SHA256Update(hash, (const uint8_t *)text, strlen(text) + 1);
}

void assay_hash_finish(assay_hash *hash, char digest_out[65]) { SHA256End(hash, digest_out); }
