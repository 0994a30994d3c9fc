/* report_write.c - the page from end to end.
 *
 * Invariant: the page holds no date and no path of this machine, and its pictures and numbers are
 * the same whenever it is written again from the same files.  One candidate is in memory at a time.
 */
#include <stdio.h>
#include <string.h>

#include "assay/metrics.h"
#include "assay/report.h"
#include "core/context.h"
#include "io/heat_color.h"
#include "io/srgb_encode.h"
#include "oracle/report/report_entry.h"
#include "oracle/report/report_folder.h"
#include "oracle/report/report_page.h"
#include "oracle/report/report_verdict.h"
#include "scene/scene_text.h"

assay_report_options assay_report_options_default(void)
{
    return (assay_report_options){.reference = NULL};
}

typedef struct {
    assay_report_writer   writer;
    assay_report_list     list;
    assay_report_verdict *verdicts;
    size_t                verdict_count;
} report;

/* The title that was asked for, or the scene's name, or the reference's. */
static void find_title(const assay_report_options *options, const assay_report_source *reference,
                       char title[ASSAY_REPORT_NAME_SIZE])
{
    const char *scene = assay_image_get_attribute(reference->image, "assay:scene.file");
    assay_text_clean(options->title ? options->title
                     : scene        ? scene
                                    : reference->name,
                     title, ASSAY_REPORT_NAME_SIZE);
    char *dot = strrchr(title, '.');
    if (!options->title && scene && dot && dot > title) {
        *dot = '\0';
    }
}

/* The scales of `assay diff --heat-map` and of FLIP, so that both paint alike. */
enum { SHADES = 65 };

static void put_shade(assay_report_text *text, double r, double g, double b)
{
    char hex[8];
    snprintf(hex, sizeof hex, "#%02x%02x%02x", assay_srgb_encode8(r), assay_srgb_encode8(g),
             assay_srgb_encode8(b));
    assay_report_put_text(text, NULL, hex);
}

static void put_heat(assay_report_text *text)
{
    assay_report_open(text, "heat", '[');
    for (int i = 0; i < SHADES; i++) {
        const assay_rgb c = assay_heat_color((double)i / (SHADES - 1));
        put_shade(text, c.r, c.g, c.b);
    }
    assay_report_close(text, ']');
}

static assay_status put_magma(assay_context *context, assay_report_text *text)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_image             *ramp = NULL, *colours = NULL;
    assay_channel            channel, rgb[3];
    assay_status             status = assay_image_create(context, SHADES, 1, &ramp);
    status = status ? status : assay_image_add_channel(ramp, "t", ASSAY_CHANNEL_FLOAT, &channel);
    for (int i = 0; status == ASSAY_OK && i < SHADES; i++) {
        channel.data.f32[i] = (float)i / (float)(SHADES - 1);
    }
    status = status ? status : assay_image_magma(ramp, "t", 0.0, 1.0, &colours);
    if (status == ASSAY_OK) {
        for (int c = 0; c < 3; c++) {
            assay_image_find_channel(colours, names[c], &rgb[c]);
        }
        assay_report_open(text, "magma", '[');
        for (int i = 0; i < SHADES; i++) {
            put_shade(text, rgb[0].data.f32[i], rgb[1].data.f32[i], rgb[2].data.f32[i]);
        }
        assay_report_close(text, ']');
    }
    assay_image_destroy(ramp);
    assay_image_destroy(colours);
    return status;
}

static assay_status put_head(report *r, const char *title)
{
    assay_report_text *text = r->writer.text;
    assay_report_put_raw(text, assay_report_page_before_title);
    assay_report_put_raw(text, "<title>");
    assay_report_put_html(text, title);
    assay_report_put_raw(text, " - assay report</title>\n");
    assay_report_put_raw(text, assay_report_page_before_data);
    assay_report_put_raw(text, "<script type=\"application/json\" class=\"page\">");
    assay_report_open(text, NULL, '{');
    assay_report_put_text(text, "title", title);
    assay_report_put_text(text, "tool", assay_version());
    put_heat(text);
    const assay_status status = put_magma(r->writer.context, text);
    assay_report_close(text, '}');
    assay_report_put_raw(text, "</script>\n");
    return status;
}

static assay_status check_size(assay_context *context, const assay_report_source *a,
                               const assay_report_source *b)
{
    const int width = assay_image_width(a->image), height = assay_image_height(a->image);
    if (assay_image_width(b->image) == width && assay_image_height(b->image) == height) {
        return ASSAY_OK;
    }
    return assay_fail(
        context, ASSAY_ERR_ARGUMENT, "%s: is of %d x %d pixels, and the reference %s of %d x %d",
        b->path, assay_image_width(b->image), assay_image_height(b->image), a->path, width, height);
}

static assay_status put_candidate(report *r, const assay_report_source *reference, size_t index)
{
    assay_context      *context   = r->writer.context;
    assay_report_source candidate = {.image = NULL};
    const char         *path      = r->list.candidates[index];
    const char         *verdict   = NULL;
    char               *own       = NULL;
    assay_status        status    = assay_report_source_read(context, path, &candidate);
    status                        = status ? status : check_size(context, reference, &candidate);
    if (status == ASSAY_OK) {
        assay_report_list_label(&r->list, index, candidate.label);
        status = assay_report_verdict_find(context, path, r->list.count == 1, r->verdicts,
                                           r->verdict_count, &verdict, &own);
    }
    if (status == ASSAY_OK) {
        status = assay_report_put_candidate(&r->writer, reference, &candidate, verdict);
    }
    assay_text_destroy(context, own);
    assay_report_source_release(&candidate);
    return status;
}

static assay_status check_verdicts(const report *r)
{
    for (size_t i = 0; i < r->verdict_count; i++) {
        if (!r->verdicts[i].used) {
            return assay_fail(r->writer.context, ASSAY_ERR_ARGUMENT,
                              "a verdict is of '%.200s', which is none of the candidates",
                              r->verdicts[i].candidate);
        }
    }
    return ASSAY_OK;
}

static assay_status put_page(report *r, const assay_report_options *options)
{
    char                title[ASSAY_REPORT_NAME_SIZE];
    assay_context      *context   = r->writer.context;
    assay_report_source reference = {.image = NULL};
    assay_status        status = assay_report_source_read(context, r->list.reference, &reference);
    if (status == ASSAY_OK) {
        find_title(options, &reference, title);
        status = put_head(r, title);
        status = status ? status : assay_report_put_reference(&r->writer, &reference);
    }
    for (size_t i = 0; status == ASSAY_OK && i < r->list.count; i++) {
        status = assay_progress(context, "report", i, r->list.count);
        status = status ? status : put_candidate(r, &reference, i);
    }
    status = status ? status : assay_progress(context, "report", r->list.count, r->list.count);
    status = status ? status : check_verdicts(r);
    assay_report_put_raw(r->writer.text, assay_report_page_after_data);
    assay_report_source_release(&reference);
    return status;
}

static assay_status write_page(report *r, const assay_report_options *options, const char *path)
{
    assay_report_text text   = {.file = NULL};
    assay_status      status = assay_atomic_file_open(r->writer.context, path, &text.file);
    if (status != ASSAY_OK) {
        return status;
    }
    r->writer.text = &text;
    status         = put_page(r, options);
    r->writer.text = NULL;
    if (status != ASSAY_OK) {
        assay_atomic_file_discard(text.file);
        return status;
    }
    return assay_atomic_file_commit(text.file);
}

assay_status assay_report_write(assay_context *context, const assay_report_options *options,
                                const char *path)
{
    report       r      = {.writer = {.context = context}, .verdict_count = options->verdict_count};
    assay_status status = assay_report_list_make(context, options, &r.list);
    status = status ? status : assay_report_verdicts_read(context, options, &r.verdicts);
    status = status ? status : write_page(&r, options, path);
    assay_report_verdicts_release(context, r.verdicts, r.verdict_count);
    assay_report_list_release(context, &r.list);
    return status;
}
