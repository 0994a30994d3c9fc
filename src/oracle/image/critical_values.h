/* critical_values.h - quantiles of Student's t at one level, for many degrees of freedom, fast. */
#ifndef ASSAY_ORACLE_CRITICAL_VALUES_H
#define ASSAY_ORACLE_CRITICAL_VALUES_H

#include <stdbool.h>

enum { ASSAY_CRITICAL_STEPS = 120 };

typedef struct {
    double log_p; /* two-sided */
    bool   exact; /* at the very degrees, slow: for single values */
    double t[ASSAY_CRITICAL_STEPS];
} assay_critical_values;

assay_critical_values assay_critical_values_at(double log_p);
assay_critical_values assay_critical_values_exact(double log_p);

/* The quantile; unless exact, that at the next lower of degrees 2^(i/4): never too small, and at
 * most 1 percent too large from 20 degrees on. */
double assay_critical_value(assay_critical_values *values, double degrees);

#endif
