/* heat_map.c - where two images differ, as colours.
 *
 * Invariant: a pixel of the map depends on that pixel of the two images and on the means of their
 * channels alone. */
#include <math.h>

#include "assay/compare.h"
#include "core/alloc.h"
#include "core/context.h"
#include "io/heat_color.h"
#include "io/image_access.h"
#include "oracle/metrics/channel_mean.h"

/* The channels to look at: pairs of a and b. */
typedef struct {
    assay_channel *pairs;
    double        *floors; /* 1e-2 |mean of a| */
    size_t         count;
} channel_pairs;

static void add_pair(channel_pairs *list, const assay_image *a, const assay_image *b,
                     const char *name)
{
    assay_channel *pair = list->pairs + 2 * list->count;
    if (assay_image_find_channel(a, name, &pair[0]) &&
        assay_image_find_channel(b, name, &pair[1]) && pair[0].type == ASSAY_CHANNEL_FLOAT &&
        pair[1].type == ASSAY_CHANNEL_FLOAT) {
        list->floors[list->count] =
            1e-2 * fabs(assay_channel_mean(&pair[0], &pair[1], assay_image_pixels(a)));
        list->count++;
    }
}

static assay_status choose_pairs(const assay_image *a, const assay_image *b, channel_pairs *list)
{
    static const char *const colors[3] = {"R", "G", "B"};
    assay_context           *context   = assay_image_context(a);
    const int                channels  = assay_image_channel_count(a);
    list->pairs  = assay_allocate(context, (size_t)channels + 4, 2 * sizeof *list->pairs);
    list->floors = assay_allocate(context, (size_t)channels + 4, sizeof *list->floors);
    if (!list->pairs || !list->floors) {
        return assay_fail_memory(context, "a heat map");
    }
    for (int c = 0; c < 3; c++) {
        add_pair(list, a, b, colors[c]);
    }
    if (list->count < 3) {
        list->count = 0;
        for (int i = 0; i < channels; i++) {
            add_pair(list, a, b, assay_image_channel_at(a, i).name);
        }
    }
    return list->count ? ASSAY_OK
                       : assay_fail(context, ASSAY_ERR_ARGUMENT,
                                    "the images have no float channel in common");
}

/* Relative difference; not finite in one image only counts as beyond every scale. */
static double pixel_error(const channel_pairs *list, size_t pixel)
{
    double sum = 0.0;
    for (size_t i = 0; i < list->count; i++) {
        const double a = assay_channel_value(&list->pairs[2 * i], pixel);
        const double b = assay_channel_value(&list->pairs[2 * i + 1], pixel);
        if (isfinite(a) && isfinite(b)) {
            const double d = fabs(b - a);
            sum += d == 0.0 ? 0.0 : d / (fabs(a) + list->floors[i]);
        } else if (!(isnan(a) && isnan(b)) && a != b) {
            return INFINITY;
        }
    }
    return sum / (double)list->count;
}

/* Where the errors of a map go: one channel as they are, or three as colours. */
typedef assay_status (*error_writer)(const channel_pairs *list, double full_scale,
                                     assay_image *map);

static assay_status write_numbers(const channel_pairs *list, double full_scale, assay_image *map)
{
    assay_channel      out;
    const assay_status status =
        assay_image_add_channel(map, "RelativeError", ASSAY_CHANNEL_FLOAT, &out);
    (void)full_scale;
    for (size_t i = 0; status == ASSAY_OK && i < assay_image_pixels(map); i++) {
        out.data.f32[i] = (float)pixel_error(list, i);
    }
    return status;
}

static assay_status write_colors(const channel_pairs *list, double full_scale, assay_image *map)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_channel            out[3];
    for (int c = 0; c < 3; c++) {
        const assay_status status =
            assay_image_add_channel(map, names[c], ASSAY_CHANNEL_FLOAT, &out[c]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    for (size_t i = 0; i < assay_image_pixels(map); i++) {
        const assay_rgb color = assay_heat_color(pixel_error(list, i) / full_scale);
        out[0].data.f32[i]    = (float)color.r;
        out[1].data.f32[i]    = (float)color.g;
        out[2].data.f32[i]    = (float)color.b;
    }
    return ASSAY_OK;
}

static assay_status make_map(const assay_image *a, const assay_image *b, error_writer writer,
                             double full_scale, assay_image **map_out)
{
    assay_context *context = assay_image_context(a);
    assay_status   status  = assay_images_check_sizes(a, b);
    if (status != ASSAY_OK) {
        return status;
    }
    channel_pairs list = {0};
    assay_image  *map  = NULL;
    status             = choose_pairs(a, b, &list);
    if (status == ASSAY_OK) {
        status = assay_image_create(context, assay_image_width(a), assay_image_height(a), &map);
    }
    if (status == ASSAY_OK) {
        status = writer(&list, full_scale, map);
    }
    assay_release(context, list.pairs);
    assay_release(context, list.floors);
    if (status != ASSAY_OK) {
        assay_image_destroy(map);
        return status;
    }
    *map_out = map;
    return ASSAY_OK;
}

assay_status assay_image_relative_error(const assay_image *a, const assay_image *b,
                                        assay_image **map_out)
{
    return make_map(a, b, write_numbers, 1.0, map_out);
}

assay_status assay_image_heat_map(const assay_image *a, const assay_image *b, double full_scale,
                                  assay_image **map_out)
{
    if (!(full_scale > 0.0) || isinf(full_scale)) {
        return assay_fail(assay_image_context(a), ASSAY_ERR_ARGUMENT,
                          "the full scale of a heat map is %g; it must be finite and > 0",
                          full_scale);
    }
    return make_map(a, b, write_colors, full_scale, map_out);
}
