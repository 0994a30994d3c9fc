/* mean_bound.h - between which numbers a mean by weight may lie whose weights and values are known
 * within bounds. */
#ifndef ASSAY_ORACLE_MEAN_BOUND_H
#define ASSAY_ORACLE_MEAN_BOUND_H

#include <stddef.h>

#include "oracle/stage/tracked.h"

/* One of the mean: weight in [low, high], and what is averaged. */
typedef struct {
    double  low, high;
    tracked said[3];
} mean_part;

/* The largest mean of x[i] = sign * said[channel] + its error over all weights; the sum of the high
 * weights must be > 0.  With weights that may all be 0, a mean of any of them. */
double mean_highest(const mean_part *parts, size_t count, int channel, double sign);

/* How far sum(w s) / sum(w), computed in any order, may be from `value`. */
double mean_bound(const rounding *r, const mean_part *parts, size_t count, int channel,
                  double value);

#endif
