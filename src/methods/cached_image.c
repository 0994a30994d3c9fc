/* cached_image.c - waves of points through filling and evaluating.
 *
 * Invariant: a wave is a run of pixels in a fixed order, far longer than threads are many; nothing
 * of the result depends on how a wave is divided among them.  A sample's random numbers are those
 * of its pixel and number, so both passes see the same point. */
#include "methods/cached_image.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"
#include "math/sobol.h"
#include "trace/camera_ray.h"
#include "trace/visible_point.h"

/* A single pass takes short waves: records of a wave's centres are there for all of its samples. */
enum { WAVE = 4096, SHORT_WAVE = 32, CHUNK = 16, CENTRE = -1 };

/* Scrambles of a pixel. */
enum { PURPOSE_RADIANCE, PURPOSE_IRRADIANCE };

/* What a sample asks of the unit square: its place in the pixel; light, and choices. */
typedef struct {
    assay_point2 place, light, choice;
} sample_points;

/* Where the walk over the pixels stands. */
typedef struct {
    int  width, height, stride, x, y;
    bool first; /* of the coarsest stride: nothing was visited before */
} pixel_walk;

typedef struct {
    uint64_t           pixel;
    assay_cached_point point;
    assay_random       random; /* after the camera ray */
    sample_points      points;
    assay_rgb          emission;
} wave_point;

typedef struct {
    const assay_frame                 *frame;
    const assay_cached_image_settings *settings;
    const assay_cached_light          *light;
    assay_film                        *film;
    assay_ray_counts                  *worker_counts;
    wave_point                        *points; /* WAVE */
    assay_cached_point                *asked;  /* WAVE */
    uint32_t                          *limits; /* WAVE */
    size_t                             count;  /* of this wave */
    int                                sample; /* or CENTRE    */
    const char                        *phase;
    uint64_t                           done, total;      /* points, of the phase    */
    bool                               fills, evaluates; /* this sweep          */
} image_job;

assay_rgb assay_cached_point_lambert(const assay_cached_point *point)
{
    const assay_bsdf_view view = assay_bsdf_seen_from(&point->vertex.bsdf, point->vertex.wo_local);
    return assay_bsdf_view_lambert(&view);
}

static assay_rgb not_negative(assay_rgb c)
{
    return rgb(c.r > 0.0 ? c.r : 0.0, c.g > 0.0 ? c.g : 0.0, c.b > 0.0 ? c.b : 0.0);
}

assay_rgb assay_cached_point_sum(assay_rgb lambert, assay_rgb irradiance, const assay_rgb *gloss,
                                 bool clamp)
{
    const assay_rgb diffuse = rgb_scale(rgb_mul(irradiance, lambert), ASSAY_INV_PI);
    if (!gloss) {
        return diffuse;
    }
    const assay_rgb sum = rgb_add(diffuse, *gloss);
    return clamp ? not_negative(sum) : sum;
}

assay_rgb assay_cached_point_rest(const assay_world *world, const assay_path_settings *path,
                                  const assay_cached_point *point, assay_random *random,
                                  assay_ray_counts *counts)
{
    return point->vertex.bsdf.model == ASSAY_BSDF_LAMBERT
               ? rgb_grey(0.0)
               : assay_path_indirect(world, path, &point->vertex, assay_cached_point_lambert(point),
                                     random, counts);
}

/* ---- the order ---- */

static pixel_walk walk_start(int width, int height, assay_pixel_order order)
{
    pixel_walk walk = {.width = width, .height = height, .stride = 1, .first = true};
    while (order == ASSAY_ORDER_HIERARCHICAL &&
           (2 * walk.stride <= width || 2 * walk.stride <= height)) {
        walk.stride *= 2;
    }
    return walk;
}

static bool is_new(const pixel_walk *walk)
{
    const int coarser = 2 * walk->stride;
    return walk->first || walk->x % coarser != 0 || walk->y % coarser != 0;
}

/* The next pixel; false at the end. */
static bool walk_next(pixel_walk *walk, uint64_t *pixel_out)
{
    while (walk->stride > 0) {
        const bool found = is_new(walk);
        *pixel_out       = (uint64_t)walk->y * (uint64_t)walk->width + (uint64_t)walk->x;
        walk->x += walk->stride;
        if (walk->x >= walk->width) {
            walk->x = 0;
            walk->y += walk->stride;
        }
        if (walk->y >= walk->height) {
            walk->y = 0;
            walk->stride /= 2;
            walk->first = false;
        }
        if (found) {
            return true;
        }
    }
    return false;
}

/* ---- looking ---- */

/* Size of a pixel at a point, m. */
static double footprint_at(const assay_frame *frame, assay_vec3 position)
{
    const assay_camera *camera = frame->camera;
    if (camera->orthographic) {
        const double aspect = (double)frame->width / (double)frame->height;
        return 2.0 * fmax(camera->ymag, camera->xmag / aspect) / frame->height;
    }
    const double distance = vec3_length(vec3_sub(position, camera->position));
    return 2.0 * distance * camera->tan_half_yfov / frame->height;
}

/* Points of sequences that are scrambled anew for each pixel, so that its samples leave no part of
 * pixel and lights out for long: noise that is not the caches' falls faster than that of
 * independent samples, and is less than its variance says. */
static sample_points points_of(const image_job *job, uint64_t pixel, uint32_t sample,
                               uint64_t purpose)
{
    assay_random random =
        assay_random_start(job->frame->seed, ASSAY_STAGE_SCRAMBLE, pixel, purpose);
    const uint64_t place = assay_random_bits(&random), light = assay_random_bits(&random);
    const uint64_t choice = assay_random_bits(&random), order = assay_random_bits(&random);
    return (sample_points){
        .place  = sobol_point(sample, place, (uint32_t)(place ^ order)),
        .light  = sobol_point(sample, light, (uint32_t)order),
        .choice = sobol_point(sample, choice, (uint32_t)(order >> 32)),
    };
}

/* What the path tracer draws first: which light, where on it, which lobe. */
static void choose_light(assay_random *random, const sample_points *points)
{
    const double u[4] = {points->choice.x, points->light.x, points->light.y, points->choice.y};
    assay_random_choose(random, u);
}

static void look_through_centre(const image_job *job, int x, int y, wave_point *point, int worker)
{
    const assay_frame *frame = job->frame;
    point->point.hit = assay_visible_find(frame->world, frame->camera, frame->width, frame->height,
                                          x, y, &job->worker_counts[worker], &point->point.vertex);
}

static void look_through_sample(const image_job *job, int x, int y, wave_point *point, int worker)
{
    const assay_frame *frame = job->frame;
    const assay_world *world = frame->world;
    point->random =
        assay_random_start(frame->seed, ASSAY_STAGE_CAMERA, point->pixel, (uint64_t)job->sample);
    point->points = points_of(job, point->pixel, (uint32_t)job->sample, PURPOSE_RADIANCE);
    const assay_point2 place = point->points.place;
    assay_vec3         origin, direction;
    assay_hit          hit;
    assay_camera_ray(frame->camera, x + place.x, y + place.y, frame->width, frame->height, &origin,
                     &direction);
    point->point.hit = assay_world_closest(world, origin, direction, true, &point->random,
                                           &job->worker_counts[worker].camera, &hit);
    if (!point->point.hit) {
        point->emission = assay_lights_infinite_radiance(world->lights, direction);
        return;
    }
    assay_vertex *vertex = &point->point.vertex;
    assay_vertex_place(world, &hit, direction, vertex);
    point->emission = assay_surface_emission(world->scene, &vertex->surface, vertex->front);
    assay_vertex_dress(world, vertex);
}

static assay_status look(void *user, uint64_t chunk, int worker)
{
    const image_job *job = user;
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < job->count; i++) {
        wave_point *point = &job->points[i];
        const int   x     = (int)(point->pixel % (uint64_t)job->frame->width);
        const int   y     = (int)(point->pixel / (uint64_t)job->frame->width);
        if (job->sample == CENTRE) {
            look_through_centre(job, x, y, point, worker);
        } else {
            look_through_sample(job, x, y, point, worker);
        }
        point->point.centre = job->sample == CENTRE;
        point->point.pixel  = point->pixel;
        if (point->point.hit) {
            point->point.footprint = footprint_at(job->frame, point->point.vertex.surface.position);
        }
        job->asked[i] = point->point;
    }
    return ASSAY_OK;
}

/* ---- evaluating ---- */

static assay_status evaluate_centre(const image_job *job, size_t i, int worker)
{
    const assay_frame        *frame = job->frame;
    const wave_point         *at    = &job->points[i];
    const assay_cached_point *point = &at->point;
    const assay_visible_point described =
        point->hit ? assay_visible_describe(frame->camera, &point->vertex)
                   : assay_visible_nothing();
    assay_film_set_visible(job->film, at->pixel, &described);
    if (!point->hit || !(frame->layers & ASSAY_LAYERS_IRRADIANCE)) {
        return ASSAY_OK;
    }
    assay_rgb           indirect = rgb_grey(0.0);
    assay_path_settings direct   = job->settings->path;
    assay_status        status   = ASSAY_OK;
    assay_vertex        receiver;
    if (direct.bounces >= 2) {
        status = job->light->irradiance(job->light->user, point, job->limits[i], worker, &indirect);
    }
    direct.bounces               = direct.bounces < 1 ? direct.bounces : 1;
    const assay_gather_site site = assay_gather_site_of(&point->vertex);
    assay_vertex_receiver(site.position, &site.frame, site.ng, &receiver);
    for (uint32_t s = 0; s < job->settings->spp && status == ASSAY_OK; s++) {
        assay_random random = assay_random_start(frame->seed, ASSAY_STAGE_IRRADIANCE, at->pixel, s);
        const sample_points points = points_of(job, at->pixel, s, PURPOSE_IRRADIANCE);
        choose_light(&random, &points);
        const assay_rgb e = assay_path_scatter(frame->world, &direct, &receiver, &random,
                                               &job->worker_counts[worker])
                                .direct;
        if (!assay_film_add(job->film, at->pixel, ASSAY_FILM_IRRADIANCE, rgb_add(e, indirect)) ||
            !assay_film_add(job->film, at->pixel, ASSAY_FILM_IRRADIANCE_DIRECT, e) ||
            !assay_film_add(job->film, at->pixel, ASSAY_FILM_IRRADIANCE_INDIRECT, indirect)) {
            status = ASSAY_ERR_DOMAIN;
        }
    }
    return status;
}

static assay_status evaluate_sample(const image_job *job, size_t i, int worker)
{
    wave_point               *at       = &job->points[i];
    const assay_cached_point *point    = &at->point;
    const assay_cached_light *light    = job->light;
    assay_path_settings       settings = job->settings->path;
    assay_ray_counts         *counts   = &job->worker_counts[worker];
    assay_rgb                 direct   = at->emission;
    assay_rgb                 indirect = rgb_grey(0.0);
    assay_status              status   = ASSAY_OK;
    if (point->hit && settings.bounces >= 2) {
        status = light->radiance(light->user, point, job->limits[i], &at->random, counts, worker,
                                 &indirect);
    }
    if (point->hit && settings.bounces >= 1) {
        settings.bounces = 1;
        choose_light(&at->random, &at->points);
        direct = rgb_add(direct, assay_path_scatter(job->frame->world, &settings, &point->vertex,
                                                    &at->random, counts)
                                     .direct);
    }
    assay_rgb color = rgb_add(direct, indirect);
    if (status == ASSAY_OK && light->picture) {
        status = light->picture(light->user, point, job->limits[i], worker, color, &color);
    }
    if (status == ASSAY_OK &&
        (!assay_film_add(job->film, at->pixel, ASSAY_FILM_COLOR, color) ||
         !assay_film_add(job->film, at->pixel, ASSAY_FILM_DIRECT, direct) ||
         !assay_film_add(job->film, at->pixel, ASSAY_FILM_INDIRECT, indirect))) {
        status = ASSAY_ERR_DOMAIN;
    }
    return status;
}

static assay_status evaluate(void *user, uint64_t chunk, int worker)
{
    const image_job *job    = user;
    assay_status     status = ASSAY_OK;
    for (size_t i = chunk * CHUNK; i < (chunk + 1) * CHUNK && i < job->count && !status; i++) {
        status = job->sample == CENTRE ? evaluate_centre(job, i, worker)
                                       : evaluate_sample(job, i, worker);
    }
    return status;
}

/* ---- sweeps ---- */

static assay_status serve_wave(image_job *job)
{
    assay_context *context = job->frame->context;
    const uint64_t chunks  = (job->count + CHUNK - 1) / CHUNK;
    assay_status   status  = assay_parallel_for(context, NULL, chunks, look, job);
    if (status == ASSAY_OK && job->fills && job->settings->path.bounces >= 2) {
        status = job->light->fill(job->light->user, job->phase, job->done, job->total, job->count,
                                  job->asked, job->limits);
    }
    for (size_t i = 0; i < job->count && job->settings->passes > 1; i++) {
        job->limits[i] = UINT32_MAX;
    }
    if (status == ASSAY_OK && job->evaluates) {
        status = assay_parallel_for(context, NULL, chunks, evaluate, job);
        if (status == ASSAY_ERR_MEMORY) {
            return assay_fail_memory(context, "a look into the cache");
        }
    }
    job->done += job->count;
    return status == ASSAY_OK ? assay_progress(context, job->phase, job->done, job->total) : status;
}

/* The walk's next pixels; false at the end. */
static bool take_wave(image_job *job, pixel_walk *walk)
{
    const size_t most = job->settings->passes == 1 ? SHORT_WAVE : WAVE;
    job->count        = 0;
    while (job->count < most && walk_next(walk, &job->points[job->count].pixel)) {
        job->count++;
    }
    return job->count > 0;
}

/* One sample of every pixel, or the centres. */
static assay_status sweep(image_job *job, int sample, bool fills, bool evaluates)
{
    const assay_pixel_order order  = sample == CENTRE ? job->settings->order : ASSAY_ORDER_SCANLINE;
    pixel_walk              walk   = walk_start(job->frame->width, job->frame->height, order);
    assay_status            status = ASSAY_OK;
    job->sample                    = sample;
    job->fills                     = fills;
    job->evaluates                 = evaluates;
    while (status == ASSAY_OK && take_wave(job, &walk)) {
        status = serve_wave(job);
    }
    return status;
}

/* The same points in two sweeps, so that all are known before the first is evaluated. */
static assay_status sweep_whole(image_job *job, int sample, bool evaluates)
{
    const bool fills =
        job->settings->path.bounces >= 2 && (sample == CENTRE || !job->settings->centres);
    assay_status status = fills ? sweep(job, sample, true, false) : ASSAY_OK;
    if (status == ASSAY_OK && fills) {
        status = job->light->complete(job->light->user, job->phase, job->done, job->total);
    }
    return status || !evaluates ? status : sweep(job, sample, false, true);
}

static void begin(image_job *job, const char *phase, int samples)
{
    job->phase = phase;
    job->done  = 0;
    job->total =
        ((uint64_t)samples + 1) * (uint64_t)job->frame->width * (uint64_t)job->frame->height;
}

/* Of two passes the first looks at the centres and at one sample.  What it leaves uncovered are
 * slivers between them; they are filled where the second finds them.  The centres come first
 * whatever layers are asked for, so that these change no record. */
static assay_status run_two_passes(image_job *job, int samples)
{
    const bool   fills  = job->settings->path.bounces >= 2;
    assay_status status = ASSAY_OK;
    begin(job, "records", samples ? 1 : 0);
    status = fills ? sweep(job, CENTRE, true, false) : ASSAY_OK;
    status = status || !fills || !samples ? status : sweep(job, 0, true, false);
    begin(job, "render", samples);
    for (int s = CENTRE; s < samples && status == ASSAY_OK; s++) {
        status = sweep(job, s, true, true);
    }
    return status;
}

/* As two passes, for light that is complete before a sweep is evaluated. */
static assay_status run_whole(image_job *job, int samples)
{
    const bool   fills  = job->settings->path.bounces >= 2;
    const bool   ahead  = fills && samples > 0 && !job->settings->centres;
    assay_status status = ASSAY_OK;
    begin(job, "records", 1);
    status = ahead ? sweep_whole(job, CENTRE, false) : ASSAY_OK;
    status = status || !ahead ? status : sweep_whole(job, 0, false);
    begin(job, "render", !fills ? samples : job->settings->centres ? samples + 1 : 2 * samples + 1);
    for (int s = CENTRE; s < samples && status == ASSAY_OK; s++) {
        status = sweep_whole(job, s, true);
    }
    return status;
}

/* Of one pass each pixel is finished with the records that were there when its turn came. */
static assay_status run_one_pass(image_job *job, int samples)
{
    pixel_walk   walk   = walk_start(job->frame->width, job->frame->height, job->settings->order);
    assay_status status = ASSAY_OK;
    begin(job, "render", samples);
    job->fills     = true;
    job->evaluates = true;
    while (status == ASSAY_OK && take_wave(job, &walk)) {
        for (job->sample = CENTRE; job->sample < samples && status == ASSAY_OK; job->sample++) {
            status = serve_wave(job);
        }
    }
    return status;
}

static assay_status run(image_job *job)
{
    const bool wanted  = (job->frame->layers & (ASSAY_LAYERS_COLOR | ASSAY_LAYERS_SPLIT)) != 0;
    const int  samples = wanted ? (int)job->settings->spp : 0;
    if (job->light->complete) {
        return run_whole(job, samples);
    }
    return job->settings->passes == 1 ? run_one_pass(job, samples) : run_two_passes(job, samples);
}

static bool allocate(image_job *job)
{
    assay_context *context = job->frame->context;
    job->worker_counts =
        assay_allocate(context, (size_t)assay_context_threads(context), sizeof *job->worker_counts);
    job->points = assay_allocate(context, WAVE, sizeof *job->points);
    job->asked  = assay_allocate(context, WAVE, sizeof *job->asked);
    job->limits = assay_allocate(context, WAVE, sizeof *job->limits);
    return job->worker_counts && job->points && job->asked && job->limits;
}

assay_status assay_cached_image_render(const assay_frame                 *frame,
                                       const assay_cached_image_settings *settings,
                                       const assay_cached_light *light, assay_film *film,
                                       assay_ray_counts *counts)
{
    assay_context *context = frame->context;
    image_job      job     = {.frame = frame, .settings = settings, .light = light, .film = film};
    assay_status status = allocate(&job) ? run(&job) : assay_fail_memory(context, "visible points");
    for (int i = 0; job.worker_counts && i < assay_context_threads(context); i++) {
        assay_ray_counts_add(counts, &job.worker_counts[i]);
    }
    assay_release(context, job.worker_counts);
    assay_release(context, job.points);
    assay_release(context, job.asked);
    assay_release(context, job.limits);
    return status == ASSAY_ERR_DOMAIN ? assay_world_fail_light(frame->world) : status;
}
