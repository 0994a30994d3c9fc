/* exr_window.c - which windows are read.
 *
 * A header may ask for a large picture and give a few pixels of it: some bytes would make hundreds
 * of megabytes of zeros.  From EMPTY_PIXELS on, at least one pixel in EMPTY_SHARE must be there. */
#include "io/exr_window.h"

#include <string.h>

#include "assay/image.h"
#include "core/context.h"

static const uint64_t EMPTY_PIXELS = UINT64_C(1) << 22;
static const uint64_t EMPTY_SHARE  = 256;

static uint64_t width_of(const exr_attr_box2i_t *box)
{
    return assay_exr_extent(box->min.x, box->max.x);
}

static uint64_t height_of(const exr_attr_box2i_t *box)
{
    return assay_exr_extent(box->min.y, box->max.y);
}

static bool is_empty(const exr_attr_box2i_t *box) { return !width_of(box) || !height_of(box); }

static bool is_too_large(const exr_attr_box2i_t *box)
{
    return width_of(box) > ASSAY_IMAGE_MAX_SIDE || height_of(box) > ASSAY_IMAGE_MAX_SIDE ||
           width_of(box) * height_of(box) > ASSAY_IMAGE_MAX_PIXELS;
}

static bool is_hollow(const exr_attr_box2i_t *data, const exr_attr_box2i_t *display)
{
    const uint64_t shown = width_of(display) * height_of(display);
    return shown > EMPTY_PIXELS && shown / EMPTY_SHARE > width_of(data) * height_of(data);
}

assay_status assay_exr_check_windows(assay_context *context, const char *name,
                                     const exr_attr_box2i_t *data, const exr_attr_box2i_t *display)
{
    if (is_empty(data) || is_empty(display)) {
        return assay_fail(context, ASSAY_ERR_FORMAT, "%s: the OpenEXR window is empty", name);
    }
    if (is_too_large(data) || is_too_large(display)) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "%s: the OpenEXR window is larger than %d a side or %u pixels in all",
                          name, ASSAY_IMAGE_MAX_SIDE, ASSAY_IMAGE_MAX_PIXELS);
    }
    if (is_hollow(data, display)) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "%s: the OpenEXR display window is %d x %d, but the data window only "
                          "%d x %d: less than one pixel in %d is there",
                          name, (int)width_of(display), (int)height_of(display),
                          (int)width_of(data), (int)height_of(data), (int)EMPTY_SHARE);
    }
    if (data->max.x < display->min.x || data->min.x > display->max.x ||
        data->max.y < display->min.y || data->min.y > display->max.y) {
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: the OpenEXR data window lies outside the display window", name);
    }
    if (memcmp(data, display, sizeof *data) != 0) {
        assay_inform(context, ASSAY_LOG_WARNING,
                     "%s: the OpenEXR data window is not the display window: pixels outside the "
                     "display window are left out, missing ones are 0",
                     name);
    }
    return ASSAY_OK;
}
