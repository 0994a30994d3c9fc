/* report_entry.c - Invariant: numbers, maps and histograms come from the images as they were read;
 * only what is shown as a picture is quantised.
 *
 * Every picture is a <script type="text/plain"> of its own, so that a browser keeps it as text and
 * runs nothing of it.  Budgets are bits a pixel: a pair of 1920 x 1080 with all maps stays near 10
 * MB in base64, and small images are kept as finely as the finest step allows. */
#include "oracle/report_entry.h"

#include <math.h>
#include <stdio.h>

#include "assay/compare.h"
#include "core/context.h"
#include "core/numerics.h"
#include "oracle/report_maps.h"
#include "oracle/report_pack.h"
#include "oracle/report_records.h"
#include "scene/scene_text.h"

static const int COLOUR_STEPS[] = {256, 128, 64, 32, 16, 0}; /* a power of two */
static const int MAP_STEPS[]    = {32, 16, 8, 4, 0};

enum { TEXT_SIZE = 4096 };

typedef struct {
    int    id, planes, steps;
    double floor;
} picture;

static assay_status put_picture(assay_report_writer *writer, const assay_image *size, int planes,
                                const float *const *values, double floor, picture *out)
{
    const int    width = assay_image_width(size), height = assay_image_height(size);
    const double pixels = (double)width * height;
    const size_t budget =
        (size_t)(planes == 3 ? fmax(393216.0, 9.0 / 8.0 * pixels) : fmax(98304.0, 2.5 / 8.0 * pixels));
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
    *out = (picture){writer->pictures++, planes, pack.steps, pack.floor};
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
            frexp(values[i], &exponent);
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
static assay_status put_colour(assay_report_writer *writer, const assay_image *image, picture *out)
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

static assay_status put_map(assay_report_writer *writer, const assay_image *size,
                            const float *values, picture *out)
{
    const double most = usual_maximum(values, pixels_of(size));
    return put_picture(writer, size, 1, &values,
                       most > 0.0 ? most : typical(&values, 1, pixels_of(size)), out);
}

/* ---- what is known ---- */

static void put_clean(assay_report_text *text, const char *key, const char *value)
{
    char clean[TEXT_SIZE];
    assay_text_clean(value, clean, sizeof clean);
    assay_report_put_text(text, key, clean);
}

static void describe_picture(assay_report_text *text, const char *key, const picture *p)
{
    assay_report_open(text, key, '{');
    assay_report_put_number(text, "id", p->id);
    assay_report_put_number(text, "planes", p->planes);
    assay_report_put_number(text, "steps", p->steps);
    assay_report_put_number(text, "floor", p->floor);
    assay_report_close(text, '}');
}

static void describe_histogram(assay_report_text *text, const char *key,
                               const assay_report_histogram *h)
{
    assay_report_open(text, key, '{');
    assay_report_put_number(text, "low", h->low);
    assay_report_put_number(text, "step", h->step);
    assay_report_put_number(text, "below", (double)h->below);
    assay_report_put_number(text, "above", (double)h->above);
    assay_report_put_number(text, "notFinite", (double)h->not_finite);
    assay_report_put_number(text, "equal", (double)h->equal);
    assay_report_open(text, "count", '[');
    for (int i = 0; i < h->bins; i++) {
        assay_report_put_number(text, NULL, (double)h->count[i]);
    }
    assay_report_close(text, ']');
    assay_report_close(text, '}');
}

static void describe_attributes(assay_report_text *text, const assay_image *image)
{
    assay_report_open(text, "attributes", '[');
    for (int i = 0; i < assay_image_attribute_count(image); i++) {
        const char *name, *value;
        assay_image_attribute_at(image, i, &name, &value);
        assay_report_open(text, NULL, '[');
        put_clean(text, NULL, name);
        put_clean(text, NULL, value);
        assay_report_close(text, ']');
    }
    assay_report_close(text, ']');
}

static void describe_cost(assay_report_text *text, const assay_report_source *source)
{
    static const struct {
        const char *key, *name, *inside;
    } numbers[] = {{"seconds", "seconds", "render"}, {"records", "records", NULL},
                   {"rays", "rays", "total"},        {"memory", "memory_bytes", "peak"},
                   {"threads", "threads", NULL}};
    if (!source->stats) {
        return;
    }
    assay_report_open(text, "cost", '{');
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        assay_report_put_number(
            text, numbers[i].key,
            assay_report_source_stat(source, numbers[i].name, numbers[i].inside));
    }
    assay_report_close(text, '}');
}

static assay_status describe_source(assay_report_text *text, const assay_report_source *source,
                                    const picture *colour)
{
    assay_report_histogram luminance;
    const char            *method = assay_report_source_method(source);
    assay_report_put_text(text, "name", source->name);
    if (method) {
        put_clean(text, "method", method);
    }
    assay_report_put_number(text, "width", assay_image_width(source->image));
    assay_report_put_number(text, "height", assay_image_height(source->image));
    assay_report_put_number(text, "samples", assay_report_source_samples(source));
    describe_picture(text, "colour", colour);
    assay_report_luminance(source->image, &luminance);
    describe_histogram(text, "luminance", &luminance);
    describe_attributes(text, source->image);
    describe_cost(text, source);
    return assay_report_records_put(source, text);
}

/* ---- what differs ---- */

static bool is_colour(const char *name)
{
    return (name[0] == 'R' || name[0] == 'G' || name[0] == 'B') && name[1] == '\0';
}

static assay_status describe_channels(assay_report_text *text, const assay_image *reference,
                                      const assay_image *candidate)
{
    assay_comparison  *comparison = NULL;
    const assay_status status     = assay_image_compare(reference, candidate, &comparison);
    if (status != ASSAY_OK) {
        return status;
    }
    assay_report_open(text, "channels", '[');
    for (int i = 0; i < assay_comparison_count(comparison); i++) {
        const assay_channel_difference d = assay_comparison_at(comparison, i);
        if (!is_colour(d.channel)) {
            continue;
        }
        assay_report_open(text, NULL, '{');
        assay_report_put_text(text, "channel", d.channel);
        assay_report_put_number(text, "differing", (double)d.differing);
        assay_report_put_number(text, "notFinite", (double)d.not_finite);
        assay_report_put_number(text, "meanReference", d.mean_a);
        assay_report_put_number(text, "meanCandidate", d.mean_b);
        assay_report_put_number(text, "maxAbs", d.max_abs);
        assay_report_put_number(text, "maxX", d.max_x);
        assay_report_put_number(text, "maxY", d.max_y);
        assay_report_put_number(text, "rmse", d.rmse);
        assay_report_put_number(text, "relativeRmse", d.relative_rmse);
        assay_report_put_number(text, "bias", d.mean_error);
        assay_report_put_number(text, "zRms", d.z_rms);
        assay_report_close(text, '}');
    }
    assay_report_close(text, ']');
    assay_comparison_destroy(comparison);
    return ASSAY_OK;
}

typedef struct {
    picture colour, difference, relative, z;
} candidate_pictures;

static assay_status put_candidate_pictures(assay_report_writer *writer, const assay_image *image,
                                           const assay_report_maps *maps, candidate_pictures *out)
{
    assay_status status = put_colour(writer, image, &out->colour);
    status = status ? status : put_map(writer, image, maps->difference, &out->difference);
    status = status ? status : put_map(writer, image, maps->relative, &out->relative);
    return status || !maps->z ? status : put_map(writer, image, maps->z, &out->z);
}

static void describe_maps(assay_report_text *text, const assay_report_maps *maps,
                          const candidate_pictures *pictures)
{
    assay_report_put_number(text, "noise", maps->noise);
    assay_report_open(text, "maps", '{');
    describe_picture(text, "difference", &pictures->difference);
    describe_picture(text, "relative", &pictures->relative);
    if (maps->z) {
        describe_picture(text, "z", &pictures->z);
    }
    assay_report_close(text, '}');
    describe_histogram(text, "relativeHistogram", &maps->relative_histogram);
    if (maps->z) {
        describe_histogram(text, "zHistogram", &maps->z_histogram);
    }
}

static void open_entry(assay_report_writer *writer, const char *kind)
{
    assay_report_put_raw(writer->text, "<script type=\"application/json\" class=\"");
    assay_report_put_raw(writer->text, kind);
    assay_report_put_raw(writer->text, "\">");
    writer->text->comma = false;
    assay_report_open(writer->text, NULL, '{');
}

static void close_entry(assay_report_writer *writer)
{
    assay_report_close(writer->text, '}');
    assay_report_put_raw(writer->text, "</script>\n");
}

assay_status assay_report_put_reference(assay_report_writer       *writer,
                                        const assay_report_source *reference)
{
    picture      colour;
    assay_status status = put_colour(writer, reference->image, &colour);
    if (status == ASSAY_OK) {
        open_entry(writer, "reference");
        status = describe_source(writer->text, reference, &colour);
        close_entry(writer);
    }
    return status;
}

assay_status assay_report_put_candidate(assay_report_writer       *writer,
                                        const assay_report_source *reference,
                                        const assay_report_source *candidate, const char *verdict)
{
    assay_report_maps  maps;
    candidate_pictures pictures;
    assay_status       status =
        assay_report_maps_create(writer->context, reference->image, candidate->image, &maps);
    if (status != ASSAY_OK) {
        return status;
    }
    status = put_candidate_pictures(writer, candidate->image, &maps, &pictures);
    if (status == ASSAY_OK) {
        open_entry(writer, "candidate");
        status = describe_source(writer->text, candidate, &pictures.colour);
        status = status ? status
                        : describe_channels(writer->text, reference->image, candidate->image);
        describe_maps(writer->text, &maps, &pictures);
        if (verdict) {
            assay_report_put_json(writer->text, "verdict", verdict);
        }
        close_entry(writer);
    }
    assay_report_maps_release(writer->context, &maps);
    return status;
}
