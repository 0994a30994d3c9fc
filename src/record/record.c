/* record.c - the functions of record_inline.h as others call them. */
#include "record/record_inline.h"

#include "core/numerics.h"

double assay_record_reach(const assay_record *record, const assay_record_rules *rules)
{
    return record_reach(record, rules);
}

/* sqrt(1 - n . n_k) <= a, or a sqrt(1 - cos 10 deg); 1 - cos is 2 sin^2 of the half. */
double assay_record_tilt_max(const assay_record_rules *rules)
{
    const double most =
        rules->weight == ASSAY_WEIGHT_TABELLION ? rules->a * RECORD_ROOT_10_DEG : rules->a;
    const double half = most * sqrt(0.5);
    return half < 1.0 ? 2.0 * assay_asin(half) : ASSAY_PI;
}

double assay_record_weight(const assay_record *record, const assay_record_rules *rules,
                           assay_vec3 position, assay_vec3 normal)
{
    return record_weight(record, rules, position, normal);
}

assay_rgb assay_record_extrapolate(const assay_record *record, const assay_record_rules *rules,
                                   assay_vec3 position, assay_vec3 normal)
{
    return record_extrapolate(record, rules, position, normal);
}
