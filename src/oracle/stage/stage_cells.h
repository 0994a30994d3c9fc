/* stage_cells.h - the cells of hemispheres as arrays of a bundle: stage `gather` writes them, stage
 * `irradiance` reads them. */
#ifndef ASSAY_ORACLE_STAGE_CELLS_H
#define ASSAY_ORACLE_STAGE_CELLS_H

#include "gather/hemisphere.h"
#include "oracle/stage/stage.h"

/* clang-format off */
#define STAGE_CELL_PARAMS                                                                          \
    {"theta_strata", ASSAY_PARAM_INT, "", "16", 2, ASSAY_STRATA_MAX, NULL,                         \
     "Strata of the hemisphere in theta.", "[gautron06] 2.2.5"},                                   \
    {"phi_strata", ASSAY_PARAM_INT, "", "50", 2, ASSAY_STRATA_MAX, NULL,                           \
     "Strata in phi.", "[gautron06] 2.2.5"},                                                       \
    {"strata", ASSAY_PARAM_CHOICE, "", "cosine", 0, 0, "cosine|uniform",                           \
     "Measure that all cells have the same share of.", "[gautron06] 2.2.5"}
/* clang-format on */

/* What the parameters say; jitter is left false. */
assay_hemisphere_layout stage_cells_layout(const assay_params *params);

/* UNSUPPORTED where the manifest says that hemispheres were rasterised. */
assay_status stage_cells_check(const stage_run *run);

#endif
