/* report_source.h - one of the images of a report, wherever it comes from. */
#ifndef ASSAY_ORACLE_REPORT_SOURCE_H
#define ASSAY_ORACLE_REPORT_SOURCE_H

#include <cjson/cJSON.h>

#include "assay/image.h"
#include "io/bundle_read.h"

enum { ASSAY_REPORT_NAME_SIZE = 256, ASSAY_REPORT_PATH_SIZE = 4096, ASSAY_REPORT_LABEL_SIZE = 288 };

typedef struct {
    char path[ASSAY_REPORT_PATH_SIZE];
    char name[ASSAY_REPORT_NAME_SIZE];   /* without folder and ending, UTF-8 */
    char label[ASSAY_REPORT_LABEL_SIZE]; /* what the page calls it: its name, until told apart */
    assay_image *image; /* R, G, B; Variance.R, ..., SampleCount where there are; metadata */
    assay_bundle_reader *bundle; /* NULL where it is an image */
    cJSON *stats; /* what `assay render --stats` wrote beside it; NULL               */
} assay_report_source;

/* Whether a path is a folder with a manifest.json. */
bool assay_report_is_bundle(const char *path);

/* The name of a path: its last part without ".exr" or ".hdr", fit for one line. */
void assay_report_name_of(const char *path, char name_out[ASSAY_REPORT_NAME_SIZE]);

/* Errors: those of assay_image_read and assay_bundle_open; ARGUMENT (no channels R, G and B; too
 * long a name). */
assay_status assay_report_source_read(assay_context *context, const char *path,
                                      assay_report_source *source_out);
void         assay_report_source_release(assay_report_source *source);

/* "path", or NULL where the image does not say. */
const char *assay_report_source_method(const assay_report_source *source);
/* Samples a pixel, the mean over the image; 0 where it is not known. */
double assay_report_source_samples(const assay_report_source *source);
/* A number of the statistics ("seconds", "render"; inside may be NULL); NaN where it is not there.
 */
double assay_report_source_stat(const assay_report_source *source, const char *name,
                                const char *inside);

#endif
