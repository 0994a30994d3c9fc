/* exr_job.h - an OpenEXR file that is being read. */
#ifndef ASSAY_IO_EXR_JOB_H
#define ASSAY_IO_EXR_JOB_H

#include <OpenEXR/openexr.h>

#include "io/image_data.h"

typedef struct {
    assay_context           *context;
    const char              *name;
    const uint8_t           *bytes;
    size_t                   count;
    exr_context_t            exr;
    const exr_attr_chlist_t *channels;
    exr_attr_box2i_t         data, display; /* inclusive */
    assay_image             *image;
    const char *const       *wanted;  /* names, up to a NULL; or NULL: all       */
    assay_channel           *targets; /* one a channel of the file, in its order; without data where
                                         it is not wanted */
    assay_status      refused;        /* what there is no memory for, said already */
    exr_compression_t compression;
    bool              deaf; /* what the library says is not kept: several threads are in it */
    char              message[200];
} exr_job;

/* The error of the library's result, with its first message. */
assay_status assay_exr_fail(const exr_job *job, exr_result_t result, const char *where);

/* ---- exr_colour.c ---- */

enum { ASSAY_EXR_COLOUR_NAME = 32, ASSAY_EXR_COLOUR_VALUE = 160 };

/* The attributes chromaticities ("0.64 0.33 ...": x and y of red, green, blue and white) and
 * acesImageContainerFlag as texts, "exr:" before their names; false of any other. */
bool assay_exr_colour_text(const exr_attribute_t *attribute, char name_out[ASSAY_EXR_COLOUR_NAME],
                           char value_out[ASSAY_EXR_COLOUR_VALUE]);

/* ---- exr_chunks.c ---- */

/* All pixels, into the targets.  Errors: FORMAT, MEMORY, UNSUPPORTED. */
assay_status assay_exr_read_chunks(exr_job *job);

#endif
