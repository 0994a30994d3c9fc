/* exr_chunks.c - the pixels of an OpenEXR file, chunk by chunk, on all threads.
 *
 * The library only reads and decompresses (but for ZIP, exr_zip.c); the samples are taken out of
 * its decompressed chunk here, since that is where HALF becomes FLOAT and every bit counts.
 *
 * Invariant: chunks share no pixel, so their order changes nothing.  Threads in the library would
 * mix up its messages, so nothing that fails is reported by them: then the chunks are read again,
 * one after the other, and the first one that fails says why. */
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "io/exr_job.h"
#include "io/exr_window.h"
#include "io/exr_zip.h"
#include "io/half.h"

/* How the part is cut: rows of chunks; of scan lines one a row. */
typedef struct {
    bool    tiled;
    int32_t width, height; /* of a chunk */
    int64_t columns, rows;
} chunk_grid;

/* A thread's own. */
typedef struct {
    exr_job              *job;
    exr_decode_pipeline_t decode;
    bool                  begun;
    exr_result_t (*decompress)(exr_decode_pipeline_t *); /* the library's choice */
    /* Of ZIP, made when it is needed. */
    struct libdeflate_decompressor *inflater;
    uint8_t                        *samples, *sorted;
    size_t                          room; /* bytes of either */
    int32_t x, y; /* of the chunk's first pixel, in the data window's coordinates */
} chunk_reader;

/* ---- out of a chunk ---- */

static bool is_zipped(const exr_job *job)
{
    return job->compression == EXR_COMPRESSION_ZIP || job->compression == EXR_COMPRESSION_ZIPS;
}

static uint32_t little_endian32(const uint8_t *b)
{
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

/* A row of one channel, from its packed samples to the part of it that the image shows. */
static void unpack_row(const chunk_reader *reader, int channel, int32_t row, int32_t width,
                       const uint8_t *packed)
{
    const exr_job      *job    = reader->job;
    const assay_channel target = job->targets[channel];
    const int64_t       y      = (int64_t)reader->y + row + job->data.min.y - job->display.min.y;
    const int64_t       x      = (int64_t)reader->x + job->data.min.x - job->display.min.x;
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

static int sample_bytes(const exr_job *job, int channel)
{
    return job->channels->entries[channel].pixel_type == EXR_PIXEL_HALF ? 2 : 4;
}

/* A decompressed chunk holds, row by row, each channel's samples of that row, lowest byte first. */
static exr_result_t unpack_chunk(exr_decode_pipeline_t *decode)
{
    const chunk_reader *reader = decode->decoding_user_data;
    const exr_job      *job    = reader->job;
    const uint8_t      *packed = is_zipped(job) ? reader->samples : decode->unpacked_buffer;
    const int32_t       width  = decode->chunk.width;
    if (!packed || decode->chunk.packed_size == 0) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    for (int32_t row = 0; row < decode->chunk.height; row++) {
        for (int c = 0; c < job->channels->num_channels; c++) {
            unpack_row(reader, c, row, width, packed);
            packed += (size_t)width * (size_t)sample_bytes(job, c);
        }
    }
    return EXR_ERR_SUCCESS;
}

/* ---- a chunk ---- */

/* The library's own buffers may be one and the same where a chunk is stored as it is: so the
 * samples have a place of their own. */
static bool make_room(chunk_reader *reader, size_t size)
{
    if (reader->room < size) {
        free(reader->samples);
        free(reader->sorted);
        reader->samples = calloc(1, size);
        reader->sorted  = calloc(1, size);
        reader->room    = reader->samples && reader->sorted ? size : 0;
    }
    if (!reader->inflater) {
        reader->inflater = libdeflate_alloc_decompressor();
    }
    return reader->inflater && reader->room >= size;
}

static exr_result_t unzip(exr_decode_pipeline_t *decode)
{
    chunk_reader *reader = decode->decoding_user_data;
    const size_t  size = decode->chunk.unpacked_size, packed = decode->chunk.packed_size;
    if (!make_room(reader, size)) {
        return EXR_ERR_OUT_OF_MEMORY;
    }
    /* What compression would not have made smaller is stored as it is.  3.1 also stores streams
     * that are just as long, which only their check sums tell from samples. */
    if (!assay_exr_unzip(reader->inflater, decode->packed_buffer, packed, reader->sorted,
                         reader->samples, size)) {
        if (packed != size) {
            return EXR_ERR_CORRUPT_CHUNK;
        }
        memcpy(reader->samples, decode->packed_buffer, size);
    }
    return EXR_ERR_SUCCESS;
}

/* B44 that ends too early is "out of memory" to the library.  It is so only where the scratch
 * buffer, which comes first, could not be had. */
static exr_result_t decompress(exr_decode_pipeline_t *decode)
{
    const chunk_reader     *reader      = decode->decoding_user_data;
    const exr_compression_t compression = reader->job->compression;
    const bool b44 = compression == EXR_COMPRESSION_B44 || compression == EXR_COMPRESSION_B44A;
    const exr_result_t result = reader->decompress(decode);
    return result == EXR_ERR_OUT_OF_MEMORY && b44 && decode->scratch_buffer_1
               ? EXR_ERR_CORRUPT_CHUNK
               : result;
}

static exr_result_t prepare(chunk_reader *reader, const exr_chunk_info_t *chunk)
{
    exr_decode_pipeline_t *decode = &reader->decode;
    if (reader->begun) {
        return exr_decoding_update(reader->job->exr, 0, chunk, decode);
    }
    exr_result_t result = exr_decoding_initialize(reader->job->exr, 0, chunk, decode);
    if (result == EXR_ERR_SUCCESS) {
        reader->begun      = true;
        result             = exr_decoding_choose_default_routines(reader->job->exr, 0, decode);
        reader->decompress = decode->decompress_fn;
    }
    return result;
}

static exr_result_t decode_chunk(chunk_reader *reader, const exr_chunk_info_t *chunk)
{
    exr_decode_pipeline_t *decode = &reader->decode;
    const exr_result_t     result = prepare(reader, chunk);
    if (result != EXR_ERR_SUCCESS) {
        return result;
    }
    /* A chunk that compression would not have made smaller is stored as it is; 3.1 forgets that for
     * B44 and would scramble it. */
    const bool raw                = chunk->packed_size == chunk->unpacked_size;
    decode->decompress_fn         = is_zipped(reader->job)       ? unzip
                                    : raw || !reader->decompress ? NULL
                                                                 : decompress;
    decode->decoding_user_data    = reader;
    decode->unpack_and_convert_fn = unpack_chunk;
    return exr_decoding_run(reader->job->exr, 0, decode);
}

/* Bytes of a pixel in a decompressed chunk. */
static uint64_t packed_pixel(const exr_job *job)
{
    uint64_t bytes = 0;
    for (int c = 0; c < job->channels->num_channels; c++) {
        bytes += (uint64_t)sample_bytes(job, c);
    }
    return bytes;
}

/* The library makes room for whatever sizes a chunk claims.  So they are held against the file
 * first, which is then to blame, and against the memory there is: for as long as it is read. */
static exr_result_t read_chunk(chunk_reader *reader, const exr_chunk_info_t *chunk)
{
    exr_job       *job      = reader->job;
    const uint64_t expected = (uint64_t)chunk->width * (uint64_t)chunk->height * packed_pixel(job);
    if (chunk->packed_size > job->count || chunk->unpacked_size != expected) {
        return EXR_ERR_CORRUPT_CHUNK;
    }
    const uint64_t room = chunk->packed_size + 2 * expected;
    if (!assay_memory_charge(job->context, room)) {
        if (!job->deaf) { /* else other threads are here, too */
            job->refused = assay_memory_ask(job->context, room, job->name);
        }
        return EXR_ERR_OUT_OF_MEMORY;
    }
    const exr_result_t result = decode_chunk(reader, chunk);
    assay_memory_discharge(job->context, room);
    return result;
}

/* ---- all of them ---- */

static exr_result_t find_grid(const exr_job *job, chunk_grid *grid)
{
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    const int64_t width   = (int64_t)assay_exr_extent(job->data.min.x, job->data.max.x);
    const int64_t height  = (int64_t)assay_exr_extent(job->data.min.y, job->data.max.y);
    exr_result_t  result  = exr_get_storage(job->exr, 0, &storage);
    grid->tiled           = storage == EXR_STORAGE_TILED;
    grid->width           = (int32_t)width;
    if (result == EXR_ERR_SUCCESS) {
        result = grid->tiled ? exr_get_tile_sizes(job->exr, 0, 0, 0, &grid->width, &grid->height)
                             : exr_get_scanlines_per_chunk(job->exr, 0, &grid->height);
    }
    if (result == EXR_ERR_SUCCESS && (grid->width < 1 || grid->height < 1)) {
        result = EXR_ERR_INVALID_ATTR;
    }
    if (result == EXR_ERR_SUCCESS) {
        grid->columns = (width + grid->width - 1) / grid->width;
        grid->rows    = (height + grid->height - 1) / grid->height;
    }
    return result;
}

static exr_result_t read_chunk_at(chunk_reader *reader, const chunk_grid *grid, int64_t index)
{
    const exr_job   *job = reader->job;
    exr_chunk_info_t chunk;
    const int64_t    column = index % grid->columns, row = index / grid->columns;
    reader->x = (int32_t)(column * grid->width);
    reader->y = (int32_t)(row * grid->height);
    const exr_result_t result =
        grid->tiled
            ? exr_read_tile_chunk_info(job->exr, 0, (int)column, (int)row, 0, 0, &chunk)
            : exr_read_scanline_chunk_info(job->exr, 0, job->data.min.y + reader->y, &chunk);
    return result == EXR_ERR_SUCCESS ? read_chunk(reader, &chunk) : result;
}

static void close_reader(chunk_reader *reader)
{
    if (reader->begun) {
        exr_decoding_destroy(reader->job->exr, &reader->decode);
    }
    libdeflate_free_decompressor(reader->inflater);
    free(reader->samples);
    free(reader->sorted);
}

static assay_status read_one_by_one(exr_job *job, const chunk_grid *grid)
{
    chunk_reader reader = {.job = job, .decode = EXR_DECODE_PIPELINE_INITIALIZER};
    exr_result_t result = EXR_ERR_SUCCESS;
    for (int64_t i = 0; i < grid->columns * grid->rows && result == EXR_ERR_SUCCESS; i++) {
        result = read_chunk_at(&reader, grid, i);
    }
    close_reader(&reader);
    return result == EXR_ERR_SUCCESS ? ASSAY_OK : assay_exr_fail(job, result, "pixels");
}

typedef struct {
    const chunk_grid *grid;
    chunk_reader     *readers; /* one a thread */
} crowd;

static assay_status read_item(void *user, uint64_t index, int worker)
{
    const crowd *all = user;
    return read_chunk_at(&all->readers[worker], all->grid, (int64_t)index) == EXR_ERR_SUCCESS
               ? ASSAY_OK
               : ASSAY_ERR_FORMAT;
}

/* *all_read: false where some chunk fails, for whatever reason. */
static assay_status read_together(exr_job *job, const chunk_grid *grid, bool *all_read)
{
    const int     threads = assay_context_threads(job->context);
    chunk_reader *readers = assay_allocate(job->context, (size_t)threads, sizeof *readers);
    crowd         all     = {grid, readers};
    if (!readers) {
        return assay_fail_memory(job->context, job->name);
    }
    for (int i = 0; i < threads; i++) {
        readers[i] = (chunk_reader){.job = job, .decode = EXR_DECODE_PIPELINE_INITIALIZER};
    }
    job->deaf = true;
    *all_read = assay_parallel_for(job->context, NULL, (uint64_t)(grid->columns * grid->rows),
                                   read_item, &all) == ASSAY_OK;
    job->deaf = false;
    for (int i = 0; i < threads; i++) {
        close_reader(&readers[i]);
    }
    assay_release(job->context, readers);
    return ASSAY_OK;
}

assay_status assay_exr_read_chunks(exr_job *job)
{
    chunk_grid         grid   = {0};
    const exr_result_t result = find_grid(job, &grid);
    if (result != EXR_ERR_SUCCESS) {
        return assay_exr_fail(job, result, "pixels");
    }
    bool               all_read = false;
    const assay_status status   = read_together(job, &grid, &all_read);
    return status != ASSAY_OK || all_read ? status : read_one_by_one(job, &grid);
}
