/* record_store.h - records in the order in which they were made, and an octree to find them by.
 *
 * A record's number is its place in that order and never changes.  Queries may run in parallel with
 * one another, never with a change; they set no message on the context. */
#ifndef ASSAY_RECORD_RECORD_STORE_H
#define ASSAY_RECORD_RECORD_STORE_H

#include "core/context.h"
#include "record/record.h"

typedef struct assay_record_store assay_record_store;

/* How a query goes over the records: both find the same, bit for bit. */
typedef enum { ASSAY_INDEX_OCTREE, ASSAY_INDEX_LIST } assay_record_index;

/* bounds: of the scene, m; records and points outside them are served, too, but each record outside
 * costs every query a look.  Errors: ARGUMENT (a not finite or below 1 / ASSAY_WEIGHT_MAX),
 * MEMORY. */
assay_status assay_record_store_create(assay_context *context, const assay_record_rules *rules,
                                       assay_vec3 bounds_min, assay_vec3 bounds_max,
                                       assay_record_index index, assay_record_store **store_out);
void         assay_record_store_destroy(assay_record_store *store);

/* Adds a copy; its number is the count before.  The store is as it was on error.  Errors: DOMAIN
 * (radius not finite and > 0; a position, an irradiance or a gradient that is not finite; a normal
 * whose length is not 1 within 1e-6; a mean or a smallest distance that is NaN), MEMORY, LIMIT
 * (2^32 - 1 records, or cubes of the octree). */
assay_status assay_record_store_add(assay_record_store *store, const assay_record *record);

uint32_t assay_record_store_count(const assay_record_store *store);
/* Borrowed until the next add. */
const assay_record       *assay_record_store_at(const assay_record_store *store, uint32_t number);
const assay_record_rules *assay_record_store_rules(const assay_record_store *store);
/* Bytes that records and octree take. */
uint64_t assay_record_store_bytes(const assay_record_store *store);

/* Makes the radius of a record smaller (neighbour clamping); radius in (0, its radius]. */
void assay_record_store_shrink(assay_record_store *store, uint32_t number, double radius);

/* Records whose position is nearer than `distance` to the point, ascending by number: calls visit
 * for each, after all are found, so visit may shrink records.  Errors: MEMORY, with nothing
 * visited. */
assay_status assay_record_store_near(const assay_record_store *store, assay_vec3 position,
                                     double distance, void (*visit)(void *user, uint32_t number),
                                     void  *user);

/* One record that contributes. */
typedef struct {
    uint32_t number;
    double   weight;
} assay_contribution;

/* Records that may contribute within a ball, ascending by number: what queries that follow one
 * another closely ask instead of the index. */
typedef struct {
    uint64_t            version; /* of the store */
    assay_vec3          centre;
    double              radius; /* m; < 0: nothing is known */
    assay_contribution *items;  /* weights are not set      */
    size_t              count, capacity;
} assay_neighbourhood;

/* A list of them, ascending by number; a worker's scratch, made with zeros and released at the
 * end (before its context is destroyed).  It remembers the store that it was filled from, so it
 * must not be filled again after that store is destroyed. */
typedef struct {
    assay_context            *context; /* set by the first query */
    assay_contribution       *items;
    size_t                    count, capacity;
    double                    weight;   /* the sum, in that order */
    const assay_record_store *store;    /* of the last query, ... */
    assay_vec3                position; /* ... its place, ...     */
    assay_neighbourhood       around;   /* ... and what is there  */
} assay_contributions;

void assay_contributions_release(assay_contributions *list);

/* The records numbered below `limit` that contribute at a point (UINT32_MAX: all).  The list is as
 * it was on error.  Errors: MEMORY. */
assay_status assay_record_store_find(const assay_record_store *store, assay_vec3 position,
                                     assay_vec3 normal, uint32_t limit, assay_contributions *list);

/* Whether any record contributes at a point.  hint: a number to try first, of the record that did
 * where the answer was true before; any value will do. */
bool assay_record_store_reaches(const assay_record_store *store, assay_vec3 position,
                                assay_vec3 normal, uint32_t *hint);

/* Eq. 2.8: the mean of what they say, by weight; list->count > 0. */
assay_rgb assay_record_store_interpolate(const assay_record_store  *store,
                                         const assay_contributions *list, assay_vec3 position,
                                         assay_vec3 normal);

#endif
