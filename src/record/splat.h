/* splat.h - records spread over the points of an image, in place of points that look for records.
 *
 * Radiance cache splatting, [gautron06] algorithm 3: a buffer holds for every pixel one point (its
 * position and normal) and two sums over the records that reach it, that of weight times what the
 * record says, and that of the weights.  What reaches a point, with what weight, and what it says
 * there is decided by record.h alone, as in a query of a record_store: so both agree.
 *
 * Each pixel adds its records in the order of their numbers, within a call and from call to call;
 * calls that go on where the last one ended give the same bits as one call, for any number of
 * threads. */
#ifndef ASSAY_RECORD_SPLAT_H
#define ASSAY_RECORD_SPLAT_H

#include "record/record_store.h"
#include "record/splat_bounds.h"

typedef struct assay_splat_buffer assay_splat_buffer;

/* Errors: MEMORY. */
assay_status assay_splat_buffer_create(assay_context *context, int width, int height,
                                       assay_splat_buffer **buffer_out);
void         assay_splat_buffer_destroy(assay_splat_buffer *buffer);

/* ---- points ---- */

/* A camera to look through, and no points. */
void assay_splat_buffer_look(assay_splat_buffer *buffer, const assay_camera *camera);

/* The point of a pixel; several pixels may be set at the same time. */
void assay_splat_buffer_set(assay_splat_buffer *buffer, size_t pixel, assay_vec3 position,
                            assay_vec3 normal);

/* Looks how far points stray from their pixels' centres; after the last of them was set, and before
 * anything is splatted.  Clears the sums. */
assay_status assay_splat_buffer_close(assay_splat_buffer *buffer);

bool assay_splat_has_point(const assay_splat_buffer *buffer, size_t pixel);

assay_context *assay_splat_context(const assay_splat_buffer *buffer);

/* ---- sums ---- */

typedef enum {
    ASSAY_SPLAT_BOUNDS_EXACT,    /* assay_splat_bounds                                         */
    ASSAY_SPLAT_BOUNDS_PUBLISHED /* assay_splat_billboard: what it leaves out is counted       */
} assay_splat_bounds_kind;

/* Where a record speaks. */
typedef struct {
    int worker;
    int slot; /* [0, ASSAY_SPLAT_SLOTS): one of a worker's that no other pixel takes before
                 all records of a call were heard at this one                           */
    size_t     pixel;
    assay_vec3 position, normal;
} assay_splat_place;

enum { ASSAY_SPLAT_TILE = 32, ASSAY_SPLAT_SLOTS = ASSAY_SPLAT_TILE * ASSAY_SPLAT_TILE };

/* What is splatted. */
typedef struct {
    const assay_record_store *store;
    assay_record_rules        rules; /* those of the store, or others: a may be changed at will  */
    assay_splat_bounds_kind   bounds;
    /* What a record says at a place; NULL: its irradiance, extrapolated. */
    assay_status (*say)(void *user, const assay_splat_place *place, uint32_t record,
                        assay_rgb *said_out);
    void *user;
} assay_splat_source;

/* Adds the records numbered [first, end).  Errors: MEMORY, CANCELLED, those of say; the sums are
 * then worthless. */
assay_status assay_splat_records(assay_splat_buffer *buffer, const assay_splat_source *source,
                                 uint32_t first, uint32_t end);

void assay_splat_buffer_clear(assay_splat_buffer *buffer);

/* Sum of the weights; 0: no record reaches the pixel's point, or there is none. */
double assay_splat_weight(const assay_splat_buffer *buffer, size_t pixel);
/* Sum of weight times what was said. */
assay_rgb assay_splat_sum(const assay_splat_buffer *buffer, size_t pixel);
/* The quotient of both, eq. 4.1; black where the weight is 0. */
assay_rgb assay_splat_mean(const assay_splat_buffer *buffer, size_t pixel);

/* Contributions left out by ASSAY_SPLAT_BOUNDS_PUBLISHED since the sums were cleared. */
uint64_t assay_splat_lost(const assay_splat_buffer *buffer);

#endif
