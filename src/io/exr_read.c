/* exr_read.c - OpenEXR through OpenEXRCore, the C library.
 *
 * The image is the display window.  Where the data window is smaller, the rest is zero, as OpenEXR
 * says; what lies outside the display window is left out.  Both are logged.
 *
 * Invariant: exr_job owns the library's context, and everything the library says arrives in
 * job->message instead of on stderr.  The library only reads, decompresses and parses; the samples
 * are taken out of its decompressed chunk here, since that is where HALF becomes FLOAT and every
 * bit counts.  Its memory is zeroed, so that a chunk that decompresses to too little cannot show
 * what was there before. */
#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/exr_window.h"
#include "io/half.h"
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
    exr_result_t (*decompress)(exr_decode_pipeline_t *); /* the library's choice */
    char message[200];
} exr_job;

/* What one chunk's unpacking has to know. */
typedef struct {
    exr_job *job;
    int32_t  x, y; /* of the chunk's first pixel, in the data window's coordinates */
} chunk_place;

static void *allocate_zeroed(size_t bytes) { return calloc(1, bytes); }

static void on_error(exr_const_context_t exr, exr_result_t code, const char *message)
{
    void *job = NULL;
    (void)code;
    /* The first message is the one that names the cause. */
    if (exr_get_user_data(exr, &job) == EXR_ERR_SUCCESS && job && !((exr_job *)job)->message[0]) {
        snprintf(((exr_job *)job)->message, sizeof((exr_job *)job)->message, "%s", message);
    }
}

static int64_t read_bytes(exr_const_context_t exr, void *user, void *buffer, uint64_t count,
                          uint64_t offset, exr_stream_error_func_ptr_t error)
{
    const exr_job *job = user;
    (void)exr;
    (void)error;
    if (offset >= job->count) {
        return 0;
    }
    const uint64_t left = job->count - offset, part = count < left ? count : left;
    memcpy(buffer, job->bytes + offset, part);
    return (int64_t)part;
}

static int64_t file_size(exr_const_context_t exr, void *user)
{
    (void)exr;
    return (int64_t)((const exr_job *)user)->count;
}

static assay_status fail_exr(const exr_job *job, exr_result_t result, const char *where)
{
    if (job->refused != ASSAY_OK) {
        return job->refused;
    }
    if (result == EXR_ERR_OUT_OF_MEMORY) {
        return assay_fail_memory(job->context, job->name);
    }
    const char *words = job->message[0] ? job->message : exr_get_default_error_message(result);
    return assay_fail(job->context,
                      result == EXR_ERR_FEATURE_NOT_IMPLEMENTED ? ASSAY_ERR_UNSUPPORTED
                                                                : ASSAY_ERR_FORMAT,
                      "%s: OpenEXR %s: %s", job->name, where, words);
}

static const char *compression_name(exr_compression_t compression)
{
    static const char *const names[] = {"none",  "RLE", "ZIPS", "ZIP",  "PIZ",
                                        "PXR24", "B44", "B44A", "DWAA", "DWAB"};
    return (unsigned)compression < sizeof names / sizeof *names ? names[compression] : "unknown";
}

/* What the library would crash on, or what assay does not read. */
static assay_status check_kind(exr_job *job)
{
    int           parts = 0;
    exr_storage_t storage;
    exr_result_t  result = exr_get_count(job->exr, &parts);
    if (result == EXR_ERR_SUCCESS) {
        result = exr_get_storage(job->exr, 0, &storage);
    }
    if (result == EXR_ERR_SUCCESS) {
        result = exr_get_compression(job->exr, 0, &job->compression);
    }
    if (result != EXR_ERR_SUCCESS) {
        return fail_exr(job, result, "header");
    }
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) {
        return assay_fail(job->context, ASSAY_ERR_UNSUPPORTED,
                          "%s: OpenEXR deep data is not read; flatten the image", job->name);
    }
    if (job->compression == EXR_COMPRESSION_DWAA || job->compression == EXR_COMPRESSION_DWAB) {
        return assay_fail(job->context, ASSAY_ERR_UNSUPPORTED,
                          "%s: OpenEXR compression %s is not read; convert the file to ZIP or PIZ",
                          job->name, compression_name(job->compression));
    }
    if (parts > 1) {
        assay_inform(job->context, ASSAY_LOG_WARNING, "%s: only the first of %d parts is read",
                     job->name, parts);
    }
    return ASSAY_OK;
}

static assay_status check_channels(const exr_job *job)
{
    uint64_t bytes = 0;
    for (int i = 0; i < job->channels->num_channels; i++) {
        const exr_attr_chlist_entry_t *channel = &job->channels->entries[i];
        if (channel->x_sampling != 1 || channel->y_sampling != 1) {
            return assay_fail(job->context, ASSAY_ERR_UNSUPPORTED,
                              "%s: channel '%.40s' is subsampled (%d x %d); write it at full "
                              "resolution",
                              job->name, channel->name.str, channel->x_sampling,
                              channel->y_sampling);
        }
        if (channel->pixel_type >= EXR_PIXEL_LAST_TYPE) {
            return assay_fail(job->context, ASSAY_ERR_FORMAT,
                              "%s: channel '%.40s' has an unknown pixel type", job->name,
                              channel->name.str);
        }
        bytes += channel->pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    }
    bytes *= assay_exr_extent(job->data.min.x, job->data.max.x) *
             assay_exr_extent(job->data.min.y, job->data.max.y);
    /* No compression of these gets beyond 1376 : 1 (PXR24: deflate, and 4 bytes from 3). */
    if (bytes / 2048 > job->count) {
        return assay_fail(job->context, ASSAY_ERR_FORMAT,
                          "%s: the OpenEXR file is too short for its pixels", job->name);
    }
    return ASSAY_OK;
}

static assay_status read_header(exr_job *job)
{
    exr_result_t result = exr_get_data_window(job->exr, 0, &job->data);
    if (result == EXR_ERR_SUCCESS) {
        result = exr_get_display_window(job->exr, 0, &job->display);
    }
    if (result == EXR_ERR_SUCCESS) {
        result = exr_get_channels(job->exr, 0, &job->channels);
    }
    if (result != EXR_ERR_SUCCESS) {
        return fail_exr(job, result, "header");
    }
    assay_status status = check_kind(job);
    if (status == ASSAY_OK) {
        status = assay_exr_check_windows(job->context, job->name, &job->data, &job->display);
    }
    return status == ASSAY_OK ? check_channels(job) : status;
}

/* A name that the image refuses is the file's fault. */
static assay_status as_format_error(const exr_job *job, assay_status status)
{
    if (status != ASSAY_ERR_ARGUMENT) {
        return status;
    }
    return assay_fail(job->context, ASSAY_ERR_FORMAT, "%s: OpenEXR header: %s", job->name,
                      assay_context_error(job->context));
}

static bool is_wanted(const exr_job *job, const char *name)
{
    const char *const *wanted = job->wanted;
    while (wanted && *wanted && strcmp(*wanted, name) != 0) {
        wanted++;
    }
    return !wanted || *wanted;
}

/* For all channels at once, so that no memory is filled in vain. */
static assay_status ask_for_memory(const exr_job *job)
{
    uint64_t count = 0;
    for (int i = 0; i < job->channels->num_channels; i++) {
        count += is_wanted(job, job->channels->entries[i].name.str);
    }
    const uint64_t pixels = (uint64_t)job->image->width * (uint64_t)job->image->height;
    return assay_memory_ask(job->context, count * pixels * sizeof(float), job->name);
}

static assay_status make_channels(exr_job *job)
{
    const int count = job->channels->num_channels;
    job->targets    = assay_allocate(job->context, (size_t)count, sizeof *job->targets);
    if (!job->targets) {
        return assay_fail_memory(job->context, job->name);
    }
    const assay_status room = ask_for_memory(job);
    if (room != ASSAY_OK) {
        return room;
    }
    for (int i = 0; i < count; i++) {
        const exr_attr_chlist_entry_t *channel = &job->channels->entries[i];
        if (!is_wanted(job, channel->name.str)) {
            continue;
        }
        const assay_channel_type type =
            channel->pixel_type == EXR_PIXEL_UINT ? ASSAY_CHANNEL_UINT : ASSAY_CHANNEL_FLOAT;
        const assay_status status =
            assay_image_add_channel(job->image, channel->name.str, type, &job->targets[i]);
        if (status != ASSAY_OK) {
            return as_format_error(job, status);
        }
    }
    return ASSAY_OK;
}

static assay_status take_attributes(exr_job *job)
{
    int32_t count = 0;
    exr_get_attribute_count(job->exr, 0, &count);
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *attribute = NULL;
        if (exr_get_attribute_by_index(job->exr, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) !=
                EXR_ERR_SUCCESS ||
            attribute->type != EXR_ATTR_STRING || !attribute->string->str ||
            assay_image_attribute_reserved(attribute->name)) {
            continue;
        }
        const assay_status status =
            assay_image_set_attribute(job->image, attribute->name, attribute->string->str);
        if (status != ASSAY_OK) {
            return as_format_error(job, status);
        }
    }
    return ASSAY_OK;
}

static uint32_t little_endian32(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* A row of one channel, from its packed samples to the part of it that the image shows. */
static void unpack_row(const chunk_place *place, int channel, int32_t row, int32_t width,
                       const uint8_t *packed)
{
    const exr_job      *job    = place->job;
    const assay_channel target = job->targets[channel];
    const int64_t       y      = (int64_t)place->y + row + job->data.min.y - job->display.min.y;
    const int64_t       x      = (int64_t)place->x + job->data.min.x - job->display.min.x;
    const int           image_width = job->image->width;
    if (!target.data.u32 || y < 0 || y >= job->image->height) {
        return;
    }
    const int64_t first = x < 0 ? -x : 0;
    const int64_t last  = x + width > image_width ? image_width - x : width;
    const bool    half  = job->channels->entries[channel].pixel_type == EXR_PIXEL_HALF;
    uint32_t     *out   = target.data.u32 + y * image_width + x;
    for (int64_t i = first; i < last; i++) {
        out[i] = half ? assay_half_to_float_bits((uint16_t)(packed[2 * i] | packed[2 * i + 1] << 8))
                      : little_endian32(packed + 4 * i);
    }
}

/* A decompressed chunk holds, row by row, each channel's samples of that row, lowest byte first. */
static exr_result_t unpack_chunk(exr_decode_pipeline_t *decode)
{
    const chunk_place *place  = decode->decoding_user_data;
    const exr_job     *job    = place->job;
    const uint8_t     *packed = decode->unpacked_buffer;
    const int32_t      width  = decode->chunk.width;
    if (!packed || decode->chunk.packed_size == 0) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    for (int32_t row = 0; row < decode->chunk.height; row++) {
        for (int c = 0; c < job->channels->num_channels; c++) {
            unpack_row(place, c, row, width, packed);
            packed +=
                (size_t)width * (job->channels->entries[c].pixel_type == EXR_PIXEL_HALF ? 2 : 4);
        }
    }
    return EXR_ERR_SUCCESS;
}

/* Bytes of a pixel in a decompressed chunk. */
static uint64_t packed_pixel(const exr_job *job)
{
    uint64_t bytes = 0;
    for (int c = 0; c < job->channels->num_channels; c++) {
        bytes += job->channels->entries[c].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
    }
    return bytes;
}

/* The library makes room for whatever sizes a chunk claims.  So they are held against the file
 * first, which is then to blame, and against the memory there is. */
static exr_result_t check_chunk(exr_job *job, const exr_chunk_info_t *chunk)
{
    const uint64_t expected = (uint64_t)chunk->width * (uint64_t)chunk->height * packed_pixel(job);
    if (chunk->packed_size > job->count || chunk->unpacked_size != expected) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    job->refused = assay_memory_ask(job->context, chunk->packed_size + 2 * expected, job->name);
    return job->refused == ASSAY_OK ? EXR_ERR_SUCCESS : EXR_ERR_OUT_OF_MEMORY;
}

/* B44 that ends too early is "out of memory" to the library.  It is so only where the scratch
 * buffer, which comes first, could not be had. */
static exr_result_t decompress(exr_decode_pipeline_t *decode)
{
    const chunk_place      *place       = decode->decoding_user_data;
    const exr_compression_t compression = place->job->compression;
    const bool b44 = compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
    const exr_result_t result = place->job->decompress(decode);
    return result == EXR_ERR_OUT_OF_MEMORY && b44 && decode->scratch_buffer_1
               ? EXR_ERR_CORRUPT_CHUNK
               : result;
}

static exr_result_t read_chunk(exr_job *job, exr_decode_pipeline_t *decode, bool first,
                               const exr_chunk_info_t *chunk, chunk_place *place)
{
    exr_result_t result = check_chunk(job, chunk);
    if (result != EXR_ERR_SUCCESS) {
        return result;
    }
    result = first ? exr_decoding_initialize(job->exr, 0, chunk, decode)
                   : exr_decoding_update(job->exr, 0, chunk, decode);
    if (result == EXR_ERR_SUCCESS && first) {
        result          = exr_decoding_choose_default_routines(job->exr, 0, decode);
        job->decompress = decode->decompress_fn;
    }
    if (result != EXR_ERR_SUCCESS) {
        return result;
    }
    /* A chunk that compression would not have made smaller is stored as it is; 3.1 forgets that for
     * B44 and would scramble it. */
    const bool raw                = chunk->packed_size == chunk->unpacked_size;
    decode->decompress_fn         = raw || !job->decompress ? NULL : decompress;
    decode->decoding_user_data    = place;
    decode->unpack_and_convert_fn = unpack_chunk;
    return exr_decoding_run(job->exr, 0, decode);
}

static exr_result_t read_scanlines(exr_job *job, exr_decode_pipeline_t *decode)
{
    int32_t      lines  = 0;
    exr_result_t result = exr_get_scanlines_per_chunk(job->exr, 0, &lines);
    for (int64_t y = job->data.min.y; y <= job->data.max.y && result == EXR_ERR_SUCCESS;
         y += lines) {
        exr_chunk_info_t chunk;
        chunk_place      place = {job, 0, (int32_t)(y - job->data.min.y)};
        result                 = exr_read_scanline_chunk_info(job->exr, 0, (int)y, &chunk);
        if (result == EXR_ERR_SUCCESS) {
            result = read_chunk(job, decode, y == job->data.min.y, &chunk, &place);
        }
    }
    return result;
}

static exr_result_t read_tiles(exr_job *job, exr_decode_pipeline_t *decode)
{
    int32_t       tile_width = 0, tile_height = 0;
    const int32_t width  = (int32_t)assay_exr_extent(job->data.min.x, job->data.max.x);
    const int32_t height = (int32_t)assay_exr_extent(job->data.min.y, job->data.max.y);
    exr_result_t  result = exr_get_tile_sizes(job->exr, 0, 0, 0, &tile_width, &tile_height);
    if (result == EXR_ERR_SUCCESS && (tile_width < 1 || tile_height < 1)) {
        result = EXR_ERR_INVALID_ATTR;
    }
    for (int64_t y = 0; y < height && result == EXR_ERR_SUCCESS; y += tile_height) {
        for (int64_t x = 0; x < width && result == EXR_ERR_SUCCESS; x += tile_width) {
            exr_chunk_info_t chunk;
            chunk_place      place = {job, (int32_t)x, (int32_t)y};
            result                 = exr_read_tile_chunk_info(job->exr, 0, (int)(x / tile_width),
                                                              (int)(y / tile_height), 0, 0, &chunk);
            if (result == EXR_ERR_SUCCESS) {
                result = read_chunk(job, decode, x == 0 && y == 0, &chunk, &place);
            }
        }
    }
    return result;
}

static assay_status read_pixels(exr_job *job)
{
    exr_decode_pipeline_t decode  = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_storage_t         storage = EXR_STORAGE_SCANLINE;
    exr_get_storage(job->exr, 0, &storage);
    const exr_result_t result =
        storage == EXR_STORAGE_TILED ? read_tiles(job, &decode) : read_scanlines(job, &decode);
    exr_decoding_destroy(job->exr, &decode);
    return result == EXR_ERR_SUCCESS ? ASSAY_OK : fail_exr(job, result, "pixels");
}

static assay_status read_image(exr_job *job)
{
    assay_status status = read_header(job);
    if (status == ASSAY_OK) {
        status = assay_image_create(
            job->context, (int)assay_exr_extent(job->display.min.x, job->display.max.x),
            (int)assay_exr_extent(job->display.min.y, job->display.max.y), &job->image);
    }
    if (status == ASSAY_OK) {
        status = make_channels(job);
    }
    if (status == ASSAY_OK) {
        status = take_attributes(job);
    }
    return status == ASSAY_OK ? read_pixels(job) : status;
}

assay_status assay_image_decode_exr(assay_context *context, const uint8_t *bytes, size_t count,
                                    const char *name, const char *const *wanted,
                                    assay_image **image_out)
{
    exr_job job = {
        .context = context, .name = name, .bytes = bytes, .count = count, .wanted = wanted};
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn          = on_error;
    init.alloc_fn                  = allocate_zeroed;
    init.free_fn                   = free;
    init.user_data                 = &job;
    init.read_fn                   = read_bytes;
    init.size_fn                   = file_size;
    init.max_image_width           = 1 << 24; /* beyond ours, so that ours is told */
    init.max_image_height          = 1 << 24;
    init.max_tile_width            = ASSAY_IMAGE_MAX_SIDE;
    init.max_tile_height           = ASSAY_IMAGE_MAX_SIDE;
    init.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION | EXR_CONTEXT_FLAG_STRICT_HEADER;

    const exr_result_t result = exr_start_read(&job.exr, name, &init);
    const assay_status status =
        result == EXR_ERR_SUCCESS ? read_image(&job) : fail_exr(&job, result, "header");
    if (result == EXR_ERR_SUCCESS) {
        exr_finish(&job.exr);
    }
    assay_release(context, job.targets);
    if (status != ASSAY_OK) {
        assay_image_destroy(job.image);
        return status;
    }
    *image_out = job.image;
    return ASSAY_OK;
}
