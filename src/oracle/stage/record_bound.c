/* record_bound.c - [gautron06] eq. 2.5, 2.7 and [tabellion04] in tracked arithmetic.
 *
 * Invariant: every number that a candidate of this precision can compute from the given ones, in
 * any order of its sums, lies within the bounds; a comparison whose sides come nearer than their
 * errors may go either way (BOUND_MAYBE).
 *
 * The cosine's rounding is what counts: 1 - n . n_k of equal normals is anything up to some u, so
 * the weight of a record at its own place is anything from 1 / sqrt(u) to ASSAY_WEIGHT_MAX. */
#include "oracle/stage/record_bound.h"

#include "record/record_inline.h"

/* Equal numbers stay equal however both are rounded. */
static tracked difference(const rounding *r, bool exact, double a, double b)
{
    return exact && a == b ? tracked_exact(0.0)
                           : tracked_sub(r, tracked_given(r, a), tracked_given(r, b));
}

static tracked3 offset_of(const rounding *r, bool exact, assay_vec3 to, assay_vec3 from)
{
    return (tracked3){difference(r, exact, to.x, from.x), difference(r, exact, to.y, from.y),
                      difference(r, exact, to.z, from.z)};
}

/* sqrt(1 - n . n_k) */
static tracked turn_of(const rounding *r, const tracked3 *a, const tracked3 *b)
{
    return tracked_sqrt(r, tracked_sub(r, tracked_exact(1.0), tracked3_dot(r, a, b)));
}

static bound_membership worse(bound_membership a, bound_membership b) { return a < b ? a : b; }

/* Whether left <= right. */
static bound_membership at_most(tracked left, tracked right)
{
    const double gap = right.v - left.v, error = left.e + right.e;
    return gap > error ? BOUND_IN : gap < -error ? BOUND_OUT : BOUND_MAYBE;
}

static bound_membership is_not_in_front(const rounding *r, const assay_record *record,
                                        const tracked3 *offset, const tracked3 *a,
                                        const tracked3 *b)
{
    const tracked3 sum    = {tracked_add(r, a->x, b->x), tracked_add(r, a->y, b->y),
                             tracked_add(r, a->z, b->z)};
    const tracked  height = tracked_mul(r, tracked_exact(0.5), tracked3_dot(r, offset, &sum));
    const tracked  least =
        tracked_mul(r, tracked_constant(r, -ASSAY_IN_FRONT), tracked_given(r, record->radius));
    return at_most(least, height);
}

/* What is a root or a distance is not below 0, however far it may be off. */
static double low_root(tracked a) { return fmax(tracked_low(a), 0.0); }

static weight_bound ward(const rounding *r, tracked moved, tracked turned, double a)
{
    const double change = moved.v + turned.v;
    const double low    = (low_root(moved) + low_root(turned)) * (1.0 - r->u);
    const double high   = (tracked_high(moved) + tracked_high(turned)) * (1.0 + r->u);
    /* a is rounded; and the test may be w >= 1 / a, where both sides are rounded quotients. */
    const double spare = 5.0 * r->u * a;
    return (weight_bound){
        .member = high < a - spare  ? BOUND_IN
                  : low > a + spare ? BOUND_OUT
                                    : BOUND_MAYBE,
        .value  = change < 1.0 / ASSAY_WEIGHT_MAX ? ASSAY_WEIGHT_MAX : 1.0 / change,
        .low    = fmin(ASSAY_WEIGHT_MAX, (1.0 - r->u) / high),
        .high   = low > 1.0 / ASSAY_WEIGHT_MAX ? (1.0 + r->u) / low
                                               : ASSAY_WEIGHT_MAX * (1.0 + 2.0 * r->u)};
}

static weight_bound tabellion(const rounding *r, tracked moved, tracked turned, double a)
{
    const tracked by_turn = tracked_div(r, turned, tracked_constant(r, RECORD_ROOT_10_DEG));
    const double  low     = fmax(low_root(moved), low_root(by_turn));
    const double  high    = fmax(tracked_high(moved), tracked_high(by_turn));
    /* The quotient by a rounded a, and the difference from 1. */
    const double least = 1.0 - high / a * (1.0 + 4.0 * r->u) - r->u;
    const double most  = 1.0 - low / a * (1.0 - 4.0 * r->u) + r->u;
    return (weight_bound){.member = least > 0.0  ? BOUND_IN
                                    : most < 0.0 ? BOUND_OUT
                                                 : BOUND_MAYBE,
                          .value  = fmax(1.0 - fmax(moved.v, by_turn.v) / a, 0.0),
                          .low    = fmax(least, 0.0),
                          .high   = fmax(most, 0.0)};
}

weight_bound record_weight_bound(const rounding *r, bool exact, const assay_record *record,
                                 const assay_record_rules *rules, assay_vec3 position,
                                 assay_vec3 normal)
{
    const tracked3 offset = offset_of(r, exact, position, record->position);
    const tracked3 a = tracked3_given(r, normal), b = tracked3_given(r, record->normal);
    const tracked  distance = tracked_sqrt(r, tracked3_dot(r, &offset, &offset));
    const tracked  moved    = tracked_div(r, distance, tracked_given(r, record->radius));
    const tracked  turned   = turn_of(r, &a, &b);
    weight_bound w = rules->weight == ASSAY_WEIGHT_TABELLION ? tabellion(r, moved, turned, rules->a)
                                                             : ward(r, moved, turned, rules->a);
    if (rules->in_front) {
        w.member = worse(w.member, is_not_in_front(r, record, &offset, &a, &b));
    }
    return w;
}

void record_said_bound(const rounding *r, bool exact, const assay_record *record,
                       const assay_record_rules *rules, assay_vec3 position, assay_vec3 normal,
                       tracked said_out[3])
{
    const tracked3 offset = offset_of(r, exact, position, record->position);
    const tracked3 a = tracked3_given(r, normal), b = tracked3_given(r, record->normal);
    const tracked3 turned = tracked3_cross(r, &b, &a);
    const bool     rotation =
        rules->gradients == ASSAY_GRADIENTS_ROTATION || rules->gradients == ASSAY_GRADIENTS_BOTH;
    const bool translation =
        rules->gradients == ASSAY_GRADIENTS_TRANSLATION || rules->gradients == ASSAY_GRADIENTS_BOTH;
    const double e[3] = {record->irradiance.r, record->irradiance.g, record->irradiance.b};
    for (int c = 0; c < 3; c++) {
        tracked_sum sum = {0};
        tracked_sum_add(&sum, tracked_given(r, e[c]));
        if (rotation) {
            const tracked3 g = tracked3_given(r, record->rotation[c]);
            tracked_sum_dot(r, &sum, &turned, &g);
        }
        if (translation) {
            const tracked3 g = tracked3_given(r, record->translation[c]);
            tracked_sum_dot(r, &sum, &offset, &g);
        }
        said_out[c] = tracked_sum_of(r, &sum);
        if (rules->clamp_negative && said_out[c].v < 0.0) {
            said_out[c] = (tracked){0.0, fmax(0.0, tracked_high(said_out[c]))};
        }
    }
}

/* d <= a R and what distance and radius lose: given coordinates are off by `given`, their
 * difference and the sum of three squares by a few u; the turn is at least 0. */
double record_reach_bound(const rounding *r, const assay_record *record,
                          const assay_record_rules *rules, double coordinate)
{
    const double own =
        fmax(fmax(fabs(record->position.x), fabs(record->position.y)), fabs(record->position.z));
    const double few = 16.0 * (r->u + r->given);
    return record_reach(record, rules) * (1.0 + few) + 4.0 * (r->given + r->u) * (own + coordinate);
}
