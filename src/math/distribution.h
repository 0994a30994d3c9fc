/* distribution.h - drawing from tables of weights, exactly.
 *
 * A draw costs a binary search and no allocation, is a pure function of its uniform numbers, and is
 * thread-safe.  Weights must be finite and >= 0. */
#ifndef ASSAY_MATH_DISTRIBUTION_H
#define ASSAY_MATH_DISTRIBUTION_H

#include <stddef.h>
#include <stdint.h>

#include "assay/context.h"

/* ---- one dimension ---- */

typedef struct assay_distribution1 assay_distribution1;

/* From `count` weights (copied), 1 <= count <= 2^31.  All zero is legal: total 0, nothing to draw.
 * Errors: ARGUMENT (count), DOMAIN (a weight NaN, infinite or negative, or an infinite sum),
 * MEMORY. */
assay_status assay_distribution1_create(assay_context *context, const double *weights, size_t count,
                                        assay_distribution1 **distribution_out);
void         assay_distribution1_destroy(assay_distribution1 *distribution);

size_t assay_distribution1_count(const assay_distribution1 *distribution);
/* Sum of the weights, in index order. */
double assay_distribution1_total(const assay_distribution1 *distribution);

/* Draws an index from u in [0, 1).  probability_out: what assay_distribution1_probability gives,
 * > 0; remapped_out: where u lies in the index's interval, again uniform in [0, 1).  Either may be
 * NULL.  An index of weight 0 is never drawn.  With total 0: index 0, probability 0, remapped u. */
size_t assay_distribution1_sample(const assay_distribution1 *distribution, double u,
                                  double *probability_out, double *remapped_out);

/* Probability that the index is drawn; 0 for all when the total is 0. */
double assay_distribution1_probability(const assay_distribution1 *distribution, size_t index);

/* ---- two dimensions ---- */

typedef struct assay_distribution2 assay_distribution2;

/* A table of rows * columns weights, row by row (copied): first a row is drawn, then a column in
 * it. Errors as above; rows and columns at least 1, rows * columns <= 2^31. */
assay_status assay_distribution2_create(assay_context *context, const double *weights, size_t rows,
                                        size_t columns, assay_distribution2 **distribution_out);
void         assay_distribution2_destroy(assay_distribution2 *distribution);

/* Sum of the weights: of each row in order, then of the rows. */
double assay_distribution2_total(const assay_distribution2 *distribution);

/* A drawn cell: its probability (0 only where the total is 0) and the point within, in [0, 1)^2. */
typedef struct {
    size_t row, column;
    double probability;
    double in_row, in_column; /* along the rows' axis, along the columns' axis */
} assay_distribution2_cell;

/* u_row, u_column in [0, 1). */
assay_distribution2_cell assay_distribution2_sample(const assay_distribution2 *distribution,
                                                    double u_row, double u_column);
double assay_distribution2_probability(const assay_distribution2 *distribution, size_t row,
                                       size_t column);

#endif
