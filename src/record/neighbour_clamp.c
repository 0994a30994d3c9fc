/* neighbour_clamp.c - both sides of one bound.
 *
 * Why: two points as near to each other as |p_i - p_j| see the same things, and from one of them
 * these are at most so much farther away than from the other; so a record whose rays missed
 * something near is known by its neighbours' smaller radii.
 *
 * Invariant: after both calls, |R_i - R_j| <= |p_i - p_j| for the new record and each of the
 * others, but where a limit of the settings has raised the new one's between them: then it is
 * R_j - R_i alone that is bounded. */
#include "record/neighbour_clamp.h"

typedef struct {
    assay_record_store *store;
    assay_vec3          position;
    double              radius; /* of the new record, so far */
} neighbourhood;

static double distance_to(const neighbourhood *n, uint32_t number)
{
    return vec3_length(vec3_sub(assay_record_store_at(n->store, number)->position, n->position));
}

static void clamp_to_neighbour(void *user, uint32_t number)
{
    neighbourhood *n     = user;
    const double   bound = assay_record_store_at(n->store, number)->radius + distance_to(n, number);
    n->radius            = bound < n->radius ? bound : n->radius;
}

static void clamp_neighbour(void *user, uint32_t number)
{
    const neighbourhood *n     = user;
    const double         bound = n->radius + distance_to(n, number);
    if (bound < assay_record_store_at(n->store, number)->radius) {
        assay_record_store_shrink(n->store, number, bound);
    }
}

/* A neighbour farther away than the radius cannot ask for less. */
assay_status assay_neighbour_clamp_record(assay_record_store *store, assay_vec3 position,
                                          double *radius)
{
    neighbourhood      n = {store, position, *radius};
    const assay_status status =
        assay_record_store_near(store, position, *radius, clamp_to_neighbour, &n);
    if (status == ASSAY_OK) {
        *radius = n.radius;
    }
    return status;
}

assay_status assay_neighbour_clamp_others(assay_record_store *store, const assay_record *record,
                                          double reach)
{
    neighbourhood n = {store, record->position, record->radius};
    return assay_record_store_near(store, record->position, reach, clamp_neighbour, &n);
}
