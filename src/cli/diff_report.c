/* diff_report.c - the table and the JSON of `assay diff`. */
#include "diff_report.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>

static const char *const FLIP_NAMES[2] = {"LDR-FLIP", "HDR-FLIP"};
static const char *const FLIP_KEYS[2]  = {"flip_ldr", "flip_hdr"};

/* Channels that the other image lacks. */
static void print_missing(const assay_image *image, const assay_image *other, const char *who)
{
    for (int i = 0; i < assay_image_channel_count(image); i++) {
        const char *name = assay_image_channel_at(image, i).name;
        if (!assay_image_find_channel(other, name, NULL)) {
            printf("only in %s: %s\n", who, name);
        }
    }
}

static void print_flip(const diff_report *report, assay_flip_kind kind)
{
    const assay_flip_summary *f = &report->flip[kind];
    printf("%s  mean %.6f  weighted median %.6f, quartiles %.6f, %.6f  min %.6f  max %.6f at "
           "(%d, %d)",
           FLIP_NAMES[kind], f->mean, f->weighted_median, f->first_quartile, f->third_quartile,
           f->minimum, f->maximum, f->max_x, f->max_y);
    if (kind == ASSAY_FLIP_HDR) {
        printf("  (%s, %d exposures, %.4f to %.4f)",
               assay_tone_mapper_name(report->options.tone_mapper), f->exposures, f->start_exposure,
               f->stop_exposure);
    }
    printf("\n");
}

static void print_picture(const diff_report *report)
{
    const assay_color_difference *c     = &report->color;
    const char                   *layer = report->options.layer;
    printf("%s%sRGB  mse %.6g  relMSE %.6g  rmse %.6g  rel. rmse %.6g  mean offset %.6g", layer,
           layer[0] ? "." : "", c->mse, c->relative_mse, c->rmse, c->relative_rmse, c->mean_error);
    if (c->mean_a != 0.0) {
        printf(" (%.3g %%)", 100.0 * c->mean_error / c->mean_a);
    }
    if (isnan(report->ssim)) {
        printf("\nSSIM  - (less than 11 pixels)\n");
    } else {
        printf("\nSSIM  %.6f\n", report->ssim);
    }
    for (int kind = 0; kind < 2; kind++) {
        if (report->has_flip[kind]) {
            print_flip(report, (assay_flip_kind)kind);
        }
    }
    printf("\n");
}

void diff_print_table(const diff_report *report)
{
    printf("%-24s %10s %13s %13s %13s %12s %12s %8s\n", "channel", "differing", "mean A",
           "mean error", "rmse", "relMSE", "rel. rmse", "z rms");
    for (int i = 0; i < assay_comparison_count(report->comparison); i++) {
        const assay_channel_difference d = assay_comparison_at(report->comparison, i);
        printf("%-24s %10llu %13.6g %13.6g %13.6g %12.6g %12.6g ", d.channel,
               (unsigned long long)d.differing, d.mean_a, d.mean_error, d.rmse, d.relative_mse,
               d.relative_rmse);
        if (isnan(d.z_rms)) {
            printf("%8s\n", "-");
        } else {
            printf("%8.3f\n", d.z_rms);
        }
    }
    printf("\n");
    print_missing(report->a, report->b, "A");
    print_missing(report->b, report->a, "B");
    if (report->has_picture) {
        print_picture(report);
    }
    printf("%s\n", assay_comparison_identical(report->comparison) ? "identical" : "different");
}

static bool add_channel(cJSON *list, const assay_channel_difference *d)
{
    cJSON *json = cJSON_CreateObject();
    if (!json || !cJSON_AddItemToArray(list, json)) {
        cJSON_Delete(json);
        return false;
    }
    return cJSON_AddStringToObject(json, "channel", d->channel) &&
           cJSON_AddNumberToObject(json, "pixels", (double)d->pixels) &&
           cJSON_AddNumberToObject(json, "differing", (double)d->differing) &&
           cJSON_AddNumberToObject(json, "not_finite", (double)d->not_finite) &&
           cJSON_AddNumberToObject(json, "mean_a", d->mean_a) &&
           cJSON_AddNumberToObject(json, "mean_b", d->mean_b) &&
           cJSON_AddNumberToObject(json, "max_abs", d->max_abs) &&
           cJSON_AddNumberToObject(json, "max_x", d->max_x) &&
           cJSON_AddNumberToObject(json, "max_y", d->max_y) &&
           cJSON_AddNumberToObject(json, "mse", d->mse) &&
           cJSON_AddNumberToObject(json, "rmse", d->rmse) &&
           cJSON_AddNumberToObject(json, "relative_mse", d->relative_mse) &&
           cJSON_AddNumberToObject(json, "relative_rmse", d->relative_rmse) &&
           cJSON_AddNumberToObject(json, "mean_error", d->mean_error) &&
           cJSON_AddNumberToObject(json, "z_rms", d->z_rms);
}

static bool add_flip(cJSON *picture, const diff_report *report, assay_flip_kind kind)
{
    const assay_flip_summary *f = &report->flip[kind];
    if (!report->has_flip[kind]) {
        return cJSON_AddNullToObject(picture, FLIP_KEYS[kind]);
    }
    cJSON *json = cJSON_AddObjectToObject(picture, FLIP_KEYS[kind]);
    return json && cJSON_AddNumberToObject(json, "mean", f->mean) &&
           cJSON_AddNumberToObject(json, "weighted_median", f->weighted_median) &&
           cJSON_AddNumberToObject(json, "first_quartile", f->first_quartile) &&
           cJSON_AddNumberToObject(json, "third_quartile", f->third_quartile) &&
           cJSON_AddNumberToObject(json, "minimum", f->minimum) &&
           cJSON_AddNumberToObject(json, "maximum", f->maximum) &&
           cJSON_AddNumberToObject(json, "max_x", f->max_x) &&
           cJSON_AddNumberToObject(json, "max_y", f->max_y) &&
           cJSON_AddNumberToObject(json, "start_exposure", f->start_exposure) &&
           cJSON_AddNumberToObject(json, "stop_exposure", f->stop_exposure) &&
           cJSON_AddNumberToObject(json, "exposures", f->exposures);
}

static bool add_picture(cJSON *root, const diff_report *report)
{
    const assay_metrics_options  *o = &report->options;
    const assay_color_difference *c = &report->color;
    if (!report->has_picture) {
        return cJSON_AddNullToObject(root, "picture");
    }
    cJSON *json = cJSON_AddObjectToObject(root, "picture");
    return json && cJSON_AddStringToObject(json, "layer", o->layer) &&
           cJSON_AddNumberToObject(json, "exposure", o->exposure) &&
           cJSON_AddNumberToObject(json, "pixels_per_degree", o->pixels_per_degree) &&
           cJSON_AddStringToObject(json, "tone_mapper", assay_tone_mapper_name(o->tone_mapper)) &&
           cJSON_AddNumberToObject(json, "mean_a", c->mean_a) &&
           cJSON_AddNumberToObject(json, "mean_error", c->mean_error) &&
           cJSON_AddNumberToObject(json, "mse", c->mse) &&
           cJSON_AddNumberToObject(json, "rmse", c->rmse) &&
           cJSON_AddNumberToObject(json, "relative_mse", c->relative_mse) &&
           cJSON_AddNumberToObject(json, "relative_rmse", c->relative_rmse) &&
           cJSON_AddNumberToObject(json, "ssim", report->ssim) &&
           add_flip(json, report, ASSAY_FLIP_LDR) && add_flip(json, report, ASSAY_FLIP_HDR);
}

static bool add_missing(cJSON *root, const char *key, const assay_image *image,
                        const assay_image *other)
{
    cJSON *list = cJSON_AddArrayToObject(root, key);
    for (int i = 0; list && i < assay_image_channel_count(image); i++) {
        const char *name = assay_image_channel_at(image, i).name;
        if (!assay_image_find_channel(other, name, NULL)) {
            cJSON *text = cJSON_CreateString(name);
            if (!text || !cJSON_AddItemToArray(list, text)) {
                cJSON_Delete(text);
                return false;
            }
        }
    }
    return list != NULL;
}

bool diff_print_json(const diff_report *report)
{
    const assay_comparison *comparison = report->comparison;
    cJSON                  *root       = cJSON_CreateObject();
    cJSON                  *list       = root ? cJSON_AddArrayToObject(root, "channels") : NULL;
    bool                    ok =
        list && cJSON_AddBoolToObject(root, "identical", assay_comparison_identical(comparison));
    for (int i = 0; ok && i < assay_comparison_count(comparison); i++) {
        const assay_channel_difference d = assay_comparison_at(comparison, i);
        ok                               = add_channel(list, &d);
    }
    ok = ok && add_missing(root, "only_in_a", report->a, report->b) &&
         add_missing(root, "only_in_b", report->b, report->a) && add_picture(root, report);
    char *text = ok ? cJSON_Print(root) : NULL;
    if (text) {
        puts(text);
    }
    cJSON_free(text);
    cJSON_Delete(root);
    return text != NULL;
}
