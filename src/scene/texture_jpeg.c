/* texture_jpeg.c - JPEG through libjpeg-turbo.
 *
 * Invariant: everything that must be released lives in jpeg_job, which outlives the setjmp; no
 * local variable is changed between setjmp and longjmp.
 *
 * The integer ("slow") inverse transform and the triangle up-sampling give the same bits with and
 * without vector instructions.  libjpeg mends damaged data with a warning and a grey area; here the
 * warnings that mean lost data are errors, and the others are ignored. */
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include <jpeglib.h>

#include <jerror.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/texture_codec.h"

/* A progressive file may ask for a whole-image pass in a few bytes; real ones have about ten. */
enum { MAX_SCANS = 256 };

typedef struct {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr         errors;
    struct jpeg_source_mgr        source;
    struct jpeg_progress_mgr      progress;
    jmp_buf                       escape;
    uint8_t                      *texels;
    bool                          out_of_memory, unsupported, too_many_scans;
    char                          message[JMSG_LENGTH_MAX];
} jpeg_job;

static _Noreturn void give_up(jpeg_job *job, const char *message)
{
    snprintf(job->message, sizeof job->message, "%s", message);
    longjmp(job->escape, 1);
}

static void on_error(j_common_ptr jpeg)
{
    jpeg_job *job  = jpeg->client_data;
    const int code = jpeg->err->msg_code;
    char      message[JMSG_LENGTH_MAX];
    job->out_of_memory = code == JERR_OUT_OF_MEMORY;
    job->unsupported   = code == JERR_BAD_PRECISION || code == JERR_SOF_UNSUPPORTED ||
                       code == JERR_ARITH_NOTIMPL || code == JERR_CONVERSION_NOTIMPL;
    jpeg->err->format_message(jpeg, message);
    give_up(job, message);
}

static void on_message(j_common_ptr jpeg, int level)
{
    if (level >= 0) {
        return;
    }
    switch (jpeg->err->msg_code) {
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_ARITH_BAD_CODE:
    case JWRN_MUST_RESYNC:
    case JWRN_JPEG_EOF:
    case JWRN_BOGUS_PROGRESSION: on_error(jpeg); break;
    default: break;
    }
}

static void on_output(j_common_ptr jpeg) { (void)jpeg; }

static void on_progress(j_common_ptr common)
{
    jpeg_job *job = common->client_data;
    if (job->jpeg.input_scan_number > MAX_SCANS) {
        job->too_many_scans = true;
        give_up(job, "too many scans");
    }
}

static void start_source(j_decompress_ptr jpeg) { (void)jpeg; }

static boolean refill_source(j_decompress_ptr jpeg)
{
    give_up(jpeg->client_data, "the file is cut short");
}

static void skip_source(j_decompress_ptr jpeg, long count)
{
    if (count <= 0) {
        return;
    }
    if ((size_t)count > jpeg->src->bytes_in_buffer) {
        give_up(jpeg->client_data, "the file is cut short");
    }
    jpeg->src->next_input_byte += count;
    jpeg->src->bytes_in_buffer -= (size_t)count;
}

/* Runs under the setjmp of decode.  A coded block of 8 x 8 pixels takes at least one bit, so a file
 * has at least a byte for 512 pixels. */
static assay_status start(jpeg_job *job, assay_context *context, const char *name, size_t count)
{
    struct jpeg_decompress_struct *jpeg = &job->jpeg;
    jpeg_read_header(jpeg, TRUE);
    const uint64_t     pixels = (uint64_t)jpeg->image_width * jpeg->image_height;
    const assay_status status =
        assay_texture_check_size(context, name, jpeg->image_width, jpeg->image_height);
    if (status != ASSAY_OK) {
        return status;
    }
    if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK ||
        jpeg->jpeg_color_space == JCS_UNKNOWN || jpeg->arith_code) {
        return assay_fail(context, ASSAY_ERR_UNSUPPORTED,
                          "%s: %s JPEG; save it as a baseline or progressive JPEG in RGB or grey",
                          name,
                          jpeg->arith_code ? "arithmetic-coded" : "CMYK or unknown colours in a");
    }
    if (pixels / 512 > count) {
        return assay_fail(context, ASSAY_ERR_FORMAT,
                          "%s: the JPEG file is too short for its %u x %u pixels", name,
                          jpeg->image_width, jpeg->image_height);
    }
    jpeg->out_color_space     = JCS_EXT_RGBA;
    jpeg->dct_method          = JDCT_ISLOW;
    jpeg->do_fancy_upsampling = TRUE;
    jpeg->do_block_smoothing  = FALSE;
    jpeg_start_decompress(jpeg);
    return ASSAY_OK;
}

/* Runs under the setjmp of decode. */
static void read_rows(jpeg_job *job)
{
    const size_t row_bytes = (size_t)job->jpeg.output_width * 4;
    while (job->jpeg.output_scanline < job->jpeg.output_height) {
        JSAMPROW row = job->texels + job->jpeg.output_scanline * row_bytes;
        jpeg_read_scanlines(&job->jpeg, &row, 1);
    }
    jpeg_finish_decompress(&job->jpeg);
}

static assay_status fail_job(const jpeg_job *job, assay_context *context, const char *name)
{
    if (job->out_of_memory) {
        return assay_fail_memory(context, name);
    }
    if (job->too_many_scans) {
        return assay_fail(context, ASSAY_ERR_LIMIT,
                          "%s: progressive JPEG with more than %d scans; save it anew", name,
                          MAX_SCANS);
    }
    if (job->unsupported) {
        return assay_fail(
            context, ASSAY_ERR_UNSUPPORTED,
            "%s: JPEG of a kind that is not read: %s; save it as a baseline JPEG of 8 "
            "bits",
            name, job->message);
    }
    return assay_fail(context, ASSAY_ERR_FORMAT, "%s: malformed JPEG: %s", name, job->message);
}

/* The object is created before, so that it can be destroyed after any escape. */
static assay_status decode(jpeg_job *job, assay_context *context, const char *name, size_t count)
{
    if (setjmp(job->escape)) {
        return fail_job(job, context, name);
    }
    const assay_status status = start(job, context, name, count);
    if (status != ASSAY_OK) {
        return status;
    }
    job->texels =
        assay_allocate(context, job->jpeg.output_height, (size_t)job->jpeg.output_width * 4);
    if (!job->texels) {
        return assay_fail_memory(context, name);
    }
    read_rows(job);
    return ASSAY_OK;
}

static bool create(jpeg_job *job, const uint8_t *bytes, size_t count)
{
    job->jpeg.err              = jpeg_std_error(&job->errors);
    job->errors.error_exit     = on_error;
    job->errors.emit_message   = on_message;
    job->errors.output_message = on_output;
    job->jpeg.client_data      = job;
    if (setjmp(job->escape)) {
        return false;
    }
    jpeg_create_decompress(&job->jpeg);
    job->source                    = (struct jpeg_source_mgr){.next_input_byte   = bytes,
                                                              .bytes_in_buffer   = count,
                                                              .init_source       = start_source,
                                                              .fill_input_buffer = refill_source,
                                                              .skip_input_data   = skip_source,
                                                              .resync_to_restart = jpeg_resync_to_restart,
                                                              .term_source       = start_source};
    job->progress.progress_monitor = on_progress;
    job->jpeg.src                  = &job->source;
    job->jpeg.progress             = &job->progress;
    return true;
}

assay_status assay_texture_decode_jpeg(assay_context *context, const uint8_t *bytes, size_t count,
                                       const char *name, assay_texture_image *image_out)
{
    jpeg_job job;
    memset(&job, 0, sizeof job);
    assay_status status = create(&job, bytes, count) ? ASSAY_OK : fail_job(&job, context, name);
    if (status == ASSAY_OK) {
        status = decode(&job, context, name, count);
    }
    if (status == ASSAY_OK) {
        image_out->width  = job.jpeg.output_width;
        image_out->height = job.jpeg.output_height;
        image_out->bits   = 8;
        image_out->texels = job.texels;
        job.texels        = NULL;
    }
    assay_release(context, job.texels);
    jpeg_destroy_decompress(&job.jpeg);
    return status;
}
