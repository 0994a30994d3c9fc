/* radiance_rows.c - from a record's frame to a point's.
 *
 * A record's frame is frame3_from_z of its normal, and so is the frame in which a point adds up
 * what its records say: where both have the same normal, as on all flat surfaces, nothing is
 * turned; the sum is turned about z into the frame that is wanted, once. */
#include "record/radiance_rows.h"

#include <string.h>

/* What the record says of the radiance at a position, in its own frame. */
static void move(const assay_radiance_rows *rows, uint32_t number, const assay_frame3 *frame,
                 assay_vec3 offset, double *moved)
{
    const double     *c     = rows->coefficients + number * rows->count;
    const assay_vec3 *g     = rows->gradients ? rows->gradients + number * rows->count : NULL;
    const assay_vec3  local = frame3_to_local(frame, offset);
    for (size_t i = 0; i < rows->count; i++) {
        moved[i] = g ? c[i] + vec3_dot(g[i], local) : c[i];
    }
}

assay_status assay_radiance_rows_say(const assay_radiance_rows *rows, const assay_record *record,
                                     uint32_t number, assay_vec3 position, const assay_frame3 *here,
                                     int worker, double *coefficients_out)
{
    const assay_frame3 there = frame3_from_z(record->normal);
    move(rows, number, &there, vec3_sub(position, record->position), coefficients_out);
    return assay_radiance_rows_turn(rows, &there, here, worker, coefficients_out);
}

static bool same(assay_vec3 a, assay_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

assay_status assay_radiance_rows_turn(const assay_radiance_rows *rows, const assay_frame3 *from,
                                      const assay_frame3 *to, int worker, double *coefficients)
{
    if (same(from->x, to->x) && same(from->y, to->y) && same(from->z, to->z)) {
        return ASSAY_OK;
    }
    return assay_radiance_turn_apply(rows->turn, worker, from, to, coefficients);
}

assay_status assay_radiance_rows_mean(const assay_radiance_rows *rows, const assay_record *records,
                                      const assay_contributions *found, assay_vec3 position,
                                      const assay_frame3 *frame, int worker, double *scratch,
                                      double *coefficients_out)
{
    const assay_frame3 here   = frame3_from_z(frame->z);
    double            *sum    = scratch;
    double            *moved  = scratch + rows->count;
    double             total  = 0.0;
    assay_status       status = ASSAY_OK;
    memset(sum, 0, rows->count * sizeof *sum);
    for (size_t k = 0; k < found->count && status == ASSAY_OK; k++) {
        const assay_contribution *item = &found->items[k];
        status = assay_radiance_rows_say(rows, &records[item->number], item->number, position,
                                         &here, worker, moved);
        /* A running mean, as assay_record_store_interpolate has. */
        total += item->weight;
        const double share = item->weight / total;
        for (size_t i = 0; i < rows->count; i++) {
            sum[i] += share * (moved[i] - sum[i]);
        }
    }
    status = status ? status : assay_radiance_rows_turn(rows, &here, frame, worker, sum);
    if (status == ASSAY_OK) {
        memcpy(coefficients_out, sum, rows->count * sizeof *sum);
    }
    return status;
}
