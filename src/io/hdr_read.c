/* hdr_read.c - Radiance pictures (RGBE), as [ward91] and Radiance's file format page describe them.
 *
 * A pixel (r, g, b, e) is c 2^(e - 136) for each component c, exact in a float; e = 0 is black.
 * Radiance itself reads (c + 0.5) 2^(e - 136), the middle of what its writer rounds down; nearly
 * all other readers leave the half out, and so does this one: 0 stays 0, and a map lights a scene
 * here as it does elsewhere (docs/conventions.md).
 *
 * EXPOSURE and COLORCORR lines say what the pixels were multiplied with; they are divided out, all
 * of them.  Rows must run from the top and from left to right (-Y height +X width).
 *
 * Invariant: every byte is asked for through `at` < `count`, and every pixel is written inside its
 * row. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "io/image_data.h"

enum { MAX_HEADER_LINE = 2048, SHORTEST_RLE_ROW = 8, LONGEST_RLE_ROW = 32767 };

typedef struct {
    assay_context *context;
    const char    *name;
    const uint8_t *bytes;
    size_t         count, at;
    double         scale[3]; /* 1 / (exposures * color corrections) */
    int            width, height;
    float         *channels[3]; /* borrowed from the image */
    uint8_t       *row;         /* 4 bytes a pixel         */
} hdr_job;

static assay_status fail_format(const hdr_job *job, const char *what)
{
    return assay_fail(job->context, ASSAY_ERR_FORMAT, "%s: Radiance file: %s", job->name, what);
}

/* The next line without its newline, as a string. */
static assay_status read_line(hdr_job *job, char line_out[MAX_HEADER_LINE])
{
    size_t length = 0;
    while (job->at < job->count && job->bytes[job->at] != '\n') {
        if (length + 1 == MAX_HEADER_LINE || job->bytes[job->at] == 0) {
            return fail_format(job, "a header line is too long or not text");
        }
        line_out[length++] = (char)job->bytes[job->at++];
    }
    if (job->at == job->count) {
        return fail_format(job, "the header is cut short");
    }
    job->at++;
    if (length && line_out[length - 1] == '\r') {
        length--;
    }
    line_out[length] = 0;
    return ASSAY_OK;
}

/* Divides the scale of `count` components by the positive numbers of a header line. */
static assay_status divide_scale(hdr_job *job, const char *text, int count)
{
    for (int i = 0; i < count; i++) {
        char        *end   = NULL;
        const double value = strtod(text, &end);
        if (end == text || !isfinite(value) || !(value > 0.0)) {
            return fail_format(job, "EXPOSURE or COLORCORR is not a positive number");
        }
        for (int c = 0; c < 3; c++) {
            job->scale[c] /= count == 1 || c == i ? value : 1.0;
        }
        text = end;
    }
    text += strspn(text, " \t");
    return *text ? fail_format(job, "EXPOSURE or COLORCORR has text after its number") : ASSAY_OK;
}

static bool begins(const char *line, const char *word, const char **rest_out)
{
    const size_t length = strlen(word);
    *rest_out           = line + length;
    return strncmp(line, word, length) == 0;
}

static assay_status read_header(hdr_job *job)
{
    char         line[MAX_HEADER_LINE] = {0};
    bool         has_format            = false;
    assay_status status                = read_line(job, line); /* "#?RADIANCE", "#?RGBE" */
    while (status == ASSAY_OK) {
        const char *rest = NULL;
        status           = read_line(job, line);
        if (status != ASSAY_OK || line[0] == 0) {
            break;
        }
        if (begins(line, "FORMAT=", &rest)) {
            if (strcmp(rest, "32-bit_rle_rgbe") != 0) {
                return assay_fail(job->context, ASSAY_ERR_UNSUPPORTED,
                                  "%s: Radiance format '%.40s' is not read; write 32-bit_rle_rgbe",
                                  job->name, rest);
            }
            has_format = true;
        } else if (begins(line, "EXPOSURE=", &rest)) {
            status = divide_scale(job, rest, 1);
        } else if (begins(line, "COLORCORR=", &rest)) {
            status = divide_scale(job, rest, 3);
        }
    }
    if (status == ASSAY_OK && !has_format) {
        return fail_format(job, "no FORMAT line in the header");
    }
    return status;
}

/* A size in plain digits; 0 where it is none or too large for any limit. */
static int read_size(const char **text)
{
    int value = 0, digits = 0;
    for (; **text >= '0' && **text <= '9'; ++*text) {
        value = value * 10 + (**text - '0');
        if (++digits > 8) {
            return 0;
        }
    }
    return value;
}

static assay_status read_resolution(hdr_job *job)
{
    char         line[MAX_HEADER_LINE] = {0};
    const char  *text                  = NULL;
    assay_status status                = read_line(job, line);
    if (status != ASSAY_OK) {
        return status;
    }
    if (!begins(line, "-Y ", &text)) {
        const bool other = (line[0] == '-' || line[0] == '+') && strpbrk(line, "XY");
        return assay_fail(
            job->context, other ? ASSAY_ERR_UNSUPPORTED : ASSAY_ERR_FORMAT,
            "%s: Radiance file: the resolution is '%.40s'; only -Y height +X width is "
            "read",
            job->name, line);
    }
    job->height = read_size(&text);
    if (begins(text, " +X ", &text)) {
        job->width = read_size(&text);
    } else {
        return assay_fail(
            job->context, ASSAY_ERR_UNSUPPORTED,
            "%s: Radiance file: the resolution is '%.40s'; only -Y height +X width is "
            "read",
            job->name, line);
    }
    if (*text || job->width < 1 || job->height < 1) {
        return fail_format(job, "the resolution line is malformed");
    }
    if (job->width > ASSAY_IMAGE_MAX_SIDE || job->height > ASSAY_IMAGE_MAX_SIDE ||
        (uint64_t)job->width * (uint64_t)job->height > ASSAY_IMAGE_MAX_PIXELS) {
        return assay_fail(job->context, ASSAY_ERR_LIMIT,
                          "%s: %d x %d pixels; at most %d a side and %u in all are read", job->name,
                          job->width, job->height, ASSAY_IMAGE_MAX_SIDE, ASSAY_IMAGE_MAX_PIXELS);
    }
    /* The shortest row of any coding has one pixel of four bytes. */
    if ((uint64_t)job->height * 4 > job->count - job->at) {
        return fail_format(job, "too short for its pixels");
    }
    return ASSAY_OK;
}

/* One component of a row after the other; a count over 128 says that count - 128 bytes are alike.
 */
static bool read_new_rle_row(hdr_job *job)
{
    for (int c = 0; c < 4; c++) {
        for (int x = 0; x < job->width;) {
            if (job->count - job->at < 2) {
                return false;
            }
            const uint8_t code  = job->bytes[job->at++];
            const bool    alike = code > 128;
            const int     run   = alike ? code - 128 : code;
            const size_t  taken = alike ? 1 : (size_t)run;
            if (run == 0 || run > job->width - x || job->count - job->at < taken) {
                return false;
            }
            for (int i = 0; i < run; i++, x++) {
                job->row[4 * x + c] = job->bytes[job->at + (alike ? 0 : (size_t)i)];
            }
            job->at += taken;
        }
    }
    return true;
}

/* Whole pixels; (1, 1, 1, n) repeats the last one n times, and right after another such pixel n *
 * 256 times, and so on. */
static bool read_old_row(hdr_job *job)
{
    unsigned shift = 0;
    for (int x = 0; x < job->width;) {
        if (job->count - job->at < 4) {
            return false;
        }
        const uint8_t *pixel = job->bytes + job->at;
        job->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(job->row + (size_t)4 * (size_t)x++, pixel, 4);
            shift = 0;
            continue;
        }
        const uint32_t run = shift <= 16 ? (uint32_t)pixel[3] << shift : UINT32_MAX;
        if (x == 0 || run > (uint32_t)(job->width - x)) {
            return false;
        }
        for (uint32_t i = 0; i < run; i++, x++) {
            memcpy(job->row + (size_t)4 * (size_t)x, job->row + (size_t)4 * (size_t)(x - 1), 4);
        }
        shift += 8;
    }
    return true;
}

static bool is_new_rle(const hdr_job *job)
{
    const uint8_t *b = job->bytes + job->at;
    return job->width >= SHORTEST_RLE_ROW && job->width <= LONGEST_RLE_ROW &&
           job->count - job->at >= 4 && b[0] == 2 && b[1] == 2 && b[2] < 128;
}

static void convert_row(const hdr_job *job, int y)
{
    for (int x = 0; x < job->width; x++) {
        const uint8_t *pixel = job->row + (size_t)4 * (size_t)x;
        const double   unit  = pixel[3] ? ldexp(1.0, pixel[3] - 136) : 0.0;
        for (int c = 0; c < 3; c++) {
            job->channels[c][(size_t)y * (size_t)job->width + (size_t)x] =
                (float)(pixel[c] * unit * job->scale[c]);
        }
    }
}

static assay_status read_pixels(hdr_job *job)
{
    for (int y = 0; y < job->height; y++) {
        bool good;
        if (is_new_rle(job)) {
            const int width = job->bytes[job->at + 2] << 8 | job->bytes[job->at + 3];
            job->at += 4;
            good = width == job->width && read_new_rle_row(job);
        } else {
            good = read_old_row(job);
        }
        if (!good) {
            return assay_fail(job->context, ASSAY_ERR_FORMAT,
                              "%s: Radiance file: row %d is malformed or cut short", job->name, y);
        }
        convert_row(job, y);
    }
    return ASSAY_OK;
}

static assay_status make_image(hdr_job *job, assay_image **image_out)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_status status = assay_image_create(job->context, job->width, job->height, image_out);
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        assay_channel channel;
        status = assay_image_add_channel(*image_out, names[c], ASSAY_CHANNEL_FLOAT, &channel);
        if (status == ASSAY_OK) {
            job->channels[c] = channel.data.f32;
        }
    }
    if (status == ASSAY_OK) {
        job->row = assay_allocate(job->context, (size_t)job->width, 4);
        status   = job->row ? ASSAY_OK : assay_fail_memory(job->context, job->name);
    }
    return status;
}

assay_status assay_image_decode_hdr(assay_context *context, const uint8_t *bytes, size_t count,
                                    const char *name, assay_image **image_out)
{
    hdr_job job = {
        .context = context, .name = name, .bytes = bytes, .count = count, .scale = {1.0, 1.0, 1.0}};
    assay_image *image  = NULL;
    assay_status status = read_header(&job);
    if (status == ASSAY_OK) {
        status = read_resolution(&job);
    }
    if (status == ASSAY_OK) {
        status = make_image(&job, &image);
    }
    if (status == ASSAY_OK) {
        status = read_pixels(&job);
    }
    assay_release(context, job.row);
    if (status != ASSAY_OK) {
        assay_image_destroy(image);
        return status;
    }
    *image_out = image;
    return ASSAY_OK;
}
