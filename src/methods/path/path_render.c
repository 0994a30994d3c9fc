/* path_render.c - an image by path tracing.
 *
 * Every pixel has two streams of samples: radiance through random places of the pixel, and
 * irradiance at the one visible point behind its centre.  Rounds follow one another until the
 * error is small enough, each in passes over all pixels; a pixel's samples are numbered through, so
 * cutting them up changes no bit. */
#include "core/alloc.h"
#include "core/context.h"
#include "core/parallel.h"
#include "methods/path/path.h"
#include "trace/camera_ray.h"
#include "trace/visible_point.h"

enum { TILE = 16 };

/* One pass: samples [first, first + count) of every pixel. */
typedef struct {
    const assay_path_state *state;
    const assay_frame      *frame;
    assay_film             *film;
    assay_ray_counts       *worker_counts;
    uint32_t                first, count;
    uint32_t                tiles_across;
} render_pass;

static assay_status add_radiance(const render_pass *pass, int x, int y, uint64_t pixel,
                                 assay_ray_counts *counts)
{
    const assay_frame *frame = pass->frame;
    for (uint32_t s = pass->first; s < pass->first + pass->count; s++) {
        assay_random random = assay_random_start(frame->seed, ASSAY_STAGE_CAMERA, pixel, s);
        const double dx     = assay_random_next(&random);
        const double dy     = assay_random_next(&random);
        assay_vec3   origin, direction;
        assay_camera_ray(frame->camera, x + dx, y + dy, frame->width, frame->height, &origin,
                         &direction);
        const assay_path_light light = assay_path_radiance(frame->world, &pass->state->settings,
                                                           origin, direction, &random, counts);
        if (!assay_film_add(pass->film, pixel, ASSAY_FILM_COLOR,
                            rgb_add(light.direct, light.indirect)) ||
            !assay_film_add(pass->film, pixel, ASSAY_FILM_DIRECT, light.direct) ||
            !assay_film_add(pass->film, pixel, ASSAY_FILM_INDIRECT, light.indirect)) {
            return ASSAY_ERR_DOMAIN;
        }
    }
    return ASSAY_OK;
}

static assay_status add_irradiance(const render_pass *pass, const assay_vertex *visible,
                                   uint64_t pixel, assay_ray_counts *counts)
{
    const double       side  = visible->front ? 1.0 : -1.0;
    const assay_frame3 frame = frame3_from_z(vec3_scale(visible->surface.ns, side));
    assay_vertex       receiver;
    assay_vertex_receiver(visible->surface.position, &frame, vec3_scale(visible->surface.ng, side),
                          &receiver);
    for (uint32_t s = pass->first; s < pass->first + pass->count; s++) {
        assay_random random =
            assay_random_start(pass->frame->seed, ASSAY_STAGE_IRRADIANCE, pixel, s);
        const assay_path_light e = assay_path_scatter(pass->frame->world, &pass->state->settings,
                                                      &receiver, &random, counts);
        if (!assay_film_add(pass->film, pixel, ASSAY_FILM_IRRADIANCE,
                            rgb_add(e.direct, e.indirect)) ||
            !assay_film_add(pass->film, pixel, ASSAY_FILM_IRRADIANCE_DIRECT, e.direct) ||
            !assay_film_add(pass->film, pixel, ASSAY_FILM_IRRADIANCE_INDIRECT, e.indirect)) {
            return ASSAY_ERR_DOMAIN;
        }
    }
    return ASSAY_OK;
}

static assay_status render_pixel(const render_pass *pass, int x, int y, assay_ray_counts *counts)
{
    const assay_frame *frame  = pass->frame;
    const uint64_t     pixel  = (uint64_t)y * (uint64_t)frame->width + (uint64_t)x;
    assay_status       status = ASSAY_OK;
    if (frame->layers & (ASSAY_LAYERS_COLOR | ASSAY_LAYERS_SPLIT)) {
        status = add_radiance(pass, x, y, pixel, counts);
    }
    const bool first = pass->first == 0 && (frame->layers & ASSAY_LAYERS_GBUFFER);
    if (status != ASSAY_OK || !(first || (frame->layers & ASSAY_LAYERS_IRRADIANCE))) {
        return status;
    }
    assay_visible_point point = assay_visible_nothing();
    assay_vertex        visible;
    if (assay_visible_find(frame->world, frame->camera, frame->width, frame->height, x, y, counts,
                           &visible)) {
        point = assay_visible_describe(frame->camera, &visible);
        if (frame->layers & ASSAY_LAYERS_IRRADIANCE) {
            status = add_irradiance(pass, &visible, pixel, counts);
        }
    }
    assay_film_set_visible(pass->film, pixel, &point);
    return status;
}

static assay_status render_tile(void *user, uint64_t index, int worker)
{
    const render_pass *pass   = user;
    const int          x0     = (int)(index % pass->tiles_across) * TILE;
    const int          y0     = (int)(index / pass->tiles_across) * TILE;
    const int          x1     = x0 + TILE < pass->frame->width ? x0 + TILE : pass->frame->width;
    const int          y1     = y0 + TILE < pass->frame->height ? y0 + TILE : pass->frame->height;
    assay_status       status = ASSAY_OK;
    for (int y = y0; y < y1 && status == ASSAY_OK; y++) {
        for (int x = x0; x < x1 && status == ASSAY_OK; x++) {
            status = render_pixel(pass, x, y, &pass->worker_counts[worker]);
        }
    }
    return status;
}

/* Samples of each pixel that must be there before their variance may decide anything. */
static uint32_t least_decided(const assay_frame *frame)
{
    const uint32_t pixels = (uint32_t)frame->width * (uint32_t)frame->height;
    const uint32_t share  = (ASSAY_PATH_DECIDE_IMAGE - 1) / pixels + 1;
    return share > ASSAY_PATH_DECIDE_PIXEL ? share : ASSAY_PATH_DECIDE_PIXEL;
}

/* How many more samples a pixel wants: the error falls with the square root of their number; at
 * least a quarter more, at most as many again, so that a poor first guess cannot mislead.
 *
 * BIASED: an image that stops where its measured error is small is more likely one that missed
 * bright and rare light.  The first decision's size keeps that small; how small is measured in
 * docs/methods/path.md. */
static uint32_t next_count(const render_pass *pass, double error)
{
    const assay_path_state *state = pass->state;
    const uint32_t          done = pass->first, left = state->max_spp - done;
    const uint32_t          least_done = least_decided(pass->frame);
    if (done < least_done) {
        return least_done - done < left ? least_done - done : left;
    }
    if (error <= state->target_error) {
        return 0;
    }
    const double   ratio  = error / state->target_error;
    const double   wanted = ceil((double)done * (ratio * ratio - 1.0));
    const double   least  = ceil(0.25 * (double)done);
    const double   most   = (double)done;
    const uint32_t count  = (uint32_t)(wanted < least ? least : wanted > most ? most : wanted);
    return count < left ? count : left;
}

/* `count` more samples of every pixel, in passes of at most ASSAY_PATH_PIXEL_PASS. */
static assay_status run_round(render_pass *pass, uint32_t count)
{
    const assay_frame *frame  = pass->frame;
    const uint64_t     tiles  = pass->tiles_across * (((uint64_t)frame->height + TILE - 1) / TILE);
    const uint32_t     passes = (count - 1) / ASSAY_PATH_PIXEL_PASS + 1;
    const uint32_t     end    = pass->first + count;
    assay_status       status = ASSAY_OK;
    for (uint32_t i = 0; i < passes && status == ASSAY_OK; i++) {
        const uint32_t left = end - pass->first;
        pass->count         = left < ASSAY_PATH_PIXEL_PASS ? left : ASSAY_PATH_PIXEL_PASS;
        status = assay_parallel_part(frame->context, "render", i * tiles, passes * tiles, tiles,
                                     render_tile, pass);
        pass->first += pass->count;
    }
    if (status == ASSAY_ERR_DOMAIN) {
        return assay_world_fail_light(frame->world);
    }
    return status;
}

/* What became of the target, in the film and, where it was missed, in words. */
static void judge_target(const render_pass *pass)
{
    const double   target = pass->state->target_error;
    const double   error  = assay_film_relative_error(pass->film);
    const uint32_t least  = least_decided(pass->frame);
    if (pass->first >= least && error <= target) {
        assay_film_set_target(pass->film, ASSAY_TARGET_REACHED);
        return;
    }
    assay_film_set_target(pass->film, ASSAY_TARGET_MISSED);
    if (pass->first < least) {
        assay_inform(pass->frame->context, ASSAY_LOG_WARNING,
                     "target_error %g: max_spp stopped at %u samples a pixel, but it takes %u to "
                     "know the error of an image of this size",
                     target, pass->first, least);
    } else {
        assay_inform(pass->frame->context, ASSAY_LOG_WARNING,
                     "target_error %g was not reached: the relative error is %.3g after max_spp = "
                     "%u samples a pixel",
                     target, error, pass->first);
    }
}

static assay_status run_rounds(render_pass *pass)
{
    const bool   until_target = pass->state->target_error > 0.0;
    assay_status status       = ASSAY_OK;
    uint32_t     count        = pass->state->spp;
    while (count > 0 && status == ASSAY_OK) {
        status = run_round(pass, count);
        count  = until_target ? next_count(pass, assay_film_relative_error(pass->film)) : 0;
    }
    if (status == ASSAY_OK && until_target) {
        judge_target(pass);
    }
    return status;
}

assay_status assay_path_render(void *state, const assay_frame *frame, assay_film *film,
                               assay_ray_counts *counts)
{
    const int         threads = assay_context_threads(frame->context);
    assay_ray_counts *worker_counts =
        assay_allocate(frame->context, (size_t)threads, sizeof *worker_counts);
    if (!worker_counts) {
        return assay_fail_memory(frame->context, "ray counts");
    }
    render_pass        pass   = {.state         = state,
                                 .frame         = frame,
                                 .film          = film,
                                 .worker_counts = worker_counts,
                                 .tiles_across  = (uint32_t)((frame->width + TILE - 1) / TILE)};
    const assay_status status = run_rounds(&pass);
    for (int i = 0; i < threads; i++) {
        assay_ray_counts_add(counts, &worker_counts[i]);
    }
    assay_release(frame->context, worker_counts);
    return status;
}
