/* record.h - an irradiance record, and what it may say about a point.
 *
 * [ward88], [ward-heckbert92], as in [gautron06] 2.2.5; departures: docs/methods/
 * irradiance-cache.md. */
#ifndef ASSAY_RECORD_RECORD_H
#define ASSAY_RECORD_RECORD_H

#include "math/frame.h"

/* A plain value, world frame.  What a weight needs comes first. */
typedef struct {
    assay_vec3 position;    /* m                                                                  */
    assay_vec3 normal;      /* unit                                                               */
    double     radius;      /* R_k as the weight takes it, m, finite, > 0                         */
    double     mean;        /* harmonic mean distance as gathered, m; may be INFINITY             */
    double     nearest;     /* smallest distance as gathered, m; may be INFINITY                  */
    assay_rgb  irradiance;  /* W/m2                                                         */
    assay_vec3 rotation[3]; /* per channel, W/(m2 rad): E(n') = E + (n x n') . rotation     */
    assay_vec3 translation[3]; /* per channel, W/m3: E(p') = E + (p' - p) . translation        */
} assay_record;

typedef enum {
    ASSAY_WEIGHT_WARD,     /* 1 / (d / R + sqrt(1 - n . n_k)), eq. 2.5; counts from 1 / a on     */
    ASSAY_WEIGHT_TABELLION /* 1 - max(d / R, sqrt((1 - n . n_k) / (1 - cos 10 deg))) / a
                              [tabellion04]; counts where > 0; R is half the nearest distance    */
} assay_weight_kind;

typedef enum {
    ASSAY_GRADIENTS_NONE,
    ASSAY_GRADIENTS_ROTATION,
    ASSAY_GRADIENTS_TRANSLATION,
    ASSAY_GRADIENTS_BOTH
} assay_gradients;

/* How records are used. */
typedef struct {
    double            a; /* accuracy, finite, >= 1 / ASSAY_WEIGHT_MAX */
    assay_weight_kind weight;
    assay_gradients   gradients;
    bool in_front;       /* leave out records that lie in front of the point, [ward88]           */
    bool clamp_negative; /* what is extrapolated below 0 counts as 0                             */
} assay_record_rules;

/* The largest weight of ASSAY_WEIGHT_WARD: that of a record at its own place.  (That of
 * ASSAY_WEIGHT_TABELLION is 1.) */
#define ASSAY_WEIGHT_MAX 1e12

/* A record lies in front of a point where (p - p_k) . (n + n_k) / 2 < -ASSAY_IN_FRONT * R_k. */
#define ASSAY_IN_FRONT 1e-3

/* The weight of a record at a point, or 0 where it does not contribute (and where a coordinate is
 * NaN); in (0, ASSAY_WEIGHT_MAX].  The in-front test is part of it. */
double assay_record_weight(const assay_record *record, const assay_record_rules *rules,
                           assay_vec3 position, assay_vec3 normal);

/* A distance beyond which the weight is 0 whatever the normal, m: a R_k, and 1e-12 of it more for
 * the rounding.  May be INFINITY. */
double assay_record_reach(const assay_record *record, const assay_record_rules *rules);

/* The largest angle between two normals at which a record may contribute, rad; (0, pi]. */
double assay_record_tilt_max(const assay_record_rules *rules);

/* What the record says that the irradiance at the point is, W/m2. */
assay_rgb assay_record_extrapolate(const assay_record *record, const assay_record_rules *rules,
                                   assay_vec3 position, assay_vec3 normal);

#endif
