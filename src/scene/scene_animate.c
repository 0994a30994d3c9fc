/* scene_animate.c - key frames between keys (glTF 2.0, appendix C).
 *
 * Invariant: a pure function of the document and the time: every pose starts again from the file's
 * own, so no evaluation depends on the one before.  All animations play together; where two move
 * the same property, the later one in the file wins. */
#include <string.h>

#include "core/numerics.h"
#include "scene/scene_build.h"

/* The key at or before t, clamped, and where between it and the next, [0, 1). */
static uint32_t find_key(const assay_channel_track *track, double t, double *fraction_out)
{
    uint32_t low = 0, high = track->key_count - 1;
    *fraction_out = 0.0;
    if (t <= track->times[0] || track->key_count == 1) {
        return 0;
    }
    if (t >= track->times[high]) {
        return high;
    }
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (track->times[middle] <= t) {
            low = middle;
        } else {
            high = middle;
        }
    }
    *fraction_out = (t - track->times[low]) / (track->times[high] - track->times[low]);
    return low;
}

/* From a to b on the great circle, the short way.  The angle comes from atan2, which unlike acos is
 * accurate for small ones. */
static void slerp(const double a[4], const double b[4], double s, double out[4])
{
    double la = 0.0, lb = 0.0, dot = 0.0;
    for (int i = 0; i < 4; i++) {
        la += a[i] * a[i];
        lb += b[i] * b[i];
        dot += a[i] * b[i];
    }
    const double ka = 1.0 / sqrt(la), kb = (dot < 0.0 ? -1.0 : 1.0) / sqrt(lb);
    double       difference = 0.0, sum = 0.0;
    for (int i = 0; i < 4; i++) {
        const double d = b[i] * kb - a[i] * ka, e = b[i] * kb + a[i] * ka;
        difference += d * d;
        sum += e * e;
    }
    const double angle = 2.0 * assay_atan2(sqrt(difference), sqrt(sum));
    const double sine  = assay_sin(angle);
    const double wa    = angle > 1e-9 ? assay_sin((1.0 - s) * angle) / sine : 1.0 - s;
    const double wb    = angle > 1e-9 ? assay_sin(s * angle) / sine : s;
    for (int i = 0; i < 4; i++) {
        out[i] = wa * (a[i] * ka) + wb * (b[i] * kb);
    }
}

/* Hermite between values k and k + 1 with the out-tangent of one and the in-tangent of the other,
 * both per second. */
static void interpolate_spline(const assay_channel_track *track, uint32_t key, double s,
                               double *out)
{
    const uint32_t n  = track->width;
    const double  *v0 = track->values + (size_t)key * n * 3, *v1 = v0 + (size_t)n * 3;
    const double   dt = track->times[key + 1] - track->times[key];
    const double   s2 = s * s, s3 = s2 * s;
    for (uint32_t i = 0; i < n; i++) {
        const double a = v1[i], p0 = v0[n + i], p1 = v1[n + i], b = v0[2 * n + i];
        out[i] = (2.0 * s3 - 3.0 * s2 + 1.0) * p0 + dt * (s3 - 2.0 * s2 + s) * b +
                 (-2.0 * s3 + 3.0 * s2) * p1 + dt * (s3 - s2) * a;
    }
}

static void sample_track(const assay_channel_track *track, double t, double *out)
{
    double         s;
    const uint32_t key = find_key(track, t, &s), n = track->width;
    const bool     spline = track->interpolation == ASSAY_INTERPOLATE_CUBICSPLINE;
    const double  *at     = track->values + (size_t)key * n * (spline ? 3 : 1) + (spline ? n : 0);
    if (s == 0.0 || track->interpolation == ASSAY_INTERPOLATE_STEP) {
        memcpy(out, at, n * sizeof *out);
    } else if (spline) {
        interpolate_spline(track, key, s, out);
    } else if (track->path == ASSAY_PATH_ROTATION) {
        slerp(at, at + n, s, out);
    } else {
        for (uint32_t i = 0; i < n; i++) {
            out[i] = (1.0 - s) * at[i] + s * at[n + i];
        }
    }
}

/* Poses and weights as the file has them without any animation. */
static void reset(assay_scene *scene)
{
    for (uint32_t i = 0; i < scene->node_count; i++) {
        const assay_node *node = &scene->nodes[i];
        assay_pose       *pose = &scene->poses[i];
        memcpy(pose->translation, node->translation, sizeof pose->translation);
        memcpy(pose->rotation, node->rotation, sizeof pose->rotation);
        memcpy(pose->scale, node->scale, sizeof pose->scale);
        if (node->target_count == 0) {
            continue;
        }
        const assay_mesh *mesh = &scene->meshes[node->mesh];
        const double     *from = node->weight_count   ? node->weights
                                 : mesh->weight_count ? mesh->weights
                                                      : NULL;
        for (uint32_t k = 0; k < node->target_count; k++) {
            scene->morph_weights[node->first_weight + k] = from ? from[k] : 0.0;
        }
    }
}

void assay_scene_animate(assay_scene *scene, double seconds)
{
    reset(scene);
    for (uint32_t i = 0; i < scene->animation_count; i++) {
        for (uint32_t k = 0; k < scene->animations[i].track_count; k++) {
            const assay_channel_track *track     = &scene->animations[i].tracks[k];
            assay_pose                *pose      = &scene->poses[track->node];
            double *const              targets[] = {pose->translation, pose->rotation, pose->scale,
                                                    scene->morph_weights +
                                                        scene->nodes[track->node].first_weight};
            sample_track(track, seconds, targets[track->path]);
        }
    }
}
