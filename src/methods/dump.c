/* dump.c - from the layers of an image to the arrays of a bundle. */
#include "methods/dump.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *layer;    /* what stands before the channel's last letters */
    const char *channels; /* those letters, separated by a blank           */
    const char *name, *unit;
} ARRAYS[] = {
    {"", "R G B", "radiance/total", "W/(m2 sr)"},
    {"Direct.", "R G B", "radiance/direct", "W/(m2 sr)"},
    {"Indirect.", "R G B", "radiance/indirect", "W/(m2 sr)"},
    {"", "SampleCount", "radiance/samples", ""},
    {"Irradiance.", "R G B", "irradiance/total", "W/m2"},
    {"IrradianceDirect.", "R G B", "irradiance/direct", "W/m2"},
    {"IrradianceIndirect.", "R G B", "irradiance/indirect", "W/m2"},
    {"SampleCount.", "Irradiance", "irradiance/samples", ""},
    {"P.", "X Y Z", "gbuffer/position", "m"},
    {"N.", "X Y Z", "gbuffer/normal", ""},
    {"Ns.", "X Y Z", "gbuffer/shading_normal", ""},
    {"", "Z", "gbuffer/depth", "m"},
    {"Albedo.", "R G B", "gbuffer/albedo", ""},
    {"UV.", "U V", "gbuffer/uv", ""},
    {"", "MaterialId", "gbuffer/material", ""},
    {"", "PrimitiveId", "gbuffer/primitive", ""},
};

enum { NAME_SIZE = 128 };

/* Copies channel SOURCE of the image as NAME of the part; nothing where there is no such channel.
 */
static assay_status copy_channel(const assay_image *image, const char *source, const char *name,
                                 assay_image *part)
{
    assay_channel from, to;
    if (!assay_image_find_channel(image, source, &from)) {
        return ASSAY_OK;
    }
    const assay_status status = assay_image_add_channel(part, name, from.type, &to);
    if (status == ASSAY_OK) {
        const size_t pixels = (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
        memcpy(to.data.f32, from.data.f32, pixels * sizeof *to.data.f32);
    }
    return status;
}

/* The channels PREFIX + LAYER + each of the listed ones, as an image of their own. */
static assay_status take_part(const assay_image *image, const char *prefix, size_t array,
                              assay_image *part)
{
    char letters[NAME_SIZE];
    snprintf(letters, sizeof letters, "%s", ARRAYS[array].channels);
    char        *rest   = letters;
    assay_status status = ASSAY_OK;
    for (char *one; status == ASSAY_OK && (one = strsep(&rest, " "));) {
        char source[NAME_SIZE];
        snprintf(source, sizeof source, "%s%s%s", prefix, ARRAYS[array].layer, one);
        status = copy_channel(image, source, one, part);
    }
    return status;
}

static assay_status add_array(assay_context *context, const assay_image *image, const char *prefix,
                              const char *suffix, size_t array, assay_bundle *bundle)
{
    assay_image *part = NULL;
    assay_status status =
        assay_image_create(context, assay_image_width(image), assay_image_height(image), &part);
    if (status == ASSAY_OK) {
        status = take_part(image, prefix, array, part);
    }
    if (status == ASSAY_OK && assay_image_channel_count(part) > 0) {
        char        name[NAME_SIZE], unit[NAME_SIZE];
        const char *plain = ARRAYS[array].unit;
        snprintf(name, sizeof name, "%s%s", ARRAYS[array].name, suffix);
        snprintf(unit, sizeof unit, *suffix ? "(%s)^2" : "%s", plain);
        status = assay_bundle_add_image(bundle, name, unit, part);
    }
    assay_image_destroy(part);
    return status;
}

assay_status assay_dump_image(assay_context *context, const assay_image *image,
                              assay_bundle *bundle)
{
    assay_status status = ASSAY_OK;
    for (int i = 0; status == ASSAY_OK && i < assay_image_attribute_count(image); i++) {
        const char *name, *value;
        assay_image_attribute_at(image, i, &name, &value);
        status = assay_bundle_describe(bundle, name, value);
    }
    for (size_t i = 0; status == ASSAY_OK && i < sizeof ARRAYS / sizeof ARRAYS[0]; i++) {
        status = add_array(context, image, "", "", i, bundle);
        if (status == ASSAY_OK) {
            status = add_array(context, image, "Variance.", "_variance", i, bundle);
        }
    }
    return status;
}
