/* stage_world.h - the scene of stages that look at one. */
#ifndef ASSAY_ORACLE_STAGE_WORLD_H
#define ASSAY_ORACLE_STAGE_WORLD_H

#include "oracle/stage/stage.h"

/* The run's scene, ready for rays, where it is the one that the manifest speaks of.  Errors:
 * ARGUMENT (another scene), those of assay_world_create. */
assay_status stage_world_create(const stage_run *run, assay_world **world_out);

#endif
