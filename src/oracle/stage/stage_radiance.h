/* stage_radiance.h - records of radiance of a bundle, as the stages that ask them take them. */
#ifndef ASSAY_ORACLE_STAGE_RADIANCE_H
#define ASSAY_ORACLE_STAGE_RADIANCE_H

#include "oracle/stage/radiance_bound.h"
#include "oracle/stage/record_parts.h"
#include "oracle/stage/stage_records.h"

/* The first inputs of such a stage, in this order; the first three alone where the stage only
 * weighs. */
enum { RADIANCE_COEFFICIENTS = RECORDS_SITE_INPUTS, RADIANCE_GRADIENT, RADIANCE_INPUTS };

/* clang-format off */
#define STAGE_RADIANCE_SITE_ARRAYS                                                                 \
    {"radiance_records/position", "m", "X Y Z", "record", "where it was taken",                    \
     false, false, false},                                                                         \
    {"radiance_records/normal", "", "X Y Z", "record", "unit normal there", false, false, false},  \
    {"radiance_records/radius", "m", "R", "record", "R of the weight, after all limits",           \
     false, false, false}

#define STAGE_RADIANCE_ARRAYS                                                                      \
    STAGE_RADIANCE_SITE_ARRAYS,                                                                    \
    {"radiance_records/coefficients", "W/(m2 sr)", NULL, "record",                                 \
     "of R, of G, of B, HSH in the record's frame", false, false, false},                          \
    {"radiance_records/coefficient_gradient", "W/(m3 sr)", NULL, "record",                         \
     "x y z of each, there; not with coefficient_gradient none", true, false, false}

#define STAGE_RADIANCE_PARAMS                                                                      \
    {"order", ASSAY_PARAM_INT, "", "10", 1, ASSAY_BASIS_MAX_ORDER, NULL,                           \
     "Order of the coefficients.", "[gautron06] 4.7"},                                             \
    {"coefficient_gradient", ASSAY_PARAM_CHOICE, "", "walls", 0, 0, "none|points|walls",           \
     "none: coefficients stay what they are.", "[krivanek05]"},                                    \
    {"rotation", ASSAY_PARAM_CHOICE, "", "table", 0, 0,                                            \
     "exact|table|conversion|digon|analytical",                                                    \
     "How coefficients pass into the frame of another normal; bounds are of the first two.",       \
     "[gautron06] 3.4"},                                                                           \
    {"rotation_steps", ASSAY_PARAM_INT, "", "16", 1, 1024, NULL,                                   \
     "Matrices between which rotation=table and digon interpolate.", "[gautron06] 3.4.2"},         \
    {"sh_order", ASSAY_PARAM_INT, "", "15", 1, ASSAY_BASIS_MAX_ORDER, NULL,                        \
     "Order of the spherical harmonics of rotation=conversion.", "[gautron06] 3.4.1"},             \
    {"splat_a", ASSAY_PARAM_REAL, "", "0", 0, 1e3, NULL,                                           \
     "Accuracy of the last batch; 0: a.", "[gautron06] fig. 4.12"}
/* clang-format on */

typedef struct {
    stage_records        records; /* as given: what weighs                                */
    assay_record_store  *store;   /* the same                                             */
    assay_record        *turned;  /* with normals of unit length in double: what is turned */
    assay_basis         *hsh;
    assay_radiance_turn *turn;
    assay_radiance_rows  rows;
    turn_bound          *bound; /* NULL: no bound is asked, or the way is not analysed        */
    size_t               workers;
    radiance_desk       *desks; /* a worker, where turns are analysed                         */
    assay_octree_walk   *walks; /* a worker, where bounds are asked                           */
    record_parts        *parts; /* the same                                                   */
} stage_radiance;

/* splatted: weights are those of the last batch of a splatting.  points: rows of x y z, where
 * records will be asked.  Close either way.  Errors: FORMAT, DOMAIN, ARGUMENT, MEMORY. */
assay_status stage_radiance_open(stage_run *run, bool splatted, size_t count, const double *points,
                                 stage_radiance *radiance);
void         stage_radiance_close(stage_radiance *radiance);

#endif
