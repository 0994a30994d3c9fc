/* image.c - OpenEXR in, by OpenEXRCore: whole scan lines, decoded to floats chunk by chunk. */
#include <OpenEXR/openexr.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "table.h"

/* Which of the listed channels this one is, -1 for none. */
static int place_of(const char *channels, const char *name)
{
    const size_t length = strlen(name);
    int          place  = 0;
    for (const char *at = channels; at; place++) {
        if (strncmp(at, name, length) == 0 && (at[length] == ' ' || at[length] == 0)) {
            return place;
        }
        at = strchr(at, ' ');
        at = at ? at + 1 : NULL;
    }
    return -1;
}

static size_t words_in(const char *text)
{
    size_t words = 1;
    for (; *text; text++) {
        words += *text == ' ';
    }
    return words;
}

static void aim(exr_decode_pipeline_t *pipeline, const char *channels, const table *t,
                size_t first_row)
{
    for (int16_t c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        const int                  place   = place_of(channels, channel->channel_name);
        channel->decode_to_ptr =
            place < 0 ? NULL : (uint8_t *)(table_row(t, first_row) + (size_t)place);
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type         = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride      = (int32_t)(t->columns * sizeof(float));
        channel->user_line_stride       = (int32_t)(t->columns * sizeof(float)) * channel->width;
    }
}

table table_read_exr(const char *path, const char *channels)
{
    exr_context_t             file;
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_attr_box2i_t          window;
    int32_t                   lines;
    if (exr_start_read(&file, path, &settings) != EXR_ERR_SUCCESS ||
        exr_get_data_window(file, 0, &window) != EXR_ERR_SUCCESS ||
        exr_get_scanlines_per_chunk(file, 0, &lines) != EXR_ERR_SUCCESS) {
        fail("%s: not a scan line image", path);
    }
    const size_t width = (size_t)(window.max.x - window.min.x + 1);
    table t = table_make(width * (size_t)(window.max.y - window.min.y + 1), words_in(channels));
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    for (int32_t y = window.min.y; y <= window.max.y; y += lines) {
        exr_chunk_info_t chunk;
        const bool       first  = y == window.min.y;
        int              result = exr_read_scanline_chunk_info(file, 0, y, &chunk);
        result                  = result  ? result
                                  : first ? exr_decoding_initialize(file, 0, &chunk, &pipeline)
                                          : exr_decoding_update(file, 0, &chunk, &pipeline);
        if (result == EXR_ERR_SUCCESS) {
            aim(&pipeline, channels, &t, (size_t)(y - window.min.y) * width);
            result = first ? exr_decoding_choose_default_routines(file, 0, &pipeline) : 0;
        }
        result = result ? result : exr_decoding_run(file, 0, &pipeline);
        if (result != EXR_ERR_SUCCESS) {
            fail("%s: cannot be decoded", path);
        }
    }
    exr_decoding_destroy(file, &pipeline);
    exr_finish(&file);
    return t;
}
