/* record_inline.h - what record.h declares, for loops over many points: the same functions, to the
 * bit.
 *
 * Invariant: a weight above 0 means that the point is within assay_record_reach; every index of
 * records leans on it.  The test by squares comes first since most of what an index offers is too
 * far away; it leaves out nothing that the weight would let in, as the reach has 1e-12 to spare and
 * the roundings of d / R + ..., 1 / x and 1 / a are a few 1e-16.
 *
 * Two departures from [gautron06] eq. 2.5 and 2.7 are needed to have numbers at all: at the record
 * itself eq. 2.5 divides by 0 (and eq. 2.8 infinity by infinity), and 1 - n . n_k of two unit
 * vectors may be rounded to below 0.  Gradients are absolute and per channel: eq. 2.7 multiplies
 * the irradiance by 1 + ..., which is of no use where one channel is 0.
 *
 * [ward88] leaves out a record with (p - p_k) . (n + n_k) / 2 < 0: a record in front of the point
 * may stand on something that hides from the point what the record sees.  On a plane and on a
 * sphere the product is 0 in exact arithmetic, so it needs a margin, or rounding would decide.
 * HEURISTIC: 1e-3 R_k.  That is far above the rounding of positions, and above the sagitta of a
 * sphere of radius R_k drawn with some 70 sides.  What is let in falsely stands at most 1e-3 R_k
 * high, and what so low a step hides is seen to be missing only within about its own height beside
 * it.  A record that is left out without need costs one more record, never a wrong value. */
#ifndef ASSAY_RECORD_RECORD_INLINE_H
#define ASSAY_RECORD_RECORD_INLINE_H

#include "record/record.h"

/* Of the reach, for rounding. */
#define RECORD_SPARE (1.0 + 1e-12)

/* sqrt(1 - cos 10 deg) */
#define RECORD_ROOT_10_DEG 0.1232568334324387088797

static inline double record_reach(const assay_record *record, const assay_record_rules *rules)
{
    return rules->a * record->radius * RECORD_SPARE;
}

/* sqrt(1 - n . n_k); NaN stays NaN. */
static inline double record_turn(assay_vec3 a, assay_vec3 b)
{
    const double squared = 1.0 - vec3_dot(a, b);
    return squared < 0.0 ? 0.0 : sqrt(squared);
}

static inline double record_weight(const assay_record *record, const assay_record_rules *rules,
                                   assay_vec3 position, assay_vec3 normal)
{
    const assay_vec3 offset  = vec3_sub(position, record->position);
    const double     squared = vec3_dot(offset, offset);
    const double     reach   = record_reach(record, rules);
    if (!(squared <= reach * reach)) {
        return 0.0;
    }
    if (rules->in_front && 0.5 * vec3_dot(offset, vec3_add(normal, record->normal)) <
                               -ASSAY_IN_FRONT * record->radius) {
        return 0.0;
    }
    const double moved  = sqrt(squared) / record->radius;
    const double turned = record_turn(normal, record->normal);
    if (rules->weight == ASSAY_WEIGHT_TABELLION) {
        const double by_turn = turned / RECORD_ROOT_10_DEG;
        const double weight  = 1.0 - (moved > by_turn ? moved : by_turn) / rules->a;
        return weight > 0.0 ? weight : 0.0;
    }
    const double change = moved + turned;
    const double weight = change < 1.0 / ASSAY_WEIGHT_MAX ? ASSAY_WEIGHT_MAX : 1.0 / change;
    return weight >= 1.0 / rules->a ? weight : 0.0;
}

static inline assay_rgb record_extrapolate(const assay_record       *record,
                                           const assay_record_rules *rules, assay_vec3 position,
                                           assay_vec3 normal)
{
    const assay_vec3 moved  = vec3_sub(position, record->position);
    const assay_vec3 turned = vec3_cross(record->normal, normal);
    const bool       rotation =
        rules->gradients == ASSAY_GRADIENTS_ROTATION || rules->gradients == ASSAY_GRADIENTS_BOTH;
    const bool translation =
        rules->gradients == ASSAY_GRADIENTS_TRANSLATION || rules->gradients == ASSAY_GRADIENTS_BOTH;
    double e[3] = {record->irradiance.r, record->irradiance.g, record->irradiance.b};
    for (int c = 0; c < 3; c++) {
        if (rotation) {
            e[c] += vec3_dot(turned, record->rotation[c]);
        }
        if (translation) {
            e[c] += vec3_dot(moved, record->translation[c]);
        }
        if (rules->clamp_negative && e[c] < 0.0) {
            e[c] = 0.0;
        }
    }
    return rgb(e[0], e[1], e[2]);
}

#endif
