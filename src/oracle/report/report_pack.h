/* report_pack.h - planes of floats in few bytes, for a browser: quantised, predicted, deflated.
 *
 * A value v is kept as the integer c = sign(v) round(K log2(1 + |v| / floor)); what comes back is
 * sign(c) floor (2^(|c| / K) - 1): wrong by at most half a step, which is 2^(1/K) - 1 of |v| +
 * floor. NaN and infinities are kept as such.  K is the finest of a list that fits a budget. */
#ifndef ASSAY_ORACLE_REPORT_PACK_H
#define ASSAY_ORACLE_REPORT_PACK_H

#include "assay/context.h"

/* Codes of what has no logarithm. */
enum { ASSAY_PACK_NAN = 32767, ASSAY_PACK_INFINITE = 32766, ASSAY_PACK_LARGEST = 32765 };

typedef struct {
    int      width, height;
    int      planes; /* 1, or 3: R, G, B */
    double   floor;
    int      steps; /* K */
    uint8_t *bytes; /* a zlib stream of 2 * planes * width * height bytes */
    size_t   count;
} assay_report_pack;

/* Packs planes of width * height floats.  floor > 0; steps: a list from fine to coarse, at least
 * one, ended by 0; the last is taken where none fits the budget (bytes).  Errors: MEMORY. */
assay_status assay_report_pack_create(assay_context *context, int width, int height, int planes,
                                      const float *const *values, double floor, const int *steps,
                                      size_t budget, assay_report_pack *pack_out);
void         assay_report_pack_release(assay_context *context, assay_report_pack *pack);

#endif
