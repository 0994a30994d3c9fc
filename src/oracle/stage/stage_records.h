/* stage_records.h - records and points of a bundle, as the stages that weigh them take them. */
#ifndef ASSAY_ORACLE_STAGE_RECORDS_H
#define ASSAY_ORACLE_STAGE_RECORDS_H

#include "math/octree.h"
#include "oracle/stage/record_bound.h"
#include "oracle/stage/stage_points.h"
#include "record/record_store.h"

/* The first inputs of such a stage, in this order; those of light may be missing where the stage
 * has none of them. */
enum {
    RECORDS_POSITION,
    RECORDS_NORMAL,
    RECORDS_RADIUS,
    RECORDS_IRRADIANCE,
    RECORDS_ROTATION,
    RECORDS_TRANSLATION,
    RECORDS_INPUTS,
    RECORDS_SITE_INPUTS = RECORDS_IRRADIANCE
};

#define STAGE_RECORD_SITE_ARRAYS                                                                   \
    {"records/position", "m", "X Y Z", "record", "where it was taken", false, false, false},       \
        {"records/normal", "", "X Y Z", "record", "unit normal there", false, false, false},       \
    {                                                                                              \
        "records/radius", "m", "R", "record", "R of the weight, after all limits", false, false,   \
            false                                                                                  \
    }

#define STAGE_RECORD_ARRAYS                                                                        \
    STAGE_RECORD_SITE_ARRAYS, {"records/irradiance",  "W/m2", "R G B", "record",                   \
                               "indirect irradiance", false,  false,   false},                     \
        {"records/rotation_gradient",                                                              \
         "W/(m2 rad)",                                                                             \
         "Rx Ry Rz Gx Gy Gz Bx By Bz",                                                             \
         "record",                                                                                 \
         "E(n') = E + (n x n') . g",                                                               \
         true,                                                                                     \
         false,                                                                                    \
         false},                                                                                   \
    {                                                                                              \
        "records/translation_gradient", "W/m3", "Rx Ry Rz Gx Gy Gz Bx By Bz", "record",            \
            "E(p') = E + (p' - p) . t", true, false, false                                         \
    }

/* clang-format off */
#define STAGE_RULE_PARAMS                                                                          \
    {"a", ASSAY_PARAM_REAL, "", "0.15", 1e-6, 1e3, NULL,                                           \
     "Accuracy: a record counts where its weight is at least 1 / a.",                              \
     "[gautron06] eq. 2.8"},                                                                       \
    {"weight", ASSAY_PARAM_CHOICE, "", "ward", 0, 0, "ward|tabellion",                             \
     "Weight of a record.",                                                                        \
     "[ward88], [tabellion04]"},                                                                   \
    {"in_front", ASSAY_PARAM_BOOL, "", "off", 0, 0, NULL,                                          \
     "Records in front of the point are left out.",                                                \
     "[ward88]"}

#define STAGE_SAID_PARAMS                                                                          \
    {"gradients", ASSAY_PARAM_CHOICE, "", "both", 0, 0, "none|rotation|translation|both",          \
     "By which gradients a record is extrapolated.",                                               \
     "[gautron06] eq. 2.7"},                                                                       \
    {"clamp_negative", ASSAY_PARAM_BOOL, "", "on", 0, 0, NULL,                                     \
     "What is extrapolated below 0 counts as 0.",                                                  \
     "ours"}
/* Where a cache is asked, for stage_query_points. */
#define STAGE_QUERY_ARRAYS \
    {"query/position", "m", "X Y Z", "point", "where it is asked; NaN where nothing is", \
     false, true, false}, \
    {"query/normal", "", "X Y Z", "point", "unit normal there; NaN likewise", false, true, false}

/* Of the stages that splat: what a pixel shows. */
#define STAGE_PIXEL_ARRAYS \
    {"splat/position", "m", "X Y Z", "pixel", "its point; NaN where there is none", \
     false, true, false}, \
    {"splat/frame", "", "Xx Xy Xz Yx Yy Yz Zx Zy Zz", "pixel", \
     "frame whose z is the normal on the viewer's side", false, true, false}, \
    {"splat/albedo", "", "R G B", "pixel", "of the Lambertian part", false, false, false}
/* clang-format on */

typedef struct {
    assay_context     *context;
    assay_record_rules rules;
    bool               said; /* with light */
    size_t             count;
    assay_record      *records;
    bool               exact;      /* equal numbers are equal to the candidate (record_bound.h)   */
    double             coordinate; /* of points: none is larger                              */
    assay_octree      *octree;     /* of reaches that nothing outside contributes            */
} stage_records;

/* said: with light, and the parameters of STAGE_SAID_PARAMS.  Errors: FORMAT, DOMAIN, MEMORY. */
assay_status stage_records_open(stage_run *run, bool said, stage_records *records_out);
void         stage_records_close(stage_records *records);

/* A store of them, with their rules.  Errors: MEMORY, LIMIT. */
assay_status stage_records_store(const stage_records *records, assay_record_store **store_out);

/* An octree of what may contribute at points with these coordinates, for a at least that of the
 * rules.  Errors: MEMORY, LIMIT. */
assay_status stage_records_index(stage_records *records, const rounding *r, size_t count,
                                 const double *positions, double a);

/* Numbers of the records that may contribute at a point, ascending.  Errors: MEMORY. */
typedef struct {
    uint32_t *items;
    size_t    count, capacity;
} stage_candidates;
assay_status stage_records_near(const stage_records *records, assay_octree_walk *walk,
                                assay_vec3 position, stage_candidates *found);

#endif
