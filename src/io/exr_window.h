/* exr_window.h - the two windows of an OpenEXR file: what it holds, and what is shown. */
#ifndef ASSAY_IO_EXR_WINDOW_H
#define ASSAY_IO_EXR_WINDOW_H

#include <OpenEXR/openexr.h>
#include <stdint.h>

#include "assay/context.h"

/* Pixels along one axis of a window whose ends are inclusive; 0 where it is empty. */
static inline uint64_t assay_exr_extent(int32_t minimum, int32_t maximum)
{
    return maximum < minimum ? 0 : (uint64_t)((int64_t)maximum - minimum + 1);
}

/* Errors: FORMAT (empty), LIMIT (larger than an image may be, or a large display window of which
 * the file holds next to nothing), UNSUPPORTED (nothing of the data is shown). */
assay_status assay_exr_check_windows(assay_context *context, const char *name,
                                     const exr_attr_box2i_t *data, const exr_attr_box2i_t *display);

#endif
