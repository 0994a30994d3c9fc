/* splat_data.h - inside of a splat buffer; for splat*.c alone. */
#ifndef ASSAY_RECORD_SPLAT_DATA_H
#define ASSAY_RECORD_SPLAT_DATA_H

#include "record/splat.h"

struct assay_splat_buffer {
    assay_context   *context;
    int              width, height, columns, rows; /* pixels; tiles                        */
    size_t           pixels;
    assay_splat_view view;
    double          *x, *y, *z;    /* positions, m                                      */
    double          *nx, *ny, *nz; /* unit normals                                      */
    double          *row_stray;    /* a row: how far its points stray, pixels           */
    double          *sums;         /* 4 a pixel: weight times R, G, B, and weight       */
    uint64_t        *lost;         /* a tile                                            */
};

static inline assay_vec3 splat_position(const assay_splat_buffer *buffer, size_t pixel)
{
    return vec3(buffer->x[pixel], buffer->y[pixel], buffer->z[pixel]);
}

static inline assay_vec3 splat_normal(const assay_splat_buffer *buffer, size_t pixel)
{
    return vec3(buffer->nx[pixel], buffer->ny[pixel], buffer->nz[pixel]);
}

#endif
