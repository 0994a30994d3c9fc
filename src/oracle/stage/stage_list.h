/* stage_list.h - the stages, one file each; for stage_list.c and these files. */
#ifndef ASSAY_ORACLE_STAGE_LIST_H
#define ASSAY_ORACLE_STAGE_LIST_H

#include "oracle/stage/stage.h"

extern const oracle_stage stage_visible, stage_gather, stage_irradiance, stage_weights,
    stage_interpolate, stage_interpolate_radiance, stage_splat, stage_splat_light,
    stage_splat_glossy, stage_splat_glossy_light, stage_normalise_glossy, stage_normalise,
    stage_combine_irradiance, stage_combine, stage_project, stage_rotate, stage_convert,
    stage_reflect;

#endif
