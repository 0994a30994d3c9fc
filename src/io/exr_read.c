/* exr_read.c - OpenEXR through OpenEXRCore, the C library.
 *
 * The image is the display window.  Where the data window is smaller, the rest is zero, as OpenEXR
 * says; what lies outside the display window is left out.  Both are logged.
 *
 * Invariant: exr_job owns the library's context, and everything the library says arrives in
 * job->message instead of on stderr.  Its memory is zeroed, so that a chunk that decompresses to
 * too little cannot show what was there before. */
#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/exr_job.h"
#include "io/exr_window.h"

static void *allocate_zeroed(size_t bytes) { return calloc(1, bytes); }

static void on_error(exr_const_context_t exr, exr_result_t code, const char *message)
{
    void *job = NULL;
    (void)code;
    /* The first message is the one that names the cause. */
    if (exr_get_user_data(exr, &job) == EXR_ERR_SUCCESS && job && !((exr_job *)job)->deaf &&
        !((exr_job *)job)->message[0]) {
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

assay_status assay_exr_fail(const exr_job *job, exr_result_t result, const char *where)
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
        return assay_exr_fail(job, result, "header");
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
        return assay_exr_fail(job, result, "header");
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
        char                   colour[ASSAY_EXR_COLOUR_NAME], text[ASSAY_EXR_COLOUR_VALUE];
        const exr_attribute_t *attribute = NULL;
        assay_status           status    = ASSAY_OK;
        if (exr_get_attribute_by_index(job->exr, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) !=
            EXR_ERR_SUCCESS) {
            continue;
        }
        if (assay_exr_colour_text(attribute, colour, text)) {
            status = assay_image_set_attribute(job->image, colour, text);
        } else if (attribute->type == EXR_ATTR_STRING && attribute->string->str &&
                   !assay_image_attribute_reserved(attribute->name)) {
            status = assay_image_set_attribute(job->image, attribute->name, attribute->string->str);
        }
        if (status != ASSAY_OK) {
            return as_format_error(job, status);
        }
    }
    return ASSAY_OK;
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
    return status == ASSAY_OK ? assay_exr_read_chunks(job) : status;
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
        result == EXR_ERR_SUCCESS ? read_image(&job) : assay_exr_fail(&job, result, "header");
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
