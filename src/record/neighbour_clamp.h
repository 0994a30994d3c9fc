/* neighbour_clamp.h - radii of neighbouring records that differ by no more than their distance
 * [krivanek06]. */
#ifndef ASSAY_RECORD_NEIGHBOUR_CLAMP_H
#define ASSAY_RECORD_NEIGHBOUR_CLAMP_H

#include "record/record_store.h"

/* Makes the radius of a record that is not yet in the store as small as the store's ask for.
 * Errors: MEMORY. */
assay_status assay_neighbour_clamp_record(assay_record_store *store, assay_vec3 position,
                                          double *radius);

/* Makes those of the store within `reach` (m) as small as the record asks for.  Errors: MEMORY. */
assay_status assay_neighbour_clamp_others(assay_record_store *store, const assay_record *record,
                                          double reach);

#endif
