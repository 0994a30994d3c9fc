/* encoded_image.c - see encoded_image.h. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "encoded_image.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

typedef struct {
    uint8_t *bytes;
    size_t   count, room;
} memory_file;

static void write_bytes(png_structp png, png_bytep bytes, size_t count)
{
    memory_file *file = png_get_io_ptr(png);
    if (file->count + count > file->room) {
        file->room  = (file->count + count) * 2;
        file->bytes = realloc(file->bytes, file->room);
        assert_non_null(file->bytes);
    }
    memcpy(file->bytes + file->count, bytes, count);
    file->count += count;
}

static void flush_bytes(png_structp png) { (void)png; }

static void set_colors(png_structp png, png_infop info, const png_spec *spec)
{
    if (spec->color_type == PNG_COLOR_TYPE_PALETTE) {
        png_color palette[256];
        png_byte  alpha[256];
        for (int i = 0; i < spec->palette_count; i++) {
            palette[i] = (png_color){spec->palette[i][0], spec->palette[i][1], spec->palette[i][2]};
            alpha[i]   = spec->palette[i][3];
        }
        png_set_PLTE(png, info, palette, spec->palette_count);
        if (spec->transparent) {
            png_set_tRNS(png, info, alpha, spec->palette_count, NULL);
        }
    } else if (spec->transparent) {
        png_color_16 color = {.red   = spec->transparent_color[0],
                              .green = spec->transparent_color[1],
                              .blue  = spec->transparent_color[2],
                              .gray  = spec->transparent_color[0]};
        png_set_tRNS(png, info, NULL, 0, &color);
    }
    if (spec->with_gamma) {
        png_text note = {.compression = PNG_TEXT_COMPRESSION_zTXt, .key = "k", .text = "some text"};
        png_set_gAMA(png, info, 1.0);
        png_set_cHRM(png, info, 0.3, 0.3, 0.7, 0.2, 0.2, 0.7, 0.1, 0.1);
        png_set_text(png, info, &note, 1);
    }
}

/* Packs a row's samples to its bits, highest first. */
static void pack_row(uint8_t *row, const uint16_t *samples, size_t count, int bits)
{
    memset(row, 0, count * 2);
    for (size_t i = 0; i < count; i++) {
        if (bits == 16) {
            row[2 * i]     = (uint8_t)(samples[i] >> 8);
            row[2 * i + 1] = (uint8_t)samples[i];
        } else {
            const size_t at = i * (size_t)bits;
            row[at / 8] |= (uint8_t)(samples[i] << (8 - bits - (int)(at % 8)));
        }
    }
}

uint8_t *png_bytes(const png_spec *spec, const uint16_t *samples, size_t *count_out)
{
    static const int channel_counts[] = {1, 0, 3, 1, 2, 0, 4};
    const size_t     row_samples      = (size_t)channel_counts[spec->color_type] * spec->width;
    memory_file      file             = {0};
    png_structp      png  = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop        info = png_create_info_struct(png);
    uint8_t         *row  = malloc(row_samples * 2 + 8);
    assert_non_null(row);
    if (setjmp(png_jmpbuf(png))) {
        fail_msg("libpng refuses the test's image");
    }
    png_set_write_fn(png, &file, write_bytes, flush_bytes);
    png_set_IHDR(png, info, spec->width, spec->height, spec->bits, spec->color_type,
                 spec->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    set_colors(png, info, spec);
    png_write_info(png, info);
    const int passes = png_set_interlace_handling(png);
    for (int pass = 0; pass < passes; pass++) {
        for (uint32_t y = 0; y < spec->height; y++) {
            pack_row(row, samples + y * row_samples, row_samples, spec->bits);
            png_write_row(png, row);
        }
    }
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    free(row);
    *count_out = file.count;
    return file.bytes;
}

uint8_t *jpeg_bytes(const jpeg_spec *spec, const uint8_t *samples, size_t *count_out)
{
    struct jpeg_compress_struct jpeg;
    struct jpeg_error_mgr       errors;
    unsigned char              *bytes = NULL;
    unsigned long               count = 0;
    jpeg.err                          = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &count);
    jpeg.image_width      = spec->width;
    jpeg.image_height     = spec->height;
    jpeg.input_components = spec->channels;
    jpeg.in_color_space   = spec->channels == 1   ? JCS_GRAYSCALE
                            : spec->channels == 3 ? JCS_RGB
                                                  : JCS_CMYK;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, spec->quality, TRUE);
    if (spec->channels == 3 && !spec->subsampled) {
        jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    }
    if (spec->progressive) {
        jpeg_simple_progression(&jpeg);
    }
    jpeg.arith_code = spec->arithmetic;
    jpeg_start_compress(&jpeg, TRUE);
    for (uint32_t y = 0; y < spec->height; y++) {
        JSAMPROW row = (JSAMPROW)(samples + (size_t)y * spec->width * (size_t)spec->channels);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    *count_out = count;
    return bytes;
}
