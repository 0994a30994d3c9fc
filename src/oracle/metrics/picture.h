/* picture.h - one colour layer of two images, checked; private to oracle. */
#ifndef ASSAY_ORACLE_PICTURE_H
#define ASSAY_ORACLE_PICTURE_H

#include "assay/metrics.h"

enum { ASSAY_LAYER_NAME = 300 };

/* The name of channel c (0, 1, 2) of a layer: "R", or "Indirect.R". */
void assay_layer_channel(const char *layer, int c, char name[ASSAY_LAYER_NAME]);

/* Borrowed from the images; every value is finite. */
typedef struct {
    assay_context *context;
    int            width, height;
    const float   *a[3], *b[3];
} assay_picture_pair;

/* Errors as metrics.h says for images; does not look at the rest of the options. */
assay_status assay_picture_pair_open(const assay_image *a, const assay_image *b, const char *layer,
                                     assay_picture_pair *pair_out);

/* ARGUMENT where an option is out of its range. */
assay_status assay_metrics_check(assay_context *context, const assay_metrics_options *options);

#endif
