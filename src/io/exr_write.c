/* exr_write.c - OpenEXR through OpenEXRCore: scan lines, ZIP (16 lines a chunk), 32-bit samples.
 *
 * Invariant: the library never sees a file; what it writes goes to an atomic file, whose own error
 * is the one that is reported.  32-bit samples are kept bit for bit, and a chunk is compressed only
 * where that makes it smaller: every reader takes one of full size as it is. */
#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/context.h"
#include "io/atomic_file.h"
#include "io/image_data.h"

bool assay_image_attribute_reserved(const char *name)
{
    static const char *const reserved[] = {"channels",
                                           "chunkCount",
                                           "compression",
                                           "dataWindow",
                                           "deepImageState",
                                           "displayWindow",
                                           "lineOrder",
                                           "maxSamplesPerPixel",
                                           "name",
                                           "pixelAspectRatio",
                                           "preview",
                                           "screenWindowCenter",
                                           "screenWindowWidth",
                                           "tiles",
                                           "type",
                                           "version"};
    for (size_t i = 0; i < sizeof reserved / sizeof *reserved; i++) {
        if (strcmp(name, reserved[i]) == 0) {
            return true;
        }
    }
    return false;
}

typedef struct {
    const assay_image *image;
    assay_atomic_file *file;
    char               message[200];
} exr_job;

static void on_error(exr_const_context_t exr, exr_result_t code, const char *message)
{
    void *job = NULL;
    (void)code;
    if (exr_get_user_data(exr, &job) == EXR_ERR_SUCCESS && job) {
        snprintf(((exr_job *)job)->message, sizeof((exr_job *)job)->message, "%s", message);
    }
}

static int64_t write_bytes(exr_const_context_t exr, void *user, const void *buffer, uint64_t count,
                           uint64_t offset, exr_stream_error_func_ptr_t error)
{
    const exr_job *job = user;
    (void)exr;
    (void)error;
    assay_atomic_file_write_at(job->file, offset, buffer, count);
    return assay_atomic_file_failed(job->file) ? -1 : (int64_t)count;
}

static exr_result_t define_part(exr_context_t exr, const assay_image *image)
{
    int          part   = 0;
    exr_result_t result = exr_set_longname_support(exr, 1);
    if (result == EXR_ERR_SUCCESS) {
        result = exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part);
    }
    if (result == EXR_ERR_SUCCESS) {
        result = exr_initialize_required_attr_simple(exr, part, image->width, image->height,
                                                     EXR_COMPRESSION_ZIP);
    }
    for (size_t i = 0; i < image->channel_count && result == EXR_ERR_SUCCESS; i++) {
        const assay_channel *channel = &image->channels[i];
        result =
            exr_add_channel(exr, part, channel->name,
                            channel->type == ASSAY_CHANNEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    for (size_t i = 0; i < image->attribute_count && result == EXR_ERR_SUCCESS; i++) {
        result =
            exr_attr_set_string(exr, part, image->attributes[i].name, image->attributes[i].value);
    }
    return result == EXR_ERR_SUCCESS ? exr_write_header(exr) : result;
}

/* The library has the channels in strcmp order, as the image has. */
static void point_at_rows(exr_encode_pipeline_t *encode, const assay_image *image, int y)
{
    for (int c = 0; c < encode->channel_count; c++) {
        exr_coding_channel_info_t *info = &encode->channels[c];
        info->encode_from_ptr           = (const uint8_t *)image->channels[c].data.u32 +
                                (size_t)y * (size_t)image->width * sizeof(uint32_t);
        info->user_bytes_per_element = sizeof(uint32_t);
        info->user_data_type         = info->data_type;
        info->user_pixel_stride      = sizeof(uint32_t);
        info->user_line_stride       = (int32_t)(image->width * (int)sizeof(uint32_t));
    }
}

typedef exr_result_t (*compressor)(exr_encode_pipeline_t *);

/* 3.1 keeps what compression has made as long as before, which nobody can tell from raw samples. */
static exr_result_t compress(exr_encode_pipeline_t *encode)
{
    const compressor  *library = encode->encoding_user_data;
    const exr_result_t result  = (*library)(encode);
    if (result == EXR_ERR_SUCCESS && encode->compressed_bytes == encode->packed_bytes) {
        memcpy(encode->compressed_buffer, encode->packed_buffer, encode->packed_bytes);
    }
    return result;
}

/* Routines are the first chunk's choice, and all others'. */
static exr_result_t choose_routines(exr_context_t exr, exr_encode_pipeline_t *encode,
                                    compressor *library)
{
    const exr_result_t result  = exr_encoding_choose_default_routines(exr, 0, encode);
    *library                   = encode->compress_fn;
    encode->encoding_user_data = library;
    encode->compress_fn        = *library ? compress : NULL;
    return result;
}

static exr_result_t write_pixels(exr_context_t exr, const assay_image *image)
{
    exr_encode_pipeline_t encode  = EXR_ENCODE_PIPELINE_INITIALIZER;
    compressor            library = NULL;
    int32_t               lines   = 0;
    exr_result_t          result  = exr_get_scanlines_per_chunk(exr, 0, &lines);
    for (int y = 0; y < image->height && result == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk;
        result = exr_write_scanline_chunk_info(exr, 0, y, &chunk);
        if (result == EXR_ERR_SUCCESS) {
            result = y == 0 ? exr_encoding_initialize(exr, 0, &chunk, &encode)
                            : exr_encoding_update(exr, 0, &chunk, &encode);
        }
        if (result == EXR_ERR_SUCCESS) {
            point_at_rows(&encode, image, y);
            result = y == 0 ? choose_routines(exr, &encode, &library) : result;
        }
        if (result == EXR_ERR_SUCCESS) {
            result = exr_encoding_run(exr, 0, &encode);
        }
    }
    exr_encoding_destroy(exr, &encode);
    return result;
}

static assay_status write_file(exr_job *job, const char *path)
{
    exr_context_t             exr  = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn          = on_error;
    init.user_data                 = job;
    init.write_fn                  = write_bytes;
    exr_result_t result            = exr_start_write(&exr, path, EXR_WRITE_FILE_DIRECTLY, &init);
    if (result == EXR_ERR_SUCCESS) {
        result = define_part(exr, job->image);
        if (result == EXR_ERR_SUCCESS) {
            result = write_pixels(exr, job->image);
        }
        const exr_result_t finished = exr_finish(&exr);
        result                      = result == EXR_ERR_SUCCESS ? finished : result;
    }
    /* A failed write is told by commit, with the system's words. */
    if (result == EXR_ERR_SUCCESS || assay_atomic_file_failed(job->file)) {
        return ASSAY_OK;
    }
    if (result == EXR_ERR_OUT_OF_MEMORY) {
        return assay_fail_memory(job->image->context, path);
    }
    return assay_fail(job->image->context, ASSAY_ERR_WRITE, "%s: cannot be written: OpenEXR: %s",
                      path, job->message[0] ? job->message : exr_get_default_error_message(result));
}

assay_status assay_image_write_exr(const assay_image *image, const char *path)
{
    exr_job      job    = {.image = image};
    assay_status status = assay_atomic_file_open(image->context, path, &job.file);
    if (status != ASSAY_OK) {
        return status;
    }
    status = write_file(&job, path);
    if (status != ASSAY_OK) {
        assay_atomic_file_discard(job.file);
        return status;
    }
    return assay_atomic_file_commit(job.file);
}
