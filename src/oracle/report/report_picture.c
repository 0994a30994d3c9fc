/* report_picture.c - Invariant: a picture is written whole before anything that speaks of it.
 *
 * Every picture is a <script type="text/plain"> of its own, so that a browser keeps it as text and
 * runs nothing of it.  Budgets are bits a pixel: a pair of 1920 x 1080 with all maps stays near 10
 * MB in base64, and small images are kept as finely as the finest step allows. */
#include "oracle/report/report_picture.h"

#include <math.h>
#include <stdio.h>

#include "core/context.h"
#include "core/numerics.h"
#include "oracle/report/report_pack.h"

static const int COLOUR_STEPS[] = {256, 128, 64, 32, 16, 0}; /* a power of two */
static const int MAP_STEPS[]    = {32, 16, 8, 4, 0};

static assay_status put_picture(assay_report_writer *writer, const assay_image *size, int planes,
                                const float *const *values, double floor, assay_report_picture *out)
{
    const int          width = assay_image_width(size), height = assay_image_height(size);
    const double       pixels = (double)width * height;
    const size_t       budget = (size_t)(planes == 3 ? fmax(393216.0, 9.0 / 8.0 * pixels)
                                                     : fmax(98304.0, 2.5 / 8.0 * pixels));
    assay_report_pack  pack;
    const assay_status status =
        assay_report_pack_create(writer->context, width, height, planes, values, floor,
                                 planes == 3 ? COLOUR_STEPS : MAP_STEPS, budget, &pack);
    if (status != ASSAY_OK) {
        return status;
    }
    char tag[64];
    snprintf(tag, sizeof tag, "<script type=\"text/plain\" id=\"picture-%d\">", writer->pictures);
    assay_report_put_raw(writer->text, tag);
    assay_report_put_base64(writer->text, pack.bytes, pack.count);
    assay_report_put_raw(writer->text, "</script>\n");
    *out = (assay_report_picture){writer->pictures++, planes, pack.steps, pack.floor};
    assay_report_pack_release(writer->context, &pack);
    return ASSAY_OK;
}

/* A value that about one in fifty is above, to a factor of 2; robust against the few that are far
 * out, unlike the root of the mean square, which is taken where this is 0. */
static double usual_maximum(const float *values, size_t pixels)
{
    enum { BINS = 512, MIDDLE = 256 };
    size_t count[BINS] = {0}, above = 0;
    for (size_t i = 0; i < pixels; i++) {
        int exponent = -MIDDLE;
        if (isfinite(values[i]) && values[i] != 0.0F) {
            frexp((double)values[i], &exponent);
        }
        count[MIDDLE + exponent]++;
    }
    for (int bin = BINS - 1; bin > 0; bin--) {
        above += count[bin];
        if (above * 50 >= pixels) {
            return assay_exp2(bin - MIDDLE);
        }
    }
    return 0.0;
}

/* Root of the mean square of the finite values of some planes; 1 where that is 0. */
static double typical(const float *const *values, int planes, size_t pixels)
{
    double sum = 0.0, count = 0.0;
    for (int p = 0; p < planes; p++) {
        for (size_t i = 0; i < pixels; i++) {
            const double v = values[p][i];
            if (isfinite(v)) {
                sum += v * v;
                count += 1.0;
            }
        }
    }
    return sum > 0.0 ? sqrt(sum / count) : 1.0;
}

static size_t pixels_of(const assay_image *image)
{
    return (size_t)assay_image_width(image) * (size_t)assay_image_height(image);
}

/* Below 2^-20 of the typical value steps are even: darker than any exposure of the page shows. */
assay_status assay_report_put_colour(assay_report_writer *writer, const assay_image *image,
                                     assay_report_picture *out)
{
    const float             *values[3];
    static const char *const names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        assay_image_find_channel(image, names[c], &channel);
        values[c] = channel.data.f32;
    }
    return put_picture(writer, image, 3, values, 0x1p-20 * typical(values, 3, pixels_of(image)),
                       out);
}

assay_status assay_report_put_map(assay_report_writer *writer, const assay_image *size,
                                  const float *values, double scale, assay_report_picture *out)
{
    const double most  = usual_maximum(values, pixels_of(size));
    const double floor = most > 0.0 ? most : typical(&values, 1, pixels_of(size));
    return put_picture(writer, size, 1, &values, fmin(floor, scale), out);
}

void assay_report_describe_picture(assay_report_text *text, const char *key,
                                   const assay_report_picture *p)
{
    assay_report_open(text, key, '{');
    assay_report_put_number(text, "id", p->id);
    assay_report_put_number(text, "planes", p->planes);
    assay_report_put_number(text, "steps", p->steps);
    assay_report_put_number(text, "floor", p->floor);
    assay_report_close(text, '}');
}
