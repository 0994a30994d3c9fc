/* backend.c - a renderer's second half in single precision, for `assay verify` to judge.
 *
 *     backend REFERENCE CANDIDATE
 *
 * takes records, G-buffer and direct light from a bundle of `assay render --method splat --dump`,
 * does every stage after them by itself, and writes what it took and what it made as a new bundle.
 * It shares nothing with assay but the format (docs/bundle.md). */
#include <stdio.h>

#include "camera.h"
#include "planted.h"
#include "splat.h"

/* Stage `combine`. */
static void combine(const bundle *from, bundle *to, table *indirect)
{
    table direct = bundle_pass_on(from, to, "radiance/direct", "R G B");
    table total  = table_make(direct.rows, 3);
    for (size_t i = 0; i < 3 * direct.rows; i++) {
        const float light =
            indirect->values[i] + (IS_PLANTED(DIRECT_LEFT_OUT) ? 0.0f : direct.values[i]);
        total.values[i] = IS_PLANTED(HIGHLIGHTS_CLAMPED) && light > 1.0f ? 1.0f : light;
    }
    bundle_write(to, "radiance/indirect", "W/(m2 sr)", indirect);
    bundle_write(to, "radiance/total", "W/(m2 sr)", &total);
    table_release(&direct);
}

int main(int count, char **arguments)
{
    if (count != 3) {
        fputs("usage: backend REFERENCE CANDIDATE\n", stderr);
        return 2;
    }
    bundle *from = bundle_open(arguments[1]), *to = bundle_create(arguments[2], from);
    size_t  size[2];
    bundle_image_size(from, "radiance/direct", size);
    camera_place(from, to, size);
    records r = records_take(from, to);
    records_ask(&r, to);
    table indirect = splat_all(&r, from, to, size[1]);
    combine(from, to, &indirect);
    records_release(&r);
    bundle_close(to);
    bundle_close(from);
    return 0;
}
