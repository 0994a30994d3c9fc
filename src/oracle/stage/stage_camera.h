/* stage_camera.h - the camera that a bundle's manifest describes. */
#ifndef ASSAY_ORACLE_STAGE_CAMERA_H
#define ASSAY_ORACLE_STAGE_CAMERA_H

#include "assay/image.h"
#include "oracle/stage/stage.h"
#include "scene/scene_data.h"

typedef struct {
    assay_camera camera;
    int          width, height;
    bool         known; /* else a camera that sees nothing, and one row of pixels */
} stage_camera;

/* For `pixels` pixels; the image's sides are those of a listed image of so many. */
stage_camera stage_camera_read(const stage_run *run, size_t pixels);

/* For an image of these sides; 0: those of the first image that the bundle lists.  Errors: FORMAT
 * (no camera, no image). */
assay_status stage_camera_of_image(const stage_run *run, int width, int height,
                                   stage_camera *view_out);

#endif
