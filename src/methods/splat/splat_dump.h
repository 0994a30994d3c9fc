/* splat_dump.h - the steps of algorithm 4 as tables of a bundle, a row a pixel (docs/bundle.md).
 */
#ifndef ASSAY_METHODS_SPLAT_DUMP_H
#define ASSAY_METHODS_SPLAT_DUMP_H

#include "methods/splat/splat_image.h"

/* Zeros may be released. */
typedef struct {
    const splat_image *image;
    const splat_layer *layer;
    const char        *name;
    double            *ends; /* a batch: how many records there were */
    size_t             count, capacity;
} splat_dump;

/* The G-buffer.  Errors: WRITE, MEMORY. */
assay_status splat_dump_begin(const splat_image *image, const splat_layer *layer, const char *name,
                              splat_dump *dump_out);
/* The splat buffer after a batch; a splat_listener whose user is the dump. */
assay_status splat_dump_tell(void *user, const splat_layer *layer, uint32_t end);
/* What became of each pixel, the ends of the batches, and the result. */
assay_status splat_dump_finish(splat_dump *dump);
void         splat_dump_release(splat_dump *dump);

#endif
