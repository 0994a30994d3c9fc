/* student.h - tails of Student's t and of the normal distribution, as logarithms.
 *
 * Degrees of freedom need not be whole (Welch and Satterthwaite); ASSAY_NORMAL degrees are the
 * normal distribution.  Within 1e-12 of log p for degrees from 0.5 and |t| up to 1e100, also where
 * p is far below the smallest double. */
#ifndef ASSAY_ORACLE_STUDENT_H
#define ASSAY_ORACLE_STUDENT_H

#define ASSAY_NORMAL 1e300

/* log of P(|T| >= |t|): 0 for t = 0, -infinity for an infinite t, NaN for a NaN.  degrees > 0. */
double assay_student_log_p(double t, double degrees);

/* The t >= 0 with P(|T| >= t) = exp(log_p), log_p <= 0; infinity where no double is that large. */
double assay_student_quantile(double log_p, double degrees);

#endif
