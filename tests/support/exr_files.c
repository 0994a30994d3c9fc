/* exr_files.c - see exr_files.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "exr_files.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    uint8_t *bytes;
    size_t   count, room;
} memory_file;

static int64_t write_bytes(exr_const_context_t exr, void *user, const void *buffer, uint64_t count,
                           uint64_t offset, exr_stream_error_func_ptr_t error)
{
    memory_file *file = user;
    (void)exr;
    (void)error;
    if (offset + count > file->room) {
        file->room  = (offset + count) * 2;
        file->bytes = realloc(file->bytes, file->room);
        assert_non_null(file->bytes);
    }
    memcpy(file->bytes + offset, buffer, count);
    file->count = offset + count > file->count ? offset + count : file->count;
    return (int64_t)count;
}

static void check(exr_result_t result)
{
    if (result != EXR_ERR_SUCCESS) {
        fail_msg("OpenEXR: %s", exr_get_default_error_message(result));
    }
}

static void define_part(exr_context_t exr, const exr_file_spec *spec, int index)
{
    int                    part = 0;
    char                   name[16];
    const exr_attr_v2f_t   centre = {.x = 0.0f, .y = 0.0f};
    const exr_attr_box2i_t data   = {
          {.x = spec->x, .y = spec->y},
          {.x = spec->x + spec->width - 1, .y = spec->y + spec->height - 1}};
    const exr_attr_box2i_t zero            = {{.x = 0}, {.x = 0}};
    const bool             display_is_data = memcmp(&spec->display, &zero, sizeof zero) == 0;
    snprintf(name, sizeof name, "part%d", index);
    const exr_storage_t storage = spec->deep         ? EXR_STORAGE_DEEP_SCANLINE
                                  : spec->tile_width ? EXR_STORAGE_TILED
                                                     : EXR_STORAGE_SCANLINE;
    check(exr_add_part(exr, spec->parts > 1 || spec->deep ? name : NULL, storage, &part));
    check(exr_initialize_required_attr(exr, part, display_is_data ? &data : &spec->display, &data,
                                       1.0f, &centre, 1.0f, EXR_LINEORDER_INCREASING_Y,
                                       spec->compression));
    if (spec->tile_width) {
        check(exr_set_tile_descriptor(
            exr, part, (uint32_t)spec->tile_width, (uint32_t)spec->tile_height,
            spec->mipmap ? EXR_TILE_MIPMAP_LEVELS : EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN));
    }
    for (int c = 0; c < spec->channel_count; c++) {
        const int sampling = spec->channels[c].sampling ? spec->channels[c].sampling : 1;
        check(exr_add_channel(exr, part, spec->channels[c].name, spec->channels[c].type,
                              EXR_PERCEPTUALLY_LOGARITHMIC, sampling, sampling));
    }
    if (spec->chromaticities) {
        check(exr_attr_set_chromaticities(exr, part, "chromaticities", spec->chromaticities));
    }
    if (spec->aces) {
        check(exr_attr_set_int(exr, part, "acesImageContainerFlag", spec->aces));
    }
    if (spec->deep) {
        check(exr_set_version(exr, part, 1));
    }
}

static void point_at(exr_encode_pipeline_t *encode, const exr_file_spec *spec, int x, int y)
{
    for (int c = 0; c < encode->channel_count; c++) {
        const int                  bytes = spec->channels[c].type == EXR_PIXEL_HALF ? 2 : 4;
        exr_coding_channel_info_t *info  = &encode->channels[c];
        info->encode_from_ptr            = (const uint8_t *)spec->channels[c].samples +
                                ((size_t)y * (size_t)spec->width + (size_t)x) * (size_t)bytes;
        info->user_bytes_per_element = (int16_t)bytes;
        info->user_data_type         = info->data_type;
        info->user_pixel_stride      = bytes;
        info->user_line_stride       = spec->width * bytes;
    }
}

static void write_chunk(exr_context_t exr, const exr_file_spec *spec, int part,
                        const exr_chunk_info_t *chunk, int x, int y)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    check(exr_encoding_initialize(exr, part, chunk, &encode));
    point_at(&encode, spec, x, y);
    check(exr_encoding_choose_default_routines(exr, part, &encode));
    check(exr_encoding_run(exr, part, &encode));
    exr_encoding_destroy(exr, &encode);
}

/* Higher levels show the corner of level 0. */
static void write_level(exr_context_t exr, const exr_file_spec *spec, int part, int level)
{
    const int width  = spec->width >> level > 1 ? spec->width >> level : 1;
    const int height = spec->height >> level > 1 ? spec->height >> level : 1;
    for (int y = 0; y < height; y += spec->tile_height) {
        for (int x = 0; x < width; x += spec->tile_width) {
            exr_chunk_info_t chunk;
            check(exr_write_tile_chunk_info(exr, part, x / spec->tile_width, y / spec->tile_height,
                                            level, level, &chunk));
            write_chunk(exr, spec, part, &chunk, x, y);
        }
    }
}

static void write_part(exr_context_t exr, const exr_file_spec *spec, int part)
{
    exr_chunk_info_t chunk;
    int32_t          lines = 0;
    if (spec->tile_width) {
        for (int level = 0; spec->mipmap ? (spec->width | spec->height) >> level : level == 0;
             level++) {
            write_level(exr, spec, part, level);
        }
        return;
    }
    check(exr_get_scanlines_per_chunk(exr, part, &lines));
    for (int y = 0; y < spec->height; y += lines) {
        check(exr_write_scanline_chunk_info(exr, part, spec->y + y, &chunk));
        write_chunk(exr, spec, part, &chunk, 0, y);
    }
}

static void be_silent(exr_const_context_t exr, exr_result_t code, const char *message)
{
    (void)exr;
    (void)code;
    (void)message;
}

uint8_t *exr_file_bytes(const exr_file_spec *spec, size_t *count_out)
{
    memory_file               file  = {0};
    exr_context_t             exr   = NULL;
    exr_context_initializer_t init  = EXR_DEFAULT_CONTEXT_INITIALIZER;
    const int                 parts = spec->parts ? spec->parts : 1;
    init.user_data                  = &file;
    init.write_fn                   = write_bytes;
    init.error_handler_fn           = be_silent;
    check(exr_start_write(&exr, "memory", EXR_WRITE_FILE_DIRECTLY, &init));
    for (int i = 0; i < parts; i++) {
        define_part(exr, spec, i);
    }
    check(exr_write_header(exr));
    for (int i = 0; i < parts && !spec->deep && !spec->channels[0].sampling; i++) {
        write_part(exr, spec, i);
    }
    exr_finish(&exr);
    *count_out = file.count;
    return file.bytes;
}
