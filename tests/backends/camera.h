/* camera.h - stage `visible`: positions of the visible points from their depths. */
#ifndef BACKEND_CAMERA_H
#define BACKEND_CAMERA_H

#include "bundle.h"

/* size: height, width. */
void camera_place(const bundle *from, bundle *to, const size_t size[2]);

#endif
