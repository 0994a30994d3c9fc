/* path_probe.c - irradiance and its gradients at given points.
 *
 * Differences are taken sample by sample with the same random numbers on both sides, so most of the
 * noise cancels and the gradient's variance can be measured like any other.  Along the normal the
 * difference is one-sided: behind a point on a surface there is no irradiance to compare with.
 *
 * Paths of a difference find lights by light sampling alone, at every vertex.  What it finds moves
 * smoothly with the point, while a scattered ray that just hits a light from one side and just
 * misses it from the other makes a difference of size 1 / step with a probability of the order of
 * the step: right in the mean, but seen in so few samples that their variance says nothing.
 * Perfectly specular lobes have no choice and keep such events.
 *
 * Invariant: between passes the result's rows hold means and sums of squared deviations. */
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "core/parallel.h"
#include "methods/path/path.h"

/* Quantities of a probe: three values (R, G, B) and the variances of their means each. */
enum {
    TOTAL,
    DIRECT,
    INDIRECT,
    TRANSLATION, /* three: x, y, z */
    ROTATION         = TRANSLATION + 3,
    QUANTITIES       = ROTATION + 3,
    QUANTITIES_PLAIN = TRANSLATION
};

typedef struct {
    const assay_path_state   *state;
    const assay_frame        *frame;
    const assay_probe_points *points;
    double                   *rows;
    assay_ray_counts         *worker_counts;
    assay_path_settings       smooth; /* of the paths of differences */
    double                    step;   /* m                           */
    uint32_t                  quantities;
    uint32_t                  first, count; /* samples of this pass */
} probe_job;

/* sums: three means and three sums of squared deviations from them. */
static void add_sample(double sums[6], double count, assay_rgb value)
{
    const double sample[3] = {value.r, value.g, value.b};
    for (int c = 0; c < 3; c++) {
        const double deviation = sample[c] - sums[c];
        sums[c] += deviation / count;
        sums[3 + c] += deviation * (sample[c] - sums[c]);
    }
}

static assay_path_light measure(const probe_job *job, const assay_path_settings *settings,
                                uint64_t index, uint32_t sample, assay_vec3 position,
                                const assay_frame3 *frame, assay_ray_counts *counts)
{
    assay_vertex receiver;
    assay_vertex_receiver(position, frame, frame->z, &receiver);
    assay_random random = assay_random_start(job->frame->seed, ASSAY_STAGE_PROBE, index, sample);
    return assay_path_scatter(job->frame->world, settings, &receiver, &random, counts);
}

static assay_rgb total(assay_path_light light) { return rgb_add(light.direct, light.indirect); }

static assay_rgb difference(assay_path_light a, assay_path_light b, double scale)
{
    return rgb_scale(rgb_add(total(a), rgb_scale(total(b), -1.0)), scale);
}

/* The frame turned by an angle about an axis in its tangent plane (Rodrigues). */
static assay_frame3 turn(const assay_frame3 *frame, assay_vec3 axis, double angle)
{
    const assay_sincos s       = assay_sincos_radians(angle);
    assay_frame3       out     = *frame;
    assay_vec3 *const  parts[] = {&out.x, &out.y, &out.z};
    for (int i = 0; i < 3; i++) {
        const assay_vec3 v      = *parts[i];
        const double     along  = vec3_dot(axis, v) * (1.0 - s.cos);
        const assay_vec3 turned = vec3_mad(vec3_scale(v, s.cos), s.sin, vec3_cross(axis, v));
        *parts[i]               = vec3_mad(turned, along, axis);
    }
    return out;
}

/* From slopes along the frame's axes to a gradient in the world; out: x, y, z. */
static void to_world(const assay_frame3 *frame, const assay_rgb slope[3], assay_rgb out[3])
{
    const double m[3][3] = {{frame->x.x, frame->y.x, frame->z.x},
                            {frame->x.y, frame->y.y, frame->z.y},
                            {frame->x.z, frame->y.z, frame->z.z}};
    for (int i = 0; i < 3; i++) {
        out[i] = rgb_add(rgb_add(rgb_scale(slope[0], m[i][0]), rgb_scale(slope[1], m[i][1])),
                         rgb_scale(slope[2], m[i][2]));
    }
}

static void measure_gradients(const probe_job *job, uint64_t index, uint32_t sample,
                              const assay_frame3 *frame, assay_path_light here,
                              assay_ray_counts *counts, assay_rgb out[6])
{
    const assay_path_settings *smooth  = &job->smooth;
    const assay_vec3           p       = job->points->positions[index];
    const double               h       = job->step;
    const double               angle   = job->state->gradient_angle;
    const assay_vec3           axis[2] = {frame->x, frame->y};
    assay_rgb                  slope[3], spin[3] = {{0}};
    for (int i = 0; i < 2; i++) {
        const assay_path_light ahead =
            measure(job, smooth, index, sample, vec3_mad(p, h, axis[i]), frame, counts);
        const assay_path_light behind =
            measure(job, smooth, index, sample, vec3_mad(p, -h, axis[i]), frame, counts);
        slope[i] = difference(ahead, behind, 0.5 / h);

        const assay_frame3     left       = turn(frame, axis[i], angle);
        const assay_frame3     right      = turn(frame, axis[i], -angle);
        const assay_path_light turned     = measure(job, smooth, index, sample, p, &left, counts);
        const assay_path_light turned_off = measure(job, smooth, index, sample, p, &right, counts);
        spin[i]                           = difference(turned, turned_off, 0.5 / angle);
    }
    if (job->state->settings.estimator != smooth->estimator) {
        here = measure(job, smooth, index, sample, p, frame, counts);
    }
    const assay_path_light above =
        measure(job, smooth, index, sample, vec3_mad(p, h, frame->z), frame, counts);
    slope[2] = difference(above, here, 1.0 / h);
    to_world(frame, slope, out);
    to_world(frame, spin, out + 3);
}

static assay_status probe_point(void *user, uint64_t index, int worker)
{
    const probe_job   *job    = user;
    assay_ray_counts  *counts = &job->worker_counts[worker];
    const assay_frame3 frame  = frame3_from_z(job->points->normals[index]);
    double            *row    = job->rows + index * job->quantities * 6;
    for (uint32_t s = job->first; s < job->first + job->count; s++) {
        const assay_path_light here              = measure(job, &job->state->settings, index, s,
                                                           job->points->positions[index], &frame, counts);
        assay_rgb              value[QUANTITIES] = {total(here), here.direct, here.indirect};
        if (job->quantities == QUANTITIES) {
            measure_gradients(job, index, s, &frame, here, counts, value + TRANSLATION);
        }
        for (uint32_t q = 0; q < job->quantities; q++) {
            if (!rgb_finite(value[q])) {
                return ASSAY_ERR_DOMAIN;
            }
            add_sample(row + 6 * (size_t)q, s + 1.0, value[q]);
        }
    }
    return ASSAY_OK;
}

static assay_status run_passes(probe_job *job)
{
    const uint64_t points = job->points->count;
    const uint32_t passes = (job->state->spp - 1) / ASSAY_PATH_POINT_PASS + 1;
    assay_status   status = ASSAY_OK;
    for (uint32_t i = 0; i < passes && points > 0 && status == ASSAY_OK; i++) {
        const uint32_t left = job->state->spp - job->first;
        job->count          = left < ASSAY_PATH_POINT_PASS ? left : ASSAY_PATH_POINT_PASS;
        status = assay_parallel_part(job->frame->context, "probe", i * points, passes * points,
                                     points, probe_point, job);
        job->first += job->count;
    }
    return status == ASSAY_ERR_DOMAIN ? assay_world_fail_light(job->frame->world) : status;
}

/* From sums of squared deviations to variances of the means. */
static void finish_rows(const probe_job *job)
{
    const double n     = job->state->spp;
    const double scale = n > 1.0 ? 1.0 / (n * (n - 1.0)) : 0.0;
    const size_t count = job->points->count * job->quantities;
    for (size_t i = 0; i < count; i++) {
        for (int c = 3; c < 6; c++) {
            job->rows[6 * i + (size_t)c] *= scale;
        }
    }
}

/* Where a path meets the edge of something with a probability of the order of the step, as many
 * samples as fill the scene's diagonal (or a radian) with steps meet about one: with fewer, the
 * variance is that of paths that met none. */
static void warn_of_short_steps(const probe_job *job, double diagonal)
{
    const double samples = job->state->spp;
    const double angle   = job->state->gradient_angle;
    if (job->quantities == QUANTITIES && job->points->count > 0 &&
        (samples * job->step < diagonal || samples * angle < 1.0)) {
        assay_inform(job->frame->context, ASSAY_LOG_WARNING,
                     "gradients: %g samples with steps of %g m and %g rad rarely meet the edges of "
                     "shadows, and their variances may be far too small; take spp * gradient_step "
                     ">= %.3g m and spp * gradient_angle >= 1, or gradients=off",
                     samples, job->step, angle, diagonal);
    }
}

assay_status assay_path_probe(void *state, const assay_frame *frame,
                              const assay_probe_points *points, double *rows,
                              assay_ray_counts *counts)
{
    const assay_path_state *path    = state;
    const assay_scene      *scene   = frame->world->scene;
    const double            extent  = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    const int               threads = assay_context_threads(frame->context);
    assay_ray_counts       *worker_counts =
        assay_allocate(frame->context, (size_t)threads, sizeof *worker_counts);
    if (!worker_counts) {
        return assay_fail_memory(frame->context, "ray counts");
    }
    probe_job job = {
        .state         = path,
        .frame         = frame,
        .points        = points,
        .rows          = rows,
        .worker_counts = worker_counts,
        .smooth        = path->settings,
        .step          = path->gradient_step > 0.0 ? path->gradient_step
                         : extent > 0.0            ? 1e-3 * extent
                                                   : 1e-3,
        .quantities    = path->gradients ? QUANTITIES : QUANTITIES_PLAIN,
    };
    job.smooth.estimator = ASSAY_ESTIMATOR_NEE;
    warn_of_short_steps(&job, extent);
    const assay_status status = run_passes(&job);
    for (int i = 0; i < threads; i++) {
        assay_ray_counts_add(counts, &worker_counts[i]);
    }
    assay_release(frame->context, worker_counts);
    if (status == ASSAY_OK) {
        finish_rows(&job);
    }
    return status;
}
