/* report_picture.h - pictures of a page: packed, written, and told of in JSON. */
#ifndef ASSAY_ORACLE_REPORT_PICTURE_H
#define ASSAY_ORACLE_REPORT_PICTURE_H

#include "assay/image.h"
#include "oracle/report/report_text.h"

typedef struct {
    assay_context     *context;
    assay_report_text *text;
    int                pictures; /* written so far: their numbers */
} assay_report_writer;

/* What the page must know to unpack one (report_pack.h). */
typedef struct {
    int    id, planes, steps;
    double floor;
} assay_report_picture;

/* R, G and B of an image.  Errors: MEMORY. */
assay_status assay_report_put_colour(assay_report_writer *writer, const assay_image *image,
                                     assay_report_picture *out);
/* One number a pixel of an image of that size.  Its floor is what nearly all values are below, and
 * no more than `scale`, up to which the page begins to show it.  Errors: MEMORY. */
assay_status assay_report_put_map(assay_report_writer *writer, const assay_image *size,
                                  const float *values, double scale, assay_report_picture *out);

void assay_report_describe_picture(assay_report_text *text, const char *key,
                                   const assay_report_picture *picture);

#endif
