/* report_entry.c - Invariant: numbers, maps and histograms come from the images as they were read;
 * only what is shown as a picture is quantised. */
#include "oracle/report/report_entry.h"

#include <math.h>
#include <stdio.h>

#include "assay/compare.h"
#include "assay/metrics.h"
#include "core/context.h"
#include "core/numerics.h"
#include "oracle/report/report_maps.h"
#include "oracle/report/report_records.h"
#include "oracle/report/report_stale.h"
#include "scene/scene_text.h"

enum { TEXT_SIZE = 4096 };

/* ---- what is known ---- */

/* Where the page's scales of maps begin (report/colour.js); that of a difference is its floor. */
static const double RELATIVE_SCALE = 0.25, Z_SCALE = 4.0, FLIP_SCALE = 1.0;

static void put_clean(assay_report_text *text, const char *key, const char *value)
{
    char clean[TEXT_SIZE];
    assay_text_clean(value, clean, sizeof clean);
    assay_report_put_text(text, key, clean);
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
    } numbers[] = {{"seconds", "seconds", "render"},
                   {"records", "records", NULL},
                   {"rays", "rays", "total"},
                   {"memory", "memory_bytes", "peak"},
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
                                    const assay_report_picture *colour)
{
    assay_report_histogram luminance;
    const char            *method = assay_report_source_method(source);
    assay_report_put_text(text, "name", source->label);
    assay_report_put_text(text, "file", source->name);
    if (method) {
        put_clean(text, "method", method);
    }
    assay_report_put_number(text, "width", assay_image_width(source->image));
    assay_report_put_number(text, "height", assay_image_height(source->image));
    assay_report_put_number(text, "samples", assay_report_source_samples(source));
    assay_report_describe_picture(text, "colour", colour);
    assay_report_put_number(text, "exposure", assay_report_exposure(source->image));
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
    assay_report_picture colour, difference, relative, z, flip;
} candidate_pictures;

/* How different the images look; map is NULL where a value is not finite. */
typedef struct {
    assay_image       *map;
    assay_flip_summary flip;
    double             ssim, exposure;
} appearance;

static assay_status judge_appearance(const assay_image *reference, const assay_image *candidate,
                                     appearance *out)
{
    assay_metrics_options options = assay_metrics_defaults();
    options.exposure              = assay_report_exposure(reference);
    out->exposure                 = options.exposure;
    assay_status status =
        assay_image_flip(reference, candidate, ASSAY_FLIP_HDR, &options, &out->flip, &out->map);
    if (status == ASSAY_OK) {
        status = assay_image_ssim(reference, candidate, &options, &out->ssim);
    }
    return status == ASSAY_ERR_DOMAIN ? ASSAY_OK : status;
}

static assay_status put_flip_map(assay_report_writer *writer, const appearance *look,
                                 assay_report_picture *out)
{
    assay_channel channel;
    if (!look->map || !assay_image_find_channel(look->map, "FLIP", &channel)) {
        return ASSAY_OK;
    }
    return assay_report_put_map(writer, look->map, channel.data.f32, FLIP_SCALE, out);
}

static void describe_appearance(assay_report_text *text, const appearance *look)
{
    if (!look->map) {
        return;
    }
    assay_report_open(text, "flip", '{');
    assay_report_put_number(text, "mean", look->flip.mean);
    assay_report_put_number(text, "weightedMedian", look->flip.weighted_median);
    assay_report_put_number(text, "maximum", look->flip.maximum);
    assay_report_put_number(text, "maxX", look->flip.max_x);
    assay_report_put_number(text, "maxY", look->flip.max_y);
    assay_report_put_number(text, "startExposure", look->flip.start_exposure);
    assay_report_put_number(text, "stopExposure", look->flip.stop_exposure);
    assay_report_close(text, '}');
    assay_report_put_number(text, "ssim", look->ssim);
    assay_report_put_number(text, "ssimExposure", look->exposure);
}

static assay_status put_candidate_pictures(assay_report_writer *writer, const assay_image *image,
                                           const assay_report_maps *maps, const appearance *look,
                                           candidate_pictures *out)
{
    assay_status status = assay_report_put_colour(writer, image, &out->colour);
    status =
        status ? status
               : assay_report_put_map(writer, image, maps->difference, INFINITY, &out->difference);
    status = status ? status
                    : assay_report_put_map(writer, image, maps->relative, RELATIVE_SCALE,
                                           &out->relative);
    if (status == ASSAY_OK && maps->z) {
        status = assay_report_put_map(writer, image, maps->z, Z_SCALE, &out->z);
    }
    return status ? status : put_flip_map(writer, look, &out->flip);
}

static void describe_maps(assay_report_text *text, const assay_report_maps *maps,
                          const appearance *look, const candidate_pictures *pictures)
{
    assay_report_put_number(text, "noise", maps->noise);
    assay_report_open(text, "maps", '{');
    assay_report_describe_picture(text, "difference", &pictures->difference);
    assay_report_describe_picture(text, "relative", &pictures->relative);
    if (maps->z) {
        assay_report_describe_picture(text, "z", &pictures->z);
    }
    if (look->map) {
        assay_report_describe_picture(text, "flip", &pictures->flip);
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
    assay_report_picture colour;
    assay_status         status = assay_report_put_colour(writer, reference->image, &colour);
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
    appearance         look = {.map = NULL};
    assay_status       status =
        assay_report_maps_create(writer->context, reference->image, candidate->image, &maps);
    if (status != ASSAY_OK) {
        return status;
    }
    status = judge_appearance(reference->image, candidate->image, &look);
    if (status == ASSAY_OK) {
        status = put_candidate_pictures(writer, candidate->image, &maps, &look, &pictures);
    }
    if (status == ASSAY_OK) {
        open_entry(writer, "candidate");
        status = describe_source(writer->text, candidate, &pictures.colour);
        status =
            status ? status : describe_channels(writer->text, reference->image, candidate->image);
        describe_maps(writer->text, &maps, &look, &pictures);
        describe_appearance(writer->text, &look);
        if (status == ASSAY_OK && verdict) {
            assay_report_put_json(writer->text, "verdict", verdict);
            status = assay_report_stale_put(writer->context, writer->text, reference, candidate,
                                            verdict);
        }
        close_entry(writer);
    }
    assay_image_destroy(look.map);
    assay_report_maps_release(writer->context, &maps);
    return status;
}
