/* backend.c - a renderer's second half in single precision, for `assay verify` to judge.
 *
 *     backend REFERENCE CANDIDATE
 *
 * takes records, G-buffer and direct light from a bundle of `assay render --method splat --dump`,
 * does every stage after them by itself, and writes what it took and what it made as a new bundle.
 * It shares nothing with assay but the format (docs/bundle.md). */
#include <stdio.h>
#include <string.h>

#include "camera.h"
#include "cells.h"
#include "harmonics.h"
#include "planted.h"
#include "splat.h"

/* Stage `combine`.  The light of pixels is a mean over camera samples, some of which pass by what
 * the pixel's centre sees; so indirect light is taken as it is, not from splat/result. */
static void combine(const bundle *from, bundle *to)
{
    table direct   = bundle_pass_on(from, to, "radiance/direct", "R G B");
    table indirect = bundle_pass_on(from, to, "radiance/indirect", "R G B");
    table total    = table_make(direct.rows, 3);
    for (size_t i = 0; i < 3 * direct.rows; i++) {
        const float light =
            indirect.values[i] + (IS_PLANTED(DIRECT_LEFT_OUT) ? 0.0f : direct.values[i]);
        total.values[i] = IS_PLANTED(HIGHLIGHTS_CLAMPED) && light > 1.0f ? 1.0f : light;
    }
    bundle_write(to, "radiance/total", "W/(m2 sr)", &total);
    table_release(&direct);
    table_release(&indirect);
}

/* Images are written as tables, which do not say how wide they are. */
static void describe_size(bundle *to, const size_t size[2])
{
    char text[32];
    snprintf(text, sizeof text, "%zu", size[0]);
    bundle_describe(to, "height", text);
    snprintf(text, sizeof text, "%zu", size[1]);
    bundle_describe(to, "width", text);
}

static void after_records(const char *reference, const char *candidate)
{
    bundle *from = bundle_open(reference), *to = bundle_create(candidate, from);
    size_t  size[2];
    bundle_image_size(from, "radiance/direct", size);
    describe_size(to, size);
    camera_place(from, to, size);
    records r = records_take(from, to);
    splat_all(&r, from, to, size[1]);
    combine(from, to);
    records_release(&r);
    bundle_close(to);
    bundle_close(from);
}

static void questions(const char *reference, const char *candidate)
{
    bundle *from = bundle_open(reference), *to = bundle_create(candidate, from);
    records r = records_take(from, to);
    records_ask(&r, to);
    if (bundle_has(from, "radiance_records/coefficients")) {
        harmonics_of_records(from, to);
    }
    records_release(&r);
    bundle_close(to);
    bundle_close(from);
}

/* Texts: keys and values, in turn, NULL at the end. */
static void alone(const char *candidate, const char *const *texts, void (*make)(bundle *))
{
    bundle *to = bundle_create(candidate, NULL);
    for (; texts[0]; texts += 2) {
        bundle_describe(to, texts[0], texts[1]);
    }
    make(to);
    bundle_close(to);
}

static const char *const CELL_TEXTS[] = {"theta_strata",    "8",      "phi_strata", "24",
                                         "strata",          "cosine", "mean",       "uniform",
                                         "normal_gradient", "off",    NULL};

static const char *const HEMISPHERE_TEXTS[] = {
    "basis", "hsh",        "order", "6",        "convention", "thesis", "from",
    "hsh",   "from_order", "6",     "to_order", "8",          NULL};

static const char *const SPHERE_TEXTS[] = {
    "basis",    "sh", "order", "6",   "convention", "thesis", "from",  "sh",   "from_order", "6",
    "to_order", "6",  "alpha", "0.3", "beta",       "0.8",    "gamma", "-1.1", NULL};

int main(int count, char **arguments)
{
    const char *what = count > 2 ? arguments[1] : "";
    const char *last = arguments[count - 1];
    if (count == 4 && strcmp(what, "image") == 0) {
        after_records(arguments[2], last);
    } else if (count == 4 && strcmp(what, "questions") == 0) {
        questions(arguments[2], last);
    } else if (count == 3 && strcmp(what, "cells") == 0) {
        alone(last, CELL_TEXTS, cells_gather);
    } else if (count == 3 && strcmp(what, "hemisphere") == 0) {
        alone(last, HEMISPHERE_TEXTS, harmonics_of_hemisphere);
    } else if (count == 3 && strcmp(what, "sphere") == 0) {
        alone(last, SPHERE_TEXTS, harmonics_of_sphere);
    } else {
        fputs("usage: backend image|questions REFERENCE CANDIDATE\n"
              "       backend cells|hemisphere|sphere CANDIDATE\n",
              stderr);
        return 2;
    }
    return 0;
}
