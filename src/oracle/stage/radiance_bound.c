/* radiance_bound.c - lambda_k + (p - p_k) . grad lambda_k in tracked arithmetic, coefficient by
 * coefficient, and then its turn, pair by pair. */
#include "oracle/stage/radiance_bound.h"

#include "core/alloc.h"

enum { CHANNELS = 3 };

assay_status radiance_desk_create(assay_context *context, const turn_bound *bound, size_t count,
                                  radiance_desk *desk_out)
{
    const size_t pairs = turn_bound_pairs(bound), row = CHANNELS * pairs;
    desk_out->said    = assay_allocate(context, CHANNELS * count, sizeof(double));
    desk_out->moved   = assay_allocate(context, CHANNELS * count, sizeof(double));
    desk_out->errors  = assay_allocate(context, row, sizeof(double));
    desk_out->before  = assay_allocate(context, row, sizeof(double));
    desk_out->after   = assay_allocate(context, row, sizeof(double));
    desk_out->scratch = assay_allocate(context, 2 * (pairs + pairs * pairs), sizeof(double));
    return desk_out->said && desk_out->moved && desk_out->errors && desk_out->before &&
                   desk_out->after && desk_out->scratch
               ? ASSAY_OK
               : ASSAY_ERR_MEMORY;
}

void radiance_desk_release(assay_context *context, radiance_desk *desk)
{
    assay_release(context, desk->said);
    assay_release(context, desk->moved);
    assay_release(context, desk->errors);
    assay_release(context, desk->before);
    assay_release(context, desk->after);
    assay_release(context, desk->scratch);
}

static bool same(assay_vec3 a, assay_vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/* The offset in the record's frame; equal coordinates are equal however both are rounded. */
static tracked3 local_offset(const rounding *r, bool exact, const tracked_frame *frame,
                             assay_vec3 to, assay_vec3 from)
{
    const tracked3 a = tracked3_given(r, to), b = tracked3_given(r, from);
    tracked3       offset = tracked3_sub(r, &a, &b);
    offset.x              = exact && to.x == from.x ? tracked_exact(0.0) : offset.x;
    offset.y              = exact && to.y == from.y ? tracked_exact(0.0) : offset.y;
    offset.z              = exact && to.z == from.z ? tracked_exact(0.0) : offset.z;
    return (tracked3){tracked3_dot(r, &frame->x, &offset), tracked3_dot(r, &frame->y, &offset),
                      tracked3_dot(r, &frame->z, &offset)};
}

/* Coefficients at the point, in the record's frame; errors of pairs are the norms of theirs. */
static void move(const turn_bound *bound, const rounding *r, const assay_radiance_rows *rows,
                 uint32_t number, const tracked3 *local, radiance_desk *desk)
{
    const size_t  count = rows->count / CHANNELS, pairs = turn_bound_pairs(bound);
    const double *c = rows->coefficients + number * rows->count;
    for (size_t i = 0; i < CHANNELS * pairs; i++) {
        desk->errors[i] = 0.0;
    }
    for (size_t i = 0; i < rows->count; i++) {
        tracked_sum sum = {0};
        tracked_sum_add(&sum, tracked_given(r, c[i]));
        if (rows->gradients) {
            const tracked3 g = tracked3_given(r, rows->gradients[number * rows->count + i]);
            tracked_sum_dot(r, &sum, &g, local);
        }
        const tracked here = tracked_sum_of(r, &sum);
        double *error  = desk->errors + i / count * pairs + turn_bound_pair_of(bound, i % count);
        desk->moved[i] = here.v;
        *error         = sqrt(*error * *error + here.e * here.e);
    }
}

assay_status radiance_said_bound(const turn_bound *bound, const rounding *r, bool exact,
                                 const assay_radiance_rows *rows, const assay_record *record,
                                 uint32_t number, assay_vec3 position, assay_vec3 normal,
                                 int worker, radiance_desk *desk)
{
    const size_t        count = rows->count / CHANNELS, pairs = turn_bound_pairs(bound);
    const assay_frame3  frame = frame3_from_z(normal);
    const tracked_frame there = tracked_frame_from_z(r, record->normal);
    const tracked_frame here  = tracked_frame_from_z(r, normal);
    const tracked3      local = local_offset(r, exact, &there, position, record->position);
    const assay_status  status =
        assay_radiance_rows_say(rows, record, number, position, &frame, worker, desk->said);
    if (status != ASSAY_OK) {
        return status;
    }
    move(bound, r, rows, number, &local, desk);
    for (size_t c = 0; c < CHANNELS; c++) {
        turn_bound_sizes(bound, desk->moved + c * count, desk->before + c * pairs);
        turn_bound_sizes(bound, desk->said + c * count, desk->after + c * pairs);
    }
    return turn_bound_turn(bound, r, &there, &here, exact && same(record->normal, normal),
                           desk->before, desk->after, desk->errors, desk->scratch);
}
