/* critical_values.c - a table over the logarithm of the degrees, filled where it is asked.
 *
 * Invariant: t[i] is 0 (not asked yet) or the quantile at 2^(i/4 - 1) degrees; the last is the
 * normal one. */
#include "oracle/image/critical_values.h"

#include "core/numerics.h"
#include "oracle/image/student.h"

assay_critical_values assay_critical_values_at(double log_p)
{
    return (assay_critical_values){.log_p = log_p};
}

assay_critical_values assay_critical_values_exact(double log_p)
{
    return (assay_critical_values){.log_p = log_p, .exact = true};
}

double assay_critical_value(assay_critical_values *values, double degrees)
{
    if (values->exact) {
        return assay_student_quantile(values->log_p, degrees);
    }
    double step = degrees >= 0x1p28
                      ? ASSAY_CRITICAL_STEPS - 1.0
                      : assay_floor(4.0 * (assay_log(degrees) / assay_log(2.0) + 1.0));
    step        = step < 0.0 ? 0.0 : fmin(step, ASSAY_CRITICAL_STEPS - 1.0);
    const int i = (int)step;
    if (values->t[i] == 0.0) {
        values->t[i] = assay_student_quantile(values->log_p, i == ASSAY_CRITICAL_STEPS - 1
                                                                 ? ASSAY_NORMAL
                                                                 : assay_exp2(i / 4.0 - 1.0));
    }
    return values->t[i];
}
