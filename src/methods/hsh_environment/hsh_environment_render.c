/* hsh_environment_render.c - at every point: turn the environment into the local frame, convert it
 * to the BRDF's basis, and take the dot product [gautron06] 3.5.3.
 *
 * Invariant: the local frame is right-handed with z on the viewer's side (material_grids.h).
 * Nothing is random but the place in the pixel, and that is where `path` looks, too. */
#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "methods/hsh_environment/hsh_environment.h"
#include "trace/camera_ray.h"
#include "trace/visible_point.h"

enum { CHANNELS = HSH_ENVIRONMENT_CHANNELS };

/* Memory of one worker. */
typedef struct {
    double          *matrix; /* rotation of SH                               */
    double          *turned; /* CHANNELS rows of SH: light, local            */
    double          *light;  /* CHANNELS rows of the BRDF's basis            */
    double          *lobe;   /* the BRDF's coefficients                      */
    double          *values; /* SH at a normal                               */
    assay_ray_counts counts;
} desk;

typedef struct {
    const hsh_environment *state;
    const assay_frame     *frame;
    assay_film            *film;
    desk                  *desks;
} render_job;

static double dot(size_t count, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* The environment's light in the BRDF's basis and the local frame. */
static assay_status light_at(const hsh_environment *s, desk *d, const assay_frame3 *frame)
{
    const double to_local[9] = {frame->x.x, frame->x.y, frame->x.z, frame->y.x, frame->y.y,
                                frame->y.z, frame->z.x, frame->z.y, frame->z.z};
    const size_t in = assay_basis_count(s->sh), out = assay_basis_count(s->brdf);
    assay_status status = assay_sh_rotation(s->sh, to_local, d->matrix);
    if (status == ASSAY_OK) {
        status = assay_sh_rotate(s->sh, d->matrix, CHANNELS, s->light, d->turned);
    }
    for (size_t c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        if (s->to_brdf) {
            assay_sparse_multiply(s->to_brdf, d->turned + c * in, d->light + c * out);
        } else {
            for (size_t i = 0; i < out; i++) {
                d->light[c * out + i] = d->turned[c * in + i];
            }
        }
    }
    return status;
}

static assay_status reflect(const hsh_environment *s, desk *d, const assay_vertex *vertex,
                            assay_rgb *radiance_out)
{
    const assay_material_grids *grids  = &s->materials[vertex->surface.material];
    const assay_frame3          frame  = assay_material_frame(vertex);
    assay_status                status = ASSAY_OK;
    if (grids->slope) {
        status = light_at(s, d, &frame);
    }
    return status ? status
                  : assay_material_grids_reflect(grids, assay_basis_count(s->brdf), vertex,
                                                 d->light, d->lobe, radiance_out);
}

static assay_status sample_color(const render_job *job, desk *d, int x, int y, uint64_t pixel,
                                 uint32_t sample)
{
    const assay_frame *frame  = job->frame;
    const assay_world *world  = frame->world;
    assay_random       random = assay_random_start(frame->seed, ASSAY_STAGE_CAMERA, pixel, sample);
    const double       dx     = assay_random_next(&random);
    const double       dy     = assay_random_next(&random);
    assay_vec3         origin, direction;
    assay_hit          hit;
    assay_rgb          radiance;
    assay_camera_ray(frame->camera, x + dx, y + dy, frame->width, frame->height, &origin,
                     &direction);
    if (!assay_world_closest(world, origin, direction, true, &random, &d->counts.camera, &hit)) {
        radiance = assay_lights_infinite_radiance(world->lights, direction);
    } else {
        assay_vertex vertex;
        assay_vertex_place(world, &hit, direction, &vertex);
        assay_vertex_dress(world, &vertex);
        const assay_status status = reflect(job->state, d, &vertex, &radiance);
        if (status != ASSAY_OK) {
            return status;
        }
        radiance =
            rgb_add(radiance, assay_surface_emission(world->scene, &vertex.surface, vertex.front));
    }
    return assay_film_add(job->film, pixel, ASSAY_FILM_COLOR, radiance) &&
                   assay_film_add(job->film, pixel, ASSAY_FILM_DIRECT, radiance) &&
                   assay_film_add(job->film, pixel, ASSAY_FILM_INDIRECT, rgb_grey(0.0))
               ? ASSAY_OK
               : ASSAY_ERR_DOMAIN;
}

/* E = sum of A_l c_l^m Y_l^m(n) [kontkanen] eq. 1. */
static assay_status add_irradiance(const render_job *job, desk *d, uint64_t pixel, assay_vec3 n)
{
    const hsh_environment *s      = job->state;
    const size_t           count  = assay_basis_count(s->sh);
    assay_status           status = assay_basis_evaluate(s->sh, n, d->values);
    if (status != ASSAY_OK) {
        return status;
    }
    for (size_t i = 0; i < count; i++) {
        int l, m;
        assay_basis_function(s->sh, i, &l, &m);
        d->values[i] *= s->cosine[l];
    }
    const assay_rgb e =
        rgb(dot(count, s->light, d->values), dot(count, s->light + count, d->values),
            dot(count, s->light + 2 * count, d->values));
    return assay_film_add(job->film, pixel, ASSAY_FILM_IRRADIANCE, e) &&
                   assay_film_add(job->film, pixel, ASSAY_FILM_IRRADIANCE_DIRECT, e) &&
                   assay_film_add(job->film, pixel, ASSAY_FILM_IRRADIANCE_INDIRECT, rgb_grey(0.0))
               ? ASSAY_OK
               : ASSAY_ERR_DOMAIN;
}

static assay_status render_pixel(const render_job *job, desk *d, int x, int y)
{
    const assay_frame *frame  = job->frame;
    const uint64_t     pixel  = (uint64_t)y * (uint64_t)frame->width + (uint64_t)x;
    assay_status       status = ASSAY_OK;
    if (frame->layers & (ASSAY_LAYERS_COLOR | ASSAY_LAYERS_SPLIT)) {
        for (uint32_t i = 0; i < job->state->spp && status == ASSAY_OK; i++) {
            status = sample_color(job, d, x, y, pixel, i);
        }
    }
    if (status != ASSAY_OK || !(frame->layers & (ASSAY_LAYERS_GBUFFER | ASSAY_LAYERS_IRRADIANCE))) {
        return status;
    }
    assay_visible_point point = assay_visible_nothing();
    assay_vertex        visible;
    if (assay_visible_find(frame->world, frame->camera, frame->width, frame->height, x, y,
                           &d->counts, &visible)) {
        point  = assay_visible_describe(frame->camera, &visible);
        status = frame->layers & ASSAY_LAYERS_IRRADIANCE ? add_irradiance(job, d, pixel, point.ns)
                                                         : ASSAY_OK;
    }
    assay_film_set_visible(job->film, pixel, &point);
    return status;
}

static assay_status render_row(void *user, uint64_t y, int worker)
{
    const render_job *job    = user;
    assay_status      status = ASSAY_OK;
    for (int x = 0; x < job->frame->width && status == ASSAY_OK; x++) {
        status = render_pixel(job, &job->desks[worker], x, (int)y);
    }
    return status;
}

/* ---- the workers' memory ---- */

static bool set_up(const hsh_environment *s, desk *d)
{
    const size_t in = assay_basis_count(s->sh), out = assay_basis_count(s->brdf);
    d->matrix = assay_allocate(s->context, in, in * sizeof(double));
    d->turned = assay_allocate(s->context, CHANNELS * in, sizeof(double));
    d->light  = assay_allocate(s->context, CHANNELS * out, sizeof(double));
    d->lobe   = assay_allocate(s->context, out, sizeof(double));
    d->values = assay_allocate(s->context, in, sizeof(double));
    return d->matrix && d->turned && d->light && d->lobe && d->values;
}

static void clear(const hsh_environment *s, desk *d)
{
    assay_release(s->context, d->matrix);
    assay_release(s->context, d->turned);
    assay_release(s->context, d->light);
    assay_release(s->context, d->lobe);
    assay_release(s->context, d->values);
}

assay_status hsh_environment_render(void *state, const assay_frame *frame, assay_film *film,
                                    assay_ray_counts *counts)
{
    const hsh_environment *s       = state;
    const int              threads = assay_context_threads(frame->context);
    render_job             job     = {.state = s, .frame = frame, .film = film};
    assay_status           status  = ASSAY_OK;
    job.desks = assay_allocate(frame->context, (size_t)threads, sizeof *job.desks);
    if (!job.desks) {
        return assay_fail_memory(frame->context, "hsh-environment");
    }
    for (int i = 0; i < threads && status == ASSAY_OK; i++) {
        if (!set_up(s, &job.desks[i])) {
            status = assay_fail_memory(frame->context, "rotations of harmonics");
        }
    }
    if (status == ASSAY_OK) {
        status =
            assay_parallel_for(frame->context, "render", (uint64_t)frame->height, render_row, &job);
        if (status == ASSAY_ERR_DOMAIN) {
            assay_fail(frame->context, status, "%s: gives light that is too bright to compute with",
                       frame->world->scene->path);
        }
    }
    for (int i = 0; i < threads; i++) {
        assay_ray_counts_add(counts, &job.desks[i].counts);
        clear(s, &job.desks[i]);
    }
    assay_release(frame->context, job.desks);
    return status;
}
