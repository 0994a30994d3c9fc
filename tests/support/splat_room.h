/* splat_room.h - a room of records and a camera that looks at its walls, for tests of splatting. */
#ifndef ASSAY_TESTS_SPLAT_ROOM_H
#define ASSAY_TESTS_SPLAT_ROOM_H

#include "record/splat.h"

/* The unit cube seen from within, slightly bent normals. */
assay_camera splat_room_camera(bool orthographic);

/* What the pixel's centre sees; false: this pixel is left without a point (one in a hundred). */
bool splat_room_point(const assay_camera *camera, int width, int height, size_t pixel,
                      assay_vec3 *position_out, assay_vec3 *normal_out);

/* Record number k of `count`, such that some ten of them reach a point at a = 0.25; of a kind of
 * its own for every seed. */
assay_record splat_room_record(uint64_t seed, uint32_t count, uint32_t k);

/* Sets and closes. */
void splat_room_fill(assay_splat_buffer *buffer, const assay_camera *camera, int width, int height);

#endif
