/* stage_points.c - Invariant: a vector is of unit length to 4e-7, which is within what a record
 * store asks of a length (1e-6) and a BRDF's grid of its square; how far it was from that when it
 * was stored is part of what is not known of it. */
#include "oracle/stage/stage_points.h"

#include "core/alloc.h"
#include "core/context.h"

/* Farther from unit length (or than its type rounds) nothing is one; farther than UNIT_ENOUGH it is
 * brought there; nearer than UNIT_EXACT double itself is. */
static const double UNIT_TOLERANCE = 1e-6, UNIT_ENOUGH = 4e-7, UNIT_EXACT = 1e-14;

static bool is_none(assay_vec3 v) { return isnan(v.x) && isnan(v.y) && isnan(v.z); }

assay_status stage_unit_vectors(stage_run *run, int input, size_t column, assay_vec3 **vectors_out)
{
    const stage_table *t       = &run->in[input];
    const double       allowed = fmax(UNIT_TOLERANCE, 4.0 * t->roundoff);
    assay_vec3        *v       = assay_allocate(run->context, t->rows, sizeof *v);
    double             moved   = 0.0;
    if (!v) {
        assay_fail_memory(run->context, "unit vectors");
        return ASSAY_ERR_MEMORY;
    }
    for (size_t i = 0; i < t->rows; i++) {
        v[i]              = stage_vec3(t->values + i * t->columns + column);
        const double away = is_none(v[i]) ? 0.0 : fabs(vec3_length(v[i]) - 1.0);
        if (!(away <= allowed)) {
            assay_release(run->context, v);
            stage_fail_value(run, input, i, column, "a vector that is not of unit length");
            return ASSAY_ERR_DOMAIN;
        }
        if (away > UNIT_ENOUGH) {
            v[i]  = vec3_normalize(v[i]);
            moved = fmax(moved, away);
        }
    }
    run->rounding.given += moved * (1.0 + run->rounding.given);
    *vectors_out = v;
    return ASSAY_OK;
}

assay_status stage_query_points(stage_run *run, int position, int normal, size_t column,
                                assay_vec3 **normals_out)
{
    const stage_table *p       = &run->in[position];
    assay_vec3        *normals = NULL;
    if (run->in[normal].rows != p->rows) {
        return stage_fail_rows(run, normal, p->rows, "one a point, as of its positions");
    }
    assay_status status = stage_unit_vectors(run, normal, column, &normals);
    for (size_t i = 0; i < p->rows && status == ASSAY_OK; i++) {
        const assay_vec3 at = stage_vec3(p->values + 3 * i);
        if (is_none(at) != is_none(normals[i]) || !(is_none(at) || vec3_finite(at))) {
            status = stage_fail_value(run, position, i, 0,
                                      "a point must have a position and a normal, or NaN for both");
        }
    }
    if (status != ASSAY_OK) {
        assay_release(run->context, normals);
        return status;
    }
    *normals_out = normals;
    return ASSAY_OK;
}

static assay_status take_normals(stage_run *run, int position, int frame, assay_vec3 *normals)
{
    const stage_table *p = &run->in[position], *f = &run->in[frame];
    const double       allowed = fmax(UNIT_TOLERANCE, 4.0 * f->roundoff);
    for (size_t i = 0; i < p->rows; i++) {
        const assay_vec3 at = stage_vec3(p->values + 3 * i);
        if (isnan(at.x)) {
            continue;
        }
        normals[i] = stage_vec3(f->values + 9 * i + 6);
        if (!vec3_finite(at)) {
            return stage_fail_value(run, position, i, 0, "not a position");
        }
        if (!(fabs(vec3_length(normals[i]) - 1.0) <= allowed)) {
            return stage_fail_value(run, frame, i, 6, "a vector that is not of unit length");
        }
    }
    return ASSAY_OK;
}

assay_status stage_pixel_normals(stage_run *run, int position, int frame, assay_vec3 **normals_out)
{
    const size_t pixels = run->in[position].rows;
    if (run->in[frame].rows != pixels) {
        return stage_fail_rows(run, frame, pixels, "one a pixel, as of its positions");
    }
    assay_vec3 *normals = assay_allocate(run->context, pixels, sizeof *normals);
    if (!normals) {
        return assay_fail_memory(run->context, "a G-buffer");
    }
    const assay_status status = take_normals(run, position, frame, normals);
    if (status != ASSAY_OK) {
        assay_release(run->context, normals);
        return status;
    }
    *normals_out = normals;
    return ASSAY_OK;
}

/* The frame about a unit normal that is nearest to x. */
static assay_frame3 about(assay_vec3 z, assay_vec3 x)
{
    const assay_vec3 flat = vec3_normalize(vec3_mad(x, -vec3_dot(x, z), z));
    return (assay_frame3){flat, vec3_cross(z, flat), z};
}

static bool is_exact(const assay_frame3 *f)
{
    return fabs(vec3_length(f->z) - 1.0) <= UNIT_EXACT &&
           vec3_length(vec3_sub(vec3_cross(f->x, f->y), f->z)) <= UNIT_EXACT &&
           fabs(vec3_dot(f->x, f->z)) <= UNIT_EXACT;
}

assay_vec3 stage_unit_normal(assay_vec3 n)
{
    return fabs(vec3_length(n) - 1.0) <= UNIT_EXACT ? n : vec3_normalize(n);
}

assay_status stage_query_frames(stage_run *run, int input, assay_frame3 **frames_out)
{
    const stage_table *t       = &run->in[input];
    const double       allowed = fmax(UNIT_TOLERANCE, 8.0 * t->roundoff);
    assay_frame3      *frames  = assay_allocate(run->context, t->rows, sizeof *frames);
    if (!frames) {
        return assay_fail_memory(run->context, "frames");
    }
    for (size_t i = 0; i < t->rows; i++) {
        const double      *row   = t->values + i * t->columns;
        const assay_frame3 given = {stage_vec3(row), stage_vec3(row + 3), stage_vec3(row + 6)};
        const assay_frame3 exact = about(stage_unit_normal(given.z), given.x);
        frames[i]                = is_exact(&given) ? given : exact;
        if (!is_none(given.z) && !(vec3_length(vec3_sub(given.x, exact.x)) <= allowed &&
                                   vec3_length(vec3_sub(given.y, exact.y)) <= allowed &&
                                   vec3_length(vec3_sub(given.z, exact.z)) <= allowed)) {
            assay_release(run->context, frames);
            return stage_fail_value(run, input, i, 0, "not a right-handed orthonormal frame");
        }
    }
    *frames_out = frames;
    return ASSAY_OK;
}
