/* exr_colour.c - what an OpenEXR header says of its colours in other types than text.
 *
 * Invariant: a number in the text reads back to the same bits.
 *
 * The names get a prefix, since a text of the standard's own name would be of the wrong type once
 * the image is written again. */
#include <stdio.h>
#include <string.h>

#include "io/exr_job.h"

bool assay_exr_colour_text(const exr_attribute_t *attribute, char name_out[ASSAY_EXR_COLOUR_NAME],
                           char value_out[ASSAY_EXR_COLOUR_VALUE])
{
    if (attribute->type == EXR_ATTR_CHROMATICITIES &&
        strcmp(attribute->name, "chromaticities") == 0) {
        const exr_attr_chromaticities_t *c = attribute->chromaticities;
        snprintf(value_out, ASSAY_EXR_COLOUR_VALUE, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g",
                 (double)c->red_x, (double)c->red_y, (double)c->green_x, (double)c->green_y,
                 (double)c->blue_x, (double)c->blue_y, (double)c->white_x, (double)c->white_y);
    } else if (attribute->type == EXR_ATTR_INT &&
               strcmp(attribute->name, "acesImageContainerFlag") == 0) {
        snprintf(value_out, ASSAY_EXR_COLOUR_VALUE, "%d", (int)attribute->i);
    } else {
        return false;
    }
    snprintf(name_out, ASSAY_EXR_COLOUR_NAME, "exr:%s", attribute->name);
    return true;
}
