/* report_records.c - Invariant: a record's centre goes through the same pixel as the ray that
 * assay_camera_ray makes for it (trace/camera_ray.c), of which this is the inverse.
 *
 * HEURISTIC: a record is hidden where it lies more than 2 percent of its distance, and more than a
 * quarter of its radius, behind what the pixel of its centre sees. */
#include "oracle/report/report_records.h"

#include <math.h>
#include <stdio.h>

#include "core/context.h"
#include "core/numerics.h"
#include "io/image_data.h"
#include "trace/camera_ray.h"

enum { RECORDS_SHOWN = 20000 };

typedef struct {
    assay_camera  camera;
    int           width, height;
    const double *depth; /* of each pixel, m; NULL: not known */
} projection;

static bool read_vector(const assay_image *image, const char *name, assay_vec3 *out)
{
    const char *text = assay_image_get_attribute(image, name);
    return text && sscanf(text, "%lf %lf %lf", &out->x, &out->y, &out->z) == 3;
}

static bool read_number(const assay_image *image, const char *name, double *out)
{
    const char *text = assay_image_get_attribute(image, name);
    return text && sscanf(text, "%lf", out) == 1 && isfinite(*out) && *out > 0.0;
}

static bool find_camera(const assay_image *image, projection *out)
{
    assay_camera *camera = &out->camera;
    out->width           = assay_image_width(image);
    out->height          = assay_image_height(image);
    camera->orthographic = !read_number(image, "assay:camera.yfov", &camera->yfov);
    if (!camera->orthographic) {
        camera->tan_half_yfov = assay_tan(0.5 * camera->yfov);
    } else if (!read_number(image, "assay:camera.xmag", &camera->xmag) ||
               !read_number(image, "assay:camera.ymag", &camera->ymag)) {
        return false;
    }
    return read_vector(image, "assay:camera.position", &camera->position) &&
           read_vector(image, "assay:camera.right", &camera->right) &&
           read_vector(image, "assay:camera.up", &camera->up) &&
           read_vector(image, "assay:camera.forward", &camera->forward);
}

/* x, y, and the radius, pixels; false where it is not in the image. */
static bool project(const projection *p, assay_vec3 position, double radius, double out[3],
                    bool *hidden_out)
{
    const assay_camera *camera = &p->camera;
    const assay_vec3    d      = vec3_sub(position, camera->position);
    const double        depth  = vec3_dot(d, camera->forward);
    const double        aspect = (double)p->width / p->height;
    const double half_height   = camera->orthographic ? fmax(camera->ymag, camera->xmag / aspect)
                                                      : depth * camera->tan_half_yfov;
    if (!(depth > 0.0) || !(half_height > 0.0)) {
        return false;
    }
    out[0] = 0.5 * p->width * (1.0 + vec3_dot(d, camera->right) / (half_height * aspect));
    out[1] = 0.5 * p->height * (1.0 - vec3_dot(d, camera->up) / half_height);
    out[2] = fmin(0.5 * p->height * radius / half_height, 2.0 * (p->width + p->height));
    if (!(out[0] >= 0.0 && out[0] < p->width && out[1] >= 0.0 && out[1] < p->height)) {
        return false;
    }
    const double seen =
        p->depth ? p->depth[(size_t)out[1] * (size_t)p->width + (size_t)out[0]] : depth;
    *hidden_out = depth - seen > fmax(0.02 * depth, 0.25 * radius);
    return true;
}

static void put_eighths(assay_report_text *text, double pixels)
{
    assay_report_put_number(text, NULL, assay_floor(8.0 * pixels + 0.5));
}

static void put_records(const projection *p, const assay_array *positions, const assay_array *radii,
                        assay_report_text *text)
{
    const size_t  count = assay_array_rows(positions);
    const size_t  shown = count < RECORDS_SHOWN ? count : RECORDS_SHOWN;
    const double *xyz   = assay_array_values(positions);
    assay_report_open(text, "records", '{');
    assay_report_put_number(text, "count", (double)count);
    assay_report_put_number(text, "shown", (double)shown);
    assay_report_open(text, "circles", '[');
    for (size_t k = 0; k < shown; k++) {
        const size_t     row      = k * count / shown;
        const assay_vec3 position = {xyz[3 * row], xyz[3 * row + 1], xyz[3 * row + 2]};
        double           circle[3];
        bool             hidden;
        if (project(p, position, assay_array_values(radii)[row], circle, &hidden)) {
            for (int i = 0; i < 3; i++) {
                put_eighths(text, circle[i]);
            }
            assay_report_put_number(text, NULL, hidden ? 1.0 : 0.0);
        }
    }
    assay_report_close(text, ']');
    assay_report_close(text, '}');
}

static assay_status read_depth(const assay_report_source *source, projection *p,
                               assay_array **depth_out)
{
    if (!assay_bundle_has(source->bundle, "gbuffer/depth")) {
        return ASSAY_OK;
    }
    const assay_status status =
        assay_bundle_read_array(source->bundle, "gbuffer/depth", "Z", depth_out);
    if (status == ASSAY_OK &&
        assay_array_rows(*depth_out) == (size_t)p->width * (size_t)p->height) {
        p->depth = assay_array_values(*depth_out);
    }
    return status;
}

static assay_status fail_shape(const assay_report_source *source, const char *name)
{
    return assay_fail(source->image->context, ASSAY_ERR_FORMAT,
                      "%s: bundle: '%s' has another shape than records have", source->path, name);
}

static assay_status read_columns(const assay_report_source *source, const char *name,
                                 size_t columns, assay_array **table_out)
{
    const assay_status status = assay_bundle_read_array(source->bundle, name, NULL, table_out);
    return status == ASSAY_OK && assay_array_columns(*table_out) != columns
               ? fail_shape(source, name)
               : status;
}

assay_status assay_report_records_put(const assay_report_source *source, assay_report_text *text)
{
    static const char *const names[] = {"records", "radiance_records"};
    projection               p       = {.depth = NULL};
    for (size_t i = 0; source->bundle && i < sizeof names / sizeof names[0]; i++) {
        char position[64], radius[64];
        snprintf(position, sizeof position, "%s/position", names[i]);
        snprintf(radius, sizeof radius, "%s/radius", names[i]);
        if (!assay_bundle_has(source->bundle, position) || !find_camera(source->image, &p)) {
            continue;
        }
        assay_array *positions = NULL, *radii = NULL, *depth = NULL;
        assay_status status = read_depth(source, &p, &depth);
        status              = status ? status : read_columns(source, position, 3, &positions);
        status              = status ? status : read_columns(source, radius, 1, &radii);
        if (status == ASSAY_OK && assay_array_rows(positions) != assay_array_rows(radii)) {
            status = fail_shape(source, radius);
        }
        if (status == ASSAY_OK) {
            put_records(&p, positions, radii, text);
        }
        assay_array_destroy(positions);
        assay_array_destroy(radii);
        assay_array_destroy(depth);
        return status;
    }
    return ASSAY_OK;
}
