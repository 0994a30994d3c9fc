/* radiance_rows.h - what records of radiance say: their coefficients moved to a point, turned into
 * its frame, averaged by weight. */
#ifndef ASSAY_RECORD_RADIANCE_ROWS_H
#define ASSAY_RECORD_RADIANCE_ROWS_H

#include "record/radiance_turn.h"
#include "record/record_store.h"

/* Borrowed: row k belongs to record k. */
typedef struct {
    size_t               count; /* of a row: 3 times the basis's                              */
    const double        *coefficients; /* in frame3_from_z of the record's normal, W/(m2 sr) */
    const assay_vec3    *gradients;    /* the same, W/(m3 sr), or NULL                       */
    assay_radiance_turn *turn;
} assay_radiance_rows;

/* What record `number` says of the radiance at a point, in the frame `here`, whose z is the normal
 * there.  Errors: DOMAIN (no frame). */
assay_status assay_radiance_rows_say(const assay_radiance_rows *rows, const assay_record *record,
                                     uint32_t number, assay_vec3 position, const assay_frame3 *here,
                                     int worker, double *coefficients_out);

/* A row from one frame into another, in place; nothing changes where both are the same.  Errors:
 * DOMAIN (no frame). */
assay_status assay_radiance_rows_turn(const assay_radiance_rows *rows, const assay_frame3 *from,
                                      const assay_frame3 *to, int worker, double *coefficients);

/* Eq. 2.8 for rows: the mean of what the records that were found say at the point, in its frame,
 * whose z is the normal there; found->count > 0.  records: all of them.  scratch: two rows. Errors:
 * DOMAIN. */
assay_status assay_radiance_rows_mean(const assay_radiance_rows *rows, const assay_record *records,
                                      const assay_contributions *found, assay_vec3 position,
                                      const assay_frame3 *frame, int worker, double *scratch,
                                      double *coefficients_out);

#endif
