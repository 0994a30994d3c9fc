/* path_probe.c - irradiance and its gradients at given points.
 *
 * Differences are taken sample by sample with the same random numbers on both sides, so most of the
 * noise cancels and the gradient's variance can be measured like any other.  Along the normal the
 * difference is one-sided: behind a point on a surface there is no irradiance to compare with. */
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
    double                    step; /* m */
    uint32_t                  quantities;
} probe_job;

typedef struct {
    double mean[3], squares[3];
} running;

static void add_sample(running *sum, double count, assay_rgb value)
{
    const double sample[3] = {value.r, value.g, value.b};
    for (int c = 0; c < 3; c++) {
        const double deviation = sample[c] - sum->mean[c];
        sum->mean[c] += deviation / count;
        sum->squares[c] += deviation * (sample[c] - sum->mean[c]);
    }
}

static assay_path_light measure(const probe_job *job, uint64_t index, uint32_t sample,
                                assay_vec3 position, const assay_frame3 *frame,
                                assay_ray_counts *counts)
{
    assay_vertex receiver;
    assay_vertex_receiver(position, frame, frame->z, &receiver);
    assay_random random = assay_random_start(job->frame->seed, ASSAY_STAGE_PROBE, index, sample);
    return assay_path_scatter(job->frame->world, &job->state->settings, &receiver, &random, counts);
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
    const assay_vec3 p       = job->points->positions[index];
    const double     h       = job->step;
    const double     angle   = job->state->gradient_angle;
    const assay_vec3 axis[2] = {frame->x, frame->y};
    assay_rgb        slope[3], spin[3] = {{0}};
    for (int i = 0; i < 2; i++) {
        const assay_path_light ahead =
            measure(job, index, sample, vec3_mad(p, h, axis[i]), frame, counts);
        const assay_path_light behind =
            measure(job, index, sample, vec3_mad(p, -h, axis[i]), frame, counts);
        slope[i] = difference(ahead, behind, 0.5 / h);

        const assay_frame3     left       = turn(frame, axis[i], angle);
        const assay_frame3     right      = turn(frame, axis[i], -angle);
        const assay_path_light turned     = measure(job, index, sample, p, &left, counts);
        const assay_path_light turned_off = measure(job, index, sample, p, &right, counts);
        spin[i]                           = difference(turned, turned_off, 0.5 / angle);
    }
    slope[2] = difference(measure(job, index, sample, vec3_mad(p, h, frame->z), frame, counts),
                          here, 1.0 / h);
    to_world(frame, slope, out);
    to_world(frame, spin, out + 3);
}

static assay_status probe_point(void *user, uint64_t index, int worker)
{
    const probe_job   *job              = user;
    assay_ray_counts  *counts           = &job->worker_counts[worker];
    const assay_frame3 frame            = frame3_from_z(job->points->normals[index]);
    running            sums[QUANTITIES] = {0};
    for (uint32_t s = 0; s < job->state->spp; s++) {
        const assay_path_light here =
            measure(job, index, s, job->points->positions[index], &frame, counts);
        assay_rgb value[QUANTITIES] = {total(here), here.direct, here.indirect};
        if (job->quantities == QUANTITIES) {
            measure_gradients(job, index, s, &frame, here, counts, value + TRANSLATION);
        }
        for (uint32_t q = 0; q < job->quantities; q++) {
            if (!rgb_finite(value[q])) {
                return ASSAY_ERR_DOMAIN;
            }
            add_sample(&sums[q], s + 1.0, value[q]);
        }
    }
    const double n     = job->state->spp;
    const double scale = n > 1.0 ? 1.0 / (n * (n - 1.0)) : 0.0;
    double      *row   = job->rows + index * job->quantities * 6;
    for (uint32_t q = 0; q < job->quantities; q++) {
        for (int c = 0; c < 3; c++) {
            row[6 * q + (uint32_t)c]     = sums[q].mean[c];
            row[6 * q + 3 + (uint32_t)c] = sums[q].squares[c] * scale;
        }
    }
    return ASSAY_OK;
}

static double default_step(const assay_scene *scene)
{
    const double diagonal = vec3_length(vec3_sub(scene->bounds_max, scene->bounds_min));
    return diagonal > 0.0 ? 1e-3 * diagonal : 1e-3;
}

assay_status assay_path_probe(void *state, const assay_frame *frame,
                              const assay_probe_points *points, double *rows,
                              assay_ray_counts *counts)
{
    const assay_path_state *path    = state;
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
        .step = path->gradient_step > 0.0 ? path->gradient_step : default_step(frame->world->scene),
        .quantities = path->gradients ? QUANTITIES : QUANTITIES_PLAIN,
    };
    const assay_status status =
        assay_parallel_for(frame->context, "probe", points->count, probe_point, &job);
    for (int i = 0; i < threads; i++) {
        assay_ray_counts_add(counts, &worker_counts[i]);
    }
    assay_release(frame->context, worker_counts);
    if (status == ASSAY_ERR_DOMAIN) {
        return assay_fail(frame->context, status,
                          "the scene gives light that is no finite number: its emission or scale "
                          "is too extreme");
    }
    return status;
}
