/* png_write.c - previews through libpng.
 *
 * Invariant: everything that must be released lives in png_job, which outlives the setjmp; no local
 * variable is changed between setjmp and longjmp.  NaN and negative values are black, infinity is
 * white: a preview shows, it does not judge. */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "io/atomic_file.h"
#include "io/image_data.h"
#include "io/srgb_encode.h"

typedef struct {
    const assay_image *image;
    const char        *path;
    assay_channel      sources[3]; /* thrice the same for grey */
    double             factor;     /* 2^exposure               */
    assay_atomic_file *file;
    uint8_t           *row;
    png_structp        png;
    png_infop          info;
    bool               out_of_memory;
    char               message[160];
} png_job;

double assay_srgb_encode(double linear)
{
    if (!(linear > 0.0)) {
        return 0.0;
    }
    if (linear >= 1.0) {
        return 1.0;
    }
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * assay_pow(linear, 1.0 / 2.4) - 0.055;
}

uint8_t assay_srgb_encode8(double linear)
{
    return (uint8_t)(assay_srgb_encode(linear) * 255.0 + 0.5);
}

static bool find_channels(const assay_image *image, const char *layer, assay_channel sources[3])
{
    static const char *const endings[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
    for (int kind = 0; kind < 2; kind++) {
        int found = 0;
        for (int c = 0; c < 3; c++) {
            char name[300];
            snprintf(name, sizeof name, "%.255s%s%s", layer, layer[0] ? "." : "", endings[kind][c]);
            found += assay_image_find_channel(image, name, &sources[c]);
        }
        if (found == 3) {
            return true;
        }
    }
    if (assay_image_find_channel(image, layer, &sources[0])) {
        sources[1] = sources[2] = sources[0];
        return true;
    }
    return false;
}

static double value_at(const assay_channel *channel, size_t pixel)
{
    return channel->type == ASSAY_CHANNEL_UINT ? channel->data.u32[pixel]
                                               : channel->data.f32[pixel];
}

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
    void    *memory = assay_allocate(job->image->context, size, 1);
    if (!memory) {
        job->out_of_memory = true;
    }
    return memory;
}

static void release(png_structp png, png_voidp memory)
{
    png_job *job = png_get_mem_ptr(png);
    assay_release(job->image->context, memory);
}

static void write_bytes(png_structp png, png_bytep bytes, size_t count)
{
    png_job *job = png_get_io_ptr(png);
    assay_atomic_file_write(job->file, bytes, count);
    if (assay_atomic_file_failed(job->file)) {
        png_error(png, "write");
    }
}

static void flush_bytes(png_structp png) { (void)png; }

/* Runs under the setjmp of encode. */
static void write_image(png_job *job)
{
    const assay_image *image = job->image;
    png_set_write_fn(job->png, job, write_bytes, flush_bytes);
    png_set_user_limits(job->png, ASSAY_IMAGE_MAX_SIDE, ASSAY_IMAGE_MAX_SIDE);
    png_set_IHDR(job->png, job->info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(job->png, job->info, PNG_sRGB_INTENT_RELATIVE);
    png_write_info(job->png, job->info);
    for (int y = 0; y < image->height; y++) {
        for (int x = 0; x < image->width; x++) {
            const size_t pixel = (size_t)y * (size_t)image->width + (size_t)x;
            for (int c = 0; c < 3; c++) {
                job->row[3 * (size_t)x + (size_t)c] =
                    assay_srgb_encode8(value_at(&job->sources[c], pixel) * job->factor);
            }
        }
        png_write_row(job->png, job->row);
    }
    png_write_end(job->png, job->info);
}

static bool encode(png_job *job)
{
    job->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, job, on_error, on_warning, job,
                                         allocate, release);
    if (!job->png) {
        job->out_of_memory = true;
        return false;
    }
    if (setjmp(png_jmpbuf(job->png))) {
        return false;
    }
    job->info = png_create_info_struct(job->png);
    job->row  = assay_allocate(job->image->context, (size_t)job->image->width, 3);
    if (!job->info || !job->row) {
        job->out_of_memory = true;
        return false;
    }
    write_image(job);
    return true;
}

static assay_status write_file(png_job *job)
{
    assay_context *context = job->image->context;
    assay_status   status  = assay_atomic_file_open(context, job->path, &job->file);
    if (status != ASSAY_OK) {
        return status;
    }
    const bool good = encode(job);
    png_destroy_write_struct(&job->png, &job->info);
    assay_release(context, job->row);
    if (good || assay_atomic_file_failed(job->file)) {
        return assay_atomic_file_commit(job->file);
    }
    assay_atomic_file_discard(job->file);
    return job->out_of_memory
               ? assay_fail_memory(context, job->path)
               : assay_fail(context, ASSAY_ERR_WRITE, "%s: cannot be written: PNG: %s", job->path,
                            job->message);
}

assay_status assay_image_write_png(const assay_image *image, const char *layer, double exposure,
                                   const char *path)
{
    png_job job = {.image = image, .path = path, .factor = assay_exp2(exposure)};
    if (!isfinite(exposure) || !isfinite(job.factor)) {
        return assay_fail(image->context, ASSAY_ERR_ARGUMENT,
                          "exposure %g: it must be finite and below 1024 stops", exposure);
    }
    if (!find_channels(image, layer, job.sources)) {
        return assay_fail(image->context, ASSAY_ERR_ARGUMENT,
                          "%s: the image has no layer '%.80s' of three channels and no channel of "
                          "that name",
                          path, layer);
    }
    return write_file(&job);
}
