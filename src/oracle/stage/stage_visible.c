/* stage_visible.c - stage `visible`: what the centres of pixels see.
 *
 * Bounds of position, depth and geometric normal; of a pixel whose ray may as well meet another
 * triangle nothing is known.  Material and triangle are whole numbers: they are right or wrong.
 * Shading normal, albedo and texture coordinates are replayed without a bound. */
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "oracle/stage/ray_bound.h"
#include "oracle/stage/stage_camera.h"
#include "oracle/stage/stage_list.h"
#include "oracle/stage/stage_world.h"
#include "trace/camera_ray.h"
#include "trace/visible_point.h"

enum { CHUNK = 64 };
enum {
    OUT_POSITION,
    OUT_NORMAL,
    OUT_SHADING,
    OUT_DEPTH,
    OUT_ALBEDO,
    OUT_UV,
    OUT_MATERIAL,
    OUT_PRIMITIVE,
    OUT_COUNT
};

/* clang-format off */
static const assay_param_desc PARAMS[] = {
    {"width", ASSAY_PARAM_INT, "pixels", "0", 0, ASSAY_IMAGE_MAX_SIDE, NULL,
     "Of the image; 0: that of the bundle's own images.", ""},
    {"height", ASSAY_PARAM_INT, "pixels", "0", 0, ASSAY_IMAGE_MAX_SIDE, NULL, "Likewise.", ""},
    {0}};

static const assay_stage_array INPUTS[] = {{0}};

static const assay_stage_array OUTPUTS[] = {
    {"gbuffer/position", "m", "X Y Z", "pixel", "0 where nothing is seen", false, false, false},
    {"gbuffer/normal", "", "X Y Z", "pixel", "geometric, on the viewer's side", false, false, false},
    {"gbuffer/shading_normal", "", "X Y Z", "pixel", "", false, false, false},
    {"gbuffer/depth", "m", "Z", "pixel", "along the viewing axis", false, false, false},
    {"gbuffer/albedo", "", "R G B", "pixel", "", false, false, false},
    {"gbuffer/uv", "", "U V", "pixel", "", false, false, false},
    {"gbuffer/material", "", "MaterialId", "pixel", "4294967295 where nothing is seen",
     false, false, false},
    {"gbuffer/primitive", "", "PrimitiveId", "pixel", "likewise", false, false, false},
    {0}};
/* clang-format on */

static const size_t COLUMNS[OUT_COUNT] = {3, 3, 3, 1, 3, 2, 1, 1};

typedef struct {
    const stage_run   *run;
    const assay_world *world;
    stage_camera       view;
    stage_output      *out[OUT_COUNT];
} visible_job;

/* ---- bounds ---- */

static uint32_t ask(const void *user, assay_vec3 origin, assay_vec3 direction)
{
    const visible_job *job   = user;
    uint64_t           count = 0;
    assay_hit          hit;
    return assay_world_visible(job->world, origin, direction, &count, &hit) ? hit.triangle
                                                                            : UINT32_MAX;
}

/* The ray of camera_ray.c: the axes are given, halves of the image and places in it are computed.
 */
static bound_ray ray_of(const visible_job *job, size_t pixel)
{
    const rounding *r    = &job->run->rounding;
    const int       x    = (int)(pixel % (size_t)job->view.width);
    const int       y    = (int)(pixel / (size_t)job->view.width);
    const double    size = bound_scene_size(job->world->scene);
    const double    few  = r->given + 12.0 * r->u; /* of products of up to four numbers each */
    assay_vec3      o, d;
    assay_camera_ray(&job->view.camera, x + 0.5, y + 0.5, job->view.width, job->view.height, &o,
                     &d);
    const assay_vec3 across = vec3_sub(o, job->view.camera.position);
    const double     far    = few * (vec3_length(o) + vec3_length(across) + r->given * size);
    return (bound_ray){.origin    = {{o.x, far}, {o.y, far}, {o.z, far}},
                       .direction = {{d.x, 2.0 * few}, {d.y, 2.0 * few}, {d.z, 2.0 * few}}};
}

static void put_bounds(size_t pixel, const tracked3 *a, stage_output *out)
{
    out->bounds[3 * pixel]     = a->x.e;
    out->bounds[3 * pixel + 1] = a->y.e;
    out->bounds[3 * pixel + 2] = a->z.e;
}

static void forget(const visible_job *job, size_t pixel)
{
    for (int k = 0; k < OUT_COUNT; k++) {
        for (size_t c = 0; c < COLUMNS[k]; c++) {
            job->out[k]->bounds[COLUMNS[k] * pixel + c] = NAN;
        }
    }
}

static void bound_pixel(const visible_job *job, size_t pixel, uint32_t triangle)
{
    const rounding    *r     = &job->run->rounding;
    const assay_scene *scene = job->world->scene;
    const bound_ray    ray   = ray_of(job, pixel);
    const bound_hit    hit   = triangle != UINT32_MAX ? bound_hit_of(r, scene, triangle, &ray)
                                                      : (bound_hit){.distance = {INFINITY, 0.0}};
    if (bound_is_torn(r, scene, &ray, triangle, hit.distance.v, ask, job)) {
        forget(job, pixel);
        return;
    }
    for (int k = OUT_SHADING; k <= OUT_UV; k++) {
        for (size_t c = 0; k != OUT_DEPTH && c < COLUMNS[k]; c++) {
            job->out[k]->bounds[COLUMNS[k] * pixel + c] = NAN;
        }
    }
    if (triangle != UINT32_MAX) {
        const tracked3 camera = tracked3_given(r, job->view.camera.position);
        const tracked3 axis   = tracked3_given(r, job->view.camera.forward);
        const tracked3 way    = tracked3_sub(r, &hit.point, &camera);
        put_bounds(pixel, &hit.point, job->out[OUT_POSITION]);
        put_bounds(pixel, &hit.normal, job->out[OUT_NORMAL]);
        job->out[OUT_DEPTH]->bounds[pixel] = tracked3_dot(r, &way, &axis).e;
    }
}

/* ---- values ---- */

static void put(stage_output *out, size_t pixel, const void *from)
{
    memcpy(out->values + out->columns * pixel, from, out->columns * sizeof *out->values);
}

static void look(const visible_job *job, size_t pixel)
{
    assay_vertex        vertex;
    assay_ray_counts    counts = {0};
    const stage_camera *view   = &job->view;
    assay_visible_point p      = assay_visible_nothing();
    if (assay_visible_find(job->world, &view->camera, view->width, view->height,
                           (int)(pixel % (size_t)view->width), (int)(pixel / (size_t)view->width),
                           &counts, &vertex)) {
        p = assay_visible_describe(&view->camera, &vertex);
    }
    const double material = p.material, primitive = p.primitive;
    const double uv[2] = {p.uv[0], p.uv[1]};
    put(job->out[OUT_POSITION], pixel, &p.position);
    put(job->out[OUT_NORMAL], pixel, &p.ng);
    put(job->out[OUT_SHADING], pixel, &p.ns);
    put(job->out[OUT_DEPTH], pixel, &p.z);
    put(job->out[OUT_ALBEDO], pixel, &p.albedo);
    put(job->out[OUT_UV], pixel, uv);
    put(job->out[OUT_MATERIAL], pixel, &material);
    put(job->out[OUT_PRIMITIVE], pixel, &primitive);
    if (job->run->bounded) {
        bound_pixel(job, pixel, p.hit ? p.primitive : UINT32_MAX);
    }
}

static assay_status look_at_pixels(void *user, uint64_t chunk, int worker)
{
    const visible_job *job = user;
    (void)worker;
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < job->out[0]->rows; i++) {
        look(job, i);
    }
    return ASSAY_OK;
}

static assay_status look_around(stage_run *run, visible_job *job)
{
    const size_t pixels = (size_t)job->view.width * (size_t)job->view.height;
    assay_status status = ASSAY_OK;
    for (int k = 0; k < OUT_COUNT && status == ASSAY_OK; k++) {
        status = stage_output_make(run, k, 0, pixels, COLUMNS[k], &job->out[k]);
    }
    return status ? status
                  : assay_parallel_for(run->context, NULL, (pixels + CHUNK - 1) / CHUNK,
                                       look_at_pixels, job);
}

static assay_status run_visible(stage_run *run)
{
    assay_world *world  = NULL;
    visible_job  job    = {.run = run};
    const int    width  = assay_params_int(run->params, "width");
    const int    height = assay_params_int(run->params, "height");
    assay_status status = stage_camera_of_image(run, width, height, &job.view);
    status              = status ? status : stage_world_create(run, &world);
    job.world           = world;
    status              = status ? status : look_around(run, &job);
    assay_world_destroy(world);
    return status;
}

const oracle_stage stage_visible = {.info = {.name        = "visible",
                                             .summary     = "what the centres of pixels see",
                                             .params      = PARAMS,
                                             .inputs      = INPUTS,
                                             .outputs     = OUTPUTS,
                                             .needs_scene = true},
                                    .run  = run_visible};
