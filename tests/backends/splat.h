/* splat.h - stages `splat` and `normalise`: records spread over the points of an image. */
#ifndef BACKEND_SPLAT_H
#define BACKEND_SPLAT_H

#include "records.h"

/* Writes the G-buffer as it was taken, the sums after every batch, and the quotient; width: of the
 * image, pixels. */
void splat_all(const records *r, const bundle *from, bundle *to, size_t width);

#endif
