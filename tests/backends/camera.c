/* camera.c - as deferred shading does it: a ray through the pixel's centre, as far as the depth;
 * (0, 0, 0) where nothing is seen. */
#include "camera.h"

#include <stdio.h>
#include <string.h>

#include "planted.h"
#include "vector.h"

static vec take_vector(const bundle *from, const char *key)
{
    vec         v;
    const char *text = bundle_text(from, key);
    if (!text || sscanf(text, "%f %f %f", &v.x, &v.y, &v.z) != 3) {
        fail("%s: not three numbers", key);
    }
    return v;
}

void camera_place(const bundle *from, bundle *to, const size_t size[2])
{
    const vec   eye     = take_vector(from, "assay:camera.position");
    const vec   forward = take_vector(from, "assay:camera.forward");
    const vec   right   = take_vector(from, "assay:camera.right");
    const vec   up      = take_vector(from, "assay:camera.up");
    const float half    = tanf(0.5f * bundle_number(from, "assay:camera.yfov"));
    const float centre  = IS_PLANTED(HALF_PIXEL) ? 0.0f : IS_PLANTED(PIXEL_SHIFTED) ? 0.501f : 0.5f;
    const float height = (float)size[0], width = (float)size[1];
    table       depth     = bundle_pass_on(from, to, "gbuffer/depth", "Z");
    table       positions = table_make(depth.rows, 3);
    for (size_t i = 0; i < depth.rows; i++) {
        const float x    = ((float)(i % size[1]) + centre - 0.5f * width) * 2.0f * half / height;
        const float y    = (0.5f * height - (float)(i / size[1]) - centre) * 2.0f * half / height;
        const float rise = IS_PLANTED(ROWS_FROM_BELOW) ? -y : y;
        const vec   ray  = add(forward, add(scale(right, x), scale(up, rise)));
        const float far =
            IS_PLANTED(DEPTH_ALONG_RAY) ? depth.values[i] / length(ray) : depth.values[i];
        const vec p = add(eye, scale(ray, far));
        if (depth.values[i] > 0.0f) {
            memcpy(table_row(&positions, i), &p, sizeof p);
        }
    }
    bundle_write(to, "gbuffer/position", "m", &positions);
    table_release(&depth);
}
