/* stage_points.h - vectors, points and frames of a bundle, as stages take them. */
#ifndef ASSAY_ORACLE_STAGE_POINTS_H
#define ASSAY_ORACLE_STAGE_POINTS_H

#include "math/frame.h"
#include "oracle/stage/stage.h"

/* Unit vectors of an input, 3 columns from `column` on (NaN where the input may have none); those
 * that were stored with few digits are brought to unit length, and run->rounding says what that
 * was.  Errors: DOMAIN, MEMORY. */
assay_status stage_unit_vectors(stage_run *run, int input, size_t column, assay_vec3 **vectors_out);

/* Normals of the points that are asked, from two inputs of as many rows, 3 columns from `column`
 * on; where nothing is asked position and normal are NaN.  Errors: FORMAT, DOMAIN, MEMORY. */
assay_status stage_query_points(stage_run *run, int position, int normal, size_t column,
                                assay_vec3 **normals_out);

/* Of the stages that splat: the z of the frames, as given, of pixels that have a position.  Errors:
 * FORMAT, DOMAIN, MEMORY. */
assay_status stage_pixel_normals(stage_run *run, int position, int frame, assay_vec3 **normals_out);

/* Frames of an input, 9 columns from the first on, made orthonormal in double: what was stored with
 * few digits is so to these digits alone, and a turn between frames divides by the sine of its
 * tilt. NaN where there is none.  Errors: DOMAIN (neither), MEMORY. */
assay_status stage_query_frames(stage_run *run, int input, assay_frame3 **frames_out);

/* Likewise a normal. */
assay_vec3 stage_unit_normal(assay_vec3 n);

static inline assay_vec3 stage_vec3(const double *row) { return vec3(row[0], row[1], row[2]); }

#endif
