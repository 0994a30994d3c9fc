/* texture_png.c - PNG through libpng.
 *
 * Invariant: everything that must be released lives in png_job, which outlives the setjmp; no local
 * variable is changed between setjmp and longjmp.  libpng's memory comes from the context.
 *
 * Only IHDR, PLTE, tRNS, IDAT and IEND are looked at: colour information is not used by glTF, and
 * chunks that are skipped cannot be malformed.  A wrong checksum of any chunk is an error. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/texture_codec.h"

typedef struct {
    assay_context *context;
    const uint8_t *bytes;
    size_t         count, at;
    png_structp    png;
    png_infop      info;
    uint8_t       *texels;
    png_bytep     *rows;
    bool           out_of_memory, cut_short;
    char           message[160];
} png_job;

static void on_error(png_structp png, png_const_charp message)
{
    png_job *job = png_get_error_ptr(png);
    snprintf(job->message, sizeof job->message, "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    png_job *job    = png_get_mem_ptr(png);
    void    *memory = assay_allocate(job->context, size, 1);
    if (!memory) {
        job->out_of_memory = true;
    }
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    png_job *job = png_get_mem_ptr(png);
    assay_release(job->context, memory);
}

static void read_bytes(png_structp png, png_bytep bytes_out, size_t count)
{
    png_job *job = png_get_io_ptr(png);
    if (count > job->count - job->at) {
        job->cut_short = true;
        png_error(png, "the file is cut short");
    }
    memcpy(bytes_out, job->bytes + job->at, count);
    job->at += count;
}

static uint32_t big_endian32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Width and height out of IHDR, and whether the rest of the file can hold so many pixels at all:
 * deflate makes at most 1032 bytes of one, and a pixel has at least one bit. */
static assay_status check_header(assay_context *context, const uint8_t *bytes, size_t count,
                                 const char *name)
{
    if (count < 33 || memcmp(bytes + 12, "IHDR", 4) != 0) {
        return assay_fail(context, ASSAY_ERR_FORMAT,
                          "%s: the PNG file is cut short or has no header", name);
    }
    const uint64_t     width = big_endian32(bytes + 16), height = big_endian32(bytes + 20);
    const assay_status status = assay_texture_check_size(context, name, width, height);
    if (status == ASSAY_OK && width * height / 8 / 1032 > count) {
        return assay_fail(context, ASSAY_ERR_FORMAT,
                          "%s: the PNG file is too short for its %llu x %llu pixels", name,
                          (unsigned long long)width, (unsigned long long)height);
    }
    return status;
}

/* Everything to RGBA of 8 or 16 bits in the machine's byte order. */
static void ask_for_rgba(png_structp png, png_infop info)
{
    const int      color = png_get_color_type(png, info), bits = png_get_bit_depth(png, info);
    const bool     transparent = png_get_valid(png, info, PNG_INFO_tRNS) != 0;
    const uint16_t probe       = 1;
    if (color == PNG_COLOR_TYPE_PALETTE) {
        png_set_palette_to_rgb(png);
    }
    if (color == PNG_COLOR_TYPE_GRAY && bits < 8) {
        png_set_expand_gray_1_2_4_to_8(png);
    }
    if (transparent) {
        png_set_tRNS_to_alpha(png);
    }
    if (color == PNG_COLOR_TYPE_GRAY || color == PNG_COLOR_TYPE_GRAY_ALPHA) {
        png_set_gray_to_rgb(png);
    }
    if (!(color & PNG_COLOR_MASK_ALPHA) && !transparent) {
        png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    }
    if (bits == 16 && *(const uint8_t *)&probe == 1) {
        png_set_swap(png);
    }
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
}

/* Runs under the setjmp of decode. */
static void read_image(png_job *job, assay_texture_image *image)
{
    static const png_byte unused_chunks[] = "cHRM\0gAMA\0iCCP\0sBIT\0sRGB\0bKGD\0eXIf\0hIST\0iTXt\0"
                                            "oFFs\0pCAL\0pHYs\0sCAL\0sPLT\0tEXt\0tIME\0zTXt";
    png_set_read_fn(job->png, job, read_bytes);
    png_set_crc_action(job->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_user_limits(job->png, ASSAY_TEXTURE_MAX_SIDE, ASSAY_TEXTURE_MAX_SIDE);
    png_set_keep_unknown_chunks(job->png, PNG_HANDLE_CHUNK_NEVER, unused_chunks,
                                (int)(sizeof unused_chunks / 5));
    png_read_info(job->png, job->info);
    ask_for_rgba(job->png, job->info);

    image->width           = png_get_image_width(job->png, job->info);
    image->height          = png_get_image_height(job->png, job->info);
    image->bits            = png_get_bit_depth(job->png, job->info);
    const size_t row_bytes = (size_t)image->width * 4 * (image->bits / 8);
    if (png_get_rowbytes(job->png, job->info) != row_bytes) {
        png_error(job->png, "unexpected pixel layout");
    }
    job->texels = assay_allocate(job->context, image->height, row_bytes);
    job->rows   = assay_allocate(job->context, image->height, sizeof *job->rows);
    if (!job->texels || !job->rows) {
        job->out_of_memory = true;
        png_error(job->png, "out of memory");
    }
    for (uint32_t y = 0; y < image->height; y++) {
        job->rows[y] = job->texels + y * row_bytes;
    }
    png_read_image(job->png, job->rows);
    png_read_end(job->png, NULL);
}

/* False on any error; job says which. */
static bool decode(png_job *job, assay_texture_image *image)
{
    job->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job,
                                        allocate, release);
    if (!job->png) {
        job->out_of_memory = true;
        return false;
    }
    if (setjmp(png_jmpbuf(job->png))) {
        return false;
    }
    job->info = png_create_info_struct(job->png);
    if (!job->info) {
        job->out_of_memory = true;
        return false;
    }
    read_image(job, image);
    return true;
}

assay_status assay_texture_decode_png(assay_context *context, const uint8_t *bytes, size_t count,
                                      const char *name, assay_texture_image *image_out)
{
    const assay_status status = check_header(context, bytes, count, name);
    if (status != ASSAY_OK) {
        return status;
    }
    png_job             job   = {.context = context, .bytes = bytes, .count = count};
    assay_texture_image image = {0};
    const bool          good  = decode(&job, &image);
    if (job.png) {
        png_destroy_read_struct(&job.png, &job.info, NULL);
    }
    assay_release(context, job.rows);
    if (good) {
        image.texels = job.texels;
        *image_out   = image;
        return ASSAY_OK;
    }
    assay_release(context, job.texels);
    if (job.out_of_memory) {
        return assay_fail_memory(context, name);
    }
    return assay_fail(context, ASSAY_ERR_FORMAT, "%s: malformed PNG: %s", name, job.message);
}
