/* stage_camera.c - a camera speeds splatting up, and changes nothing of it: where the manifest has
 * none, or one that cannot be, every pixel is looked at for every record. */
#include "oracle/stage/stage_camera.h"

#include <stdlib.h>
#include <string.h>

#include "core/context.h"

static bool read_numbers(const char *text, int count, double *out)
{
    for (int i = 0; text && i < count; i++) {
        char *end = NULL;
        out[i]    = strtod(text, &end);
        if (end == text || !isfinite(out[i])) {
            return false;
        }
        text = end;
    }
    return text && *text == '\0';
}

static bool read_vector(const stage_run *run, const char *key, assay_vec3 *out)
{
    double     v[3];
    const bool ok = read_numbers(assay_bundle_text(run->bundle, key), 3, v);
    *out          = ok ? vec3(v[0], v[1], v[2]) : vec3(0.0, 0.0, 0.0);
    return ok;
}

static bool read_camera(const stage_run *run, assay_camera *camera)
{
    bool ok = read_vector(run, "assay:camera.position", &camera->position);
    ok      = read_vector(run, "assay:camera.forward", &camera->forward) && ok;
    ok      = read_vector(run, "assay:camera.up", &camera->up) && ok;
    ok      = read_vector(run, "assay:camera.right", &camera->right) && ok;
    if (read_numbers(assay_bundle_text(run->bundle, "assay:camera.yfov"), 1, &camera->yfov)) {
        camera->tan_half_yfov = assay_tan(0.5 * camera->yfov);
        return ok && camera->tan_half_yfov > 0.0;
    }
    camera->orthographic = true;
    return ok &&
           read_numbers(assay_bundle_text(run->bundle, "assay:camera.xmag"), 1, &camera->xmag) &&
           read_numbers(assay_bundle_text(run->bundle, "assay:camera.ymag"), 1, &camera->ymag) &&
           camera->xmag > 0.0 && camera->ymag > 0.0;
}

static bool find_sides(const stage_run *run, size_t pixels, int *width, int *height)
{
    for (int i = 0; i < assay_bundle_count(run->bundle); i++) {
        assay_bundle_entry entry = {.name = NULL};
        if (assay_bundle_entry_at(run->bundle, i, &entry) == ASSAY_OK && entry.image &&
            entry.dimensions == 3 && (pixels == 0 || entry.shape[0] * entry.shape[1] == pixels) &&
            entry.shape[0] <= ASSAY_IMAGE_MAX_SIDE && entry.shape[1] <= ASSAY_IMAGE_MAX_SIDE) {
            *height = (int)entry.shape[0];
            *width  = (int)entry.shape[1];
            return true;
        }
    }
    return false;
}

stage_camera stage_camera_read(const stage_run *run, size_t pixels)
{
    stage_camera view = {.width = (int)pixels, .height = 1};
    view.known =
        find_sides(run, pixels, &view.width, &view.height) && read_camera(run, &view.camera);
    if (!view.known) {
        /* Every point is behind it, so its boxes are the image. */
        view.camera = (assay_camera){.position      = vec3(0.0, 0.0, 0.0),
                                     .right         = vec3(1.0, 0.0, 0.0),
                                     .up            = vec3(0.0, 1.0, 0.0),
                                     .forward       = vec3(0.0, 0.0, 0.0),
                                     .tan_half_yfov = 1.0,
                                     .yfov          = 0.5 * ASSAY_PI};
    }
    return view;
}

assay_status stage_camera_of_image(const stage_run *run, int width, int height,
                                   stage_camera *view_out)
{
    stage_camera view = {.width = width, .height = height};
    if ((width == 0 || height == 0) && !find_sides(run, 0, &view.width, &view.height)) {
        return assay_fail(run->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: it lists no image, and width and height are not given",
                          assay_bundle_path(run->bundle));
    }
    view.known = read_camera(run, &view.camera);
    if (!view.known) {
        return assay_fail(run->context, ASSAY_ERR_FORMAT,
                          "%s: bundle: manifest.json describes no camera (assay:camera.position, "
                          ".forward, .up, .right, .yfov or .xmag and .ymag)",
                          assay_bundle_path(run->bundle));
    }
    *view_out = view;
    return ASSAY_OK;
}
